//! Programs nobody would write: whatever compiles runs without a panic, ends, and runs twice the same.

use std::time::Duration;

use domore::engine::{Machine, Mode, Options, Program, Unsupported};
use domore::instruction::{Effect, Join, Kind, TABLE, Table};

/// A small generator: the tests must not depend on the machine they run on.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit.max(1)
    }

    fn pick<'t>(&mut self, from: &[&'t str]) -> &'t str {
        from.get(self.below(from.len())).copied().unwrap_or("X0")
    }
}

const OPERANDS: &[&str] = &[
    "X0",
    "Y1",
    "C2",
    "C0:UW",
    "N0",
    "N1:3",
    "D0",
    "D1:W1",
    "R0",
    "V4",
    "T0",
    "T0.Acc",
    "T0.Done",
    "CT0",
    "CT0.Acc",
    "CT0.DnDone",
    "ST1",
    "ST2",
    "DST511",
    "SDT0.Hour",
    "SS0",
    "N[N0]",
    "C[D0 % 40]",
    "D[0 - 1]",
    "0",
    "1",
    "-5",
    "0x20000",
    "2147483647",
    "-2147483648",
    "1.5",
    "1e30",
    "$Main",
    "Sub",
    "$Main.S0",
    "$Main.S3",
    "\"3 N0 N4 2\"",
    "\"3 C0 C9 1\"",
    "\"4 0x0 N0 D0 5 0x0 R0 N9 1\"",
    "\"N0 / D0\"",
    "\"D0 * D0 * D0 + 1 % N0\"",
    "\"N[N0] ** 40\"",
    "\"IF(X0, R0 / R1, -D0)\"",
    "\"SUMR(D0, N0) << N1\"",
    "\"1 +\"",
    "\"\"",
    "\"3\"",
    "N4095",
    "V4096",
    "DLX8",
    "bogus",
    "",
    "\"open",
];

/// An operand that fits, most of the time.
fn operand(random: &mut Random, kind: Kind) -> &'static str {
    if random.below(60) == 0 {
        return random.pick(OPERANDS);
    }
    match kind {
        Kind::Bit => random.pick(&["X0", "Y1", "C2", "N1:3", "$Main.S1", "C9"]),
        Kind::Number | Kind::Value => {
            random.pick(&["N0", "D0", "R0", "V4", "D1:W1", "N[N0]", "T0.Acc", "C0:UW", "CT0.Acc"])
        }
        Kind::Timer => random.pick(&["T0", "T1"]),
        Kind::Counter => random.pick(&["CT0", "CT1"]),
        Kind::Text => "SS0",
        Kind::CodeBlock => random.pick(&["Sub", "$Main"]),
        Kind::Stage => random.pick(&["$Main.S0", "$Main.S1", "$Main.S2"]),
        Kind::Expression => random.pick(&[
            "\"N0 / D0\"",
            "\"D0 * D0 * D0 + 1 % N0\"",
            "\"N[N0] ** 40\"",
            "\"IF(X0, R0 / R1, -D0)\"",
            "\"D0 + 1\"",
        ]),
        Kind::Table(Table::FlaggedCopies) => "\"4 0x0 N0 D0 5 0x0 R0 N9 1\"",
        Kind::Table(Table::Fills) => "\"3 N0 N4 2\"",
        Kind::Table(_) => random.pick(&["\"3 N0 N4 2\"", "\"3 C0 C9 1\"", "\"3\""]),
        Kind::Flags => "0x20000",
        _ => random.pick(OPERANDS),
    }
}

fn text(random: &mut Random) -> String {
    let mut text = String::from("$PRGRM $Main\n\n");
    for block in 0..2 {
        for _ in 0..1 + random.below(8) {
            let entry = TABLE.get(random.below(TABLE.len())).expect("an entry");
            // As many values as the instruction takes; a rung of another shape now and then.
            let odd = random.below(40) == 0;
            let pushes = match entry.effect {
                Effect::Series | Effect::Parallel => 2,
                Effect::Alone | Effect::Contact { join: Join::Push, .. } => 0,
                _ => entry.legs().max(1),
            };
            for _ in 0..pushes + usize::from(odd) {
                text.push_str(&format!(
                    "{} {}\n",
                    random.pick(&["STR", "STRN", "STRPD", "STRND"]),
                    random.pick(&OPERANDS[..3])
                ));
            }
            let operands: Vec<_> = entry.operands.iter().map(|found| operand(random, found.kind)).collect();
            text.push_str(&format!("{} {}\n", entry.mnemonic, operands.join(" ")));
            if entry.mnemonic == "FOR" {
                text.push_str("\nSTR ST1\nINC D9\n\nNEXT\n");
            }
            text.push('\n');
        }
        if block == 0 {
            text.push_str("$PGMEND $Main\n\n$LGCMOD Sub\n\n");
        }
    }
    text + "RET\n\n$LGCEND Sub\n"
}

#[test]
fn random_programs_end_and_repeat() {
    let mut random = Random(7);
    let (mut ran, mut refused) = (0, 0);
    for _ in 0..1_200 {
        let Ok(reading) = domore::text::read(&text(&mut random)) else { continue };
        let unsupported = if random.below(2) == 0 { Unsupported::Refuse } else { Unsupported::Stop };
        let options = Options { unsupported, watchdog: 20_000, ..Options::default() };
        let program = match Program::compile(&reading.project, &options) {
            Ok(program) => program,
            Err(refusals) => {
                assert!(refusals.iter().all(|refusal| !refusal.why.is_empty()));
                refused += 1;
                continue;
            }
        };
        ran += 1;
        let mut machines = [Machine::new(program.clone()), Machine::new(program)];
        let inputs: Vec<i64> = (0..12).map(|_| random.below(2) as i64).collect();
        for machine in &mut machines {
            machine.enter_run();
            for input in &inputs {
                machine.set("X0", &domore::engine::Value::Integer(*input)).expect("an input");
                machine.scan(Duration::from_millis(70));
                if *input == 1 && machine.mode() == Mode::Run && machine.scans().is_multiple_of(5) {
                    machine.enter_program();
                    machine.enter_run();
                    machine.power_cycle();
                }
            }
        }
        let [one, other] = machines;
        let saved = one.save();
        assert!(saved == other.save(), "a program runs differently the second time");
        let mut restored = one.fork();
        restored.restore(&saved).expect("its own state");
        assert!(restored.save() == saved);
    }
    assert!(ran > 50 && refused > 50, "{ran} ran, {refused} were refused");
}

#[test]
fn expressions_of_any_text_end() {
    let map = domore::memory::Map::new(&domore::Project::default()).expect("memory");
    let data = domore::memory::Data::new(map.bytes());
    let pieces = [
        "N0", "D[", "]", "(", ")", "+", "-", "**", ">>>", "IF(", ",", "1", "0x", "1e9", "R0", ".", ":UW", "!", "~",
        "AVGR(", "%", "é",
    ];
    let mut random = Random(11);
    for _ in 0..20_000 {
        let text: String = (0..random.below(24)).map(|_| random.pick(&pieces)).collect();
        if let Ok(formula) = domore::math::Formula::parse(&text, &map) {
            // A value or a trouble; which is another test's business.
            let _ = formula.value(&data, domore::choices::Choices::default());
        }
        if let Ok(expression) = domore::math::Expression::parse(&text) {
            let written = expression.to_string();
            assert_eq!(domore::math::Expression::parse(&written).as_ref(), Ok(&expression), "{text} -> {written}");
        }
    }
}
