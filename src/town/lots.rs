//! What stands on one block: outlines and tags.
//!
//! In: a block of the plan. Out: [`Thing`]s in ground metres about the centre of the town (x east, y north).

use glam::DVec2;

use super::layout::{BLOCK, Town, Use};
use crate::interpreter::seed::Seed;

/// An area to be written as a way, or as a multipolygon relation if it has a hole, or an open way.
#[derive(Clone, Debug)]
pub struct Thing {
    pub ring: Vec<DVec2>,
    pub hole: Option<Vec<DVec2>>,
    pub open: bool,
    pub tags: Vec<(&'static str, String)>,
}

impl Thing {
    fn area(ring: Vec<DVec2>, tags: Vec<(&'static str, String)>) -> Self {
        Thing { ring, hole: None, open: false, tags }
    }

    pub fn is_building(&self) -> bool {
        self.tags.iter().any(|(k, _)| *k == "building")
    }
}

/// A rectangle between two corners of a block, given as fractions of the block, inset by metres.
fn rectangle(town: &Town, corner: DVec2, inset: f64) -> Vec<DVec2> {
    let (lo, hi) = (corner + inset, corner + BLOCK - inset);
    let steps = 4;
    let along = |a: DVec2, b: DVec2| (0..steps).map(move |i| a + (b - a) * (i as f64 / steps as f64));
    let corners = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
    (0..4).flat_map(|i| along(corners[i], corners[(i + 1) % 4])).map(|p| town.warp(p)).collect()
}

/// A plan shape given in metres about its own middle, set on the ground at a grid point, turned with the street.
fn place(town: &Town, middle: DVec2, turn: f64, shape: &[(f64, f64)]) -> Vec<DVec2> {
    let (origin, angle) = (town.warp(middle), town.angle(middle) + turn);
    let (sin, cos) = libm::sincos(angle);
    shape.iter().map(|&(x, y)| origin + DVec2::new(x * cos - y * sin, x * sin + y * cos)).collect()
}

/// House outlines: rectangle, L, T and U, `w` wide and `d` deep, counter-clockwise from the front left.
fn house_shape(kind: f64, w: f64, d: f64) -> Vec<(f64, f64)> {
    let (x, y) = (w / 2.0, d / 2.0);
    match kind {
        k if k < 0.60 => vec![(-x, -y), (x, -y), (x, y), (-x, y)],
        k if k < 0.80 => vec![(-x, -y), (x, -y), (x, 0.1 * d), (0.1 * w, 0.1 * d), (0.1 * w, y + 2.0), (-x, y + 2.0)],
        k if k < 0.92 => {
            let (a, b) = (0.22 * w, y + 2.5);
            vec![(-x, -y), (x, -y), (x, 0.1 * d), (a, 0.1 * d), (a, b), (-a, b), (-a, 0.1 * d), (-x, 0.1 * d)]
        }
        _ => {
            let (a, b) = (0.18 * w, y + 3.0);
            vec![(-x, -y), (x, -y), (x, b), (a, b), (a, 0.0), (-a, 0.0), (-a, b), (-x, b)]
        }
    }
}

/// Everything on one block.
pub fn block(town: &Town, column: u32, row: u32, used: Use) -> Vec<Thing> {
    let corner = town.corner(column, row);
    let seed = town.seed.named("block").part(town.block_number(column, row));
    match used {
        Use::Houses => houses(town, corner, seed),
        Use::Courtyard => courtyard(town, corner, seed),
        Use::Industry => industry(town, corner, seed),
        Use::School => school(town, corner),
        Use::Park => park(town, corner),
        Use::River => vec![Thing::area(rectangle(town, corner, 7.0), vec![("landuse", "meadow".into())])],
        Use::Field => {
            let kinds = ["farmland", "meadow", "forest"];
            let kind = kinds[(seed.named("field").unit() * 3.0) as usize];
            vec![Thing::area(rectangle(town, corner, 5.0), vec![("landuse", kind.into())])]
        }
    }
}

fn houses(town: &Town, corner: DVec2, seed: Seed) -> Vec<Thing> {
    let mut things = vec![Thing::area(rectangle(town, corner, 6.0), vec![("landuse", "residential".into())])];
    let lots = 6 + u64::from(seed.named("lots").unit() < 0.4);
    for side in 0..2u64 {
        for lot in 0..lots {
            let s = seed.part(side).part(lot);
            let width = (BLOCK.x - 28.0) / lots as f64;
            let x = corner.x + 14.0 + width * (lot as f64 + 0.5) + (s.named("shift").unit() - 0.5) * 2.0;
            let front = 20.0 + 4.0 * s.named("front").unit();
            let (y, turn) =
                if side == 0 { (corner.y + front, 0.0) } else { (corner.y + BLOCK.y - front, std::f64::consts::PI) };
            let turn = turn + (s.named("turn").unit() - 0.5) * 0.08;
            things.extend(house(town, DVec2::new(x, y), turn, width, s));
        }
    }
    things
}

fn house(town: &Town, middle: DVec2, turn: f64, lot_width: f64, seed: Seed) -> Vec<Thing> {
    let w = (lot_width - 7.0).min(10.0 + 4.0 * seed.named("w").unit());
    let d = 7.5 + 2.5 * seed.named("d").unit();
    let levels = if seed.named("levels").unit() < 0.55 { 1 } else { 2 };
    let kinds = ["house", "detached", "residential", "yes"];
    let mut tags = vec![
        ("building", kinds[(seed.named("kind").unit() * 4.0) as usize].to_owned()),
        ("building:levels", levels.to_string()),
    ];
    let roof = seed.named("roof").unit();
    if roof < 0.75 {
        tags.push(("roof:shape", if roof < 0.45 { "gabled" } else { "hipped" }.to_owned()));
    }
    let mut things = vec![Thing::area(place(town, middle, turn, &house_shape(seed.named("shape").unit(), w, d)), tags)];
    if seed.named("garage").unit() < 0.22 {
        let back = DVec2::new(0.0, if libm::cos(turn) > 0.0 { 17.0 } else { -17.0 });
        let garage = [(-1.8, -3.0), (1.8, -3.0), (1.8, 3.0), (-1.8, 3.0)];
        let at = middle + back + DVec2::new(lot_width * 0.18, 0.0);
        things.push(Thing::area(
            place(town, at, turn, &garage),
            vec![("building", "garage".into()), ("height", "2.8 m".into())],
        ));
    }
    things
}

fn courtyard(town: &Town, corner: DVec2, seed: Seed) -> Vec<Thing> {
    let middle = corner + BLOCK / 2.0;
    let half = |x: f64, y: f64| [(-x, -y), (x, -y), (x, y), (-x, y)];
    let (x, y) = (46.0 + 6.0 * seed.named("w").unit(), 25.0 + 3.0 * seed.named("d").unit());
    let mut hole = place(town, middle, 0.0, &half(x - 13.0, y - 13.0));
    hole.reverse();
    vec![
        Thing::area(rectangle(town, corner, 6.0), vec![("landuse", "residential".into())]),
        Thing {
            ring: place(town, middle, 0.0, &half(x, y)),
            hole: Some(hole),
            open: false,
            tags: vec![
                ("building", "apartments".into()),
                ("building:levels", format!("{}", 3 + (seed.named("levels").unit() * 3.0) as u32)),
                ("roof:shape", "hipped".into()),
            ],
        },
    ]
}

fn industry(town: &Town, corner: DVec2, seed: Seed) -> Vec<Thing> {
    let mut things = vec![Thing::area(rectangle(town, corner, 6.0), vec![("landuse", "industrial".into())])];
    let mid = corner.y + BLOCK.y / 2.0;
    let drive = (0..=4).map(|i| town.warp(DVec2::new(corner.x + BLOCK.x * f64::from(i) / 4.0, mid))).collect();
    things.push(Thing { ring: drive, hole: None, open: true, tags: vec![("highway", "service".into())] });
    for i in 0..4u64 {
        let s = seed.named("hall").part(i);
        let (w, d) = (40.0 + 14.0 * s.named("w").unit(), 18.0 + 6.0 * s.named("d").unit());
        let x = corner.x + if i % 2 == 0 { 41.0 } else { 109.0 };
        let y = if i < 2 { corner.y + 22.0 } else { corner.y + BLOCK.y - 22.0 };
        let shape = if s.named("l").unit() < 0.3 {
            vec![
                (-w / 2.0, -d / 2.0),
                (w / 2.0, -d / 2.0),
                (w / 2.0, 0.0),
                (0.0, 0.0),
                (0.0, d / 2.0),
                (-w / 2.0, d / 2.0),
            ]
        } else {
            vec![(-w / 2.0, -d / 2.0), (w / 2.0, -d / 2.0), (w / 2.0, d / 2.0), (-w / 2.0, d / 2.0)]
        };
        let kind = if s.named("kind").unit() < 0.5 { "industrial" } else { "warehouse" };
        let height = format!("{:.1}", 6.0 + 5.0 * s.named("h").unit());
        things.push(Thing::area(
            place(town, DVec2::new(x, y), 0.0, &shape),
            vec![("building", kind.into()), ("height", height), ("roof:shape", "flat".into())],
        ));
    }
    things
}

fn school(town: &Town, corner: DVec2) -> Vec<Thing> {
    let shape = [
        (-34.0, -20.0),
        (34.0, -20.0),
        (34.0, 18.0),
        (21.0, 18.0),
        (21.0, -7.0),
        (-21.0, -7.0),
        (-21.0, 18.0),
        (-34.0, 18.0),
    ];
    vec![
        Thing::area(rectangle(town, corner, 6.0), vec![("landuse", "grass".into())]),
        Thing::area(
            place(town, corner + BLOCK / 2.0, 0.0, &shape),
            vec![("building", "school".into()), ("building:levels", "2".into()), ("roof:shape", "hipped".into())],
        ),
    ]
}

fn park(town: &Town, corner: DVec2) -> Vec<Thing> {
    let middle = corner + BLOCK / 2.0;
    let round = |r: f64, squash: f64, at: DVec2| -> Vec<DVec2> {
        let angle = |i: u32| f64::from(i) / 16.0 * std::f64::consts::TAU;
        (0..16).map(|i| town.warp(at + DVec2::new(libm::cos(angle(i)), squash * libm::sin(angle(i))) * r)).collect()
    };
    let path = |a: (f64, f64), b: (f64, f64)| Thing {
        ring: (0..=6)
            .map(|i| {
                let t = f64::from(i) / 6.0;
                let bow = DVec2::new(0.0, 9.0 * libm::sin(t * std::f64::consts::PI));
                town.warp(corner + DVec2::new(a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t) + bow)
            })
            .collect(),
        hole: None,
        open: true,
        tags: vec![("highway", "footway".into())],
    };
    vec![
        Thing::area(rectangle(town, corner, 6.0), vec![("leisure", "park".into())]),
        Thing::area(round(15.0, 0.7, middle + DVec2::new(34.0, -8.0)), vec![("natural", "water".into())]),
        Thing::area(round(17.0, 0.8, middle + DVec2::new(-40.0, 12.0)), vec![("natural", "wood".into())]),
        path((0.0, 10.0), (BLOCK.x, 60.0)),
        path((20.0, BLOCK.y), (BLOCK.x - 40.0, 0.0)),
    ]
}
