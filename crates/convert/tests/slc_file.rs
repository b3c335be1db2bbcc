//! Whole `.SLC` files: layout, what is kept of lines that fit nothing, and hostile text.

use std::time::{Duration, Instant};

use convert::slc::file::{Data, Ladder, Section, SlcFile, TitleBlock, read};
use proptest::prelude::*;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

/// A file of our own in the layout RSLogix writes.
const SAMPLE: &str = "\
START Bul.1766    % Bul.1766     MicroLogix 1400 Series A %

% PROCESSOR RACK CONFIGURATION INFORMATION %
% SLOT CONFIGURATION INFORMATION %
SLOT 0 Bul.1766    % Bul.1766     MicroLogix 1400 Series A %  SCAN_IN 8 SCAN_OUT 6  G_FILE 3
     526 0 -1 IOCARD 4625 0 8 0 0 6 0 0 0 2 0 0
SLOT 1 1762-IQ16   % 16-Input 10/30 VDC %  SCAN_IN 1 SCAN_OUT 0  IOCARD 4625 0 8 0 0 6 0 0 0 2 0 0


PROJECT \"PUMP\"
    2  \"MAIN\"
  100  \"ALARMS \"

LADDER 2
% Rung: 0 %
SOR XIC I:1.0/0 OTE O:0.0/0 EOR 
% TITLE/RUNG DESCRIPTION
TITLE: Pump
RUNG DESCRIPTION: Runs while the switch is on,
at 100%\\ %
% Rung: 1 %
SOR JSR 100 EOR 

LADDER 100


DATA O:0
% O:0.0 % 0X0000 0X0001 


DATA I:1
% I:1.0 % 0X8000 


DATA S:0
% S:0 %      4   5414      0   2560  28652      0      0      0      0      0 
% S:10 %     -1 

DATA N7:0 
% N7:0  %     60      0      0      0      0      0      0      0      0      0 
% N7:10 % -32768 

DATA F8:0 
% F8:0  %    0.01666667 

DATA R6:0 
% .CTL   .LEN   .POS    %
0X0000      4      0 % R6:0  %

DATA L9:0 
% L9:0  %  2147483647 -2147483648 

DATA ST10:0 
% ST10:0  %
\"Tank \\22A\\22\"
% ST10:1  %
\"\"

DATA PD11:0 
% PD11:0  %
     1      2      3      4      5      6      7      8      9     10
    11     12     13     14     15     16     17     18     19     20
    21     22     23


DATA HSC0:0 
% HSC0:0  %
     0      0 0X0002 0X000F      0
            0    2147483647   -2147483648    2147483647   -2147483648
     0      0      0


DATA RTC0:0 
% RTC0:0  %
  2024      1      2      3      4      5      6 0X0000 

DATA DLS0:0

FORCE O:00
% ON     OFF  %
0X0001 0XFFFF % FORCE O:0.0 %
0X0000 0XFFFE % FORCE O:0.1 %


";

#[test]
fn the_layout_is_written_back() {
    let file = read(SAMPLE);
    assert_eq!(file.diagnostics, []);
    assert_eq!(file.write(), SAMPLE);
    assert_eq!(read(&SAMPLE.replace('\n', "\r\n")), file);
    assert_eq!(file.start().map(|start| start.catalog.as_str()), Some("Bul.1766"));
    let slots: Vec<_> = file.slots().collect();
    assert_eq!(slots[0].configuration.as_deref(), Some([526, 0, 0xFFFF].as_slice()));
    assert_eq!((slots[1].scan_in, slots[1].scan_out, slots[1].catalog.as_str()), (1, 0, "1762-IQ16"));
    let names = file.names().expect("names");
    assert_eq!(names.project, "PUMP");
    assert_eq!(names.program_files, [(2, "MAIN".into()), (100, "ALARMS ".into())]);
    let ladder = file.ladders().next().expect("file 2");
    let title = TitleBlock { title: "Pump".into(), description: "Runs while the switch is on,\nat 100%".into() };
    assert_eq!(ladder.rungs[0].title, Some(title));
    assert_eq!((ladder.rungs[1].text.as_str(), ladder.rungs[1].line), ("SOR JSR 100 EOR", 22));
    let data = |letters: &str| file.data().find(|data| data.letters == letters).expect("data").clone();
    assert_eq!(data("N").words.last(), Some(&0x8000));
    assert_eq!(data("L").words, [0xFFFF, 0x7FFF, 0, 0x8000]);
    assert_eq!(data("ST").words.len(), 84);
    assert_eq!((data("PD").words_per_element, data("PD").words[22]), (23, 23));
    assert_eq!((data("HSC").words_per_element, &data("HSC").words[5..9]), (18, [0, 0, 0xFFFF, 0x7FFF].as_slice()));
    let force = file.forces().next().expect("forces");
    assert_eq!((force.words[0].on, force.words[1].off), (1, 0xFFFE));
}

#[test]
fn lines_that_fit_nothing_are_kept_and_reported() {
    let text = "\
GARBAGE
more

START 1747-L532
SLOT 0 what is this
  1 2 3
SLOT 1 1746-IA16   % 16-Input (TTL) 5 VDC %  SCAN_IN 1 SCAN_OUT 0
PROJECT \"X
LADDER 2
lost
% Rung: 5 %
SOR XIC B3:0/0
 OTE B3:0/1 EOR
% a remark %
SOR XIC
% Rung: 2 %
DATA N7:0
% N7:0 % 1 2 x
% N7:9 % 3
DATA HSC0:0
% HSC0:0 %
1 2 3
% HSC0:1 %
1 2
FORCE I:01
no mask
";
    let file = read(text);
    let places: Vec<_> = file.diagnostics.iter().map(|d| d.place.as_str()).collect();
    assert_eq!(
        places,
        [
            "line 1", "line 4", "line 5", "line 8", "line 10", "line 11", "line 14", "line 18", "line 19", "line 23",
            "line 26"
        ],
        "{:#?}",
        file.diagnostics
    );
    let written = file.write();
    for kept in
        ["GARBAGE\nmore\n", "SLOT 0 what is this\n  1 2 3\n", "lost", "% a remark %", "% N7:0 % 1 2 x", "no mask"]
    {
        assert!(written.contains(kept), "{kept}\n{written}");
    }
    let again = read(&written);
    assert_eq!(again.write(), written);
}

#[test]
fn the_vendors_own_file_comes_back_byte_for_byte() {
    let Some(root) = corpus::root() else { return };
    let text = std::fs::read_to_string(root.join("RsLogix500Helper/59-BSGS.SLC")).expect("the file");
    let file = read(&text);
    assert_eq!(file.diagnostics, []);
    assert_eq!(file.write(), text);
    let has_extra = file.sections.iter().any(|section| match section {
        Section::Other(_) => true,
        Section::Data(Data { extra, .. }) | Section::Ladder(Ladder { extra, .. }) => !extra.is_empty(),
        _ => false,
    });
    assert!(!has_extra);
    assert_eq!(file.ladders().map(|ladder| ladder.rungs.len()).sum::<usize>(), 35);
    // Element sizes of function files are those that project files of this controller store.
    let sizes: Vec<_> = file.data().map(|data| (data.letters.as_str(), data.words_per_element)).collect();
    for size in [("HSC", 18), ("PTOX", 15), ("STI", 4), ("EII", 4), ("RTC", 8), ("PWMX", 10), ("LCD", 16)] {
        assert!(sizes.contains(&size), "{size:?} {sizes:?}");
    }
}

#[test]
fn ten_megabytes_of_anything_end_quickly() {
    let fill = |unit: &str| unit.repeat(10_000_000 / unit.len());
    for unit in [
        "x",
        "\n",
        "a\n",
        "%",
        "% TITLE/RUNG DESCRIPTION\n",
        "SOR ",
        "SOR\n",
        "LADDER 2\nSOR XIC\n",
        "DATA N7:0\n% N7:0 % 1 2 3 4 5 6 7\n",
        "% N7:0 % 1\n",
        "DATA HSC0:0\n% x %\n1\n",
        "SLOT 0\n 1\n",
        "\"",
        "\\\n",
        "FORCE O:0\n",
        "é%\r",
    ] {
        let text = format!("START x % y %\nLADDER 2\nSOR EOR\n{}", fill(unit));
        let begin = Instant::now();
        let file = read(&text);
        let written = file.write();
        // Tests run unoptimised beside others; the optimised reader takes a tenth of a second.
        assert!(begin.elapsed() < Duration::from_secs(20), "{unit:?}: {:?}", begin.elapsed());
        assert!(written.len() < 3 * text.len() + 1000);
        assert!(file.diagnostics.len() <= 1000);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_settles(pieces in prop::collection::vec(piece(), 0..60)) {
        let words = |text: &str| {
            text.lines().map(str::trim).filter(|line| !line.is_empty()).map(str::to_owned).collect::<Vec<_>>()
        };
        let first = read(&pieces.join("\n")).write();
        let second = read(&first).write();
        prop_assert_eq!(words(&second), words(&first));
        prop_assert_eq!(read(&second).write(), second);
    }
}

/// Lines of the sample, whole or cut, and noise.
fn piece() -> impl Strategy<Value = String> {
    let lines: Vec<&str> = SAMPLE.lines().collect();
    prop_oneof![
        6 => prop::sample::select(lines.clone()).prop_map(str::to_owned),
        2 => (prop::sample::select(lines), 0..40_usize).prop_map(|(line, cut)| line.chars().take(cut).collect()),
        1 => "[ %0-9A-Z:\"\\\\.]{0,20}",
        1 => "\\PC{0,20}",
    ]
}

#[test]
fn an_empty_text_is_an_empty_file() {
    let file = read("");
    assert_eq!(file.sections, []);
    assert_eq!(file.diagnostics.len(), 1);
    assert_eq!(SlcFile::default().write(), "");
}
