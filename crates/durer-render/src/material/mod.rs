//! Materials: how surfaces reflect and scatter light.

mod finish;
mod fresnel;
mod metal;

pub(crate) use self::finish::{Finish, Incidence, Mirror, View};
pub(crate) use self::fresnel::{reflectance, refract};
