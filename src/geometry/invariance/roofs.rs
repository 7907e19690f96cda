//! Roofs move with their polygon. In: random polygons, motions, every roof. Out: differences of their faces.

use glam::DVec2;
use proptest::prelude::*;

use super::skeletons::has_margin;
use super::*;
use crate::geometry::mesh_checks::{is_closed, surface_area, volume};
use crate::geometry::roof::{self, Facing, Roof, RoofError, RoofPart, RoofShape, Slope};
use crate::geometry::skeleton::skeleton;

/// A roof by number over a polygon, with all that has a direction or an edge turned along.
fn build(number: usize, p: &Polygon, choice: &Choice) -> Result<Option<Roof>, RoofError> {
    let Choice { slope, facing, edge, length, along } = *choice;
    let angle = match slope {
        Slope::Angle(angle) => angle,
        Slope::Height(_) => 40.0,
    };
    let roof = match number {
        0 => roof::hip(p, slope, 0.0, false)?,
        1 => roof::hip(p, slope, length, false)?,
        2 => roof::hip(p, slope, 0.0, true)?,
        3 => roof::gable(p, slope, 0.0, 0.0, false, None)?,
        4 => roof::gable(p, slope, length, length / 2.0, false, None)?,
        5 => roof::gable(p, slope, 0.0, 0.0, true, Some(edge as i64))?,
        6 => roof::half_hipped(p, slope, 0.4)?,
        7 => roof::pyramid(p, slope)?,
        8 => roof::ridge(p, slope, along)?,
        9 => roof::shed(p, slope, edge as i64)?,
        10 => roof::skillion(p, slope, along)?,
        11 => roof::saltbox(p, slope, along)?,
        12 => roof::mansard(p, 70.0, 20.0, length)?,
        13 => roof::gambrel(p, 60.0, 30.0, length)?,
        14 => roof::dome(p, 3.0 * length, 6)?,
        15 => roof::round(p, 3.0 * length, 6)?,
        16 => roof::flat(p),
        _ => return RoofShape::ALL[number - 17].build(p, Slope::Angle(angle), facing),
    };
    Ok(Some(roof))
}

const ROOFS: usize = 17 + RoofShape::ALL.len();

/// Of these the roofs that reach beyond their walls.
const OVERHANGING: [usize; 2] = [1, 4];

/// Of these the roofs with `even`.
const LEVELLED: [usize; 2] = [2, 5];

/// Gables, and roofs that are cut at heights: their faces have more corners than the planes of a hip roof.
fn needs_margin(number: usize) -> bool {
    use RoofShape as R;
    let shape = |n: usize| {
        matches!(RoofShape::ALL[n - 17], R::Gabled | R::HalfHipped | R::Gambrel | R::Round | R::Mansard | R::Dome)
    };
    matches!(number, 3..=6 | 12..=15) || (number >= 17 && shape(number))
}

/// What a roof is asked for beside its shape.
#[derive(Clone, Copy, Debug)]
struct Choice {
    slope: Slope,
    facing: Facing,
    edge: usize,
    length: f64,
    along: DVec2,
}

impl Choice {
    fn moved(&self, p: &Polygon, motion: &Motion) -> Choice {
        let slope = match self.slope {
            Slope::Height(h) => Slope::Height(h * motion.scale),
            angle => angle,
        };
        let facing = match self.facing {
            Facing::Downhill(d) => Facing::Downhill(motion.direction(d)),
            other => other,
        };
        let edge = motion.edge(p, self.edge % p.outer.len());
        Choice { slope, facing, edge, length: self.length * motion.scale, along: motion.direction(self.along) }
    }
}

fn choices() -> impl Strategy<Value = Choice> {
    let slopes = prop_oneof![(5.0..80.0f64).prop_map(Slope::Angle), (0.5..9.0f64).prop_map(Slope::Height)];
    let direction = || (0.0..TAU).prop_map(|a| DVec2::new(libm::cos(a), libm::sin(a)));
    let facings = prop_oneof![
        direction().prop_map(Facing::Downhill),
        prop::sample::select(vec![Facing::Natural, Facing::Along, Facing::Across])
    ];
    (slopes, facings, 0usize..20, 0.3..2.0f64, direction()).prop_map(|(slope, facing, edge, length, along)| Choice {
        slope,
        facing,
        edge,
        length,
        along,
    })
}

/// Edges that end a ridge are chosen by what an outline offers; if it offers two things alike, one must be taken.
fn is_undecided(number: usize, p: &Polygon, choice: &Choice, motion: &Motion) -> bool {
    let edge = |i: usize| p.outer[(i + 1) % p.outer.len()] - p.outer[i];
    let n = p.outer.len();
    let lengths_tie = (0..n).any(|i| (0..i).any(|j| (edge(i).length() - edge(j).length()).abs() < 1e-6 * extent(p)));
    let turns = match choice.facing {
        Facing::Natural => false,
        // Along which of its edges, if two are turned from it alike.
        Facing::Downhill(d) => (0..n).any(|i| {
            let along = |i: usize| edge(i).normalize().dot(d).abs();
            let turn = |i: usize| along(i).min((1.0 - along(i).powi(2)).max(0.0).sqrt());
            let crosses = |j: usize| edge(i).normalize().perp_dot(edge(j).normalize()).abs() > 1e-9;
            (0..i).any(|j| (turn(i) - turn(j)).abs() < 1e-6 && (n > 4 || crosses(j)))
        }),
        // Of more than four edges two that are parallel may both end the ridge.
        Facing::Along | Facing::Across => {
            let parallel = |i: usize, j: usize| edge(i).normalize().perp_dot(edge(j).normalize()).abs() < 1e-9;
            lengths_tie || (n > 4 && (0..n).any(|i| (0..i).any(|j| parallel(i, j))))
        }
    };
    // A rectangle and its first edge look the same in a mirror; a saltbox does not.
    let is_saltbox = number >= 17 && RoofShape::ALL[number - 17] == RoofShape::Saltbox;
    let mirrored = is_saltbox && motion.mirrors() && !matches!(choice.facing, Facing::Downhill(_));
    // The opposite of an edge is counted along the ring; of an odd number of edges none lies opposite.
    let is_uneven = number == 5 && n % 2 == 1 && motion.mirrors();
    mirrored || is_uneven || (number >= 17 && turns) || (n == 3 && lengths_tie)
}

fn complaint(number: usize, p: &Polygon, choice: &Choice, motion: &Motion, share: f64) -> Option<String> {
    let moved = build(number, &motion.polygon(p), &choice.moved(p, motion));
    let (roof, moved) = match (build(number, p, choice), moved) {
        (Ok(Some(roof)), Ok(Some(moved))) => (roof, moved),
        (a, b) => return (a != b).then(|| format!("{a:?} became {b:?}")),
    };
    let own = |part: &RoofPart| match *part {
        RoofPart::Top { edge: Some(edge) } => RoofPart::Top { edge: Some(motion.edge(p, edge)) },
        RoofPart::Side { edge } => RoofPart::Side { edge: motion.edge(p, edge) },
        other => other,
    };
    let mut parts = [roof.parts.iter().map(own).collect::<Vec<_>>(), moved.parts.clone()];
    parts.iter_mut().for_each(|p| p.sort_by_key(|part| format!("{part:?}")));
    if parts[0] != parts[1] || roof.warnings != moved.warnings {
        return Some(format!("{:?} {:?} became {:?} {:?}", parts[0], roof.warnings, parts[1], moved.warnings));
    }
    let size = extent(p).max(extent_of(&roof.mesh));
    let compare = if motion.mirrors() { difference_of_loops } else { difference };
    compare(&motion.mesh(&roof.mesh), &moved.mesh, allowed(share, size, motion))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn roofs_follow_exact_motions(p in footprints(), choice in choices(), motion in exact(), number in 0..ROOFS) {
        prop_assume!(!is_undecided(number, &p, &choice, &motion));
        // Eaves end where slopes meet that may be all but parallel: an overhang of such a plan keeps a digit less.
        let share = if OVERHANGING.contains(&number) { 1e-8 } else { 1e-9 };
        prop_assert_eq!(complaint(number, &p, &choice, &motion, share), None, "roof {}", number);
    }

    #[test]
    fn roofs_of_houses_follow_exact_motions(p in houses(), choice in choices(), motion in exact(), number in 0..ROOFS) {
        prop_assume!(!is_undecided(number, &p, &choice, &motion));
        prop_assert_eq!(complaint(number, &p, &choice, &motion, 1e-8), None, "roof {}", number);
    }

    /// At arbitrary angles: the same roof by volume and surface. Not where a step of the grid decides: ridges levelled at the
    /// mean of their ends (rounding makes two ends of one), and gables beside walls on one line (rounding makes two
    /// lines of them, the step between them runs over the roof and cuts a corner off the triangle that stands up), and
    /// bent roofs beside them (far out the step folds faces, which the triangulation then leaves out).
    #[test]
    fn roofs_of_houses_keep_their_measures(p in houses(), choice in choices(), motion in any_motion(), number in 0..ROOFS) {
        prop_assume!(!is_undecided(number, &p, &choice, &motion) && !LEVELLED.contains(&number));
        prop_assume!(!needs_margin(number) || has_margin(&p, &skeleton(&p, None).expect("a skeleton")));
        let moved = build(number, &motion.polygon(&p), &choice.moved(&p, &motion));
        let (roof, moved) = match (build(number, &p, &choice), moved) {
            (Ok(Some(roof)), Ok(Some(moved))) => (roof.mesh, moved.mesh),
            (a, b) => {
                prop_assert_eq!(a, b);
                return Ok(());
            }
        };
        let (length, surface) = (motion.scale * extent_of(&roof), surface_area(&roof) * motion.scale.powi(2));
        let tolerance = allowed(3e-8, extent_of(&roof), &motion);
        prop_assert!((surface - surface_area(&moved)).abs() <= 30.0 * length * tolerance, "roof {number}: {surface} {}", surface_area(&moved));
        if !is_closed(&roof) {
            // Overhangs are sheets: there is no volume.
            return Ok(());
        }
        let space = volume(&roof) * motion.scale.powi(3);
        prop_assert!((space - volume(&moved)).abs() <= 10.0 * length * length * tolerance, "roof {number}: {space} {}", volume(&moved));
    }
}
