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
    /// What is drawn. Text stands before lines where both want a cell. All items of an instruction follow
    /// each other.
    pub items: Vec<Item>,
    /// The instructions drawn, in the order of their items; none where the rung stands in words.
    pub instructions: Vec<Spot>,
    /// Wires without an instruction on them (an empty leg), as the nodes they lead from and to.
    pub shorts: Vec<(Node, Node)>,
    /// Number of the rung as it stands at the left rail.
    pub number: String,
}

impl Scene {
    /// Which wires have power, by their node: the left rail, and what `out` says about the instructions.
    pub fn powered(&self, out: &dyn Fn(usize) -> bool) -> Vec<bool> {
        let ends = self.instructions.iter().map(|spot| spot.leaves).chain(self.shorts.iter().map(|short| short.1));
        let mut power = vec![false; ends.max().unwrap_or(0).saturating_add(1)];
        let mut give = |node: Node, on: bool| {
            if let Some(power) = power.get_mut(node) {
                *power |= on;
            }
        };
        give(0, true);
        for spot in &self.instructions {
            give(spot.leaves, out(spot.index));
        }
        // In the order of power flow, so that one pass is enough.
        for (from, to) in &self.shorts {
            let on = power.get(*from).copied().unwrap_or(false);
            if let Some(power) = power.get_mut(*to) {
                *power |= on;
            }
        }
        power
    }
}

/// A piece of wire that has the same power everywhere. 0 is the left rail.
pub type Node = usize;

/// One thing drawn.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Item {
    /// Column of the left end.
    pub x: usize,
    /// Row of the upper end.
    pub y: usize,
    /// What it is.
    pub shape: Shape,
    /// Whose it is.
    pub of: Of,
}

/// Whose an item is.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum Of {
    /// The rung's: number, comment, rails.
    #[default]
    Rung,
    /// A wire of this node.
    Node(Node),
    /// An instruction's.
    Instruction {
        /// Its number in the order of [`ladder::Rung::instructions`], or of a Do-more rung's instructions.
        index: usize,
        /// The operand a text shows, counted from 0.
        operand: Option<usize>,
        /// The address a text stands for, in the spelling of the model (`T4:0/DN`); a Do-more operand as
        /// written. Texts cut into lines have the whole address at each.
        link: Option<String>,
    },
}

/// An instruction of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spot {
    /// Its number, see [`Of::Instruction`].
    pub index: usize,
    /// Mnemonic, operands, symbol and description as one line.
    pub title: String,
    /// The wire it takes its power from.
    pub enters: Node,
    /// The wire it gives its power to.
    pub leaves: Node,
    /// Its bit has a force in the project: forced on, or off.
    pub forced: Option<bool>,
    /// What RSLogix highlights, if the style asks for it: a contact that conducts or a coil whose bit is 1,
    /// by the data table. `None`: not asked for, or not known.
    pub state: Option<bool>,
}

/// What an [`Item`] draws, starting at its place.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
    /// A force of the project at its contact or coil.
    Force,
    /// `T` at a contact or coil that [`Spot::state`] tells conducts or drives.
    State,
}

impl Item {
    pub(crate) fn new(x: usize, y: usize, shape: Shape) -> Item {
        Item { x, y, shape, of: Of::Rung }
    }

    pub(crate) fn text(x: usize, y: usize, role: Role, text: impl Into<String>) -> Item {
        Item::new(x, y, Shape::Text(role, text.into()))
    }

    pub(crate) fn across(from: usize, to: usize, y: usize) -> Item {
        Item::new(from, y, Shape::Across { length: to.saturating_sub(from), arrows: None })
    }

    pub(crate) fn down(x: usize, from: usize, to: usize) -> Item {
        Item::new(x, from, Shape::Down { length: to.saturating_sub(from), arrows: false })
    }

    /// As a wire of a node.
    pub(crate) fn on(mut self, node: Node) -> Item {
        self.of = Of::Node(node);
        self
    }

    /// The number of the instruction it belongs to.
    pub fn instruction(&self) -> Option<usize> {
        match self.of {
            Of::Instruction { index, .. } => Some(index),
            _ => None,
        }
    }

    /// The address its text stands for.
    pub fn link(&self) -> Option<&str> {
        match &self.of {
            Of::Instruction { link, .. } => link.as_deref(),
            _ => None,
        }
    }

    pub(crate) fn moved(mut self, x: usize, y: usize) -> Item {
        self.x += x;
        self.y += y;
        self
    }
}
