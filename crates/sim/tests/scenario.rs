//! The rules of scenarios: order inside a step, time, edges, faults, failures.

use std::time::Duration;

use ladder::{Family, Image, Rung};
use sim::Choices;
use sim::scenario::{Found, Loader, Report, RunError, Scenario, run};

struct Inline;

impl Loader for Inline {
    fn program(&self, path: &str) -> Result<Image, String> {
        Err(format!("{path} is not here"))
    }

    fn rungs(&self, text: &str, family: Family) -> Result<Vec<Rung>, Vec<(u32, String)>> {
        let family = (family != Family::Unknown).then_some(family);
        let place = |error: convert::slc::rung::TextError| (error.line, error.to_string());
        convert::slc::rung::parse_rungs(text, family).map_err(|errors| errors.into_iter().map(place).collect())
    }
}

fn attempt(text: &str) -> Result<Report, RunError> {
    run(&Scenario::parse(text).expect("a scenario"), &Inline, Choices::default())
}

#[track_caller]
fn holds(text: &str) -> Report {
    let report = attempt(text).expect("it runs");
    assert_eq!(report.failures, [], "{}", report.failures.first().map(ToString::to_string).unwrap_or_default());
    report
}

/// The lines in which a scenario stops with an error, with the message.
#[track_caller]
fn stops(text: &str) -> (u32, String) {
    match attempt(text) {
        Err(RunError::Scenario(spot)) => (spot.line, spot.value),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_first_scan_has_no_time_and_every_later_one_has() {
    let report = holds(
        "family = \"slc-5/03\"\nscan = \"10ms\"\nladder = \"XIC B3:0/0 TON T4:0 0.01 100 0\"\n\
         [[step]]\nset = { \"B3:0/0\" = 1 }\nscans = 1\nexpect = { \"T4:0/EN\" = 1, \"T4:0.ACC\" = 0 }\n\
         [[step]]\nscans = 1\nexpect = { \"T4:0.ACC\" = 1 }\n\
         [[step]]\nrun = \"50ms\"\nexpect = { \"T4:0.ACC\" = 6 }\n",
    );
    assert_eq!((report.scans, report.checks, report.time), (7, 4, Duration::from_millis(60)));
}

#[test]
fn run_lasts_until_the_time_has_passed_also_from_the_start() {
    // The scan without time before it does not count towards the second.
    let report = holds(
        "family = \"slc-5/03\"\nladder = \"XIC B3:0/0 TON T4:0 0.01 100 0\"\n\
         [[step]]\nset = { \"B3:0/0\" = 1 }\nrun = \"1s\"\nexpect = { \"T4:0/DN\" = 1, \"T4:0.ACC\" = 100 }\n",
    );
    assert_eq!((report.scans, report.time), (101, Duration::from_secs(1)));
}

#[test]
fn a_step_can_have_its_own_time_between_scans() {
    let report = holds(
        "family = \"slc-5/03\"\nscan = \"10ms\"\nladder = \"XIC B3:0/0 TON T4:0 0.01 100 0\"\n\
         [[step]]\nset = { \"B3:0/0\" = 1 }\nscan = \"70ms\"\nscans = 2\nexpect = { \"T4:0.ACC\" = 7 }\n\
         [[step]]\nscans = 1\nexpect = { \"T4:0.ACC\" = 8 }\n\
         [[step]]\nscan = \"100ms\"\nrun = \"200ms\"\nexpect = { \"T4:0.ACC\" = 28 }\n",
    );
    assert_eq!((report.scans, report.time), (5, Duration::from_millis(280)));
    let zero = "family = \"slc-5/03\"\nladder = \"OTE B3:0/0\"\n[[step]]\nscan = \"0ms\"\n";
    assert!(sim::scenario::Scenario::parse(zero).is_err_and(|error| error.key == "step[1].scan"));
}

#[test]
fn a_step_acts_in_its_documented_order() {
    // mode before set: the coil's bit is cleared by the prescan and then set; edges before scans.
    holds(
        "family = \"slc-5/03\"\nladder = { 2 = \"XIC B3:1/0 JSR U:3\\nXIC B3:0/1 CTU C5:0 3 0\\nADD N7:0 1 N7:0\", 3 = \"XIC B3:1/1 OTE B3:0/5\" }\n\
         [[step]]\nset = { \"B3:0/5\" = 1 }\nscans = 1\nexpect = { \"B3:0/5\" = 1, \"N7:0\" = 1 }\n\
         [[step]]\nmode = \"program-run\"\nexpect = { \"B3:0/5\" = 0, \"N7:0\" = 1 }\n\
         [[step]]\nmode = \"program-run\"\nset = { \"B3:0/5\" = 1 }\nedges = { bit = \"B3:0/1\", count = 3 }\nscans = 2\n\
         expect = { \"B3:0/5\" = 1, \"C5:0.ACC\" = 3, \"C5:0/DN\" = 1, \"N7:0\" = 9 }\n",
    );
}

#[test]
fn what_the_first_step_sets_is_there_on_entering_run() {
    // The unit of the STI is taken over on going to run only.
    holds(
        "family = \"slc-5/03\"\nladder = { 2 = \"ADD N7:0 1 N7:0\", 5 = \"ADD N7:1 1 N7:1\" }\n\
         [[step]]\nset = { \"S:31\" = 5, \"S:30\" = 25, \"S:2/10\" = 1 }\nrun = \"1s\"\nexpect = { \"N7:1\" = 40 }\n",
    );
}

#[test]
fn faults_must_be_expected_in_the_step_they_come_in() {
    let ladder = "family = \"slc-5/03\"\nladder = \"XIC B3:0/0 OTL S:5/0\"\n";
    let fault = "[[step]]\nset = { \"B3:0/0\" = 1 }\nscans = 1\n";
    let report = attempt(&format!("{ladder}{fault}")).expect("it runs");
    let [failure] = report.failures.as_slice() else { panic!("one failure: {report:?}") };
    assert!(matches!(failure.found, Found::Fault { expected: None, found: Some(ref fault) } if fault.code == 0x20));
    assert!(
        failure.to_string().starts_with("step 1, scan 1, 0.000 s: expected no major fault, found major fault 0020")
    );
    // Expected once, it may stay.
    holds(&format!("{ladder}{fault}fault = \"0020\"\n[[step]]\nscans = 3\nexpect = {{ \"S:6\" = \"0x20\" }}\n"));
    let report = attempt(&format!("{ladder}{fault}fault = \"0034\"\n")).expect("it runs");
    assert_eq!(report.failures.len(), 1);
    let report = attempt(&format!("{ladder}[[step]]\nscans = 1\nfault = \"0020\"\n")).expect("it runs");
    assert!(report.failures.first().is_some_and(|failure| failure.to_string().ends_with("0020, found none")));
}

#[test]
fn failures_say_where_what_and_when() {
    let report = attempt(
        "family = \"slc-5/03\"\nladder = \"ADD N7:0 1 N7:0\"\n[[step]]\nscans = 2\n\
         [[step]]\nnote = \"count\"\nscans = 2\nexpect = { \"N7:0\" = 5, \"S:0/2\" = 1 }\n",
    )
    .expect("it runs");
    let lines: Vec<_> = report.failures.iter().map(|failure| (failure.line, failure.to_string())).collect();
    assert_eq!(
        lines,
        [
            (8, "step 2 (count), scan 4, 0.030 s: N7:0 expected 5, found 4".to_owned()),
            (8, "step 2 (count), scan 4, 0.030 s: S:0/2 expected 1, found 0".to_owned()),
        ]
    );
}

#[test]
fn brackets_are_read_when_the_step_comes() {
    holds(
        "family = \"slc-5/03\"\nladder = \"ADD N7:0 1 N7:0\"\n\
         [[step]]\nset = { \"N7:5\" = 55, \"N7:6\" = 66, \"N7:0\" = 4 }\nscans = 1\nexpect = { \"N7:[N7:0]\" = 55 }\n\
         [[step]]\nscans = 1\nexpect = { \"N7:[N7:0]\" = 66 }\n",
    );
}

#[test]
fn what_cannot_be_run_is_located() {
    let head = "family = \"slc-5/03\"\n";
    let (line, why) = stops(&format!("{head}program = \"x.RSS\"\n[[step]]\nscans = 1\n"));
    assert_eq!((line, why.as_str()), (2, "x.RSS: x.RSS is not here"));
    let (line, why) = stops(&format!("{head}ladder = '''\nOTE B3:0/0\nXCI B3:0/1\n'''\n[[step]]\nscans = 1\n"));
    assert_eq!(line, 4);
    assert!(why.contains("XCI"), "{why}");
    let (line, why) =
        stops(&format!("{head}ladder = \"OTE B3:0/0\"\n[[step]]\nset = {{ \"B3:0/0\" = 2 }}\nscans = 1\n"));
    assert_eq!((line, why.as_str()), (4, "B3:0/0: a bit is 0 or 1, not 2"));
    let (_, why) =
        stops("family = \"do-more\"\nladder = \"STR X0\\nOUT Y0\"\n[[step]]\nset = { \"X0\" = 1 }\nscans = 1\n");
    assert!(why.contains("do-more"), "{why}");
}
