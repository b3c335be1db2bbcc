//! The ladder of a program as one page: drawings, and an index of the addresses in them.
//!
//! Everything is in the page: no script, no font, no picture from elsewhere.

use std::collections::HashMap;
use std::io::{self, Write};

use crate::scene::{Item, Scene};
use crate::svg;

/// A page that is being written; [`Page::finish`] ends it.
pub struct Page<'a> {
    out: &'a mut dyn Write,
    /// Places in [`Page::addresses`] by address.
    known: HashMap<String, usize>,
    /// Addresses in order of their first rung, with the rungs that show them.
    addresses: Vec<(String, Vec<usize>)>,
    /// Names of the rungs, for the index.
    rungs: Vec<String>,
}

const STYLE: &str = "\
:root{color-scheme:light dark}\
body{margin:1rem;font:15px/1.4 system-ui,sans-serif;background:#fff;color:#111}\
@media (prefers-color-scheme:dark){body{background:#16181d;color:#e8e8e8}a{color:#8fb0ff}}\
h1{font-size:1.3rem}h2{font-size:1.05rem;margin:2rem 0 .5rem;border-bottom:1px solid}\
.drawing{overflow-x:auto}.drawing:target{outline:3px solid #6a1b9a}\
dl{columns:18rem}dt{font-family:monospace;font-weight:bold}dd{margin:0 0 .4rem 1rem;break-before:avoid}\
:target{scroll-margin-top:1rem}dt:target{outline:2px solid}\
@media print{body{margin:0}.drawing{overflow:visible;break-inside:avoid}.drawing svg{max-width:100%;height:auto}}";

impl<'a> Page<'a> {
    /// Begins a page. `addresses` are those that rungs of the page use, in the spelling of the model: they
    /// become links to the index, wherever a text names them.
    ///
    /// # Errors
    /// What writing to `out` gives.
    pub fn begin(
        out: &'a mut dyn Write,
        title: &str,
        addresses: impl IntoIterator<Item = String>,
    ) -> io::Result<Page<'a>> {
        let title = svg::escape(title);
        write!(
            out,
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
             <meta name=\"viewport\" content=\"width=device-width\"><title>{title}</title>\
             <style>{STYLE}{}</style></head><body>\n<h1>{title}</h1>\n",
            svg::STYLE
        )?;
        let mut page = Page { out, known: HashMap::new(), addresses: Vec::new(), rungs: Vec::new() };
        for address in addresses {
            let next = page.addresses.len();
            page.known.entry(address).or_insert_with_key(|address| {
                page.addresses.push((address.clone(), Vec::new()));
                next
            });
        }
        Ok(page)
    }

    /// A heading, such as a program file.
    ///
    /// # Errors
    /// What writing gives.
    pub fn heading(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.out, "<h2>{}</h2>", svg::escape(text))
    }

    /// A rung; `name` is what the index calls it, such as `2:4`.
    ///
    /// # Errors
    /// What writing gives.
    pub fn rung(&mut self, scene: &Scene, name: &str) -> io::Result<()> {
        let rung = self.rungs.len();
        self.rungs.push(name.to_owned());
        for address in scene.items.iter().filter_map(Item::link) {
            let place = self.known.get(address).and_then(|place| self.addresses.get_mut(*place));
            // Items of a rung come one after the other.
            if let Some((_, rungs)) = place.filter(|(_, rungs)| rungs.last() != Some(&rung)) {
                rungs.push(rung);
            }
        }
        let label = format!("Rung {name}");
        let options = svg::Options {
            href: &|address| self.known.get(address).map(|place| format!("#a{place}")),
            label: &label,
            ..svg::Options::default()
        };
        let drawing = svg::drawing(scene, &options);
        writeln!(self.out, "<div class=\"drawing\" id=\"r{rung}\">{drawing}</div>")
    }

    /// The index, and the end of the page.
    ///
    /// # Errors
    /// What writing gives.
    pub fn finish(self) -> io::Result<()> {
        let mut sorted: Vec<_> =
            self.addresses.iter().enumerate().filter(|(_, (_, rungs))| !rungs.is_empty()).collect();
        sorted.sort_by(|(_, (one, _)), (_, (other, _))| natural(one).cmp(natural(other)));
        if !sorted.is_empty() {
            writeln!(self.out, "<h2>Addresses and the rungs that show them</h2>\n<dl>")?;
        }
        for (place, (address, rungs)) in &sorted {
            write!(self.out, "<dt id=\"a{place}\">{}</dt><dd>", svg::escape(address))?;
            for (index, rung) in rungs.iter().enumerate() {
                let name = self.rungs.get(*rung).map_or("", String::as_str);
                let comma = if index == 0 { "" } else { ", " };
                write!(self.out, "{comma}<a href=\"#r{rung}\">{}</a>", svg::escape(name))?;
            }
            writeln!(self.out, "</dd>")?;
        }
        if !sorted.is_empty() {
            writeln!(self.out, "</dl>")?;
        }
        writeln!(self.out, "</body></html>")
    }
}

/// Parts of an address in an order in which `N7:10` comes after `N7:9`.
fn natural(address: &str) -> impl Iterator<Item = (u8, usize, &str)> {
    let mut rest = address;
    std::iter::from_fn(move || {
        let digits = rest.starts_with(|c: char| c.is_ascii_digit());
        let end = rest.find(|c: char| c.is_ascii_digit() != digits).unwrap_or(rest.len());
        let (part, after) = rest.split_at(end);
        rest = after;
        // Numbers by their length, then by their digits: no number is too long.
        let number = part.trim_start_matches('0');
        (!part.is_empty()).then_some(if digits { (0, number.len(), number) } else { (1, 0, part) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_sort_as_numbers() {
        let mut all = ["N7:10", "N7:9", "B3:0/10", "N10:0", "B3:0/9", "N7:9/1"];
        all.sort_by(|a, b| natural(a).cmp(natural(b)));
        assert_eq!(all, ["B3:0/9", "B3:0/10", "N7:9", "N7:9/1", "N7:10", "N10:0"]);
    }
}
