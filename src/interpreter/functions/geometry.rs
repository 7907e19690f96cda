//! Questions about the current geometry (reference 6.6).

use glam::DVec2;

use super::super::derivation::Derivation;
use super::super::measure;
use super::super::shape::Shape;
use super::super::value::Value;
use super::Input;
use crate::cga::builtins::{Function as F, Word};

pub fn call(run: &mut Derivation, function: F, input: &Input, shape: &Shape) -> Option<Value> {
    let mesh = &shape.form.mesh;
    let number = |x: usize| Value::Float(x as f64);
    Some(match function {
        F::GeometryArea => Value::Float(measure::area(run, shape, input.word(0))),
        F::GeometryIsOriented => Value::Bool(measure::is_oriented(run, shape, input.word(0).unwrap_or(Word::All))),
        F::GeometryAngle => {
            let (slope, normal) = measure::steepest(shape);
            Value::Float(match input.word(0) {
                Some(Word::Azimuth) => measure::azimuth(normal),
                Some(Word::Zenith) => 90.0 - slope,
                _ => slope,
            })
        }
        F::GeometryBoundaryLength => Value::Float(measure::boundary_length(shape)),
        F::GeometryHeight => Value::Float(measure::height(shape)),
        F::GeometryVolume => Value::Float(measure::volume(shape)),
        F::GeometryIsClosedSurface => Value::Bool(measure::is_closed(shape)),
        F::GeometryIsConcave => Value::Bool(measure::is_concave(shape)),
        F::GeometryIsInstanced => Value::Bool(shape.form.instanced),
        F::GeometryIsPlanar => Value::Bool(measure::is_planar(shape, input.float(0))),
        F::GeometryIsRectangular => Value::Bool(measure::is_rectangular(shape, input.float(0))),
        F::GeometryNFaces => number(mesh.faces.len()),
        F::GeometryNEdges => number(measure::count_edges(&shape.form)),
        F::GeometryNVertices => number(measure::count_vertices(&shape.form)),
        F::GeometryNHoles => number(mesh.faces.iter().map(|f| f.holes.len()).sum()),
        F::GeometryHasUvs => {
            let wanted = (input.len() > 0).then(|| input.uv_set(run, 0));
            Value::Bool(mesh.faces.iter().any(|f| match wanted {
                Some(set) => set.is_some_and(|set| f.uv(set).is_some()),
                None => !f.uvs.is_empty(),
            }))
        }
        F::GeometryDu | F::GeometryDv => {
            let extent = match (input.uv_set(run, 0), input.word(1)) {
                (None, _) => DVec2::ZERO,
                (Some(set), Some(Word::UnitSpace)) => measure::uv_extent_in_metres(shape, set),
                (Some(set), _) => measure::uv_range(&shape.form, set).map(|(low, high)| high - low).unwrap_or_default(),
            };
            Value::Float(if function == F::GeometryDu { extent.x } else { extent.y })
        }
        F::GeometryUMin | F::GeometryUMax | F::GeometryVMin | F::GeometryVMax => {
            let range = input.uv_set(run, 0).and_then(|set| measure::uv_range(&shape.form, set));
            let (low, high) = range.unwrap_or_default();
            Value::Float(match function {
                F::GeometryUMin => low.x,
                F::GeometryUMax => high.x,
                F::GeometryVMin => low.y,
                _ => high.y,
            })
        }
        _ => return None,
    })
}
