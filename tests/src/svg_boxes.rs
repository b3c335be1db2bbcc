//! What a drawing in SVG covers, from its attributes alone, and whether anything lies over anything else.
//!
//! This knows nothing of how drawings are made: it reads the file as a browser does. A text takes the
//! rectangle of its `textLength`, font height included; a path takes its strokes.

use roxmltree::{Document, Node};

/// Above the line of a text: letters of 13 units.
const ASCENT: f64 = 10.5;
/// Below it.
const DESCENT: f64 = 3.0;
/// Narrowest column in which a letter of 13 units is not squeezed.
const COLUMN: f64 = 7.0;

#[derive(Clone, Copy, Debug)]
struct Area {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Area {
    /// More than a common side.
    fn overlaps(&self, other: &Area) -> bool {
        const TOUCH: f64 = 0.25;
        self.left + TOUCH < other.right
            && other.left + TOUCH < self.right
            && self.top + TOUCH < other.bottom
            && other.top + TOUCH < self.bottom
    }

    fn contains(&self, other: &Area) -> bool {
        self.left <= other.left && other.right <= self.right && self.top <= other.top && other.bottom <= self.bottom
    }

    fn grown(&self, by: f64) -> Area {
        Area { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    fn joined(&self, other: &Area) -> Area {
        Area {
            left: self.left.min(other.left),
            top: self.top.min(other.top),
            right: self.right.max(other.right),
            bottom: self.bottom.max(other.bottom),
        }
    }
}

#[derive(Debug)]
struct Text {
    area: Area,
    class: String,
    text: String,
}

#[derive(Debug, Default)]
struct Content {
    texts: Vec<Text>,
    /// Strokes as thin areas: contacts, coils, frames, wires.
    strokes: Vec<Area>,
    /// Wires alone.
    wires: Vec<Area>,
    /// Frames as a whole, and contacts and coils as a whole.
    solid: Vec<Area>,
    backgrounds: Vec<(Area, String)>,
    faults: Vec<String>,
}

/// What a drawing holds, and what is wrong with it.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Texts.
    pub texts: usize,
    /// Strokes.
    pub strokes: usize,
    /// One line each.
    pub faults: Vec<String>,
}

/// Looks at one `<svg>` element.
pub fn check(svg: &str) -> Outcome {
    let document = match Document::parse(svg) {
        Ok(document) => document,
        Err(error) => return Outcome { faults: vec![format!("no XML: {error}")], ..Outcome::default() },
    };
    let root = document.root_element();
    let mut content = Content::default();
    let page = match view(root) {
        Some(page) => page,
        None => return Outcome { faults: vec!["no viewBox, or not the size of it".into()], ..Outcome::default() },
    };
    for node in root.descendants().filter(Node::is_element) {
        content.add(node);
    }
    let mut faults = std::mem::take(&mut content.faults);
    content.texts.sort_by(|a, b| a.area.top.total_cmp(&b.area.top));
    content.strokes.sort_by(|a, b| a.top.total_cmp(&b.top));
    inside(&content, &page, &mut faults);
    apart(&content, &mut faults);
    Outcome { texts: content.texts.len(), strokes: content.strokes.len(), faults }
}

fn inside(content: &Content, page: &Area, faults: &mut Vec<String>) {
    for text in content.texts.iter().filter(|text| !page.contains(&text.area)) {
        faults.push(format!("clipped: {:?} at {:?}", text.text, text.area));
    }
    let areas = content.strokes.iter().chain(content.backgrounds.iter().map(|(area, _)| area));
    for area in areas.filter(|area| !page.contains(area)) {
        faults.push(format!("outside of the drawing: {area:?}"));
    }
}

fn apart(content: &Content, faults: &mut Vec<String>) {
    for (index, text) in content.texts.iter().enumerate() {
        let below = content.texts.iter().skip(index + 1).take_while(|other| other.area.top < text.area.bottom);
        for other in below.filter(|other| other.area.overlaps(&text.area)) {
            faults.push(format!("{:?} lies over {:?}", text.text, other.text));
        }
        let reach = content.strokes.iter().take_while(|stroke| stroke.top < text.area.bottom);
        for stroke in reach.filter(|stroke| stroke.overlaps(&text.area)) {
            faults.push(format!("a line at {stroke:?} goes through {:?} at {:?}", text.text, text.area));
        }
        for (area, class) in content.backgrounds.iter().filter(|(area, _)| area.overlaps(&text.area)) {
            if *class != text.class || !area.grown(1.0).contains(&text.area) {
                faults.push(format!("{:?} has the background of a {class}, or a part of it", text.text));
            }
        }
    }
    for (index, one) in content.solid.iter().enumerate() {
        for other in content.solid.iter().skip(index + 1).filter(|other| other.overlaps(one)) {
            faults.push(format!("{one:?} lies over {other:?}"));
        }
        for wire in content.wires.iter().filter(|wire| wire.overlaps(&one.grown(-1.5))) {
            faults.push(format!("a wire at {wire:?} goes through {one:?}"));
        }
    }
}

impl Content {
    fn add(&mut self, node: Node<'_, '_>) {
        let class = node.attribute("class").unwrap_or("");
        let found = match node.tag_name().name() {
            "text" => self.text(node, class),
            "rect" => rectangle(node).map(|area| self.rectangle(area, class)),
            "path" => strokes(node.attribute("d").unwrap_or("")).map(|strokes| self.path(strokes, class)),
            "svg" | "g" | "title" | "style" | "a" => Some(()),
            _ => None,
        };
        if found.is_none() {
            self.faults.push(format!("not understood: {:?}", node));
        }
    }

    fn text(&mut self, node: Node<'_, '_>, class: &str) -> Option<()> {
        let number = |name| node.attribute(name)?.parse::<f64>().ok();
        let (x, y, width) = (number("x")?, number("y")?, number("textLength")?);
        let text: String = node.descendants().filter(Node::is_text).filter_map(|node| node.text()).collect();
        let letters = text.chars().count() as f64;
        if letters * COLUMN > width {
            self.faults.push(format!("squeezed: {text:?} in {width} units"));
        }
        let area = Area { left: x, top: y - ASCENT, right: x + width, bottom: y + DESCENT };
        self.texts.push(Text { area, class: class.to_owned(), text });
        Some(())
    }

    fn rectangle(&mut self, area: Area, class: &str) {
        match class.strip_prefix("bg ") {
            Some(of) => self.backgrounds.push((area, of.to_owned())),
            None if class == "bar" || class == "paper" => {}
            None => self.faults.push(format!("a rectangle of no known class at {area:?}")),
        }
    }

    fn path(&mut self, strokes: Vec<Area>, class: &str) {
        let whole = strokes.iter().copied().reduce(|a, b| a.joined(&b));
        match class {
            "frame" | "sign" => self.solid.extend(whole),
            "rail" => {}
            _ => self.wires.extend(&strokes),
        }
        self.strokes.extend(strokes);
    }
}

fn view(root: Node<'_, '_>) -> Option<Area> {
    let numbers: Vec<f64> = root.attribute("viewBox")?.split(' ').filter_map(|part| part.parse().ok()).collect();
    let [left, top, width, height] = *numbers else { return None };
    let size = |name: &str| root.attribute(name)?.parse::<f64>().ok();
    let same = size("width") == Some(width) && size("height") == Some(height);
    same.then_some(Area { left, top, right: left + width, bottom: top + height })
}

fn rectangle(node: Node<'_, '_>) -> Option<Area> {
    let number = |name| node.attribute(name).map_or(Some(0.0), |value| value.parse::<f64>().ok());
    let (left, top) = (number("x")?, number("y")?);
    Some(Area { left, top, right: left + number("width")?, bottom: top + number("height")? })
}

/// The strokes of a path of `M`, `L`, `H`, `V` and `C`; curves as the straight lines between some of
/// their points.
fn strokes(path: &str) -> Option<Vec<Area>> {
    let mut found = Vec::new();
    let mut at = (0.0, 0.0);
    let mut rest = path;
    while let Some(letter) = rest.chars().next() {
        let (_, tail) = rest.split_at(1);
        let end = tail.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(tail.len());
        let (numbers, next) = tail.split_at(end);
        rest = next;
        let numbers: Vec<f64> = numbers.split_whitespace().map(|n| n.parse().ok()).collect::<Option<_>>()?;
        let from = at;
        match (letter, numbers.as_slice()) {
            ('M', &[x, y]) => {
                at = (x, y);
                continue;
            }
            ('L', &[x, y]) => at = (x, y),
            ('H', &[x]) => at = (x, at.1),
            ('V', &[y]) => at = (at.0, y),
            ('C', &[a, b, c, d, x, y]) => {
                let mut last = from;
                for step in 1..=8 {
                    let t = f64::from(step) / 8.0;
                    let u = 1.0 - t;
                    let mix = |p0: f64, p1: f64, p2: f64, p3: f64| {
                        u * u * u * p0 + 3.0 * u * u * t * p1 + 3.0 * u * t * t * p2 + t * t * t * p3
                    };
                    let point = (mix(from.0, a, c, x), mix(from.1, b, d, y));
                    found.push(stroke(last, point));
                    last = point;
                }
                at = (x, y);
                continue;
            }
            _ => return None,
        }
        // A slanted line is cut, so that its area stays close to it.
        let parts = if from.0 == at.0 || from.1 == at.1 { 1 } else { 8 };
        let point = |step: i32| {
            let t = f64::from(step) / f64::from(parts);
            (from.0 + (at.0 - from.0) * t, from.1 + (at.1 - from.1) * t)
        };
        found.extend((0..parts).map(|step| stroke(point(step), point(step + 1))));
    }
    Some(found)
}

/// The area of a line one unit wide, whose ends are cut off straight.
fn stroke(a: (f64, f64), b: (f64, f64)) -> Area {
    let area = Area { left: a.0.min(b.0), top: a.1.min(b.1), right: a.0.max(b.0), bottom: a.1.max(b.1) };
    match (a.0 == b.0, a.1 == b.1) {
        (true, _) => Area { left: area.left - 0.5, right: area.right + 0.5, ..area },
        (_, true) => Area { top: area.top - 0.5, bottom: area.bottom + 0.5, ..area },
        _ => area.grown(0.5),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(content: &str) -> usize {
        let svg = format!("<svg width=\"100\" height=\"60\" viewBox=\"0 0 100 60\">{content}</svg>");
        let outcome = check(&svg);
        println!("{:?}", outcome.faults);
        outcome.faults.len()
    }

    #[test]
    fn what_is_wrong_is_found() {
        let text = |x: i32, y: i32, width: i32| {
            format!("<text class=\"t\" x=\"{x}\" y=\"{y}\" textLength=\"{width}\">abc</text>")
        };
        assert_eq!(faults(&text(0, 12, 24)), 0);
        assert_eq!(faults(&text(80, 12, 24)), 1, "clipped at the right");
        assert_eq!(faults(&text(0, 5, 24)), 1, "clipped above");
        assert_eq!(faults(&text(0, 12, 15)), 1, "squeezed");
        assert_eq!(faults(&(text(0, 12, 24) + &text(20, 12, 24))), 1, "two texts");
        assert_eq!(faults(&(text(0, 12, 24) + &text(24, 12, 24) + &text(0, 28, 24))), 0, "beside and below");
        assert_eq!(faults(&(text(0, 12, 24) + "<path class=\"w\" d=\"M10 0V40\"/>")), 1, "a wire through a text");
        let frame = "<path class=\"frame\" d=\"M10 10V40H50V10H10\"/>";
        assert_eq!(faults(&format!("{frame}<path class=\"w\" d=\"M0 20H10M50 20H99\"/>")), 0, "wires at a frame");
        assert_eq!(faults(&format!("{frame}<path class=\"w\" d=\"M0 20H99\"/>")), 1, "a wire through a frame");
        assert_eq!(faults(&format!("{frame}<path class=\"sign\" d=\"M45 12V30\"/>")), 1, "a contact over a frame");
        assert_eq!(faults("<path class=\"rail\" d=\"M10 0V70\"/>"), 1, "a rail beyond the drawing");
        assert_eq!(faults("<path class=\"sign\" d=\"M5 20C30 20 60 50 95 20\"/><circle/>"), 1, "an unknown element");
        let strip = "<rect class=\"bg symbol\" x=\"0\" y=\"0\" width=\"24\" height=\"16\"/>";
        assert_eq!(faults(&format!("{strip}{}", text(0, 12, 24))), 1, "a background of something else");
    }
}
