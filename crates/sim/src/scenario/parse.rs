//! TOML text to a scenario, every error with its line and key.

use std::ops::Range;
use std::time::Duration;

use ladder::Family;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::literal::{Literal, digits};
use super::{Assignment, Edges, Length, Routine, Scenario, ScenarioError, Spot, Step, Subject, Target, parse_duration};

/// Time per scan when nothing is said.
const SCAN: Duration = Duration::from_millis(10);

/// Scans one step may ask for: more is asked by mistake only.
const MOST_SCANS: u64 = 10_000_000;

/// Scans all steps together may ask for.
const MOST_IN_ALL: u64 = 100_000_000;

const TOP: &[&str] = &["name", "source", "note", "program", "ladder", "family", "scan", "step"];
const STEP: &[&str] = &["note", "mode", "scan", "set", "edges", "scans", "run", "fault", "expect"];

type Result<T> = std::result::Result<T, ScenarioError>;
type Value<'a> = Spanned<DeValue<'a>>;

impl Scenario {
    /// Reads a scenario.
    ///
    /// # Errors
    /// The first key that does not belong or whose value is not what belongs there.
    pub fn parse(text: &str) -> Result<Scenario> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at).collect();
        let reader = Reader { text, breaks };
        let table = DeTable::parse(text).map_err(|error| ScenarioError {
            line: error.span().map_or(1, |span| reader.line(&span)),
            key: String::new(),
            message: error.message().to_owned(),
        })?;
        reader.scenario(table.get_ref())
    }
}

struct Reader<'a> {
    text: &'a str,
    /// Where its line breaks are: every value asks for its line.
    breaks: Vec<usize>,
}

impl Reader<'_> {
    fn line(&self, span: &Range<usize>) -> u32 {
        u32::try_from(self.breaks.partition_point(|at| *at < span.start)).unwrap_or(u32::MAX).saturating_add(1)
    }

    fn error(&self, value: &Value<'_>, key: &str, message: impl Into<String>) -> ScenarioError {
        ScenarioError { line: self.line(&value.span()), key: key.to_owned(), message: message.into() }
    }

    fn expected(&self, value: &Value<'_>, key: &str, what: &str) -> ScenarioError {
        self.error(value, key, format!("expected {what}, found {}", describe(value.get_ref())))
    }

    fn known(&self, table: &DeTable<'_>, path: &str, keys: &[&str]) -> Result<()> {
        for key in table.keys() {
            if !keys.contains(&key.get_ref().as_ref()) {
                return Err(ScenarioError {
                    line: self.line(&key.span()),
                    key: format!("{path}{}", key.get_ref()),
                    message: format!("there is no such key; expected one of {}", keys.join(", ")),
                });
            }
        }
        Ok(())
    }

    fn text(&self, value: &Value<'_>, key: &str) -> Result<String> {
        match value.get_ref() {
            DeValue::String(text) => Ok(text.to_string()),
            _ => Err(self.expected(value, key, "a string")),
        }
    }

    fn optional(&self, table: &DeTable<'_>, path: &str, key: &str) -> Result<Option<String>> {
        table.get(key).map(|value| self.text(value, &format!("{path}{key}"))).transpose()
    }

    fn table<'t, 'v>(&self, value: &'t Value<'v>, key: &str) -> Result<&'t DeTable<'v>> {
        match value.get_ref() {
            DeValue::Table(table) => Ok(table),
            _ => Err(self.expected(value, key, "a table { .. }")),
        }
    }

    fn whole(&self, value: &Value<'_>, key: &str, least: u64) -> Result<u64> {
        match value.get_ref() {
            DeValue::Integer(_) => match whole(value.get_ref()) {
                Some(number) if (least as i64..=MOST_SCANS as i64).contains(&number) => Ok(number as u64),
                _ => Err(self.expected(value, key, &format!("a number from {least} to {MOST_SCANS}"))),
            },
            _ => Err(self.expected(value, key, "a whole number")),
        }
    }

    fn duration(&self, value: &Value<'_>, key: &str) -> Result<Duration> {
        parse_duration(&self.text(value, key)?).map_err(|why| self.error(value, key, why))
    }

    fn scenario(&self, table: &DeTable<'_>) -> Result<Scenario> {
        self.known(table, "", TOP)?;
        let target = table.get("family").map(|value| self.target(value)).transpose()?;
        // What a text file is shows when it is opened; its addresses are read then.
        let addresses = match table.get("program").map(|value| value.get_ref()) {
            Some(DeValue::String(path)) if target.is_none() && path.to_ascii_lowercase().ends_with(".txt") => {
                Some(Target::DoMore)
            }
            _ => target,
        };
        let scan = table.get("scan").map(|value| self.duration(value, "scan")).transpose()?.unwrap_or(SCAN);
        if scan.is_zero() {
            return Err(ScenarioError { line: 1, key: "scan".into(), message: "expected a time above 0".into() });
        }
        let steps: Vec<Step> = match table.get("step") {
            None => Vec::new(),
            Some(value) => match value.get_ref() {
                DeValue::Array(steps) => {
                    let number = |(index, step)| self.step(step, index + 1, addresses, scan);
                    steps.iter().enumerate().map(number).collect::<Result<_>>()?
                }
                _ => return Err(self.expected(value, "step", "steps, each below a line [[step]]")),
            },
        };
        let mut total = 0;
        for (index, step) in steps.iter().enumerate() {
            total += scans_of(step, scan);
            if total > MOST_IN_ALL {
                let message = format!("with this step the scenario has more than {MOST_IN_ALL} scans");
                return Err(ScenarioError { line: step.line, key: format!("step[{}]", index + 1), message });
            }
        }
        if steps.is_empty() {
            let message = "expected at least one [[step]]".to_owned();
            return Err(ScenarioError { line: 1, key: "step".into(), message });
        }
        Ok(Scenario {
            name: self.optional(table, "", "name")?.unwrap_or_default(),
            source: self.sources(table)?,
            note: self.optional(table, "", "note")?,
            program: self.subject(table, target)?,
            target,
            scan,
            steps,
        })
    }

    fn sources(&self, table: &DeTable<'_>) -> Result<Vec<String>> {
        match table.get("source").map(|value| (value, value.get_ref())) {
            None => Ok(Vec::new()),
            Some((_, DeValue::Array(list))) => list.iter().map(|value| self.text(value, "source")).collect(),
            Some((value, _)) => Ok(vec![self.text(value, "source")?]),
        }
    }

    fn target(&self, value: &Value<'_>) -> Result<Target> {
        let name = self.text(value, "family")?;
        let lower = name.to_ascii_lowercase();
        if lower == "do-more" {
            return Ok(Target::DoMore);
        }
        match Family::from_id(&lower) {
            Some(family) if family != Family::Unknown => Ok(Target::Slc(family)),
            _ => {
                let known: Vec<_> = Family::all().filter(|f| *f != Family::Unknown).map(Family::id).collect();
                Err(self.error(
                    value,
                    "family",
                    format!("unknown family `{name}`; expected {} or do-more", known.join(", ")),
                ))
            }
        }
    }

    fn subject(&self, table: &DeTable<'_>, target: Option<Target>) -> Result<Subject> {
        match (table.get("program"), table.get("ladder")) {
            (Some(program), None) => {
                let value = self.text(program, "program")?;
                Ok(Subject::File(Spot { value, line: self.line(&program.span()) }))
            }
            (None, Some(ladder)) => self.inline(ladder, target).map(Subject::Inline),
            (Some(_), Some(ladder)) => Err(self.error(ladder, "ladder", "expected program or ladder, found both")),
            (None, None) => {
                let message = "expected program = \"FILE\" or ladder = \"RUNGS\"".to_owned();
                Err(ScenarioError { line: 1, key: "program".into(), message })
            }
        }
    }

    fn inline(&self, value: &Value<'_>, target: Option<Target>) -> Result<Vec<Routine>> {
        if let DeValue::String(text) = value.get_ref() {
            let main = if target == Some(Target::DoMore) { "$Main" } else { "2" };
            let name = Spot { value: main.to_owned(), line: self.line(&value.span()) };
            return Ok(vec![Routine { name, text: text.to_string(), line: self.text_line(value) }]);
        }
        let table = match value.get_ref() {
            DeValue::Table(table) => table,
            _ => return Err(self.expected(value, "ladder", "rungs as text, or a table of program files")),
        };
        let mut routines = Vec::new();
        for (key, value) in table {
            let path = format!("ladder.{}", key.get_ref());
            let name = Spot { value: key.get_ref().to_string(), line: self.line(&key.span()) };
            if target != Some(Target::DoMore) && !name.value.parse::<u16>().is_ok_and(|n| (2..=255).contains(&n)) {
                return Err(self.error(value, &path, "expected a program file number from 2 to 255 as key"));
            }
            routines.push(Routine { name, text: self.text(value, &path)?, line: self.text_line(value) });
        }
        Ok(routines)
    }

    /// The line the content of a string begins in: a line break right behind `"""` does not count.
    fn text_line(&self, value: &Value<'_>) -> u32 {
        let span = value.span();
        let written = self.text.get(span.clone()).unwrap_or("");
        let content = written.strip_prefix("\"\"\"").or(written.strip_prefix("'''"));
        let skips = content.is_some_and(|text| text.starts_with('\n') || text.starts_with("\r\n"));
        self.line(&span) + u32::from(skips)
    }

    fn step(&self, value: &Value<'_>, number: usize, target: Option<Target>, scan: Duration) -> Result<Step> {
        let path = format!("step[{number}].");
        let table = self.table(value, &format!("step[{number}]"))?;
        self.known(table, &path, STEP)?;
        let key = |name: &str| format!("{path}{name}");
        let program_run = match table.get("mode") {
            None => false,
            Some(mode) => match self.text(mode, &key("mode"))?.as_str() {
                "program-run" => true,
                _ => return Err(self.expected(mode, &key("mode"), "\"program-run\"")),
            },
        };
        let own = table.get("scan").map(|value| self.duration(value, &key("scan"))).transpose()?;
        if own.is_some_and(|own| own.is_zero())
            && let Some(value) = table.get("scan")
        {
            return Err(self.expected(value, &key("scan"), "a time above 0"));
        }
        let scan = own.unwrap_or(scan);
        let length = match (table.get("scans"), table.get("run")) {
            (None, None) => Length::None,
            (Some(scans), None) => Length::Scans(self.whole(scans, &key("scans"), 0)?),
            (None, Some(run)) => {
                let time = self.duration(run, &key("run"))?;
                if time.as_nanos() / scan.as_nanos().max(1) > u128::from(MOST_SCANS) {
                    return Err(self.error(run, &key("run"), format!("that is more than {MOST_SCANS} scans")));
                }
                Length::For(time)
            }
            (Some(_), Some(run)) => return Err(self.error(run, &key("run"), "expected scans or run, found both")),
        };
        Ok(Step {
            line: self.line(&value.span()),
            note: self.optional(table, &path, "note")?,
            program_run,
            scan: own,
            set: self.assignments(table.get("set"), &key("set"), target)?,
            edges: table.get("edges").map(|value| self.edges(value, &key("edges"), target)).transpose()?,
            length,
            fault: table.get("fault").map(|value| self.fault(value, &key("fault"))).transpose()?,
            expect: self.assignments(table.get("expect"), &key("expect"), target)?,
        })
    }

    fn edges(&self, value: &Value<'_>, path: &str, target: Option<Target>) -> Result<Edges> {
        let table = self.table(value, path)?;
        self.known(table, &format!("{path}."), &["bit", "count"])?;
        let Some(bit) = table.get("bit") else {
            return Err(self.error(value, path, "expected a bit: { bit = \"B3:0/0\", count = 3 }"));
        };
        let text = self.text(bit, &format!("{path}.bit"))?;
        let spot = Spot { value: text, line: self.line(&bit.span()) };
        self.address(&spot, &format!("{path}.bit"), target)?;
        let count = table.get("count").map(|count| self.whole(count, &format!("{path}.count"), 1)).transpose()?;
        Ok(Edges { bit: spot, count: count.unwrap_or(1) })
    }

    fn assignments(&self, value: Option<&Value<'_>>, path: &str, target: Option<Target>) -> Result<Vec<Assignment>> {
        let Some(value) = value else { return Ok(Vec::new()) };
        let mut found = Vec::new();
        for (key, value) in self.table(value, path)? {
            let address = Spot { value: key.get_ref().to_string(), line: self.line(&key.span()) };
            let path = format!("{path}.\"{}\"", address.value);
            self.address(&address, &path, target)?;
            let literal = match value.get_ref() {
                DeValue::Integer(_) => whole(value.get_ref()).map(Literal::Integer),
                DeValue::Float(number) => number.as_str().replace('_', "").parse().ok().map(Literal::Float),
                DeValue::Boolean(bit) => Some(Literal::Integer((*bit).into())),
                DeValue::String(text) => Some(Literal::Text(text.to_string())),
                _ => None,
            };
            let value = literal.ok_or_else(|| self.expected(value, &path, "a number or a string"))?;
            found.push(Assignment { address, value });
        }
        Ok(found)
    }

    fn address(&self, address: &Spot<String>, key: &str, target: Option<Target>) -> Result<()> {
        // Do-more has addresses of its own; they are read where the program is known.
        if target == Some(Target::DoMore) {
            return Ok(());
        }
        match crate::outside::address(&address.value) {
            Ok(parsed) if parsed.indexed => Err(ScenarioError {
                line: address.line,
                key: key.to_owned(),
                message: "an address with # has no value of its own".to_owned(),
            }),
            Ok(_) => Ok(()),
            Err(why) => Err(ScenarioError { line: address.line, key: key.to_owned(), message: why.to_string() }),
        }
    }

    /// Codes are printed in hex: `"0020"`, also with the marks of hex; `"none"`, `""` and 0 expect no fault. A
    /// number without quotes has to say that it is hex: nobody means fault 14h by `20`.
    fn fault(&self, value: &Value<'_>, key: &str) -> Result<Spot<u16>> {
        let line = self.line(&value.span());
        if let DeValue::Integer(number) = value.get_ref()
            && number.radix() == 16
            && let Some(code) = whole(value.get_ref()).and_then(|code| u16::try_from(code).ok())
        {
            return Ok(Spot { value: code, line });
        }
        let text = self.text(value, key)?;
        let lower = text.trim().to_ascii_lowercase();
        if lower.is_empty() || lower == "none" {
            return Ok(Spot { value: 0, line });
        }
        let marked = lower.starts_with("0x") || lower.ends_with('h');
        let code = if marked { digits(&lower) } else { i64::from_str_radix(&lower, 16).ok() };
        match code.and_then(|code| u16::try_from(code).ok()) {
            Some(value) => Ok(Spot { value, line }),
            None => Err(self.expected(value, key, "a fault code in hex such as \"0020\"")),
        }
    }
}

/// Scans a step asks for; each part is bounded already.
fn scans_of(step: &Step, scan: Duration) -> u64 {
    let scan = step.scan.unwrap_or(scan);
    let length = match step.length {
        Length::None => 0,
        Length::Scans(count) => count,
        Length::For(time) => u64::try_from(time.as_nanos() / scan.as_nanos().max(1)).unwrap_or(MOST_SCANS),
    };
    step.edges.as_ref().map_or(0, |edges| 2 * edges.count) + length
}

fn whole(value: &DeValue<'_>) -> Option<i64> {
    match value {
        DeValue::Integer(number) => i64::from_str_radix(&number.as_str().replace('_', ""), number.radix()).ok(),
        _ => None,
    }
}

fn describe(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("\"{text}\""),
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(_) => "a list".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLE: &str = r#"
name   = "lamp flashes"
program = "single_timer.RSS"
family = "slc-5/03"
scan   = "10ms"
[[step]]
note   = "press start"
set    = { "B3:0/0" = 1, "T4:0.PRE" = 100 }
scans  = 1
expect = { "T4:0/EN" = 1, "T4:0.ACC" = 0 }
[[step]]
edges  = { bit = "B3:0/1", count = 3 }
expect = { "C5:0.ACC" = 3, "C5:0/DN" = 1 }
fault  = "0020"
mode   = "program-run"
"#;

    #[test]
    fn the_documented_sample_reads() {
        let scenario = Scenario::parse(SAMPLE).expect("a scenario");
        assert_eq!(scenario.name, "lamp flashes");
        assert_eq!(scenario.target, Some(Target::Slc(Family::Slc503)));
        assert_eq!(scenario.scan, Duration::from_millis(10));
        let [first, second] = scenario.steps.as_slice() else { panic!("two steps") };
        assert_eq!(first.length, Length::Scans(1));
        let addresses: Vec<_> = first.set.iter().map(|set| (set.address.value.as_str(), &set.value)).collect();
        assert_eq!(addresses, [("B3:0/0", &Literal::Integer(1)), ("T4:0.PRE", &Literal::Integer(100))]);
        assert_eq!(first.set[0].address.line, 8);
        assert_eq!(second.fault, Some(Spot { value: 0x20, line: 14 }));
        assert!(second.program_run && !first.program_run);
        assert_eq!(second.edges.as_ref().map(|edges| edges.count), Some(3));
        assert_eq!(second.length, Length::None);
    }

    #[test]
    fn inline_ladders_know_their_lines() {
        let text = "ladder = \"\"\"\nXIC B3:0/0 OTE B3:0/1\n\"\"\"\n[[step]]\nscans = 1\n";
        let Subject::Inline(files) = Scenario::parse(text).expect("a scenario").program else { panic!("inline") };
        assert_eq!((files[0].name.value.as_str(), files[0].line), ("2", 2));
        let text = "ladder = { 2 = \"JSR U:3\", 3 = \"XIC B3:0/0 OTE B3:0/1\" }\n[[step]]\nscans = 1\n";
        let Subject::Inline(files) = Scenario::parse(text).expect("a scenario").program else { panic!("inline") };
        assert_eq!(files.iter().map(|file| file.name.value.as_str()).collect::<Vec<_>>(), ["2", "3"]);
    }

    #[test]
    fn errors_name_line_and_key() {
        let head = "ladder = \"OTE B3:0/0\"\n";
        let many = "[[step]]\nscans = 10000000\n\n\n".repeat(2000);
        for (text, line, key) in [
            ("family = \"slc-9\"\n[[step]]\n", 2, "family"),
            ("scan = \"10\"\n[[step]]\n", 2, "scan"),
            ("[[step]]\nscan = 1\n", 3, "step[1].scan"),
            ("[[step]]\nscans = -1\n", 3, "step[1].scans"),
            ("[[step]]\nscans = 1\nrun = \"1s\"\n", 4, "step[1].run"),
            ("[[step]]\nset = { \"Q7:0\" = 1 }\n", 3, "step[1].set.\"Q7:0\""),
            ("[[step]]\nset = { \"N7:0\" = [1] }\n", 3, "step[1].set.\"N7:0\""),
            ("[[step]]\n[step.expect]\n\"N7:0\" = 1\n\"#N7:1\" = 2\n", 5, "step[1].expect.\"#N7:1\""),
            ("[[step]]\nmode = \"test\"\n", 3, "step[1].mode"),
            ("[[step]]\nfault = 20\n", 3, "step[1].fault"),
            ("[[step]]\nedges = { count = 3 }\n", 3, "step[1].edges"),
            ("[[step]]\nset = 3\nset = 4\n", 4, ""),
            (many.as_str(), 42, "step[11]"),
            ("", 1, "step"),
        ] {
            let error = Scenario::parse(&format!("{head}{text}")).expect_err(text);
            assert_eq!((error.line, error.key.as_str()), (line, key), "{text}: {error}");
        }
        assert!(Scenario::parse("[[step]]\n").is_err_and(|error| error.key == "program"));
    }

    #[test]
    fn fault_codes_are_hex() {
        for text in ["0020", "20", "0x20", "20h", "0020H"] {
            let toml = format!("ladder = \"OTE B3:0/0\"\n[[step]]\nfault = \"{text}\"\n");
            let scenario = Scenario::parse(&toml).expect(text);
            assert_eq!(scenario.steps[0].fault.as_ref().map(|fault| fault.value), Some(0x20), "{text}");
        }
        for (value, code) in [("0x20", 0x20), ("\"none\"", 0), ("\"\"", 0), ("\"0000\"", 0)] {
            let toml = format!("ladder = \"OTE B3:0/0\"\n[[step]]\nfault = {value}\n");
            let scenario = Scenario::parse(&toml).expect(value);
            assert_eq!(scenario.steps[0].fault.as_ref().map(|fault| fault.value), Some(code), "{value}");
        }
    }
}
