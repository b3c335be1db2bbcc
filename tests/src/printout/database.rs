//! "Address/Symbol Database", "Instruction Comment Database" and "Symbol Group Database".

use super::{Page, row};

/// A row of the address and symbol database.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SymbolRow {
    /// The address in the report's spelling, for example `I:0/4`; empty for an unassigned symbol.
    pub address: String,
    /// The symbol, or empty.
    pub symbol: String,
    /// `Global` where there is a symbol, else empty.
    pub scope: String,
    /// The description lines joined by one space; the page edge may cut it.
    pub description: String,
    /// The column "Sym Group".
    pub group: String,
    /// The column "Dev. Code".
    pub device: String,
    /// The column "ABV", printed on wide pages.
    pub above: String,
    /// The column "BLW", printed on wide pages.
    pub below: String,
}

/// A row of the instruction comment database.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommentRow {
    /// The address.
    pub address: String,
    /// The mnemonic.
    pub instruction: String,
    /// The comment.
    pub description: String,
}

/// A row of the symbol group database.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GroupRow {
    /// Name of the group.
    pub name: String,
    /// Its description.
    pub description: String,
}

pub(super) fn read_symbols(rows: &mut Vec<SymbolRow>, page: &Page) -> Vec<String> {
    let heading = ["Address", "Symbol", "Scope", "Description", "Sym Group", "Dev. Code", "ABV", "BLW"];
    collect(rows, page, &heading, |[address, symbol, scope, description, group, device, above, below]| SymbolRow {
        address,
        symbol,
        scope,
        description,
        group,
        device,
        above,
        below,
    })
}

pub(super) fn read_comments(rows: &mut Vec<CommentRow>, page: &Page) -> Vec<String> {
    collect(rows, page, &["Address", "Instruction", "Description"], |[address, instruction, description]| CommentRow {
        address,
        instruction,
        description,
    })
}

pub(super) fn read_groups(rows: &mut Vec<GroupRow>, page: &Page) -> Vec<String> {
    collect(rows, page, &["Group_Name", "Description"], |[name, description]| GroupRow { name, description })
}

/// Cuts every row of a page at the columns of its heading.
fn collect<T, const N: usize>(
    rows: &mut Vec<T>,
    page: &Page,
    names: &[&str; N],
    build: impl Fn([String; N]) -> T,
) -> Vec<String> {
    let mut lines = page.lines.iter().filter(|l| !l.is_empty());
    let Some(starts) = lines.next().and_then(|heading| row::starts(heading, names)) else {
        return page.lines.clone();
    };
    for line in lines {
        let mut columns = row::cut(line, &starts).into_iter();
        rows.push(build(std::array::from_fn(|_| columns.next().unwrap_or_default())));
    }
    Vec::new()
}
