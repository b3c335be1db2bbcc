//! Running a page's drawing operators, as far as RSLogix reports use them.

use super::font::{Font, told};
use super::matrix::Matrix;
use super::page::{Colour, Fill, Page, Stroke, Text};
use lopdf::Object;
use lopdf::content::Content;
use std::collections::BTreeMap;

/// What `q` saves and `Q` brings back.
#[derive(Clone)]
struct State {
    map: Matrix,
    fill: Colour,
    stroke: Colour,
}

struct Machine<'a> {
    page: Page,
    height: f64,
    fonts: &'a BTreeMap<Vec<u8>, Font>,
    state: State,
    saved: Vec<State>,
    /// Subpaths under construction, in page points.
    path: Vec<Vec<(f64, f64)>>,
    font: Option<&'a Font>,
    size: f64,
    text: Matrix,
    line: Matrix,
}

/// Runs the operators of one page of the given height (points).
///
/// # Errors
/// When the stream is no sequence of operators with the operands they need.
pub(super) fn run(bytes: &[u8], fonts: &BTreeMap<Vec<u8>, Font>, height: f64) -> Result<Page, String> {
    let content = Content::decode(bytes).map_err(told)?;
    let start = State { map: Matrix::IDENTITY, fill: Colour::Black, stroke: Colour::Black };
    let mut machine = Machine {
        page: Page::default(),
        height,
        fonts,
        state: start,
        saved: Vec::new(),
        path: Vec::new(),
        font: None,
        size: 0.0,
        text: Matrix::IDENTITY,
        line: Matrix::IDENTITY,
    };
    for operation in &content.operations {
        machine.step(&operation.operator, &operation.operands)?;
    }
    Ok(machine.page)
}

impl Machine<'_> {
    fn step(&mut self, operator: &str, operands: &[Object]) -> Result<(), String> {
        match operator {
            "q" => self.saved.push(self.state.clone()),
            "Q" => self.state = self.saved.pop().ok_or("Q without q")?,
            "cm" => self.state.map = Matrix::new(numbers(operands)?).then(self.state.map),
            "rg" => self.state.fill = Colour::new(numbers(operands)?),
            "RG" => self.state.stroke = Colour::new(numbers(operands)?),
            "g" => self.state.fill = grey(operands)?,
            "G" => self.state.stroke = grey(operands)?,
            "m" => {
                let point = self.point(operands)?;
                self.path.push(vec![point]);
            }
            "l" => {
                let point = self.point(operands)?;
                self.path.last_mut().ok_or("l without m")?.push(point);
            }
            "h" => {
                let path = self.path.last_mut().ok_or("h without m")?;
                if let Some(&first) = path.first() {
                    path.push(first);
                }
            }
            "re" => self.rectangle(numbers(operands)?),
            "f" | "F" | "f*" => self.fill(),
            "S" => self.stroke(),
            "n" => self.path.clear(),
            "BT" => (self.text, self.line) = (Matrix::IDENTITY, Matrix::IDENTITY),
            "Tf" => self.set_font(operands)?,
            "Tm" => {
                self.line = Matrix::new(numbers(operands)?);
                self.text = self.line;
            }
            "Td" => {
                let [x, y] = numbers(operands)?;
                self.line = Matrix::shift(x, y).then(self.line);
                self.text = self.line;
            }
            "Tj" => self.show(operands)?,
            "TJ" => {
                let parts = operands.first().ok_or("TJ without array")?.as_array().map_err(told)?;
                self.show(parts)?;
            }
            // Line style, clipping, marked content and text rendering do not move or colour a mark.
            "W" | "W*" | "J" | "j" | "M" | "w" | "d" | "i" | "gs" | "ET" | "Tr" | "BDC" | "BMC" | "EMC" => {}
            other => {
                self.page.skipped.insert(other.to_owned());
            }
        }
        Ok(())
    }

    fn point(&self, operands: &[Object]) -> Result<(f64, f64), String> {
        let [x, y] = numbers(operands)?;
        Ok(self.place(self.state.map, x, y))
    }

    fn place(&self, map: Matrix, x: f64, y: f64) -> (f64, f64) {
        let (x, y) = map.apply(x, y);
        (x, self.height - y)
    }

    fn rectangle(&mut self, [x, y, width, height]: [f64; 4]) {
        let corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)];
        let map = self.state.map;
        self.path.push(corners.iter().map(|&(x, y)| self.place(map, x, y)).collect());
    }

    /// Every fill in a report is a rectangle, so its extent says all.
    fn fill(&mut self) {
        for path in std::mem::take(&mut self.path) {
            let fold = |start: f64, pick: fn(f64, f64) -> f64, of: fn(&(f64, f64)) -> f64| {
                path.iter().map(of).fold(start, pick)
            };
            self.page.fills.push(Fill {
                x0: fold(f64::INFINITY, f64::min, |p| p.0),
                y0: fold(f64::INFINITY, f64::min, |p| p.1),
                x1: fold(f64::NEG_INFINITY, f64::max, |p| p.0),
                y1: fold(f64::NEG_INFINITY, f64::max, |p| p.1),
                colour: self.state.fill,
            });
        }
    }

    fn stroke(&mut self) {
        for path in std::mem::take(&mut self.path) {
            for ends in path.windows(2) {
                let &[a, b] = ends else { continue };
                let forward = if (a.0 - b.0).abs() < 0.01 { a.1 <= b.1 } else { a.0 < b.0 };
                let (a, b) = if forward { (a, b) } else { (b, a) };
                let stroke = Stroke { x0: a.0, y0: a.1, x1: b.0, y1: b.1, colour: self.state.stroke };
                self.page.strokes.push(stroke);
            }
        }
    }

    fn set_font(&mut self, operands: &[Object]) -> Result<(), String> {
        let [name, size] = operands else { return Err("Tf without name and size".to_owned()) };
        self.font = self.fonts.get(name.as_name().map_err(told)?);
        self.size = f64::from(size.as_float().map_err(told)?);
        Ok(())
    }

    fn show(&mut self, parts: &[Object]) -> Result<(), String> {
        let Some(font) = self.font else {
            self.page.skipped.insert("text in an unknown font".to_owned());
            return Ok(());
        };
        let (mut text, mut width) = (String::new(), 0.0);
        for part in parts {
            match part {
                Object::String(bytes, _) => {
                    let (more, thousandths) = font.decode(bytes);
                    text.push_str(&more);
                    width += thousandths * self.size / 1000.0;
                }
                other => width -= f64::from(other.as_float().map_err(told)?) * self.size / 1000.0,
            }
        }
        let map = self.text.then(self.state.map);
        let (x0, base) = self.place(map, 0.0, 0.0);
        let (x1, _) = self.place(map, width, 0.0);
        self.text = Matrix::shift(width, 0.0).then(self.text);
        // The base line lies 2.5 to 3 points below the middle of a row, depending on the font.
        let colour = self.state.fill;
        self.page.texts.push(Text { x0, x1, y: base - 2.8, text, colour });
        Ok(())
    }
}

fn numbers<const N: usize>(operands: &[Object]) -> Result<[f64; N], String> {
    let read: Result<Vec<f64>, _> = operands.iter().map(|o| o.as_float().map(f64::from)).collect();
    let read = read.map_err(told)?;
    read.try_into().map_err(|v: Vec<f64>| format!("{N} numbers expected, {} found", v.len()))
}

fn grey(operands: &[Object]) -> Result<Colour, String> {
    let [level] = numbers(operands)?;
    Ok(Colour::new([level; 3]))
}
