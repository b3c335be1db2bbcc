use super::*;
use crate::choices::{Choice, Choices};
use crate::memory::{Data, Map, Num, Resolved};
use crate::program::Project;

fn evaluate(text: &str, values: &[(&str, Num)], choices: Choices) -> Result<Num, Trouble> {
    let map = Map::new(&Project::default()).expect("memory");
    let mut data = Data::new(map.bytes());
    for (address, value) in values {
        let Ok(Resolved::Place(place)) = map.resolve_text(address) else { panic!("{address}") };
        data.store(place, *value, choices);
    }
    Formula::parse(text, &map).unwrap_or_else(|why| panic!("{text}: {why}")).value(&data, choices)
}

#[track_caller]
fn gives(text: &str, expected: i64) {
    assert_eq!(evaluate(text, &[], Choices::default()), Ok(Num::Int(expected)), "{text}");
}

#[test]
fn ranks_are_those_of_c() {
    for (text, expected) in [
        ("1 + 2 * 3", 7),
        ("(1 + 2) * 3", 9),
        ("10 - 4 - 3", 3),
        ("2 ** 3 ** 2", 512),
        ("-2 ** 2", 4),
        ("7 / 2 * 2", 6),
        ("-7 / 2", -3),
        ("-7 % 3", -1),
        ("1 | 6 & 3", 3),
        ("1 << 4 + 1", 32),
        ("-8 >> 1", -4),
        ("-8 >>> 28", 15),
        ("~0x0F & 0xFF", 0xF0),
        ("3 > 2 && 0 || 1", 1),
        ("!5 + 1", 1),
        ("6 ^ 3", 5),
        ("IF(1 > 2, 10, 20)", 20),
        ("IF(0, 1 / 0, 5)", 5),
        ("2147483647 + 1", -2_147_483_648),
        ("ABS(-5)", 5),
        ("0xFFFFFFFF", -1),
        ("-2147483648", -2_147_483_648),
        ("-2147483648 < 0", 1),
        ("-2147483648 == 0x80000000", 1),
        ("ABS(-2147483647)", 2_147_483_647),
        ("-(-2147483648)", -2_147_483_648),
        ("5 - -2147483648", -2_147_483_643),
    ] {
        gives(text, expected);
    }
    let saturated = Choices::default().with(Choice::MathSaturates);
    assert_eq!(evaluate("-2147483648", &[], saturated), Ok(Num::Int(-2_147_483_648)));
    assert_eq!(evaluate("-(-2147483648)", &[], saturated), Ok(Num::Int(2_147_483_647)));
}

#[test]
fn a_real_on_either_side_makes_a_real() {
    assert_eq!(evaluate("7 / 2.0", &[], Choices::default()), Ok(Num::Real(3.5)));
    assert_eq!(evaluate("ROUND(TOREAL(7) / 2)", &[], Choices::default()), Ok(Num::Real(4.0)));
    let even = Choices::default().with(Choice::RoundHalfEven);
    assert_eq!(evaluate("ROUND(2.5)", &[], even), Ok(Num::Real(2.0)));
    assert_eq!(evaluate("FRAC(2.5) + TRUNC(-2.5)", &[], Choices::default()), Ok(Num::Real(-1.5)));
    assert_eq!(evaluate("0.1 + 0.2", &[], Choices::default()), Ok(Num::Real(f64::from(0.1f32 + 0.2f32))));
}

#[test]
fn elements_casts_ranges_and_indices_are_read() {
    let values = [
        ("N1", Num::Int(10)),
        ("N2", Num::Int(20)),
        ("N3", Num::Int(36)),
        ("D80", Num::Int(3)),
        ("C33", Num::Int(1)),
        ("T0.Acc", Num::Int(500)),
    ];
    let value = |text| evaluate(text, &values, Choices::default());
    assert_eq!(value("N[D80 - 1] + N[N[10] + 1]"), Ok(Num::Int(30)));
    assert_eq!(value("AVGR(N1, D80)"), Ok(Num::Real(22.0)));
    assert_eq!(value("SUMR(N1, 3) + MAXR(N1, 3)"), Ok(Num::Int(102)));
    assert_eq!(value("C32:UW * 2 + C33"), Ok(Num::Int(5)));
    assert_eq!(value("T0.Acc > 499"), Ok(Num::Int(1)));
    assert_eq!(value("N[4096]"), Err(Trouble::Index));
    assert_eq!(value("N[-1]"), Err(Trouble::Index));
    assert_eq!(value("AVGR(N4095, 2)"), Err(Trouble::Index));
    assert_eq!(value("N1 / N0"), Err(Trouble::DivideByZero));
    assert_eq!(evaluate("5 / 0", &[], Choices::default().with(Choice::DivideByZeroGivesZero)), Ok(Num::Int(0)));
}

#[test]
fn text_settles_and_errors_are_located() {
    for text in [
        "(D0 / D11) * D11",
        "IF(D0 == 32767, -32768, D0 + 1)",
        "(V0 & (0xFFFF - V1)) | (V2 & V1)",
        "-(D0 + 1) - (2 - 3)",
        "N[D80 - 1] ** 2 ** 3",
        "(2 ** 3) ** 2",
        "!(X0 && X1) || ~D0 >>> 3",
        "-(-D0)",
    ] {
        let once = Expression::parse(text).expect(text).to_string();
        let again = Expression::parse(&once).expect(&once);
        assert_eq!(again, Expression::parse(text).expect(text), "{text} -> {once}");
        assert_eq!(again.to_string(), once);
    }
    for (text, offset) in [("1 +", 3), ("FOO(1)", 0), ("1 2", 2), ("(1", 2), ("ROUND(1, 2)", 0), ("1.2.3", 0), ("", 0)]
    {
        assert_eq!(Expression::parse(text).expect_err(text).offset, offset, "{text}");
    }
    assert!(Expression::parse(&"(".repeat(10_000)).is_err());
    assert!(Expression::parse(&"-".repeat(10_000)).is_err());
    assert!(Expression::parse(&vec!["1"; 5_000].join("+")).is_err());
    let map = Map::new(&Project::default()).expect("memory");
    let nested = format!("{}0{}", "N[".repeat(3_000), "]".repeat(3_000));
    assert!(Formula::parse(&nested, &map).is_err());
}
