//! Dynamic import calls. In: a shape and new values for attributes of an import. Out: the shape with all attributes
//! and constants of that import evaluated again on it (reference 1.12).

use super::derivation::Derivation;
use super::limits::Outcome;
use super::shape::Shape;
use super::start::{default_value, host_value};
use super::value::Value;
use crate::cga::program::AttributeId;

/// Gives `shape` the import's attributes anew. The given values win over the host's, the host's over the file's.
pub fn instantiate(
    run: &mut Derivation,
    import: u32,
    given: Vec<(AttributeId, Value)>,
    shape: &mut Shape,
) -> Outcome<()> {
    let program = run.program;
    let kept: Vec<AttributeId> = given.iter().map(|(id, _)| *id).collect();
    for (id, value) in given {
        let kind = program.attribute(id).kind;
        set(shape, id, kind.map_or(value.clone(), |kind| value.converted(kind)));
    }
    let seed = shape.seed;
    for &id in program.import_attributes(import).iter().filter(|id| !kept.contains(id)) {
        let attribute = program.attribute(id);
        // The streets around the initial shape stay where they are.
        if attribute.is_map {
            continue;
        }
        let value = match host_value(run, attribute) {
            Some(value) => value,
            None => {
                shape.seed = seed.named(&attribute.name);
                default_value(run, attribute, shape)?
            }
        };
        set(shape, id, value);
    }
    shape.seed = seed;
    Ok(())
}

fn set(shape: &mut Shape, id: AttributeId, value: Value) {
    std::sync::Arc::make_mut(&mut shape.state_mut().attributes)[id.0 as usize] = value;
}
