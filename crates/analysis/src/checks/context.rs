//! What all checks look at: the program walked once, with its cross reference, calls and timers.

use std::cell::{OnceCell, RefCell};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use instr::{Form, Position, Role};
use ladder::{Address, Documentation, Element, FileType, Image, Instruction, Mnemonic, Operand, Value};

use crate::budget::Budget;
use crate::calls::CallGraph;
use crate::location::Location;
use crate::space::Area;
use crate::timers::TimerReport;
use crate::xref::{CrossReference, Level, Through};

/// Branches nested deeper than any processor takes are not followed for what gates an instruction.
const MAX_DEPTH: usize = 64;

/// One instruction of the program.
pub(crate) struct Step<'a> {
    pub(crate) at: Location,
    pub(crate) it: &'a Instruction,
    /// Mnemonic; empty when it is not known.
    pub(crate) name: &'a str,
    pub(crate) info: Option<&'static instr::Instruction>,
    pub(crate) form: Option<&'static Form>,
    /// Some condition stands before it. `false`: it sees a true rung in every scan of its rung.
    pub(crate) gated: bool,
}

impl Step<'_> {
    /// The constant at operand `index`.
    pub(crate) fn integer(&self, index: usize) -> Option<i64> {
        self.it.operands.get(index)?.constant()?.as_integer()
    }
}

/// An instruction without a form may be a condition.
pub(crate) fn is_condition(form: Option<&Form>) -> bool {
    form.is_none_or(|form| form.position == Position::Input)
}

/// An access to data, definite or not.
#[derive(Clone)]
pub(crate) struct Touch<'a> {
    pub(crate) at: Location,
    pub(crate) mnemonic: &'a Mnemonic,
    pub(crate) role: Role,
    pub(crate) definite: bool,
    pub(crate) level: Level,
    pub(crate) through: Through,
}

/// An image as checks see it.
pub(crate) struct Context<'a> {
    pub(crate) image: &'a Image,
    pub(crate) documentation: &'a Documentation,
    pub(crate) xref: CrossReference<'a>,
    pub(crate) calls: CallGraph,
    pub(crate) timers: TimerReport,
    /// All instructions in program order.
    pub(crate) steps: Vec<Step<'a>>,
    /// Rungs that examine S:1/15.
    first_scan: HashSet<(u16, u32)>,
    findings: OnceCell<crate::xref::Findings>,
    touches: RefCell<HashMap<Area, Rc<Vec<Touch<'a>>>>>,
    budget: RefCell<Budget>,
}

impl<'a> Context<'a> {
    pub(crate) fn new(image: &'a Image, documentation: &'a Documentation) -> Context<'a> {
        let xref = CrossReference::build(image, documentation);
        let timers = TimerReport::build(image, &xref);
        let steps = steps(image);
        let first_pass = Address::element(FileType::S, 2, 1).with_bit(15);
        let examines = |step: &&Step<'_>| {
            step.name == "XIC" && step.it.operands.first().and_then(Operand::address) == Some(&first_pass)
        };
        let first_scan = steps.iter().filter(examines).map(|step| (step.at.file, step.at.rung)).collect();
        Context {
            image,
            documentation,
            calls: CallGraph::build(image, documentation),
            timers,
            steps,
            first_scan,
            xref,
            findings: OnceCell::new(),
            touches: RefCell::default(),
            budget: RefCell::new(Budget::of_report()),
        }
    }

    /// The findings of the cross reference.
    pub(crate) fn findings(&self) -> &crate::xref::Findings {
        self.findings.get_or_init(|| self.xref.findings())
    }

    /// Some accesses were not looked up.
    pub(crate) fn is_spent(&self) -> bool {
        self.budget.borrow().is_spent()
    }

    /// The address an operand names, a symbol resolved.
    pub(crate) fn address(&self, step: &Step<'_>, operand: usize) -> Option<Address> {
        self.xref.resolve(step.it.operands.get(operand)?)
    }

    /// Every access to some of what an address names; `None` when there is no time left to look.
    pub(crate) fn touches(&self, address: &Address) -> Option<Rc<Vec<Touch<'_>>>> {
        let Some(area) = self.xref.place(address) else { return Some(Rc::default()) };
        if let Some(known) = self.touches.borrow().get(&area) {
            return Some(known.clone());
        }
        let spans = self.xref.overlapping(area, &mut self.budget.borrow_mut())?;
        let mut all: Vec<Touch<'a>> = Vec::with_capacity(spans.len());
        for span in &spans {
            if let Some(it) = self.xref.use_of(span) {
                all.push(Touch {
                    at: it.location,
                    mnemonic: it.mnemonic,
                    role: span.role,
                    definite: span.definite,
                    level: span.level,
                    through: it.through,
                });
            }
        }
        all.sort_by_key(|touch| touch.at);
        let all = Rc::new(all);
        self.touches.borrow_mut().insert(area, all.clone());
        Some(all)
    }

    /// The accesses that write, perhaps or certainly.
    pub(crate) fn writes(&self, address: &Address) -> Option<Vec<Touch<'_>>> {
        Some(self.touches(address)?.iter().filter(|touch| touch.role.writes()).cloned().collect())
    }

    /// The accesses that read, perhaps or certainly.
    pub(crate) fn reads(&self, address: &Address) -> Option<Vec<Touch<'_>>> {
        Some(self.touches(address)?.iter().filter(|touch| touch.role.reads()).cloned().collect())
    }

    /// The program file can run.
    pub(crate) fn runs(&self, file: u16) -> bool {
        self.calls.file(file).is_some_and(|file| file.reachable)
    }

    /// The steps grouped by the direct address of an operand, in program order.
    pub(crate) fn by_address<'s>(
        &'s self,
        wanted: impl Fn(&Step<'a>) -> Option<usize>,
    ) -> Vec<(Address, Vec<&'s Step<'a>>)> {
        let mut groups: Vec<(Address, Vec<&Step<'a>>)> = Vec::new();
        let mut places: HashMap<Address, usize> = HashMap::new();
        for step in &self.steps {
            let Some(address) = wanted(step).and_then(|operand| self.address(step, operand)) else { continue };
            if !address.is_direct() {
                continue;
            }
            match places.get(&address) {
                Some(group) => {
                    if let Some((_, steps)) = groups.get_mut(*group) {
                        steps.push(step);
                    }
                }
                None => {
                    places.insert(address.clone(), groups.len());
                    groups.push((address, vec![step]));
                }
            }
        }
        groups
    }

    /// The rung examines S:1/15, which is on in the first scan.
    pub(crate) fn is_first_scan(&self, at: Location) -> bool {
        self.first_scan.contains(&(at.file, at.rung))
    }

    /// A word of the status file.
    pub(crate) fn status_word(&self, word: u16) -> Option<u16> {
        self.image.data_file(FileType::S, 2)?.element_words(word)?.first().copied()
    }

    /// The number an operand has now: a constant, or what the data table holds.
    pub(crate) fn value(&self, operand: &Operand) -> Option<f64> {
        use ladder::Number;
        match operand {
            Operand::Constant(constant) => Some(match constant.number() {
                Number::Integer(number) => number as f64,
                Number::Float(number) => number.into(),
            }),
            _ => match self.xref.value(&self.xref.resolve(operand)?)? {
                Value::Word(word) => Some(word.into()),
                Value::Long(long) => Some(long.into()),
                Value::Float(float) => Some(float.into()),
                _ => None,
            },
        }
    }
}

fn steps(image: &Image) -> Vec<Step<'_>> {
    let mut steps = Vec::new();
    for file in image.ladder_files() {
        for (rung, content) in (0..).zip(&file.rungs) {
            let mut walk = Walk { image, at: Location { file: file.number, rung, instruction: 0 }, steps: &mut steps };
            walk.series(&content.series, false, 0);
        }
    }
    steps
}

struct Walk<'a, 's> {
    image: &'a Image,
    at: Location,
    steps: &'s mut Vec<Step<'a>>,
}

impl<'a> Walk<'a, '_> {
    /// Returns whether what follows the series is gated.
    fn series(&mut self, series: &'a [Element], mut gated: bool, depth: usize) -> bool {
        for element in series {
            match element {
                Element::Instruction(it) => {
                    let name = it.mnemonic.name().unwrap_or("");
                    let info = instr::by_mnemonic(name);
                    let form = info.and_then(|info| form(info, self.image, it));
                    self.steps.push(Step { at: self.at, it, name, info, form, gated });
                    self.at.instruction = self.at.instruction.saturating_add(1);
                    gated |= is_condition(form);
                }
                // Without following it, nothing may be called ungated.
                Element::Branch(_) if depth >= MAX_DEPTH => gated = true,
                Element::Branch(branch) => {
                    let mut all = !branch.legs.is_empty();
                    for leg in &branch.legs {
                        all &= self.series(leg, gated, depth + 1);
                    }
                    gated |= all;
                }
            }
        }
        gated
    }
}

/// The form an instruction has: operands tell the forms of one mnemonic apart (OSR).
pub(crate) fn form(info: &'static instr::Instruction, image: &Image, it: &Instruction) -> Option<&'static Form> {
    let fits = |form: &&'static Form| form.operands.len() == it.operands.len();
    let text = || info.form_for(image.family(), it.operands.len());
    let own = || info.forms_for(image.family()).find(fits);
    own().or_else(|| info.forms.iter().find(fits)).or_else(text).or_else(|| info.forms.first())
}
