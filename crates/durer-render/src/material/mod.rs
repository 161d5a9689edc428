//! How surfaces answer to light: finishes, metals, mirrors.

mod finish;
mod fresnel;
mod metal;

pub(crate) use self::finish::{Finish, Incidence, Mirror, View};
pub(crate) use self::fresnel::{reflectance, refract};
