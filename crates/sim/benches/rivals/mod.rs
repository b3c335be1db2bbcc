//! One ladder in three languages: SLC text, C and pyrung.
//!
//! Rungs come in groups of [`MIX`]; every group has a word of bits, a timer, a counter and an integer
//! of its own. `$k` is the number of the group, `$a $b $c` are input bits, `$p` a preset; `$B $T $C $N`
//! are the addresses of the group in SLC text.

pub(crate) mod c;
pub(crate) mod pyrung;

use ladder::{Address, Family, Value};
use sim::{Machine, Options, Program};

/// A rung as SLC text, C and pyrung. pyrung resets a counter in the rung that counts.
pub(crate) const MIX: [[&str; 3]; 10] = [
    ["XIC I:0/$a XIO $B/3 OTE $B/0", "coil(&B[$k], 0, in($a) && !bit(B[$k], 3));", "with rung(i[$a], ~b3): out(b0)"],
    [
        "BST XIC I:0/$b NXB XIC $B/1 BND XIO I:0/$c OTE $B/1",
        "coil(&B[$k], 1, (in($b) || bit(B[$k], 1)) && !in($c));",
        "with rung(Or(i[$b], b1), ~i[$c]): out(b1)",
    ],
    ["XIC $B/1 TON $T 0.01 $p 0", "ton(&T[$k], bit(B[$k], 1));", "with rung(b1): on_delay(t, $p, 'tms')"],
    ["XIC $T/DN OTL $B/2", "if (T[$k].control & DN) B[$k] |= 1 << 2;", "with rung(t.Done): latch(b2)"],
    ["XIC $C/DN OTU $B/2", "if (C[$k].control & DN) B[$k] &= ~(1 << 2);", "with rung(c.Done): reset(b2)"],
    [
        "XIC $B/0 XIC $B/1 CTU $C 5 0",
        "ctu(&C[$k], bit(B[$k], 0) && bit(B[$k], 1));",
        "with rung(rise(b0), b1): count_up(c, 5).reset(And(c.Done, i[$c]))",
    ],
    ["XIC $C/DN XIC I:0/$c RES $C", "if ((C[$k].control & DN) && in($c)) res(&C[$k]);", ""],
    [
        "GRT $T.ACC $N MOV $T.ACC $N",
        "if (T[$k].acc > N[$k]) mov(T[$k].acc, &N[$k]);",
        "with rung(t.Acc > n): copy(t.Acc, n)",
    ],
    [
        "EQU $C.ACC 3 ADD $T.ACC $C.ACC $N",
        "if (C[$k].acc == 3) add(T[$k].acc, C[$k].acc, &N[$k]);",
        "with rung(c.Acc == 3): calc(t.Acc + c.Acc, n)",
    ],
    ["LES $N 40 XIC $B/2 OTE $B/3", "coil(&B[$k], 3, N[$k] < 40 && bit(B[$k], 2));", "with rung(n < 40, b2): out(b3)"],
];

/// Inputs change after so many scans.
pub(crate) const SCANS_PER_INPUT: u64 = 8;

/// The next input word: the same sequence in every language.
pub(crate) fn next_input(word: u16) -> u16 {
    let word = word ^ word << 7;
    let word = word ^ word >> 9;
    word ^ word << 8
}

/// One template for one group.
fn fill(template: &str, k: usize) -> String {
    // At most 250 elements per file, further groups in files of their own.
    let element = |letter: &str, own: usize| format!("{letter}{}:{}", own + 4 * (k / 250), k % 250);
    let number = |factor: usize, offset: usize, modulus: usize| ((k * factor + offset) % modulus).to_string();
    template
        .replace("$k", &k.to_string())
        .replace("$a", &number(3, 0, 16))
        .replace("$b", &number(5, 1, 16))
        .replace("$c", &number(7, 2, 16))
        .replace("$p", &number(1, 20, 40))
        .replace("$B", &element("B", 10))
        .replace("$T", &element("T", 11))
        .replace("$C", &element("C", 12))
        .replace("$N", &element("N", 13))
}

/// The ladder in one of the languages, a line per rung.
fn lines(rungs: usize, language: usize) -> impl Iterator<Item = String> {
    (0..rungs).map(move |rung| fill(MIX[rung % MIX.len()][language], rung / MIX.len()))
}

/// A machine on `rungs` rungs, in run mode.
pub(crate) fn machine(rungs: usize) -> Machine {
    let text: Vec<String> = lines(rungs, 0).collect();
    let parsed = convert::slc::rung::parse_rungs(&text.join("\n"), Some(Family::Slc503)).expect("the ladder reads");
    let image = sim::inline_image(Family::Slc503, vec![(2, parsed)]);
    let program = Program::compile(&image, &Options { inline: true, ..Options::default() }).expect("it compiles");
    let mut machine = Machine::new(program);
    machine.enter_run();
    machine
}

/// A sum over all data words of the ladder, as the C program prints it.
pub(crate) fn checksum(machine: &Machine, groups: usize) -> u32 {
    let word = |template: &str, k: usize| {
        let address = Address::parse(&fill(template, k)).expect("an address");
        match machine.get(&address) {
            Ok(Value::Word(word)) => u32::from(word as u16),
            other => panic!("{address}: {other:?}"),
        }
    };
    let flags = word("S:0", 0) & 0xF;
    (0..groups).fold(flags, |sum, k| {
        ["$B", "$T.0", "$T.ACC", "$C.0", "$C.ACC", "$N"]
            .iter()
            .fold(sum, |sum, template| sum.wrapping_mul(31).wrapping_add(word(template, k)))
    })
}
