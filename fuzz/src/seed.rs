//! Inputs to start from: the example projects, and records by our own writer with the parts that no
//! example has. Nothing is kept in the repository; each target writes its seeds before it runs.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use rss::program::{CipTail, Instruction, Item, LadFile, Leg, MessageSetup, PathHop, ProgramFiles, Rung, mark};
use rss::{ImageKind, Mode, Project, StreamKind, Text, serialize};

/// The folder of the fuzz targets.
const HOME: &str = env!("CARGO_MANIFEST_DIR");

/// The example projects.
pub static EXAMPLES: LazyLock<Vec<Project>> =
    LazyLock::new(|| files("RSS").iter().map(|bytes| Project::read(bytes, Mode::Strict).expect("reads")).collect());

/// Writes the seeds of a target where cargo-fuzz looks for inputs.
pub fn plant(target: &str, seeds: Vec<Vec<u8>>) {
    let folder = Path::new(HOME).join("corpus").join(target);
    std::fs::create_dir_all(&folder).expect("the folder of the inputs");
    for (number, seed) in seeds.iter().enumerate() {
        std::fs::write(folder.join(format!("seed-{number}")), seed).expect("a seed");
    }
}

/// The files of the examples with this ending.
#[must_use]
pub fn files(ending: &str) -> Vec<Vec<u8>> {
    let list = |folder: &Path| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).expect("the examples");
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("the examples").path()).collect();
        paths.sort();
        paths
    };
    let folders = list(&Path::new(HOME).join("../examples")).into_iter().filter(|path| path.is_dir());
    let paths = folders.flat_map(|folder| list(&folder));
    let wanted = paths.filter(|path| path.extension().is_some_and(|e| e == ending));
    wanted.map(|path| std::fs::read(path).expect("an example")).collect()
}

/// The payloads of these streams in the examples.
#[must_use]
pub fn payloads(kinds: &[StreamKind]) -> Vec<Vec<u8>> {
    let of = |project: &'static Project| kinds.iter().filter_map(|kind| project.stream(ImageKind::Main, *kind));
    EXAMPLES.iter().flat_map(of).map(|stream| stream.payload().to_vec()).collect()
}

/// Program files, and one with the set-up record of a message.
#[must_use]
pub fn programs() -> Vec<Vec<u8>> {
    let text = || Text::from_bytes(b"N7:0");
    let message = MessageSetup {
        command: text(),
        hops: vec![PathHop { address: text(), ..PathHop::default() }],
        cip: Some(CipTail { service: text(), blob: vec![1; 8].into(), ..CipTail::default() }),
        ..MessageSetup::default()
    };
    let item = |opcode, operands: usize, message: Option<MessageSetup<'static>>| {
        Item::Instruction(Instruction {
            operands: (0..operands).map(|_| text()).collect(),
            opcode,
            message: message.map(Box::new),
            ..Instruction::default()
        })
    };
    // Modbus and Ethernet/IP: without and with the CIP part.
    let plain = MessageSetup { cip: None, ..message.clone() };
    let items = vec![
        item(mark::RUNG_START, 0, None),
        item(0x9C, 1, Some(plain)),
        item(0xB6, 1, Some(message)),
        item(mark::RUNG_END, 0, None),
    ];
    let rung = Rung { leg: Leg { items }, ..Rung::default() };
    let file = LadFile { rung_count: 1, flags: LadFile::LADDER, number: 0, rungs: vec![rung], ..LadFile::default() };
    let mut all = payloads(&[StreamKind::ProgramFiles]);
    all.push(serialize(&ProgramFiles { files: vec![file] }).expect("writes"));
    all
}

/// Channel configurations, and one with the records of a serial channel.
#[must_use]
pub fn channels() -> Vec<Vec<u8>> {
    let record = |id: u16, words: u16| {
        let mut bytes = [id.to_le_bytes(), (2 * words).to_le_bytes()].concat();
        bytes.extend((0..words).flat_map(u16::to_le_bytes));
        bytes.extend(rss::channel::crc16_arc(&bytes).to_le_bytes());
        bytes
    };
    let words = [record(4, 9), record(5, 13), record(9, 3)].concat();
    let channel = rss::channel::Channel::from_bytes(&words);
    let configuration = rss::channel::ChannelConfiguration {
        model: rss::processor::Model(61),
        channels: vec![channel],
        ..rss::channel::ChannelConfiguration::default()
    };
    let mut all = payloads(&[StreamKind::ChannelConfiguration]);
    all.push(serialize(&configuration).expect("writes"));
    all
}

/// Compiler streams, and one with an image and a label table of one LBL and one JMP.
#[must_use]
pub fn compilers() -> Vec<Vec<u8>> {
    let mut labels = vec![40 + 23 + 22, 0, 0, 0, 23, 0, 22, 0];
    labels.resize(40, 0);
    labels.extend([[0; 4], [4, 0, 0, 0], [2, 0, 0, 0], [7, 0, 0, 0]].concat());
    labels.resize(40 + 23 + 22, 0);
    let mut all = payloads(&[StreamKind::Compiler]);
    // Behind the flag and the length of the image, and the lengths of both after it.
    if let Some(mut compiler) = all.first().cloned() {
        let head = compiler.len() - 24 - 2 - 2 - 4;
        compiler[head + 2..head + 4].copy_from_slice(&[40 + 23 + 22, 0]);
        compiler.splice(head + 8..head + 8, labels);
        all.push(compiler);
    }
    all
}

/// Monitors, and trends with a chart in it.
#[must_use]
pub fn monitors() -> Vec<Vec<u8>> {
    use StreamKind::{CustomDataMonitors, GraphicFiles, RecipeFiles};
    let chart = rss::monitors::Trend { name: Text::from_bytes(b"Heat"), file: b"content" };
    let mut all = payloads(&[CustomDataMonitors, GraphicFiles, RecipeFiles]);
    all.push(serialize(&rss::monitors::Trends { charts: vec![chart] }).expect("writes"));
    all
}

/// The compiled code of every instruction in the examples, each once.
#[must_use]
pub fn codes() -> Vec<Vec<u8>> {
    let mut all = Vec::new();
    for payload in payloads(&[StreamKind::ProgramFiles]) {
        let programs = rss::parse::<ProgramFiles<'_>>(&payload, "", Mode::Strict).value;
        for rung in programs.files.iter().flat_map(|file| &file.rungs) {
            rung.for_each_instruction(|instruction| all.push(instruction.code.to_vec()));
        }
    }
    all.sort();
    all.dedup();
    all
}

/// Streams with the two bytes before them by which [`crate::check::model`] chooses their place.
#[must_use]
pub fn streams() -> Vec<Vec<u8>> {
    let mut all = Vec::new();
    for (kind, stream) in (0..).zip(StreamKind::NAMED) {
        let image = kind % 2;
        all.extend(payloads(&[*stream]).into_iter().map(|payload| [vec![kind, image], payload].concat()));
    }
    all
}

/// The examples as JSON documents.
#[must_use]
pub fn documents() -> Vec<Vec<u8>> {
    let json = |project| convert::json::to_json_text(&convert::from_rss::project(project, Default::default()));
    EXAMPLES.iter().map(|project| json(project).into_bytes()).collect()
}
