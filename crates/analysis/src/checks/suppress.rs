//! Findings taken out on purpose: rules in a file, and remarks in rung comments.

use std::collections::HashMap;

use ladder::Image;
use toml::de::{DeTable, DeValue};

use super::{Finding, by_code};

/// Rules of a suppression file.
#[derive(Clone, Debug, Default)]
pub struct Rules {
    list: Vec<Rule>,
}

/// One `[[allow]]` of a suppression file: every condition given must hold.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rule {
    /// Code of the check.
    pub check: String,
    /// Name of the project's file.
    pub project: Option<String>,
    /// Program file.
    pub file: Option<u16>,
    /// Rung of that file.
    pub rung: Option<u32>,
    /// Address the finding is about, as it is printed.
    pub address: Option<String>,
    /// Why: for people.
    pub reason: String,
}

impl Rules {
    /// Reads a suppression file (TOML): a list of `[[allow]]` tables.
    ///
    /// # Errors
    /// What is wrong, with the number of the rule.
    pub fn parse(text: &str) -> Result<Rules, String> {
        let table = DeTable::parse(text).map_err(|error| error.message().to_owned())?;
        let mut list = Vec::new();
        for (key, value) in table.get_ref() {
            let rules = match (&**key.get_ref(), value.get_ref()) {
                ("allow", DeValue::Array(rules)) => rules,
                (key, _) => return Err(format!("expected [[allow]] tables, found `{key}`")),
            };
            for (number, rule) in (1..).zip(rules.iter()) {
                list.push(one(rule.get_ref()).map_err(|why| format!("[[allow]] number {number}: {why}"))?);
            }
        }
        Ok(Rules { list })
    }

    /// The rules in the order of the file.
    pub fn list(&self) -> &[Rule] {
        &self.list
    }

    /// Adds the rules of another file behind these.
    pub fn extend(&mut self, other: Rules) {
        self.list.extend(other.list);
    }

    /// The first rule that takes a finding out, in words.
    pub(super) fn allow(&self, finding: &Finding, project: &str) -> Option<String> {
        let holds = |rule: &&Rule| {
            rule.check == finding.check.code
                && rule.project.as_ref().is_none_or(|name| name == project)
                && rule.address.as_ref().is_none_or(|address| *address == finding.address)
                && (rule.file.is_none()
                    || finding
                        .locations
                        .iter()
                        .any(|at| rule.file == Some(at.file) && rule.rung.is_none_or(|rung| rung == at.rung)))
        };
        let rule = self.list.iter().find(holds)?;
        Some(if rule.reason.is_empty() { "rule".to_owned() } else { format!("rule: {}", rule.reason) })
    }
}

fn one(rule: &DeValue<'_>) -> Result<Rule, String> {
    let DeValue::Table(table) = rule else { return Err("expected a table".to_owned()) };
    let mut made = Rule::default();
    for (key, value) in table {
        let (key, value) = (&**key.get_ref(), value.get_ref());
        let text = || match value {
            DeValue::String(text) => Ok(text.to_string()),
            _ => Err(format!("`{key}` is a text in quotes")),
        };
        let number = || match value {
            DeValue::Integer(number) => {
                i64::from_str_radix(number.as_str(), number.radix()).map_err(|_| format!("`{key}` is out of range"))
            }
            _ => Err(format!("`{key}` is a number")),
        };
        let bad = |_| format!("`{key}` is out of range");
        match key {
            "check" => {
                let code = text()?;
                made.check = by_code(&code).ok_or_else(|| format!("there is no check `{code}`"))?.code.to_owned();
            }
            "project" => made.project = Some(text()?),
            "file" => made.file = Some(u16::try_from(number()?).map_err(bad)?),
            "rung" => made.rung = Some(u32::try_from(number()?).map_err(bad)?),
            "address" => made.address = Some(text()?),
            "reason" => made.reason = text()?,
            _ => return Err(format!("`{key}` is none of check, project, file, rung, address, reason")),
        }
    }
    if made.check.is_empty() {
        return Err("`check` is missing".to_owned());
    }
    if made.rung.is_some() && made.file.is_none() {
        return Err("`rung` needs `file`".to_owned());
    }
    Ok(made)
}

/// What stands before the codes in a rung comment.
const MARK: &str = "rungs: allow ";

/// Codes allowed by the comment of each rung.
pub(super) type Comments = HashMap<(u16, u32), Vec<&'static str>>;

pub(super) fn comments(image: &Image) -> Comments {
    let mut all = Comments::new();
    for file in image.ladder_files() {
        for (number, rung) in (0..).zip(&file.rungs) {
            let Some(comment) = &rung.comment else { continue };
            let codes = comment.text.lines().chain([comment.title.as_str()]).flat_map(codes);
            let codes: Vec<_> = codes.collect();
            if !codes.is_empty() {
                all.insert((file.number, number), codes);
            }
        }
    }
    all
}

/// The codes a line of a comment allows: `rungs: allow OUT01, TIM04`.
fn codes(line: &str) -> Vec<&'static str> {
    let Some(at) = line.to_ascii_lowercase().find(MARK) else { return Vec::new() };
    let rest = line.get(at + MARK.len()..).unwrap_or("");
    let words = rest.split([' ', ',']).filter(|word| !word.is_empty());
    words.map_while(|word| by_code(word.trim_end_matches(['.', ';'])).map(|check| check.code)).collect()
}

/// The comment that takes a finding out: that of any rung the finding lists.
pub(super) fn in_comment(comments: &Comments, finding: &Finding) -> Option<String> {
    let allows = |at: &&crate::Location| {
        comments.get(&(at.file, at.rung)).is_some_and(|codes| codes.contains(&finding.check.code))
    };
    finding.locations.iter().find(allows).map(|at| format!("comment of rung {at}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_name_codes() {
        assert_eq!(codes("seal-in. Rungs: allow out01, TIM04. because"), ["OUT01", "TIM04"]);
        assert_eq!(codes("rungs: allow nothing"), [""; 0]);
        assert_eq!(codes("rungs: allow"), [""; 0]);
    }

    #[test]
    fn rules_are_read_or_refused() {
        let rules = Rules::parse(
            "[[allow]]\ncheck = \"out01\"\nfile = 2\nrung = 3\nreason = \"jog and run\"\n[[allow]]\ncheck = \"IOC02\"\n",
        );
        let rules = rules.expect("rules");
        assert_eq!((rules.list().len(), rules.list()[0].rung, rules.list()[0].check.as_str()), (2, Some(3), "OUT01"));
        for (text, why) in [
            ("[[allow]]\ncheck = \"XXX99\"", "no check"),
            ("[[allow]]\nfile = 2", "missing"),
            ("[[allow]]\ncheck = \"OUT01\"\nrung = 1", "needs `file`"),
            ("[[allow]]\ncheck = \"OUT01\"\nfile = -1", "range"),
            ("[[deny]]\ncheck = \"OUT01\"", "deny"),
            ("allow", ""),
        ] {
            assert!(Rules::parse(text).is_err_and(|error| error.contains(why)), "{text}");
        }
    }
}
