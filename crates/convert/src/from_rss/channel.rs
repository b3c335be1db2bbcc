//! Channels: records to settings, named and ordered as RSLogix prints them.

use ladder::{Channel, Confidence, DataFile, FileType, Setting};
use rss::channel::{ChannelConfiguration, Ethernet, General, Serial};
use rss::tables;

use super::configuration::confidence;

/// The driver of an Ethernet channel.
const ETHERNET: &str = "Ethernet";
/// The setting that the hardware address is printed before.
const IP_ADDRESS: &str = "IP Address";

/// All channels. What only the data tables know is added by [`hardware_address`].
pub(super) fn channels(record: &ChannelConfiguration<'_>) -> Vec<Channel> {
    let witnessed = witnessed(record.model.0);
    let channels = record.channels.iter().zip(0u16..);
    channels.map(|(channel, number)| describe(channel, number, witnessed)).collect()
}

/// How sure settings are that are known by likeness to a printed record: only reports of the
/// MicroLogix 1100 have channel pages, other models use the same records.
fn witnessed(model: u16) -> Confidence {
    if matches!(model, 60 | 61) { Confidence::Proven } else { Confidence::Inferred }
}

fn describe(channel: &rss::channel::Channel<'_>, number: u16, witnessed: Confidence) -> Channel {
    let mut settings = Settings { list: Vec::new(), witnessed };
    let (serial, ethernet) = (channel.serial(), channel.ethernet());
    if let Some(general) = channel.general() {
        settings.general(&general, serial.is_some());
    }
    let driver = match (&serial, &ethernet) {
        (Some(serial), _) => settings.serial(serial),
        (None, Some(ethernet)) => settings.ethernet(ethernet),
        (None, None) => "not configured, or a driver not known".to_owned(),
    };
    Channel { number, driver, settings: settings.list, unexplained_words: channel.unexplained_words() }
}

struct Settings {
    list: Vec<Setting>,
    /// How sure settings by likeness are.
    witnessed: Confidence,
}

impl Settings {
    fn add(&mut self, name: &str, value: impl ToString, confidence: Confidence) {
        self.list.push(Setting { name: name.to_owned(), value: value.to_string(), confidence });
    }

    /// A setting of the table of printed values, if the record is like the printed ones.
    fn likened(&mut self, like: bool, table: &[(&str, &str)], name: &str) {
        if let Some((_, value)) = table.iter().find(|(other, _)| like && *other == name) {
            self.add(name, value, self.witnessed);
        }
    }

    fn general(&mut self, general: &General, serial: bool) {
        use Confidence::{Inferred, Proven};
        self.add("Edit Resource/Owner Timeout", general.owner_timeout, Proven);
        self.add("Passthru Link ID", general.passthru_link_id, Proven);
        self.likened(general.as_printed, tables::GENERAL_AS_PRINTED, "Write Protected");
        // Both were printed with Yes only: which bit is which is not known while they differ.
        let sure = if general.as_printed { self.witnessed } else { Inferred };
        self.add("Comms Servicing Selection", yes(general.services & 1 != 0), sure);
        self.add("Message Servicing Selection", yes(general.services & 2 != 0), sure);
        if serial {
            for (name, byte) in
                [("1st AWA Append Character", general.append_1), ("2nd AWA Append Character", general.append_2)]
            {
                let (text, sure) = append_character(byte);
                self.add(name, text, sure);
            }
        }
    }

    fn serial(&mut self, serial: &Serial) -> String {
        use Confidence::{Inferred, Proven, Unknown};
        let name = tables::serial_driver(serial.driver);
        let table = tables::serial_as_printed(serial.driver);
        let df1 = serial.driver == DF1_FULL_DUPLEX;
        if df1 {
            self.add("Source ID", format!("{} (decimal)", serial.source_id), Proven);
        }
        match tables::baud_rate(serial.baud) {
            Some((rate, evidence)) => self.add("Baud", rate, confidence(evidence)),
            None => self.add("Baud", format!("unknown (code {})", serial.baud), Unknown),
        }
        for (name, _) in table {
            self.likened(serial.as_printed, table, name);
        }
        if df1 {
            self.add("ACK Timeout(x20 ms)", serial.ack_timeout, Proven);
            match serial.retries {
                [nak, enq] if nak == enq => {
                    self.add("NAK Retries", nak, Proven);
                    self.add("ENQ Retries", enq, Proven);
                }
                [low, high] => self.add("NAK and ENQ Retries", format!("{low} and {high}, in unknown order"), Inferred),
            }
        }
        name.map_or_else(|| format!("serial, unknown driver (code {})", serial.driver), |(name, _)| name.to_owned())
    }

    fn ethernet(&mut self, ethernet: &Ethernet) -> String {
        use Confidence::{Inferred, Proven};
        let like = ethernet.as_printed;
        self.add(IP_ADDRESS, ethernet.address, Proven);
        self.add("Subnet Mask", ethernet.mask, Proven);
        self.add("Gateway Address", ethernet.gateway, Proven);
        for (name, server) in ["Primary Name Server", "Secondary Name Server"].iter().zip(ethernet.name_servers) {
            self.add(name, server, Inferred);
        }
        self.add("Msg Connection Timeout (x 1mS)", ethernet.connection_timeout, Proven);
        self.add("Msg Reply Timeout (x mS)", ethernet.reply_timeout, Proven);
        self.add("Inactivity Timeout (x Min)", ethernet.inactivity_timeout, Proven);
        self.add("Bootp Enable", yes(ethernet.bootp()), Proven);
        self.add("Dhcp Enable", yes(ethernet.dhcp()), Proven);
        self.likened(like, tables::ETHERNET_AS_PRINTED, "SNMP Enable");
        if like {
            self.likened(like, tables::ETHERNET_AS_PRINTED, "HTTP Enable");
        } else {
            self.add("HTTP Enable", yes(ethernet.http()), Inferred);
        }
        if ethernet.modbus_tcp() {
            self.add("Modbus TCP Enable", yes(true), Inferred);
        }
        self.likened(like, tables::ETHERNET_AS_PRINTED, "Auto Negotiate Enable");
        self.likened(like, tables::ETHERNET_AS_PRINTED, "Port Speed Enable");
        ETHERNET.to_owned()
    }
}

/// Driver code of DF1 full duplex, the only driver whose station settings have been printed.
const DF1_FULL_DUPLEX: u16 = 8;

fn yes(on: bool) -> &'static str {
    if on { "Yes" } else { "No" }
}

/// Carriage return and line feed were printed, by their hexadecimal digit.
fn append_character(byte: u8) -> (String, Confidence) {
    match byte {
        b'\r' => ("\\d".to_owned(), Confidence::Proven),
        b'\n' => ("\\a".to_owned(), Confidence::Proven),
        other => (format!("0x{other:02X}"), Confidence::Inferred),
    }
}

/// Words of the Ethernet status file that hold the hardware address, high byte first.
const HARDWARE_ADDRESS: std::ops::Range<usize> = 6..9;

/// Puts the hardware address, which only the Ethernet status file has, at the head of the settings of
/// an Ethernet channel.
pub(super) fn hardware_address(channels: &mut [Channel], function_files: &[DataFile], model: u16) {
    let status = function_files.iter().find(|file| file.file_type == FileType::ES);
    let Some(words) = status.and_then(|file| file.words.get(HARDWARE_ADDRESS)) else { return };
    let bytes = words.iter().flat_map(|word| word.to_be_bytes());
    let value = bytes.map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(":");
    for channel in channels.iter_mut().filter(|channel| channel.driver == ETHERNET) {
        let first = channel.settings.iter().position(|setting| setting.name == IP_ADDRESS).unwrap_or(0);
        let name = "Hardware Address".to_owned();
        channel.settings.insert(first, Setting { name, value: value.clone(), confidence: witnessed(model) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn append_characters_are_spelt_as_printed() {
        assert_eq!(append_character(0x0D).0, r"\d");
        assert_eq!(append_character(0x0A).0, r"\a");
        assert_eq!(append_character(0x41), ("0x41".to_owned(), Confidence::Inferred));
    }

    #[test]
    fn the_hardware_address_is_in_the_ethernet_status_file() {
        let mut status = DataFile::new(FileType::ES, 0, 178);
        status.words.resize(178, 0);
        status.words[6..9].copy_from_slice(&[0x000F, 0x7312, 0xA034]);
        let setting = |name: &str| Setting { name: name.into(), value: "x".into(), confidence: Confidence::Proven };
        let channel = |driver: &str| Channel {
            number: 1,
            driver: driver.into(),
            settings: vec![setting("Passthru Link ID"), setting(IP_ADDRESS)],
            unexplained_words: 0,
        };
        let mut channels = [channel("DF1 Full Duplex"), channel(ETHERNET)];
        hardware_address(&mut channels, &[status], 61);
        assert_eq!(channels[0].settings.len(), 2);
        assert_eq!(channels[1].settings[1].value, "00:0F:73:12:A0:34");
        assert_eq!(channels[1].settings[2].name, IP_ADDRESS);
    }
}
