//! `cargo xtask gallery`: makes the page of the scenes in scenes/, each with its equation, source
//! and picture.

use crate::Outcome;
use crate::command::{Durer, Shot, root};
use crate::scenes::{self, Scene};
use std::fmt::Write as _;

/// The picture on the README's first page. In the gallery it is also first, and larger.
const MASTERPIECE: &str = "melencolia";

/// The width of the pictures in the contact sheet at the head of the page.
const THUMBNAIL: u32 = 150;

/// Renders all scenes, or the named ones, and writes the page of all scenes.
pub(crate) fn run(names: &[String]) -> Outcome {
    let folder = root().join("docs/gallery");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let durer = Durer::build()?;
    for scene in scenes::list(&root().join("scenes"), names)? {
        let (width, height) = size(&scene);
        println!("==> {} {width}x{height}", scene.name);
        let picture = folder.join(format!("{}.png", scene.name));
        durer.render(&scene.path, &picture, Shot { width, height, aa: "4x4", threads: None })?;
    }
    let mut scenes = scenes::list(&root().join("scenes"), &[])?;
    scenes.sort_by_key(|s| s.name != MASTERPIECE);
    let page = root().join("docs/gallery.md");
    std::fs::write(&page, document(&scenes)).map_err(|e| format!("{}: {e}", page.display()))
}

fn size(scene: &Scene) -> (u32, u32) {
    if scene.name == MASTERPIECE { (1024, 768) } else { (400, 300) }
}

/// The text of docs/gallery.md.
fn document(scenes: &[Scene]) -> String {
    let mut text = String::from(
        "# Gallery\n\n\
         One scene per surface, and a composition. Written by `cargo xtask gallery` from the files in \
         [scenes](../scenes); each renders with `durer render scenes/NAME.pov`.\n\n",
    );
    for scene in scenes {
        let title = &scene.header.title;
        let _ = writeln!(
            text,
            "<a href=\"#{}\"><img src=\"gallery/{}.png\" width=\"{THUMBNAIL}\" alt=\"{title}\" title=\"{title}\"></a>",
            anchor(title),
            scene.name
        );
    }
    for scene in scenes {
        let (width, height) = size(scene);
        let _ = write!(text, "\n## {}\n\n", scene.header.title);
        for equation in &scene.header.equations {
            let _ = write!(text, "> `{equation}`\n\n");
        }
        let _ = write!(
            text,
            "{}\n\n<img src=\"gallery/{}.png\" width=\"{width}\" height=\"{height}\" alt=\"{}\">\n\n",
            scene.header.description, scene.name, scene.header.title
        );
        let source = body(&scene.text);
        let _ = write!(
            text,
            "<details>\n<summary>scenes/{}.pov</summary>\n\n```pov\n{source}\n```\n\n</details>\n",
            scene.name
        );
    }
    text
}

/// The text after the comment at the head of a scene.
fn body(text: &str) -> &str {
    let head: usize =
        text.split_inclusive('\n').take_while(|line| line.starts_with("//")).map(str::len).sum();
    text[head..].trim()
}

/// The name of a heading in links: lower case, dashes for spaces, no punctuation.
fn anchor(title: &str) -> String {
    let kept = title.chars().filter(|c| c.is_alphanumeric() || *c == ' ' || *c == '-');
    kept.map(|c| if c == ' ' { '-' } else { c }).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_source_is_shown_without_its_head() {
        assert_eq!(body("// Title\n//\n// Words.\n\nsphere { 0, 1 }\n"), "sphere { 0, 1 }");
    }

    #[test]
    fn anchors_are_what_the_page_makes_of_headings() {
        assert_eq!(anchor("Hyperboloid of one sheet"), "hyperboloid-of-one-sheet");
        assert_eq!(anchor("Melencolia (1514)"), "melencolia-1514");
    }
}
