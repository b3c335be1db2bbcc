//! The table itself: one file per family of instructions, joined and indexed here at compile time.

use crate::model::{Form, Instruction};

mod ascii;
mod bit;
mod clock;
mod communication;
mod compare;
mod control_operands;
mod conversion;
mod counter;
mod file;
mod high_speed;
mod interrupt;
mod logic;
mod math;
mod process;
mod program_control;
mod sequencer;
mod storage;
mod timer;

const FAMILIES: &[&[Instruction]] = &[
    bit::SET,
    timer::SET,
    counter::SET,
    compare::SET,
    math::SET,
    conversion::SET,
    logic::SET,
    file::SET,
    sequencer::SET,
    ascii::SET,
    program_control::SET,
    interrupt::SET,
    high_speed::SET,
    process::SET,
    clock::SET,
    communication::SET,
    storage::SET,
];

const COUNT: usize = {
    let (mut count, mut family) = (0, 0);
    while family < FAMILIES.len() {
        count += FAMILIES[family].len();
        family += 1;
    }
    count
};

static ALL: [Instruction; COUNT] = sorted();

/// All entries by mnemonic: an insertion sort, because nothing better runs in a constant.
const fn sorted() -> [Instruction; COUNT] {
    let mut all = [bit::SET[0]; COUNT];
    let (mut filled, mut family) = (0, 0);
    while family < FAMILIES.len() {
        let mut row = 0;
        while row < FAMILIES[family].len() {
            let new = FAMILIES[family][row];
            let mut at = filled;
            while at > 0 && precedes(new.mnemonic, all[at - 1].mnemonic) {
                all[at] = all[at - 1];
                at -= 1;
            }
            all[at] = new;
            filled += 1;
            row += 1;
        }
        family += 1;
    }
    all
}

const fn precedes(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut i = 0;
    while i < a.len() && i < b.len() {
        if a[i] != b[i] {
            return a[i] < b[i];
        }
        i += 1;
    }
    a.len() < b.len()
}

/// Operation code to (entry, form); codes above the highest one ever seen fit in a byte.
static BY_OPCODE: [Option<(u8, u8)>; 256] = {
    let mut index = [None; 256];
    let mut row = 0;
    while row < COUNT {
        let forms = ALL[row].forms;
        let mut number = 0;
        while number < forms.len() {
            if let (Some(opcode), None) = (forms[number].opcode, forms[number].stored_as) {
                assert!(index[opcode as usize].is_none(), "an operation code stands twice in the table");
                index[opcode as usize] = Some((row as u8, number as u8));
            }
            number += 1;
        }
        row += 1;
    }
    index
};

/// Every instruction, sorted by mnemonic.
pub fn all() -> &'static [Instruction] {
    &ALL
}

/// The instruction with this mnemonic (upper case).
pub fn by_mnemonic(mnemonic: &str) -> Option<&'static Instruction> {
    ALL.binary_search_by(|instruction| instruction.mnemonic.cmp(mnemonic)).ok().and_then(|row| ALL.get(row))
}

/// The instruction and the form a stored operation code stands for. Structural codes (0 to 5) and
/// codes nobody has identified give `None`.
///
/// 0x83 gives AWA; RSLogix stores AWT with the same code, see [`Form::stored_as`].
pub fn by_opcode(opcode: u16) -> Option<(&'static Instruction, &'static Form)> {
    let (row, form) = (*BY_OPCODE.get(usize::from(opcode))?)?;
    let instruction = ALL.get(usize::from(row))?;
    Some((instruction, instruction.forms.get(usize::from(form))?))
}
