//! The ladder as C, compiled by `gcc -O2`.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use super::{MIX, SCANS_PER_INPUT, lines};

/// What an engineer who writes the ladder in C would need: elements with their status bits, flags,
/// time since the last execution of each timer. A counter is reset long before it could wrap.
const HEAD: &str = r"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
enum { EN = 1 << 15, TT = 1 << 14, DN = 1 << 13, CU = 1 << 15 };
struct timer { uint16_t control; int16_t pre, acc; uint64_t last, part; };
struct counter { uint16_t control; int16_t pre, acc; };
static uint16_t I, S0, S5;
static uint64_t now;
static inline int in(int n) { return I >> n & 1; }
static inline int bit(uint16_t word, int n) { return word >> n & 1; }
static inline void coil(uint16_t *word, int n, int on) { *word = on ? *word | 1 << n : *word & ~(1 << n); }
static inline void flags(int16_t value, int carry, int overflow) {
    S0 = (S0 & ~15) | carry | overflow << 1 | (value == 0) << 2 | (value < 0) << 3;
    if (overflow) S5 |= 1;
}
static inline void mov(int16_t value, int16_t *dest) { *dest = value; flags(value, 0, 0); }
static inline void add(int16_t a, int16_t b, int16_t *dest) {
    int sum = a + b, carry = (uint16_t)a + (uint16_t)b > 0xFFFF;
    int16_t value = sum > 32767 ? 32767 : sum < -32768 ? -32768 : sum;
    *dest = value;
    flags(value, carry, value != sum);
}
static inline void ton(struct timer *t, int rung) {
    if (!rung) {
        t->control &= ~(EN | TT | DN);
        t->acc = 0; t->part = 0;
    } else {
        int done = (t->control & (EN | DN)) == (EN | DN);
        if (!(t->control & EN)) { t->acc = 0; t->part = 0; }
        if (!done && (t->control & EN) && t->acc < t->pre) {
            uint64_t gathered = t->part + (now - t->last);
            uint64_t ticks = gathered < 10000000 ? 0 : gathered / 10000000;
            t->part = gathered - ticks * 10000000;
            t->acc = t->acc + ticks > (uint64_t)t->pre ? t->pre : t->acc + (int16_t)ticks;
        }
        done |= t->acc >= t->pre;
        if (done) t->part = 0;
        t->control = (t->control & ~(EN | TT | DN)) | EN | (done ? DN : TT);
    }
    t->last = now;
}
static inline void ctu(struct counter *c, int rung) {
    if (rung && !(c->control & CU)) c->acc++;
    c->control = (c->control & ~(CU | DN)) | (rung ? CU : 0) | (c->acc >= c->pre ? DN : 0);
}
static inline void res(struct counter *c) { c->control = 0; c->acc = 0; }
";

const MAIN: &str = r#"
int main(int argc, char **argv) {
    uint64_t scans = argc > 1 ? strtoull(argv[1], 0, 10) : 1;
    for (int k = 0; k < GROUPS; k++) {
        T[k].pre = (k + 20) % 40;
        C[k].pre = 5;
        C[k].control = CU;
    }
    struct timespec start, end;
    uint16_t next = 1;
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (uint64_t s = 0; s < scans; s++) {
        if (s % SCANS_PER_INPUT == 0) { next ^= next << 7; next ^= next >> 9; next ^= next << 8; I = next; }
        now += 10000000;
        scan();
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    uint32_t sum = S0 & 15;
    for (int k = 0; k < GROUPS; k++) {
        uint16_t words[] = { B[k], T[k].control, T[k].acc, C[k].control, C[k].acc, N[k] };
        for (int w = 0; w < 6; w++) sum = sum * 31 + words[w];
    }
    printf("%lld %u\n", (end.tv_sec - start.tv_sec) * 1000000000LL + end.tv_nsec - start.tv_nsec, sum);
}
"#;

fn source(rungs: usize) -> String {
    let groups = rungs.div_ceil(MIX.len());
    let mut text = format!(
        "{HEAD}\nenum {{ GROUPS = {groups}, SCANS_PER_INPUT = {SCANS_PER_INPUT} }};\nstatic uint16_t B[{groups}];\n\
         static int16_t N[{groups}];\nstatic struct timer T[{groups}];\nstatic struct counter C[{groups}];\n\
         static void scan(void) {{\n"
    );
    for line in lines(rungs, 1) {
        let _ = writeln!(text, "    {line}");
    }
    text + "}\n" + MAIN
}

/// Time of `scans` scans of the ladder in C, and the sum over its data.
///
/// # Errors
/// gcc is not there or fails.
pub(crate) fn run(folder: &Path, rungs: usize, scans: u64) -> Result<(Duration, u32), String> {
    let program = folder.join(format!("ladder_{rungs}"));
    let file = program.with_extension("c");
    std::fs::write(&file, source(rungs)).map_err(|error| error.to_string())?;
    let gcc = Command::new("gcc").args(["-O2", "-o"]).arg(&program).arg(&file).output();
    let gcc = gcc.map_err(|error| format!("gcc: {error}"))?;
    if !gcc.status.success() {
        return Err(format!("gcc: {}", String::from_utf8_lossy(&gcc.stderr)));
    }
    let output = Command::new(&program).arg(scans.to_string()).output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut numbers = text.split_whitespace();
    let time = numbers.next().and_then(|word| word.parse().ok()).map(Duration::from_nanos);
    let sum = numbers.next().and_then(|word| word.parse().ok());
    time.zip(sum).ok_or_else(|| format!("unexpected answer: {text}"))
}
