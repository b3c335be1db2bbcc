//! Logic as a graph of AND gates, each of them once, and the question whether a line of it can be on.

use std::cell::Cell;
use std::collections::HashMap;
use std::rc::Rc;

use batsat::{BasicSolver, Lit, SolverInterface, Var, lbool};

/// A gate or input, doubled, and whether it is inverted: the last bit.
pub(crate) type Line = u32;

pub(crate) const OFF: Line = 0;
pub(crate) const ON: Line = 1;

/// Steps of the solver after which a question stays open.
const PATIENCE: u64 = 300_000;

/// Gates that are looked through.
const LEVELS: u32 = 4;

/// Gates and inputs, and what a solver was told of them.
pub(crate) struct Gates {
    /// Both sides of a gate; an input has none.
    nodes: Vec<Option<(Line, Line)>>,
    known: HashMap<(Line, Line), Line>,
    solver: BasicSolver,
    variables: HashMap<u32, Var>,
    /// Steps the solver has left.
    steps: Rc<Cell<u64>>,
    /// Steps of the solver after which a question stays open.
    pub(crate) patience: u64,
}

/// What became of a question.
#[derive(Clone, Debug)]
pub(crate) enum Answer {
    /// The line is off, whatever the inputs.
    Never,
    /// It is on with these values of all nodes.
    Values(Vec<bool>),
    /// Nothing is known after much work.
    Open,
}

impl Gates {
    pub(crate) fn new() -> Gates {
        let steps = Rc::new(Cell::new(0u64));
        let solver = solver(&steps);
        Gates { nodes: vec![None], known: HashMap::new(), solver, variables: HashMap::new(), steps, patience: PATIENCE }
    }

    /// How many gates there are.
    pub(crate) fn size(&self) -> usize {
        self.nodes.len()
    }

    /// Forgets the gates above so many.
    pub(crate) fn forget(&mut self, size: usize) {
        self.nodes.truncate(size);
        self.known.retain(|_, line| ((*line >> 1) as usize) < size);
        self.solver = solver(&self.steps);
        self.variables.clear();
    }

    pub(crate) fn input(&mut self) -> Line {
        self.nodes.push(None);
        (self.nodes.len() as u32 - 1) << 1
    }

    fn gate(&self, line: Line) -> Option<(Line, Line)> {
        self.nodes.get((line >> 1) as usize).copied().flatten()
    }

    pub(crate) fn and(&mut self, a: Line, b: Line) -> Line {
        let (a, b) = (a.min(b), a.max(b));
        if a == OFF || a == b ^ 1 {
            return OFF;
        }
        if a == ON || a == b {
            return b;
        }
        // One side stands in the other one already.
        for (outer, inner) in [(a, b), (b, a)] {
            if let Some((x, y)) = self.gate(inner) {
                let decided = [x, y].contains(&(outer ^ 1));
                let implied = [x, y].contains(&outer);
                match (inner & 1 == 1, decided, implied) {
                    (false, true, _) => return OFF,
                    (false, _, true) => return inner,
                    (true, true, _) => return outer,
                    (true, _, true) => {
                        let rest = if x == outer { y } else { x };
                        return self.and(outer, rest ^ 1);
                    }
                    _ => {}
                }
            }
        }
        if let Some(found) = self.known.get(&(a, b)) {
            return *found;
        }
        self.nodes.push(Some((a, b)));
        let line = (self.nodes.len() as u32 - 1) << 1;
        self.known.insert((a, b), line);
        line
    }

    pub(crate) fn or(&mut self, a: Line, b: Line) -> Line {
        self.and(a ^ 1, b ^ 1) ^ 1
    }

    pub(crate) fn xor(&mut self, a: Line, b: Line) -> Line {
        if a < 2 {
            return b ^ a;
        }
        if b < 2 {
            return a ^ b;
        }
        let (either, both) = (self.or(a, b), self.and(a, b));
        self.and(either, both ^ 1)
    }

    /// Whether `line` is on wherever `select` is, as far as gates above it show.
    fn implies(&self, select: Line, line: Line, levels: u32) -> bool {
        let sides = || self.gate(select).filter(|_| select & 1 == 0 && levels > 0);
        select == line
            || sides().is_some_and(|(a, b)| self.implies(a, line, levels - 1) || self.implies(b, line, levels - 1))
    }

    /// What a choice is where `select` is on: a value kept under power is that value under the same power.
    fn under(&self, select: Line, line: Line, levels: u32) -> Line {
        let (1, Some((a, b)), true) = (line & 1, self.gate(line), levels > 0) else { return line };
        if a & b & 1 == 0 {
            return line;
        }
        let (Some(x), Some(y)) = (self.gate(a), self.gate(b)) else { return line };
        for ((one, two), (three, four)) in [(x, y), (y, x)] {
            for (choice, value) in [(one, two), (two, one)] {
                if (three == choice ^ 1 || four == choice ^ 1) && self.implies(select, choice, LEVELS) {
                    return self.under(select, value, levels - 1);
                }
            }
        }
        line
    }

    /// `on` where `select` is on, else `off`.
    pub(crate) fn choose(&mut self, select: Line, on: Line, off: Line) -> Line {
        let (on, off) = (self.under(select, on, LEVELS), self.under(select ^ 1, off, LEVELS));
        if on == off {
            return on;
        }
        let (x, y) = (self.and(select, on), self.and(select ^ 1, off));
        self.or(x, y)
    }

    fn variable(&mut self, line: Line) -> Lit {
        // Gates below first, without recursion: a scan makes deep graphs.
        let mut open = vec![line >> 1];
        while let Some(node) = open.last().copied() {
            if self.variables.contains_key(&node) {
                open.pop();
                continue;
            }
            let sides = self.nodes.get(node as usize).copied().flatten();
            let Some((a, b)) = sides else {
                let variable = self.solver.new_var_default();
                if node == 0 {
                    self.solver.add_clause_reuse(&mut vec![Lit::new(variable, false)]);
                }
                self.variables.insert(node, variable);
                open.pop();
                continue;
            };
            let below: Vec<u32> = [a >> 1, b >> 1].into_iter().filter(|n| !self.variables.contains_key(n)).collect();
            if !below.is_empty() {
                open.extend(below);
                continue;
            }
            let variable = self.solver.new_var_default();
            let side = |line: Line| Lit::new(self.variables[&(line >> 1)], line & 1 == 0);
            let (own, a, b) = (Lit::new(variable, true), side(a), side(b));
            for clause in [vec![!own, a], vec![!own, b], vec![own, !a, !b]] {
                self.solver.add_clause_reuse(&mut clause.clone());
            }
            self.variables.insert(node, variable);
            open.pop();
        }
        Lit::new(self.variables[&(line >> 1)], line & 1 == 0)
    }

    /// Whether `line` can be on while all of `given` are.
    pub(crate) fn ask(&mut self, line: Line, given: &[Line]) -> Answer {
        if line == OFF || given.contains(&OFF) {
            return Answer::Never;
        }
        let assumed: Vec<Lit> = given.iter().chain([&line]).map(|line| self.variable(*line)).collect();
        self.steps.set(self.patience);
        let answer = self.solver.solve_limited(&assumed);
        if answer == lbool::FALSE {
            Answer::Never
        } else if answer == lbool::TRUE {
            Answer::Values(self.values())
        } else {
            Answer::Open
        }
    }

    /// All nodes from the inputs of the solver's last answer.
    fn values(&self) -> Vec<bool> {
        self.with(&|node| {
            self.variables.get(&node).is_some_and(|variable| self.solver.value_var(*variable) == lbool::TRUE)
        })
    }

    /// All nodes with these inputs; the others are off.
    pub(crate) fn evaluate(&self, inputs: &HashMap<Line, bool>) -> Vec<bool> {
        self.with(&|node| inputs.get(&(node << 1)).copied().unwrap_or(false))
    }

    fn with(&self, input: &dyn Fn(u32) -> bool) -> Vec<bool> {
        let mut values = vec![false];
        self.more(&mut values, input);
        values
    }

    /// Adds the values of nodes that are new since; new inputs are off.
    pub(crate) fn extend(&self, values: &mut Vec<bool>) {
        self.more(values, &|_| false);
    }

    fn more(&self, values: &mut Vec<bool>, input: &dyn Fn(u32) -> bool) {
        for (node, sides) in (0u32..).zip(&self.nodes).skip(values.len()) {
            values.push(match sides {
                None => input(node),
                Some((a, b)) => value(values, *a) && value(values, *b),
            });
        }
    }
}

/// A solver that stops when no steps are left.
fn solver(steps: &Rc<Cell<u64>>) -> BasicSolver {
    let mut solver = BasicSolver::default();
    let left = Rc::clone(steps);
    solver.cb_mut().set_stop(move || {
        left.set(left.get().saturating_sub(1));
        left.get() == 0
    });
    solver
}

/// The value of a line.
pub(crate) fn value(values: &[bool], line: Line) -> bool {
    values.get((line >> 1) as usize).copied().unwrap_or(false) != (line & 1 == 1)
}
