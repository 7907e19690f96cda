//! `getGeoCoord` and `getTreeKey` (reference 6.9): where the current shape is, on Earth and in the tree of shapes.

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::super::value::Value;
use super::Input;
use crate::cga::builtins::Word;

/// Position of the scope's origin: X east and Y north in metres of the scene, longitude and latitude in degrees. Without
/// a host that knows the place, longitude and latitude are NaN, with a warning.
pub fn geo_coordinate(run: &mut Derivation, input: &Input, shape: &Shape) -> Value {
    let origin = shape.scope.frame.origin;
    let wanted = input.word(0);
    match wanted {
        Some(Word::GeoX) => return Value::Float(origin.x),
        Some(Word::GeoY) => return Value::Float(0.0 - origin.z),
        _ => {}
    }
    let place = run.start.host.place.as_ref();
    let Some((lon, lat)) = place.and_then(|place| place.lon_lat(origin.x, origin.z)) else {
        run.warn("cga::no-place", input.span, || "nothing says where on Earth this scene lies; this is nan".into());
        return Value::Float(f64::NAN);
    };
    Value::Float(if wanted == Some(Word::Longitude) { lon } else { lat })
}

/// Child numbers from the root, such as `0;2;1;`; the same throughout a rule.
pub fn tree_key(run: &Derivation) -> Value {
    let path = run.path();
    Value::text(path.iter().map(|i| format!("{i};")).collect::<String>())
}
