//! Orientation selectors. In: a world direction, the scope it is seen from, and a word. Out: whether they agree
//! (reference 3.5).

use glam::DVec3;

use super::placement::Frame;
use super::shape::Scope;
use crate::cga::builtins::Word;

/// The six sectors around the axes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sector {
    Front,
    Back,
    Right,
    Left,
    Top,
    Bottom,
}

/// Ties at exactly 45 degrees: horizontal before top and bottom, front and back before left and right.
const TIE: f64 = 1e-6;

fn sector(v: DVec3) -> Option<Sector> {
    let level = libm::hypot(v.x, v.z);
    let length = v.length();
    if length == 0.0 {
        return None;
    }
    Some(if v.y.abs() > level + TIE * length {
        if v.y > 0.0 { Sector::Top } else { Sector::Bottom }
    } else if v.z.abs() >= v.x.abs() - TIE * length {
        if v.z > 0.0 { Sector::Front } else { Sector::Back }
    } else if v.x > 0.0 {
        Sector::Right
    } else {
        Sector::Left
    })
}

/// Elevation above the frame's xz-plane, degrees.
fn elevation(v: DVec3) -> f64 {
    libm::atan2(v.y, libm::hypot(v.x, v.z)).to_degrees()
}

/// What a word asks of a direction.
enum Question {
    Sector(Family, Sector),
    /// Any of the four horizontal sectors.
    Sideways(Family),
    /// Elevation in (from, to].
    Elevation(f64, f64),
    Horizontal,
    NotHorizontal,
}

#[derive(Clone, Copy)]
enum Family {
    Scope,
    Object,
    World,
}

fn question(word: Word) -> Option<Question> {
    use Question::Sector as S;
    use Word as W;
    Some(match word {
        W::Front => S(Family::Scope, Sector::Front),
        W::Back => S(Family::Scope, Sector::Back),
        W::Right => S(Family::Scope, Sector::Right),
        W::Left => S(Family::Scope, Sector::Left),
        W::Top => S(Family::Scope, Sector::Top),
        W::Bottom => S(Family::Scope, Sector::Bottom),
        W::ObjectFront => S(Family::Object, Sector::Front),
        W::ObjectBack => S(Family::Object, Sector::Back),
        W::ObjectRight => S(Family::Object, Sector::Right),
        W::ObjectLeft => S(Family::Object, Sector::Left),
        W::ObjectTop => S(Family::Object, Sector::Top),
        W::ObjectBottom => S(Family::Object, Sector::Bottom),
        W::ObjectSide => Question::Sideways(Family::Object),
        W::WorldSouth => S(Family::World, Sector::Front),
        W::WorldNorth => S(Family::World, Sector::Back),
        W::WorldEast => S(Family::World, Sector::Right),
        W::WorldWest => S(Family::World, Sector::Left),
        W::WorldUp => S(Family::World, Sector::Top),
        W::WorldDown => S(Family::World, Sector::Bottom),
        W::WorldSide => Question::Sideways(Family::World),
        W::Vertical => Question::Elevation(-11.25, 11.25),
        W::Aslant => Question::Elevation(11.25, 78.75),
        W::Nutant => Question::Elevation(-78.75, -11.25),
        W::Horizontal => Question::Horizontal,
        W::Side => Question::NotHorizontal,
        _ => return None,
    })
}

/// Whether a world direction lies where the word says, seen from the scope, the object frame or the world.
/// `None` if the word is no orientation. A zero direction agrees with nothing.
pub fn agrees(word: Word, direction: DVec3, scope: &Scope, object: &Frame) -> Option<bool> {
    let question = question(word)?;
    if direction == DVec3::ZERO {
        return Some(false);
    }
    // A negative size turns the axis of the scope frame around.
    let in_scope = || scope.frame.local_direction(direction) * scope.size.map(|s| if s < 0.0 { -1.0 } else { 1.0 });
    let seen = |family: Family| match family {
        Family::Scope => in_scope(),
        Family::Object => object.local_direction(direction),
        Family::World => direction,
    };
    let steep = |e: f64| !(e > -78.75 && e <= 78.75);
    Some(match question {
        Question::Sector(family, wanted) => sector(seen(family)) == Some(wanted),
        Question::Sideways(family) => !matches!(sector(seen(family)), Some(Sector::Top | Sector::Bottom)),
        Question::Elevation(from, to) => {
            let e = elevation(in_scope());
            e > from && e <= to
        }
        Question::Horizontal => steep(elevation(in_scope())),
        Question::NotHorizontal => !steep(elevation(in_scope())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(elevation: f64, words: &[(Word, bool)]) {
        let (y, z) = libm::sincos(elevation.to_radians());
        let scope = Scope { frame: Frame::WORLD, size: DVec3::ONE };
        for &(word, expected) in words {
            let got = agrees(word, DVec3::new(0.0, y, z), &scope, &Frame::WORLD);
            assert_eq!(got, Some(expected), "{} at {elevation}", word.text());
        }
    }

    #[test]
    fn sectors_and_elevations_follow_the_reference() {
        seen(60.0, &[(Word::Top, true), (Word::Aslant, true), (Word::Side, true), (Word::Horizontal, false)]);
        seen(80.0, &[(Word::Top, true), (Word::Horizontal, true), (Word::Side, false)]);
        seen(40.0, &[(Word::Front, true), (Word::Aslant, true), (Word::Side, true), (Word::Top, false)]);
        seen(45.0, &[(Word::Front, true), (Word::Top, false), (Word::WorldSouth, true)]);
        seen(-90.0, &[(Word::Bottom, true), (Word::Horizontal, true), (Word::Nutant, false)]);
    }

    #[test]
    fn a_negative_size_swaps_front_and_back() {
        let scope = Scope { frame: Frame::WORLD, size: DVec3::new(1.0, 1.0, -1.0) };
        assert_eq!(agrees(Word::Back, DVec3::Z, &scope, &Frame::WORLD), Some(true));
        assert_eq!(agrees(Word::ObjectFront, DVec3::Z, &scope, &Frame::WORLD), Some(true));
        assert_eq!(agrees(Word::Border, DVec3::Z, &scope, &Frame::WORLD), None);
    }
}
