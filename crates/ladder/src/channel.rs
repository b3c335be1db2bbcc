//! Communication channels as their settings read on paper.

use crate::Confidence;

/// One channel of the processor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Channel number.
    pub number: u16,
    /// `DF1 full duplex`, `Ethernet`, ... or what is known of an unknown driver.
    pub driver: String,
    /// Settings in the order RSLogix prints them.
    pub settings: Vec<Setting>,
    /// 16-bit words of the channel's configuration that no setting explains.
    pub unexplained_words: usize,
}

/// A named setting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Name as printed where known: `IP Address`.
    pub name: String,
    /// Value as printed.
    pub value: String,
    /// How sure name and value are.
    pub confidence: Confidence,
}
