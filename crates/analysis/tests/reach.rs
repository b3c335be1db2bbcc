//! What each instruction touches, for every instruction that touches more than it names.
//!
//! The expected areas are those of the manuals' instruction descriptions (lengths in elements, bits
//! or steps; step 0 of sequencers; masks; members of timers and counters), written out by hand.

mod support;

use analysis::CrossReference;
use instr::Role;
use ladder::{Address, DataFile, Family, FileType, Image, MessageSetup};
use support::{image, set};

/// Accesses to an address, in the notation of the tables below: role letter(s), `?` if not definite,
/// mnemonic, touched data.
fn lookup(image: &Image, address: &str) -> Vec<String> {
    let xref = CrossReference::build(image, &image.documentation);
    let address = Address::parse(address).expect(address);
    let letters = |role: Role| match (role.reads(), role.writes()) {
        (true, true) => "rw",
        (true, false) => "r",
        _ => "w",
    };
    let text = |access: &analysis::Access<'_>| {
        let may = if access.certainty == analysis::Certainty::May { "?" } else { "" };
        format!("{}{may} {} {}", letters(access.role), access.mnemonic, access.touched)
    };
    xref.of(&address).iter().map(text).collect()
}

#[track_caller]
fn check(rung: &str, rows: &[(&str, &[&str])]) {
    let image = image(&[rung]);
    for (address, expected) in rows {
        assert_eq!(lookup(&image, address), *expected, "{address} in {rung}");
    }
}

#[test]
fn a_copy_counts_elements_of_its_destination_on_both_sides() {
    check(
        "COP #N7:10 #N10:0 5",
        &[
            ("N7:10", &["r COP N7:10..N7:14"]),
            ("N7:14/3", &["r COP N7:10..N7:14"]),
            ("N7:15", &[]),
            ("N7:9", &[]),
            ("N10:0", &["w COP N10:0..N10:4"]),
            ("N10:4", &["w COP N10:0..N10:4"]),
            ("N10:5", &[]),
        ],
    );
    // Three-word destination elements: six words are read.
    check(
        "COP #N7:0 #T4:2 2",
        &[("N7:5", &["r COP N7:0..N7:5"]), ("N7:6", &[]), ("T4:3.ACC", &["w COP T4:2..T4:3"]), ("T4:4", &[])],
    );
    // One-word destination elements: one timer is read.
    check("COP #T4:0 #N7:0 3", &[("T4:0.ACC", &["r COP T4:0"]), ("T4:1", &[]), ("N7:2", &["w COP N7:0..N7:2"])]);
}

#[test]
fn a_fill_writes_elements_and_a_word_copy_words() {
    check(
        "FLL N7:0 #B3:4 3",
        &[("N7:0", &["r FLL N7:0"]), ("N7:1", &[]), ("B3:6/15", &["w FLL B3:4..B3:6"]), ("B3:7", &[])],
    );
    check("FLL 0 #T4:1 2", &[("T4:2.PRE", &["w FLL T4:1..T4:2"]), ("T4:3", &[]), ("T4:0", &[])]);
    check("CPW #L9:0 #N7:0 4", &[("L9:1", &["r CPW L9:0..L9:1"]), ("L9:2", &[]), ("N7:3", &["w CPW N7:0..N7:3"])]);
    check("CPW #I:0.0 #N7:0 3", &[("I:2.0/5", &["r CPW I:0.0..I:2.0"]), ("N7:2", &["w CPW N7:0..N7:2"])]);
}

#[test]
fn shifts_reach_as_many_bits_as_their_length() {
    // B3/16 .. B3/73, printed with length 58 in the hand-held terminal manual.
    let mut shift = image(&["BSL #B3:1 R6:3 I:2.0/12 58"]);
    set(&mut shift, FileType::R, 6, 3 * 3 + 1, 58);
    for (address, expected) in [
        ("B3:1/0", &["rw BSL B3:1/0..B3:4/9"][..]),
        ("B3/73", &["rw BSL B3:1/0..B3:4/9"]),
        ("B3/74", &[]),
        ("B3:0", &[]),
        ("I:2.0/12", &["r BSL I:2.0/12"]),
        ("R6:3/UL", &["w BSL R6:3/UL"]),
        ("R6:3.LEN", &["r BSL R6:3.LEN"]),
        ("R6:3.POS", &[]),
    ] {
        assert_eq!(lookup(&shift, address), expected, "{address}");
    }
}

#[test]
fn the_length_of_a_verified_instruction_is_that_of_its_control_element() {
    let mut shift = image(&["BSR #B3:1 R6:0 B3:0/0 16"]);
    set(&mut shift, FileType::R, 6, 1, 32);
    assert_eq!(lookup(&shift, "B3:2/15"), ["rw BSR B3:1..B3:2"]);
    let ladder::Element::Instruction(instruction) = &mut shift.program_files[0].rungs[0].series[0] else {
        panic!("an instruction")
    };
    // Not verified yet: the text is what was entered.
    instruction.compiled = false;
    assert_eq!(lookup(&shift, "B3:2/15"), [""; 0]);
}

#[test]
fn a_length_written_by_the_program_can_reach_further() {
    let mut image = image(&["FFL N7:0 #N10:0 R6:0 4 0", "MOV 20 R6:0.LEN"]);
    set(&mut image, FileType::R, 6, 1, 4);
    assert_eq!(lookup(&image, "N10:3"), ["w FFL N10:0..N10:3"]);
    assert_eq!(lookup(&image, "N10:9"), ["w? FFL N10:4.."]);
}

#[test]
fn stacks_have_as_many_elements_as_their_length() {
    for (rung, stack, dest) in [
        ("FFL N7:10 #N7:12 R6:0 3 3", "w FFL N7:12..N7:14", "r FFL N7:10"),
        ("LFL N7:10 #N7:12 R6:0 3 3", "w LFL N7:12..N7:14", "r LFL N7:10"),
        ("FFU #N7:12 N7:10 R6:0 3 3", "rw FFU N7:12..N7:14", "w FFU N7:10"),
        ("LFU #N7:12 N7:10 R6:0 3 3", "r LFU N7:12..N7:14", "w LFU N7:10"),
    ] {
        let mut image = image(&[rung]);
        set(&mut image, FileType::R, 6, 1, 3);
        assert_eq!(lookup(&image, "N7:12"), [stack]);
        assert_eq!(lookup(&image, "N7:14"), [stack]);
        assert_eq!(lookup(&image, "N7:15"), [""; 0]);
        assert_eq!(lookup(&image, "N7:10"), [dest]);
    }
}

#[test]
fn sequencers_have_one_word_more_than_steps_and_write_through_their_mask() {
    let mut output = image(&["SQO #N7:20 000Fh O:0.0 R6:2 4 0"]);
    set(&mut output, FileType::R, 6, 2 * 3 + 1, 4);
    for (address, expected) in [
        ("N7:20", &["r SQO N7:20..N7:24"][..]),
        ("N7:24", &["r SQO N7:20..N7:24"]),
        ("N7:25", &[]),
        ("O:0/3", &["w SQO O:0.0/0..O:0.0/3"]),
        ("O:0/4", &[]),
        ("R6:2.POS", &["rw SQO R6:2.POS"]),
    ] {
        assert_eq!(lookup(&output, address), expected, "{address}");
    }
    let mut load = image(&["SQL #N7:20 I:0.0 R6:2 4 0", "SQC #N10:0 #N10:10 #N10:20 R6:3 2 0"]);
    set(&mut load, FileType::R, 6, 2 * 3 + 1, 4);
    set(&mut load, FileType::R, 6, 3 * 3 + 1, 2);
    assert_eq!(lookup(&load, "N7:24"), ["w SQL N7:20..N7:24"]);
    assert_eq!(lookup(&load, "I:0.0/1"), ["r SQL I:0.0"]);
    // Mask and source written with # step along.
    assert_eq!(lookup(&load, "N10:12"), ["r SQC N10:10..N10:12"]);
    assert_eq!(lookup(&load, "N10:22"), ["r SQC N10:20..N10:22"]);
    assert_eq!(lookup(&load, "N10:23"), [""; 0]);
}

#[test]
fn a_masked_move_writes_the_bits_of_its_mask() {
    check("MVM N7:0 0F000h B3:2", &[("B3:2/4", &[]), ("B3:2/11", &[]), ("B3:2/15", &["w MVM B3:2/12..B3:2/15"])]);
    check("MVM N7:0 -32768 B3:2", &[("B3:2", &["w MVM B3:2/15"]), ("B3:2/14", &[])]);
    // What a mask in the data table lets through is decided at run time; the word is written.
    check("MVM N7:0 N7:1 B3:2", &[("B3:2/4", &["w MVM B3:2"]), ("N7:1", &["r MVM N7:1"])]);
    check("IIM I:2.0 00FFh 1", &[("I:2.0/7", &["w IIM I:2.0/0..I:2.0/7"]), ("I:2.0/8", &[])]);
    check("IOM O:0.0 0FFFFh 2", &[("O:0.1/7", &["r IOM O:0.0..O:0.1"]), ("O:2.0", &[])]);
}

#[test]
fn words_bits_and_elements_overlap() {
    check("MOV N7:0 B3:0", &[("B3:0/5", &["w MOV B3:0"]), ("N7:0/15", &["r MOV N7:0"]), ("B3:1/0", &[])]);
    check("MOV F8:0 L9:1", &[("L9:1/31", &["w MOV L9:1"]), ("L9:2/0", &[]), ("F8:0", &["r MOV F8:0"])]);
    check("XIC I:0/20; OTE O:2/3", &[("I:0.1", &["r XIC I:0.1/4"]), ("O:2", &["w OTE O:2.0/3"]), ("O:0", &[])]);
    check("MOV ST11:1.LEN N7:0", &[("ST11:1", &["r MOV ST11:1.LEN"]), ("ST11:1.DATA[0]", &[])]);
    check("ACN ST11:0 ST11:1 ST11:2", &[("ST11:2.LEN", &["w ACN ST11:2"]), ("ST11:1", &["r ACN ST11:1"])]);
}

#[test]
fn timers_counters_and_resets_touch_members() {
    check(
        "TON T4:0 0.01 100 0",
        &[
            ("T4:0/EN", &["w TON T4:0/EN"]),
            ("T4:0/DN", &["rw TON T4:0/DN"]),
            ("T4:0.PRE", &["r TON T4:0.PRE"]),
            ("T4:0.ACC", &["rw TON T4:0.ACC"]),
            ("T4:1", &[]),
        ],
    );
    check("RES T4:0", &[("T4:0.PRE", &[]), ("T4:0.ACC", &["w RES T4:0.ACC"]), ("T4:0/DN", &["w RES T4:0/DN"])]);
    check("RES C5:0", &[("C5:0.PRE", &[]), ("C5:0/OV", &["w RES C5:0/OV"]), ("C5:0.ACC", &["w RES C5:0.ACC"])]);
    check("RES R6:0", &[("R6:0.LEN", &[]), ("R6:0.POS", &["w RES R6:0.POS"]), ("R6:0/FD", &[])]);
    check("CTU C5:1 10 0", &[("C5:1/CU", &["rw CTU C5:1/CU"]), ("C5:1/CD", &[]), ("C5:1.PRE", &["r CTU C5:1.PRE"])]);
}

#[test]
fn addresses_decided_at_run_time_may_be_touched() {
    check(
        "MOV N7:0 N10:[N7:5]",
        &[("N10:30", &["w? MOV N10:*"]), ("N7:5", &["r MOV N7:5"]), ("N7:0", &["r MOV N7:0"])],
    );
    check("MOV 5 T4:[N7:5].PRE", &[("T4:3.PRE", &["w? MOV T4:*.PRE"]), ("T4:3/DN", &[]), ("T4:3.ACC", &[])]);
    check("MOV 5 N[N7:1]:3", &[("N10:3", &["w? MOV N*:3"]), ("N7:3", &["w? MOV N*:3"]), ("N7:4", &[]), ("B3:3", &[])]);
    check("XIC B3:4/[N7:0]", &[("B3:4/2", &["r? XIC B3:4.."]), ("B3:3/2", &[]), ("N7:0", &["r XIC N7:0"])]);
    check(
        "TON T4:[N7:0] 1.0 5 0",
        &[("T4:2.ACC", &["rw? TON T4:*.ACC"]), ("T4:2/DN", &["rw? TON T4:*/DN"]), ("N7:0", &["r TON N7:0"])],
    );
    check(
        "COP #N7:0 #N10:[N7:50] 5",
        &[("N10:44", &["w? COP N10:*"]), ("N7:50", &["r COP N7:50"]), ("N7:4", &["r COP N7:0..N7:4"])],
    );
    // S:24 shifts word addresses written with #.
    check(
        "MOV #N7:10 #N10:5",
        &[("N7:20", &["r? MOV N7:*"]), ("N10:15", &["w? MOV N10:*"]), ("S:24", &["r MOV S:24", "r MOV S:24"])],
    );
}

#[test]
fn expressions_read_their_operands() {
    let mut cpt = image(&["CPT F8:2 0"]);
    let ladder::Element::Instruction(instruction) = &mut cpt.program_files[0].rungs[0].series[0] else {
        panic!("an instruction")
    };
    instruction.operands[1] = ladder::Operand::parse("( N7:62 * F8:1 ) + N10:[N7:3]");
    assert_eq!(lookup(&cpt, "N7:62"), ["r CPT N7:62"]);
    assert_eq!(lookup(&cpt, "F8:1"), ["r CPT F8:1"]);
    assert_eq!(lookup(&cpt, "F8:2"), ["w CPT F8:2"]);
    assert_eq!(lookup(&cpt, "N10:9"), ["r? CPT N10:*"]);
    assert_eq!(lookup(&cpt, "N7:3"), ["r CPT N7:3"]);
}

#[test]
fn process_and_clock_instructions() {
    check(
        "PID PD12:0 N7:0 N7:1 _",
        &[
            ("PD12:0.SPS", &["r PID PD12:0.SPS"]),
            ("PD12:0.CVP", &["rw PID PD12:0.CVP"]),
            ("PD12:0/DN", &["w PID PD12:0/DN"]),
            ("PD12:0.17", &["rw PID PD12:0.17"]),
            ("N7:0", &["r PID N7:0"]),
            ("N7:1", &["rw PID N7:1"]),
        ],
    );
    // The control block of SLC processors is 23 integers.
    check("PID N7:10 N7:0 N7:1 23 _", &[("N7:32", &["rw PID N7:10..N7:32"]), ("N7:33", &[]), ("N7:9", &[])]);
    check("FRD S:13 N7:0", &[("S:14", &["r FRD S:14"]), ("S:13", &["r FRD S:13"])]);
    check("TOD N7:3 S:13", &[("S:14", &["w? TOD S:14"])]);
    check("DDV 100 N7:3", &[("S:13", &["r DDV S:13", "w? DDV S:13"])]);
    check("ADD N7:0 1 N7:0", &[("N7:0", &["r ADD N7:0", "w ADD N7:0"]), ("S:5/0", &["w? ADD S:5/0"])]);
}

#[test]
fn function_files_are_reached_by_number_and_by_meaning() {
    let mut image = image(&["HSL HSC0 N7:0 N7:1 N7:2 N7:3", "STS 10", "PTO 1", "RAC HSC0 L9:0"]);
    image.processor.family = Family::MicroLogix1400;
    for (file_type, elements, words) in [(FileType::HSC, 2, 18), (FileType::STI, 1, 4), (FileType::PTOX, 3, 15)] {
        let mut file = DataFile::new(file_type, 0, 0);
        (file.elements, file.words_per_element) = (elements, words);
        file.words = vec![0; usize::from(elements * words)];
        image.function_files.push(file);
    }
    assert_eq!(lookup(&image, "HSC:0.HIP"), ["w HSL HSC:0.HIP"]);
    assert_eq!(lookup(&image, "HSC:1.HIP"), [""; 0]);
    assert_eq!(lookup(&image, "HSC:0.ACC"), ["w RAC HSC:0.ACC"]);
    assert_eq!(lookup(&image, "STI:0.SPM"), ["w STS STI:0.SPM"]);
    assert_eq!(lookup(&image, "PTOX:1"), ["rw PTO PTOX:1"]);
}

#[test]
fn messages_move_what_their_set_up_says() {
    let with = |settings: &[(&'static str, &str)]| {
        let mut image = image(&["MSG MG13:0 _ N10:0"]);
        let ladder::Element::Instruction(instruction) = &mut image.program_files[0].rungs[0].series[0] else {
            panic!("an instruction")
        };
        let settings = settings.iter().map(|(name, text)| ((*name).into(), (*text).to_owned())).collect();
        instruction.message = Some(Box::new(MessageSetup { settings }));
        image
    };
    let read = with(&[("Communication Command", "03 Read Holding Registers (4xxxxx)"), ("Size in Elements", "7")]);
    assert_eq!(lookup(&read, "N10:6"), ["w MSG N10:0..N10:6"]);
    assert_eq!(lookup(&read, "N10:7"), [""; 0]);
    assert_eq!(lookup(&read, "MG13:0/DN"), ["w MSG MG13:0/DN"]);
    let write = with(&[("Communication Command", "16 Write Multiple Registers (4xxxxx)"), ("Size in Elements", "2")]);
    assert_eq!(lookup(&write, "N10:1"), ["r MSG N10:0..N10:1"]);
    let unknown = with(&[]);
    assert_eq!(lookup(&unknown, "N10:40"), ["rw? MSG N10:*"]);
    let xref = CrossReference::build(&unknown, &unknown.documentation);
    assert_eq!(xref.notes().len(), 1);
}

#[test]
fn an_unknown_instruction_may_do_anything_with_its_addresses() {
    let image = image(&["QQQ N7:1 #N10:2", "MOV N7:0"]);
    assert_eq!(lookup(&image, "N7:1"), ["rw? QQQ N7:1"]);
    assert_eq!(lookup(&image, "N10:9"), ["rw? QQQ N10:*"]);
    assert_eq!(lookup(&image, "N7:0"), ["rw? MOV N7:0"]);
    let xref = CrossReference::build(&image, &image.documentation);
    let kinds: Vec<_> = xref.unresolved().iter().map(|u| u.kind.as_str()).collect();
    assert_eq!(kinds, ["unknown instruction", "unknown number of operands"]);
}

#[test]
fn the_cost_of_addresses_decided_at_run_time_is_that_of_their_accesses() {
    let rung = |n: usize| format!("OTE N{}:[B3:{}]/{}", 20 + n % 100, n / 100 % 25, n / 2_500);
    let rungs: Vec<String> = (0..20_000).map(rung).collect();
    let image = image(&rungs.iter().map(String::as_str).collect::<Vec<_>>());
    let xref = CrossReference::build(&image, &image.documentation);
    // Takes minutes if each address looks through all accesses.
    let computed = xref.all().filter(|group| group.address.indirections().next().is_some());
    let accesses: Vec<usize> = computed.map(|group| group.accesses.len()).collect();
    assert_eq!(accesses, vec![1; 20_000]);
}
