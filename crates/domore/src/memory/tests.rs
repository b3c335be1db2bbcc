use super::*;
use crate::choices::{Choice, Choices};
use crate::program::{ElementDoc, Part, Section};

fn map() -> Map {
    Map::new(&Project::default()).expect("default memory")
}

fn place(map: &Map, text: &str) -> Place {
    match map.resolve_text(text) {
        Ok(Resolved::Place(place)) => place,
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn default_blocks_have_the_sizes_of_an_export() {
    let map = map();
    for text in ["X2047", "V4095", "T255.Done", "CT255.Acc", "DLX777", "DLV3777", "ST1023", "DST511", "SDT0.Hour"] {
        assert!(map.resolve_text(text).is_ok(), "{text}");
    }
    for text in ["X2048", "V4096", "T256.Done", "DLV4000", "N0.Acc", "Q0", "T0.TT", "T0.Acc:UW", "T0:UW", "C8:UW"] {
        assert!(map.resolve_text(text).is_err(), "{text}");
    }
    assert_eq!(
        map.resolve_text("T0").ok(),
        Some(Resolved::Structure(ElementType::Timer, map.block("T").unwrap().start))
    );
}

#[test]
fn casts_read_the_same_bits() {
    let map = map();
    let mut data = Data::new(map.bytes());
    let choices = Choices::default();
    data.store(place(&map, "C33"), Num::Int(1), choices);
    data.store(place(&map, "C47"), Num::Int(1), choices);
    assert_eq!(data.number(place(&map, "C32:UW")), Num::Int(0x8002));
    assert_eq!(data.number(place(&map, "C32:SW")), Num::Int(i64::from(0x8002_u16 as i16)));
    data.store(place(&map, "V84:SD"), Num::Int(-2), choices);
    assert_eq!(data.number(place(&map, "V84")), Num::Int(0xFFFE));
    assert_eq!(data.number(place(&map, "V85:15")), Num::Int(1));
    data.store(place(&map, "D5"), Num::Int(0x0403_0201), choices);
    assert_eq!(data.number(place(&map, "D5:B2")), Num::Int(3));
    assert_eq!(data.number(place(&map, "D5:UB2")), Num::Int(3));
    assert_eq!(data.number(place(&map, "D5:W1")), Num::Int(0x0403));
}

#[test]
fn conversions_follow_the_choices() {
    let map = map();
    let mut data = Data::new(map.bytes());
    let mut stored = |value, choices| {
        data.store(place(&map, "N0"), value, choices);
        data.number(place(&map, "N0"))
    };
    let choices = Choices::default();
    assert_eq!(stored(Num::Int(40_000), choices), Num::Int(40_000 - 65_536));
    assert_eq!(stored(Num::Int(40_000), choices.with(Choice::StoreSaturates)), Num::Int(32_767));
    assert_eq!(stored(Num::Real(2.7), choices), Num::Int(2));
    assert_eq!(stored(Num::Real(-2.7), choices.with(Choice::StoreRounds)), Num::Int(-3));
    assert_eq!(stored(Num::Real(1e9), choices), Num::Int(32_767));
    assert_eq!(stored(Num::Real(f64::NAN), choices), Num::Int(0));
}

#[test]
fn declared_blocks_and_nicknames_count() {
    let block = |name: &str, word: &str, count, extra: &[&str]| MemoryBlock {
        name: name.into(),
        type_word: word.into(),
        count,
        extra: extra.iter().map(|text| (*text).to_owned()).collect(),
        ..MemoryBlock::default()
    };
    let doc = |element: &str, nickname: &str, extra: &str| ElementDoc {
        element: element.into(),
        nickname: nickname.into(),
        extra: extra.into(),
        ..ElementDoc::default()
    };
    let memory =
        Section::new([block("N", "SWORD", 10, &[]), block("Rec", "REAL", 5, &["-1"]), block("PID_0", "PID", 0, &[])]);
    let documentation =
        Section::new([doc("T3", "RunDelay", ""), doc("SK1", "Limit", "250"), doc("V84:SD", "Total", "")]);
    let project =
        Project { parts: vec![Part::Memory(memory), Part::Documentation(documentation)], ..Project::default() };
    let map = Map::new(&project).expect("memory");
    assert!(map.resolve_text("N10").is_err_and(|error| error.why.contains("N9")));
    assert_eq!(place(&map, "Rec4").kind, Kind::F32);
    assert_eq!(map.block("Rec").map(|block| block.retention), Some(Retention::None));
    assert_eq!(place(&map, "RunDelay.Done"), place(&map, "T3.Done"));
    assert_eq!(place(&map, "total"), place(&map, "V84:SD"));
    assert_eq!(map.resolve_text("Limit"), Ok(Resolved::Constant(Num::Int(250))));
    assert!(map.resolve_text("PID_0").is_err_and(|error| error.why.contains("PID")));
    let huge = Section::new([block("Big", "REAL", u32::MAX, &[])]);
    assert!(Map::new(&Project { parts: vec![Part::Memory(huge)], ..Project::default() }).is_err());
}

#[test]
fn strings_are_cut_to_their_length() {
    let map = map();
    let mut data = Data::new(map.bytes());
    assert!(data.set_text(place(&map, "SS0"), &"x".repeat(70)));
    assert_eq!(data.text(place(&map, "SS0")).len(), 64);
    assert_eq!(data.number(place(&map, "SS0.Length")), Num::Int(64));
    assert!(!data.set_text(place(&map, "SS1"), "\u{4e00}"));
}
