//! MSG set-up records as named settings, and back.
//!
//! Settings whose meaning is unknown are named by their place in the record, so that nothing is lost
//! between a project file, the model and JSON.

use ladder::MessageSetup;
use rss::program::{self, CipTail, PathHop};
use rss::{Error, Result, Text};

const PATH_DECIMAL: [&str; 3] = ["Class (dec)", "Instance (dec)", "Attribute (dec)"];
const PATH_HEX: [&str; 3] = ["Class (hex)", "Instance (hex)", "Attribute (hex)"];
const HOP: [&str; 3] = ["Hop Address", "Hop h0", "Hop h1"];
const SERVICE: &str = "Service Code (hex)";

/// The settings of a record, screen settings first.
pub(crate) fn settings(setup: &program::MessageSetup<'_>) -> MessageSetup {
    let mut settings = Vec::new();
    let mut add = |name: &'static str, value: String| settings.push((name.into(), value));
    let text = |text: &Text<'_>| text.decode().into_owned();
    add("Communication Command", text(&setup.command));
    add("Channel", setup.channel.to_string());
    add("Message Timeout", text(&setup.timeout));
    add("Size in Elements", text(&setup.size));
    add("Target Data Table Address", text(&setup.target));
    add("Data Table Address", text(&setup.local));
    add("Node", text(&setup.node));
    add("Target Address", text(&setup.host));
    add("Routing Information", text(&setup.routing));
    for hop in &setup.hops {
        let values = [text(&hop.address), hop.h0.to_string(), hop.h1.map(|n| n.to_string()).join(" ")];
        HOP.into_iter().zip(values).for_each(|(name, value)| add(name, value));
    }
    if let Some(cip) = &setup.cip {
        add(SERVICE, text(&cip.service));
        for (names, values) in [(PATH_DECIMAL, &cip.path_decimal), (PATH_HEX, &cip.path_hex)] {
            names.into_iter().zip(values).for_each(|(name, value)| add(name, text(value)));
        }
        add("Size in Bytes", text(&cip.length));
        add("Data Table Address (send)", text(&cip.data));
        add("g0", cip.g0.to_string());
        add("Cached Data", hex(&cip.blob));
    }
    add("m0", setup.m0.to_string());
    add("m1", setup.m1.to_string());
    add("Status", setup.status.to_string());
    add("m2", setup.m2.to_string());
    add("m3", hex(&setup.m3));
    add("m4", hex(&setup.m4));
    add("m5", text(&setup.m5));
    add("m6", text(&setup.m6));
    add("m7", text(&setup.m7));
    add("m8", text(&setup.m8));
    add("m9", text(&setup.m9));
    add("m10", setup.m10.to_string());
    MessageSetup { settings }
}

/// The record of settings that came from one.
///
/// # Errors
/// A setting the record has and the settings lack, or one that does not fit its field.
pub(crate) fn record(setup: &MessageSetup) -> Result<program::MessageSetup<'_>> {
    let settings = Settings(setup);
    let hops = setup.settings.iter().filter(|(name, _)| name == HOP[0]).count();
    Ok(program::MessageSetup {
        m0: settings.number("m0")?,
        m1: settings.number("m1")?,
        status: settings.number("Status")?,
        m2: settings.number("m2")?,
        command: settings.text("Communication Command")?,
        channel: settings.number("Channel")?,
        timeout: settings.text("Message Timeout")?,
        size: settings.text("Size in Elements")?,
        m3: settings.array("m3")?,
        target: settings.text("Target Data Table Address")?,
        local: settings.text("Data Table Address")?,
        m4: settings.array("m4")?,
        m5: settings.text("m5")?,
        node: settings.text("Node")?,
        m6: settings.text("m6")?,
        host: settings.text("Target Address")?,
        m7: settings.text("m7")?,
        m8: settings.text("m8")?,
        m9: settings.text("m9")?,
        m10: settings.number("m10")?,
        hops: (0..hops).map(|hop| settings.hop(hop)).collect::<Result<_>>()?,
        routing: settings.text("Routing Information")?,
        cip: if settings.nth(SERVICE, 0).is_ok() { Some(settings.cip()?) } else { None },
    })
}

struct Settings<'s>(&'s MessageSetup);

impl<'s> Settings<'s> {
    fn nth(&self, wanted: &str, index: usize) -> Result<&'s str> {
        let mut found = self.0.settings.iter().filter(|(name, _)| name == wanted);
        let value = found.nth(index).map(|(_, value)| value.as_str());
        value.ok_or_else(|| Error::Unwritable(format!("MSG set-up: setting {wanted} is missing")))
    }

    fn text(&self, name: &str) -> Result<Text<'s>> {
        super::to_rss::text(self.nth(name, 0)?)
    }

    fn number<N: std::str::FromStr>(&self, name: &str) -> Result<N> {
        parse(name, self.nth(name, 0)?)
    }

    fn bytes(&self, name: &str) -> Result<Vec<u8>> {
        let text = self.nth(name, 0)?;
        let byte = |digits: &str| u8::from_str_radix(digits, 16).map_err(|_| unfit(name, text));
        text.split_whitespace().map(byte).collect()
    }

    fn array<const N: usize>(&self, name: &str) -> Result<[u8; N]> {
        let bytes = self.bytes(name)?;
        bytes.as_slice().try_into().map_err(|_| unfit(name, &hex(&bytes)))
    }

    fn hop(&self, index: usize) -> Result<PathHop<'s>> {
        let [address, h0, h1] = HOP;
        let text = self.nth(h1, index)?;
        let numbers: Vec<u32> = text.split(' ').map(|number| parse(h1, number)).collect::<Result<_>>()?;
        Ok(PathHop {
            h0: parse(h0, self.nth(h0, index)?)?,
            address: super::to_rss::text(self.nth(address, index)?)?,
            h1: numbers.as_slice().try_into().map_err(|_| unfit(h1, text))?,
        })
    }

    fn cip(&self) -> Result<CipTail<'s>> {
        let path = |[class, instance, attribute]: [&str; 3]| {
            Ok::<_, Error>([self.text(class)?, self.text(instance)?, self.text(attribute)?])
        };
        Ok(CipTail {
            g0: self.number("g0")?,
            service: self.text(SERVICE)?,
            path_decimal: path(PATH_DECIMAL)?,
            path_hex: path(PATH_HEX)?,
            length: self.text("Size in Bytes")?,
            data: self.text("Data Table Address (send)")?,
            blob: self.bytes("Cached Data")?.into(),
        })
    }
}

fn parse<N: std::str::FromStr>(name: &str, text: &str) -> Result<N> {
    text.parse().map_err(|_| unfit(name, text))
}

fn unfit(name: &str, text: &str) -> Error {
    Error::Unwritable(format!("MSG set-up: `{text}` does not fit setting {name}"))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ")
}
