//! PGM, PPM, TGA and BMP: formats that hold their numbers as they are, or in runs.

use super::{MayHold, Picture, Result, cut_off, fault, of_colour, of_grey, of_index};

/// PGM and PPM, in text (P2, P3) and in bytes (P5, P6).
pub(super) fn pnm(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Picture> {
    let mut text = Text { bytes, at: 2 };
    let mut header = [0; 3];
    for (value, what) in header.iter_mut().zip(["width", "height", "greatest value"]) {
        let Some(number) = text.number() else { return fault(format!("has no {what} in its header")) };
        *value = number;
    }
    let [columns, rows, most] = header;
    if !(1..=65535).contains(&most) {
        return fault(format!("has {most} as its greatest value: from 1 to 65535 is allowed"));
    }
    let (columns, rows) = (columns as usize, rows as usize);
    may_hold([columns, rows])?;
    let has_colours = matches!(bytes[1], b'3' | b'6');
    let channels = if has_colours { 3 } else { 1 };
    let height = |pixel: &[u32]| match pixel {
        [red, green, _] => {
            let byte = |value: u32| (value.min(most) * 255 / most) as u8;
            of_colour(byte(*red), byte(*green))
        }
        _ => of_grey(pixel[0], most),
    };
    let mut words = Vec::with_capacity(columns * rows);
    if matches!(bytes[1], b'2' | b'3') {
        for _ in 0..columns * rows {
            let mut pixel = [0; 3];
            for value in &mut pixel[..channels] {
                let Some(number) = text.number() else {
                    let (found, wanted) = (words.len(), columns * rows);
                    return fault(format!("ends too early: of {wanted} pixels {found} are there"));
                };
                *value = number;
            }
            words.push(height(&pixel[..channels]));
        }
        return Ok(Picture { columns, rows, words });
    }
    // One white space, then the bytes.
    let data = bytes.get(text.at + 1..).unwrap_or(&[]);
    let width = if most > 255 { 2 } else { 1 };
    let wanted = columns * rows * channels * width;
    if data.len() < wanted {
        return cut_off("pixels", wanted, data.len());
    }
    words.extend(data[..wanted].chunks_exact(channels * width).map(|bytes| {
        let mut pixel = [0; 3];
        for (value, bytes) in pixel.iter_mut().zip(bytes.chunks_exact(width)) {
            *value = bytes.iter().fold(0, |number, &byte| number << 8 | u32::from(byte));
        }
        height(&pixel[..channels])
    }));
    Ok(Picture { columns, rows, words })
}

/// Numbers between white space and comments.
struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Text<'_> {
    fn number(&mut self) -> Option<u32> {
        loop {
            match self.bytes.get(self.at)? {
                b'#' => {
                    while *self.bytes.get(self.at)? != b'\n' {
                        self.at += 1;
                    }
                }
                byte if byte.is_ascii_whitespace() => self.at += 1,
                byte if byte.is_ascii_digit() => break,
                _ => return None,
            }
        }
        let mut number: u32 = 0;
        while let Some(byte) = self.bytes.get(self.at).filter(|byte| byte.is_ascii_digit()) {
            number = number.checked_mul(10)?.checked_add(u32::from(byte - b'0'))?;
            self.at += 1;
        }
        Some(number)
    }
}

fn u16_at(bytes: &[u8], at: usize) -> usize {
    usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]))
}

fn i32_at(bytes: &[u8], at: usize) -> i32 {
    i32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

/// The meaning of a pixel's bytes: blue comes before green and red.
#[derive(Clone, Copy, PartialEq)]
enum Pixels {
    Index,
    Grey,
    /// 16 bits: five each for red, green and blue.
    Fives,
    Colour,
}

impl Pixels {
    fn height(self, bytes: &[u8]) -> u16 {
        match self {
            Self::Index => of_index(bytes[0]),
            Self::Grey => of_grey(bytes[0].into(), 255),
            Self::Fives => {
                let five = |shift: u32| (u16_at(bytes, 0) >> shift & 31) as u8 * 8;
                of_colour(five(10), five(5))
            }
            Self::Colour => of_colour(bytes[2], bytes[1]),
        }
    }
}

/// TGA: with a palette, grey or in colour, plain or in runs.
pub(super) fn tga(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Picture> {
    if bytes.len() < 18 {
        return cut_off("header", 18, bytes.len());
    }
    let (kind, depth, columns, rows) = (bytes[2], bytes[16], u16_at(bytes, 12), u16_at(bytes, 14));
    let pixels = match (kind & 7, depth) {
        (1, 8) => Pixels::Index,
        (3, 8) => Pixels::Grey,
        (2, 15 | 16) => Pixels::Fives,
        (2, 24 | 32) => Pixels::Colour,
        _ => {
            return fault(format!("is not a TGA file that is understood: type {kind}, {depth} bits a pixel"));
        }
    };
    if kind & !11 != 0 {
        return fault(format!("is not a TGA file that is understood: type {kind}"));
    }
    may_hold([columns, rows])?;
    let palette = if bytes[1] == 1 { u16_at(bytes, 5) * usize::from(bytes[7]).div_ceil(8) } else { 0 };
    let mut data = bytes.get(18 + usize::from(bytes[0]) + palette..).unwrap_or(&[]);
    let (size, count) = (usize::from(depth).div_ceil(8), columns * rows);
    let mut words = Vec::with_capacity(count);
    if kind & 8 == 0 {
        if data.len() < count * size {
            return cut_off("pixels", count * size, data.len());
        }
        words.extend(data[..count * size].chunks_exact(size).map(|pixel| pixels.height(pixel)));
    }
    while words.len() < count {
        let Some((&head, rest)) = data.split_first() else { break };
        let (run, left) = (usize::from(head & 127) + 1, count - words.len());
        let stored = if head & 128 != 0 { size } else { run * size };
        let Some(packet) = rest.get(..stored) else { break };
        if head & 128 != 0 {
            words.extend(std::iter::repeat_n(pixels.height(packet), run.min(left)));
        } else {
            words.extend(packet.chunks_exact(size).take(left).map(|pixel| pixels.height(pixel)));
        }
        data = &rest[stored..];
    }
    if words.len() < count {
        let found = words.len();
        return fault(format!("ends too early: of {count} pixels {found} are there"));
    }
    // Rows go upward, unless the header says otherwise; so do columns go to the right.
    if bytes[17] & 32 == 0 {
        turn_over(&mut words, columns);
    }
    if bytes[17] & 16 != 0 {
        words.chunks_exact_mut(columns).for_each(<[u16]>::reverse);
    }
    Ok(Picture { columns, rows, words })
}

/// The last row first.
fn turn_over(words: &mut [u16], columns: usize) {
    let rows = words.len() / columns;
    for row in 0..rows / 2 {
        let (above, below) = words.split_at_mut((rows - 1 - row) * columns);
        above[row * columns..][..columns].swap_with_slice(&mut below[..columns]);
    }
}

/// BMP without compression, of 8, 24 or 32 bits a pixel.
pub(super) fn bmp(bytes: &[u8], may_hold: MayHold<'_>) -> Result<Picture> {
    if bytes.len() < 54 {
        return cut_off("headers", 54, bytes.len());
    }
    let (start, columns, rows) = (i32_at(bytes, 10) as u32 as usize, i32_at(bytes, 18), i32_at(bytes, 22));
    let (depth, packed) = (u16_at(bytes, 28), i32_at(bytes, 30));
    let pixels = match depth {
        8 => Pixels::Index,
        24 | 32 => Pixels::Colour,
        _ => return fault(format!("is a BMP file with {depth} bits a pixel: 8, 24 and 32 are understood")),
    };
    // 3: masks, which are those of plain ones in practice.
    if packed != 0 && !(packed == 3 && depth == 32) {
        return fault("is a compressed BMP file, which is not understood");
    }
    if columns < 0 {
        return fault(format!("has a width of {columns}"));
    }
    let (is_turned, columns, rows) = (rows > 0, columns as usize, rows.unsigned_abs() as usize);
    may_hold([columns, rows])?;
    let (size, line) = (depth / 8, (columns * depth / 8).div_ceil(4) * 4);
    let data = bytes.get(start..).unwrap_or(&[]);
    if data.len() < line * rows {
        return cut_off("pixels", line * rows, data.len());
    }
    let mut words = Vec::with_capacity(columns * rows);
    for row in data[..line * rows].chunks_exact(line) {
        words.extend(row[..columns * size].chunks_exact(size).map(|pixel| pixels.height(pixel)));
    }
    if is_turned {
        turn_over(&mut words, columns);
    }
    Ok(Picture { columns, rows, words })
}
