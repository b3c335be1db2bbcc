//! What the data of a project says about its contacts and coils: forces, and what RSLogix highlights.

use ladder::{Address, DataFile, FileType, Force, Image, Instruction, Place, Value};

/// Below a point that is forced on.
pub(crate) const FORCED_ON: &str = "force ON";
/// Below a point that is forced off.
pub(crate) const FORCED_OFF: &str = "force OFF";
/// Below a contact that conducts or a coil that is on.
pub(crate) const TRUE: &str = "T";

/// Whether a direct I/O bit is forced on or off. Where both masks name it, off wins, as in
/// [`Force::apply`].
pub(crate) fn forced(image: &Image, address: &Address) -> Option<bool> {
    if !matches!(address.file_type, FileType::I | FileType::O) || !address.is_direct() {
        return None;
    }
    let bit = address.bit.as_ref().and_then(Place::number)?;
    let file = image.data_file(address.file_type, address.file.number()?)?;
    // Bits of a slot count on through its words.
    let word = image.io.word_index(address)?.checked_add(bit / 16)?;
    of_bit(force(file, word)?, bit % 16)
}

fn force(file: &DataFile, word: u16) -> Option<Force> {
    file.forces.get(usize::from(word)).copied()
}

fn of_bit(force: Force, bit: u16) -> Option<bool> {
    let mask = 1_u16.checked_shl(u32::from(bit))?;
    if force.off & mask == 0 { Some(false) } else { (force.on & mask != 0).then_some(true) }
}

/// Whether RSLogix highlights an instruction: a contact that the bit in the data table lets conduct, a
/// coil whose bit is as the coil makes it. `None` for other instructions and for bits that are not
/// known from the file alone (indirect, indexed, beyond the end).
pub(crate) fn shown(image: &Image, instruction: &Instruction) -> Option<bool> {
    let wanted = match instruction.mnemonic.name()? {
        "XIC" | "OTE" | "OTL" => true,
        "XIO" | "OTU" => false,
        _ => return None,
    };
    let [operand] = instruction.operands.as_slice() else { return None };
    let address = operand.address().filter(|address| address.is_direct() && address.bit.is_some())?;
    match image.value_at(address)? {
        Value::Bit(bit) => Some(bit == wanted),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_of_a_bit() {
        let force = Force { on: 0b0101, off: !0b0110 };
        assert_eq!(of_bit(force, 0), Some(true));
        assert_eq!(of_bit(force, 1), Some(false));
        assert_eq!(of_bit(force, 2), Some(false), "off wins, as when the masks are applied");
        assert_eq!(force.apply(0) & 0b0100, 0);
        assert_eq!(of_bit(force, 3), None);
        assert_eq!(of_bit(Force::NONE, 15), None);
    }
}
