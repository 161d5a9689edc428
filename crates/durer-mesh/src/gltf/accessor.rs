//! Accessors: arrays of numbers in the bytes of a view. A sparse accessor replaces some of their
//! elements.

use super::buffers::Buffers;
use super::{item, wrong};
use crate::error::{ErrorKind, Location};
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::buffer::View;
use gltf::json::validation::Checked;

/// The layout of numbers in a view: an offset and an element type. The view gives the stride.
struct Layout {
    view: usize,
    offset: u64,
    kind: ComponentType,
    components: usize,
    count: u64,
    spot: Location,
}

/// All accessors of a file.
pub(super) struct Accessors<'a> {
    pub(super) list: &'a [Accessor],
    pub(super) views: &'a [View],
    pub(super) buffers: Buffers<'a>,
}

impl Accessors<'_> {
    /// The number of elements that an accessor declares.
    pub(super) fn count(&self, number: usize, asked: Location) -> Result<u64, ErrorKind> {
        Ok(item(self.list, number, "accessor", asked)?.count.0)
    }

    /// The elements of an accessor with `N` components. Normalised integers become fractions.
    pub(super) fn vectors<const N: usize>(
        &mut self,
        number: usize,
        asked: Location,
    ) -> Result<Vec<[f64; N]>, ErrorKind> {
        let is_normalized = item(self.list, number, "accessor", asked)?.normalized;
        self.elements(number, asked, |kind, bytes| {
            let mut parts = bytes.chunks_exact(kind.size());
            core::array::from_fn(|_| value(kind, is_normalized, parts.next().unwrap_or_default()))
        })
    }

    /// The elements of an accessor of unsigned integers.
    pub(super) fn indices(&mut self, number: usize, asked: Location) -> Result<Vec<u32>, ErrorKind> {
        let Checked::Valid(kind) = item(self.list, number, "accessor", asked)?.component_type else {
            return wrong(Location::Element("accessor", number), "its componentType is unknown");
        };
        if !matches!(kind.0, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return wrong(
                Location::Element("accessor", number),
                "indices must be whole numbers without a sign",
            );
        }
        Ok(self.elements(number, asked, |_, bytes| [whole(bytes)])?.into_iter().map(|[i]| i).collect())
    }

    fn elements<T: Copy + Default, const N: usize>(
        &mut self,
        number: usize,
        asked: Location,
        read: impl Fn(ComponentType, &[u8]) -> [T; N],
    ) -> Result<Vec<[T; N]>, ErrorKind> {
        let accessor = item(self.list, number, "accessor", asked)?;
        let spot = Location::Element("accessor", number);
        let Checked::Valid(kind) = accessor.component_type else {
            return wrong(spot, "its componentType is unknown");
        };
        let components = match accessor.type_ {
            Checked::Valid(type_ @ (Type::Scalar | Type::Vec2 | Type::Vec3 | Type::Vec4)) => {
                type_.multiplicity()
            }
            _ => 0,
        };
        if components != N {
            return wrong(spot, format!("its type should be of {N} components"));
        }
        let count = accessor.count.0;
        let offset = accessor.byte_offset.map_or(0, |x| x.0);
        let mut all = match accessor.buffer_view {
            Some(view) => self
                .read(&Layout { view: view.value(), offset, kind: kind.0, components, count, spot }, |b| {
                    read(kind.0, b)
                })?,
            // The accessor is all zeros. It may have as many elements as the files have bytes,
            // whatever it declares.
            None => {
                let room = self.buffers.there as u64;
                if count > room {
                    return Err(ErrorKind::Room {
                        spot,
                        what: "elements without a bufferView".into(),
                        promised: count,
                        room,
                    });
                }
                vec![[T::default(); N]; count as usize]
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(index) = sparse.indices.component_type else {
                return wrong(spot, "the componentType of its sparse indices is unknown");
            };
            let (count, at, values) = (sparse.count.0, &sparse.indices, &sparse.values);
            let places = Layout {
                view: at.buffer_view.value(),
                offset: at.byte_offset.0,
                kind: index.0,
                components: 1,
                count,
                spot,
            };
            let places = self.read(&places, whole)?;
            let values = Layout {
                view: values.buffer_view.value(),
                offset: values.byte_offset.0,
                kind: kind.0,
                components,
                count,
                spot,
            };
            for (place, value) in places.into_iter().zip(self.read(&values, |b| read(kind.0, b))?) {
                let (index, count) = (i64::from(place), all.len());
                *all.get_mut(place as usize).ok_or(ErrorKind::Index {
                    spot,
                    what: "element",
                    index,
                    count,
                })? = value;
            }
        }
        Ok(all)
    }

    /// Reads the elements of a layout, after checking that the view contains all of them.
    fn read<T>(&mut self, layout: &Layout, read: impl Fn(&[u8]) -> T) -> Result<Vec<T>, ErrorKind> {
        let &Layout { view, offset, kind, components, count, spot } = layout;
        let element = kind.size() * components;
        let bytes = self.buffers.view(self.views, view, spot)?;
        let stride = self.views[view].byte_stride.map_or(element, |s| s.0);
        if stride < element {
            return wrong(
                Location::Element("bufferView", view),
                format!("its byteStride of {stride} is less than an element's {element} bytes"),
            );
        }
        let bytes = usize::try_from(offset).ok().and_then(|from| bytes.get(from..)).unwrap_or_default();
        // The last element need not be followed by the rest of its stride.
        let room = if bytes.len() < element { 0 } else { (bytes.len() - element) / stride + 1 };
        if count > room as u64 {
            let what = format!("elements from byte {offset} of bufferView {view}");
            return Err(ErrorKind::Room { spot, what, promised: count, room: room as u64 });
        }
        Ok(bytes.chunks(stride).take(count as usize).map(|chunk| read(&chunk[..element])).collect())
    }
}

/// An unsigned integer of one, two or four bytes.
fn whole(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |n, &b| n << 8 | u32::from(b))
}

/// A component as a number. Normalised integers lie in `[-1, 1]` or `[0, 1]`.
fn value(kind: ComponentType, is_normalized: bool, bytes: &[u8]) -> f64 {
    let bits = whole(bytes);
    let (number, most) = match kind {
        ComponentType::I8 => (f64::from(bits as u8 as i8), 127.0),
        ComponentType::U8 => (f64::from(bits), 255.0),
        ComponentType::I16 => (f64::from(bits as u16 as i16), 32767.0),
        ComponentType::U16 => (f64::from(bits), 65535.0),
        ComponentType::U32 => (f64::from(bits), f64::from(u32::MAX)),
        ComponentType::F32 => return f64::from(f32::from_bits(bits)),
    };
    if is_normalized { (number / most).max(-1.0) } else { number }
}
