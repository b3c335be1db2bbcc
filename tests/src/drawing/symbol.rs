//! The shapes that stand in the gaps of a wire: contacts, brackets, coils and boxes, with their texts.

use super::page::{Colour, Fill, Stroke, Text};
use super::sheet::Sheet;
use super::{ROW, near};

/// How an instruction is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// `] [`, or with a slash.
    Contact,
    /// `[ ]` around a mnemonic: LBL, ONS.
    Bracket,
    /// `( )`, empty or around a mnemonic.
    Coil,
    /// A box with its mnemonic in the upper edge.
    Box,
}

/// An instruction as drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Instruction {
    /// The shape.
    pub shape: Shape,
    /// The printed mnemonic. XIC, XIO and OTE, which carry none, are told by their shape;
    /// OTL and OTU are printed as `L` and `U`.
    pub mnemonic: String,
    /// What stands above a contact or coil: the address, for a bit of a word its word.
    pub above: Option<String>,
    /// What stands right below a contact or coil: the bit number or name.
    pub below: Option<String>,
    /// Further below: the module of an input or output.
    pub module: Option<String>,
    /// The symbol on green.
    pub symbol: Vec<String>,
    /// The description lines on pale yellow, from top to bottom.
    pub description: Vec<String>,
    /// Green lies behind the wire at it: RSLogix shows it as true.
    pub lit: bool,
    /// First line in a box: `Timer On Delay`.
    pub title: Option<String>,
    /// Rows of a box.
    pub fields: Vec<Field>,
}

/// A parameter in a box.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Field {
    /// The label in blue, empty for a row without.
    pub label: String,
    /// What stands beside the label; with `<` behind it if it is a live value.
    pub text: String,
    /// What stands in the rows below without a label of their own: the live value.
    pub values: Vec<String>,
}

impl Instruction {
    /// The operands: address with bit for contacts and coils, the texts beside the labels for boxes.
    #[must_use]
    pub fn operands(&self) -> Vec<String> {
        if self.shape == Shape::Box {
            return self.fields.iter().map(|f| f.text.clone()).filter(|t| !t.is_empty()).collect();
        }
        match (&self.above, &self.below) {
            (Some(word), Some(bit)) => vec![format!("{word}/{bit}")],
            (Some(address), None) => vec![address.clone()],
            (None, Some(bit)) => vec![format!("/{bit}")],
            (None, None) => Vec::new(),
        }
    }
}

/// A recognised shape and where the wire goes on behind it.
pub(super) struct Found {
    pub(super) instruction: Instruction,
    /// The right end of the shape itself.
    pub(super) end: f64,
}

/// What stands on the wire at height `y` between `left`, where the wire breaks off,
/// and `right`, where it begins again.
pub(super) fn recognise(sheet: &Sheet, left: f64, right: f64, y: f64) -> Option<Found> {
    if let Some(lower) = box_bottom(sheet, left, y) {
        return read_box(sheet, left, y, lower);
    }
    let middle = f64::midpoint(left, right);
    let (shape, bare) = match ends(sheet, left, y)? {
        Ends::Outward if slashed(sheet, left, right, y) => (Shape::Contact, "XIO"),
        Ends::Outward => (Shape::Contact, "XIC"),
        Ends::Inward => (Shape::Bracket, "[ ]"),
        Ends::Round => (Shape::Coil, "OTE"),
    };
    let at = |row: f64| centred(sheet, middle, row.mul_add(ROW, y));
    let inner = inside(sheet, left, right, y).map(|text| match text.as_str() {
        "L" => "OTL".to_owned(),
        "U" => "OTU".to_owned(),
        _ => text,
    });
    let bottom = at(1.0);
    // Below a label or a coil on a whole element stands no bit number but the module at once.
    let (below, module) = (bottom, at(2.0));
    let (symbol, description) = documentation(sheet, middle, y);
    let instruction = Instruction {
        shape,
        mnemonic: inner.unwrap_or_else(|| bare.to_owned()),
        above: at(-1.0),
        below,
        module,
        symbol,
        description,
        lit: lit(sheet, left, y),
        title: None,
        fields: Vec::new(),
    };
    Some(Found { instruction, end: right })
}

/// Whether a coil is only the flag of a box (`EN`, `DN`), drawn right of it: nothing stands above a flag.
pub(super) fn is_flag(instruction: &Instruction) -> bool {
    instruction.shape == Shape::Coil && instruction.above.is_none() && instruction.mnemonic != "OTE"
}

enum Ends {
    Outward,
    Inward,
    Round,
}

/// Contacts and brackets end the wire with an upright bar; what is at its ends tells which.
fn ends(sheet: &Sheet, x: f64, y: f64) -> Option<Ends> {
    let half = ROW / 2.0;
    let upright = |s: &&Stroke| near(s.x0, x) && near(s.x1, x) && s.y0 < y - 4.0 && s.y1 < y + half + 1.0;
    if sheet.strokes.iter().any(|s| upright(&s) && s.y1 > y + 4.0) {
        let hook = |s: &&Stroke| near(s.y0, s.y1) && (s.y0 - y).abs() < half + 1.0 && (s.y0 - y).abs() > 4.0;
        let mut hooks = sheet.strokes.iter().filter(hook);
        return hooks.find_map(
            |s| {
                if near(s.x1, x) { Some(Ends::Outward) } else { near(s.x0, x).then_some(Ends::Inward) }
            },
        );
    }
    let round = |s: &Stroke| near(s.x0, x) && near(s.x1, x) && s.y0 < y && s.y1 > y && s.y1 - s.y0 < half;
    sheet.strokes.iter().any(round).then_some(Ends::Round)
}

/// The slash of an XIO runs over the gap from one hook to the other.
fn slashed(sheet: &Sheet, left: f64, right: f64, y: f64) -> bool {
    sheet.strokes.iter().any(|s| {
        let across = s.x0 < left && s.x0 > left - 8.0 && s.x1 > right && s.x1 < right + 8.0;
        across && s.y0 > y && s.y1 < y
    })
}

/// The lower end of a box whose left side meets the wire here; a box reaches one row above the wire.
fn box_bottom(sheet: &Sheet, x: f64, y: f64) -> Option<f64> {
    let side = |s: &&Stroke| near(s.x0, x) && near(s.x1, x) && near(s.y0, y - ROW) && s.y1 > y + 1.0;
    sheet.strokes.iter().find(side).map(|s| s.y1)
}

fn read_box(sheet: &Sheet, left: f64, y: f64, lower: f64) -> Option<Found> {
    let upper = y - ROW;
    let side = |s: &&Stroke| near(s.x0, s.x1) && near(s.y0, upper) && near(s.y1, lower) && s.x0 > left + 1.0;
    let right = sheet.strokes.iter().filter(side).map(|s| s.x0).fold(f64::INFINITY, f64::min);
    if !right.is_finite() {
        return None;
    }
    let within =
        |t: &&Text| t.x0 > left - 1.0 && t.x0 < right && t.y > upper - 3.0 && t.y < lower && !t.text.trim().is_empty();
    let mut texts: Vec<&Text> = sheet.texts.iter().filter(within).collect();
    texts.sort_by(|a, b| row(a, y).cmp(&row(b, y)).then(a.x0.total_cmp(&b.x0)));
    let mut mnemonic = None;
    let mut title = None;
    let mut fields: Vec<Field> = Vec::new();
    let mut open = None;
    for text in texts {
        let place = row(text, y);
        let words = text.text.trim().to_owned();
        match (place, text.colour) {
            (..=-1, Colour::Blue) => mnemonic = Some(words),
            (..=-1, _) => {}
            (0, Colour::Blue) if title.is_none() => title = Some(words),
            (_, Colour::Blue) => {
                fields.push(Field { label: words, ..Field::default() });
                open = Some(place);
            }
            _ => match fields.last_mut() {
                Some(field) if open == Some(place) && field.text.is_empty() => field.text = words,
                Some(field) => field.values.push(words),
                None => fields.push(Field { text: words, ..Field::default() }),
            },
        }
    }
    // The strip with symbol and description over a box starts left of it and covers it.
    let (symbol, description) = documentation(sheet, f64::midpoint(left, right), y);
    let instruction = Instruction {
        shape: Shape::Box,
        mnemonic: mnemonic?,
        above: None,
        below: None,
        module: None,
        symbol,
        description,
        lit: lit(sheet, left, y),
        title,
        fields,
    };
    Some(Found { instruction, end: right })
}

/// Rows below the wire: 0 on its height, -1 the row above.
fn row(text: &Text, y: f64) -> i32 {
    // The heights on a page are far below the range of i32.
    #[allow(clippy::cast_possible_truncation)]
    let row = ((text.y - y) / ROW).round() as i32;
    row
}

/// The black text closest to `x` in the row at height `y`. An address stands in the middle;
/// a bit number over a module name is pushed aside by blanks that RSLogix prints before it.
fn centred(sheet: &Sheet, x: f64, y: f64) -> Option<String> {
    let away = |t: &Text| (f64::midpoint(t.x0, t.x1) - x).abs();
    let fits = |t: &&Text| {
        let near_by = t.colour == Colour::Black && (t.y - y).abs() < ROW / 2.0 && away(t) < 14.0;
        near_by && !t.text.trim().is_empty() && strip(sheet, x, t.y).is_none()
    };
    let closest = sheet.texts.iter().filter(fits).min_by(|a, b| away(a).total_cmp(&away(b)));
    closest.map(|t| t.text.trim().to_owned())
}

/// The blue text between the ends of a coil or bracket.
fn inside(sheet: &Sheet, left: f64, right: f64, y: f64) -> Option<String> {
    let fits = |t: &&Text| {
        let between = t.x0 > left - 1.0 && t.x1 < right + 1.0;
        t.colour == Colour::Blue && (t.y - y).abs() < ROW / 2.0 && between && !t.text.trim().is_empty()
    };
    sheet.texts.iter().find(fits).map(|t| t.text.trim().to_owned())
}

/// The coloured strip of a symbol or description at a place. The green behind the wire of a true
/// instruction is only half a row high.
fn strip(sheet: &Sheet, x: f64, y: f64) -> Option<&Fill> {
    sheet.fills.iter().find(|f| {
        let over = f.x0 <= x && x <= f.x1 && f.y0 < y && y < f.y1;
        over && matches!(f.colour, Colour::Green | Colour::PaleYellow) && f.y1 - f.y0 > ROW / 2.0 + 1.0
    })
}

/// Whether green lies behind the wire left of `x`.
fn lit(sheet: &Sheet, x: f64, y: f64) -> bool {
    sheet.fills.iter().any(|f| {
        let on = f.x0 < x - 2.0 && x - 2.0 < f.x1 && f.y0 < y && y < f.y1;
        on && f.colour == Colour::Green && f.y1 - f.y0 <= ROW / 2.0 + 1.0
    })
}

/// Symbol and description over an instruction: the coloured strips over `x`, row by row upwards.
fn documentation(sheet: &Sheet, x: f64, y: f64) -> (Vec<String>, Vec<String>) {
    let (mut symbol, mut description) = (Vec::new(), Vec::new());
    let mut height = y - 2.0 * ROW;
    while let Some(strip) = strip(sheet, x, height) {
        if sheet.is_title(strip) {
            break;
        }
        let on = |t: &&Text| (t.y - height).abs() < ROW / 2.0 && t.x0 > strip.x0 - 1.0 && t.x0 < strip.x1;
        let text = sheet.texts.iter().find(on).map(|t| t.text.trim().to_owned()).unwrap_or_default();
        if strip.colour == Colour::Green {
            symbol.insert(0, text);
        } else {
            description.insert(0, text);
        }
        height -= ROW;
    }
    (symbol, description)
}
