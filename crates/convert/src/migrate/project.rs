//! The parts of the Do-more project around the rungs.

use domore::program::{Controller, MemoryBlock, Radix, Section};
use domore::{CodeBlock, CodeKind, Part, Project};

use super::allocate::Block;
use super::context::Context;
use super::docs;

/// The model the result is made for unless a person chooses another in Designer.
const CONTROLLER: &str = "DM-SIM";

/// Memory blocks of a new project: name, type, radix, count, not retentive.
const MEMORY: [(&str, &str, Radix, u32, bool); 22] = [
    ("X", "BIT", Radix::Decimal, 2048, true),
    ("Y", "BIT", Radix::Decimal, 2048, true),
    ("WX", "SWORD", Radix::Decimal, 256, true),
    ("WY", "SWORD", Radix::Decimal, 256, true),
    ("C", "BIT", Radix::Decimal, 2048, false),
    ("V", "UWORD", Radix::Decimal, 4096, false),
    ("N", "SWORD", Radix::Decimal, 4096, false),
    ("D", "SDWORD", Radix::Decimal, 4096, false),
    ("R", "REAL", Radix::Decimal, 4096, false),
    ("T", "TIMER", Radix::Decimal, 256, false),
    ("CT", "COUNTER", Radix::Decimal, 256, false),
    ("SS", "STRING", Radix::Decimal, 128, false),
    ("SL", "STRING", Radix::Decimal, 64, false),
    ("UDT", "DATETIME", Radix::Decimal, 32, false),
    ("PL", "UWORD", Radix::Decimal, 256, false),
    ("DLX", "BIT", Radix::Octal, 0o1000, true),
    ("DLY", "BIT", Radix::Octal, 0o1000, true),
    ("DLC", "BIT", Radix::Octal, 0o1000, false),
    ("DLV", "UWORD", Radix::Octal, 0o4000, false),
    ("MI", "BIT", Radix::Decimal, 1024, false),
    ("MC", "BIT", Radix::Decimal, 1024, false),
    ("MIR", "SWORD", Radix::Decimal, 2048, false),
];

/// Blocks grow in steps of this many elements.
const STEP: u32 = 256;

/// The project of these code blocks.
pub(super) fn project(context: &Context<'_>, blocks: Vec<CodeBlock>, documented: &[docs::Documented]) -> Project {
    let mut memory: Vec<MemoryBlock> = MEMORY
        .iter()
        .map(|(name, type_word, radix, count, volatile)| {
            let used = Block::by_name(name).map_or(0, |block| context.places.used(block));
            MemoryBlock {
                name: (*name).to_owned(),
                type_word: (*type_word).to_owned(),
                radix: Some(*radix),
                count: if used > *count { used.next_multiple_of(STEP) } else { *count },
                extra: if *volatile { vec!["-1".to_owned()] } else { Vec::new() },
                ..MemoryBlock::default()
            }
        })
        .collect();
    memory.extend(blocks.iter().filter(|block| block.kind == CodeKind::Subroutine).map(|block| MemoryBlock {
        name: block.name.clone(),
        type_word: "<Virtual>".to_owned(),
        radix: None,
        count: 0,
        ..MemoryBlock::default()
    }));
    let mut parts = vec![
        Part::Controller(Controller { model: CONTROLLER.to_owned(), ..Controller::default() }),
        Part::Memory(Section::new(memory)),
    ];
    parts.extend(blocks.into_iter().map(Part::Code));
    parts.push(Part::Documentation(Section::new(docs::elements(documented))));
    Project { parts, ..Project::default() }
}
