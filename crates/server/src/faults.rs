//! What a person can do about a major fault.

use sim::scenario::Stop;

/// What to look at behind a fault, and what to mend. The rung it stands at and its values are shown beside it.
const ADVICE: &[(u16, &str)] = &[
    (0x11, "Give the project a program file 2: that is where every scan begins."),
    (0x19, "Look for a JMP whose LBL is missing, or a label number that stands twice in one program file."),
    (
        0x20,
        "A minor error bit was set when the scan ended: look at S:5 (overflow S:5/0, control register S:5/2, ...). \
         A program that can live with it clears the bit (OTU S:5/0) behind the instruction that sets it.",
    ),
    (
        0x22,
        "The scan took longer than the watchdog allows: look for a jump backwards or a loop that never ends, or raise \
         the watchdog (S:3H).",
    ),
    (0x23, "The file of the timed interrupt (S:31, or STI:0) must be a ladder file that exists, from 3 to 255."),
    (0x24, "The period of the timed interrupt (S:30, or STI:0) is outside its range."),
    (0x25, "Too many JSR inside each other below the timed interrupt."),
    (0x26, "Too many JSR inside each other below the input interrupt."),
    (0x27, "Too many JSR inside each other below the fault routine."),
    (0x28, "S:29 must name a ladder file that exists, from 3 to 255, or be 0."),
    (0x29, "An address led beyond the data table: look at the offset in S:24 and at the index of the address."),
    (0x2A, "An indexed address led beyond its file: look at the offset in S:24."),
    (0x2B, "The word in brackets names a data file that does not exist, or one of another type."),
    (0x2C, "The word in brackets names an element that does not exist: look at its value in the rung."),
    (0x2D, "The word in brackets names a bit or word that does not exist: look at its value in the rung."),
    (0x2E, "The slot of the input interrupt holds no module with discrete inputs."),
    (0x2F, "The file of the input interrupt does not exist."),
    (0x30, "Too many JSR inside each other: look for a subroutine that calls itself."),
    (0x31, "The rung holds an instruction that is not simulated. On the controller the rung may run."),
    (0x32, "Length or position of the sequencer leads beyond its file: look at its LEN and POS."),
    (0x33, "Length or position of the shift register or stack leads beyond its file: look at its LEN and POS."),
    (0x34, "Preset or accumulator of a timer is below zero: look at both, and for what wrote them."),
    (0x35, "The instruction is not allowed in an interrupt or fault routine."),
    (0x36, "A parameter of the PID is outside its range: look at its control block."),
    (0x37, "A setting of the high-speed counter is not allowed."),
    (0x38, "RET stands in program file 2, which no JSR has called."),
];

/// What to look at, for the faults the simulation raises; others are told as they are.
pub fn advice(stop: &Stop) -> Option<&'static str> {
    ADVICE.iter().find(|row| row.0 == stop.code && stop.code != 0).map(|row| row.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_in_order_and_unknown_ones_get_no_advice() {
        assert!(ADVICE.windows(2).all(|pair| matches!(pair, [a, b] if a.0 < b.0)));
        let stop = |code| Stop { code, text: String::new() };
        assert!(advice(&stop(0x34)).is_some_and(|text| text.contains("below zero")));
        assert_eq!((advice(&stop(0)), advice(&stop(0x77))), (None, None));
    }
}
