//! Two texts side by side, word by word.

use analysis::diff::longest_common;

/// A stretch of one of two texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stretch<'t> {
    /// In both.
    Same(&'t str),
    /// Only in the old text.
    Old(&'t str),
    /// Only in the new text.
    New(&'t str),
}

/// Cells of a table: beyond it the texts stand as one replaced by the other.
const MOST_CELLS: usize = 4_000_000;

/// Same words in common, of 100 of the shorter text, below which the texts have nothing to do with each other and
/// scattered words that agree would only confuse.
const LEAST_COMMON: usize = 25;

/// What became of the words of a text: stretches in order, neighbouring ones joined.
pub fn stretches<'t>(old: &'t str, new: &'t str) -> Vec<Stretch<'t>> {
    let (a, b) = (words(old), words(new));
    let start = a.iter().zip(&b).take_while(|(x, y)| x == y).count();
    let end = a.iter().skip(start).rev().zip(b.iter().skip(start).rev()).take_while(|(x, y)| x == y).count();
    let (left, right) =
        (a.get(start..a.len() - end).unwrap_or_default(), b.get(start..b.len() - end).unwrap_or_default());
    let pairs =
        if left.len().saturating_mul(right.len()) <= MOST_CELLS { longest_common(left, right) } else { Vec::new() };
    let said = |words: &[&str]| words.iter().filter(|word| !word.trim().is_empty()).count();
    let common =
        start + end + pairs.iter().filter(|(i, _)| left.get(*i).is_some_and(|word| !word.trim().is_empty())).count();
    let pairs = if common * 100 < said(&a).min(said(&b)) * LEAST_COMMON { Vec::new() } else { pairs };
    let mut steps = Vec::with_capacity(a.len() + b.len());
    steps.extend(a.iter().take(start).map(|word| Stretch::Same(word)));
    let mut from = (0, 0);
    for (i, j) in pairs.into_iter().chain([(left.len(), right.len())]) {
        steps.extend(left.get(from.0..i).unwrap_or_default().iter().map(|word| Stretch::Old(word)));
        steps.extend(right.get(from.1..j).unwrap_or_default().iter().map(|word| Stretch::New(word)));
        steps.extend(left.get(i).map(|word| Stretch::Same(word)));
        from = (i + 1, j + 1);
    }
    steps.extend(a.iter().skip(a.len() - end).map(|word| Stretch::Same(word)));
    steps
}

/// Words, and the blanks, line ends and signs between them, each on its own.
fn words(text: &str) -> Vec<&str> {
    let kind = |c: char| match c {
        '\n' => 0,
        c if c.is_whitespace() => 1,
        c if c.is_alphanumeric() || c == '_' => 2,
        _ => 3,
    };
    let mut words = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = match kind(first) {
            of @ (1 | 2) => rest.find(|c| kind(c) != of).unwrap_or(rest.len()),
            _ => first.len_utf8(),
        };
        let (word, behind) = rest.split_at(end);
        words.push(word);
        rest = behind;
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(old: &str, new: &str) -> String {
        let all = stretches(old, new).into_iter().map(|stretch| match stretch {
            Stretch::Same(text) => text.to_owned(),
            Stretch::Old(text) => format!("[-{text}]"),
            Stretch::New(text) => format!("[+{text}]"),
        });
        all.collect()
    }

    #[test]
    fn words_are_told_apart() {
        assert_eq!(shown("pump runs for 5 s", "pump runs for 10 s"), "pump runs for [-5][+10] s");
        assert_eq!(shown("one two", "one new two"), "one [+new][+ ]two");
        assert_eq!(shown("", "new"), "[+new]");
        assert_eq!(shown("same", "same"), "same");
        assert_eq!(shown("wait\nstop", "wait\ngo\nstop"), "wait\n[+go][+\n]stop");
    }

    #[test]
    fn texts_without_much_in_common_replace_each_other() {
        let all = stretches("start the first pump now", "valve closed by operator in manual mode the");
        assert!(all.iter().all(|stretch| !matches!(stretch, Stretch::Same(_))), "{all:?}");
    }

    /// Both texts can be read from the stretches, whatever they are.
    #[test]
    fn nothing_is_lost() {
        let texts = ["", "a", "a  b\r\nc", "x<y>&\"'", "ü ö; 日本 語", "a b c d e f", "f e d c b a"];
        for old in texts {
            for new in texts {
                let (mut a, mut b) = (String::new(), String::new());
                for stretch in stretches(old, new) {
                    let (Stretch::Same(text) | Stretch::Old(text) | Stretch::New(text)) = stretch;
                    if !matches!(stretch, Stretch::New(_)) {
                        a.push_str(text);
                    }
                    if !matches!(stretch, Stretch::Old(_)) {
                        b.push_str(text);
                    }
                }
                assert_eq!((a.as_str(), b.as_str()), (old, new));
            }
        }
    }

    #[test]
    fn long_texts_end_quickly() {
        let (old, new) = ("a b ".repeat(100_000), "b c ".repeat(100_000));
        assert!(stretches(&old, &new).len() > 1000);
    }
}
