//! What the splits have in common. In: a block of sizes and the total. Out: evaluated sizes laid out as slabs, and
//! pieces numbered for `split.index` and `split.total` (reference 4.3.2 to 4.3.4).

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::form::Form;
use super::super::limits::{Outcome, Stop};
use super::super::shape::Shape;
use super::Pieces;
use super::split_sizes::{Block, LEAST, Resolved, Size, Slab, resolve};
use crate::cga::program::{Prefix, SplitBlock, SplitItem, Successor};
use crate::source::Span;

/// Slabs with the blocks to run in them.
pub struct Layout<'p> {
    pub slabs: Vec<Slab>,
    bodies: Vec<&'p Successor>,
}

/// Evaluates every size once, in source order, and lays the blocks out over `total` (metres, square metres or texture
/// units). A total of nothing gives no slabs and a warning.
pub fn lay_out<'p>(
    run: &mut Derivation<'p>,
    block: &'p SplitBlock,
    total: f64,
    span: Span,
    env: &Env,
) -> Outcome<Layout<'p>> {
    let mut bodies = Vec::new();
    let blocks = evaluate(run, block, &mut bodies, env)?;
    let pattern = [Block::Group { blocks, repeat: block.repeat }];
    let slabs = slabs(run, &pattern, total, span)?;
    Ok(Layout { slabs, bodies })
}

/// Lays evaluated blocks out; says where something was asked for that cannot be made.
pub fn slabs(run: &mut Derivation, pattern: &[Block], total: f64, span: Span) -> Outcome<Vec<Slab>> {
    if total < LEAST {
        run.warn("cga::split-flat", span, || "there is no extent to split here, so there are no pieces".into());
        return Ok(Vec::new());
    }
    let Ok(Resolved { slabs, too_thin }) = resolve(pattern, total, run.shapes_left()) else {
        run.count_shapes(usize::MAX, span)?;
        return Err(Stop);
    };
    if let Some(size) = too_thin {
        run.warn("cga::split-size", span, || format!("a piece of size {size:e} is below {LEAST:e} and is not made"));
    }
    run.count_shapes(slabs.len(), span)?;
    Ok(slabs)
}

pub fn size(prefix: Prefix, x: f64) -> Size {
    match prefix {
        Prefix::Absolute => Size::Absolute(x),
        Prefix::Relative => Size::Relative(x),
        Prefix::Floating => Size::Floating(x),
    }
}

fn evaluate<'p>(
    run: &mut Derivation<'p>,
    block: &'p SplitBlock,
    bodies: &mut Vec<&'p Successor>,
    env: &Env,
) -> Outcome<Vec<Block>> {
    let mut blocks = Vec::with_capacity(block.items.len());
    for item in &block.items {
        blocks.push(match item {
            SplitItem::Piece { prefix, size: expr, body } => {
                let x = run.eval_finite(expr, env)?;
                bodies.push(body);
                Block::Piece { size: size(*prefix, x), body: bodies.len() - 1 }
            }
            SplitItem::Group(group) => {
                Block::Group { blocks: evaluate(run, group, bodies, env)?, repeat: group.repeat }
            }
        });
    }
    Ok(blocks)
}

impl<'p> Layout<'p> {
    /// The pieces of the slabs that hold geometry (all, if the parent holds none), numbered in order.
    pub fn pieces(&self, forms: Vec<Form>, parent: &Shape, piece: impl Fn(usize, Form) -> Box<Shape>) -> Pieces<'p> {
        let mut pieces: Pieces<'p> = Vec::with_capacity(self.slabs.len());
        for (i, (slab, form)) in self.slabs.iter().zip(forms).enumerate() {
            if !form.is_empty() || parent.form.is_empty() {
                pieces.push((piece(i, form), self.bodies[slab.body]));
            }
        }
        let total = pieces.len() as u32;
        for (index, (piece, _)) in pieces.iter_mut().enumerate() {
            piece.split_index = index as i32;
            piece.split_total = total;
        }
        pieces
    }
}
