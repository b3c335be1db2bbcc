//! Whole numbers as lines: two's complement, the least bit first, the last bit the sign.

use super::gates::{Gates, Line, OFF, ON};

pub(crate) type Word = Vec<Line>;

/// Without bits that only repeat the sign.
fn short(mut word: Word) -> Word {
    while word.len() > 1 && word[word.len() - 1] == word[word.len() - 2] {
        word.pop();
    }
    word
}

pub(crate) fn bit(word: &[Line], index: usize) -> Line {
    word.get(index).or(word.last()).copied().unwrap_or(OFF)
}

pub(crate) fn constant(value: i64) -> Word {
    short((0..64).map(|bit| if value >> bit & 1 == 1 { ON } else { OFF }).collect())
}

/// The number, if it is one.
pub(crate) fn fixed(word: &[Line]) -> Option<i64> {
    word.iter()
        .all(|line| *line < 2)
        .then(|| (0..64).fold(0i64, |value, index| value | i64::from(bit(word, index) & 1) << index))
}

/// From bits with a sign of their own, or without.
pub(crate) fn of_bits(mut bits: Vec<Line>, signed: bool) -> Word {
    if !signed {
        bits.push(OFF);
    }
    short(bits)
}

/// The least and greatest number that it can be, from its fixed bits alone.
pub(crate) fn ends(word: &[Line]) -> (i64, i64) {
    let (mut least, mut most) = (0i64, 0i64);
    for (index, line) in word.iter().enumerate() {
        let weight = if index + 1 == word.len() { -(1i64 << index) } else { 1i64 << index };
        match *line {
            OFF => {}
            ON => (least, most) = (least + weight, most + weight),
            _ if weight < 0 => least += weight,
            _ => most += weight,
        }
    }
    (least, most)
}

/// The low bits as a number of that size.
pub(crate) fn wrapped(word: &[Line], bits: usize) -> Word {
    short((0..bits).map(|index| bit(word, index)).collect())
}

impl Gates {
    pub(crate) fn choose_word(&mut self, select: Line, on: &[Line], off: &[Line]) -> Word {
        let length = on.len().max(off.len());
        short((0..length).map(|index| self.choose(select, bit(on, index), bit(off, index))).collect())
    }

    fn sum(&mut self, a: &[Line], b: &[Line], mut carry: Line, invert: Line) -> Word {
        let mut word = Vec::new();
        for index in 0..a.len().max(b.len()) + 1 {
            let (x, y) = (bit(a, index), bit(b, index) ^ invert);
            let half = self.xor(x, y);
            word.push(self.xor(half, carry));
            let (both, through) = (self.and(x, y), self.and(half, carry));
            carry = self.or(both, through);
        }
        short(word)
    }

    pub(crate) fn add(&mut self, a: &[Line], b: &[Line]) -> Word {
        self.sum(a, b, OFF, 0)
    }

    pub(crate) fn subtract(&mut self, a: &[Line], b: &[Line]) -> Word {
        self.sum(a, b, ON, 1)
    }

    pub(crate) fn less(&mut self, a: &[Line], b: &[Line]) -> Line {
        let difference = self.subtract(a, b);
        bit(&difference, difference.len() - 1)
    }

    pub(crate) fn equal(&mut self, a: &[Line], b: &[Line]) -> Line {
        let mut same = ON;
        for index in 0..a.len().max(b.len()) {
            let differs = self.xor(bit(a, index), bit(b, index));
            same = self.and(same, differs ^ 1);
        }
        same
    }

    pub(crate) fn is_on(&mut self, word: &[Line]) -> Line {
        word.iter().fold(OFF, |on, line| self.or(on, *line))
    }

    /// Each bit of 32 on its own.
    pub(crate) fn bitwise(&mut self, a: &[Line], b: &[Line], gate: fn(&mut Gates, Line, Line) -> Line) -> Word {
        short((0..32).map(|index| gate(self, bit(a, index), bit(b, index))).collect())
    }

    /// A product with a constant factor.
    pub(crate) fn times(&mut self, word: &[Line], factor: i64) -> Word {
        let mut product = constant(0);
        for shift in (0..63).filter(|shift| factor.unsigned_abs() >> shift & 1 == 1) {
            let mut part = vec![OFF; shift];
            part.extend(word);
            product = self.add(&product, &part);
        }
        if factor < 0 { self.subtract(&constant(0), &product) } else { product }
    }

    /// Quotient towards zero and remainder with the sign of the dividend, of a divisor above zero.
    pub(crate) fn divide(&mut self, word: &[Line], divisor: i64) -> (Word, Word) {
        let sign = bit(word, word.len() - 1);
        let negated = self.subtract(&constant(0), word);
        let size = self.choose_word(sign, &negated, word);
        let divisor = constant(divisor);
        let (mut rest, mut quotient) = (constant(0), vec![OFF; size.len() + 1]);
        for index in (0..size.len()).rev() {
            let mut shifted = vec![bit(&size, index)];
            shifted.extend(&rest);
            let below = self.less(&shifted, &divisor);
            let reduced = self.subtract(&shifted, &divisor);
            rest = self.choose_word(below, &shifted, &reduced);
            quotient[index] = below ^ 1;
        }
        let mut signed = |word: &[Line]| {
            let negated = self.subtract(&constant(0), word);
            self.choose_word(sign, &negated, word)
        };
        (signed(&short(quotient)), signed(&rest))
    }
}
