use std::time::Duration;

use super::*;
use crate::choices::Choice;

const MS10: Duration = Duration::from_millis(10);

fn program(text: &str, options: &Options) -> Result<Program, Vec<Refusal>> {
    Program::compile(&crate::text::read(text).expect("reads").project, options)
}

/// A machine in run with the body of `$Main`, or with whole blocks where the text begins with `$`.
fn machine(text: &str) -> Machine {
    machine_with(text, Options::default())
}

fn machine_with(text: &str, options: Options) -> Machine {
    let whole =
        if text.starts_with('$') { text.to_owned() } else { format!("$PRGRM $Main\n\n{text}\n\n$PGMEND $Main\n") };
    let program = program(&whole, &options);
    let program = program.unwrap_or_else(|refusals| panic!("{}", refusals.first().expect("one")));
    let mut machine = Machine::new(program);
    machine.enter_run();
    machine
}

impl Machine {
    fn put(&mut self, address: &str, value: i64) {
        self.set(address, &Value::Integer(value)).unwrap_or_else(|error| panic!("{error}"));
    }

    #[track_caller]
    fn shows(&self, pairs: &[(&str, i64)]) {
        for (address, expected) in pairs {
            let found = match self.get(address).unwrap_or_else(|error| panic!("{error}")) {
                Value::Bit(on) => i64::from(on),
                Value::Integer(value) => value,
                other => panic!("{address}: {other:?}"),
            };
            assert_eq!(found, *expected, "{address}");
        }
    }

    fn scans_of(&mut self, count: usize) {
        (0..count).for_each(|_| {
            self.scan(MS10);
        });
    }
}

#[test]
fn stack_and_branches() {
    let mut m =
        machine("STR X0\nOR X1\nANDN X2\nSTR X3\nAND X4\nORSTR\nOUT Y0\nDUPBOOL\nAND X5\nOUT Y1\nPOPBOOL\nNOT\nOUT Y2");
    for bits in 0..64i64 {
        for number in 0..6 {
            m.put(&format!("X{number}"), bits >> number & 1);
        }
        m.scan(MS10);
        let x = |number: i64| bits >> number & 1 != 0;
        let y0 = ((x(0) || x(1)) && !x(2)) || (x(3) && x(4));
        m.shows(&[("Y0", y0.into()), ("Y1", (y0 && x(5)).into()), ("Y2", (!y0).into())]);
    }
}

#[test]
fn logic_goes_on_behind_outputs() {
    let mut m = machine("STR X0\nRST C0\nAND X1\nMOVE 5 N0\nNOT\nMOVE 7 N1");
    m.put("X0", 1);
    m.put("C0", 1);
    m.scan(MS10);
    m.shows(&[("C0", 0), ("N0", 0), ("N1", 7)]);
    m.put("X1", 1);
    m.scan(MS10);
    m.shows(&[("N0", 5)]);
}

#[test]
fn programs_latch_and_terminate() {
    let mut m = machine(
        "$PRGRM $Main\n\nSTR X0\nRUN Batch\n\nSTR X1\nHALT Batch\n\n$PGMEND $Main\n\
         $PRGRM Batch\n\nSTR ST1\nOUT Y0\nSET C0\n\nSTR ST1\nTMR T0 100\n\nSTR ST1\nTMRAG T1 100\n\n$PGMEND Batch\n",
    );
    m.scans_of(2);
    m.shows(&[("Y0", 0)]);
    m.put("X0", 1);
    m.scan(MS10);
    m.put("X0", 0);
    m.scans_of(3);
    m.shows(&[("Y0", 1), ("C0", 1), ("T0.Acc", 30), ("T1.Acc", 30)]);
    m.put("X1", 1);
    m.scan(MS10);
    m.shows(&[("Y0", 0), ("C0", 1), ("T0.Acc", 0), ("T0.Reset", 1), ("T1.Acc", 30)]);
    m.put("X1", 0);
    m.put("X0", 1);
    m.scan(MS10);
    m.enter_program();
    m.shows(&[("Y0", 0), ("C0", 1), ("T0.Acc", 0), ("T1.Acc", 30), ("DST10", 2)]);
    m.enter_run();
    m.put("X0", 0);
    m.scan(MS10);
    m.shows(&[("Y0", 0)]);
}

#[test]
fn stages_jump_and_shut_down() {
    let mut m = machine(
        "SG $Main.S0\n\nOUT Y0\n\nSTR X0\nJMP $Main.S1\n\nSG $Main.S1\n\nOUT Y1\n\nSTR X1\nJMP $Main.S0\n\nSTR ST1\nTMR T0 1000",
    );
    m.scan(MS10);
    m.shows(&[("Y0", 1), ("Y1", 0), ("$Main.S0", 1)]);
    m.put("X0", 1);
    m.scan(MS10);
    // The stage behind runs in the same scan; the one left shuts down in the next.
    m.shows(&[("Y0", 1), ("Y1", 1), ("$Main.S0", 0)]);
    m.put("X0", 0);
    m.scans_of(2);
    m.shows(&[("Y0", 0), ("Y1", 1), ("T0.Acc", 20)]);
    m.put("X1", 1);
    m.scan(MS10);
    m.shows(&[("Y0", 0), ("Y1", 1)]);
    m.put("X1", 0);
    m.scan(MS10);
    m.shows(&[("Y0", 1), ("Y1", 0), ("T0.Acc", 0)]);
}

#[test]
fn loops_subroutines_and_data_boxes() {
    let mut m = machine(
        "$PRGRM $Main\n\nFOR D0 1 5 1\n\nSTR ST1\nMATH D1 \"D1 + D0\"\n\nNEXT\n\n\
         STR ST1\nCALL Sub 0x0 DST511 \"3 N0 N10 2\" \"3 N12 N2 1\"\n\n\
         STR ST1\nINIT \"3 N20 N23 9\"\nCOPY 0x0 \"4 0x0 N20 V20 3\"\nSCALE N30 0 100 0 1000 N31\nCLAMP N31 500 0 N32\n\
         MEMCOPY D1 D5 0x20000 1\n\n$PGMEND $Main\n\
         $LGCMOD Sub\n\nSTR ST1\nMATH N12 \"N10 * N11\"\n\nSTR X0\nRETC\n\nSTR ST1\nMOVE 1 N40\n\nRET\n\n$LGCEND Sub\n",
    );
    for (address, value) in [("N0", 6), ("N1", 7), ("N30", 75)] {
        m.put(address, value);
    }
    m.scan(MS10);
    m.shows(&[("D1", 15), ("D0", 6), ("N2", 42), ("N23", 9), ("N24", 0), ("V22", 9), ("V23", 0)]);
    m.shows(&[("N31", 750), ("N32", 500), ("D5", 15), ("N40", 1)]);
    let mut endless = machine("REPEAT\n\nSTR ST1\nINC D0\n\nUNTIL C0");
    endless.scan(MS10);
    assert_eq!((endless.fault(), endless.mode()), (Some(Fault::Watchdog), Mode::Program));
}

#[test]
fn resets_act_at_their_place_and_hold_for_the_scan() {
    let text = "STR X0\nTMRAG T0 50\n\nSTR X1\nRSTT T0\n\nSTR X2\nSTR ST2\nUDCG CT0 3 DST511\n\nSTR X3\nRSTCT CT0";
    let mut m = machine(text);
    m.put("X0", 1);
    m.scans_of(7);
    m.shows(&[("T0.Acc", 60), ("T0.Done", 1)]);
    m.put("X1", 1);
    m.scan(MS10);
    m.shows(&[("T0.Acc", 0), ("T0.Done", 0), ("T0.Reset", 1)]);
    m.put("X1", 0);
    m.scans_of(2);
    m.shows(&[("T0.Acc", 20)]);
    for _ in 0..3 {
        m.put("X2", 0);
        m.scan(MS10);
        m.put("X2", 1);
        m.scan(MS10);
    }
    m.shows(&[("CT0.Acc", 3), ("CT0.Done", 1), ("CT0.DnDone", 0)]);
    m.enter_program();
    m.enter_run();
    m.scan(MS10);
    m.shows(&[("CT0.Acc", 3)]);
    m.put("X3", 1);
    m.scan(MS10);
    m.shows(&[("CT0.Acc", 0), ("CT0.Done", 0), ("CT0.Reset", 1)]);
    let mut later = machine_with(
        text,
        Options { choices: crate::choices::Choices::default().with(Choice::ResetWhenProcessed), ..Options::default() },
    );
    later.put("X0", 1);
    later.scans_of(3);
    later.put("X1", 1);
    later.scan(MS10);
    later.shows(&[("T0.Acc", 30)]);
    later.put("X1", 0);
    later.scan(MS10);
    later.shows(&[("T0.Acc", 0)]);
}

#[test]
fn edges_compare_with_the_last_processing() {
    let mut m = machine(
        "STRPD C0\nOUT C10\n\nSTR X0\nOUT C0\n\nSTRPD C0\nOUT C11\n\nSTRND C0\nOUT C12\n\nSTR X0\nPD C13\n\nSTR X0\nND C14",
    );
    m.scan(MS10);
    m.put("X0", 1);
    m.scan(MS10);
    // Before the coil the edge is seen one scan later.
    m.shows(&[("C10", 0), ("C11", 1), ("C12", 0), ("C13", 1)]);
    m.scan(MS10);
    m.shows(&[("C10", 1), ("C11", 0), ("C13", 0), ("C14", 0)]);
    m.put("X0", 0);
    m.scan(MS10);
    m.shows(&[("C12", 1), ("C14", 1)]);
    m.scan(MS10);
    m.shows(&[("C12", 0), ("C14", 0)]);
    let mut first = machine("STR X0\nPD C0");
    first.put("X0", 1);
    first.scan(MS10);
    first.shows(&[("C0", 0)]);
    let options =
        Options { choices: crate::choices::Choices::default().with(Choice::FirstScanEdge), ..Options::default() };
    let mut edge = machine_with("STR X0\nPD C0", options);
    edge.put("X0", 1);
    edge.scan(MS10);
    edge.shows(&[("C0", 1)]);
}

#[test]
fn system_memory_follows_time() {
    let mut m = machine("STR ST0\nINC N0\n\nSTR ST4\nOUT Y0\n\nSTR ST2\nOUT Y1");
    m.scan(Duration::ZERO);
    m.shows(&[("N0", 1), ("Y0", 0), ("SDT0.Year", 2000)]);
    m.scans_of(50);
    m.shows(&[("N0", 1), ("Y0", 1), ("Y1", 0)]);
    m.put("SDT0.Hour", 23);
    m.put("SDT0.Minute", 59);
    m.put("SDT0.Second", 59);
    m.scans_of(100);
    m.shows(&[("SDT0.Hour", 0), ("SDT0.Day", 2), ("DST10", 3)]);
}

#[test]
fn what_cannot_run_is_refused_with_its_rung() {
    for (rung, why) in [
        ("STR X0\nBOGUS N1", "not known"),
        ("STR X9999\nOUT Y0", "last element"),
        ("STR X0\nOUT X0:UW", "no bit"),
        ("STR X0\nMOVE 1 T0.Done", "read-only"),
        ("STR X0\nSTR X1\nOUT Y0", "balance"),
        ("STR X0\nANDSTR\nOUT Y0", "needs 2"),
        ("STR X0\nTMR N0 5", "no timer"),
        ("STR X0\nMATH N0 \"N1 +\"", "expression"),
        ("STR X0\nCALL Nowhere 0x0 DST511 \"3\" \"3\"", "no code block"),
        ("NEXT", "no FOR"),
    ] {
        let text = format!("$PRGRM $Main\n\nSTR X0\nOUT Y5\n\n{rung}\n\n$PGMEND $Main\n");
        let refusals = program(&text, &Options::default()).expect_err(rung);
        let found = refusals.first().expect("one").to_string();
        assert!(found.starts_with("$Main rung 2") && found.contains(why), "{rung}: {found}");
    }
    let mut stops = machine_with("STR X0\nBOGUS N1", Options { unsupported: Unsupported::Stop, ..Options::default() });
    stops.scan(MS10);
    assert_eq!(stops.mode(), Mode::Run);
    stops.put("X0", 1);
    stops.scan(MS10);
    assert!(matches!(stops.fault(), Some(Fault::Unsupported { .. })));
}

#[test]
fn states_are_saved_forked_and_taken_over() {
    let text = "STR X0\nTMR T0 50\n\nSTRPD T0.Done\nINC N0\n\nSTRDLT N0\nOUT C0\n\nSTR ST1\nFLASHER 20 30 Y0";
    let mut m = machine(text);
    m.put("X0", 1);
    m.scans_of(4);
    let saved = m.save();
    let mut other = machine(text);
    other.restore(&saved).expect("restores");
    let mut fork = m.fork();
    let mut copy = m.fork();
    m.scans_of(10);
    other.scans_of(10);
    fork.scans_of(10);
    assert!(copy.copy_from(&fork));
    assert_eq!(m.save(), other.save());
    assert_eq!(m.save(), copy.save());
    assert_eq!(machine("STR X0\nOUT Y0").restore(&saved), Err(RestoreError::OtherProgram));
    for length in 0..saved.len().min(200) {
        assert!(other.restore(&saved[..length]).is_err());
    }
}

#[test]
fn inputs_are_read_from_their_terminals_before_each_scan() {
    let text = "STR X1\nOUT C0\n\nSTR ST1\nOUT X1\nMOVE 7 WX0\nMOVE 2.5 RX1\nINC N0\n\nSTR X1\nOUT C1";
    let mut m = machine(text);
    m.scans_of(2);
    // The program sees its own value behind the coil, and the terminal again in the next scan.
    m.shows(&[("C0", 0), ("C1", 1), ("X1", 1), ("WX0", 7)]);
    // Its neighbours are set from outside: the terminal of X1 is not told what the program wrote.
    m.put("X0", 1);
    m.put("WX0:3", 1);
    m.scan(MS10);
    m.shows(&[("C0", 0), ("X0", 1)]);
    let mut read = machine("STR X1\nOUT C0\nMOVE WX0 N1");
    for (address, value) in [("X1", 1), ("WX0", -5)] {
        read.put(address, value);
    }
    read.scans_of(2);
    read.shows(&[("X1", 1), ("WX0", -5), ("C0", 1), ("N1", -5)]);
    // Terminals are part of the state, in all its forms.
    let saved = m.save();
    let mut other = machine(text);
    other.restore(&saved).expect("restores");
    let mut copy = machine(text).fork();
    assert!(!copy.copy_from(&m));
    copy = m.fork();
    m.enter_program();
    m.enter_run();
    for machine in [&mut m, &mut other, &mut copy] {
        machine.scan(MS10);
        machine.shows(&[("X0", 1), ("C0", 0)]);
        machine.put("X1", 1);
        machine.scan(MS10);
        machine.shows(&[("C0", 1)]);
    }
    // What does not fit changes neither image nor terminal.
    assert!(m.set("WX0", &Value::Integer(40_000)).is_err());
    assert!(m.set("X0", &Value::Integer(2)).is_err());
    m.power_cycle();
    m.shows(&[("X0", 0)]);
    m.scan(MS10);
    m.shows(&[("X0", 1)]);
}

#[test]
fn power_loss_clears_what_is_not_retentive() {
    let mut m = machine("STR X0\nSET Y0\nSET C0\nMOVE 7 N0");
    m.put("X0", 1);
    m.scan(MS10);
    m.power_cycle();
    m.shows(&[("X0", 0), ("Y0", 0), ("C0", 1), ("N0", 7)]);
    assert_eq!(m.mode(), Mode::Run);
}

#[test]
fn presets_beyond_32_bits_are_refused() {
    for rung in [
        "STR X0\nTMR T0 2147483648",
        "STR X0\nTMRDOWN T0 4294967295",
        "STR X0\nSTR X1\nCNT CT0 2147483648",
        "STR X0\nSTR X1\nSTR X2\nUDC CT0 5 2147483648",
        "STR X0\nFLASHER 500 2147483648 Y0",
    ] {
        let text = format!("$PRGRM $Main\n\n{rung}\n\n$PGMEND $Main\n");
        let refusals = program(&text, &Options::default()).err().unwrap_or_default();
        assert!(refusals.iter().any(|refusal| refusal.to_string().contains("goes up to 2147483647")), "{rung}");
    }
    machine("STR X0\nTMR T0 2147483647").scan(MS10);
}
