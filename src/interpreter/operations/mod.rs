//! The operations of reference 4, one file each.
//!
//! In: evaluated arguments and a shape. Out: the shape changed, or new shapes with the blocks to run on them.

mod align_to_axes;
mod align_to_box;
mod align_to_geometry;
mod appearance;
mod args;
mod auto_tags;
mod center;
mod cleanup;
pub mod comp;
mod component_list;
mod components;
mod convexify;
mod delete_holes;
mod edge_tags;
mod envelope;
mod extrude;
mod footprint;
mod inner_rectangle;
mod insert;
mod insert_along_uv;
mod insert_cleanup;
mod label;
mod mirror;
mod normals;
mod offset;
mod perimeter;
mod plan_faces;
mod primitive;
mod rectify;
mod reduce;
mod regions;
mod report;
mod reset_geometry;
mod reverse_normals;
mod roof;
mod roof_edges;
mod roof_shape;
mod scatter;
mod scatter_gauss;
mod scatter_solid;
mod set;
mod set_material;
mod set_pivot;
mod setback;
mod setback_tags;
mod setback_to_area;
pub mod setback_uv;
mod shape_wings;
mod split;
mod split_area;
mod split_pattern;
mod split_perimeter;
mod split_sizes;
mod split_uv;
mod strips;
mod tag;
mod taper;
mod transform;
mod trim;
mod uv;
mod uv_tiling;

pub use primitive::unit_cube;
pub use set::set;
pub use tag::levels as tag_levels;

use super::derivation::Derivation;
use super::environment::Env;
use super::expression::Evaluated;
use super::limits::Outcome;
use super::shape::{Scope, Shape};
use crate::cga::builtins::Operation;
use crate::cga::program::{Item, SplitKind, Successor};
use crate::source::Span;
use args::Args;

/// New shapes with the blocks to run on them, in order.
pub type Pieces<'p> = Vec<(Box<Shape>, &'p Successor)>;

/// Runs an operation without a block.
pub fn apply(
    run: &mut Derivation,
    operation: Operation,
    args: &[Evaluated],
    span: Span,
    shape: &mut Shape,
    reference: &Scope,
) -> Outcome<()> {
    use Operation as O;
    let args = Args::new(args, span);
    match operation {
        O::T => transform::t(run, &args, shape),
        O::S => transform::s(run, &args, shape),
        O::R => transform::r(run, &args, shape),
        O::Translate => transform::translate(run, &args, shape),
        O::Rotate => transform::rotate(run, &args, shape),
        O::RotateScope => transform::rotate_scope(run, &args, shape),
        O::Center => center::apply(&args, shape, reference),
        O::SetPivot => set_pivot::apply(run, &args, shape),
        O::MirrorScope => mirror::scope(&args, shape),
        O::Mirror => mirror::geometry(&args, shape),
        O::ReverseNormals => reverse_normals::apply(shape),
        O::AlignScopeToAxes => align_to_axes::apply(run, &args, shape),
        O::AlignScopeToGeometry => align_to_geometry::apply(run, &args, shape),
        O::AlignScopeToGeometryBBox => align_to_box::apply(run, &args, shape),
        O::InnerRect => inner_rectangle::replace(run, &args, shape),
        O::Envelope => envelope::apply(run, &args, shape),
        O::Convexify => convexify::apply(run, &args, shape),
        O::Rectify => rectify::apply(run, &args, shape),
        O::ReduceGeometry => reduce::apply(run, &args, shape),
        O::Footprint => footprint::apply(run, &args, shape),
        O::Taper => taper::apply(run, &args, shape),
        O::Extrude => extrude::apply(run, &args, shape)?,
        O::Offset => offset::apply(run, &args, shape),
        O::RoofGable => roof::gable(run, &args, shape),
        O::RoofHip => roof::hip(run, &args, shape),
        O::RoofPyramid => roof::pyramid(run, &args, shape),
        O::RoofShed => roof::shed(run, &args, shape),
        O::RoofShape => roof_shape::apply(run, &args, shape),
        O::RoofRidge => roof::ridge(run, &args, shape),
        O::PrimitiveCube => primitive::cube(run, &args, shape),
        O::PrimitiveQuad => primitive::quad(run, &args, shape),
        O::PrimitiveDisk => primitive::disk(run, &args, shape),
        O::PrimitiveCylinder => primitive::cylinder(run, &args, shape),
        O::PrimitiveCone => primitive::cone(run, &args, shape),
        O::PrimitiveSphere => primitive::sphere(run, &args, shape),
        O::InsertAlongUv => insert_along_uv::apply(run, &args, shape)?,
        O::Insert => insert::apply(run, &args, shape)?,
        O::ResetGeometry => reset_geometry::apply(run, shape),
        O::Trim => trim::apply(run, shape, span),
        O::CleanupGeometry => cleanup::apply(run, &args, shape),
        O::DeleteHoles => delete_holes::apply(shape),
        O::Color => appearance::color(run, &args, shape),
        O::Texture => appearance::texture(run, &args, shape),
        O::SetMaterial => set_material::apply(run, &args, shape),
        O::ResetMaterial => appearance::reset(&args, shape),
        O::SetupProjection => uv::setup_projection(run, &args, shape),
        O::ProjectUv => uv::project(run, &args, shape),
        O::TranslateUv => uv::translate(run, &args, shape),
        O::ScaleUv => uv::scale(run, &args, shape),
        O::RotateUv => uv::rotate(run, &args, shape),
        O::CopyUv => uv::copy(run, &args, shape),
        O::DeleteUv => uv::delete(run, &args, shape),
        O::NormalizeUv => uv_tiling::normalize(run, &args, shape),
        O::TileUv => uv_tiling::tile(run, &args, shape),
        O::SetNormals => normals::set(&args, shape),
        O::SoftenNormals => normals::soften_below(run, &args, shape),
        O::Tag => tag::tag(run, &args, shape),
        O::DeleteTags => tag::delete(&args, shape),
        O::SetTagsFromEdgeAttrs => edge_tags::apply(run, shape),
        O::Label => label::apply(run, &args, shape),
        O::Report => report::report(run, &args),
        O::Print => report::print(run, &args)?,
        other => unreachable!("`{}` is an item of its own", other.name()),
    }
    if operation.inserts() {
        trim::inserted(run, shape, span);
    }
    Ok(())
}

/// Runs an operation with a block as far as the new shapes.
pub fn pieces<'p>(run: &mut Derivation<'p>, item: &'p Item, env: &Env) -> Outcome<Pieces<'p>> {
    match item {
        Item::Split { kind: SplitKind::Scope { axis, adjust }, block, span } => {
            split::along_scope(run, *axis, *adjust, block, *span, env)
        }
        Item::Split { kind: SplitKind::Area { axis, adjust }, block, span } => {
            split_area::by_area(run, *axis, *adjust, block, *span, env)
        }
        Item::Split { kind: SplitKind::Uv { v, metres, set }, block, span } => {
            let along = split_uv::Along { v: *v, metres: *metres, set };
            split_uv::along_texture(run, &along, block, *span, env)
        }
        Item::Scatter { args, body, span } => {
            let evaluated = run.eval_args(args, env)?;
            scatter::pieces(run, &Args::new(&evaluated, *span), body, env)
        }
        Item::Comp { component, keep_axes, selectors, span } => {
            comp::pieces(run, *component, *keep_axes, selectors, *span, env)
        }
        Item::Regions { operation, args, selectors, span } => {
            regions::pieces(run, *operation, args, selectors, *span, env)
        }
        Item::PerimeterSplit { args, pattern, remainder, span } => {
            split_perimeter::pieces(run, args, pattern, remainder.as_deref(), *span, env)
        }
        Item::Operation { .. }
        | Item::Set { .. }
        | Item::Call { .. }
        | Item::Instantiate { .. }
        | Item::Leaf { .. }
        | Item::Discard
        | Item::Inline { .. }
        | Item::Boolean { .. }
        | Item::Modify { .. }
        | Item::Group(_) => Ok(Vec::new()),
    }
}
