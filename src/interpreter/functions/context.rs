//! Questions about other shapes (reference 6.8): `inside`, `overlaps`, `touches`, `minimumDistance`, `contextCount`,
//! `contextCompare`. In a first derivation they have their defaults: false, infinity and 0.

use std::cell::OnceCell;
use std::sync::Arc;

use super::super::context::{ContextShape, Surroundings, scope_box};
use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::measure;
use super::super::seed::Seed;
use super::super::shape::Shape;
use super::super::value::Value;
use super::Input;
use crate::cga::builtins::{Function as F, Word};
use crate::geometry::box_tree::Bounds;
use crate::geometry::proximity::{Location, Meeting, Solid, TOLERANCE};

pub fn call(run: &Derivation, function: F, input: &Input, shape: &Shape) -> Option<Value> {
    let surroundings = run.context.surroundings;
    let target = input.word(0).unwrap_or(Word::All);
    let label = input.text(1);
    Some(match function {
        F::Inside | F::Overlaps | F::Touches => {
            Value::Bool(surroundings.is_some_and(|s| Occlusion::new(run, shape).any(s, function, target, &label)))
        }
        F::MinimumDistance => {
            Value::Float(surroundings.map_or(f64::INFINITY, |s| distance(run, s, target, &label, shape)))
        }
        F::ContextCount => {
            Value::Float(surroundings.map_or(0, |s| labelled(s, target, &label, |_| false).count()) as f64)
        }
        F::ContextCompare => {
            Value::Float(surroundings.map_or(0, |s| rank(s, target, &label, input.word(2), shape)) as f64)
        }
        _ => return None,
    })
}

/// Shapes with a label in the target: of this start shape, of others, or of all. The empty label is none. `except`
/// leaves out shapes of this start shape.
fn labelled<'s>(
    surroundings: &'s Surroundings,
    target: Word,
    label: &'s str,
    except: impl Fn(&ContextShape) -> bool + 's,
) -> impl Iterator<Item = &'s ContextShape> {
    let own = surroundings.own.filter(|_| target != Word::Inter && !label.is_empty()).into_iter();
    let own = own.flat_map(move |survey| survey.labelled(label)).filter(move |shape| !except(shape));
    let others = surroundings.labelled.iter().filter(move |_| target != Word::Intra && !label.is_empty());
    own.chain(others.flat_map(move |survey| survey.labelled(label)))
}

/// Least distance of the scopes of labelled shapes, without those this shape was made from or that were made from it.
fn distance(run: &Derivation, surroundings: &Surroundings, target: Word, label: &str, shape: &Shape) -> f64 {
    let trail = run.trail(shape);
    let own = scope_box(&shape.scope);
    let others = labelled(surroundings, target, label, |other| other.is_related(&trail));
    others.map(|other| own.distance(&scope_box(&other.scope))).fold(f64::INFINITY, f64::min)
}

/// Differences up to this are none, metres or square metres.
const TIE: f64 = 1e-6;

/// How many labelled shapes come before this one.
fn rank(surroundings: &Surroundings, target: Word, label: &str, mode: Option<Word>, shape: &Shape) -> usize {
    // The more of it the earlier.
    let amount = |form: &Form, center: glam::DVec3| match mode {
        Some(Word::Northernmost) => -center.z,
        Some(Word::Southernmost) => center.z,
        Some(Word::Easternmost) => center.x,
        Some(Word::Westernmost) => -center.x,
        Some(Word::Highest) => center.y,
        Some(Word::WorldLowest) => -center.y,
        Some(Word::AreaSmallest) => -measure::form_area(form),
        _ => measure::form_area(form),
    };
    let own = amount(&shape.world_form(), shape.scope.center());
    labelled(surroundings, target, label, |_| false).filter(|o| amount(&o.form, o.scope.center()) > own + TIE).count()
}

/// The current shape, to be held against occluders.
struct Occlusion {
    form: Arc<Form>,
    trail: Vec<Seed>,
    /// Its own closed geometry, made when it is first asked for.
    solid: OnceCell<Option<Solid>>,
}

impl Occlusion {
    fn new(run: &Derivation, shape: &Shape) -> Self {
        Occlusion { form: shape.world_form(), trail: run.trail(shape), solid: OnceCell::new() }
    }

    /// Whether some occluder answers yes. Shapes this one was made from, and those made from it, are none.
    fn any(&self, surroundings: &Surroundings, question: F, target: Word, label: &str) -> bool {
        let Some(bounds) = Bounds::around(self.form.mesh.positions.iter().copied()) else { return false };
        let bounds = bounds.grown(TOLERANCE);
        let own = surroundings.own.filter(|_| target != Word::Inter).into_iter();
        let own = own.flat_map(|survey| survey.touching(&bounds)).filter(|o| !o.is_related(&self.trail));
        let near = surroundings.near.iter().filter(|_| target != Word::Intra);
        let near = near.flat_map(|survey| survey.touching(&bounds));
        let mut occluders = own.chain(near).filter(|o| label.is_empty() || o.label.as_deref() == Some(label));
        occluders.any(|occluder| occluder.solid().is_some_and(|solid| self.answer(question, solid)))
    }

    fn answer(&self, question: F, other: &Solid) -> bool {
        if self.form.mesh.faces.is_empty() {
            let places = self.places(other);
            return match question {
                F::Inside => !places.is_empty() && !places.contains(&Location::Outside),
                F::Overlaps => places.contains(&Location::Inside),
                _ => places.iter().any(|place| *place != Location::Outside),
            };
        }
        let mut meetings = self.form.mesh.faces.iter().map(|face| other.meeting(&self.form.mesh, face));
        match question {
            F::Inside => !meetings.any(|m| m.outside),
            F::Overlaps => self.overlaps(meetings, other, false),
            _ => self.overlaps(meetings, other, true),
        }
    }

    /// Shares some of the inside: a face of one runs inside the other, or faces of both lie on each other and look the
    /// same way; or, if contact is enough, touches.
    fn overlaps(&self, meetings: impl Iterator<Item = Meeting>, other: &Solid, contact: bool) -> bool {
        let mut same = false;
        for meeting in meetings {
            if meeting.inside || contact && (meeting.same || meeting.opposite) {
                return true;
            }
            same |= meeting.same;
        }
        let Some(own) = self.solid.get_or_init(|| Solid::new(&self.form.mesh)) else { return false };
        same || other.mesh().faces.iter().any(|face| own.meeting(other.mesh(), face).inside)
    }

    /// Where the parts of bare edges, or bare points, are.
    fn places(&self, other: &Solid) -> Vec<Location> {
        let positions = &self.form.mesh.positions;
        if self.form.edges.is_empty() {
            return positions.iter().map(|&p| other.locate(p)).collect();
        }
        let line = |[a, b]: &[u32; 2]| other.locations(positions[*a as usize], positions[*b as usize]);
        self.form.edges.iter().flat_map(line).collect()
    }
}
