//! `PROCESSOR`: processor model, program identity, driver and route.

use crate::archive::{Reader, Record, Writer};
use crate::error::Result;
use crate::text::Text;

/// Processor model code as stored. Any value is valid; names are in
/// [`crate::tables::processor_model`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Model(pub u16);

impl Model {
    /// MicroLogix 1400, Series A and B: the models whose record has five bytes more.
    fn has_tail(self) -> bool {
        matches!(self.0, 62 | 63)
    }
}

/// The `CProc` record. Evidence per field: `docs/format/project-streams.md`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Processor<'a> {
    /// Model that the project is written for (proven).
    pub model: Model,
    /// Processor type that the last connected controller answered with, or the
    /// model if there was none (inferred).
    pub reported: Model,
    /// Driver name and settings as stored; see [`Driver`].
    pub driver: Text<'a>,
    /// Six bytes after the driver, zero in every known project (unknown).
    pub after_driver: [u8; 6],
    /// Processor name (printed).
    pub name: Text<'a>,
    /// Name of the main program: empty or `MAIN_PROG` (inferred).
    pub main_program: Text<'a>,
    /// Program ID; printed in hexadecimal (proven).
    pub program_id: u16,
    /// 1 except in a few projects never read from a processor (unknown).
    pub after_program_id: u32,
    /// Route to the controller, `HOST!DRIVER\address`; empty if never chosen (proven).
    pub route: Text<'a>,
    /// Bytes after the route: five zero bytes for the MicroLogix 1400, else none (unknown).
    pub tail: &'a [u8],
}

impl<'a> Record<'a> for Processor<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CProc")?;
        self.model = Model(r.u16("the processor model")?);
        self.reported = Model(r.u16("the reported processor type")?);
        self.driver = r.string("the driver")?;
        self.after_driver = r.array("six bytes after the driver")?;
        // Passwords, if this record can hold any, would have to stand here: a
        // value never seen is worth a line, not an error.
        self.after_driver = r.usually("zero bytes after the driver", self.after_driver, &[0; 6])?;
        self.name = r.string("the processor name")?;
        self.main_program = r.string("the main program name")?;
        self.program_id = r.u16("the program ID")?;
        self.after_program_id = r.u32("a number after the program ID")?;
        self.route = r.string("the route")?;
        r.mark();
        let expected = if self.model.has_tail() { 5 } else { 0 };
        if r.remaining() == expected {
            self.tail = r.bytes("the bytes after the route", expected)?;
        } else {
            let found = r.remaining();
            r.deviation(format_args!("{expected} bytes after the route for model {}", self.model.0), found)?;
            self.tail = r.opaque("the bytes after the route", found)?;
        }
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CProc");
        w.u16(self.model.0);
        w.u16(self.reported.0);
        w.string(&self.driver)?;
        w.bytes(&self.after_driver);
        w.string(&self.name)?;
        w.string(&self.main_program)?;
        w.u16(self.program_id);
        w.u32(self.after_program_id);
        w.string(&self.route)?;
        w.bytes(self.tail);
        Ok(())
    }
}

impl Processor<'_> {
    /// The driver string taken apart, if it has the known shape.
    #[must_use]
    pub fn driver_settings(&self) -> Option<Driver> {
        Driver::parse(self.driver.as_bytes())
    }

    /// The route taken apart: host, driver, address; `None` if it is empty or
    /// names no host.
    #[must_use]
    pub fn route_parts(&self) -> Option<Route> {
        let route = self.route.decode();
        let (host, rest) = route.split_once('!')?;
        let (driver, address) = rest.split_once('\\').unwrap_or((rest, ""));
        Some(Route { host: host.to_owned(), driver: driver.to_owned(), address: address.to_owned() })
    }
}

/// `HOST!DRIVER\address`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Route {
    /// Name of the computer that held the driver.
    pub host: String,
    /// Name of the communication driver.
    pub driver: String,
    /// Node number or IP address; empty if no controller was chosen.
    pub address: String,
}

/// Bytes of driver settings inside the driver string.
pub const DRIVER_BYTES: usize = 170;
/// Separates the driver name from its settings.
const DRIVER_MARK: &[u8] = b"%A000%";
/// Ends the settings.
const DRIVER_END: &[u8] = b"%D";
/// Place of the address record inside the settings.
const ADDRESS_AT: usize = 34;
const ADDRESS_NODE: u16 = 0x0081;
const ADDRESS_TEXT: u16 = 0x00A2;

/// What the driver string says: a name and 170 bytes of settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Driver {
    /// Driver name, e.g. `AB_DF1-1`; chosen by the user, `(unknown)` if none was.
    pub name: String,
    /// The settings. Zero except for the address record.
    pub settings: [u8; DRIVER_BYTES],
}

/// Address of the controller on its driver (proven against the route).
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DriverAddress {
    /// Node number on a serial driver, the emulator or a bus.
    Node(u8),
    /// Host or IP address of an Ethernet driver.
    Text(String),
}

impl Driver {
    /// Takes a stored driver string apart; `None` if it has another shape.
    #[must_use]
    pub fn parse(stored: &[u8]) -> Option<Driver> {
        let at = stored.windows(DRIVER_MARK.len()).position(|window| window == DRIVER_MARK)?;
        let (name, rest) = stored.split_at_checked(at)?;
        let digits = rest
            .strip_prefix(DRIVER_MARK)?
            .strip_suffix(DRIVER_END)
            .filter(|digits| digits.len() == 2 * DRIVER_BYTES)?;
        let mut settings = [0; DRIVER_BYTES];
        for (byte, pair) in settings.iter_mut().zip(digits.chunks_exact(2)) {
            // The low digit comes first.
            *byte = match pair {
                [low, high] => hex_digit(*high)? << 4 | hex_digit(*low)?,
                _ => return None,
            };
        }
        Some(Driver { name: crate::text::decode(name).into_owned(), settings })
    }

    /// The stored form, for [`Processor::driver`].
    ///
    /// # Errors
    /// The first character of the name that code page 1252 lacks.
    pub fn to_stored(&self) -> std::result::Result<Vec<u8>, char> {
        let mut stored = crate::text::encode(&self.name)?;
        stored.extend_from_slice(DRIVER_MARK);
        for byte in self.settings {
            stored.extend([hex_char(byte & 0xF), hex_char(byte >> 4)]);
        }
        stored.extend_from_slice(DRIVER_END);
        Ok(stored)
    }

    /// A driver of this name that was never connected.
    #[must_use]
    pub fn unconnected(name: &str) -> Driver {
        let mut settings = [0; DRIVER_BYTES];
        // As every project stores it that never chose a driver: node 1.
        for (at, value) in [(ADDRESS_AT + 4, 0x81), (ADDRESS_AT + 6, 1), (ADDRESS_AT + 8, 1)] {
            if let Some(byte) = settings.get_mut(at) {
                *byte = value;
            }
        }
        Driver { name: name.to_owned(), settings }
    }

    fn word(&self, at: usize) -> Option<u16> {
        let bytes = self.settings.get(at..)?.first_chunk::<2>()?;
        Some(u16::from_le_bytes(*bytes))
    }

    /// Kind of connection: 4 serial or emulator, 16 Ethernet, 0 never connected.
    #[must_use]
    pub fn kind(&self) -> u16 {
        self.word(ADDRESS_AT).unwrap_or_default()
    }

    /// The address record, if it has one of the two known shapes.
    #[must_use]
    pub fn address(&self) -> Option<DriverAddress> {
        let length = self.word(ADDRESS_AT + 6)?;
        let rest = self.settings.get(ADDRESS_AT + 8..)?;
        match self.word(ADDRESS_AT + 4)? {
            ADDRESS_NODE if length == 1 => rest.first().map(|node| DriverAddress::Node(*node)),
            ADDRESS_TEXT => {
                let (&kind, rest) = rest.split_first()?;
                let (&count, rest) = rest.split_first()?;
                let text = rest.get(..usize::from(count))?;
                (kind == 0x10).then(|| DriverAddress::Text(crate::text::decode(text).into_owned()))
            }
            _ => None,
        }
    }
}

fn hex_digit(digit: u8) -> Option<u8> {
    match digit {
        b'0'..=b'9' => Some(digit - b'0'),
        b'A'..=b'F' => Some(digit - b'A' + 10),
        // Lower case would not survive rewriting: another shape.
        _ => None,
    }
}

fn hex_char(nibble: u8) -> u8 {
    match nibble & 0xF {
        low @ 0..=9 => b'0' + low,
        high => b'A' + (high - 10),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archive::{parse, serialize};
    use crate::error::Mode;

    /// A record laid out by hand: model, reported type, an Ethernet driver, names, ID.
    fn sample(model: u16, tail: &[u8]) -> Vec<u8> {
        let mut settings = [0u8; DRIVER_BYTES];
        let address = b"\x10\0\x10\0\xA2\0\x0C\0\x10\x0A10.20.30.4";
        settings[34..34 + address.len()].copy_from_slice(address);
        let mut driver = b"AB_ETH-1%A000%".to_vec();
        for byte in settings {
            driver.extend(format!("{:X}{:X}", byte & 15, byte >> 4).bytes());
        }
        driver.extend(b"%D");
        assert_eq!(driver.len(), 348 + 8);
        let mut bytes = b"\xFF\xFF\x80\0\x05\0CProc".to_vec();
        bytes.extend(model.to_le_bytes());
        bytes.extend(0x9Cu16.to_le_bytes());
        bytes.push(0xFF);
        bytes.extend((driver.len() as u16).to_le_bytes());
        bytes.extend(driver);
        bytes.extend([0; 6]);
        bytes.extend(b"\x05MIXER\x00\x7B\xAB\x01\0\0\0\x17PC7!AB_ETH-1\\10.20.30.4");
        bytes.extend(tail);
        bytes
    }

    #[test]
    fn fields_stand_where_the_layout_says() {
        let bytes = sample(61, b"");
        let parsed = parse::<Processor>(&bytes, "PROCESSOR/ObjectData", Mode::Strict);
        assert_eq!(parsed.error, None);
        assert_eq!(parsed.understood, bytes.len());
        let record = parsed.value;
        assert_eq!((record.model, record.reported), (Model(61), Model(0x9C)));
        assert_eq!(record.name, "MIXER");
        assert_eq!(record.program_id, 0xAB7B);
        let driver = record.driver_settings().expect("known shape");
        assert_eq!(driver.name, "AB_ETH-1");
        assert_eq!(driver.kind(), 16);
        assert_eq!(driver.address(), Some(DriverAddress::Text("10.20.30.4".into())));
        assert_eq!(driver.to_stored().as_deref(), Ok(record.driver.as_bytes()));
        let route = record.route_parts().expect("three parts");
        assert_eq!((&*route.host, &*route.driver, &*route.address), ("PC7", "AB_ETH-1", "10.20.30.4"));
        assert_eq!(serialize(&record), Ok(bytes));
    }

    #[test]
    fn an_unexpected_tail_is_carried_and_reported() {
        for (model, tail, deviations) in [(63, &[0u8; 5][..], 0), (61, b"\x01\x02", 1), (62, b"", 1)] {
            let bytes = sample(model, tail);
            let parsed = parse::<Processor>(&bytes, "S", Mode::Permissive);
            assert_eq!(parsed.error, None);
            assert_eq!(parsed.deviations.len(), deviations);
            assert_eq!(parsed.understood, bytes.len() - if deviations > 0 { tail.len() } else { 0 });
            assert_eq!(serialize(&parsed.value), Ok(bytes.clone()));
            assert_eq!(parse::<Processor>(&bytes, "S", Mode::Strict).error.is_some(), deviations > 0);
        }
    }

    #[test]
    fn a_new_driver_has_an_empty_address() {
        let driver = Driver::unconnected("EMU500-1");
        assert_eq!(driver.kind(), 0);
        assert_eq!(driver.address(), Some(DriverAddress::Node(1)));
        let stored = driver.to_stored().expect("ASCII");
        assert_eq!(Driver::parse(&stored), Some(driver));
        assert_eq!(Driver::parse(b"EMU500-1%A000%00%D"), None);
    }
}
