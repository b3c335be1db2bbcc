//! Spans sorted by place, so that a lookup costs the size of its answer.

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
    /// Bounded spans of at most one element, by first bit.
    narrow: Vec<Span>,
    widest: u64,
    /// Ranges, open ends and repeated parts.
    wide: Vec<Span>,
}

/// All spans, one bucket per space.
pub(crate) struct Index {
    buckets: Vec<Bucket>,
}

impl Index {
    pub(crate) fn new(spans: &[Span], spaces: &Spaces<'_>) -> Index {
        let mut buckets: Vec<Bucket> = (0..spaces.len()).map(|_| Bucket::default()).collect();
        for span in spans {
            let stride = spaces.stride(span.area.space);
            if let Some(bucket) = buckets.get_mut(span.area.space) {
                if span.area.bits <= stride && span.area.part.is_none() {
                    bucket.widest = bucket.widest.max(span.area.bits);
                    bucket.narrow.push(*span);
                } else {
                    bucket.wide.push(*span);
                }
            }
        }
        for bucket in &mut buckets {
            bucket.narrow.sort_by_key(|span| span.area.first);
        }
        Index { buckets }
    }

    /// Adds a span that was found after sorting.
    pub(crate) fn add(&mut self, span: Span) {
        if let Some(bucket) = self.buckets.get_mut(span.area.space) {
            bucket.wide.push(span);
        }
    }

    /// Calls `found` with every span that has a bit in common with `area`, those through an
    /// indirect file number included.
    pub(crate) fn overlapping(&self, spaces: &Spaces<'_>, area: Area, mut found: impl FnMut(&Span)) {
        self.in_space(area, spaces.stride(area.space), &mut found);
        let Some(space) = spaces.get(area.space) else { return };
        let any_file = Key { number: None, slot: None, ..space.key };
        if any_file != space.key
            && let Some(any) = spaces.find(any_file)
        {
            self.in_space(Area { space: any, ..area }, spaces.stride(any), &mut found);
        }
    }

    fn in_space(&self, area: Area, stride: u64, found: &mut impl FnMut(&Span)) {
        let Some(bucket) = self.buckets.get(area.space) else { return };
        let earliest = area.first.saturating_sub(bucket.widest);
        let start = bucket.narrow.partition_point(|span| span.area.first < earliest);
        let near = bucket.narrow.iter().skip(start).take_while(|span| span.area.first < area.end());
        for span in near.chain(&bucket.wide) {
            if span.area.overlaps(&area, stride) {
                found(span);
            }
        }
    }
}
