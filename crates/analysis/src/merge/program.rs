//! Ladder files and their rungs.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Comment, Image, ProgramFile, ProgramFileKind, Rung};

use super::{Conflict, MergedFile, MergedRung, Piece, RungConflict, Side, Three, decide, text};
use crate::diff::{ChangeKind, Difference, Equality, LogicChange, Place, Word};

/// What a side did to the base.
type Matched = (Difference, Vec<(Place, Place)>);

pub(super) fn merge(
    three: Three<'_>,
    sides: (&Matched, &Matched),
    image: &mut Image,
    conflicts: &mut Vec<Conflict>,
) -> Vec<MergedFile> {
    renames(sides, conflicts);
    let mut merger = Merger {
        three,
        equality: Equality::default(),
        ours: sides.0.1.iter().copied().collect(),
        theirs: sides.1.1.iter().copied().collect(),
    };
    let numbers: BTreeSet<u16> =
        [three.base, three.ours, three.theirs].iter().flat_map(|i| i.ladder_files()).map(|f| f.number).collect();
    let mut files = Vec::new();
    for number in numbers {
        files.extend(merger.file(number, conflicts));
    }
    doubled(sides, &files, conflicts);
    assemble(three, &files, image, conflicts);
    files
}

/// Rungs that merging would leave twice, or bring back: moved by both sides, moved by one and taken out by the
/// other, or inserted by both at different places.
fn doubled(sides: (&Matched, &Matched), files: &[MergedFile], conflicts: &mut Vec<Conflict>) {
    let result: BTreeSet<(Side, Place)> = files
        .iter()
        .flat_map(|file| &file.pieces)
        .filter_map(|piece| match piece {
            Piece::Rung(rung) => Some((rung.side, rung.at)),
            Piece::Conflict(_) => None,
        })
        .collect();
    let rungs = |matched: &'_ Matched, kind: ChangeKind| -> Vec<(Option<Place>, Option<Place>, String)> {
        let rungs = matched.0.logic.iter().filter_map(|change| match change {
            LogicChange::Rung(rung) if rung.kind == kind => Some(rung),
            _ => None,
        });
        let text = |words: &[Word]| words.iter().map(|word| word.text.as_str()).collect::<Vec<_>>().join(" ");
        rungs.map(|rung| (rung.old, rung.new, text(&rung.new_words))).collect()
    };
    let shown = |at: Option<Place>| at.map(|at| format!("rung {}:{}", at.file, at.rung));
    let mut tell = |what: &str, base: Option<Place>, ours: Option<Place>, theirs: Option<Place>| {
        conflicts.push(Conflict { what: what.to_owned(), base: shown(base), ours: shown(ours), theirs: shown(theirs) });
    };
    let both = |ours: Option<Place>, theirs: Option<Place>| {
        let has = |side, at: Option<Place>| at.is_some_and(|at| result.contains(&(side, at)));
        has(Side::Ours, ours) && has(Side::Theirs, theirs)
    };
    let moved = [sides.0, sides.1].map(|matched| rungs(matched, ChangeKind::Moved));
    let gone = [sides.0, sides.1].map(|matched| rungs(matched, ChangeKind::Deleted));
    let by_old = |list: &[(Option<Place>, Option<Place>, String)]| -> BTreeMap<Option<Place>, Option<Place>> {
        list.iter().map(|(old, new, _)| (*old, *new)).collect()
    };
    let [ours_gone, theirs_moved, theirs_gone] = [by_old(&gone[0]), by_old(&moved[1]), by_old(&gone[1])];
    for (old, new, _) in &moved[0] {
        if let Some(other) = theirs_moved.get(old).filter(|other| both(*new, **other)) {
            tell("both sides moved a rung, to different places", *old, *new, *other);
        }
        if theirs_gone.contains_key(old) {
            tell("ours moved a rung that theirs took out", *old, *new, None);
        }
    }
    for (old, new, _) in &moved[1] {
        if ours_gone.contains_key(old) {
            tell("theirs moved a rung that ours took out", *old, None, *new);
        }
    }
    let inserted = [sides.0, sides.1].map(|matched| rungs(matched, ChangeKind::Inserted));
    let texts: BTreeMap<&str, Option<Place>> = inserted[0].iter().map(|(_, new, text)| (text.as_str(), *new)).collect();
    for (_, new, text) in inserted[1].iter().filter(|(_, _, text)| !text.is_empty() && text != "END") {
        if let Some(ours) = texts.get(text.as_str()).filter(|ours| both(**ours, *new)) {
            tell("both sides inserted the same rung, at different places", None, *ours, *new);
        }
    }
}

/// Numbers and addresses that one side replaced throughout, where the other side's rungs have the old ones.
fn renames(sides: (&Matched, &Matched), conflicts: &mut Vec<Conflict>) {
    let touched = |matched: &Matched| matched.0.logic.iter().any(|_| true);
    for (one, other, names) in [(sides.0, sides.1, ["ours", "theirs"]), (sides.1, sides.0, ["theirs", "ours"])] {
        for change in &one.0.logic {
            if let LogicChange::File(file) = change
                && file.kind == ChangeKind::Moved
                && touched(other)
            {
                let number = |number: Option<u16>| number.map(|number| format!("program file {number}"));
                let what = format!("{} renumbered a program file, {} changed the program", names[0], names[1]);
                conflicts.push(Conflict { what, base: number(file.old), ours: number(file.new), theirs: None });
            }
        }
        for rename in &one.0.renames {
            let is_part = |word: &Word| {
                let rest = word.text.trim_start_matches('#').strip_prefix(rename.old.as_str());
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['/', '.']))
            };
            let used = other.0.logic.iter().find_map(|change| match change {
                LogicChange::Rung(rung) if rung.new_words.iter().any(is_part) => rung.new,
                _ => None,
            });
            if let Some(at) = used {
                conflicts.push(Conflict {
                    what: format!(
                        "{} is now {} in {}; rung {}:{} of {} was changed and uses {}",
                        rename.old, rename.new, names[0], at.file, at.rung, names[1], rename.old
                    ),
                    base: Some(rename.old.clone()),
                    ours: Some(if names[0] == "ours" { rename.new.clone() } else { rename.old.clone() }),
                    theirs: Some(if names[0] == "ours" { rename.old.clone() } else { rename.new.clone() }),
                });
            }
        }
    }
}

struct Merger<'a> {
    three: Three<'a>,
    equality: Equality,
    /// Base to ours, base to theirs: rungs that kept their order.
    ours: BTreeMap<Place, Place>,
    theirs: BTreeMap<Place, Place>,
}

fn ladder_file(image: &Image, number: u16) -> Option<&ProgramFile> {
    image.ladder_files().find(|file| file.number == number)
}

fn rung(image: &Image, at: Place) -> Option<&Rung> {
    ladder_file(image, at.file)?.rungs.get(at.rung)
}

/// Title and text; where a comment hangs follows from its rung.
fn content(comment: Option<&Comment>) -> Option<(&str, &str)> {
    comment.map(|comment| (comment.title.as_str(), comment.text.as_str())).filter(|both| *both != ("", ""))
}

impl Merger<'_> {
    fn same(&mut self, a: (&Image, Place), b: (&Image, Place)) -> bool {
        let of = |(image, at): (&'_ Image, Place)| -> bool { rung(image, at).is_some() };
        if !of(a) || !of(b) {
            return of(a) == of(b);
        }
        self.equality.same(rung(a.0, a.1).map(|r| (a.0, r)), rung(b.0, b.1).map(|r| (b.0, r)))
    }

    /// The same rungs with the same comments, one after the other.
    fn all_same(&mut self, a: (&Image, &[Place]), b: (&Image, &[Place])) -> bool {
        let comment = |image, at| content(rung(image, at).and_then(|rung| rung.comment.as_ref()));
        a.1.len() == b.1.len()
            && a.1.iter().zip(b.1).all(|(x, y)| comment(a.0, *x) == comment(b.0, *y) && self.same((a.0, *x), (b.0, *y)))
    }

    /// A file of the result, `None` if it is gone.
    fn file(&mut self, number: u16, conflicts: &mut Vec<Conflict>) -> Option<MergedFile> {
        let Three { base, ours, theirs } = self.three;
        let found = [base, ours, theirs].map(|image| ladder_file(image, number));
        let places = |file: &ProgramFile| -> Vec<Place> {
            (0..file.rungs.len()).map(|rung| Place { file: number, rung }).collect()
        };
        let all = |file: Option<&ProgramFile>| file.map(places).unwrap_or_default();
        let (b, o, t) = (all(found[0]), all(found[1]), all(found[2]));
        let whole = |side: Side, places: &[Place], image: &Image| MergedFile {
            number,
            side,
            pieces: places.iter().map(|at| Piece::Rung(merged(side, image, *at))).collect(),
        };
        match found.map(|file| file.is_some()) {
            [_, true, false] | [_, false, true] => {
                let (side, image, left) =
                    if found[1].is_some() { (Side::Ours, ours, &o) } else { (Side::Theirs, theirs, &t) };
                // Gone on the other side: only if nothing was changed here.
                if found[0].is_none() {
                    return Some(whole(side, left, image));
                }
                if self.all_same((base, &b), (image, left)) {
                    return None;
                }
                conflicts.push(Conflict {
                    what: format!("program file {number} was deleted on one side and changed on the other"),
                    base: Some(format!("{} rungs", b.len())),
                    ours: found[1].map(|file| format!("{} rungs", file.rungs.len())),
                    theirs: found[2].map(|file| format!("{} rungs", file.rungs.len())),
                });
                Some(whole(side, left, image))
            }
            [false, true, true] => {
                if self.all_same((ours, &o), (theirs, &t)) {
                    return Some(whole(Side::Ours, &o, ours));
                }
                let why = "both sides added this program file, with other rungs";
                let conflict = RungConflict { why, base: Vec::new(), ours: o, theirs: t };
                Some(MergedFile { number, side: Side::Ours, pieces: vec![Piece::Conflict(conflict)] })
            }
            [true, true, true] => Some(MergedFile { number, side: Side::Ours, pieces: self.rungs(&b, &o, &t) }),
            _ => None,
        }
    }

    /// Rungs between rungs that both sides kept in their order.
    fn rungs(&mut self, b: &[Place], o: &[Place], t: &[Place]) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let (mut i, mut j, mut k) = (0, 0, 0);
        for (n, at) in b.iter().enumerate() {
            let (Some(p), Some(q)) = (self.ours.get(at).copied(), self.theirs.get(at).copied()) else { continue };
            let (Some(first), Some(second)) = (o.first(), t.first()) else { continue };
            // A file with another number is a conflict of its own.
            if p.file != first.file || q.file != second.file || p.rung < j || q.rung < k {
                continue;
            }
            pieces.extend(self.gap(
                b.get(i..n).unwrap_or_default(),
                o.get(j..p.rung).unwrap_or_default(),
                t.get(k..q.rung).unwrap_or_default(),
            ));
            pieces.push(self.kept(*at, p, q));
            (i, j, k) = (n + 1, p.rung + 1, q.rung + 1);
        }
        pieces.extend(self.gap(
            b.get(i..).unwrap_or_default(),
            o.get(j..).unwrap_or_default(),
            t.get(k..).unwrap_or_default(),
        ));
        pieces
    }

    /// A rung that is on all sides.
    fn kept(&mut self, b: Place, o: Place, t: Place) -> Piece {
        let Three { base, ours, theirs } = self.three;
        let conflict = |why| Piece::Conflict(RungConflict { why, base: vec![b], ours: vec![o], theirs: vec![t] });
        let side = if self.same((ours, o), (theirs, t)) || self.same((base, b), (theirs, t)) {
            Side::Ours
        } else if self.same((base, b), (ours, o)) {
            Side::Theirs
        } else {
            return conflict("both sides changed this rung");
        };
        let comment = |image, at| rung(image, at).and_then(|rung| rung.comment.as_ref());
        let (x, y, z) = (comment(base, b), comment(ours, o), comment(theirs, t));
        let comment = match decide(&content(x), &content(y), &content(z)) {
            Some(Side::Ours) => y,
            Some(Side::Theirs) => z,
            None => return conflict("both sides changed the comment of this rung"),
        };
        let at = if side == Side::Ours { o } else { t };
        Piece::Rung(MergedRung { side, at, comment: comment.cloned() })
    }

    /// Rungs between two kept ones: what only one side touched is taken.
    fn gap(&mut self, b: &[Place], o: &[Place], t: &[Place]) -> Vec<Piece> {
        let Three { base, ours, theirs } = self.three;
        let all = |side, image: &Image, places: &[Place]| -> Vec<Piece> {
            places.iter().map(|at| Piece::Rung(merged(side, image, *at))).collect()
        };
        if self.all_same((base, b), (theirs, t)) || self.all_same((ours, o), (theirs, t)) {
            all(Side::Ours, ours, o)
        } else if self.all_same((base, b), (ours, o)) {
            all(Side::Theirs, theirs, t)
        } else {
            let why = match (b.is_empty(), o.is_empty() || t.is_empty()) {
                (true, _) => "both sides inserted rungs here: their order is the order of the scan",
                (false, true) => "one side took out or moved rungs that the other side touched",
                _ => "both sides changed the rungs here",
            };
            vec![Piece::Conflict(RungConflict { why, base: b.to_vec(), ours: o.to_vec(), theirs: t.to_vec() })]
        }
    }
}

fn merged(side: Side, image: &Image, at: Place) -> MergedRung {
    MergedRung { side, at, comment: rung(image, at).and_then(|rung| rung.comment.clone()) }
}

/// The program files of the result. Where a conflict is, ours stands.
fn assemble(three: Three<'_>, files: &[MergedFile], image: &mut Image, conflicts: &mut Vec<Conflict>) {
    let Three { base, ours, theirs } = three;
    let mut result: BTreeMap<u16, ProgramFile> = BTreeMap::new();
    // System files and free numbers as ours has them, then what only theirs has.
    for file in theirs.program_files.iter().chain(&ours.program_files) {
        if file.kind != ProgramFileKind::Ladder {
            result.insert(file.number, file.clone());
        }
    }
    // A number whose ladder is gone on both sides or taken out by one is free.
    let last = [ours, theirs].iter().flat_map(|i| &i.program_files).map(|f| f.number).max().unwrap_or(2);
    for merged in files {
        let mut rungs = Vec::new();
        for piece in &merged.pieces {
            match piece {
                Piece::Rung(found) => {
                    let from = if found.side == Side::Ours { ours } else { theirs };
                    let logic = rung(from, found.at).cloned().unwrap_or_default();
                    rungs.push(Rung { comment: found.comment.clone(), ..logic });
                }
                Piece::Conflict(conflict) => {
                    rungs.extend(conflict.ours.iter().filter_map(|at| rung(ours, *at).cloned()))
                }
            }
        }
        let number = merged.number;
        let of = |image| ladder_file(image, number);
        let mut part = |what: &str, of: fn(&ProgramFile) -> &str| {
            let all = [base, ours, theirs].map(|image| ladder_file(image, number).map(of));
            text(|| format!("{what} of program file {number}"), all, conflicts)
        };
        let name = part("name", |file| &file.name);
        let description = part("description", |file| &file.description);
        let fallback = of(ours).or_else(|| of(theirs));
        result.insert(
            number,
            ProgramFile {
                number,
                name: name.or_else(|| fallback.map(|file| file.name.clone())).unwrap_or_default(),
                description: description.or_else(|| fallback.map(|file| file.description.clone())).unwrap_or_default(),
                kind: ProgramFileKind::Ladder,
                rungs,
            },
        );
    }
    for number in 0..=last {
        result.entry(number).or_insert_with(|| ProgramFile {
            number,
            name: String::new(),
            description: String::new(),
            kind: ProgramFileKind::Unused,
            rungs: Vec::new(),
        });
    }
    image.program_files = result.into_values().collect();
}
