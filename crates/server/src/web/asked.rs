//! Parts of requests that carry their limits in their type, so that what is beyond them never reaches a handler.
//! The same limits stand in `openapi.json`, which a schema-driven tester compares with what the server does.

use std::fmt::Formatter;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};

/// Largest whole number that JSON carries exactly everywhere.
pub(super) const SAFE: u64 = (1 << 53) - 1;

/// Something that stands in JSON as an object. Without this a list of its parts would do as well.
#[derive(Clone, Debug)]
pub(super) struct Object<T>(pub(super) T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Object<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Parts<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Parts<T> {
            type Value = Object<T>;

            fn expecting(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, parts: A) -> Result<Object<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(parts)).map(Object)
            }
        }
        from.deserialize_map(Parts(PhantomData))
    }
}

/// A whole number from `LEAST` to `MOST`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whole<const LEAST: u64, const MOST: u64>(u64);

impl<const LEAST: u64, const MOST: u64> Whole<LEAST, MOST> {
    pub(super) fn get(self) -> u64 {
        self.0
    }

    /// The same as a count of things in memory.
    pub(super) fn size(self) -> usize {
        usize::try_from(self.0).unwrap_or(usize::MAX)
    }
}

impl<'de, const LEAST: u64, const MOST: u64> Deserialize<'de> for Whole<LEAST, MOST> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        // As any number: 12.0 is whole too, and no whole number up to `SAFE` loses anything on this way.
        let number = f64::deserialize(from)?;
        match number.fract() == 0.0 && (LEAST as f64..=MOST as f64).contains(&number) {
            true => Ok(Whole(number as u64)),
            false => Err(D::Error::custom(format!("expected a whole number from {LEAST} to {MOST}, found {number}"))),
        }
    }
}

/// A text of 1 to `MOST` characters.
#[derive(Clone, Debug)]
pub(super) struct Text<const MOST: usize>(String);

impl<const MOST: usize> Text<MOST> {
    pub(super) fn as_str(&self) -> &str {
        &self.0
    }

    pub(super) fn into_string(self) -> String {
        self.0
    }
}

impl<'de, const MOST: usize> Deserialize<'de> for Text<MOST> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let text = String::deserialize(from)?;
        match text.chars().count() {
            1.. if text.chars().nth(MOST).is_none() => Ok(Text(text)),
            count => Err(D::Error::custom(format!("expected a text of 1 to {MOST} characters, found {count}"))),
        }
    }
}

/// A list of at most `MOST` things.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct List<T, const MOST: usize>(Vec<T>);

impl<T, const MOST: usize> Default for List<T, MOST> {
    fn default() -> Self {
        List(Vec::new())
    }
}

impl<T, const MOST: usize> List<T, MOST> {
    pub(super) fn as_slice(&self) -> &[T] {
        &self.0
    }

    pub(super) fn into_vec(self) -> Vec<T> {
        self.0
    }
}

impl<'de, T: Deserialize<'de>, const MOST: usize> Deserialize<'de> for List<T, MOST> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        // The body is bounded, so the list is too before it is counted.
        let list = Vec::deserialize(from)?;
        match list.len() {
            count if count <= MOST => Ok(List(list)),
            count => Err(D::Error::custom(format!("expected at most {MOST} entries, found {count}"))),
        }
    }
}

/// An address or a symbol.
pub(super) type Address = Text<200>;

/// A name that a person gives.
pub(super) type Name = Text<200>;
