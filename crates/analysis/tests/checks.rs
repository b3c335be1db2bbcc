//! Each check finds what it is for, and leaves alone what only looks like it.

mod support;

use std::collections::BTreeSet;

use analysis::checks::{self, Rules, Severity};
use convert::slc::rung::parse_rung;
use ladder::{
    Address, AddressEntry, Comment, CommentOwner, DataFile, Family, FileType, Force, Image, Instruction, Mnemonic,
    ProgramFile, ProgramFileKind, Target,
};
use support::set;

/// An image with a rung per line; `@3` begins program file 3.
fn program(lines: &[&str]) -> Image {
    let mut image = support::image(&[]);
    for line in lines {
        if let Some(number) = line.strip_prefix('@') {
            image.program_files.push(ProgramFile {
                number: number.parse().expect("a file number"),
                name: String::new(),
                description: String::new(),
                kind: ProgramFileKind::Ladder,
                rungs: Vec::new(),
            });
            continue;
        }
        let rung = if line.contains("BST") {
            parse_rung(line, Some(image.family())).expect(line)
        } else {
            support::rung(line)
        };
        image.program_files.last_mut().expect("file 2").rungs.push(rung);
    }
    image
}

fn find(image: &Image, code: &str) -> Vec<String> {
    let report = checks::run(image, &image.documentation, "x.RSS", &Rules::default(), |check| check.code == code);
    report.findings.iter().map(|it| format!("{} {}", it.address, it.message)).collect()
}

type Change = fn(&mut Image);

/// A program and what is changed in it before it is checked.
struct Case(&'static [&'static str], Change);

fn same(_: &mut Image) {}

fn name(image: &mut Image, address: &str, symbol: &str) {
    let target = Target::Address(Address::parse(address).expect(address));
    image.documentation.add(AddressEntry { target, symbol: symbol.into(), description: Vec::new() });
}

fn micrologix(image: &mut Image) {
    image.processor.family = Family::MicroLogix1400;
}

/// A high-speed counter with routine 3, high preset 100 and this overflow.
fn counter(image: &mut Image, overflow: u16) {
    micrologix(image);
    let mut file = DataFile::new(FileType::HSC, 0, 0);
    (file.elements, file.words_per_element, file.words) = (1, 36, vec![0; 36]);
    (file.words[0], file.words[7], file.words[11]) = (3, 100, overflow);
    image.function_files.push(file);
}

fn force(image: &mut Image) {
    image.data_files[0].forces[0] = Force { on: 4, off: 0xFFFF };
}

fn detach(image: &mut Image) {
    let owner = CommentOwner::Rung { file: 2, rung: 9 };
    image.documentation.detached_comments.push(Comment { text: "gone".into(), title: String::new(), owner });
}

#[rustfmt::skip]
const CASES: &[(&str, Case, Case)] = &[
    ("OUT01", Case(&["XIC I:0/0; OTE B3:0/1", "XIC I:0/1; OTE B3:0/1"], same), Case(&["XIC I:0/0; OTE B3:0/1", "XIC I:0/1; OTE B3:0/2"], same)),
    ("OUT02", Case(&["XIC I:0/0; OTL B3:0/1"], same), Case(&["XIC I:0/0; OTL B3:0/1", "MOV 0 B3:0"], same)),
    ("OUT03", Case(&["XIC I:0/0; OTL O:0/1", "JSR U:3", "@3", "XIC I:0/1; OTU O:0/1"], same), Case(&["XIC I:0/0; OTL O:0/1", "XIC I:0/1; OTU O:0/1"], same)),
    ("OUT04", Case(&["XIC I:0/0; OTU B3:0/1"], same), Case(&["XIC I:0/0; OTU B3:0/1", "XIC I:0/1; OTL B3:0/1"], same)),
    ("OUT05", Case(&["XIC I:0/0; OTE B3:0/1", "XIC I:0/1; OTL B3:0/1"], same), Case(&["XIC I:0/0; OTL B3:0/1", "XIC I:0/1; OTU B3:0/1"], same)),
    ("OUT06", Case(&["XIC I:0/0; OTE O:0/1", "MOV N7:0 O:0"], same), Case(&["XIC I:0/0; OTE O:0/1", "MOV N7:0 O:2"], same)),
    ("OUT07", Case(&["XIC B3:0/1; OTE O:0/0", "XIC I:0/0; OTE B3:0/1"], same), Case(&["XIC I:0/0; OTE B3:0/1", "XIC B3:0/1; OTE O:0/0"], same)),
    ("OUT08", Case(&["XIC I:0/0; JSR U:3", "@3", "XIC I:0/1; OTE O:0/1"], same), Case(&["JSR U:3", "@3", "XIC I:0/1; OTE O:0/1"], same)),
    ("OUT09", Case(&["XIC I:0/0; OTL O:0/1"], same), Case(&["XIC I:0/0; OTE O:0/1"], same)),
    ("OUT10", Case(&["XIC I:0/0; OSR B3:0/1; OTE B3:0/2", "XIC I:0/1; OSR B3:0/1; OTE B3:0/3"], same), Case(&["XIC I:0/0; OSR B3:0/1; OTE B3:0/2", "XIC I:0/1; OSR B3:0/4; OTE B3:0/3"], same)),
    ("OUT11", Case(&["XIC I:0/0; OSR B3:0/1; OTE B3:0/2", "MOV 0 B3:0"], same), Case(&["XIC I:0/0; OSR B3:0/1; OTE B3:0/2", "MOV 0 B3:1"], same)),
    ("LOG01", Case(&["XIC I:0/0 BST XIO I:0/0 NXB XIC I:0/1 BND OTE B3:0/1"], same), Case(&["XIC B3:0/0; OTU B3:0/0; XIO B3:0/0; OTE B3:0/1"], same)),
    ("LOG02", Case(&["BST XIC I:0/0 NXB BND OTE B3:0/1"], same), Case(&["BST XIC I:0/0 OTE B3:0/3 NXB BND OTE B3:0/1"], same)),
    ("LOG03", Case(&["OTE B3:0/1"], same), Case(&["BST XIC I:0/0 NXB XIC I:0/1 BND OTE B3:0/1", "OTU S:5/0"], same)),
    ("LOG04", Case(&["XIC I:0/0; XIC I:0/1; XIC I:0/0; OTE B3:0/1"], same), Case(&["BST XIC I:0/0 NXB XIC I:0/0 XIC I:0/1 BND OTE B3:0/1"], same)),
    ("LOG05", Case(&["BST XIC I:0/0 NXB XIO I:0/0 BND OTE B3:0/1"], same), Case(&["BST XIC I:0/0 XIC I:0/1 NXB XIO I:0/0 BND OTE B3:0/1"], same)),
    ("LOG06", Case(&["EQU N7:0 N7:0; OTE B3:0/1"], same), Case(&["EQU N7:0 N7:1; OTE B3:0/1"], same)),
    ("LOG07", Case(&["LIM 10 N7:0 5; OTE B3:0/1"], same), Case(&["LIM 5 N7:0 10; OTE B3:0/1"], same)),
    ("LOG08", Case(&["XIC B3:0/0; OTE B3:0/1"], same), Case(&["XIC B3:0/0; OTE B3:0/1", "MOV 1 B3:0"], same)),
    ("LOG09", Case(&["BST XIC I:0/0 NXB XIC I:0/0 BND OTE B3:0/1"], same), Case(&["BST XIC I:0/0 NXB XIC I:0/1 BND OTE B3:0/1"], same)),
    ("TIM01", Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "XIC I:0/1; TON T4:0 0.01 5 0"], same), Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "XIC I:0/1; TON T4:1 0.01 5 0"], same)),
    ("TIM02", Case(&["XIC I:0/0; TON T4:0 0.01 0 0"], same), Case(&["XIC I:0/0; TON T4:0 0.01 0 0", "MOV N7:0 T4:0.PRE"], same)),
    ("TIM03", Case(&["XIC I:0/0; TON T4:0 0.01 -5 0"], |image| set(image, FileType::T, 4, 1, 0xFFFB)), Case(&["XIC I:0/0; TON T4:0 0.01 5 0"], |image| set(image, FileType::T, 4, 1, 5))),
    ("TIM04", Case(&["XIC I:0/0; TOF T4:0 0.01 5 0", "XIC I:0/1; RES T4:0"], same), Case(&["XIC I:0/0; RTO T4:0 0.01 5 0", "XIC I:0/1; RES T4:0"], same)),
    ("TIM05", Case(&["XIC I:0/0; RTO T4:0 0.01 5 0"], same), Case(&["XIC I:0/0; RTO T4:0 0.01 5 0", "XIC I:0/1; RES T4:0"], same)),
    ("TIM06", Case(&["XIC T4:0/DN; OTE B3:0/1"], same), Case(&["XIC T4:0/DN; OTE B3:0/1", "XIC I:0/0; TON T4:0 0.01 5 0"], same)),
    ("TIM07", Case(&["XIC I:0/0; TON T4:0 0.01 5 0"], same), Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "XIC T4:0/DN; OTE B3:0/1"], same)),
    ("TIM08", Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "XIC I:0/0; TON T4:1 1.0 5 0", "MOV T4:0.PRE T4:1.PRE"], |image| set(image, FileType::T, 4, 3, 0x200)), Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "XIC I:0/0; TON T4:1 0.01 5 0", "MOV T4:0.PRE T4:1.PRE"], same)),
    ("TIM09", Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "XIC I:0/1; OTU T4:0/DN"], same), Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "XIC I:0/1; OTU T4:1/DN"], same)),
    ("TIM10", Case(&["TON T4:0 0.01 5 0"], same), Case(&["TON T4:0 0.01 5 0", "XIC T4:0/DN; RES T4:0"], same)),
    ("TIM11", Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "EQU T4:0.ACC 3; OTE B3:0/1"], same), Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "GEQ T4:0.ACC 3; OTE B3:0/1"], same)),
    ("TIM12", Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "GEQ T4:0.ACC 5; OTE B3:0/1"], |image| set(image, FileType::T, 4, 1, 5)), Case(&["XIC I:0/0; TON T4:0 0.01 5 0", "GEQ T4:0.ACC 4; OTE B3:0/1"], |image| set(image, FileType::T, 4, 1, 5))),
    ("TIM13", Case(&["XIC I:0/0; TON T4:0 1.0 2 0"], |image| set(image, FileType::T, 4, 1, 2)), Case(&["XIC I:0/0; TON T4:0 1.0 20 0"], |image| set(image, FileType::T, 4, 1, 20))),
    ("TIM14", Case(&["XIC I:0/0; OTE B3:0/1"], |image| set(image, FileType::T, 4, 1, 2)), Case(&["XIC I:0/0; TON T4:0 1.0 2 0"], |image| set(image, FileType::T, 4, 1, 2))),
    ("CNT01", Case(&["XIC I:0/0; CTU C5:0 5 0", "XIC I:0/1; CTU C5:0 5 0"], same), Case(&["XIC I:0/0; CTU C5:0 5 0", "XIC I:0/1; CTD C5:0 5 0"], same)),
    ("CNT02", Case(&["XIC I:0/0; CTU C5:0 0 0", "XIC C5:0/DN; OTE B3:0/1"], same), Case(&["XIC I:0/0; CTU C5:0 0 0", "GEQ C5:0.ACC 4; OTE B3:0/1"], same)),
    ("CNT03", Case(&["XIC I:0/0; CTU C5:0 5 0"], same), Case(&["XIC I:0/0; CTU C5:0 5 0", "MOV 0 C5:0.ACC"], same)),
    ("CNT04", Case(&["CTU C5:0 5 0"], same), Case(&["XIC I:0/0; CTU C5:0 5 0"], same)),
    ("CNT05", Case(&["XIC C5:0/DN; OTE B3:0/1"], same), Case(&["XIC C5:0/DN; OTE B3:0/1", "XIC I:0/0; CTU C5:0 5 0"], same)),
    ("CNT06", Case(&["XIC I:0/0; CTU C5:0 5 0"], same), Case(&["XIC I:0/0; CTU C5:0 5 0", "MOV C5:0.ACC N7:0"], same)),
    ("CNT07", Case(&["XIC I:0/0; CTU C5:0 -5 0"], |image| set(image, FileType::C, 5, 1, 0xFFFB)), Case(&["XIC I:0/0; CTU C5:0 5 0"], |image| set(image, FileType::C, 5, 1, 5))),
    ("FLW01", Case(&["END", "@3", "XIC I:0/0; OTE B3:0/1", "END"], same), Case(&["JSR U:3", "END", "@3", "XIC I:0/0; OTE B3:0/1", "@4", "END"], same)),
    ("FLW02", Case(&["JSR U:9"], same), Case(&["JSR U:3", "@3", "END"], same)),
    ("FLW03", Case(&["XIC I:0/0; JMP Q2:1"], same), Case(&["XIC I:0/0; JMP Q2:1", "LBL Q2:1; OTE B3:0/1"], same)),
    ("FLW04", Case(&["LBL Q2:1; OTE B3:0/1", "LBL Q2:1; OTE B3:0/2"], same), Case(&["LBL Q2:1; OTE B3:0/1", "LBL Q2:2; OTE B3:0/2"], same)),
    ("FLW05", Case(&["XIC I:0/0; JMP Q2:1", "XIC I:0/1; MCR", "LBL Q2:1; OTE B3:0/1", "MCR"], same), Case(&["XIC I:0/0; JMP Q2:1", "XIC I:0/1; MCR", "MCR", "LBL Q2:1; OTE B3:0/1"], same)),
    ("FLW06", Case(&["XIC I:0/0; MCR", "XIC I:0/1; OTE B3:0/1"], same), Case(&["XIC I:0/0; MCR", "XIC I:0/1; OTE B3:0/1", "MCR"], same)),
    ("FLW07", Case(&["XIC I:0/0; OTE B3:0/1"], same), Case(&["XIC I:0/0; OTE B3:0/1", "END"], same)),
    ("FLW08", Case(&["LBL Q2:1; OTE B3:0/1", "XIC I:0/0; JMP Q2:1"], same), Case(&["XIC I:0/0; JMP Q2:1", "LBL Q2:1; OTE B3:0/1"], same)),
    ("FLW09", Case(&["LBL Q2:1; OTE B3:0/1"], same), Case(&["XIC I:0/0; JMP Q2:1", "LBL Q2:1; OTE B3:0/1"], same)),
    ("FLW10", Case(&["JSR U:3", "@3", "XIC I:0/0; JSR U:4", "@4", "JSR U:3"], same), Case(&["JSR U:3", "JSR U:4", "@3", "XIC I:0/0; JSR U:4", "@4", "END"], same)),
    ("FLW11", Case(&["JSR U:3", "@3", "JSR U:4", "@4", "JSR U:5", "@5", "JSR U:6", "@6", "JSR U:7", "@7", "END"], |image| image.processor.family = Family::Slc501), Case(&["JSR U:3", "@3", "JSR U:4", "@4", "JSR U:5", "@5", "JSR U:6", "@6", "JSR U:7", "@7", "END"], same)),
    ("FLW12", Case(&["TND", "XIC I:0/0; OTE B3:0/1", "END"], same), Case(&["JMP Q2:1", "LBL Q2:1; OTE B3:0/1", "XIC I:0/0; TND", "OTE B3:0/2", "END"], same)),
    ("FLW13", Case(&["XIC I:0/0; SUS 5"], same), Case(&["XIC I:0/0; TND"], same)),
    ("FLW14", Case(&["JSR U:3", "XIC I:0/0; JSR U:3", "@3", "XIC I:0/1; TON T4:0 1.0 5 0"], same), Case(&["JSR U:3", "XIC I:0/0; JSR U:3", "@3", "XIC I:0/1; OTE B3:0/1"], same)),
    ("FLW15", Case(&["XIC I:0/0; MCR", "XIC I:0/1; TOF T4:0 1.0 5 0", "MCR"], same), Case(&["XIC I:0/0; MCR", "MCR", "XIC I:0/1; TOF T4:0 1.0 5 0"], same)),
    ("MTH01", Case(&["XIC I:0/0; ADD N7:0 N7:1 N7:2"], same), Case(&["XIC I:0/0; ADD N7:0 N7:1 N7:2", "OTU S:5/0"], same)),
    ("MTH02", Case(&["XIC I:0/0; DIV N7:0 0 N7:2"], same), Case(&["XIC I:0/0; DIV 0 N7:1 N7:2"], same)),
    ("MTH03", Case(&["XIC I:0/0; DIV N7:0 N7:1 N7:2"], same), Case(&["NEQ N7:1 0; DIV N7:0 N7:1 N7:2"], same)),
    ("MTH04", Case(&["EQU F8:0 1.5; OTE B3:0/1"], same), Case(&["GEQ F8:0 1.5; EQU N7:0 1; OTE B3:0/1"], same)),
    ("MTH05", Case(&["GEQ N7:0 40000; OTE B3:0/1"], same), Case(&["GEQ L9:0 40000; EQU N7:0 0FFFFh; OTE B3:0/1"], same)),
    ("MTH06", Case(&["XIC I:0/0; MVM N7:0 0 N7:1"], same), Case(&["XIC I:0/0; MVM N7:0 00FFh N7:1"], same)),
    ("MTH07", Case(&["XIC I:0/0; MOV N7:0 N7:0"], same), Case(&["XIC I:0/0; MOV N7:0 N7:1"], same)),
    ("MTH08", Case(&["ADD N7:0 1 N7:0"], same), Case(&["ADD N7:0 1 N7:0", "GEQ N7:0 100; CLR N7:0"], same)),
    ("MTH09", Case(&["XIC I:0/0; MUL F8:0 2.0 N7:0"], same), Case(&["XIC I:0/0; MUL F8:0 2.0 F8:1"], same)),
    ("MTH10", Case(&["XIC I:0/0; DDV N7:0 N7:1"], same), Case(&["XIC I:0/0; MUL N7:2 N7:3 N7:4", "XIC I:0/0; DDV N7:0 N7:1"], same)),
    ("ADR01", Case(&["XIC I:0/0; MOV N7:200 N7:0"], same), Case(&["XIC I:0/0; MOV N7:100 N7:0"], same)),
    ("ADR02", Case(&["MOV 500 N7:0", "MOV N10:[N7:0] N7:1"], same), Case(&["MOV 5 N7:0", "MOV N10:[N7:0] N7:1"], same)),
    ("ADR03", Case(&["MOV N7:0 S:24", "FLL 0 #N10:0 5", "MOV #N7:10 N7:1"], same), Case(&["FLL 0 #N10:0 5", "MOV N7:0 S:24", "MOV #N7:10 N7:1"], same)),
    ("ADR04", Case(&["MOV #N7:10 N7:1"], same), Case(&["MOV N7:0 S:24", "MOV #N7:10 N7:1"], same)),
    ("ADR05", Case(&["XIC I:0/0; BSL #B3:0 R6:0 I:0/1 16", "XIC I:0/0; BSR #B3:4 R6:0 I:0/1 16"], same), Case(&["XIC I:0/0; FFL N7:0 #N10:0 R6:0 5 0", "XIC I:0/1; FFU #N10:0 N7:1 R6:0 5 0"], same)),
    ("ADR06", Case(&["XIC I:0/0; COP #N7:0 #N7:1 10"], same), Case(&["XIC I:0/0; COP #N7:0 #N7:10 10"], same)),
    ("ADR07", Case(&["XIC ?; OTE B3:0/1"], same), Case(&["XIC I:0/0; OTE B3:0/1"], same)),
    ("ADR08", Case(&["XIC I:0/0; XYZ N7:0"], same), Case(&["XIC I:0/0; OTE B3:0/1"], same)),
    ("ADR09", Case(&["XIC I:0/0; COP #N7:0 #N10:0 0"], same), Case(&["XIC I:0/0; COP #N7:0 #N10:0 1"], same)),
    ("IOC01", Case(&["XIC B3:0/0; OTE I:0/1"], same), Case(&["XIC I:0/1; OTE O:0/1"], same)),
    ("IOC02", Case(&["END"], force), Case(&["END"], same)),
    ("IOC03", Case(&["END"], |image| { force(image); set(image, FileType::S, 2, 1, 0x20); }), Case(&["END"], |image| { force(image); set(image, FileType::S, 2, 1, 0x40); })),
    ("IOC04", Case(&["XIC I:5.0/1; OTE B3:0/1"], same), Case(&["XIC I:2.0/1; OTE B3:0/1"], same)),
    ("IOC05", Case(&["XIC I:0/1; OTE B3:0/1"], same), Case(&["XIC I:0/1; OTE B3:0/1"], |image| name(image, "I:0.0/1", "START"))),
    ("IOC06", Case(&["XIC O:0/1; OTE B3:0/1"], same), Case(&["XIC O:0/1; OTE B3:0/1", "MOV N7:0 O:0"], same)),
    ("IOC07", Case(&["XIC I:0/0; MSG MG13:0 _ N7:0", "XIC I:0/1; MSG MG13:0 _ N7:5"], micrologix), Case(&["XIC I:0/0; MSG MG13:0 _ N7:0", "XIC I:0/1; MSG MG13:1 _ N7:5"], micrologix)),
    ("IOC08", Case(&["MSG MG13:0 _ N7:0"], micrologix), Case(&["XIO MG13:0/EN; MSG MG13:0 _ N7:0"], micrologix)),
    ("IOC09", Case(&["XIC I:0/0; MSG MG13:0 _ N7:0", "XIC I:0/1; OTU MG13:0/EN"], micrologix), Case(&["XIC I:0/0; MSG MG13:0 _ N7:0", "XIC I:0/1; OTU MG13:1/EN"], micrologix)),
    ("IOC10", Case(&["XIC I:0/0; MSG MG13:0 _ N7:0", "XIC MG13:0/DN; OTE B3:0/1"], micrologix), Case(&["XIC I:0/0; MSG MG13:0 _ N7:0", "XIC MG13:0/ER; OTE B3:0/1"], micrologix)),
    ("IOC11", Case(&["END"], same), Case(&["END"], |image| image.io.slots.iter_mut().for_each(|slot| slot.module.catalog = Some("1746-IB16".into())))),
    ("DOC01", Case(&["END"], detach), Case(&["END"], same)),
    ("DOC02", Case(&["END"], |image| name(image, "N7:200", "GONE")), Case(&["END"], |image| name(image, "N7:20", "HERE"))),
    ("DOC03", Case(&["END"], |image| { name(image, "N7:1", "SPEED"); name(image, "N7:2", "speed"); }), Case(&["END"], |image| { name(image, "N7:1", "SPEED"); name(image, "N7:2", "FLOW"); })),
    ("DOC04", Case(&["XIC I:0/0; XIC I:0/1; OTE O:0/1"], |image| name(image, "I:0.0/0", "START")), Case(&["XIC I:0/0; OTE O:0/1"], |image| name(image, "I:0.0/0", "START"))),
    ("DOC05", Case(&["END", "@3", "XIC I:0/0; OTE B3:0/1"], same), Case(&["END", "@3", "END"], same)),
    ("DOC06", Case(&["END"], |image| image.documentation.add(AddressEntry { target: Target::Unassigned, symbol: "LOST".into(), description: Vec::new() })), Case(&["END"], |image| name(image, "N7:1", "SPEED"))),
    ("CFG01", Case(&["END"], |image| image.program_files[0].rungs[0].edited = true), Case(&["END"], same)),
    ("CFG02", Case(&["XIC I:0/0; TON T4:0 0.01 5 0"], |image| set(image, FileType::T, 4, 1, 7)), Case(&["XIC I:0/0; TON T4:0 0.01 5 0"], |image| set(image, FileType::T, 4, 1, 5))),
    ("CFG03", Case(&["END"], |image| image.processor.deny_future_access = Some(true)), Case(&["END"], |image| image.processor.deny_future_access = Some(false))),
    ("CFG04", Case(&["END"], |image| set(image, FileType::S, 2, 1, 0x2000)), Case(&["END"], same)),
    ("CFG05", Case(&["END"], |image| set(image, FileType::S, 2, 29, 7)), Case(&["END", "@7", "END"], |image| set(image, FileType::S, 2, 29, 7))),
    ("CFG06", Case(&["END", "@7", "END"], |image| set(image, FileType::S, 2, 31, 7)), Case(&["END", "@7", "END"], |image| { set(image, FileType::S, 2, 31, 7); set(image, FileType::S, 2, 30, 10); })),
    ("CFG07", Case(&["XIC I:0/0; HSC C5:0 5 0", "XIC I:0/1; HSC C5:0 5 0"], same), Case(&["XIC I:0/0; HSC C5:0 5 0"], same)),
    ("CFG08", Case(&["END"], |image| counter(image, 50)), Case(&["END"], |image| counter(image, 5000))),
    ("CFG09", Case(&["END"], same), Case(&["END"], |image| set(image, FileType::S, 2, 29, 7))),
    ("CFG10", Case(&["MOV #N7:0 N10:0"], |image| set(image, FileType::S, 2, 2, 8)), Case(&["MOV N7:0 N10:0"], |image| set(image, FileType::S, 2, 2, 8))),
    ("CFG11", Case(&["ADD N7:0 1 N7:1"], |image| set(image, FileType::S, 2, 2, 0x4000)), Case(&["ADD N7:0 1 N7:1"], same)),
];

#[test]
fn each_check_has_a_case_and_decides_it() {
    let mut wrong = Vec::new();
    for (code, bad, good) in CASES {
        for (Case(lines, change), expected) in [(bad, true), (good, false)] {
            let mut image = program(lines);
            change(&mut image);
            let found = find(&image, code);
            if found.is_empty() == expected {
                wrong.push(format!("{code}: {lines:?} gives {found:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let tested: BTreeSet<&str> = CASES.iter().map(|(code, _, _)| *code).collect();
    let all: BTreeSet<&str> = checks::all().map(|check| check.code).collect();
    assert_eq!(tested, all);
    assert_eq!(checks::all().count(), all.len(), "codes are given once");
    assert!(all.len() >= 40);
}

#[test]
fn rules_and_comments_take_findings_out_and_are_counted() {
    let mut image = program(&["XIC I:0/0; OTE B3:0/1", "XIC I:0/1; OTE B3:0/1", "XIC I:0/1; OTL B3:0/5"]);
    let owner = CommentOwner::Rung { file: 2, rung: 1 };
    let text = "jog\r\nrungs: allow OUT01, TIM02".to_owned();
    image.program_files[0].rungs[1].comment = Some(Comment { text, title: String::new(), owner });
    let rules = "[[allow]]\ncheck = 'OUT02'\nfile = 2\nrung = 2\nproject = 'x.RSS'\nreason = 'HMI clears it'";
    let rules = Rules::parse(rules).expect("rules");
    let chosen = |check: &checks::Check| matches!(check.code, "OUT01" | "OUT02");
    let report = checks::run(&image, &image.documentation, "x.RSS", &rules, chosen);
    assert_eq!(report.findings.len(), 0, "{:?}", report.findings);
    let by: Vec<&str> = report.suppressed.iter().map(|it| it.by.as_str()).collect();
    assert_eq!(by, ["comment of rung 2:1", "rule: HMI clears it"]);
    let report = checks::run(&image, &image.documentation, "other.RSS", &rules, chosen);
    assert_eq!(report.findings.len(), 1, "the rule is about one project");
}

#[test]
fn errors_come_first_and_lists_are_bounded() {
    let mut lines = vec!["XIC I:0/0; OTL B3:0/1"; 1];
    lines.extend(vec!["JSR U:200"; 3_000]);
    let image = program(&lines);
    let report = checks::run(&image, &image.documentation, "x.RSS", &Rules::default(), |check| check.default_on);
    assert_eq!(report.findings[0].check.severity, Severity::Error);
    assert!(report.not_listed >= 2_000);
}

/// Wide instructions under many addresses cost the square when each is looked up against all.
#[test]
fn hostile_programs_end_quickly() {
    let start = std::time::Instant::now();
    let mut image = support::image(&[]);
    image.data_files.push(DataFile::new(FileType::B, 20, 1_000));
    let rungs = &mut image.program_files[0].rungs;
    for number in 0..6_000 {
        rungs.push(support::rung("FLL 0 #B20:0 1000"));
        rungs.push(support::rung(&format!(
            "XIC B20:{}/{}; OTL B20:{}/{}",
            number % 1_000,
            number % 16,
            number % 999,
            number % 15
        )));
    }
    let many = vec![
        ladder::Element::Instruction(Instruction::new(
            Mnemonic::named("XIC"),
            vec![ladder::Operand::parse("B3:0/0")],
        ));
        20_000
    ];
    rungs.push(ladder::Rung::new(many));
    let report = checks::run(&image, &image.documentation, "x.RSS", &Rules::default(), |_| true);
    assert!(!report.findings.is_empty());
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}
