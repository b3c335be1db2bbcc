//! The program as pages show it: what does not change while it runs.
//!
//! One interface for every dialect. A served program lives as long as the process that serves it, so views
//! may borrow it for good.

mod do_more;
mod slc;

use render::scene::Scene;
use render::svg;
use serde::Serialize;

pub use do_more::DoMoreProgram;
pub use slc::SlcProgram;

/// A program that is served.
pub trait Program: Send + Sync {
    /// Its file name, as a scenario in the same folder names it.
    fn file_name(&self) -> &str;
    /// `family` of scenarios on it, where they need one.
    fn scenario_family(&self) -> Option<String>;
    /// Controller, routines, data files, points.
    fn outline(&self) -> &Outline;
    /// A rung; `None` beyond the end.
    fn rung(&self, routine: u16, index: usize, width: usize) -> Option<RungView>;
    /// Height of the drawing of every rung, so that a page can make room for those it has not drawn; empty where
    /// there is no such routine.
    fn heights(&self, routine: u16, width: usize) -> Vec<usize>;
    /// Elements of a data file from one on; `None`: there is no such file.
    fn data(&self, file: &str, from: usize, count: usize) -> Option<DataView>;
    /// Who reads and writes an address.
    ///
    /// # Errors
    /// It is no address or symbol.
    fn uses(&self, address: &str) -> Result<UsesView, String>;
    /// Everything a text is found in.
    ///
    /// # Errors
    /// The text is no query.
    fn search(&self, text: &str) -> Result<HitsView, String>;
}

/// The project tree.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Outline {
    /// File name.
    pub file: String,
    /// `slc` or `do-more`.
    pub dialect: &'static str,
    /// The controller in words.
    pub controller: String,
    /// What else is known of it: name and value.
    pub properties: Vec<(&'static str, String)>,
    /// Program files or code blocks.
    pub routines: Vec<RoutineView>,
    /// Data files or memory blocks.
    pub data_files: Vec<DataFileView>,
    /// Input and output points the program uses.
    pub points: Vec<PointView>,
    /// Timers and counters the program uses.
    pub timers: Vec<TimerView>,
    /// What a person must know before trusting a run: approximations, parts that could not be read.
    pub notes: Vec<String>,
}

/// A program file or code block.
#[derive(Clone, Debug, Serialize)]
pub struct RoutineView {
    /// Its number in requests.
    pub number: u16,
    /// `LAD 2 - MAIN`.
    pub title: String,
    /// Its description.
    pub description: String,
    /// How many rungs it has.
    pub rungs: usize,
}

/// A data file.
#[derive(Clone, Debug, Serialize)]
pub struct DataFileView {
    /// Its name in requests: `N7`.
    pub label: String,
    /// Its name and description.
    pub title: String,
    /// How many elements it has.
    pub elements: usize,
}

/// An input or output point.
#[derive(Clone, Debug, Serialize)]
pub struct PointView {
    /// Address of the bit or word.
    pub address: String,
    /// Symbol or nickname.
    pub symbol: String,
    /// Description.
    pub description: String,
    /// An input; otherwise an output.
    pub input: bool,
    /// A word; otherwise a bit.
    pub analog: bool,
}

/// A timer or counter.
#[derive(Clone, Debug, Serialize)]
pub struct TimerView {
    /// Its address.
    pub address: String,
    /// `TON`, `CTU`, ... several where several instructions use it.
    pub kind: String,
    /// Symbol or nickname.
    pub symbol: String,
    /// Description.
    pub description: String,
    /// Address of its preset, where it has one.
    pub preset: Option<String>,
    /// Address of its accumulated value.
    pub accumulated: String,
    /// Address of its done bit.
    pub done: String,
    /// Seconds per count; `None` for counters.
    pub base: Option<f64>,
}

/// A rung.
#[derive(Clone, Debug, Serialize)]
pub struct RungView {
    /// Its number from 0.
    pub rung: usize,
    /// The drawing.
    pub svg: String,
    /// Its instructions in stored order.
    pub instructions: Vec<InstructionView>,
    /// Instruction, wire it takes power from, wire it gives power to, as the drawing numbers wires. 0 is the left rail.
    pub wires: Vec<(usize, usize, usize)>,
    /// Wires without an instruction on them, in the order of power flow: from, to.
    pub shorts: Vec<(usize, usize)>,
}

/// Room for a value in a drawing, until a page shows the real one: as wide as most numbers become.
const PLACE: &str = "......";

/// The places for the values of a rung's instructions.
fn places(views: &[InstructionView], number: usize, operand: usize) -> Option<String> {
    let values = &views.get(number)?.values;
    values.iter().any(|value| value.operand == operand).then(|| PLACE.to_owned())
}

impl RungView {
    fn new(rung: usize, scene: Scene, instructions: Vec<InstructionView>) -> RungView {
        // Every instruction gets a state, so that pages need only change it.
        let mark = |_| svg::Mark { on: Some(false), ..svg::Mark::default() };
        let options = svg::Options { mark: &mark, power: Some(&|_| false), ..svg::Options::default() };
        RungView {
            rung,
            svg: svg::drawing(&scene, &options),
            instructions,
            wires: scene.instructions.iter().map(|spot| (spot.index, spot.enters, spot.leaves)).collect(),
            shorts: scene.shorts,
        }
    }
}

/// An instruction.
#[derive(Clone, Debug, Serialize)]
pub struct InstructionView {
    /// Its mnemonic.
    pub mnemonic: String,
    /// Its operands as written.
    pub operands: Vec<String>,
    /// Values a page keeps up to date in the drawing.
    pub values: Vec<ValueView>,
    /// Flags at the right side of a box (EN, DN), in the order they are drawn.
    pub flags: Vec<FlagView>,
    /// The bit a click changes.
    pub bit: Option<String>,
    /// It is a contact that looks at that bit.
    pub contact: bool,
    /// That bit can be forced.
    pub forcible: bool,
}

/// A flag beside a box.
#[derive(Clone, Debug, Serialize)]
pub struct FlagView {
    /// What is written in it.
    pub name: &'static str,
    /// Address of its bit; `None` where the control block is no element with flags.
    pub address: Option<String>,
}

/// A value in a drawing.
#[derive(Clone, Debug, Serialize)]
pub struct ValueView {
    /// Address of the value.
    pub address: String,
    /// The operand it stands at.
    pub operand: usize,
    /// It stands in the place of the operand (a preset); otherwise in a row of its own below it.
    pub instead: bool,
}

/// Elements of a data file.
#[derive(Clone, Debug, Serialize)]
pub struct DataView {
    /// The file.
    pub label: String,
    /// Columns: what stands behind the address of an element, empty for the element itself.
    pub columns: Vec<String>,
    /// Radix of words when nothing else is chosen: `decimal`, `binary`, `hex`.
    pub radix: &'static str,
    /// The elements asked for.
    pub elements: Vec<ElementView>,
}

/// An element of a data file.
#[derive(Clone, Debug, Serialize)]
pub struct ElementView {
    /// Its address.
    pub address: String,
    /// Symbol or nickname.
    pub symbol: String,
    /// Description.
    pub description: String,
}

/// Who uses an address.
#[derive(Clone, Debug, Default, Serialize)]
pub struct UsesView {
    /// The address.
    pub address: String,
    /// Symbol or nickname.
    pub symbol: String,
    /// Description.
    pub description: String,
    /// Uses in program order.
    pub uses: Vec<UseView>,
    /// Uses that are not listed because there are too many.
    pub left_out: usize,
}

/// One use.
#[derive(Clone, Debug, Serialize)]
pub struct UseView {
    /// Program file or code block.
    pub routine: u16,
    /// Rung, from 0.
    pub rung: usize,
    /// Instruction in it, from 0, where the use is one instruction's.
    pub instruction: Option<usize>,
    /// The instruction.
    pub text: String,
    /// `read`, `write`, ...
    pub access: String,
}

/// What a search found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct HitsView {
    /// The address or symbol the text is.
    pub named: Option<NamedView>,
    /// In program order.
    pub hits: Vec<HitView>,
    /// Hits that are not listed because there are too many.
    pub left_out: usize,
}

/// An address that was named.
#[derive(Clone, Debug, Serialize)]
pub struct NamedView {
    /// The address.
    pub address: String,
    /// Symbol or nickname.
    pub symbol: String,
    /// How many uses it has.
    pub uses: usize,
}

/// One hit.
#[derive(Clone, Debug, Serialize)]
pub struct HitView {
    /// Program file or code block, where it stands in one.
    pub routine: Option<u16>,
    /// Rung, from 0.
    pub rung: Option<usize>,
    /// What it is: `instruction`, `symbol`, `comment`, ...
    pub kind: String,
    /// The text found.
    pub text: String,
    /// The address it is about, of documentation.
    pub address: Option<String>,
    /// Label of the data file it is about.
    pub data: Option<String>,
}

/// Uses and hits that are listed.
const LISTED: usize = 500;
