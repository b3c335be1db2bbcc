//! The operand texts of an instruction, without an allocation for the most common number of them.

use crate::text::Text;
use std::fmt;
use std::ops::{Deref, DerefMut};

/// A list of operand texts; use it as the slice it derefs to.
///
/// Two of three instructions are contacts and coils with one operand, so one
/// operand is held in place.
#[derive(Clone)]
pub struct Operands<'a>(Repr<'a>);

#[derive(Clone)]
enum Repr<'a> {
    One(Text<'a>),
    Many(Box<[Text<'a>]>),
}

impl Operands<'_> {
    /// No operand.
    pub(super) fn none() -> Self {
        Operands(Repr::Many(Box::default()))
    }
}

impl<'a> Operands<'a> {
    /// One operand.
    #[must_use]
    pub const fn one(text: Text<'a>) -> Self {
        Operands(Repr::One(text))
    }
}

impl Default for Operands<'_> {
    fn default() -> Self {
        Operands::none()
    }
}

impl<'a> Deref for Operands<'a> {
    type Target = [Text<'a>];

    fn deref(&self) -> &[Text<'a>] {
        match &self.0 {
            Repr::One(text) => std::slice::from_ref(text),
            Repr::Many(texts) => texts,
        }
    }
}

impl<'a> DerefMut for Operands<'a> {
    fn deref_mut(&mut self) -> &mut [Text<'a>] {
        match &mut self.0 {
            Repr::One(text) => std::slice::from_mut(text),
            Repr::Many(texts) => texts,
        }
    }
}

impl<'a> From<Vec<Text<'a>>> for Operands<'a> {
    fn from(mut texts: Vec<Text<'a>>) -> Self {
        match (texts.len(), texts.pop()) {
            (1, Some(text)) => Operands::one(text),
            (_, last) => {
                texts.extend(last);
                Operands(Repr::Many(texts.into_boxed_slice()))
            }
        }
    }
}

impl<'a> FromIterator<Text<'a>> for Operands<'a> {
    fn from_iter<I: IntoIterator<Item = Text<'a>>>(texts: I) -> Self {
        texts.into_iter().collect::<Vec<_>>().into()
    }
}

impl<'o, 'a> IntoIterator for &'o Operands<'a> {
    type Item = &'o Text<'a>;
    type IntoIter = std::slice::Iter<'o, Text<'a>>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl PartialEq for Operands<'_> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl Eq for Operands<'_> {}

impl fmt::Debug for Operands<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_texts_is_a_slice_of_them() {
        let texts = [Text::from_bytes(b"T4:0"), Text::from_bytes(b"1.0"), Text::from_bytes(b"100")];
        for n in 0..=3 {
            let operands: Operands<'_> = texts[..n].iter().cloned().collect();
            assert_eq!(operands.len(), n);
            assert_eq!(&operands[..], &texts[..n]);
        }
        assert_eq!(Operands::from(vec![texts[0].clone()]), Operands::one(texts[0].clone()));
        assert_eq!(size_of::<Operands>(), 24);
    }
}
