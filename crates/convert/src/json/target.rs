//! Documentation targets as an address text and a kind.

use ladder::{Address, Target};

/// The kinds a document names, in the order the schema lists them.
const ADDRESS: &str = "address";
const PROGRAM_FILE_OPERAND: &str = "program_file_operand";
const LABEL: &str = "label";
const PROGRAM_FILE: &str = "program_file";
const DATA_FILE: &str = "data_file";
const UNASSIGNED: &str = "unassigned";
const OTHER: &str = "other";

/// The kind of a target.
pub(crate) fn kind_of(target: &Target) -> &'static str {
    match target {
        Target::Address(_) => ADDRESS,
        Target::ProgramFileOperand(_) => PROGRAM_FILE_OPERAND,
        Target::Label { .. } => LABEL,
        Target::ProgramFile(_) => PROGRAM_FILE,
        Target::DataFile(_) => DATA_FILE,
        Target::Unassigned => UNASSIGNED,
        Target::Other(_) => OTHER,
    }
}

/// The target with this text. Without a kind the text decides, and a text that is nothing else is
/// an address of unknown form.
///
/// # Errors
/// What a text of that kind looks like.
pub(crate) fn target_from(kind: Option<&str>, text: &str) -> Result<Target, String> {
    let Some(kind) = kind else {
        let kinds = [UNASSIGNED, PROGRAM_FILE_OPERAND, LABEL, PROGRAM_FILE, DATA_FILE, ADDRESS];
        let found = kinds.into_iter().find_map(|kind| target_of_kind(kind, text)?.ok());
        return Ok(found.unwrap_or_else(|| Target::Other(text.to_owned())));
    };
    target_of_kind(kind, text).unwrap_or_else(|| {
        Err([ADDRESS, PROGRAM_FILE_OPERAND, LABEL, PROGRAM_FILE, DATA_FILE, UNASSIGNED, OTHER].join(", "))
    })
}

/// `None` if there is no such kind.
fn target_of_kind(kind: &str, text: &str) -> Option<Result<Target, String>> {
    let expected = |what: &str| Err(what.to_owned());
    let after = |prefix: &str| text.strip_prefix(prefix).and_then(|rest| rest.parse::<u16>().ok());
    Some(match kind {
        ADDRESS => Address::parse(text).map(Target::Address).map_err(|error| error.to_string()),
        PROGRAM_FILE_OPERAND => {
            after("U:").map_or_else(|| expected("U: and a number"), |number| Ok(Target::ProgramFileOperand(number)))
        }
        LABEL => label(text).map_or_else(|| expected("Q, a file number, : and a label number"), Ok),
        PROGRAM_FILE => after("program file ")
            .map_or_else(|| expected("\"program file\" and a number"), |number| Ok(Target::ProgramFile(number))),
        DATA_FILE => {
            after("data file ").map_or_else(|| expected("\"data file\" and a number"), |n| Ok(Target::DataFile(n)))
        }
        UNASSIGNED if text.is_empty() => Ok(Target::Unassigned),
        UNASSIGNED => expected("an empty address"),
        OTHER => Ok(Target::Other(text.to_owned())),
        _ => return None,
    })
}

fn label(text: &str) -> Option<Target> {
    let (file, number) = text.strip_prefix('Q')?.split_once(':')?;
    Some(Target::Label { file: file.parse().ok()?, number: number.parse().ok()? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_read_back() {
        let address = |text| Target::Address(Address::parse(text).expect("address"));
        for target in [
            address("T4:0/DN"),
            address("N[N7:4]:2"),
            Target::ProgramFileOperand(5),
            Target::Label { file: 51, number: 1 },
            Target::ProgramFile(2),
            Target::DataFile(300),
            Target::Unassigned,
            Target::Other("GRP?".to_owned()),
        ] {
            let text = target.to_string();
            assert_eq!(target_from(Some(kind_of(&target)), &text), Ok(target.clone()));
            assert_eq!(target_from(None, &text), Ok(target));
        }
        assert!(target_from(Some("address"), "GRP?").is_err());
        assert!(target_from(Some("adress"), "N7:0").is_err());
    }
}
