//! Rungs painted on pages of a PDF document: vector lines, and texts that can be selected and searched.
//!
//! A [`Canvas`] is one page being painted; [`rung()`] paints a scene, or some rows of it, anywhere on it. What
//! makes pages a document (page tree, links, bookmarks) is not here.
//!
//! ```
//! use render::pdf::{Canvas, Grid};
//! use render::scene::{Item, Of, Role, Scene, Shape};
//!
//! let item = Item { x: 0, y: 0, shape: Shape::Text(Role::Address, "T4:0/DN".into()), of: Of::Rung };
//! let scene = Scene { width: 10, height: 1, items: vec![item], ..Scene::default() };
//! let mut page = Canvas::new(792.0);
//! render::pdf::rung(&mut page, &scene, 0..1, &Grid { left: 36.0, top: 36.0, cell: 5.4, row: 10.8 }, &mut |_| None);
//! let content = String::from_utf8(page.finish().content).unwrap();
//! assert!(content.contains("(T4:0/DN)Tj"));
//! ```

mod canvas;
mod font;
mod rung;

pub use canvas::{Area, Canvas, Color, Letters, Link, Painted};
pub use font::{Font, printable};
pub use rung::{Grid, breaks, rung};
