//! What a converted program says about the rungs it was made from.

use super::RungFate;

/// Reads the comments a migration leaves above each rung (`SLC 2:14  XIC ...`, `condition: ...`,
/// `person: ...`). `None`: no rung says where it comes from.
pub fn fates(project: &domore::Project) -> Option<Vec<RungFate>> {
    let mut fates = Vec::new();
    for rung in project.code_blocks().flat_map(|block| &block.rungs) {
        let lines = rung.comment.iter().flat_map(|comment| &comment.lines);
        let (mut place, mut person, mut conditions) = (None, None, Vec::new());
        for line in lines {
            if let Some(reason) = line.strip_prefix("person: ") {
                person = Some(reason.to_owned());
            } else if let Some(condition) = line.strip_prefix("condition: ") {
                conditions.push(condition.to_owned());
            } else if let Some(found) = origin(line) {
                // The mark is the last line of a comment: what a person wrote above it does not count.
                place = Some(found);
            }
        }
        if let Some((file, rung)) = place {
            fates.push(RungFate { file, rung, person, conditions });
        }
    }
    (!fates.is_empty()).then_some(fates)
}

/// `SLC 2:14  ...`.
fn origin(line: &str) -> Option<(u16, u32)> {
    let mark = line.strip_prefix("SLC ")?.split(' ').next()?;
    let (file, rung) = mark.split_once(':')?;
    Some((file.parse().ok()?, rung.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_read_and_other_comments_are_not() {
        let text = "$PRGRM $Main\n\n#BEGIN COMMENT\n\"Pump\"\n\"condition: X: y\"\n\"SLC 2:3  XIC B3:0/0\"\n#END\nSTR C0\nOUT C1\n\n\
                    #BEGIN COMMENT\n\"person: MSG: no\"\n\"SLC 2:4  MSG\"\n#END\nNOP\n\n#BEGIN COMMENT\n\"own\"\n#END\nNOP\n\n\
                    $PGMEND $Main\n";
        let project = domore::text::read(text).expect("reads").project;
        let found = fates(&project).expect("marks");
        let place = |fate: &RungFate| (fate.file, fate.rung, fate.person.is_some(), fate.conditions.len());
        assert_eq!(found.iter().map(place).collect::<Vec<_>>(), [(2, 3, false, 1), (2, 4, true, 0)]);
        let plain = domore::text::read("$PRGRM $Main\n\nSTR C0\nOUT C1\n\n$PGMEND $Main\n").expect("reads").project;
        assert_eq!(fates(&plain), None);
    }
}
