//! Values of data file elements in JSON, and the words they stand for.
//!
//! A value is what a person reads (`{"EN":0,...,"PRE":100,"ACC":0}`, `1.5`, `"text"`); some words
//! hold more than that (spare bits of a control word, characters after the end of a string, the
//! payload of a not-a-number). [`words_of`] is the one rule from value to words: the writer applies
//! it to its own output, and where the words differ it lists them beside the values.

use std::borrow::Cow;
use std::fmt;

use super::path::quoted;
use ladder::{DataFile, FileType, TimeBase, Value, members_of};
use serde::de::{Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde::ser::{SerializeMap, Serializer};
use serde::{Deserialize, Serialize};

/// The value of one element.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ElementDoc<'a> {
    /// The file ends inside this element.
    Missing,
    Integer(i64),
    Float(f64),
    Text(Cow<'a, str>),
    /// Words of a structure without named values.
    Words(Vec<i16>),
    /// Members of timers, counters and control elements.
    Members(Vec<(Cow<'a, str>, MemberDoc<'a>)>),
}

/// The value of one member.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum MemberDoc<'a> {
    Null,
    Integer(i64),
    Text(Cow<'a, str>),
}

/// The member of a timer that is no bit and no word: its time base in seconds.
const BASE: &str = "base";
const NOT_A_NUMBER: &str = "NaN";
const INFINITE: [(&str, f32); 2] = [("Infinity", f32::INFINITY), ("-Infinity", f32::NEG_INFINITY)];

/// Words of a string element: the length and 82 characters.
const STRING_WORDS: usize = 42;

/// Elements written as an object of their members.
fn has_members(file_type: FileType) -> bool {
    matches!(file_type, FileType::T | FileType::C | FileType::R)
}

/// The value of an element as JSON shows it.
pub(super) fn value_of(file: &DataFile, element: u16) -> ElementDoc<'static> {
    match file.value(element) {
        None => ElementDoc::Missing,
        Some(Value::Float(value)) => float(value),
        Some(Value::Long(value)) => ElementDoc::Integer(value.into()),
        Some(Value::Text(text)) if file.words_per_element as usize == STRING_WORDS => ElementDoc::Text(text.into()),
        Some(Value::Word(word)) if file.file_type.words_per_element() == Some(1) => ElementDoc::Integer(word.into()),
        Some(Value::Timer(_) | Value::Counter(_) | Value::Control(_)) => members(file, element),
        Some(_) => {
            ElementDoc::Words(file.element_words(element).unwrap_or_default().iter().map(|w| *w as i16).collect())
        }
    }
}

/// A float with the shortest digits that give the same 32 bits.
fn float(value: f32) -> ElementDoc<'static> {
    if value.is_nan() {
        return ElementDoc::Text(NOT_A_NUMBER.into());
    }
    match INFINITE.iter().find(|(_, infinite)| *infinite == value) {
        Some((name, _)) => ElementDoc::Text((*name).into()),
        // The double nearest to those digits prints as those digits; the widened float would not.
        None => ElementDoc::Float(value.to_string().parse().unwrap_or_else(|_| f64::from(value))),
    }
}

fn members(file: &DataFile, element: u16) -> ElementDoc<'static> {
    let words = file.element_words(element).unwrap_or_default();
    let word = |index: u16| words.get(usize::from(index)).copied().unwrap_or_default();
    let mut members = Vec::with_capacity(10);
    let mut flags_done = false;
    for member in members_of(file.file_type) {
        let value = match member.bit {
            Some(bit) => i64::from(word(member.word) >> bit & 1),
            None => {
                if file.file_type == FileType::T && !std::mem::replace(&mut flags_done, true) {
                    let base = TimeBase::from_control(word(0));
                    let text = base.map_or(MemberDoc::Null, |base| MemberDoc::Text(base.text().into()));
                    members.push((BASE.into(), text));
                }
                i64::from(word(member.word) as i16)
            }
        };
        members.push((member.name.into(), MemberDoc::Integer(value)));
    }
    ElementDoc::Members(members)
}

/// Why a value has no words.
#[derive(Debug)]
pub(super) struct ValueError {
    /// Member of the value, or empty.
    pub(super) member: String,
    pub(super) expected: String,
    pub(super) found: String,
}

fn mismatch(expected: impl Into<String>, found: impl Into<String>) -> ValueError {
    ValueError { member: String::new(), expected: expected.into(), found: found.into() }
}

/// The words of an element of this type. A missing element has none.
pub(super) fn words_of(file_type: FileType, value: &ElementDoc<'_>, words: &mut Vec<u16>) -> Result<(), ValueError> {
    match (file_type, value) {
        (_, ElementDoc::Missing) => {}
        (_, ElementDoc::Words(list)) => words.extend(list.iter().map(|w| *w as u16)),
        (FileType::F, ElementDoc::Integer(value)) => push_long(words, (*value as f32).to_bits()),
        (FileType::F, ElementDoc::Float(value)) => push_long(words, finite(*value)?.to_bits()),
        (FileType::F, ElementDoc::Text(text)) => {
            let named = INFINITE.iter().find(|(name, _)| name == text).map(|(_, value)| *value);
            let value = named.or_else(|| (text == NOT_A_NUMBER).then_some(f32::NAN));
            push_long(
                words,
                value.ok_or_else(|| mismatch("a number, NaN, Infinity or -Infinity", quoted(text)))?.to_bits(),
            );
        }
        (FileType::L, ElementDoc::Integer(value)) => {
            let long = i32::try_from(*value).map_err(|_| mismatch("a signed 32-bit integer", value.to_string()))?;
            push_long(words, long as u32);
        }
        (FileType::ST, ElementDoc::Text(text)) => string(text, words)?,
        (_, ElementDoc::Integer(value)) if file_type.words_per_element() == Some(1) => words.push(word(*value)?),
        (_, ElementDoc::Members(members)) if has_members(file_type) => structure(file_type, members, words)?,
        (_, other) => return Err(mismatch(wanted(file_type), other.kind())),
    }
    Ok(())
}

fn wanted(file_type: FileType) -> &'static str {
    match file_type {
        FileType::F => "a number, NaN, Infinity or -Infinity",
        FileType::L => "a signed 32-bit integer",
        FileType::ST => "a string",
        _ if has_members(file_type) => "an object with the members of the element",
        _ if file_type.words_per_element() == Some(1) => "a signed 16-bit integer",
        _ => "an array of signed 16-bit integers",
    }
}

fn push_long(words: &mut Vec<u16>, value: u32) {
    words.extend([value as u16, (value >> 16) as u16]);
}

fn word(value: i64) -> Result<u16, ValueError> {
    i16::try_from(value).map(|w| w as u16).map_err(|_| mismatch("a signed 16-bit integer", value.to_string()))
}

fn finite(value: f64) -> Result<f32, ValueError> {
    let single = value as f32;
    if single.is_finite() { Ok(single) } else { Err(mismatch("a 32-bit float", value.to_string())) }
}

/// Length and characters; what Windows-1252 does not have is no character of a string.
fn string(text: &str, words: &mut Vec<u16>) -> Result<(), ValueError> {
    let capacity = (STRING_WORDS - 1) * 2;
    let mut bytes = Vec::with_capacity(capacity);
    for character in text.chars() {
        let byte = rss::text::encode_char(character);
        bytes.push(byte.ok_or_else(|| mismatch("characters of Windows-1252", format!("{character:?}")))?);
        if bytes.len() > capacity {
            return Err(mismatch(format!("at most {capacity} characters"), "more"));
        }
    }
    words.push(u16::try_from(bytes.len()).unwrap_or_default());
    bytes.resize(capacity, 0);
    words.extend(bytes.chunks_exact(2).map(|pair| match pair {
        [high, low] => u16::from_be_bytes([*high, *low]),
        _ => 0,
    }));
    Ok(())
}

fn structure(
    file_type: FileType,
    members: &[(Cow<'_, str>, MemberDoc<'_>)],
    words: &mut Vec<u16>,
) -> Result<(), ValueError> {
    let mut element = [0u16; 3];
    let mut seen: Vec<&str> = Vec::with_capacity(members.len());
    for (name, value) in members {
        let at = |error: ValueError| ValueError { member: name.to_string(), ..error };
        if seen.contains(&name.as_ref()) {
            return Err(at(mismatch("each member once", "it again")));
        }
        seen.push(name);
        if file_type == FileType::T && name == BASE {
            element[0] |= time_base(value).map_err(at)?.map_or(0x0300, TimeBase::control_bits);
            continue;
        }
        let Some(member) = members_of(file_type).find(|member| member.name == name) else {
            return Err(at(mismatch("a member of the element", "an unknown member")));
        };
        let MemberDoc::Integer(number) = value else {
            return Err(at(mismatch("an integer", value.kind())));
        };
        let Some(slot) = element.get_mut(usize::from(member.word)) else { continue };
        match member.bit {
            None => *slot = word(*number).map_err(at)?,
            Some(bit) if matches!(number, 0 | 1) => *slot |= (*number as u16) << bit,
            Some(_) => return Err(at(mismatch("0 or 1", number.to_string()))),
        }
    }
    let base = (file_type == FileType::T).then_some(BASE);
    let all = members_of(file_type).map(|member| member.name).chain(base);
    if let Some(absent) = all.into_iter().find(|name| !seen.contains(name)) {
        return Err(mismatch(format!("member {absent}"), "none"));
    }
    words.extend(element);
    Ok(())
}

fn time_base(value: &MemberDoc<'_>) -> Result<Option<TimeBase>, ValueError> {
    match value {
        MemberDoc::Null => Ok(None),
        MemberDoc::Text(text) => match TimeBase::from_text(text) {
            Some(base) => Ok(Some(base)),
            None => Err(mismatch("a time base: 1.0, 0.01 or 0.001", quoted(text))),
        },
        MemberDoc::Integer(_) => Err(mismatch("a time base in a string", value.kind())),
    }
}

impl ElementDoc<'_> {
    fn kind(&self) -> &'static str {
        match self {
            ElementDoc::Missing => "null",
            ElementDoc::Integer(_) => "an integer",
            ElementDoc::Float(_) => "a number",
            ElementDoc::Text(_) => "a string",
            ElementDoc::Words(_) => "an array",
            ElementDoc::Members(_) => "an object",
        }
    }
}

impl MemberDoc<'_> {
    fn kind(&self) -> &'static str {
        match self {
            MemberDoc::Null => "null",
            MemberDoc::Integer(_) => "an integer",
            MemberDoc::Text(_) => "a string",
        }
    }
}

impl Serialize for ElementDoc<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            ElementDoc::Missing => serializer.serialize_unit(),
            ElementDoc::Integer(value) => serializer.serialize_i64(*value),
            ElementDoc::Float(value) => serializer.serialize_f64(*value),
            ElementDoc::Text(text) => serializer.serialize_str(text),
            ElementDoc::Words(words) => words.serialize(serializer),
            ElementDoc::Members(members) => {
                let mut map = serializer.serialize_map(Some(members.len()))?;
                for (name, value) in members {
                    map.serialize_entry(name, value)?;
                }
                map.end()
            }
        }
    }
}

impl Serialize for MemberDoc<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            MemberDoc::Null => serializer.serialize_unit(),
            MemberDoc::Integer(value) => serializer.serialize_i64(*value),
            MemberDoc::Text(text) => serializer.serialize_str(text),
        }
    }
}

fn signed<E: serde::de::Error>(value: u64) -> Result<i64, E> {
    i64::try_from(value).map_err(|_| E::custom(format!("invalid value: integer `{value}`, expected a 64-bit integer")))
}

struct ElementVisitor;

impl<'de> Visitor<'de> for ElementVisitor {
    type Value = ElementDoc<'static>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the value of an element: null, a number, a string, an array of words or an object of members")
    }
    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(ElementDoc::Missing)
    }
    fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
        Ok(ElementDoc::Integer(value))
    }
    fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Self::Value, E> {
        signed(value).map(ElementDoc::Integer)
    }
    fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
        Ok(ElementDoc::Float(value))
    }
    fn visit_str<E>(self, text: &str) -> Result<Self::Value, E> {
        Ok(ElementDoc::Text(text.to_owned().into()))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Self::Value, A::Error> {
        let mut words = Vec::new();
        while let Some(word) = sequence.next_element()? {
            words.push(word);
        }
        Ok(ElementDoc::Words(words))
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut members = Vec::new();
        while let Some((name, value)) = map.next_entry::<String, MemberDoc<'static>>()? {
            // No element has more members; a document cannot make the list longer.
            if members.len() >= 16 {
                return Err(A::Error::custom("invalid length: more members, expected at most 16 members"));
            }
            members.push((Cow::Owned(name), value));
        }
        Ok(ElementDoc::Members(members))
    }
}

impl<'de> Deserialize<'de> for ElementDoc<'_> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ElementVisitor)
    }
}

struct MemberVisitor;

impl Visitor<'_> for MemberVisitor {
    type Value = MemberDoc<'static>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the value of a member: null, an integer or a string")
    }
    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(MemberDoc::Null)
    }
    fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
        Ok(MemberDoc::Integer(value))
    }
    fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Self::Value, E> {
        signed(value).map(MemberDoc::Integer)
    }
    fn visit_str<E>(self, text: &str) -> Result<Self::Value, E> {
        Ok(MemberDoc::Text(text.to_owned().into()))
    }
}

impl<'de> Deserialize<'de> for MemberDoc<'_> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(MemberVisitor)
    }
}
