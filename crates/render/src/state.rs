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

/// Whether RSLogix highlights an instruction: a contact that the bit in the data table lets conduct, any
/// coil whose bit is 1, an OTU too. Indirect addresses count as what their indices hold. `None` for other
/// instructions and for bits that the project does not hold (indexed by S:24, beyond the end).
pub(crate) fn shown(image: &Image, instruction: &Instruction) -> Option<bool> {
    let wanted = match instruction.mnemonic.name()? {
        "XIC" | "OTE" | "OTL" | "OTU" => true,
        "XIO" => false,
        _ => return None,
    };
    let [operand] = instruction.operands.as_slice() else { return None };
    let address = operand.address().filter(|address| !address.indexed && address.bit.is_some())?;
    match image.value_at(&resolved(image, address, 0)?)? {
        Value::Bit(bit) => Some(bit == wanted),
        _ => None,
    }
}

/// An address with the numbers that its indices hold in the data table now.
fn resolved(image: &Image, address: &Address, depth: usize) -> Option<Address> {
    if address.is_direct() {
        return Some(address.clone());
    }
    // The language has one level of brackets.
    if depth > 1 || address.indexed {
        return None;
    }
    let number = |place: &Place| match place {
        Place::Number(number) => Some(*number),
        Place::Indirect(index) => match image.value_at(&resolved(image, index, depth + 1)?)? {
            Value::Word(word) => u16::try_from(word).ok(),
            _ => None,
        },
    };
    let file = number(&address.file)?;
    let mut element = number(&address.element)?;
    let mut bit = address.bit.as_ref().map(number);
    if let (Some(Place::Indirect(_)), Some(Some(number))) = (&address.bit, &mut bit) {
        // An index counts bits on through the elements of the file.
        let words = image.data_file(address.file_type, file)?.words_per_element;
        let bits = words.checked_mul(16).filter(|bits| *bits > 0 && address.word.is_none())?;
        element = element.checked_add(*number / bits)?;
        *number %= bits;
    }
    let bit = match bit {
        None => None,
        Some(number) => Some(Place::Number(number?)),
    };
    Some(Address { file: Place::Number(file), element: Place::Number(element), bit, ..address.clone() })
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
