//! One rung: series and branches on the stack of booleans.

use ladder::{Branch, Element, Instruction, Mnemonic, Series};

use super::context::{Context, Converted, Person};
use super::emit::{Contact, Emitter};
use super::marks::Mark;
use super::table;

/// Branches nest at most this deep.
const MAX_NESTING: usize = 32;

/// Conditions without effects.
enum Pure {
    Contact(Contact),
    Series(Vec<Pure>),
    /// At least two legs, none of them a plain wire.
    Parallel(Vec<Pure>),
}

/// Appends a whole series to a rung.
///
/// # Errors
/// The first instruction that needs a person.
pub(super) fn series(context: &mut Context<'_>, e: &mut Emitter, series: &Series) -> Converted {
    part(context, e, series, 0, true)
}

/// `last`: nothing of the rung is executed behind this series.
fn part(context: &mut Context<'_>, e: &mut Emitter, series: &Series, depth: usize, last: bool) -> Converted {
    for (index, element) in series.iter().enumerate() {
        let last = last && index + 1 == series.len();
        match element {
            Element::Instruction(one) => instruction(context, e, one)?,
            Element::Branch(branch) => parallel(context, e, branch, depth, last)?,
        }
    }
    Ok(())
}

fn instruction(context: &mut Context<'_>, e: &mut Emitter, one: &Instruction) -> Converted {
    context.left = context.left.saturating_sub(1);
    match row_of(one)? {
        row if row.contact.is_some() => match row.contact.and_then(|contact| contact(context, one)) {
            Some(contact) => e.contact(&contact),
            None => (row.convert)(context, e, one)?,
        },
        row => match context.jumped.clone() {
            // Outputs behind a jump that was taken get no power.
            Some(jumped) => {
                e.duplicate();
                e.and_not(&jumped);
                (row.convert)(context, e, one)?;
                e.pop();
            }
            None => (row.convert)(context, e, one)?,
        },
    }
    Ok(())
}

fn row_of(one: &Instruction) -> Converted<&'static table::Row> {
    let Mnemonic::Named(name) = &one.mnemonic else {
        return Err(Person::new(Mark::Unknown, format!("{}: an instruction whose name is not known", one.mnemonic)));
    };
    table::by_mnemonic(name)
        .ok_or_else(|| Person::new(Mark::NoCounterpart, format!("{name} has no counterpart in Do-more")))
}

fn parallel(context: &mut Context<'_>, e: &mut Emitter, branch: &Branch, depth: usize, last: bool) -> Converted {
    if depth >= MAX_NESTING {
        return Err(Person::new(Mark::Flow, format!("branches nest deeper than {MAX_NESTING} levels")));
    }
    if branch.legs.is_empty() {
        return Ok(());
    }
    if let Some(pure) = pure_branch(context, branch, depth) {
        pure_joined(e, &pure);
        return Ok(());
    }
    if last {
        for leg in &branch.legs {
            e.duplicate();
            part(context, e, leg, depth + 1, true)?;
            e.pop();
        }
        return Ok(());
    }
    // What the legs pass on is needed behind the branch: a relay gathers it.
    let flow = context.scratch_bit(depth);
    e.always(|e| e.reset(&flow));
    for leg in &branch.legs {
        e.duplicate();
        part(context, e, leg, depth + 1, false)?;
        e.set(&flow);
        e.pop();
    }
    e.and(&flow);
    Ok(())
}

/// The branch as conditions without effects, if it is that.
fn pure_branch(context: &mut Context<'_>, branch: &Branch, depth: usize) -> Option<Pure> {
    if depth >= MAX_NESTING {
        return None;
    }
    let mut legs = Vec::with_capacity(branch.legs.len());
    for leg in &branch.legs {
        legs.push(pure_series(context, leg, depth + 1)?);
    }
    // A leg that is a wire makes a wire of the branch.
    if legs.iter().any(|leg| matches!(leg, Pure::Series(parts) if parts.is_empty())) {
        return Some(Pure::Series(Vec::new()));
    }
    Some(if legs.len() == 1 { legs.pop()? } else { Pure::Parallel(legs) })
}

fn pure_series(context: &mut Context<'_>, series: &Series, depth: usize) -> Option<Pure> {
    let mut parts = Vec::with_capacity(series.len());
    for element in series {
        match element {
            Element::Instruction(one) => {
                let row = row_of(one).ok()?;
                parts.push(Pure::Contact(row.contact?(context, one)?));
            }
            Element::Branch(branch) if branch.legs.is_empty() => {}
            Element::Branch(branch) => match pure_branch(context, branch, depth)? {
                Pure::Series(inner) => parts.extend(inner),
                other => parts.push(other),
            },
        }
    }
    Some(if parts.len() == 1 { parts.pop()? } else { Pure::Series(parts) })
}

/// Appends conditions in series with the power flow.
fn pure_joined(e: &mut Emitter, pure: &Pure) {
    match pure {
        Pure::Contact(contact) => e.contact(contact),
        Pure::Series(parts) => parts.iter().for_each(|part| pure_joined(e, part)),
        Pure::Parallel(_) => {
            let joined = e.depth() > 0;
            pure_pushed(e, pure);
            if joined {
                e.join_and();
            }
        }
    }
}

/// Pushes the value of conditions.
fn pure_pushed(e: &mut Emitter, pure: &Pure) {
    match pure {
        Pure::Contact(contact) => e.store(contact),
        Pure::Series(parts) => {
            let mut parts = parts.iter();
            if let Some(first) = parts.next() {
                pure_pushed(e, first);
            }
            parts.for_each(|part| pure_joined(e, part));
        }
        Pure::Parallel(legs) => {
            for (index, leg) in legs.iter().enumerate() {
                match leg {
                    Pure::Contact(contact) if index > 0 => e.or(contact),
                    leg => {
                        pure_pushed(e, leg);
                        if index > 0 {
                            e.join_or();
                        }
                    }
                }
            }
        }
    }
}
