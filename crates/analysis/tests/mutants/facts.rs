//! What is true of a program after every scan, whatever its inputs and times: found by trying, shown by
//! induction over one scan.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use analysis::proof::{Kind, Scope};
use domore::Project;

use super::gates::{Answer, Gates, Line, OFF, ON, value};
use super::meet::{Meeting, Notes};
use super::relations::speaks_of;
use super::scan::{Begin, Change, HALTED, Model, Outside, Scan, Start, Why};
use super::words::{Word, constant, of_bits};

/// Milliseconds between two scans at most: eleven days.
pub(crate) const LONGEST: i64 = 999_999_999;

/// All that is known of a program.
pub(crate) struct Facts<'f> {
    pub(crate) model: Model<'f>,
    pub(crate) gates: Gates,
    /// What comes from outside in the scan that is looked at.
    pub(crate) outside: Outside,
    pub(crate) begin: Begin,
    /// Bits after the first scan.
    first: HashMap<u32, bool>,
    /// Bits that can change later.
    lines: BTreeMap<u32, Line>,
    /// What holds before the scan and in it: ranges of what is changed from outside, a halt.
    pub(crate) given: Vec<Line>,
    /// Relations that hold after every scan.
    pub(crate) relations: Vec<super::relations::Clause>,
    related: Vec<Line>,
}

/// Nothing but zeros, and timers that never ran.
struct PowerUp(HashMap<u32, Line>);

impl Start for PowerUp {
    fn line(&self, bit: u32) -> Line {
        self.0.get(&bit).copied().unwrap_or(OFF)
    }
}

/// Memory between two scans: some bits apart from how the unchanged program has them.
pub(crate) struct Between<'b> {
    first: &'b HashMap<u32, bool>,
    lines: &'b BTreeMap<u32, Line>,
    pub(crate) own: &'b HashMap<u32, Line>,
}

impl Start for Between<'_> {
    fn line(&self, bit: u32) -> Line {
        let known = || self.first.get(&bit).map_or(OFF, |on| Line::from(*on));
        self.own.get(&bit).or_else(|| self.lines.get(&bit)).copied().unwrap_or_else(known)
    }
}

/// Memory after a scan.
pub(crate) type After = HashMap<u32, Line>;

impl<'f> Facts<'f> {
    /// Finds which bits never change after the first scan.
    pub(crate) fn new(project: &'f Project, scope: &Scope) -> Result<Facts<'f>, Why> {
        let model = Model::new(project)?;
        let mut gates = Gates::new();
        let mut outside = Outside::default();
        let mode = gates.input();
        let time = (0..31).map(|_| gates.input()).collect();
        let begin = Begin { mode, time: of_bits(time, false), writes: Vec::new() };
        let mut facts = Facts {
            model,
            gates,
            outside: Outside::default(),
            begin,
            first: HashMap::new(),
            lines: BTreeMap::new(),
            given: Vec::new(),
            relations: Vec::new(),
            related: Vec::new(),
        };
        let after = facts.first_scan(None, &mut outside)?;
        for (bit, line) in after {
            if line < 2 {
                facts.first.insert(bit, line == ON);
            } else {
                let line = facts.gates.input();
                facts.lines.insert(bit, line);
            }
        }
        let endless = facts.gates.less(&constant(LONGEST), &facts.begin.time.clone());
        facts.given.push(endless ^ 1);
        facts.drive(scope)?;
        while facts.grow()? {}
        Ok(facts)
    }

    /// Memory after the first scan from power-up.
    pub(crate) fn first_scan(&mut self, change: Option<Change<'_>>, outside: &mut Outside) -> Result<After, Why> {
        let start = PowerUp(self.model.hidden().collect());
        let begin = Begin { mode: ON, time: constant(0), writes: Vec::new() };
        let mut scan = Scan::new(&self.model, change, &start, (&mut self.gates, outside))?;
        scan.run(&begin)?;
        Ok(scan.memory)
    }

    /// Memory after any later scan.
    pub(crate) fn next(&mut self, change: Option<Change<'_>>, own: &HashMap<u32, Line>) -> Result<After, Why> {
        let start = Between { first: &self.first, lines: &self.lines, own };
        let mut scan = Scan::new(&self.model, change, &start, (&mut self.gates, &mut self.outside))?;
        scan.run(&self.begin)?;
        Ok(scan.memory)
    }

    /// Memory after any later scan, and what was written in it; all of memory behind the rung that will change.
    pub(crate) fn next_noted(&mut self, place: (usize, usize)) -> Result<(After, Notes), Why> {
        let own = HashMap::new();
        let start = Between { first: &self.first, lines: &self.lines, own: &own };
        let mut scan = Scan::new(&self.model, None, &start, (&mut self.gates, &mut self.outside))?;
        scan.notes = Some(Notes::new(place));
        scan.run(&self.begin)?;
        Ok((scan.memory, scan.notes.unwrap_or_default()))
    }

    /// Memory after any later scan of a program with a change, which meets the unchanged one.
    pub(crate) fn next_changed(
        &mut self,
        change: Change<'_>,
        own: &HashMap<u32, Line>,
        (notes, questions): (&Notes, usize),
        given: &[Line],
    ) -> Result<After, Why> {
        let start = Between { first: &self.first, lines: &self.lines, own };
        let mut scan = Scan::new(&self.model, Some(change), &start, (&mut self.gates, &mut self.outside))?;
        scan.peer = Some(Meeting::new(notes, given, questions));
        scan.run(&self.begin)?;
        Ok(scan.memory)
    }

    /// A bit between two scans.
    pub(crate) fn before(&self, bit: u32) -> Line {
        Between { first: &self.first, lines: &self.lines, own: &HashMap::new() }.line(bit)
    }

    /// Data from outside can have any value of its range.
    fn drive(&mut self, scope: &Scope) -> Result<(), Why> {
        for driven in &scope.driven {
            // The clock is from outside anyway.
            if driven.address.starts_with("SDT0") {
                continue;
            }
            let resolved = self.model.map.resolve_text(&driven.address).map_err(|error| error.why)?;
            let domore::memory::Resolved::Place(place) = resolved else { return Err("no place".to_owned()) };
            let bits = match driven.kind {
                Kind::Bit => 1,
                Kind::Word => 16,
                Kind::Long => 32,
                _ => return Err("reals and texts are not followed".to_owned()),
            };
            // Bits that no value of the range has are off.
            let used = driven.range.map_or(bits, |(_, most)| bits.min(u32::BITS - most.leading_zeros()));
            let value: Word = (0..bits).map(|bit| if bit < used { self.gates.input() } else { OFF }).collect();
            let changes = self.gates.input();
            if let Some((least, most)) = driven.range {
                let number = of_bits(value.clone(), false);
                let below = self.gates.less(&number, &constant(least.into()));
                let above = self.gates.less(&constant(most.into()), &number);
                self.given.extend([below ^ 1, above ^ 1]);
            }
            self.begin.writes.push((place.bit, value, changes));
        }
        Ok(())
    }

    /// Takes bits that one scan can change into those that vary; `false`: there is none left.
    fn grow(&mut self) -> Result<bool, Why> {
        let after = self.next(None, &HashMap::new())?;
        let mut given = self.given.clone();
        // A program that was halted goes on only after run was left and entered.
        let halted = self.before(HALTED);
        let goes_on = self.gates.or(halted ^ 1, self.begin.mode);
        given.push(goes_on);
        let mut fresh = BTreeSet::new();
        for (bit, line) in &after {
            let known = Line::from(self.first.get(bit).copied().unwrap_or(false));
            if self.lines.contains_key(bit) || *line == known || fresh.contains(bit) {
                continue;
            }
            match self.gates.ask(*line ^ known, &given) {
                Answer::Never => {}
                Answer::Open => drop(fresh.insert(*bit)),
                Answer::Values(values) => {
                    // Everything else that changes with these values too.
                    for (bit, line) in &after {
                        let known = self.first.get(bit).copied().unwrap_or(false);
                        if !self.lines.contains_key(bit) && value(&values, *line) != known {
                            fresh.insert(*bit);
                        }
                    }
                }
            }
        }
        for bit in &fresh {
            let line = self.gates.input();
            self.lines.insert(*bit, line);
        }
        if fresh.is_empty() {
            self.given = given;
        }
        Ok(!fresh.is_empty())
    }

    /// What the other bits are.
    pub(crate) fn fixed(&self) -> HashMap<u32, Line> {
        self.first.iter().map(|(bit, on)| (*bit, Line::from(*on))).collect()
    }

    /// Looks for relations between bits and words.
    pub(crate) fn relate(&mut self, project: &Project, scope: &Scope) -> Result<(), Why> {
        self.relations = super::relations::find(self, project, scope)?;
        let lines: HashMap<u32, Line> = self.lines.iter().map(|(bit, line)| (*bit, *line)).collect();
        let fixed = self.fixed();
        let was = |bit: u32| lines.get(&bit).or_else(|| fixed.get(&bit)).copied().unwrap_or(0);
        for clause in self.relations.clone() {
            let line = super::relations::line_of(self, &clause, &was);
            self.related.push(line);
        }
        Ok(())
    }

    /// What holds before a scan and speaks of some of these bits.
    pub(crate) fn known_of(&self, of: &dyn Fn(u32) -> bool) -> Vec<Line> {
        let near = self.relations.iter().zip(&self.related).filter(|(clause, _)| speaks_of(clause, of));
        self.given.iter().copied().chain(near.map(|row| *row.1)).collect()
    }

    /// Bits that can change.
    pub(crate) fn varying(&self) -> impl Iterator<Item = u32> {
        self.lines.keys().copied()
    }
}
