//! Scopes: names and their values, at the global level, in include files and in macro calls.

use crate::interner::Name;
use crate::value::Value;

/// A variable: the index of a binding in the name's own stack, and an element if it is an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Reference {
    pub(crate) name: Name,
    pub(crate) slot: usize,
    /// The index of the element in its array, then that of the element within this one, and so on.
    pub(crate) path: Vec<usize>,
}

#[derive(Debug)]
enum Content {
    Value(Value),
    /// A macro's parameter that stands for the caller's variable.
    Alias(Reference),
}

#[derive(Debug)]
struct Binding {
    level: u32,
    content: Content,
}

/// All bindings. Level 0 is global; each include file and each macro call adds one.
#[derive(Debug, Default)]
pub(crate) struct Scopes {
    stacks: Vec<Vec<Binding>>,
    /// The names bound in each level above 0.
    levels: Vec<Vec<Name>>,
}

impl Scopes {
    fn stack(&self, name: Name) -> &[Binding] {
        self.stacks.get(name.0 as usize).map_or(&[], Vec::as_slice)
    }

    fn stack_mut(&mut self, name: Name) -> &mut Vec<Binding> {
        let index = name.0 as usize;
        if self.stacks.len() <= index {
            self.stacks.resize_with(index + 1, Vec::new);
        }
        &mut self.stacks[index]
    }

    /// Opens a level.
    pub(crate) fn enter(&mut self) {
        self.levels.push(Vec::new());
    }

    /// Closes the innermost level and removes its names.
    pub(crate) fn leave(&mut self) {
        let level = self.levels.len() as u32;
        for name in self.levels.pop().unwrap_or_default() {
            let stack = self.stack_mut(name);
            if stack.last().is_some_and(|b| b.level == level) {
                stack.pop();
            }
        }
    }

    /// The value of `name` in the innermost level that has it.
    pub(crate) fn get(&self, name: Name) -> Option<&Value> {
        match &self.stack(name).last()?.content {
            Content::Value(value) => Some(value),
            Content::Alias(target) => self.follow(target),
        }
    }

    fn follow(&self, target: &Reference) -> Option<&Value> {
        let Content::Value(value) = &self.stack(target.name).get(target.slot)?.content else { return None };
        target.path.iter().try_fold(value, |value, &i| match value {
            Value::Array(array) => array.items.get(i),
            _ => None,
        })
    }

    /// The variable that `name` refers to; for a parameter, the caller's own.
    pub(crate) fn reference(&self, name: Name) -> Option<Reference> {
        let stack = self.stack(name);
        match &stack.last()?.content {
            Content::Value(_) => Some(Reference { name, slot: stack.len() - 1, path: Vec::new() }),
            Content::Alias(target) => Some(target.clone()),
        }
    }

    /// The variable itself, to be looked at.
    pub(crate) fn at(&self, target: &Reference) -> Option<&Value> {
        self.follow(target)
    }

    /// The variable itself, to be changed.
    pub(crate) fn get_mut(&mut self, target: &Reference) -> Option<&mut Value> {
        let Content::Value(value) = &mut self.stack_mut(target.name).get_mut(target.slot)?.content else {
            return None;
        };
        target.path.iter().try_fold(value, |value, &i| match value {
            Value::Array(array) => std::rc::Rc::make_mut(array).items.get_mut(i),
            _ => None,
        })
    }

    /// Updates the arrays around the element `target`: in the outermost, arrays are now nested
    /// `depth` deep, and the contents of the innermost now take `after` bytes instead of `before`.
    pub(crate) fn element_changed(&mut self, target: &Reference, depth: u32, before: usize, after: usize) {
        for around in 0..target.path.len() {
            let innermost = around + 1 == target.path.len();
            let outer = Reference { path: target.path[..around].to_vec(), ..target.clone() };
            if let Some(Value::Array(array)) = self.get_mut(&outer) {
                let array = std::rc::Rc::make_mut(array);
                array.depth = array.depth.max(depth - around as u32);
                if innermost {
                    array.changed(before, after);
                }
            }
        }
    }

    /// `#declare`: changes the innermost variable of that name, or creates a global one.
    pub(crate) fn declare(&mut self, name: Name, value: Value) {
        let known = self.reference(name);
        if let Some(held) = known.and_then(|target| self.get_mut(&target)) {
            *held = value;
        } else {
            // There is no such name, or it is a parameter whose variable has been undefined since.
            let stack = self.stack_mut(name);
            stack.pop();
            stack.push(Binding { level: 0, content: Content::Value(value) });
        }
    }

    /// `#local`: changes or creates the variable of the innermost level. A parameter remains the
    /// caller's variable.
    pub(crate) fn local(&mut self, name: Name, value: Value) {
        let level = self.levels.len() as u32;
        let here = self.stack(name).last().filter(|b| b.level == level);
        if here.is_some_and(|b| matches!(b.content, Content::Alias(_))) {
            self.declare(name, value);
        } else {
            self.bind(name, Content::Value(value));
        }
    }

    /// Creates the parameter `name` of a macro in the innermost level, in place of any binding of
    /// that name.
    pub(crate) fn parameter(&mut self, name: Name, value: Value) {
        self.bind(name, Content::Value(value));
    }

    /// Makes `name` an alias of `target` in the innermost level.
    pub(crate) fn alias(&mut self, name: Name, target: Reference) {
        self.bind(name, Content::Alias(target));
    }

    fn bind(&mut self, name: Name, content: Content) {
        let level = self.levels.len() as u32;
        let stack = self.stack_mut(name);
        if let Some(here) = stack.last_mut().filter(|b| b.level == level) {
            here.content = content;
            return;
        }
        stack.push(Binding { level, content });
        if let Some(names) = self.levels.last_mut() {
            names.push(name);
        }
    }

    /// `#undef`: removes the innermost variable of that name. Returns `false` if there is none.
    pub(crate) fn undefine(&mut self, name: Name) -> bool {
        let Some(binding) = self.stack_mut(name).pop() else { return false };
        let names = (binding.level as usize).checked_sub(1).and_then(|i| self.levels.get_mut(i));
        if let Some(at) = names.as_ref().and_then(|names| names.iter().position(|&n| n == name)) {
            names.into_iter().for_each(|names| {
                names.swap_remove(at);
            });
        }
        true
    }

    /// Every name with a value, for a hint at a misspelling.
    pub(crate) fn bound(&self) -> impl Iterator<Item = Name> + '_ {
        self.stacks.iter().enumerate().filter(|(_, s)| !s.is_empty()).map(|(i, _)| Name(i as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(scopes: &Scopes, name: Name) -> Option<f64> {
        match scopes.get(name)? {
            Value::Number(terms) => terms.float(),
            _ => None,
        }
    }

    const A: Name = Name(7);
    const P: Name = Name(8);

    fn float(value: f64) -> Value {
        Value::Number(value.into())
    }

    #[test]
    fn locals_hide_globals_and_go() {
        let mut scopes = Scopes::default();
        scopes.declare(A, float(1.0));
        scopes.enter();
        scopes.local(A, float(2.0));
        scopes.declare(A, float(3.0));
        assert_eq!(number(&scopes, A), Some(3.0));
        scopes.leave();
        assert_eq!(number(&scopes, A), Some(1.0));
    }

    #[test]
    fn a_parameter_is_the_callers_variable() {
        let mut scopes = Scopes::default();
        scopes.declare(A, float(1.0));
        let target = scopes.reference(A).unwrap();
        scopes.enter();
        scopes.alias(P, target);
        scopes.declare(P, float(5.0));
        scopes.leave();
        assert_eq!(number(&scopes, A), Some(5.0));
        assert_eq!(number(&scopes, P), None);
    }

    #[test]
    fn undef_uncovers_what_was_hidden() {
        let mut scopes = Scopes::default();
        scopes.declare(A, float(1.0));
        scopes.enter();
        scopes.local(A, float(2.0));
        assert!(scopes.undefine(A));
        assert_eq!(number(&scopes, A), Some(1.0));
        scopes.leave();
        assert_eq!(number(&scopes, A), Some(1.0));
        assert!(scopes.undefine(A) && !scopes.undefine(A));
    }
}
