//! Files that stand in for some of those that come with POV-Ray, where POV-Ray is not installed.

/// Standard include files: colours, finishes and shapes.
const INCLUDES: [(&str, &str); 3] = [
    ("colors.inc", include_str!("../include/colors.inc")),
    ("finish.inc", include_str!("../include/finish.inc")),
    ("shapes.inc", include_str!("../include/shapes.inc")),
];

/// POV-Ray's fonts of letters.
const FONTS: [&str; 3] = ["timrom", "cyrvetic", "crystal"];

/// Liberation Serif, under the SIL Open Font License 1.1.
const FONT: &[u8] = include_bytes!("../fonts/LiberationSerif-Regular.ttf");

/// The text of the include file `name`, in any case of letters.
pub(crate) fn include(name: &str) -> Option<&'static str> {
    INCLUDES.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|&(_, text)| text)
}

/// The font that stands in for the file `name`, whose ending may be left out.
pub(crate) fn font(name: &str) -> Option<&'static [u8]> {
    let lower = name.to_ascii_lowercase();
    FONTS.contains(&lower.strip_suffix(".ttf").unwrap_or(&lower)).then_some(FONT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_in_any_case_and_fonts_without_their_ending() {
        assert!(include("Colors.INC").is_some_and(|text| text.contains("#declare SkyBlue")));
        assert!(include("woods.inc").is_none());
        for name in ["timrom.ttf", "TimRom", "cyrvetic.ttf", "crystal"] {
            let face = ttf_parser::Face::parse(font(name).unwrap(), 0).unwrap();
            assert!("AZaz09&äßΩЖ".chars().all(|letter| face.glyph_index(letter).is_some()));
        }
        assert!(font("povlogo.ttf").is_none());
    }
}
