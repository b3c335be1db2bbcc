//! `CHANNEL CONFIGURATION`: communication channels, their records and decoded settings.

mod words;

use crate::archive::{Reader, Record, Writer};
use crate::error::Result;
use crate::processor::Model;
use std::net::Ipv4Addr;

/// The `CChannelConfig` record. Evidence per field: `docs/format/project-streams.md`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ChannelConfiguration<'a> {
    /// Model, as in `PROCESSOR` (proven).
    pub model: Model,
    /// Channel 0, 1, ..; none for models that keep their settings in the status file.
    pub channels: Vec<Channel<'a>>,
    /// Bytes after the channels: eleven zeros where there is no channel, else none (unknown).
    pub tail: &'a [u8],
    /// Everything after the model where it is no list of channels: carried, not understood.
    pub other_shape: Option<&'a [u8]>,
}

/// One channel: words that hold a sequence of records.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Channel<'a> {
    /// The words as stored, two bytes each.
    bytes: &'a [u8],
}

/// Bytes after the channel count of a model without channels.
const NO_CHANNEL_TAIL: usize = 11;

impl<'a> Record<'a> for ChannelConfiguration<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CChannelConfig")?;
        self.model = Model(r.u16("the processor model")?);
        r.mark();
        let start = r.checkpoint();
        if let Err(error) = self.read_channels(r) {
            // Only models of eight codes are known: another one may well keep
            // its channels in another shape, which is no reason to lose them.
            r.rewind(&start);
            r.deviation("a list of channels", error)?;
            self.channels.clear();
            self.tail = &[];
            self.other_shape = Some(r.opaque("a channel configuration of another shape", r.remaining())?);
        }
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CChannelConfig");
        w.u16(self.model.0);
        if let Some(body) = self.other_shape {
            w.bytes(body);
            return Ok(());
        }
        let count = u8::try_from(self.channels.len())
            .map_err(|_| crate::error::Error::Unwritable(format!("{} channels", self.channels.len())))?;
        w.u8(count);
        for channel in &self.channels {
            w.count_u16(channel.bytes.len() / 2)?;
            w.bytes(channel.bytes);
        }
        w.bytes(self.tail);
        Ok(())
    }
}

impl<'a> ChannelConfiguration<'a> {
    fn read_channels(&mut self, r: &mut Reader<'a>) -> Result<()> {
        let count = usize::from(r.u8("the number of channels")?);
        r.check_room("a number of channels", count, 2)?;
        for index in 0..count {
            r.enter("channel", index)?;
            let words = r.count_u16("a number of words", 2)?;
            let at = r.offset();
            let bytes = r.bytes("the words of a channel", 2 * words)?;
            let channel = Channel { bytes };
            self.channels.push(channel);
            // A stale check value is common in one record kind, and the settings
            // it covers are still the stored ones: only the split is checked.
            for offset in channel.records().filter_map(std::result::Result::err) {
                r.deviation_at(at + offset, "a record that ends inside its channel", "one that does not")?;
            }
            r.leave();
        }
        let expected = if count == 0 { NO_CHANNEL_TAIL } else { 0 };
        let found = r.remaining();
        if found == expected {
            self.tail = r.bytes("the bytes after the channels", found)?;
        } else {
            r.deviation(format_args!("{expected} bytes after {count} channels"), found)?;
            self.tail = r.opaque("the bytes after the channels", found)?;
        }
        Ok(())
    }
}

/// A record of a channel: u16 id, u16 length, data, u16 check value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChannelRecord<'a> {
    /// Word of the channel at which the record starts.
    pub word: usize,
    /// Record id: 4 general, 5 driver, 9 others.
    pub id: u16,
    /// Data between length and check value.
    pub data: &'a [u8],
    /// Stored check value.
    pub crc: u16,
    /// CRC-16/ARC over id, length and data.
    pub computed_crc: u16,
}

impl ChannelRecord<'_> {
    /// Whether the stored check value fits the data. Real files hold stale
    /// ones, so this is information, not an error.
    #[must_use]
    pub fn crc_ok(&self) -> bool {
        self.crc == self.computed_crc
    }

    /// Word `number` of the channel, if it lies in this record's data.
    fn word(&self, number: usize) -> Option<u16> {
        let at = number.checked_sub(self.word + 2)?.checked_mul(2)?;
        word_at(self.data, at)
    }
}

fn word_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_le_bytes(*bytes.get(at..)?.first_chunk::<2>()?))
}

/// CRC-16/ARC: polynomial 0x8005 reflected, start 0, no final inversion.
#[must_use]
pub fn crc16_arc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xA001 } else { crc >> 1 })
    })
}

/// Splits a channel into records; a place that holds none ends it with its byte offset.
#[derive(Debug, Clone)]
pub struct Records<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Iterator for Records<'a> {
    type Item = std::result::Result<ChannelRecord<'a>, usize>;

    fn next(&mut self) -> Option<Self::Item> {
        // A zero word in place of an id is filler.
        let mut start = self.at;
        let id = loop {
            match word_at(self.bytes, start) {
                Some(0) => start += 2,
                Some(id) => break id,
                None => return None,
            }
        };
        let record = (|| {
            let length = usize::from(word_at(self.bytes, start + 2)?);
            let data = self.bytes.get(start + 4..)?.get(..length)?;
            let covered = self.bytes.get(start..start + 4 + length)?;
            Some(ChannelRecord {
                word: start / 2,
                id,
                data,
                crc: word_at(self.bytes, start + 4 + length)?,
                computed_crc: crc16_arc(covered),
            })
        })();
        match record {
            Some(record) => {
                self.at = start + 6 + record.data.len();
                Some(Ok(record))
            }
            None => {
                self.at = self.bytes.len();
                Some(Err(start))
            }
        }
    }
}

/// Record id of the general settings.
const GENERAL: u16 = 4;
/// Record id of the driver settings.
const DRIVER: u16 = 5;
/// Data length of a serial driver record.
const SERIAL_BYTES: usize = 26;
/// Data length of an Ethernet driver record.
const ETHERNET_BYTES: usize = 106;

/// General settings of a channel (word numbers of the format page in brackets).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct General {
    /// Edit resource / owner timeout, seconds (word 3) (printed).
    pub owner_timeout: u16,
    /// Passthru link ID (word 4) (printed).
    pub passthru_link_id: u16,
    /// Service selections (word 5): bits 0 and 1 comms and message servicing (inferred), bit 8 unknown.
    pub services: u16,
    /// First AWA append character, low byte of (word 9) (printed).
    pub append_1: u8,
    /// Second AWA append character, high byte of (word 9) (printed).
    pub append_2: u8,
    /// Equal to a record beside a printout but for the fields above: settings without a known place
    /// have the values of [`crate::tables::GENERAL_AS_PRINTED`].
    pub as_printed: bool,
}

/// Serial driver settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Serial {
    /// Driver code (word 14); names in [`crate::tables::serial_driver`].
    pub driver: u16,
    /// Driver options (word 15) (inferred).
    pub options: u16,
    /// Source ID, node address (word 17) (printed).
    pub source_id: u16,
    /// NAK and ENQ retries (word 22), which is which is unknown (values printed).
    pub retries: [u8; 2],
    /// ACK timeout in units of 20 ms (word 23) (printed).
    pub ack_timeout: u16,
    /// Baud code, low byte of (word 25); rates in [`crate::tables::baud_rate`].
    pub baud: u8,
    /// Line options, high byte of (word 25) (inferred).
    pub line_options: u8,
    /// Equal to a record of the same driver beside a printout but for the fields above: settings
    /// without a known place have the values of [`crate::tables::serial_as_printed`].
    pub as_printed: bool,
}

/// Ethernet settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ethernet {
    /// Message connection timeout, ms (word 16) (printed).
    pub connection_timeout: u16,
    /// Message reply timeout, ms (word 17) (printed).
    pub reply_timeout: u16,
    /// Inactivity timeout, minutes (word 18) (printed).
    pub inactivity_timeout: u16,
    /// IP address (word 19, 20) (printed).
    pub address: Ipv4Addr,
    /// Subnet mask (word 21, 22) (printed).
    pub mask: Ipv4Addr,
    /// Gateway (word 23, 24) (printed).
    pub gateway: Ipv4Addr,
    /// Primary and secondary name server (word 27..30) (inferred).
    pub name_servers: [Ipv4Addr; 2],
    /// Protocol switches (word 63); see the methods.
    pub protocols: u16,
    /// Port speed mask (word 66) (inferred).
    pub port_speed: u16,
    /// Equal to a record beside a printout but for the fields above: settings without a known place
    /// have the values of [`crate::tables::ETHERNET_AS_PRINTED`].
    pub as_printed: bool,
}

impl Ethernet {
    /// BOOTP enabled (printed).
    #[must_use]
    pub fn bootp(&self) -> bool {
        self.protocols & 1 != 0
    }

    /// DHCP enabled (printed).
    #[must_use]
    pub fn dhcp(&self) -> bool {
        self.protocols & 2 != 0
    }

    /// HTTP server enabled (inferred: every printout says yes, and the bit is set beside all of them).
    #[must_use]
    pub fn http(&self) -> bool {
        self.protocols & 0x100 != 0
    }

    /// Modbus TCP enabled (inferred).
    #[must_use]
    pub fn modbus_tcp(&self) -> bool {
        self.protocols & 0x2000 != 0
    }
}

impl<'a> Channel<'a> {
    /// A channel of these words; an odd last byte is dropped.
    #[must_use]
    pub fn from_bytes(bytes: &'a [u8]) -> Self {
        let whole = bytes.len() & !1;
        Channel { bytes: bytes.get(..whole).unwrap_or_default() }
    }

    /// The stored words, two bytes each.
    #[must_use]
    pub fn as_bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// Its records, in stored order.
    #[must_use]
    pub fn records(&self) -> Records<'a> {
        Records { bytes: self.bytes, at: 0 }
    }

    fn record(&self, id: u16, length: Option<usize>) -> Option<ChannelRecord<'a>> {
        self.records()
            .filter_map(std::result::Result::ok)
            .find(|record| record.id == id && length.is_none_or(|n| n == record.data.len()))
    }

    /// General settings, if the channel begins with them.
    #[must_use]
    pub fn general(&self) -> Option<General> {
        let record = self.record(GENERAL, None).filter(|r| r.word == 0)?;
        let [append_1, append_2] = record.word(9)?.to_le_bytes();
        Some(General {
            owner_timeout: record.word(3)?,
            passthru_link_id: record.word(4)?,
            services: record.word(5)?,
            append_1,
            append_2,
            as_printed: words::as_printed(&record),
        })
    }

    /// Serial driver settings, if this is a serial channel.
    #[must_use]
    pub fn serial(&self) -> Option<Serial> {
        let record = self.record(DRIVER, Some(SERIAL_BYTES))?;
        // Word numbers count from a driver record at word 12, where it always stands.
        let word = |number: usize| record.word(number - 12 + record.word);
        let [baud, line_options] = word(25)?.to_le_bytes();
        Some(Serial {
            driver: word(14)?,
            options: word(15)?,
            source_id: word(17)?,
            retries: word(22)?.to_le_bytes(),
            ack_timeout: word(23)?,
            baud,
            line_options,
            as_printed: words::as_printed(&record),
        })
    }

    /// Ethernet settings, if this is an Ethernet channel.
    #[must_use]
    pub fn ethernet(&self) -> Option<Ethernet> {
        let record = self.record(DRIVER, Some(ETHERNET_BYTES))?;
        let word = |number: usize| record.word(number - 12 + record.word);
        let address = |number: usize| {
            let ([b, a], [d, c]) = (word(number)?.to_le_bytes(), word(number + 1)?.to_le_bytes());
            Some(Ipv4Addr::new(a, b, c, d))
        };
        Some(Ethernet {
            connection_timeout: word(16)?,
            reply_timeout: word(17)?,
            inactivity_timeout: word(18)?,
            address: address(19)?,
            mask: address(21)?,
            gateway: address(23)?,
            name_servers: [address(27)?, address(29)?],
            protocols: word(63)?,
            port_speed: word(66)?,
            as_printed: words::as_printed(&record),
        })
    }

    /// Words other than zero that no field of the three kinds of settings tells; the marks, lengths and
    /// check values of records are not counted.
    #[must_use]
    pub fn unexplained_words(&self) -> usize {
        self.records()
            .map(|record| match record {
                Ok(record) => words::unexplained(&record),
                Err(at) => self.bytes.get(at..).unwrap_or_default().chunks(2).filter(|word| **word != [0, 0]).count(),
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archive::{parse, serialize};
    use crate::error::Mode;

    #[test]
    fn crc_of_the_published_check_string() {
        // Check value of CRC-16/ARC in the catalogue of parametrised CRC algorithms.
        assert_eq!(crc16_arc(b"123456789"), 0xBB3D);
    }

    fn record(id: u16, data: &[u8]) -> Vec<u8> {
        let mut bytes = id.to_le_bytes().to_vec();
        bytes.extend((data.len() as u16).to_le_bytes());
        bytes.extend(data);
        bytes.extend(crc16_arc(&bytes).to_le_bytes());
        bytes
    }

    fn words(count: usize, set: &[(usize, u16)]) -> Vec<u8> {
        let mut data = vec![0; 2 * count];
        for (at, value) in set {
            data[2 * at..2 * at + 2].copy_from_slice(&value.to_le_bytes());
        }
        data
    }

    /// A serial and an Ethernet channel; word numbers here count from the record's data.
    fn sample() -> Vec<u8> {
        let general = record(4, &words(9, &[(1, 60), (2, 1), (3, 3), (7, 0x0A0D)]));
        let serial = record(5, &words(13, &[(0, 8), (1, 0x48), (3, 5), (8, 0x0303), (9, 50), (11, 0x1C04)]));
        let ethernet = record(
            5,
            &words(
                53,
                &[
                    (2, 15000),
                    (3, 3000),
                    (4, 30),
                    (5, 0x0A14),
                    (6, 0x1E28),
                    (7, 0xFFFF),
                    (8, 0xFF00),
                    (49, 0x0101),
                    (52, 15),
                ],
            ),
        );
        let mut bytes = b"\xFF\xFF\x80\0\x0E\0CChannelConfig\x3D\0\x02".to_vec();
        for driver in [serial, ethernet] {
            // Two filler words after the records.
            let channel: Vec<u8> = [&general[..], &driver, &[0; 4]].concat();
            bytes.extend((channel.len() as u16 / 2).to_le_bytes());
            bytes.extend(channel);
        }
        bytes
    }

    #[test]
    fn settings_of_both_kinds() {
        let bytes = sample();
        let parsed = parse::<ChannelConfiguration>(&bytes, "S", Mode::Strict);
        assert_eq!((parsed.error, parsed.understood), (None, bytes.len()));
        let record = parsed.value;
        let [serial, ethernet] = &record.channels[..] else { panic!("two channels") };
        let general = serial.general().expect("general record");
        assert_eq!((general.owner_timeout, general.passthru_link_id), (60, 1));
        assert_eq!((general.append_1, general.append_2), (b'\r', b'\n'));
        let settings = serial.serial().expect("serial record");
        assert!(general.as_printed && settings.as_printed);
        assert_eq!((settings.driver, settings.source_id), (8, 5));
        assert_eq!((settings.baud, settings.ack_timeout), (4, 50));
        assert_eq!(serial.ethernet(), None);
        let settings = ethernet.ethernet().expect("Ethernet record");
        assert_eq!(settings.address, Ipv4Addr::new(10, 20, 30, 40));
        assert_eq!(settings.mask, Ipv4Addr::new(255, 255, 255, 0));
        assert_eq!(settings.inactivity_timeout, 30);
        assert!(settings.bootp() && settings.http() && !settings.dhcp());
        // Word 15 is zero here.
        assert!(!settings.as_printed);
        assert_eq!((serial.unexplained_words(), ethernet.unexplained_words()), (0, 1));
        assert!(ethernet.records().all(|r| r.is_ok_and(|r| r.crc_ok())));
        assert_eq!(serialize(&record), Ok(bytes));
    }

    #[test]
    fn an_unknown_bit_is_not_as_printed() {
        let mut bytes = sample();
        // High byte of the line options: envelope 20, model and counts 5, general record 24, id and length 4.
        bytes[20 + 5 + 24 + 4 + 2 * 11 + 1] ^= 0x40;
        let parsed = parse::<ChannelConfiguration>(&bytes, "S", Mode::Permissive);
        let serial = parsed.value.channels[0];
        assert!(serial.serial().is_some_and(|s| !s.as_printed && s.baud == 4));
        assert!(serial.general().is_some_and(|g| g.as_printed));
        // The driver options in word 15 and the line options in word 25.
        assert_eq!(serial.unexplained_words(), 2);
    }

    #[test]
    fn a_stale_check_value_is_reported_by_the_record_only() {
        let mut bytes = sample();
        // Owner timeout of channel 0: envelope 20, model and counts 5, id, length, one word.
        bytes[20 + 5 + 4 + 2] = 61;
        let parsed = parse::<ChannelConfiguration>(&bytes, "S", Mode::Strict);
        assert_eq!(parsed.error, None);
        let channel = parsed.value.channels[0];
        assert_eq!(channel.general().map(|g| g.owner_timeout), Some(61));
        let ok: Vec<bool> = channel.records().filter_map(std::result::Result::ok).map(|r| r.crc_ok()).collect();
        assert_eq!(ok, [false, true]);
    }

    #[test]
    fn a_record_beyond_its_channel_is_a_deviation() {
        let mut bytes = sample();
        bytes[20 + 5 + 2] = 0xF0;
        let parsed = parse::<ChannelConfiguration>(&bytes, "S", Mode::Permissive);
        assert_eq!((parsed.error, parsed.deviations.len()), (None, 1));
        assert_eq!(serialize(&parsed.value), Ok(bytes));
    }

    #[test]
    fn a_body_of_another_shape_is_carried() {
        let bytes = b"\xFF\xFF\x80\0\x0E\0CChannelConfig\x31\0\x02\xFF\xFFshort".to_vec();
        let parsed = parse::<ChannelConfiguration>(&bytes, "S", Mode::Permissive);
        assert_eq!((parsed.error, parsed.deviations.len()), (None, 1));
        assert_eq!(parsed.understood, bytes.len() - 8);
        assert_eq!(parsed.value.other_shape, Some(&b"\x02\xFF\xFFshort"[..]));
        assert_eq!(serialize(&parsed.value), Ok(bytes.clone()));
        assert!(parse::<ChannelConfiguration>(&bytes, "S", Mode::Strict).error.is_some());
    }

    #[test]
    fn models_without_channels() {
        let mut bytes = b"\xFF\xFF\x80\0\x0E\0CChannelConfig\x08\0\0".to_vec();
        bytes.extend([0; 11]);
        let parsed = parse::<ChannelConfiguration>(&bytes, "S", Mode::Strict);
        assert_eq!((parsed.error, parsed.understood), (None, bytes.len()));
        assert_eq!(parsed.value.tail.len(), 11);
        assert_eq!(serialize(&parsed.value), Ok(bytes));
    }
}
