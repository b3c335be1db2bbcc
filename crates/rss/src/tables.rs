//! Code tables: what the numbers of the project streams stand for, each with
//! the strength of its evidence. A code that is not listed has no name here.
//!
//! Nothing in the byte layer depends on these tables; they exist so that
//! every reader of the records names a code the same way, or says that it is
//! unknown.

use std::fmt;

/// How well a statement about the format is supported, strongest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Evidence {
    /// RSLogix 500 itself printed the statement next to the stored value.
    Printed,
    /// Holds in every known project and has an independent cross-check.
    Proven,
    /// Consistent everywhere, but indirect: by elimination, order or usage.
    Inferred,
    /// A plausible reading with little support.
    Weak,
    /// Stated by a public vendor document; not seen in a project file.
    Published,
}

impl Evidence {
    /// The level as one lower-case word.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Printed => "printed",
            Self::Proven => "proven",
            Self::Inferred => "inferred",
            Self::Weak => "weak",
            Self::Published => "published",
        }
    }
}

impl fmt::Display for Evidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Which layout the `IO CONFIGURATION` body has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum IoForm {
    /// Packed module records with CIP identities (MicroLogix 1100 and up).
    Packed,
    /// Fixed table of 31 slots (SLC 500, MicroLogix 1000).
    Slots,
}

/// One processor model code of the `PROCESSOR` record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProcessorModel {
    /// Code as stored.
    pub code: u16,
    /// Bulletin number in RSLogix's own spelling, e.g. `Bul.1763`.
    pub catalog: &'static str,
    /// Name, as RSLogix prints it where that was seen.
    pub name: &'static str,
    /// Family key, e.g. `micrologix-1100`.
    pub family: &'static str,
    /// Evidence for the family.
    pub family_evidence: Evidence,
    /// Evidence for the exact name (series, variant).
    pub name_evidence: Evidence,
    /// What the identification rests on, one sentence.
    pub basis: &'static str,
    /// Form of its I/O configuration.
    pub io_form: IoForm,
    /// Instruction words of program memory (used + left).
    pub instruction_words: u32,
    /// Data words of data memory; `None` where no project states it.
    pub data_words: Option<u32>,
    /// Words of status file S:2.
    pub status_words: u16,
}

/// All known processor model codes, ascending.
pub const PROCESSOR_MODELS: &[ProcessorModel] = &[
    ProcessorModel {
        code: 8,
        catalog: "1747-L40",
        name: "SLC 500 fixed, 40 I/O",
        family: "slc-500-fixed",
        family_evidence: Evidence::Proven,
        name_evidence: Evidence::Inferred,
        basis: "24 inputs and 16 outputs in slot 0, 16 status words, 1 K instruction words; the letter after L40 is unknown",
        io_form: IoForm::Slots,
        instruction_words: 1024,
        data_words: None,
        status_words: 16,
    },
    ProcessorModel {
        code: 28,
        catalog: "Bul.1761",
        name: "MicroLogix 1000",
        family: "micrologix-1000",
        family_evidence: Evidence::Proven,
        name_evidence: Evidence::Inferred,
        basis: "20 inputs and 12 outputs in slot 0, 33 status words, 941 instruction words; never printed",
        io_form: IoForm::Slots,
        instruction_words: 941,
        data_words: None,
        status_words: 33,
    },
    ProcessorModel {
        code: 36,
        catalog: "Bul.1761",
        name: "MicroLogix 1000 DH-485",
        family: "micrologix-1000",
        family_evidence: Evidence::Proven,
        name_evidence: Evidence::Inferred,
        basis: "same I/O and memory as code 28; holds a DH-485 node and rate in S:16 after running",
        io_form: IoForm::Slots,
        instruction_words: 941,
        data_words: None,
        status_words: 33,
    },
    ProcessorModel {
        code: 57,
        catalog: "Bul.1762",
        name: "MicroLogix 1200 Series C",
        family: "micrologix-1200",
        family_evidence: Evidence::Proven,
        name_evidence: Evidence::Inferred,
        basis: "S:57 holds 1200 or 1210 wherever it ran; series from S:58 = 2",
        io_form: IoForm::Packed,
        instruction_words: 5696,
        data_words: Some(2048),
        status_words: 66,
    },
    ProcessorModel {
        code: 60,
        catalog: "Bul.1763",
        name: "MicroLogix 1100 Series A",
        family: "micrologix-1100",
        family_evidence: Evidence::Printed,
        name_evidence: Evidence::Printed,
        basis: "printed by RSLogix",
        io_form: IoForm::Packed,
        instruction_words: 6656,
        data_words: Some(4096),
        status_words: 66,
    },
    ProcessorModel {
        code: 61,
        catalog: "Bul.1763",
        name: "MicroLogix 1100 Series B",
        family: "micrologix-1100",
        family_evidence: Evidence::Printed,
        name_evidence: Evidence::Printed,
        basis: "printed by RSLogix",
        io_form: IoForm::Packed,
        instruction_words: 6656,
        data_words: Some(4096),
        status_words: 66,
    },
    ProcessorModel {
        code: 62,
        catalog: "Bul.1766",
        name: "MicroLogix 1400 Series A",
        family: "micrologix-1400",
        family_evidence: Evidence::Proven,
        name_evidence: Evidence::Inferred,
        basis: "S:57 holds 1400; series by contrast with code 63, which is printed",
        io_form: IoForm::Packed,
        instruction_words: 12434,
        data_words: Some(10240),
        status_words: 66,
    },
    ProcessorModel {
        code: 63,
        catalog: "Bul.1766",
        name: "MicroLogix 1400 Series B",
        family: "micrologix-1400",
        family_evidence: Evidence::Printed,
        name_evidence: Evidence::Printed,
        basis: "printed by RSLogix",
        io_form: IoForm::Packed,
        instruction_words: 12434,
        data_words: Some(10240),
        status_words: 66,
    },
];

/// The processor model with this code, if it is known.
pub fn processor_model(code: u16) -> Option<&'static ProcessorModel> {
    PROCESSOR_MODELS.iter().find(|model| model.code == code)
}

/// Name of a processor type byte that a connected controller answers with
/// (field `reported` of the `PROCESSOR` record), where it differs from a
/// model code. Evidence: inferred.
pub fn reported_type(code: u16) -> Option<&'static str> {
    match code {
        0x9C => Some("MicroLogix 1100"),
        0x9F => Some("MicroLogix 1400"),
        _ => processor_model(code).map(|model| model.name),
    }
}

/// CIP identity of an expansion module of the packed I/O form.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct ModuleIdentity {
    /// CIP vendor number; 1 is Allen-Bradley.
    pub vendor: u16,
    /// CIP device type: 7 discrete, 10 analog.
    pub device_type: u16,
    /// Product code within vendor and device type.
    pub code: u16,
}

/// A module with a known (or suspected) catalogue number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModuleName {
    /// Catalogue number, or a description in words where none is known.
    pub catalog: &'static str,
    /// Description as printed or published.
    pub description: &'static str,
    /// Strength of the identification.
    pub evidence: Evidence,
    /// What the identification rests on.
    pub basis: &'static str,
}

const fn module(
    vendor: u16,
    device_type: u16,
    code: u16,
    catalog: &'static str,
    description: &'static str,
    evidence: Evidence,
    basis: &'static str,
) -> (ModuleIdentity, ModuleName) {
    (ModuleIdentity { vendor, device_type, code }, ModuleName { catalog, description, evidence, basis })
}

/// Expansion modules of the packed I/O form.
pub const EXPANSION_MODULES: &[(ModuleIdentity, ModuleName)] = &[
    module(1, 7, 96, "1762-IQ8", "8-Input 10/30 VDC", Evidence::Printed, "named in reports of the same project"),
    module(
        1,
        7,
        97,
        "1762-IQ16",
        "16-Input 10/30 VDC",
        Evidence::Inferred,
        "the only 16-point discrete input module beside IQ8",
    ),
    module(
        1,
        7,
        98,
        "1762-IQ8OW6",
        "8-Input 24 VDC, 6-Output Relay",
        Evidence::Inferred,
        "the only module with 8 inputs and 6 outputs",
    ),
    module(
        1,
        7,
        103,
        "1762-OB16",
        "16-Output (TRANS-SRC) 10/50 VDC",
        Evidence::Inferred,
        "16 discrete outputs; 121 is the relay module of that size",
    ),
    module(
        1,
        7,
        114,
        "1762-IA8",
        "8-Input 120 VAC",
        Evidence::Inferred,
        "a second 8-input module, only beside a base unit with AC inputs",
    ),
    module(
        1,
        7,
        119,
        "1762-OA8",
        "8-Output",
        Evidence::Weak,
        "8 discrete outputs that are not the relay module; OB8 is possible",
    ),
    module(1, 7, 120, "1762-OW8", "8-Output Relay", Evidence::Printed, "named in reports of the same project"),
    module(1, 7, 121, "1762-OW16", "16-Output Relay", Evidence::Inferred, "code after OW8, 16 outputs"),
    module(
        1,
        7,
        124,
        "1762-OX6I",
        "6-Output Isolated Relay",
        Evidence::Inferred,
        "the only module with 6 outputs and no input",
    ),
    module(
        1,
        10,
        64,
        "1762-IT4",
        "4-Channel Thermocouple/mV Input",
        Evidence::Inferred,
        "rung comments name the card and its thermocouple type, which the configuration word repeats",
    ),
    module(
        1,
        10,
        66,
        "1762-OF4",
        "4-Channel Analog Output",
        Evidence::Inferred,
        "the only analog module with 4 output words",
    ),
    module(
        1,
        10,
        67,
        "1762-IF4",
        "4-Channel Analog Input",
        Evidence::Inferred,
        "rung comments name the card and its 4-20 mA range, which the configuration words repeat",
    ),
    module(
        1,
        10,
        75,
        "1762-IF2OF2",
        "2-Channel Analog Input, 2-Channel Analog Output",
        Evidence::Inferred,
        "the only analog module with 2 output words",
    ),
    module(
        58,
        10,
        20,
        "third-party analog module",
        "8-word analog module of vendor 58 (Spectrum Controls)",
        Evidence::Weak,
        "vendor number only",
    ),
];

/// The expansion module with this CIP identity, if it is known.
pub fn expansion_module(identity: ModuleIdentity) -> Option<&'static ModuleName> {
    EXPANSION_MODULES.iter().find(|(known, _)| *known == identity).map(|(_, name)| name)
}

const fn slc(
    id: u16,
    catalog: &'static str,
    description: &'static str,
    evidence: Evidence,
    basis: &'static str,
) -> (u16, ModuleName) {
    (id, ModuleName { catalog, description, evidence, basis })
}

/// Modules of the SLC slot form by ID code (100 × class + number).
///
/// The published rows are only those for which a vendor manual was at hand.
pub const SLC_MODULES: &[(u16, ModuleName)] = &[
    slc(
        500,
        "1746-IA16",
        "16-Input 100/120 VAC",
        Evidence::Inferred,
        "class of 16 inputs, number 0; catalogue number from general knowledge of the ID list",
    ),
    slc(
        599,
        "16-input module",
        "16 inputs, entered by class without a type",
        Evidence::Inferred,
        "class of 16 inputs; number 99 stands for any module of the class",
    ),
    slc(
        2100,
        "on-board I/O",
        "24 inputs, 16 outputs (SLC 500 fixed)",
        Evidence::Proven,
        "slot 0 of every project of model 8",
    ),
    slc(
        2900,
        "1746-OW16",
        "16-Output Relay",
        Evidence::Inferred,
        "class of 16 outputs, number 0; catalogue number from general knowledge of the ID list",
    ),
    slc(
        3199,
        "on-board I/O",
        "20 inputs, 12 outputs (MicroLogix 1000)",
        Evidence::Proven,
        "slot 0 of every project of models 28 and 36",
    ),
    slc(3504, "1746-NI16I", "16-Channel Analog Current Input, class 1", Evidence::Published, "publication 1746-UM001A"),
    slc(3505, "1746-NI16V", "16-Channel Analog Voltage Input, class 1", Evidence::Published, "publication 1746-UM001A"),
    slc(3527, "1746-NO8I", "8-Channel Analog Current Output, class 1", Evidence::Published, "publication 1746-UM026A"),
    slc(3528, "1746-NO8V", "8-Channel Analog Voltage Output, class 1", Evidence::Published, "publication 1746-UM026A"),
    slc(3533, "1746-NT8", "8-Channel Thermocouple/mV Input", Evidence::Published, "publication 1746-UM022B"),
    slc(
        10403,
        "1746-NI16I",
        "16-Channel Analog Current Input, class 3",
        Evidence::Published,
        "publication 1746-UM001A",
    ),
    slc(
        10406,
        "1746-NI16V",
        "16-Channel Analog Voltage Input, class 3",
        Evidence::Published,
        "publication 1746-UM001A",
    ),
    slc(12727, "1746-NO8I", "8-Channel Analog Current Output, class 3", Evidence::Published, "publication 1746-UM026A"),
    slc(12728, "1746-NO8V", "8-Channel Analog Voltage Output, class 3", Evidence::Published, "publication 1746-UM026A"),
];

/// The SLC module with this ID code (100 × class + number), if it is known.
pub fn slc_module(id: u16) -> Option<&'static ModuleName> {
    SLC_MODULES.iter().find(|(known, _)| *known == id).map(|(_, name)| name)
}

/// Input and output points of a controller whose stored bytes say more than it has: the on-board I/O
/// of the MicroLogix 1000 with 32 points, which stores 32 input and 16 output bits.
pub fn onboard_points(id: u16) -> Option<(u16, u16)> {
    (id == 3199).then_some((20, 12))
}

/// Bits per second of a serial baud code, with its evidence.
pub fn baud_rate(code: u8) -> Option<(u32, Evidence)> {
    match code {
        3 => Some((9_600, Evidence::Printed)),
        4 => Some((19_200, Evidence::Printed)),
        10 => Some((38_400, Evidence::Inferred)),
        _ => None,
    }
}

/// Name of a serial driver code as RSLogix prints it.
pub fn serial_driver(code: u16) -> Option<(&'static str, Evidence)> {
    match code {
        8 => Some(("DF1 Full Duplex", Evidence::Printed)),
        9 => Some(("Modbus RTU Master", Evidence::Printed)),
        _ => None,
    }
}

/// Settings of the general record without a known place, as printed beside every record that differs
/// in decoded words only.
pub const GENERAL_AS_PRINTED: &[(&str, &str)] = &[("Write Protected", "No")];

/// The same for the record of an Ethernet channel.
pub const ETHERNET_AS_PRINTED: &[(&str, &str)] = &[
    ("SNMP Enable", "No"),
    ("HTTP Enable", "Yes"),
    ("Auto Negotiate Enable", "Yes"),
    ("Port Speed Enable", "10/100 Mbps Full Duplex/Half Duplex"),
];

/// The same for a serial driver, by its code.
pub fn serial_as_printed(driver: u16) -> &'static [(&'static str, &'static str)] {
    match driver {
        8 => &[
            ("Parity", "NONE"),
            ("Control Line", "No Handshaking"),
            ("Error Detection", "CRC"),
            ("Embedded Responses", "Auto Detect"),
            ("Duplicate Packet Detect", "Yes"),
        ],
        9 => &[
            ("Parity", "NONE"),
            ("Control Line", "No Handshaking"),
            ("InterCharacter Timeout(x1 ms)", "0"),
            ("Pre Transmit Delay(x1 ms)", "0"),
        ],
        _ => &[],
    }
}

/// Base-unit variant: the four hexadecimal digits of a word of the packed
/// I/O configuration (evidence: inferred).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct BaseUnit(pub u16);

impl BaseUnit {
    /// Whether the base unit has on-board analog I/O; `None` for other digits.
    pub const fn analog(self) -> Option<bool> {
        match self.0 >> 12 {
            1 => Some(false),
            2 => Some(true),
            _ => None,
        }
    }

    /// Letter of the input kind (`A` AC, `B` DC); `None` if not stated.
    pub const fn input(self) -> Option<char> {
        match (self.0 >> 8) & 0xF {
            1 => Some('A'),
            2 => Some('B'),
            _ => None,
        }
    }

    /// Letter of the output kind (`W` relay, `X` mixed, `B` transistor).
    pub const fn output(self) -> Option<char> {
        match (self.0 >> 4) & 0xF {
            1 => Some('W'),
            2 => Some('X'),
            3 => Some('B'),
            _ => None,
        }
    }

    /// Letter of the supply (`A` AC, `B` DC); `None` if not stated.
    pub const fn supply(self) -> Option<char> {
        match self.0 & 0xF {
            1 => Some('A'),
            2 => Some('B'),
            _ => None,
        }
    }

    /// Variant letters as in the catalogue number (`BWA`, `BXBA`), or `None`
    /// where the project does not state the variant.
    pub fn letters(self) -> Option<String> {
        let mut letters: String = [self.input()?, self.output()?, self.supply()?].into_iter().collect();
        if self.analog()? {
            letters.push('A');
        }
        Some(letters)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_ascending() {
        let models: Vec<u16> = PROCESSOR_MODELS.iter().map(|model| model.code).collect();
        assert!(models.windows(2).all(|pair| pair[0] < pair[1]));
        let slc: Vec<u16> = SLC_MODULES.iter().map(|(id, _)| *id).collect();
        assert!(slc.windows(2).all(|pair| pair[0] < pair[1]));
        for (index, (identity, _)) in EXPANSION_MODULES.iter().enumerate() {
            assert!(EXPANSION_MODULES[..index].iter().all(|(earlier, _)| earlier != identity));
        }
    }

    #[test]
    fn printed_names_and_unknown_codes() {
        let model = processor_model(61).expect("1100 series B");
        assert_eq!(model.catalog, "Bul.1763");
        assert_eq!(model.name, "MicroLogix 1100 Series B");
        assert_eq!(model.name_evidence, Evidence::Printed);
        assert_eq!(processor_model(0x2A), None);
        assert_eq!(slc_module(4242), None);
        assert_eq!(baud_rate(0x7F), None);
        assert_eq!(reported_type(0x9C), Some("MicroLogix 1100"));
    }

    #[test]
    fn base_unit_letters() {
        assert_eq!(BaseUnit(0x1000).letters(), None);
        assert_eq!(BaseUnit(0x1111).letters().as_deref(), Some("AWA"));
        assert_eq!(BaseUnit(0x1211).letters().as_deref(), Some("BWA"));
        assert_eq!(BaseUnit(0x1232).letters().as_deref(), Some("BBB"));
        assert_eq!(BaseUnit(0x2222).letters().as_deref(), Some("BXBA"));
        assert_eq!(BaseUnit(0xFFFF).letters(), None);
    }
}
