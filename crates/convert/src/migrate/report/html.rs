//! The report as one HTML page: no script, no network, everything escaped.

use std::fmt::Write as _;

use super::{Report, RungRow};

const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:78rem;padding:0 1rem;color:#1d2328;background:#fff}\
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem}table{border-collapse:collapse;margin:.5rem 0}\
th,td{text-align:left;vertical-align:top;padding:.25rem .7rem .25rem 0}th{border-bottom:1px solid #9aa5ad}\
.number{text-align:right}.warn{border-left:4px solid #b3560b;background:#fdf3e7;padding:.6rem 1rem}\
.rung{border:1px solid #cfd6da;border-radius:4px;margin:.8rem 0}.rung h3{font-size:.95rem;margin:0;padding:.35rem .7rem;background:#f1f4f5}\
.rung ul{margin:.4rem 0;padding-left:1.8rem}.sides{display:grid;grid-template-columns:1fr 1fr}\
pre{margin:0;padding:.6rem .7rem;white-space:pre-wrap;overflow-wrap:anywhere;font:13px/1.4 ui-monospace,monospace}\
.sides pre+pre{border-left:1px solid #cfd6da}.exact h3{border-left:6px solid #2f7d4f}.condition h3{border-left:6px solid #c98a12}\
.person h3{border-left:6px solid #b3261e}nav a{margin-right:.9rem}code{font:13px ui-monospace,monospace}\
@media print{.rung{break-inside:avoid}}";

pub(super) fn page(report: &Report) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = write!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n<title>Migration of {0} to Do-more</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>Migration of {0} to Do-more</h1>\n",
        escaped(&report.file)
    );
    let _ = writeln!(
        out,
        "<p>{} &middot; SHA-256 <code>{}</code></p>",
        escaped(&report.processor),
        escaped(&report.sha256)
    );
    let _ = writeln!(out, "<p class=\"warn\">{}</p>", escaped(report.unchecked));
    summary(&mut out, report);
    if let Some(proof) = &report.proof {
        out.push_str("<h2>Proof run</h2>\n<table>\n");
        for (name, value) in proof {
            let _ = writeln!(out, "<tr><th>{}</th><td>{}</td></tr>", escaped(name), escaped(value));
        }
        out.push_str("</table>\n");
    }
    if !report.notes.is_empty() {
        out.push_str("<h2>The program as a whole</h2>\n<ul>\n");
        for note in &report.notes {
            let _ = writeln!(out, "<li><code>{}</code> {}</li>", note.code, escaped(&note.text));
        }
        out.push_str("</ul>\n");
    }
    unconfirmed(&mut out, report);
    open_rungs(&mut out, report);
    let mut file = None;
    for rung in &report.rungs {
        if file != Some(rung.file) {
            file = Some(rung.file);
            let _ = writeln!(out, "<h2 id=\"f{0}\">Program file {0}</h2>", rung.file);
        }
        self::rung(&mut out, rung);
    }
    out.push_str("</body>\n</html>\n");
    out
}

fn summary(out: &mut String, report: &Report) {
    let counts = report.counts;
    out.push_str("<h2>Summary</h2>\n<table>\n<tr><th>Rungs</th><th class=\"number\">Count</th><th class=\"number\">Share</th></tr>\n");
    let rows = [
        ("converted exactly", counts.exact),
        ("converted with a stated condition", counts.condition),
        ("need a person", counts.person),
        ("all", counts.rungs),
    ];
    for (name, count) in rows {
        let share = if counts.rungs == 0 { 0.0 } else { 100.0 * count as f64 / counts.rungs as f64 };
        let _ = writeln!(
            out,
            "<tr><td>{name}</td><td class=\"number\">{count}</td><td class=\"number\">{share:.1} %</td></tr>"
        );
    }
    out.push_str("</table>\n");
    if !report.marks.is_empty() {
        out.push_str(
            "<table>\n<tr><th>Code</th><th>PCE</th><th>Trap</th><th class=\"number\">Conditions</th><th class=\"number\">Persons</th></tr>\n",
        );
        for row in &report.marks {
            let _ = writeln!(
                out,
                "<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>",
                row.code,
                row.pce.map(|number| number.to_string()).unwrap_or_default(),
                row.title,
                row.conditions,
                row.persons
            );
        }
        out.push_str("</table>\n");
    }
}

fn unconfirmed(out: &mut String, report: &Report) {
    out.push_str("<h2>Not checked against Designer</h2>\n");
    if report.unconfirmed.is_empty() {
        out.push_str("<p>All forms of the result stand in exports of Designer.</p>\n");
        return;
    }
    out.push_str("<table>\n<tr><th>Form</th><th>Known from</th><th class=\"number\">Uses</th></tr>\n");
    for form in &report.unconfirmed {
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td></tr>",
            escaped(&form.form),
            form.evidence,
            form.uses
        );
    }
    out.push_str("</table>\n");
}

/// Links to the rungs that need a look.
fn open_rungs(out: &mut String, report: &Report) {
    for (verdict, title) in [("person", "Rungs that need a person"), ("condition", "Rungs with a condition")] {
        let rungs: Vec<_> = report.rungs.iter().filter(|rung| rung.verdict == verdict).collect();
        if rungs.is_empty() {
            continue;
        }
        let _ = writeln!(out, "<h2>{title}</h2>\n<nav>");
        for rung in rungs {
            let _ = writeln!(out, "<a href=\"#r{0}-{1}\">{0}:{1}</a>", rung.file, rung.rung);
        }
        out.push_str("</nav>\n");
    }
}

fn rung(out: &mut String, rung: &RungRow) {
    let _ = writeln!(
        out,
        "<section class=\"rung {verdict}\" id=\"r{file}-{number}\">\n<h3>SLC {file}:{number} &rarr; {block} rung {to} &middot; {verdict}</h3>",
        verdict = rung.verdict,
        file = rung.file,
        number = rung.rung,
        block = escaped(&rung.block),
        to = rung.block_rung
    );
    if !rung.notes.is_empty() {
        out.push_str("<ul>\n");
        for note in &rung.notes {
            let _ = writeln!(out, "<li><code>{}</code> {}</li>", note.code, escaped(&note.text));
        }
        out.push_str("</ul>\n");
    }
    let _ = writeln!(
        out,
        "<div class=\"sides\"><pre>{}</pre><pre>{}</pre></div>\n</section>",
        escaped(&rung.original),
        escaped(&rung.result.join("\n"))
    );
}

/// Text in HTML; characters that could command something become visible.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' => out.push('\n'),
            c if c.is_control() || turns(c) => out.push('\u{FFFD}'),
            c => out.push(c),
        }
    }
    out
}

/// Turns the direction of writing: what is shown would not be what is there.
fn turns(c: char) -> bool {
    matches!(c, '\u{061C}' | '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_a_project_becomes_markup() {
        assert_eq!(escaped("<b>\"&'\u{7}"), "&lt;b&gt;&quot;&amp;&#39;\u{FFFD}");
    }
}
