//! Words and bits of the status file the engine reads or writes.

/// A bit of the status file: word and mask.
pub type Bit = (usize, u16);

/// Arithmetic flags.
pub const FLAGS: usize = 0;
/// Carry.
pub const CARRY: u16 = 1;
/// Overflow.
pub const OVERFLOW: u16 = 2;
/// Zero.
pub const ZERO: u16 = 4;
/// Sign.
pub const SIGN: u16 = 8;
/// Mode and state bits.
pub const MODE: usize = 1;
/// Mask of the mode code in [`MODE`].
pub const MODE_CODE: u16 = 0x1F;
/// Forces are enabled.
pub const FORCES_ENABLED: Bit = (MODE, 1 << 5);
/// Forces are installed.
pub const FORCES_INSTALLED: Bit = (MODE, 1 << 6);
/// Major error halted.
pub const MAJOR_ERROR: Bit = (MODE, 1 << 13);
/// First pass.
pub const FIRST_PASS: Bit = (MODE, 1 << 15);
/// STI bits and selections.
pub const CONTROL: usize = 2;
/// STI pending.
pub const STI_PENDING: Bit = (CONTROL, 1);
/// STI enabled.
pub const STI_ENABLED: Bit = (CONTROL, 2);
/// STI executing.
pub const STI_EXECUTING: Bit = (CONTROL, 4);
/// Indexed addresses may cross file boundaries.
pub const INDEX_ACROSS: Bit = (CONTROL, 8);
/// STI set point counts milliseconds.
pub const STI_MILLISECONDS: Bit = (CONTROL, 1 << 10);
/// DII pending.
pub const DII_PENDING: Bit = (CONTROL, 1 << 11);
/// DII enabled.
pub const DII_ENABLED: Bit = (CONTROL, 1 << 12);
/// DII executing.
pub const DII_EXECUTING: Bit = (CONTROL, 1 << 13);
/// Math overflow keeps the low bits.
pub const OVERFLOW_WRAPS: Bit = (CONTROL, 1 << 14);
/// Scan time, low byte, and watchdog, high byte.
pub const SCAN_TIME: usize = 3;
/// Free running clock.
pub const CLOCK: usize = 4;
/// Minor errors.
pub const MINOR: usize = 5;
/// Overflow trap.
pub const TRAP: u16 = 1;
/// Control register error.
pub const CONTROL_ERROR: u16 = 1 << 2;
/// Major error while the fault routine ran.
pub const FAULT_IN_ROUTINE: u16 = 1 << 3;
/// STI expired while it was executing.
pub const STI_OVERFLOW: u16 = 1 << 10;
/// A discrete input interrupt came while one was waiting.
pub const DII_OVERFLOW: u16 = 1 << 12;
/// ASCII string error.
pub const STRING_ERROR: u16 = 1 << 15;
/// Minor error bits that become major error 0020 at the end of the scan.
pub const MINOR_FATAL: u16 = TRAP | CONTROL_ERROR | FAULT_IN_ROUTINE;
/// Major error code.
pub const FAULT_CODE: usize = 6;
/// Suspend code.
pub const SUSPEND_CODE: usize = 7;
/// Suspend file.
pub const SUSPEND_FILE: usize = 8;
/// Math register, low word.
pub const MATH_LOW: usize = 13;
/// Math register, high word.
pub const MATH_HIGH: usize = 14;
/// Rung executed last when a fault occurred.
pub const FAULT_RUNG: usize = 20;
/// File executed last when a fault occurred.
pub const FAULT_FILE: usize = 21;
/// Longest scan.
pub const MAXIMUM_SCAN: usize = 22;
/// Average scan.
pub const AVERAGE_SCAN: usize = 23;
/// Index register.
pub const INDEX: usize = 24;
/// User fault routine.
pub const FAULT_ROUTINE: usize = 29;
/// STI period.
pub const STI_PERIOD: usize = 30;
/// STI program file.
pub const STI_FILE: usize = 31;
/// Miscellaneous selections of the SLC 5/03 and higher.
pub const MISCELLANEOUS: usize = 33;
/// Scan times in milliseconds instead of 10 ms.
pub const SCAN_IN_MILLISECONDS: Bit = (MISCELLANEOUS, 1 << 13);
/// Last scan time.
pub const LAST_SCAN: usize = 35;
/// Further minor errors of the SLC 5/03 and higher.
pub const EXTENDED_MINOR: usize = 36;
/// DII lost.
pub const DII_LOST: u16 = 1 << 8;
/// STI lost.
pub const STI_LOST: u16 = 1 << 9;
/// Year; month, day, hour, minute, second follow.
pub const YEAR: usize = 37;
/// DII program file.
pub const DII_FILE: usize = 46;
/// DII slot.
pub const DII_SLOT: usize = 47;
/// DII mask: bits of the first input word that are looked at.
pub const DII_MASK: usize = 48;
/// DII compare value.
pub const DII_COMPARE: usize = 49;
/// DII preset: events per interrupt.
pub const DII_PRESET: usize = 50;
/// DII return mask: bits that changed with the event.
pub const DII_RETURN: usize = 51;
/// DII accumulator.
pub const DII_ACCUMULATOR: usize = 52;
/// Day of the week.
pub const DAY_OF_WEEK: usize = 53;
/// Words the engine relies on: a shorter status file is extended in memory, never in what is shown.
pub const WORDS: usize = 66;
