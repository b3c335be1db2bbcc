//! Spans sorted by place, so that a lookup costs the size of its answer.

use std::ops::ControlFlow;

use crate::space::{Area, Key, Spaces};

use super::Level;
use instr::Role;

/// One stretch of data that one use of an operand touches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) area: Area,
    pub(crate) role: Role,
    /// Touched whenever the instruction does its work; otherwise perhaps.
    pub(crate) definite: bool,
    pub(crate) level: Level,
    /// Index of the use.
    pub(crate) by: usize,
}

#[derive(Default)]
struct Bucket {
    /// First bit and number of each bounded span of at most one element, by first bit.
    narrow: Vec<(u64, u32)>,
    widest: u64,
    /// Numbers of ranges, open ends and repeated parts.
    wide: Vec<u32>,
    /// Spans found after sorting.
    late: Vec<Span>,
}

/// The numbers of all spans, one bucket per space. The spans themselves stay where they are, because
/// a large program has many.
pub(crate) struct Index {
    buckets: Vec<Bucket>,
}

impl Index {
    pub(crate) fn new(spans: &[Span], spaces: &Spaces<'_>) -> Index {
        let mut buckets: Vec<Bucket> = (0..spaces.len()).map(|_| Bucket::default()).collect();
        for (number, span) in (0_u32..).zip(spans) {
            let stride = spaces.stride(span.area.space);
            if let Some(bucket) = buckets.get_mut(span.area.space) {
                if span.area.bits <= stride && span.area.part.is_none() {
                    bucket.widest = bucket.widest.max(span.area.bits);
                    bucket.narrow.push((span.area.first, number));
                } else {
                    bucket.wide.push(number);
                }
            }
        }
        for bucket in &mut buckets {
            bucket.narrow.sort_unstable();
        }
        Index { buckets }
    }

    /// Adds a span that was found after sorting.
    pub(crate) fn add(&mut self, span: Span) {
        if let Some(bucket) = self.buckets.get_mut(span.area.space) {
            bucket.late.push(span);
        }
    }

    /// Calls `found` with every span that has a bit in common with `area`, those through an
    /// indirect file number included, until it says [`ControlFlow::Break`]. `spans` are those the
    /// index was made of. Returns how many spans were compared.
    pub(crate) fn overlapping(
        &self,
        spans: &[Span],
        spaces: &Spaces<'_>,
        area: Area,
        mut found: impl FnMut(&Span) -> ControlFlow<()>,
    ) -> usize {
        let mut compared = 0;
        let stride = spaces.stride(area.space);
        if self.in_space(spans, area, stride, &mut compared, &mut found).is_break() {
            return compared;
        }
        let Some(space) = spaces.get(area.space) else { return compared };
        let any_file = Key { number: None, slot: None, ..space.key };
        if any_file != space.key
            && let Some(any) = spaces.find(any_file)
        {
            let area = Area { space: any, ..area };
            let _ = self.in_space(spans, area, spaces.stride(any), &mut compared, &mut found);
        }
        compared
    }

    fn in_space(
        &self,
        spans: &[Span],
        area: Area,
        stride: u64,
        compared: &mut usize,
        found: &mut impl FnMut(&Span) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Some(bucket) = self.buckets.get(area.space) else { return ControlFlow::Continue(()) };
        let earliest = area.first.saturating_sub(bucket.widest);
        let start = bucket.narrow.partition_point(|(first, _)| *first < earliest);
        let near = bucket.narrow.iter().skip(start).take_while(|(first, _)| *first < area.end());
        let numbers = near.map(|(_, number)| number).chain(&bucket.wide);
        let indexed = numbers.filter_map(|number| spans.get(usize::try_from(*number).ok()?));
        for span in indexed.chain(&bucket.late) {
            *compared += 1;
            if span.area.overlaps(&area, stride) {
                found(span)?;
            }
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{OPEN, Part};
    use ladder::{Address, DataFile, FileType, Image};

    /// The sorted lookup finds what a comparison with every span finds.
    #[test]
    fn finds_what_a_full_scan_finds() {
        let image = Image { data_files: vec![DataFile::new(FileType::T, 4, 40)], ..Image::default() };
        let mut spaces = Spaces::new(&image);
        let space = spaces.place(&Address::element(FileType::T, 4, 0)).area.space;
        // A small linear congruential generator: the same areas in every run.
        let mut seed = 12_345_u64;
        let mut random = |below: u64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) % below
        };
        let mut area = || {
            let first = random(40 * 48);
            match random(10) {
                0 => Area { space, first, bits: OPEN, part: None },
                1 => {
                    let offset = random(47);
                    let bits = random(48 - offset) + 1;
                    Area { space, first: 0, bits: OPEN, part: Some(Part { offset, bits }) }
                }
                2 => Area { space, first, bits: 1 + random(400), part: None },
                _ => Area { space, first, bits: 1 + random(48), part: None },
            }
        };
        let spans: Vec<Span> = (0..150)
            .map(|by| Span { area: area(), role: Role::Read, definite: true, level: Level::Word, by })
            .collect();
        let index = Index::new(&spans, &spaces);
        for _ in 0..100 {
            let asked = area();
            let mut found = Vec::new();
            index.overlapping(&spans, &spaces, asked, |span| {
                found.push(span.by);
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            // Bit by bit, without the arithmetic of the areas.
            let has = |area: &Area, bit: u64| {
                bit >= area.first
                    && bit < area.end()
                    && area.part.is_none_or(|p| (p.offset..p.offset + p.bits).contains(&(bit % 48)))
            };
            let expected: Vec<usize> = spans
                .iter()
                .filter(|span| (0..60 * 48).any(|bit| has(&span.area, bit) && has(&asked, bit)))
                .map(|span| span.by)
                .collect();
            assert_eq!(found, expected, "{asked:?}");
        }
    }
}
