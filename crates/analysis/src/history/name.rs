//! What a file name says: the program's name, the backup number, a date.

/// A file name taken apart.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Name {
    /// The name without ending, backup numbers and marks of copies, as it is written.
    pub shown: String,
    /// The same for comparing: upper case, blanks as `_`.
    pub stem: String,
    /// The number of the last `_BAKnnn` at the end of the name.
    pub backup: Option<u32>,
    /// A date in the name: `2021-04-05`.
    pub date: Option<String>,
}

const MONTHS: [&str; 12] = ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];

impl Name {
    /// Takes a file name apart; folders before it are not looked at.
    ///
    /// ```
    /// use analysis::history::Name;
    ///
    /// let name = Name::of("Pump 3_BAK012.RSS");
    /// assert_eq!((name.stem.as_str(), name.backup), ("PUMP_3", Some(12)));
    /// ```
    pub fn of(file: &str) -> Name {
        let file = file.rsplit(['/', '\\']).next().unwrap_or(file);
        let mut shown = ["rss", "slc", "json"].iter().find_map(|ending| without_ending(file, ending)).unwrap_or(file);
        let mut backup = None;
        // A backup opened and saved again gets a second number; the last one is that of this save.
        while let Some((before, number)) = backup_number(shown) {
            backup = backup.or(Some(number));
            shown = before;
        }
        let shown = without_copy(shown);
        let stem = shown.trim().to_uppercase().replace([' ', '-', '.'], "_");
        Name { date: date(shown), shown: shown.to_owned(), stem, backup }
    }
}

fn without_ending<'a>(file: &'a str, ending: &str) -> Option<&'a str> {
    let (before, last) = file.rsplit_once('.')?;
    (last.eq_ignore_ascii_case(ending) && !before.is_empty()).then_some(before)
}

/// `X_BAK012`, `X.BAK012`: what stands before, and the number.
fn backup_number(name: &str) -> Option<(&str, u32)> {
    let digits = name.len() - name.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    let (before, number) = name.split_at_checked(name.len() - digits)?;
    let number = number.parse().ok()?;
    let before = before
        .get(..before.len().checked_sub(3)?)
        .filter(|start| before.get(start.len()..).is_some_and(|mark| mark.eq_ignore_ascii_case("BAK")))?;
    let stem = before.strip_suffix(['_', '.', ' ', '-'])?;
    (!stem.is_empty()).then_some((stem, number))
}

/// Without `Copy of ` and `Copy (2) of ` at its start, as older versions of Windows name copies.
fn without_copy_of(name: &str) -> Option<&str> {
    const BLANK: [char; 2] = [' ', '_'];
    let word = |text: &str, word: &str| -> Option<usize> {
        text.get(..word.len()).filter(|start| start.eq_ignore_ascii_case(word)).map(str::len)
    };
    let mut rest = name.get(word(name, "copy")?..)?.strip_prefix(BLANK)?;
    if let Some((number, after)) = rest.strip_prefix('(').and_then(|inside| inside.split_once(')'))
        && !number.is_empty()
        && number.chars().all(|c| c.is_ascii_digit())
    {
        rest = after.strip_prefix(BLANK)?;
    }
    let rest = rest.get(word(rest, "of")?..)?.strip_prefix(BLANK)?.trim_start();
    (!rest.is_empty()).then_some(rest)
}

/// Without `Copy of ` at its start, ` - Copy`, `_-_Copy`, `(2)` at its end.
fn without_copy(name: &str) -> &str {
    let mut rest = name.trim_end();
    while let Some(inner) = without_copy_of(rest) {
        rest = inner;
    }
    loop {
        let before = rest;
        if let Some(inside) = rest.strip_suffix(')')
            && let Some((start, number)) = inside.rsplit_once('(')
            && !number.is_empty()
            && number.chars().all(|c| c.is_ascii_digit())
        {
            rest = start.trim_end();
        }
        let cut = rest.len().saturating_sub(4);
        if rest.get(cut..).is_some_and(|end| end.eq_ignore_ascii_case("copy"))
            && let Some(start) = rest.get(..cut)
        {
            let start_cut = start.trim_end_matches(['_', '-', ' ']);
            // A mark stands before the word; `PHOTOCOPY` is a name.
            if start_cut.len() < start.len() && !start_cut.is_empty() {
                rest = start_cut;
            }
        }
        if rest.is_empty() {
            return name;
        }
        if rest == before {
            return rest;
        }
    }
}

/// The last date in a name: `Apr_05_2021`, `9-12-2016` (month first, as the program's own country writes
/// it), `20230715`.
fn date(name: &str) -> Option<String> {
    let words: Vec<&str> = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let number = |word: &str| -> Option<u32> { word.parse().ok() };
    let year = |word: &str| number(word).filter(|year| word.len() == 4 && (1990..2100).contains(year));
    let written = |year: u32, month: u32, day: u32| {
        ((1..=12).contains(&month) && (1..=31).contains(&day)).then(|| format!("{year:04}-{month:02}-{day:02}"))
    };
    let month = |word: &str| match number(word) {
        Some(number) => Some(number),
        None => {
            let start = word.get(..3)?.to_ascii_lowercase();
            let index = MONTHS.iter().position(|month| *month == start)?;
            u32::try_from(index + 1).ok()
        }
    };
    let three = words.windows(3).filter_map(|window| match window {
        [a, b, c] => match (year(a), year(c)) {
            (_, Some(year)) => written(year, month(a)?, number(b)?),
            (Some(year), _) => written(year, month(b)?, number(c)?),
            _ => None,
        },
        _ => None,
    });
    let one = words.iter().filter(|word| word.len() == 8).filter_map(|word| {
        let part = |range| word.get(range).and_then(number);
        written(part(0..4).filter(|year| (1990..2100).contains(year))?, part(4..6)?, part(6..8)?)
    });
    three.chain(one).last()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_what_saving_and_copying_add() {
        for (file, stem, backup, date) in [
            ("CCHDUMP_BAK003.RSS", "CCHDUMP", Some(3), None),
            ("cchdump.rss", "CCHDUMP", None, None),
            ("PUMP.BAK012.RSS", "PUMP", Some(12), None),
            ("A_BAK0_CURRENT_BAK017_BAK018.RSS", "A_BAK0_CURRENT", Some(18), None),
            ("JBT_BIN_Original_-_Copy.RSS", "JBT_BIN_ORIGINAL", None, None),
            ("line (2).RSS", "LINE", None, None),
            ("DUMP_APR_05_2021_BAK071.RSS", "DUMP_APR_05_2021", Some(71), Some("2021-04-05")),
            ("EDINBURG_11-17-2016.RSS", "EDINBURG_11_17_2016", None, Some("2016-11-17")),
            ("20230715_MicroLogix.RSS", "20230715_MICROLOGIX", None, Some("2023-07-15")),
            ("_BAK001.RSS", "_BAK001", None, None),
            ("copy.RSS", "COPY", None, None),
            ("Copy of Pump 3.RSS", "PUMP_3", None, None),
            ("COPY_OF_PUMP_3_BAK004.RSS", "PUMP_3", Some(4), None),
            ("Copy (2) of Copy of Pump.RSS", "PUMP", None, None),
            ("Copy of.RSS", "COPY_OF", None, None),
            ("Copy office.RSS", "COPY_OFFICE", None, None),
            (".RSS", "_RSS", None, None),
            ("x/../y.RSS", "Y", None, None),
        ] {
            let name = Name::of(file);
            let found = (name.stem.as_str(), name.backup, name.date.as_deref());
            assert_eq!(found, (stem, backup, date), "{file}");
        }
    }
}
