//! Boolean circuits as clauses, and numbers as rows of bits.

use std::collections::HashMap;

use batsat::{Callbacks, Lit, Solver, SolverInterface, SolverOpts, clause, lbool};

/// Ends a search after so many conflicts: an answer that takes longer is no answer.
#[derive(Default)]
struct Patience {
    left: u64,
}

impl Callbacks for Patience {
    fn on_new_clause(&mut self, _: &[Lit], source: clause::Kind) {
        if source == clause::Kind::Learnt {
            self.left = self.left.saturating_sub(1);
        }
    }

    fn stop(&self) -> bool {
        self.left == 0
    }
}

/// Conflicts of one search.
const PATIENCE: u64 = 20_000;

/// What a search found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    /// It is possible; values can be asked for.
    Possible,
    /// It is not.
    Impossible,
    /// The search took too long.
    Unknown,
}

/// Gates over the clauses they mean. Constants are folded, and a gate is made once.
pub(super) struct Gates {
    solver: Solver<Patience>,
    yes: Lit,
    pairs: HashMap<(Lit, Lit), Lit>,
}

/// A number, lowest bit first; the last bit is its sign.
pub(super) type Number = Vec<Lit>;

impl Gates {
    pub(super) fn new() -> Gates {
        let mut solver = Solver::new(SolverOpts::default(), Patience::default());
        let yes = Lit::new(solver.new_var_default(), true);
        solver.add_clause_reuse(&mut vec![yes]);
        Gates { solver, yes, pairs: HashMap::new() }
    }

    pub(super) fn yes(&self) -> Lit {
        self.yes
    }

    pub(super) fn no(&self) -> Lit {
        !self.yes
    }

    pub(super) fn constant(&self, on: bool) -> Lit {
        if on { self.yes } else { !self.yes }
    }

    /// Gates and free bits so far.
    pub(super) fn size(&self) -> usize {
        self.solver.num_vars() as usize
    }

    /// Something nothing is known about.
    pub(super) fn free(&mut self) -> Lit {
        Lit::new(self.solver.new_var_default(), true)
    }

    pub(super) fn clause(&mut self, literals: &[Lit]) {
        self.solver.add_clause_reuse(&mut literals.to_vec());
    }

    pub(super) fn and(&mut self, a: Lit, b: Lit) -> Lit {
        if a == self.no() || b == self.no() || a == !b {
            return self.no();
        }
        if a == self.yes || a == b {
            return b;
        }
        if b == self.yes {
            return a;
        }
        let key = (a.min(b), a.max(b));
        if let Some(found) = self.pairs.get(&key) {
            return *found;
        }
        let gate = self.free();
        self.clause(&[!gate, a]);
        self.clause(&[!gate, b]);
        self.clause(&[gate, !a, !b]);
        self.pairs.insert(key, gate);
        gate
    }

    pub(super) fn or(&mut self, a: Lit, b: Lit) -> Lit {
        !self.and(!a, !b)
    }

    pub(super) fn all(&mut self, literals: impl IntoIterator<Item = Lit>) -> Lit {
        literals.into_iter().fold(self.yes, |sum, next| self.and(sum, next))
    }

    /// `a` where the condition holds, `b` elsewhere.
    pub(super) fn choose(&mut self, condition: Lit, a: Lit, b: Lit) -> Lit {
        if a == b {
            return a;
        }
        let (with, without) = (self.and(condition, a), self.and(!condition, b));
        self.or(with, without)
    }

    pub(super) fn same(&mut self, a: Lit, b: Lit) -> Lit {
        let (both, neither) = (self.and(a, b), self.and(!a, !b));
        self.or(both, neither)
    }

    pub(super) fn number(&self, value: i64, width: usize) -> Number {
        (0..width).map(|bit| self.constant(value >> bit.min(63) & 1 != 0)).collect()
    }

    /// The same number with more bits.
    pub(super) fn wider(&self, number: &[Lit], width: usize) -> Number {
        let sign = number.last().copied().unwrap_or(self.no());
        (0..width).map(|bit| number.get(bit).copied().unwrap_or(sign)).collect()
    }

    pub(super) fn choose_number(&mut self, condition: Lit, a: &[Lit], b: &[Lit]) -> Number {
        a.iter().zip(b).map(|(a, b)| self.choose(condition, *a, *b)).collect()
    }

    pub(super) fn equal(&mut self, a: &[Lit], b: &[Lit]) -> Lit {
        let mut all = self.yes;
        for (a, b) in a.iter().zip(b) {
            let same = self.same(*a, *b);
            all = self.and(all, same);
        }
        all
    }

    /// `a < b` of signed numbers of one width.
    pub(super) fn less(&mut self, a: &[Lit], b: &[Lit]) -> Lit {
        let mut less = self.no();
        let last = a.len().saturating_sub(1);
        for (bit, (a, b)) in a.iter().zip(b).enumerate() {
            // The sign counts the other way round.
            let (low, high) = if bit == last { (*b, *a) } else { (*a, *b) };
            let (decides, same) = (self.and(!low, high), self.same(low, high));
            let kept = self.and(same, less);
            less = self.or(decides, kept);
        }
        less
    }

    /// The sum, as wide as `a`; what does not fit is lost.
    pub(super) fn add(&mut self, a: &[Lit], b: &[Lit], mut carry: Lit) -> Number {
        let mut sum = Vec::with_capacity(a.len());
        for (a, b) in a.iter().zip(b) {
            let same = self.same(*a, *b);
            sum.push(!self.same(!same, carry));
            carry = self.choose(same, *a, carry);
        }
        sum
    }

    /// Whether everything assumed can be true together.
    pub(super) fn ask(&mut self, assumed: &[Lit]) -> Answer {
        self.solver.cb_mut().left = PATIENCE;
        match self.solver.solve_limited(assumed) {
            answer if answer == lbool::TRUE => Answer::Possible,
            answer if answer == lbool::FALSE => Answer::Impossible,
            _ => Answer::Unknown,
        }
    }

    /// The value in what the last search found possible.
    pub(super) fn found(&self, literal: Lit) -> bool {
        self.solver.value_lit(literal) == lbool::TRUE
    }

    /// What the last search needed of what was assumed.
    pub(super) fn needed(&self, literal: Lit) -> bool {
        self.solver.unsat_core_contains_lit(!literal) || self.solver.unsat_core_contains_lit(literal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(gates: &Gates, number: &[Lit]) -> i64 {
        let bits = (0..).zip(number).map(|(bit, literal)| i64::from(gates.found(*literal)) << bit).sum::<i64>();
        let width = number.len() as u32;
        (bits << (64 - width)) >> (64 - width)
    }

    #[test]
    fn numbers_count_as_the_machine_does() {
        let mut gates = Gates::new();
        let (a, b): (Number, Number) = ((0..6).map(|_| gates.free()).collect(), (0..6).map(|_| gates.free()).collect());
        let carry = gates.no();
        let (sum, less, equal) = (gates.add(&a, &b, carry), gates.less(&a, &b), gates.equal(&a, &b));
        for x in -32..32i64 {
            for y in [-32, -31, -7, -1, 0, 1, 5, 31] {
                let (p, q) = (gates.number(x, 6), gates.number(y, 6));
                let pairs = a.iter().zip(&p).chain(b.iter().zip(&q));
                let assumed: Vec<Lit> =
                    pairs.map(|(free, bit)| if *bit == gates.yes() { *free } else { !*free }).collect();
                assert_eq!(gates.ask(&assumed), Answer::Possible);
                let wrapped = ((x + y + 32).rem_euclid(64)) - 32;
                assert_eq!(value(&gates, &sum), wrapped, "{x} + {y}");
                assert_eq!((gates.found(less), gates.found(equal)), (x < y, x == y), "{x} {y}");
            }
        }
    }
}
