//! What a processor does not have is told with its rung, numbers that no word holds are refused.

use ladder::Family::{self, *};
use sim::{Options, Program, inline_image};

fn compile(family: Family, ladder: &str) -> Result<Vec<String>, Vec<String>> {
    let rungs = convert::slc::rung::parse_rungs(ladder, Some(family)).expect(ladder);
    let image = inline_image(family, vec![(2, rungs)]);
    let options = Options { inline: true, ..Options::default() };
    match Program::compile(&image, &options) {
        Ok(program) => Ok(program.approximations().iter().map(ToString::to_string).collect()),
        Err(refusals) => Err(refusals.iter().map(ToString::to_string).collect()),
    }
}

#[test]
fn numbers_beyond_a_word_are_refused() {
    for (ladder, what) in [
        ("CTU C5:0 100000 0", "preset 100000"),
        ("CTD C5:0 10 -32769", "accumulator -32769"),
        ("TON T4:0 0.01 70000 0", "preset 70000"),
        ("TON T4:0 0.01 40000 0", "preset 40000"),
        ("FFL N7:0 #N10:0 R6:0 70000 0", "length 70000"),
        ("SQO #N7:0 FFFFh O:2 R6:0 4 70000", "position 70000"),
        ("BSL #B3:0 R6:0 I:1/0 70000", "length 70000"),
        ("COP #N7:0 #N10:0 70000", "length 70000"),
    ] {
        let refused = compile(Slc503, ladder).expect_err(ladder);
        let [refusal] = refused.as_slice() else { panic!("{refused:?}") };
        assert!(refusal.starts_with("file 2 rung 0: ") && refusal.contains(what), "{refusal}");
    }
    for ladder in ["TON T4:0 0.01 32767 0", "TON T4:0 1.0 10 -5", "CTU C5:0 -32768 32767", "CTU C5:0 0FFFFh 0"] {
        assert_eq!(compile(Slc503, ladder), Ok(Vec::new()), "{ladder}");
    }
}

#[test]
fn what_a_family_lacks_is_told() {
    for (family, ladder, what) in [
        (Slc501, "MOV N7:[N7:0] N7:1", Some("SLC 5/01 has no indirect addresses")),
        (Slc502, "MOV F8:0 N7:1", Some("no F files")),
        (Slc503, "MOV F8:0 N7:1", None),
        (Slc503, "TON T4:0 0.001 10 0", Some("no timers of this time base")),
        (MicroLogix1400, "TON T4:0 0.001 10 0", None),
        (Slc501, "TON T4:0 1.0 10 0", Some("no timers of this time base")),
        (MicroLogix1000, "MOV N7:105 N7:0", Some("no element 105 in a N file")),
        (MicroLogix1000, "MOV N7:104 N7:0", None),
        (Slc503, "MOV N7:256 N7:0", Some("no element 256 in a N file")),
        (Slc503, "MOV N256:0 N7:0", Some("no data file 256")),
        (Slc503, "MOV RTC:0.HR N7:0", Some("no RTC files")),
        (Slc503, "MOV L9:0 N7:0", Some("no L files")),
        (MicroLogix1100, "MOV L9:0 RTC:0.YR", None),
        (Slc503, "XIC I:31/0 OTE B3:0/0", Some("no slot 31")),
        (Slc503, "LBL 256 OTE B3:0/0", Some("no label 256")),
        (MicroLogix1400, "LBL 256 OTE B3:0/0", None),
        (Slc503, "XIC B3:0/0 LBL 1 OTE B3:0/1", Some("LBL behind other instructions")),
        (Slc503, "XIC B3:0/0", Some("a rung without an output")),
    ] {
        let told = compile(family, ladder).expect(ladder);
        match what {
            None => assert_eq!(told, Vec::<String>::new(), "{ladder}"),
            Some(what) => {
                assert!(told.iter().any(|line| line.starts_with("file 2 rung 0") && line.contains(what)), "{told:?}");
            }
        }
    }
}
