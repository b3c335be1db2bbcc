//! A page being painted: lines, areas, texts and links in points from its top left corner.
//!
//! What is set already is not set again, and numbers are rounded to hundredths of a point, which no
//! printer can show, so that pages stay small.

use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Name, Settings, Str};

use super::font::{Font, codes, printable};

/// A colour: red, green and blue from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub f32, pub f32, pub f32);

impl Color {
    /// Black.
    pub const BLACK: Color = Color(0.0, 0.0, 0.0);

    /// Of a number `0xRRGGBB`.
    pub const fn of(hex: u32) -> Color {
        let [_, red, green, blue] = hex.to_be_bytes();
        // Three digits are more than the 256 steps there are.
        Color(part(red), part(green), part(blue))
    }
}

const fn part(value: u8) -> f32 {
    (value as f32 / 0.255) as u16 as f32 / 1000.0
}

/// A rectangle in points from the top left corner of the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// Left side.
    pub left: f32,
    /// Upper side.
    pub top: f32,
    /// Right side.
    pub right: f32,
    /// Lower side.
    pub bottom: f32,
}

/// A place on a page that leads somewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Where it is, in points from the top left corner.
    pub area: Area,
    /// Name of the place it leads to.
    pub target: String,
}

/// How a text is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Letters {
    /// Font.
    pub font: Font,
    /// Size in points.
    pub size: f32,
    /// Colour.
    pub color: Color,
}

/// A page being painted.
pub struct Canvas {
    content: Content,
    height: f32,
    links: Vec<Link>,
    escaped: usize,
    fill: Color,
    stroke: Color,
    width: f32,
    font: Option<(Font, f32)>,
    scaling: f32,
    open: bool,
}

/// What was painted.
#[derive(Clone, Debug, Default)]
pub struct Painted {
    /// Operators of the page's contents, not compressed.
    pub content: Vec<u8>,
    /// Links, in the order they were painted.
    pub links: Vec<Link>,
    /// Characters that stand spelled out because the fonts cannot show them.
    pub escaped: usize,
}

fn hundredths(value: f32) -> f32 {
    // Rounding in double precision keeps the shortest decimal form of the result short.
    ((f64::from(value) * 100.0).round() / 100.0) as f32
}

impl Canvas {
    /// An empty page of this height in points.
    pub fn new(height: f32) -> Canvas {
        let mut content = Content::with_settings(Settings { pretty: false });
        content.set_line_cap(LineCapStyle::ProjectingSquareCap).set_line_join(LineJoinStyle::MiterJoin);
        Canvas {
            content,
            height,
            links: Vec::new(),
            escaped: 0,
            fill: Color::BLACK,
            stroke: Color::BLACK,
            width: 1.0,
            font: None,
            scaling: 100.0,
            open: false,
        }
    }

    fn y(&self, y: f32) -> f32 {
        hundredths(self.height - y)
    }

    fn close_path(&mut self) {
        if std::mem::take(&mut self.open) {
            self.content.stroke();
        }
    }

    fn set_fill(&mut self, color: Color) {
        self.close_path();
        if self.fill != color {
            self.fill = color;
            match color {
                Color(r, g, b) if r == g && g == b => self.content.set_fill_gray(r),
                Color(r, g, b) => self.content.set_fill_rgb(r, g, b),
            };
        }
    }

    fn set_stroke(&mut self, color: Color, width: f32) {
        if self.stroke != color {
            self.close_path();
            self.stroke = color;
            match color {
                Color(r, g, b) if r == g && g == b => self.content.set_stroke_gray(r),
                Color(r, g, b) => self.content.set_stroke_rgb(r, g, b),
            };
        }
        if self.width != width {
            self.close_path();
            self.width = width;
            self.content.set_line_width(hundredths(width));
        }
    }

    /// A line through points, of a width in points.
    pub fn line(&mut self, points: &[(f32, f32)], width: f32, color: Color) {
        let Some(((x, y), rest)) = points.split_first() else { return };
        self.set_stroke(color, width);
        self.content.move_to(hundredths(*x), self.y(*y));
        for (x, y) in rest {
            self.content.line_to(hundredths(*x), self.y(*y));
        }
        self.open = true;
    }

    /// A curve from a point to another, drawn towards two others in between.
    pub fn curve(&mut self, points: [(f32, f32); 4], width: f32, color: Color) {
        let [from, first, second, to] = points.map(|(x, y)| (hundredths(x), self.y(y)));
        self.set_stroke(color, width);
        self.content.move_to(from.0, from.1);
        self.content.cubic_to(first.0, first.1, second.0, second.1, to.0, to.1);
        self.open = true;
    }

    /// A filled area.
    pub fn fill(&mut self, area: Area, color: Color) {
        self.set_fill(color);
        let (left, bottom) = (hundredths(area.left), self.y(area.bottom));
        let (right, top) = (hundredths(area.right), self.y(area.top));
        self.content.rect(left, bottom, hundredths(right - left), hundredths(top - bottom)).fill_nonzero();
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[(f32, f32)], color: Color) {
        let Some(((x, y), rest)) = points.split_first() else { return };
        self.set_fill(color);
        self.content.move_to(hundredths(*x), self.y(*y));
        for (x, y) in rest {
            self.content.line_to(hundredths(*x), self.y(*y));
        }
        self.content.close_path().fill_nonzero();
    }

    /// A text from `x` on the line `y`. Characters the fonts lack are spelled out and counted. Returns its
    /// width in points.
    pub fn text(&mut self, x: f32, y: f32, letters: Letters, text: &str) -> f32 {
        self.fitted(x, y, letters, f32::INFINITY, text).0
    }

    /// As [`Canvas::text`], made narrower where it is wider than `room`. Returns its width in points and by
    /// how much it was made narrower: 1 for not at all.
    pub fn fitted(&mut self, x: f32, y: f32, letters: Letters, room: f32, text: &str) -> (f32, f32) {
        let Letters { font, size, color } = letters;
        let (text, escaped) = printable(text);
        self.escaped += escaped;
        let wanted = font.width(&text, size);
        // Sums of widths differ in the last digits from what a grid gives.
        let ratio = if wanted > room * 1.001 && wanted > 0.0 { (room / wanted).max(0.01) } else { 1.0 };
        if text.chars().all(|c| c == ' ') {
            return (wanted * ratio, ratio);
        }
        self.set_fill(color);
        self.content.begin_text();
        if self.font != Some((font, size)) {
            self.font = Some((font, size));
            self.content.set_font(Name(font.resource().as_bytes()), hundredths(size));
        }
        let scaling = hundredths(ratio * 100.0);
        if self.scaling != scaling {
            self.scaling = scaling;
            self.content.set_horizontal_scaling(scaling);
        }
        self.content.next_line(hundredths(x), self.y(y));
        self.content.show(Str(&codes(&text)));
        self.content.end_text();
        (wanted * ratio, ratio)
    }

    /// Characters spelled out up to now because the fonts cannot show them.
    pub fn escaped(&self) -> usize {
        self.escaped
    }

    /// Makes an area lead to a place.
    pub fn link(&mut self, area: Area, target: &str) {
        self.links.push(Link { area, target: target.to_owned() });
    }

    /// The finished page.
    pub fn finish(mut self) -> Painted {
        self.close_path();
        Painted { content: self.content.finish().into_vec(), links: self.links, escaped: self.escaped }
    }
}
