//! No scan allocates memory, whatever it executes.

use std::alloc::System;
use std::time::Duration;

use domore::engine::{Machine, Options, Program, Value};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static GLOBAL: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const TEXT: &str = "$PRGRM $Main\n\nSG $Main.S0\n\nSTR X0\nJMP $Main.S1\n\nSG $Main.S1\n\nSTR X1\nSTR X2\nCNT CT0 N0\n\n\
    STR X1\nONDTMR T0 20 Y0\n\nSTRPD X1\nANDNE N0 N1\nMATH N[N2] \"IF(R0 > 1.5, SQRT(R0), AVGR(N0, 4)) + N[N2] / N3\"\n\
    COPY 0x0 \"4 0x0 N0 D0 9 0x0 C0 N20 3\"\nSCALE N0 0 10 0 100 R1\n\nFOR D9 1 5 1\n\nSTR ST1\nINC D10\n\nNEXT\n\n\
    STR ST4\nCALL Sub 0x0 DST511 \"3 N0 N40 2\" \"3 N40 N42 1\"\nFLASHER 20 30 Y1\n\nSTR X2\nRUN Batch\n\nSTR X1\nHALT Batch\n\n\
    $PGMEND $Main\n$LGCMOD Sub\n\nSTRDLT N40\nOUT C9\n\nRET\n\n$LGCEND Sub\n$PRGRM Batch\n\nSTR ST1\nTMR T5 50\nOUT Y7\n\n$PGMEND Batch\n";

#[test]
fn scanning_allocates_nothing() {
    let project = domore::text::read(TEXT).expect("reads").project;
    let program = Program::compile(&project, &Options::default()).expect("compiles");
    let mut machine = Machine::new(program);
    machine.enter_run();
    let inputs = ["X0", "X1", "X2"].map(|address| machine.handle(address).expect("an input"));
    machine.set("R0", &Value::Real(2.5)).expect("a real");
    let copy = machine.fork();
    let region = Region::new(GLOBAL);
    for scan in 0..500u32 {
        for (index, input) in inputs.iter().enumerate() {
            machine.set_number(*input, domore::memory::Num::Int((scan >> index & 1).into()));
        }
        machine.scan(Duration::from_millis(10));
        if scan == 400 {
            machine.copy_from(&copy);
        }
    }
    assert_eq!(region.change().allocations, 0);
    assert!(machine.instructions() > 1_000 && machine.fault().is_none());
}
