//! The values that an identifier can have.

use std::rc::Rc;

use crate::diagnostics::Place;
use crate::limits::Charge;
use crate::macros::Macro;
use crate::transform::Matrix;

/// One to five numbers: a float, a vector, or (with five) a colour as red, green, blue, filter,
/// transmit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Terms {
    values: [f64; 5],
    count: u8,
}

impl Terms {
    /// Makes the terms of `values`, of which there are 1 to 5.
    pub(crate) fn new(values: &[f64]) -> Self {
        let mut all = [0.0; 5];
        let count = values.len().min(5);
        all[..count].copy_from_slice(&values[..count]);
        Self { values: all, count: count as u8 }
    }

    /// The terms themselves.
    pub(crate) fn as_slice(&self) -> &[f64] {
        &self.values[..usize::from(self.count)]
    }

    /// The number of terms.
    pub(crate) fn len(&self) -> usize {
        usize::from(self.count)
    }

    /// The float, if there is just one term.
    pub(crate) fn float(&self) -> Option<f64> {
        (self.count == 1).then_some(self.values[0])
    }

    /// The value with `count` terms: a single term is repeated, fewer are padded with zeros, and
    /// longer values stay as they are.
    pub(crate) fn promoted(mut self, count: usize) -> Self {
        if self.len() < count {
            if self.count == 1 {
                let first = self.values[0];
                self.values[1..count].fill(first);
            }
            self.count = count as u8;
        }
        self
    }

    /// Applies `f` to each pair of terms; the shorter operand is promoted.
    pub(crate) fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let count = self.len().max(other.len());
        let (a, b) = (self.promoted(count), other.promoted(count));
        let mut result = Self { values: [0.0; 5], count: count as u8 };
        for (value, (a, b)) in result.values.iter_mut().zip(a.as_slice().iter().zip(b.as_slice())) {
            *value = f(*a, *b);
        }
        result
    }

    /// Applies `f` to each term.
    pub(crate) fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for value in &mut self.values[..usize::from(self.count)] {
            *value = f(*value);
        }
        self
    }

    /// The first three terms of the promoted value.
    pub(crate) fn xyz(self) -> [f64; 3] {
        let v = self.promoted(3).values;
        [v[0], v[1], v[2]]
    }

    /// All five terms of the promoted value.
    pub(crate) fn all(self) -> [f64; 5] {
        self.promoted(5).values
    }
}

impl From<f64> for Terms {
    fn from(value: f64) -> Self {
        Self::new(&[value])
    }
}

impl From<[f64; 3]> for Terms {
    fn from(values: [f64; 3]) -> Self {
        Self::new(&values)
    }
}

/// A string, charged to the scene's memory.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Text {
    pub(crate) text: String,
    _charge: Charge,
}

impl Text {
    /// Makes a text and charges its bytes.
    pub(crate) fn new(text: String) -> Rc<Self> {
        let _charge = Charge::new(text.len() + 64);
        Rc::new(Self { text, _charge })
    }
}

/// An array. Its elements are in row order.
#[derive(Clone, Debug)]
pub(crate) struct Array {
    pub(crate) sizes: Vec<usize>,
    pub(crate) items: Vec<Value>,
    /// The nesting depth of arrays, this one included.
    pub(crate) depth: u32,
    charge: Charge,
}

impl Array {
    /// Makes an array without values.
    pub(crate) fn new(sizes: Vec<usize>) -> Self {
        let count = sizes.iter().product();
        let charge = Charge::new(Self::bytes(count));
        Self { sizes, items: vec![Value::Empty; count], depth: 1, charge }
    }

    /// Updates the memory that the elements take beyond their own size, after all were set.
    pub(crate) fn recount(&mut self) {
        let held: usize = self.items.iter().map(Value::held).sum();
        self.charge.resize(Self::bytes(self.items.len()).saturating_add(held));
    }

    /// Updates the memory after an element that took `before` bytes takes `after`.
    pub(crate) fn changed(&mut self, before: usize, after: usize) {
        self.charge.change(before, after);
    }

    /// The bytes of `count` elements.
    pub(crate) fn bytes(count: usize) -> usize {
        count.saturating_mul(size_of::<Value>()).saturating_add(64)
    }
}

/// A definition that uses something durer does not support yet. Using it is an error, not defining
/// it.
#[derive(Debug)]
pub(crate) struct Unsupported {
    /// The text of the message.
    pub(crate) text: String,
    /// Where the cause stands. For a number it is the place of its use that counts.
    pub(crate) place: Option<Place>,
    /// Whether it stands for a number, or for a function that gives one: then a semicolon ends the
    /// statement.
    pub(crate) number: bool,
}

/// A value, cheap to copy: the large ones are shared and never changed in place.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    /// An array element without a value.
    Empty,
    Number(Terms),
    Text(Rc<Text>),
    Array(Rc<Array>),
    Transform(Rc<Matrix>),
    Pigment(Rc<crate::texture::Pigment>),
    Finish(Rc<crate::texture::Finish>),
    Texture(Rc<crate::texture::Texture>),
    ColorMap(Rc<crate::texture::ColorMap>),
    SlopeMap(Rc<crate::texture::SlopeMap>),
    Normal(Rc<crate::texture::Normal>),
    NormalMap(Rc<crate::texture::Map<crate::texture::Normal>>),
    PigmentMap(Rc<crate::texture::Map<crate::texture::Pigment>>),
    TextureMap(Rc<crate::texture::Map<crate::texture::Texture>>),
    Interior(Rc<crate::texture::Interior>),
    Material(Rc<crate::texture::Material>),
    Fog(Rc<crate::atmosphere::Fog>),
    Rainbow(Rc<crate::rainbow::Rainbow>),
    SkySphere(Rc<crate::atmosphere::SkySphere>),
    Camera(Rc<crate::camera::Camera>),
    Object(Rc<crate::object::Object>),
    Macro(Rc<Macro>),
    Function(Rc<crate::sampled::Called>),
    VectorFunction(Rc<crate::vector_function::VectorFunction>),
    Spline(Rc<crate::spline::Spline>),
    /// A parameter of the function that is being read.
    Parameter(u32),
    /// An open file, by its number.
    File(usize),
    Unsupported(Rc<Unsupported>),
}

impl Value {
    /// The kind of the value in the words of a message, with its article.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Empty => "an array element without a value",
            Self::Number(terms) => match terms.len() {
                1 => "a float",
                5 => "a colour",
                _ => "a vector",
            },
            Self::Text(_) => "a string",
            Self::Array(_) => "an array",
            Self::Transform(_) => "a transform",
            Self::Pigment(_) => "a pigment",
            Self::Finish(_) => "a finish",
            Self::Texture(_) => "a texture",
            Self::ColorMap(_) => "a colour map",
            Self::SlopeMap(_) => "a slope map",
            Self::Normal(_) => "a normal",
            Self::NormalMap(_) => "a normal map",
            Self::PigmentMap(_) => "a pigment map",
            Self::TextureMap(_) => "a texture map",
            Self::Interior(_) => "an interior",
            Self::Material(_) => "a material",
            Self::Fog(_) => "fog",
            Self::Rainbow(_) => "a rainbow",
            Self::SkySphere(_) => "a sky sphere",
            Self::Camera(_) => "a camera",
            Self::Object(_) => "an object",
            Self::Macro(_) => "a macro",
            Self::Function(_) => "a function",
            Self::VectorFunction(_) => "a function of vectors",
            Self::Spline(_) => "a spline",
            Self::Parameter(_) => "a function's parameter",
            Self::File(_) => "an open file",
            Self::Unsupported(_) => "something not supported yet",
        }
    }

    /// The bytes that it holds and that are not charged elsewhere.
    pub(crate) fn held(&self) -> usize {
        let layer = size_of::<crate::texture::Layer>();
        match self {
            Self::Texture(texture) => texture.size() * layer,
            Self::Pigment(_) | Self::Normal(_) | Self::Finish(_) => layer,
            Self::Material(material) => {
                material.texture.as_ref().map_or(0, crate::texture::Texture::size) * layer + layer
            }
            Self::Function(called) => called.held(),
            Self::VectorFunction(function) => function.held(),
            Self::SkySphere(sky) => sky.pigments.len() * layer,
            Self::Fog(_) | Self::Rainbow(_) | Self::Interior(_) | Self::Transform(_) | Self::Camera(_) => 256,
            _ => 0,
        }
    }

    /// The nesting depth of arrays; 0 for other values.
    pub(crate) fn array_depth(&self) -> u32 {
        if let Self::Array(array) = self { array.depth } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operands_are_promoted() {
        let a = Terms::new(&[1.0, 2.0, 3.0]);
        assert_eq!(a.zip(2.0.into(), |a, b| a * b).as_slice(), [2.0, 4.0, 6.0]);
        assert_eq!(a.zip(Terms::new(&[2.0, 3.0]), |a, b| a * b).as_slice(), [2.0, 6.0, 0.0]);
        assert_eq!(Terms::from(0.5).all(), [0.5; 5]);
        assert_eq!(a.all(), [1.0, 2.0, 3.0, 0.0, 0.0]);
    }
}
