//! In: the rings of a footprint. Out: nothing, or a panic that names what is wrong with its repair, skeleton, roofs or
//! offsets.

use arbitrary::{Result, Unstructured};
use glam::DVec2;

use crate::geometry::mesh_checks::{Defect, defects};
use crate::geometry::offset::offset;
use crate::geometry::repair::{Options, Verdict, repair};
use crate::geometry::skeleton::SkeletonError;
use crate::geometry::roof::{Facing, RoofShape, Slope, sound};
use crate::geometry::{Polygon, Ring};
use crate::judge::judge;

/// Least area of parts, as the generated footprints of the benchmark have it.
const OPTIONS: Options = Options { weld: 0.0, min_area: 1e-9 };

/// Every footprint has an answer; what comes out of it is whole.
pub fn check(rings: &[Ring], bytes: &mut Unstructured<'_>) -> Result<()> {
    let options = if bytes.ratio(1u8, 3u8)? { Options::default() } else { OPTIONS };
    let judged = judge(rings, &options);
    if !is_fine_enough(rings) {
        return Ok(());
    }
    assert!(judged.defects.is_empty(), "{:?}\n{rings:?}", judged.defects);
    assert!(judged.area_error < 1e-6, "the faces miss {:e} of the area\n{rings:?}", judged.area_error);
    let repaired = repair(rings, &options);
    assert_eq!(matches!(repaired.verdict, Verdict::Rejected(_)), repaired.polygons.is_empty(), "{rings:?}");
    for polygon in repaired.polygons.iter().filter(|p| p.rings().map(Vec::len).sum::<usize>() < 80) {
        check_roofs(polygon, bytes)?;
        check_offsets(polygon, bytes)?;
    }
    Ok(())
}

/// Whether the numbers that far from the origin are finer than a billionth of the extent.
fn is_fine_enough(rings: &[Ring]) -> bool {
    let points = || rings.iter().flatten().copied();
    let low = points().fold(DVec2::INFINITY, DVec2::min);
    let high = points().fold(DVec2::NEG_INFINITY, DVec2::max);
    let farthest = low.abs().max(high.abs()).max_element();
    farthest * f64::EPSILON < 1e-9 * (high - low).max_element()
}

/// A roof of any shape passes its checks or is replaced by one that does.
fn check_roofs(polygon: &Polygon, bytes: &mut Unstructured<'_>) -> Result<()> {
    let shape = *bytes.choose(&RoofShape::ALL)?;
    let slope = match bytes.ratio(1u8, 2u8)? {
        true => Slope::Angle(f64::from(bytes.int_in_range(0..=89u8)?)),
        false => Slope::Height(f64::from(bytes.arbitrary::<u16>()?) / 100.0),
    };
    let facing = match bytes.int_in_range(0..=3u8)? {
        0 => Facing::Natural,
        1 => Facing::Along,
        2 => Facing::Across,
        _ => {
            let (sin, cos) = libm::sincos(f64::from(bytes.arbitrary::<u16>()?) / 1e4);
            Facing::Downhill(DVec2::new(cos, sin))
        }
    };
    let context = || format!("{} {slope:?} {facing:?} over {polygon:?}", shape.name());
    let made = sound(polygon, slope, &[], (shape.name(), shape.build(polygon, slope, facing)));
    let Ok(made) = made else { panic!("{}: {}", made.unwrap_err(), context()) };
    let Some(roof) = made.roof else { return Ok(()) };
    let level = roof.mesh.bounds().is_none_or(|(low, high)| low.y == high.y);
    let found = if level { Vec::new() } else { defects(&roof.mesh, &[Defect::DegenerateTriangle]) };
    assert!(found.is_empty(), "{found:?} after {:?}: {}", made.steps, context());
    Ok(())
}

/// Offsets are polygons, smaller inwards and larger outwards.
fn check_offsets(polygon: &Polygon, bytes: &mut Unstructured<'_>) -> Result<()> {
    let Some((low, high)) = polygon.bounds() else { return Ok(()) };
    let extent = (high - low).max_element();
    let distance = extent * f64::from(bytes.arbitrary::<i8>()?) / 256.0;
    let context = || format!("offset {distance} of {polygon:?}");
    let made = match offset(polygon, distance) {
        // Nothing is left of a sliver on the grid of what it grows into.
        Err(SkeletonError::NotSimple) if distance > 0.0 && polygon.area() < 1e-7 * extent * extent => return Ok(()),
        made => made.unwrap_or_else(|why| panic!("{why}: {}", context())),
    };
    let area: f64 = made.inside.iter().map(Polygon::area).sum();
    let slack = 1e-7 * extent * extent;
    let grown = area - polygon.area();
    assert!(area.is_finite() && grown * distance.signum() >= -slack, "the area grows by {grown}: {}", context());
    Ok(())
}
