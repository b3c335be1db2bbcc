//! The printouts read by themselves: each report must agree with its own totals,
//! so that a later difference to a project is not a fault of the witness.

use rungs_tests::corpus;
use rungs_tests::printout::{self, Printout};
use std::path::Path;

/// The one listing in the corpus that RSLogix did not print.
const TAGS: &str = "address_symbol_database.pdf.txt";

fn reports(root: &Path) -> Vec<(String, Printout)> {
    let paths = corpus::files(root, ".pdf.txt").expect("corpus can be listed");
    let read = |path: &Path| std::fs::read_to_string(path).expect("a report is UTF-8 text");
    let report = |p: &&std::path::PathBuf| !corpus::name(root, p).ends_with(TAGS);
    paths.iter().filter(report).map(|p| (corpus::name(root, p), printout::parse(&read(p)))).collect()
}

#[test]
fn every_line_of_every_report_is_understood() {
    let Some(root) = corpus::root() else { return };
    let (mut lines, mut count) = (Vec::new(), 0);
    for (name, report) in reports(&root) {
        count += 1;
        println!(
            "{name}: {} pages, {} program files, {} data files, {} values, {} symbol rows, {} rungs, {} lines left",
            report.pages,
            report.program_files.as_ref().map_or(0, Vec::len),
            report.data_files.as_ref().map_or(0, Vec::len),
            report.values.iter().map(|f| f.elements().count() + f.status.len()).sum::<usize>(),
            report.symbols.as_ref().map_or(0, Vec::len),
            report.ladder.iter().map(|f| f.rungs.len()).sum::<usize>(),
            report.unexplained.len(),
        );
        lines.extend(report.unexplained.into_iter().map(|u| format!("{name} page {}: {}", u.page, u.line)));
    }
    assert!(count > 0, "a corpus without any report");
    assert!(lines.is_empty(), "{} lines not understood:\n{}", lines.len(), lines[..lines.len().min(50)].join("\n"));
}

#[test]
fn rung_numbers_run_from_zero_to_the_printed_total() {
    let Some(root) = corpus::root() else { return };
    let mut wrong = Vec::new();
    for (name, report) in reports(&root) {
        for file in &report.ladder {
            let numbers: Vec<usize> = file.rungs.iter().map(|r| r.number).collect();
            if numbers != (0..file.total).collect::<Vec<_>>() {
                wrong.push(format!("{name} LAD {}: {} rungs told, found {numbers:?}", file.number, file.total));
            }
            let listed = report.program_files.iter().flatten().find(|row| row.number == file.number);
            if listed.is_some_and(|row| row.rungs != file.total || row.name != file.name) {
                wrong.push(format!("{name} LAD {}: pages and list differ", file.number));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn lists_agree_with_the_processor_page() {
    let Some(root) = corpus::root() else { return };
    let (mut wrong, mut checked) = (Vec::new(), 0);
    for (name, report) in reports(&root) {
        let (Some(processor), Some(programs), Some(data)) =
            (&report.processor, &report.program_files, &report.data_files)
        else {
            continue;
        };
        checked += 1;
        let words: u32 = data.iter().map(|row| row.words).sum();
        let told = processor.used.map(|(_, words)| words);
        if told.is_some_and(|told| told != words) {
            wrong.push(format!("{name}: words {told:?} told, {words} listed"));
        }
        let (programs, data) = (programs.len(), data.len());
        if (processor.program_files, processor.data_files) != (count(programs), count(data)) {
            let (told, other) = (processor.program_files, processor.data_files);
            wrong.push(format!("{name}: {told}, {other} files told, {programs}, {data} listed"));
        }
    }
    println!("{checked} reports with all three parts");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_listed_data_file_is_printed_with_all_its_elements() {
    let Some(root) = corpus::root() else { return };
    let (mut wrong, mut files) = (Vec::new(), 0);
    for (name, report) in reports(&root) {
        for row in report.data_files.iter().flatten() {
            let place = format!("{name} {}{}", row.kind, row.number);
            let per_element = match row.kind.as_str() {
                "O" | "I" | "T" | "C" | "R" => 3,
                "S" => 0,
                "F" | "L" => 2,
                "ST" => 42,
                _ => 1,
            };
            if row.words != per_element * row.elements {
                wrong.push(format!("{place}: {} words for {} elements", row.words, row.elements));
            }
            let Some(file) = report.values.iter().find(|f| f.kind == row.kind && f.number == row.number) else {
                wrong.push(format!("{place}: no values printed"));
                continue;
            };
            files += 1;
            let columns = match row.kind.as_str() {
                "O" | "I" | "B" => 16,
                "T" => 6,
                "C" => 8,
                "R" => 10,
                "ST" => 2,
                _ => 1,
            };
            let full = |values: usize| values == columns || (columns == 16 && values == 8);
            let found = match columns {
                1 => file.elements().count(),
                _ => file.rows.iter().filter(|r| full(r.values.len())).count(),
            };
            if row.kind != "S" && count(found) != row.elements {
                wrong.push(format!("{place}: {} elements listed, {found} printed", row.elements));
            }
            if file.name != row.name || (row.kind == "S") == file.status.is_empty() {
                wrong.push(format!("{place}: the pages are headed {}", file.name));
            }
        }
    }
    println!("{files} data files");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn symbols_are_global_and_rows_have_an_address_or_a_symbol() {
    let Some(root) = corpus::root() else { return };
    let mut wrong = Vec::new();
    for (name, report) in reports(&root) {
        for row in report.symbols.iter().flatten() {
            let global = if row.symbol.is_empty() { "" } else { "Global" };
            let unused = [&row.group, &row.device, &row.above, &row.below].iter().all(|t| t.is_empty());
            let named = !row.address.is_empty() || !row.symbol.is_empty();
            if !named || row.address.contains(' ') || row.scope != global || !unused {
                wrong.push(format!("{name}: {row:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_tag_dictionary_has_71_rows() {
    let Some(root) = corpus::root() else { return };
    for path in corpus::files(&root, TAGS).expect("corpus can be listed") {
        let text = std::fs::read_to_string(&path).expect("the listing is UTF-8 text");
        let (rows, lost) = printout::parse_tags(&text);
        assert_eq!(rows.len(), 71);
        assert_eq!(lost.len(), 2, "title and heading: {lost:?}");
    }
}

fn count(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}
