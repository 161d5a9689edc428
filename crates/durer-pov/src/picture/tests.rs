//! Each format with the same numbers; files that are cut off.

use super::*;
use std::sync::atomic::{AtomicU32, Ordering};

fn read_bytes(bytes: &[u8], format: Format) -> Result<Picture> {
    // Tests run at the same time: each file has a name of its own.
    static FILES: AtomicU32 = AtomicU32::new(0);
    let name = format!("durer-picture-{}-{}", std::process::id(), FILES.fetch_add(1, Ordering::Relaxed));
    let file = std::env::temp_dir().join(name);
    std::fs::write(&file, bytes).unwrap();
    let read = read(&file, format, &Limits::default(), &|[columns, rows]| {
        if columns * rows > 1000 { fault("is too large") } else { Ok(()) }
    });
    std::fs::remove_file(&file).unwrap();
    read
}

fn words(bytes: &[u8], format: Format) -> Vec<u16> {
    match read_bytes(bytes, format) {
        Ok(picture) => picture.words,
        Err(Fault::Text(text)) => panic!("{text}"),
        Err(Fault::Limit(_)) => panic!("a limit"),
    }
}

fn refused(bytes: &[u8], format: Format) -> String {
    match read_bytes(bytes, format) {
        Err(Fault::Text(text)) => text,
        Err(Fault::Limit(_)) => "a limit".into(),
        Ok(_) => panic!("this file is wrong"),
    }
}

#[test]
fn pgm_and_ppm_in_text_and_in_bytes() {
    assert_eq!(words(b"P2 # a comment\n2 2\n15\n0 15 5 1", Format::Pnm), [0, 65535, 21845, 4369]);
    assert_eq!(words(b"P5 2 2 255\n\x00\xff\x0a\x01", Format::Pnm), [0, 65535, 2570, 257]);
    assert_eq!(words(b"P5 2 1 65535\n\x12\x34\xff\xff", Format::Pnm), [0x1234, 65535]);
    assert_eq!(words(b"P3 1 2 255 1 2 3 4 5 6", Format::Pnm), [0x0102, 0x0405]);
    assert_eq!(words(b"P6 1 1 255\n\x07\x08\x09", Format::Pnm), [0x0708]);
    assert_eq!(
        refused(b"P5 2 2 255\n\x00", Format::Pnm),
        "ends too early: its pixels take 4 bytes, and 1 are there"
    );
    assert_eq!(refused(b"P2 2 2 255 1 2", Format::Pnm), "ends too early: of 4 pixels 2 are there");
    assert_eq!(refused(b"P2 2", Format::Pnm), "has no height in its header");
    assert_eq!(refused(b"GIF89a", Format::Pnm), "is not a PGM or PPM file");
    assert_eq!(refused(b"", Format::Png), "is empty");
    assert_eq!(refused(b"P5 100000 100000 255\n", Format::Pnm), "is too large");
}

#[test]
fn tga_of_all_kinds() {
    let header = |kind: u8, depth: u8, flags: u8| {
        let mut bytes = vec![0_u8; 18];
        (bytes[2], bytes[12], bytes[14], bytes[16], bytes[17]) = (kind, 2, 2, depth, flags);
        bytes
    };
    let with = |mut bytes: Vec<u8>, data: &[u8]| {
        bytes.extend(data);
        bytes
    };
    assert_eq!(words(&with(header(3, 8, 0), &[1, 2, 3, 4]), Format::Tga), [771, 1028, 257, 514]);
    assert_eq!(words(&with(header(3, 8, 32), &[1, 2, 3, 4]), Format::Tga), [257, 514, 771, 1028]);
    assert_eq!(words(&with(header(11, 8, 32), &[130, 1, 0, 4]), Format::Tga), [257, 257, 257, 1028]);
    let colours = [3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10];
    assert_eq!(words(&with(header(2, 24, 32), &colours), Format::Tga), [0x0102, 0x0405, 0x0708, 0x0a0b]);
    assert_eq!(words(&with(header(10, 24, 32), &[131, 3, 2, 1]), Format::Tga), [0x0102; 4]);
    assert!(refused(&with(header(10, 24, 32), &[131, 3]), Format::Tga).starts_with("ends too early"));
    assert!(refused(&header(7, 24, 32), Format::Tga).starts_with("is not a TGA file"));
}

#[test]
fn bmp_goes_upward() {
    let mut bytes = vec![0_u8; 54];
    bytes[..2].copy_from_slice(b"BM");
    (bytes[10], bytes[18], bytes[22], bytes[28]) = (54, 2, 2, 24);
    bytes.extend([3, 2, 1, 6, 5, 4, 0, 0, 9, 8, 7, 12, 11, 10, 0, 0]);
    assert_eq!(words(&bytes, Format::Bmp), [0x0708, 0x0a0b, 0x0102, 0x0405]);
    bytes.truncate(60);
    assert!(refused(&bytes, Format::Bmp).starts_with("ends too early"));
}

#[test]
fn png_of_all_depths() {
    let png = |colour: png::ColorType, depth: png::BitDepth, data: &[u8]| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if colour == Indexed {
            encoder.set_palette(vec![7; 768]);
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        bytes
    };
    use png::{BitDepth::*, ColorType::*};
    // POV-Ray reads level 3 as level 2.
    let grey = png(Grayscale, Eight, &[1, 2, 3, 255]);
    assert_eq!(words(&grey, Format::Png), [257, 514, 514, 65535]);
    assert!(refused(&grey[..grey.len() / 2], Format::Png).starts_with("cannot be unpacked"));
    assert_eq!(words(&png(Grayscale, One, &[0x40, 0x80]), Format::Png), [0, 65535, 65535, 0]);
    let deep = [0x12, 0x34, 0, 1, 0xff, 0xff, 0x80, 0];
    assert_eq!(words(&png(Grayscale, Sixteen, &deep), Format::Png), [0x1234, 1, 65535, 0x8000]);
    assert_eq!(words(&png(Indexed, Eight, &[0, 1, 2, 255]), Format::Png), [0, 256, 512, 65280]);
    assert_eq!(words(&png(Indexed, Four, &[0x01, 0x2f]), Format::Png), [0, 256, 512, 3840]);
    let colours = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12];
    assert_eq!(words(&png(Rgb, Eight, &colours), Format::Png), [0x0102, 0x0405, 0x0708, 0x0a0b]);
    let with_alpha = [1, 0, 2, 0, 3, 0, 4, 0];
    assert_eq!(words(&png(GrayscaleAlpha, Eight, &with_alpha), Format::Png), [257, 514, 771, 1028]);
}

#[test]
fn the_right_half_of_a_pot_file_holds_the_low_bytes() {
    // Indices 1, 2, 3, 4 and 5, 0, 6, 7.
    let bytes = b"\x47\x49\x46\x38\x37\x61\x04\x00\x02\x00\x82\x00\x00\x00\x00\x00\x01\x01\x01\x02\x02\x02\x03\x03\x03\x04\x04\x04\x05\x05\x05\x06\x06\x06\x07\x07\x07\x2c\x00\x00\x00\x00\x04\x00\x02\x00\x00\x08\x0c\x00\x03\x08\x18\x40\xa0\x00\x00\x03\x07\x02\x02\x00\x3b";
    assert_eq!(words(bytes, Format::Gif)[..4], [0x0100, 0x0200, 0x0300, 0x0400]);
    assert_eq!(words(bytes, Format::Pot), [0x0103, 0x0204, 0x0506, 0x0007]);
    assert_eq!(refused(b"P2 1 1", Format::Pot), "is not a POT file");
}
