//! A drawing as items on a grid, independent of what paints it.
//!
//! Coordinates count grid cells from the top left corner, x to the right, y downwards. Text fills
//! cells; lines run from the centre of one cell to the centre of another, so that lines of
//! neighbouring elements meet when they name the same cell.

/// Everything drawn for one rung.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scene {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// What is drawn. Text stands before lines where both want a cell.
    pub items: Vec<Item>,
}

/// One thing drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// Column of the left end.
    pub x: usize,
    /// Row of the upper end.
    pub y: usize,
    /// What it is.
    pub shape: Shape,
}

/// What an [`Item`] draws, starting at its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A line of text; its characters are printable and of known width.
    Text(Role, String),
    /// A wire to the right over this many cells; arrow heads show a continuation that runs back.
    Across {
        /// Distance between the centres of its ends.
        length: usize,
        /// Where arrow heads point.
        arrows: Option<Direction>,
    },
    /// A wire downwards over this many cells.
    Down {
        /// Distance between the centres of its ends.
        length: usize,
        /// Arrow heads point down.
        arrows: bool,
    },
    /// A power rail, through all rows below its place and open at both ends.
    Rail,
    /// The frame of a box; its name stands in the upper side.
    Frame {
        /// Columns, sides included.
        width: usize,
        /// Rows, sides included.
        height: usize,
        /// The mnemonic.
        name: String,
    },
    /// A contact, three cells wide; `closed` examines for 0.
    Contact {
        /// Drawn with a stroke.
        closed: bool,
    },
    /// A coil with letters inside, as wide as its letters (a space if none) and two.
    Coil(String),
    /// Letters in brackets.
    Marked(String),
}

/// Where a wire leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// To the left.
    Left,
    /// To the right.
    Right,
}

/// What a text says, for colours and style sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// Rung number at the left rail.
    RungNumber,
    /// `e` at the left rail of an edited rung.
    EditMark,
    /// Page title.
    Title,
    /// Rung comment.
    Comment,
    /// Address description or instruction comment.
    Description,
    /// Symbol.
    Symbol,
    /// Address, or bit, at a contact or coil.
    Address,
    /// Module of an I/O point.
    Module,
    /// Name in the frame of a box.
    Mnemonic,
    /// Title of a box.
    BoxTitle,
    /// Name of an operand in a box.
    Name,
    /// Operand in a box.
    Operand,
    /// Value in a box.
    Value,
    /// A remark of the renderer: nothing RSLogix prints.
    Note,
}

impl Item {
    pub(crate) fn text(x: usize, y: usize, role: Role, text: impl Into<String>) -> Item {
        Item { x, y, shape: Shape::Text(role, text.into()) }
    }

    pub(crate) fn across(from: usize, to: usize, y: usize) -> Item {
        Item { x: from, y, shape: Shape::Across { length: to.saturating_sub(from), arrows: None } }
    }

    pub(crate) fn down(x: usize, from: usize, to: usize) -> Item {
        Item { x, y: from, shape: Shape::Down { length: to.saturating_sub(from), arrows: false } }
    }

    pub(crate) fn moved(mut self, x: usize, y: usize) -> Item {
        self.x += x;
        self.y += y;
        self
    }
}
