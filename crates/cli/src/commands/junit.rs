//! JUnit XML, the form build servers read test results in.

use std::fmt::Write;

/// One test case.
pub struct Case {
    /// Folder of the scenario.
    pub class: String,
    /// Its file and name.
    pub name: String,
    /// Wall-clock seconds it took.
    pub seconds: f64,
    /// How it went.
    pub result: Verdict,
    /// What a reader must know beside the verdict: approximations; a line each.
    pub notes: Vec<String>,
}

/// How a case went.
pub enum Verdict {
    /// Everything as expected.
    Passed,
    /// Expectations not met, one line each.
    Failed(Vec<String>),
    /// It could not be carried out.
    Error(String),
}

/// The whole document.
pub fn document(cases: &[Case]) -> String {
    let count = |wanted: fn(&Verdict) -> bool| cases.iter().filter(|case| wanted(&case.result)).count();
    let failures = count(|verdict| matches!(verdict, Verdict::Failed(_)));
    let errors = count(|verdict| matches!(verdict, Verdict::Error(_)));
    let seconds: f64 = cases.iter().map(|case| case.seconds).sum();
    let counts = format!(
        "name=\"rungs test\" tests=\"{}\" failures=\"{failures}\" errors=\"{errors}\" time=\"{seconds:.3}\"",
        cases.len()
    );
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    // Writing to a string cannot fail.
    let _ = writeln!(text, "<testsuites {counts}>\n<testsuite {counts}>");
    for case in cases {
        let (class, name) = (escape(&case.class), escape(&case.name));
        let _ = write!(text, "<testcase classname=\"{class}\" name=\"{name}\" time=\"{:.3}\"", case.seconds);
        let verdict = match &case.result {
            Verdict::Passed => None,
            Verdict::Failed(lines) => Some(("failure", lines.as_slice())),
            Verdict::Error(line) => Some(("error", std::slice::from_ref(line))),
        };
        if verdict.is_none() && case.notes.is_empty() {
            text.push_str("/>\n");
            continue;
        }
        text.push_str(">\n");
        if let Some((element, lines)) = verdict {
            let message = escape(lines.first().map_or("", String::as_str));
            let _ = writeln!(text, "<{element} message=\"{message}\">{}</{element}>", escape(&lines.join("\n")));
        }
        if !case.notes.is_empty() {
            let _ = writeln!(text, "<system-out>{}</system-out>", escape(&case.notes.join("\n")));
        }
        text.push_str("</testcase>\n");
    }
    text.push_str("</testsuite>\n</testsuites>\n");
    text
}

/// Text as XML takes it; characters XML cannot hold become `?`.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(c),
            c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => escaped.push('?'),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_escapes() {
        let case =
            |name: &str, result| Case { class: "a".into(), name: name.into(), seconds: 0.5, result, notes: Vec::new() };
        let text = document(&[
            case("x<y", Verdict::Passed),
            case("b", Verdict::Failed(vec!["N7:0 \"1\"".into(), "more".into()])),
            case("c", Verdict::Error("no\u{1} file".into())),
            Case { notes: vec!["approximate: PTO < pulses".into()], ..case("d", Verdict::Passed) },
        ]);
        assert!(text.contains(
            "name=\"d\" time=\"0.500\">\n<system-out>approximate: PTO &lt; pulses</system-out>\n</testcase>"
        ));
        assert!(text.contains("tests=\"4\" failures=\"1\" errors=\"1\" time=\"2.000\""));
        assert!(text.contains("name=\"x&lt;y\" time=\"0.500\"/>"));
        assert!(text.contains("<failure message=\"N7:0 &quot;1&quot;\">N7:0 &quot;1&quot;\nmore</failure>"));
        assert!(text.contains("<error message=\"no? file\">"));
    }
}
