//! A random scene as a tree, which can be written as text and reduced.

use std::fmt::Write as _;

/// A piece of text with other pieces inside: an object, a loop, a clip.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    /// The text up to the first part: `sphere { 0, 1`, `union {`, `#for (I, 0, 3)`.
    pub(super) open: String,
    /// The objects inside.
    pub(super) parts: Vec<Node>,
    /// The modifiers after them, in their order.
    pub(super) said: Vec<Node>,
    /// `}`, `]` or `#end`; empty for plain text.
    pub(super) close: &'static str,
    /// The least number of parts with which the node is valid. `NEEDED` for a modifier without parts
    /// that stays where it is.
    pub(super) least: usize,
}

/// The mark of a modifier that cannot be removed, such as an item of a list.
pub(super) const NEEDED: usize = usize::MAX;

impl Node {
    pub(super) fn text(text: impl Into<String>) -> Self {
        Self { open: text.into(), parts: Vec::new(), said: Vec::new(), close: "", least: 0 }
    }

    /// A block with parts, of which it needs so many.
    pub(super) fn block(open: impl Into<String>, parts: Vec<Self>, least: usize) -> Self {
        Self { open: open.into(), parts, said: Vec::new(), close: "}", least }
    }

    /// An entry of a map.
    pub(super) fn entry(open: String, said: Vec<Self>) -> Self {
        Self { open, parts: Vec::new(), said, close: "]", least: 0 }
    }

    /// The text in one line.
    pub(super) fn line(&self) -> String {
        let mut text = String::new();
        self.write(&mut text, 0);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    fn write(&self, text: &mut String, depth: usize) {
        let lead = "  ".repeat(depth);
        let _ = write!(text, "{lead}{}", self.open);
        if self.parts.is_empty() && self.said.iter().all(|s| s.close.is_empty()) {
            for said in &self.said {
                let _ = write!(text, " {}", said.open);
            }
            let _ = writeln!(text, "{}{}", if self.close.is_empty() { "" } else { " " }, self.close);
            return;
        }
        text.push('\n');
        self.parts.iter().chain(&self.said).for_each(|part| part.write(text, depth + 1));
        let _ = writeln!(text, "{lead}{}", self.close);
    }

    /// Calls a function with this node and every node in it.
    pub(super) fn each(&mut self, call: &mut impl FnMut(&mut Self)) {
        call(self);
        self.parts.iter_mut().chain(&mut self.said).for_each(|node| node.each(call));
    }

    /// The number of nodes in it.
    pub(super) fn size(&self) -> usize {
        1 + self.parts.iter().chain(&self.said).map(Self::size).sum::<usize>()
    }
}

/// A scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scene {
    /// Settings, defaults, background.
    pub(super) settings: Vec<Node>,
    pub(super) camera: Node,
    pub(super) lights: Vec<Node>,
    /// Declarations of objects and macros.
    pub(super) declared: Vec<Node>,
    pub(super) objects: Vec<Node>,
}

impl Scene {
    /// The text of the scene's file.
    pub(super) fn text(&self) -> String {
        let mut text = String::from("#version 3.7;\n");
        let all = self.settings.iter().chain([&self.camera]).chain(&self.lights);
        all.chain(&self.declared).chain(&self.objects).for_each(|node| node.write(&mut text, 0));
        text
    }

    /// The scene, moved by a little with its camera: everything keeps its place in the picture.
    pub(super) fn moved(&self) -> Self {
        let mut moved = self.clone();
        let by = Node::text("translate <0.00123, 0.00217, 0.00331>");
        for node in moved.lights.iter_mut().chain(&mut moved.objects) {
            let node = if node.close == "#end" { &mut node.parts[0] } else { node };
            node.said.push(by.clone());
        }
        if moved.camera.close.is_empty() {
            moved.camera.open = moved.camera.open.replacen(" }", &format!(" {} }}", by.open), 1);
        } else {
            moved.camera.said.push(by);
        }
        moved
    }

    /// The number of nodes in it.
    pub(super) fn size(&self) -> usize {
        let all = self.settings.iter().chain([&self.camera]).chain(&self.lights);
        all.chain(&self.declared).chain(&self.objects).map(Node::size).sum()
    }
}
