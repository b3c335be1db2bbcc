//! "Channel Configuration": one block of settings per communication channel.

use super::Page;

/// A communication channel as printed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// Channel number.
    pub number: u16,
    /// What stands in brackets after it: `SYSTEM`.
    pub mode: String,
    /// The driver, for example `DF1 Full Duplex` or `Ethernet`.
    pub driver: String,
    /// The settings in printed order.
    pub settings: Vec<Setting>,
}

/// A line of a channel: `IP Address: 192.168.0.10`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    /// The label as printed, without the repeated channel and driver before it.
    pub label: String,
    /// The value as printed; empty where nothing follows.
    pub value: String,
}

impl Channel {
    /// The value of the first setting with this label.
    #[must_use]
    pub fn setting(&self, label: &str) -> Option<&str> {
        self.settings.iter().find(|s| s.label == label).map(|s| s.value.as_str())
    }
}

pub(super) fn read(channels: &mut Vec<Channel>, page: &Page) -> Vec<String> {
    let mut lost = Vec::new();
    for line in page.lines.iter().map(|l| l.trim()).filter(|l| !l.is_empty()) {
        if channels.last_mut().is_some_and(|c| take_setting(c, line)) {
            continue;
        }
        match heading(line) {
            Some(channel) => channels.push(channel),
            None => lost.push(line.to_owned()),
        }
    }
    lost
}

/// `CHANNEL 0 (SYSTEM) - Driver: DF1 Full Duplex`
fn heading(line: &str) -> Option<Channel> {
    let (number, rest) = line.strip_prefix("CHANNEL ")?.split_once(" (")?;
    let (mode, driver) = rest.split_once(") - Driver: ")?;
    Some(Channel {
        number: number.parse().ok()?,
        mode: mode.to_owned(),
        driver: driver.to_owned(),
        settings: Vec::new(),
    })
}

fn take_setting(channel: &mut Channel, line: &str) -> bool {
    let repeated = format!("CHANNEL {} ({}) - Driver: {}", channel.number, channel.mode, channel.driver);
    let line = match line.strip_prefix(&repeated) {
        Some(rest) => rest.trim(),
        None if line.starts_with("CHANNEL ") => return false,
        None => line,
    };
    // RSLogix leaves the colon out in this one label.
    let bare = line.strip_prefix("Dhcp Enable ").map(|v| ("Dhcp Enable", v));
    let Some((label, value)) = line.split_once(':').or(bare) else {
        return false;
    };
    channel.settings.push(Setting { label: label.trim().to_owned(), value: value.trim().to_owned() });
    true
}
