//! What belongs together on both sides, for whoever runs them scan by scan: names, values, and the comparison a
//! proof makes.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Address, FileType, Image, Value};

use super::inputs::{Inputs, clock_field};
use super::pairs::{Mapping, Pairs};
use super::play::{Both, Difference, compare};
use super::report::Report;
use super::side::{DoMore, Kind, Side, Slc};
use super::{Options, RungFate, scenario};
use crate::CrossReference;

/// A machine of either dialect, to look at.
#[derive(Clone, Copy)]
pub enum AnySide<'s> {
    /// SLC 500 or MicroLogix.
    Slc(&'s Slc),
    /// Do-more.
    DoMore(&'s DoMore),
}

/// A machine of either dialect, to write to.
pub enum AnySideMut<'s> {
    /// SLC 500 or MicroLogix.
    Slc(&'s mut Slc),
    /// Do-more.
    DoMore(&'s mut DoMore),
}

/// Data the original names, and where the other program has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Address of the original.
    pub original: String,
    /// Address of the other program.
    pub other: String,
    /// What stands there.
    pub kind: Kind,
    /// All of it is compared after every scan. Otherwise it depends on rungs left to a person, or each controller
    /// keeps it for itself.
    pub compared: bool,
    /// First bits on both sides.
    places: (u32, u32),
}

/// Two programs side by side.
#[derive(Debug)]
pub struct Pairing {
    pairs: Pairs,
    rows: Vec<Row>,
    /// Original, other, value: what makes both begin alike.
    start: Vec<(String, String, Value)>,
    /// Addresses without a place on both sides, with why.
    unmapped: Vec<(String, String)>,
    incomparable: Vec<String>,
}

impl Pairing {
    /// Finds what belongs together, by the rules of a proof run. Both machines hold the data of their projects and
    /// have not run. `fates` is as in [`super::prove_domore`].
    pub fn new(image: &Image, a: &Slc, b: AnySide<'_>, map: &[Mapping], fates: Option<&[RungFate]>) -> Pairing {
        match b {
            AnySide::Slc(b) => Pairing::of(image, a, b, map, fates),
            AnySide::DoMore(b) => Pairing::of(image, a, b, map, fates),
        }
    }

    fn of<B: Side>(image: &Image, a: &Slc, b: &B, map: &[Mapping], fates: Option<&[RungFate]>) -> Pairing {
        let xref = CrossReference::build(image, &image.documentation);
        let mut report = Report::empty(&Options::default());
        let pairs = super::pairs(image, &xref, (a, b), map, fates, &mut report);
        let inputs = Inputs::new(image, &xref, a, b, &pairs);
        report.take_map(&pairs, &inputs.left_out);
        let presets = super::start(&mut Both { a: a.fork(), b: b.fork() }, &inputs, &pairs);
        let start = presets.into_iter().map(|preset| (preset.original, preset.other, shown(preset.kind, preset.value)));
        let rows = rows(&xref, a, b, &pairs);
        Pairing { start: start.collect(), rows, pairs, unmapped: report.unmapped, incomparable: report.incomparable }
    }

    /// Data the original names, in the order of its cross reference.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// What must be written on both sides before they enter run for the first time, so that they begin alike: address
    /// of the original, of the other program, value.
    pub fn start(&self) -> &[(String, String, Value)] {
        &self.start
    }

    /// Addresses the original uses that have no place on both sides, with why: nothing is known of them.
    pub fn unmapped(&self) -> &[(String, String)] {
        &self.unmapped
    }

    /// Why parts, or the whole, cannot be compared.
    pub fn incomparable(&self) -> &[String] {
        &self.incomparable
    }

    /// How the other program spells an address of the original.
    ///
    /// # Errors
    /// There is no such address, or it has no place there.
    pub fn other(&self, a: &Slc, address: &str) -> Result<String, String> {
        let (at, kind) = a.place(address)?;
        let parsed = Address::parse(address).map_err(|error| error.to_string())?;
        if kind == Kind::Text {
            return self.pairs.other_text(at).ok_or_else(|| nowhere(address));
        }
        let found = self.pairs.other(at, kind);
        let clock = || self.pairs.clock(clock_field(&parsed)?.0, address);
        // The clock is the system's own on both sides, whatever the words of the status file were mapped to.
        if clock_field(&parsed).is_some() { clock() } else { found }.ok_or_else(|| nowhere(address))
    }

    /// How the original spells an address of the other program.
    ///
    /// # Errors
    /// There is no such address, or it is none that the original has: helpers of a conversion.
    pub fn original(&self, a: &Slc, b: AnySide<'_>, address: &str) -> Result<String, String> {
        let place = |text: &str| match b {
            AnySide::Slc(b) => b.place(text),
            AnySide::DoMore(b) => b.place(text),
        };
        let (at, kind) = place(address)?;
        let found = self.pairs.original(at, kind).ok_or_else(|| nowhere(address))?;
        // A bit that was taken out of its word has its own place: the one in the word is nobody's.
        let back = self.other(a, &found).ok().and_then(|other| place(&other).ok());
        if back == Some((at, kind)) { Ok(found) } else { Err(nowhere(address)) }
    }

    /// Writes a value of the original to the place of the other program: the same bits, as a proof run does.
    ///
    /// # Errors
    /// There is no such place, or nobody may write it.
    pub fn write(&self, b: AnySideMut<'_>, other: &str, value: &Value) -> Result<(), String> {
        let bits = match value {
            Value::Bit(on) => u32::from(*on),
            Value::Word(word) => u32::from(*word as u16),
            Value::Long(long) => *long as u32,
            Value::Float(number) => number.to_bits(),
            _ => return Err(format!("{other} takes bits and numbers only")),
        };
        match b {
            AnySideMut::Slc(b) => b.write(&b.target(other)?, bits),
            AnySideMut::DoMore(b) => b.write(&b.target(other)?, bits),
        }
        Ok(())
    }

    /// Compares both sides after a scan that ran on both.
    pub fn compare(&self, a: &Slc, b: AnySide<'_>) -> Option<Difference> {
        let mut buffers = [Vec::new(), Vec::new()];
        match b {
            AnySide::Slc(b) => compare(a, b, &self.pairs, &mut buffers),
            AnySide::DoMore(b) => compare(a, b, &self.pairs, &mut buffers),
        }
    }

    /// The original has stopped, the other program goes on, and a stated condition or a rung left to a person says so:
    /// nothing that follows is a difference.
    pub fn has_left_conditions(&self, a: &Slc, b: AnySide<'_>) -> bool {
        let b = match b {
            AnySide::Slc(b) => b.stopped(),
            AnySide::DoMore(b) => b.stopped(),
        };
        a.stopped().is_some() && b.is_none() && self.pairs_excuse(a)
    }

    fn pairs_excuse(&self, a: &Slc) -> bool {
        self.pairs.stops_unknown || a.machine.fault().is_some_and(|fault| self.pairs.is_stated(fault))
    }

    /// Numbers of the rows whose values differ, those that are not compared left out.
    pub fn differing(&self, a: &Slc, b: AnySide<'_>) -> Vec<u32> {
        let rows = (0..).zip(&self.rows).filter(|(_, row)| row.compared);
        rows.filter(|(_, row)| !alike(row, a, b)).map(|(number, _)| number).collect()
    }

    /// The values of a row on both sides.
    pub fn values(&self, row: usize, a: &Slc, b: AnySide<'_>) -> Option<[Value; 2]> {
        let row = self.rows.get(row)?;
        let other = match b {
            AnySide::Slc(b) => value(b, row.places.1, row.kind),
            AnySide::DoMore(b) => value(b, row.places.1, row.kind),
        };
        Some([value(a, row.places.0, row.kind), other])
    }
}

/// How two sides differ, in the words of a report.
pub(super) fn words(difference: &Difference) -> String {
    scenario::describe(difference)
}

impl std::fmt::Display for Difference {
    /// `O:0.0/1 is 1 in the original, Y1 is 0 in the other program`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&words(self))
    }
}

fn nowhere(address: &str) -> String {
    format!("{address} has no place in both programs")
}

fn alike(row: &Row, a: &Slc, b: AnySide<'_>) -> bool {
    fn same<B: Side>(row: &Row, a: &Slc, b: &B) -> bool {
        let (x, y) = row.places;
        match row.kind {
            Kind::Bit => a.bit(x) == b.bit(y),
            Kind::Word => a.word(x) == b.word(y),
            Kind::Long => bits(a, x) == bits(b, y),
            Kind::Float => {
                let [own, other] = [bits(a, x), bits(b, y)];
                own == other || f32::from_bits(own).is_nan() && f32::from_bits(other).is_nan()
            }
            Kind::Text => text(a, x) == text(b, y),
        }
    }
    match b {
        AnySide::Slc(b) => same(row, a, b),
        AnySide::DoMore(b) => same(row, a, b),
    }
}

fn bits<S: Side>(side: &S, at: u32) -> u32 {
    u32::from(side.word(at)) | u32::from(side.word(at + 16)) << 16
}

fn text<S: Side>(side: &S, at: u32) -> Vec<u8> {
    let mut found = Vec::new();
    side.text(at, &mut found);
    found
}

fn value<S: Side>(side: &S, at: u32, kind: Kind) -> Value {
    match kind {
        Kind::Bit => Value::Bit(side.bit(at)),
        Kind::Word => Value::Word(side.word(at) as i16),
        Kind::Long | Kind::Float => shown(kind, bits(side, at)),
        Kind::Text => Value::Text(text(side, at).iter().map(|byte| char::from(*byte)).collect()),
    }
}

fn shown(kind: Kind, value: u32) -> Value {
    match kind {
        Kind::Bit => Value::Bit(value != 0),
        Kind::Word | Kind::Text => Value::Word(value as u16 as i16),
        Kind::Long => Value::Long(value as i32),
        Kind::Float => Value::Float(f32::from_bits(value)),
    }
}

/// Everything the original names that stands at one place. Structures are told by their members.
fn rows<B: Side>(xref: &CrossReference<'_>, a: &Slc, b: &B, pairs: &Pairs) -> Vec<Row> {
    let masks = pairs.masks();
    let mut seen = BTreeSet::new();
    let mut rows = Vec::new();
    for address in xref.named() {
        let address = Address { indexed: false, ..address.clone() };
        if !address.is_direct() {
            continue;
        }
        let members: &[&str] = match address.file_type {
            FileType::T if is_whole(&address) => &["/EN", "/TT", "/DN", ".PRE", ".ACC"],
            FileType::C if is_whole(&address) => &["/CU", "/CD", "/DN", ".PRE", ".ACC"],
            FileType::R if is_whole(&address) => &["/EN", "/DN", ".LEN", ".POS"],
            _ => &[""],
        };
        for member in members {
            let original = format!("{address}{member}");
            let Ok((at, kind)) = a.place(&original) else { continue };
            let other = if kind == Kind::Text { pairs.other_text(at) } else { pairs.other(at, kind) };
            let (Some(other), Some(beside)) = (other, pairs.beside(at, kind)) else { continue };
            // What the other side cannot name is not shown with a name that leads nowhere.
            if b.place(&other).is_err() || !seen.insert((at, kind)) {
                continue;
            }
            rows.push(Row { original, other, kind, compared: is_compared(&masks, at, kind), places: (at, beside) });
        }
    }
    rows
}

fn is_whole(address: &Address) -> bool {
    address.word.is_none() && address.bit.is_none()
}

fn is_compared(masks: &BTreeMap<u32, u16>, at: u32, kind: Kind) -> bool {
    let mask = |word: u32| masks.get(&word).copied().unwrap_or(0);
    match kind {
        Kind::Bit => mask(at >> 4) >> (at & 15) & 1 != 0,
        Kind::Word => mask(at >> 4) == u16::MAX,
        Kind::Long | Kind::Float => mask(at >> 4) == u16::MAX && mask((at >> 4) + 1) == u16::MAX,
        Kind::Text => mask(at >> 4) != 0,
    }
}
