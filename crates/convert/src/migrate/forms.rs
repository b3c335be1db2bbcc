//! Which forms of a result were never seen to pass through Designer.

use std::collections::BTreeMap;

use domore::Project;
use domore::address::{Address, Cast, Element, Operand, View};
use domore::instruction::{Evidence, by_mnemonic};

/// A form the result uses that could not be checked against Designer itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Form {
    /// What it is: `HALT`, `C0:SW`, ...
    pub form: String,
    /// How it is known: `inferred`, `generator`, `help`, ...
    pub evidence: &'static str,
    /// How often the result uses it.
    pub uses: usize,
}

/// All such forms of a project, by name.
pub fn unconfirmed(project: &Project) -> Vec<Form> {
    let mut found: BTreeMap<(String, &'static str), usize> = BTreeMap::new();
    for instruction in project.code_blocks().flat_map(|block| &block.rungs).flat_map(|rung| &rung.instructions) {
        let mut count = |form: &str, evidence: &'static str| {
            *found.entry((form.to_owned(), evidence)).or_default() += 1;
        };
        match by_mnemonic(&instruction.mnemonic) {
            Some(entry) if entry.evidence.is_confirmed() => {}
            Some(entry) => count(entry.mnemonic, entry.evidence.as_str()),
            None => count(&instruction.mnemonic, Evidence::Inferred.as_str()),
        }
        // An export calls a subroutine without parameters just so.
        if instruction.is("CALL") && instruction.operands.iter().skip(1).ne(PLAIN_CALL) {
            count("CALL with parameters: its flags", "inferred");
        }
        for operand in &instruction.operands {
            match Operand::parse(operand) {
                Ok(Operand::Address(address)) => of_address(&address, &mut count),
                Ok(Operand::Quoted(text)) if instruction.is("MATH") => of_expression(&text, &mut count),
                _ => {}
            }
        }
    }
    found.into_iter().map(|((form, evidence), uses)| Form { form, evidence, uses }).collect()
}

/// An operator or function in the expressions of a rung that is inferred.
pub(super) fn in_expressions(code: &[domore::Instruction]) -> Option<String> {
    let mut found = None;
    for instruction in code.iter().filter(|instruction| instruction.is("MATH")) {
        if let Ok(Operand::Quoted(text)) = Operand::parse(instruction.operand(1)) {
            of_expression(&text, &mut |form, evidence| {
                if evidence == Evidence::Inferred.as_str() {
                    found.get_or_insert_with(|| form.to_owned());
                }
            });
        }
    }
    found
}

/// Levels of parentheses an expression of MATH may have, those of functions included. (vendor's product page: nesting
/// to 8 levels)
const MOST_LEVELS: usize = 8;

/// Levels of the deepest expression of a rung, if Designer would not take it.
pub(super) fn too_deep(code: &[domore::Instruction]) -> Option<usize> {
    let maths = code.iter().filter(|instruction| instruction.is("MATH"));
    maths.map(|instruction| levels(instruction.operand(1))).max().filter(|levels| *levels > MOST_LEVELS)
}

fn levels(text: &str) -> usize {
    let (mut depth, mut most) = (0_usize, 0);
    for c in text.chars() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        most = most.max(depth);
    }
    most
}

fn of_address(address: &Address, count: &mut impl FnMut(&str, &'static str)) {
    match address.cast {
        None => {}
        Some(Cast::Bit(_)) => count("bit of a word as operand, such as N5:3", "help"),
        Some(Cast::Byte(_) | Cast::Word(_)) => count("byte or word of an element as operand", "help"),
        Some(Cast::As(View::SignedDword, None)) => {}
        Some(Cast::As(View::UnsignedWord, None)) => count("16 bits as a word, such as C0:UW", "help"),
        Some(Cast::As(..)) => count("16 bits as a signed word, such as C0:SW", "third-party"),
    }
    if matches!(address.element, Element::Indexed { .. }) {
        count("index expression as an operand, such as N[D0+1]", "inferred");
    }
    if address.field.as_deref() == Some("Acc") {
        count("writing or reading .Acc of a timer as an operand", "help");
    }
}

/// What stands behind the name of a subroutine that is called without parameters. (Designer export)
pub(super) const PLAIN_CALL: [&str; 4] = ["0x0", "DST511", "\"3\"", "\"3\""];

/// Operators and functions exports do not show.
const OPERATORS: [(&str, &str, &str); 8] = [
    ("&", "operator & in MATH", "generator"),
    ("|", "operator | in MATH", "generator"),
    ("^", "operator ^ in MATH", "inferred"),
    ("<<", "operator << in MATH", "generator"),
    (">>", "operator >> in MATH", "generator"),
    (">=", "operator >= in MATH", "inferred"),
    ("<=", "operator <= in MATH", "inferred"),
    ("!=", "operator != in MATH", "inferred"),
];

/// Functions exports show.
const FUNCTIONS: [&str; 7] = ["IF", "ROUND", "TRUNC", "FRAC", "ABS", "TOREAL", "AVGR"];

fn of_expression(text: &str, count: &mut impl FnMut(&str, &'static str)) {
    for (sign, form, evidence) in OPERATORS {
        let shown = match sign {
            // `<<` holds `<`, `>=` holds `>`: only the sign itself counts.
            "&" | "|" | "^" => text.contains(sign),
            other => text.contains(other),
        };
        if shown {
            count(form, evidence);
        }
    }
    let mut rest = text;
    while let Some(at) = rest.find('(') {
        let (before, behind) = rest.split_at(at);
        let start = before.rfind(|c: char| !c.is_ascii_alphanumeric()).map_or(0, |at| at + 1);
        let name = before.get(start..).unwrap_or("");
        if name.starts_with(|c: char| c.is_ascii_alphabetic()) && !FUNCTIONS.contains(&name) {
            count(&format!("function {name} in MATH"), "inferred");
        }
        rest = behind.get(1..).unwrap_or("");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_of_parentheses_are_counted() {
        assert_eq!(levels("\"((N0 + 1) * IF(N1 > (2), 3, (4))) - (5)\""), 3);
        let rung = |inner: usize| {
            let text = format!("\"{}N0{}\"", "(".repeat(inner), ")".repeat(inner));
            [domore::Instruction::new("MATH", ["D0".to_owned(), text])]
        };
        assert_eq!((too_deep(&rung(8)), too_deep(&rung(9))), (None, Some(9)));
    }

    #[test]
    fn expressions_are_looked_into() {
        let mut found = Vec::new();
        of_expression("IF(N0 >= 3, SQRT(R0), N1 & 15)", &mut |form, _| found.push(form.to_owned()));
        assert_eq!(found, ["operator & in MATH", "operator >= in MATH", "function SQRT in MATH"]);
    }
}
