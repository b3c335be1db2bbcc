//! Numbers for random programs and data.
//!
//! Tests of other packages take this file in by its path: a failure told by its numbers is found again
//! anywhere.

/// xorshift64*: the same numbers on every machine. The seed must not be 0.
#[derive(Clone, Debug)]
pub struct Dice(pub u64);

impl Dice {
    /// 48 bits.
    #[allow(clippy::should_implement_trait, reason = "never at an end")]
    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 16
    }

    /// Any word.
    pub fn any(&mut self) -> u16 {
        self.next() as u16
    }

    /// A number below `limit`, which is not 0.
    pub fn below(&mut self, limit: u64) -> u64 {
        self.next() % limit
    }

    /// One of a list that is not empty.
    pub fn pick<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len() as u64) as usize]
    }
}
