//! Every input and output that a program of the corpus names is a point of a module in its I/O configuration.

use ladder::{Address, Family, FileType, Image, Operand, Place};
use rungs_tests::corpus;
use std::collections::BTreeSet;

/// Addresses of files I and O in an operand, those in brackets and expressions included.
fn collect<'a>(address: &'a Address, found: &mut Vec<&'a Address>) {
    if matches!(address.file_type, FileType::I | FileType::O) {
        found.push(address);
    }
    for inner in address.indirections() {
        collect(inner, found);
    }
}

fn addresses(image: &Image) -> Vec<&Address> {
    let mut found = Vec::new();
    let rungs = image.program_files.iter().flat_map(|file| &file.rungs);
    for operand in rungs.flat_map(|rung| rung.instructions()).flat_map(|instruction| &instruction.operands) {
        match operand {
            Operand::Address(address) => collect(address, &mut found),
            Operand::Expression(expression) => {
                let addresses = expression.operands().into_iter().filter_map(Operand::address);
                addresses.for_each(|address| collect(address, &mut found));
            }
            _ => {}
        }
    }
    found
}

#[test]
fn every_io_operand_is_a_point_of_a_module() {
    let Some(root) = corpus::root() else { return };
    let (mut resolved, mut run_time, mut left_over) = (0_usize, 0_usize, 0_usize);
    let (mut wrong, mut left_over_in) = (Vec::new(), BTreeSet::new());
    for path in corpus::files(&root, ".rss").expect("corpus can be listed") {
        let name = corpus::name(&root, &path);
        let bytes = std::fs::read(&path).expect("a project can be read");
        let Ok(project) = convert::open(&bytes, &name, rss::Mode::Permissive) else { continue };
        let images = [Some(&project.main), project.online.as_ref(), project.autosave.as_ref()];
        for image in images.into_iter().flatten() {
            for address in addresses(image) {
                if matches!(address.element, Place::Indirect(_)) {
                    // The slot is known only while the program runs.
                    run_time += 1;
                    continue;
                }
                match image.io.resolve(address) {
                    Some(point) if point.in_range && point.slot.module.catalog.is_some() => {
                        let words =
                            image.data_file(address.file_type, if address.file_type == FileType::O { 0 } else { 1 });
                        let words = words.map_or(0, |file| file.elements);
                        assert!(point.word_index < words, "{name} {address}: word {} of {words}", point.word_index);
                        resolved += 1;
                    }
                    // Two programs of MicroLogix 1000 controllers keep outputs of another controller's slot 2.
                    None if image.family() == Family::MicroLogix1000 && is_slot_2_output(address) => {
                        left_over += 1;
                        left_over_in.insert(name.clone());
                    }
                    found => wrong.push(format!("{name} {address}: {found:?}")),
                }
            }
        }
    }
    println!("{resolved} I/O operands resolved, {run_time} left to the run, {left_over} in no slot: {left_over_in:?}");
    assert!(wrong.is_empty(), "{} operands:\n{}", wrong.len(), wrong[..wrong.len().min(30)].join("\n"));
    assert!(resolved > 0, "a corpus without I/O operands");
    assert_eq!((left_over, left_over_in.len()), (13, 2));
}

fn is_slot_2_output(address: &Address) -> bool {
    address.file_type == FileType::O && address.element == Place::Number(2)
}
