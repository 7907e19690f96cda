//! How fast rules are derived, beside the crate symbios-shape on the same models. In: three rule files. Out: a table of
//! times and of models or leaves per second.
//!
//! Mansard gives meshes with texture coordinates, symbios-shape oriented boxes without meshes. Both start from
//! compiled rules and a lot; every call has a seed and a lot of its own.

use std::cell::Cell;
use std::sync::LazyLock;

use divan::Bencher;
use divan::counter::ItemsCount;
use glam::DVec3;
use mansard::cga::program::Program;
use mansard::cga::{CompileOptions, compile_text};
use mansard::geometry::{Face, Mesh};
use mansard::interpreter::seed::Seed;
use mansard::interpreter::tree::ShapeTree;
use mansard::interpreter::{Limits, NoAssets, StartShape, derive};
use mansard::source::SourceMap;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    divan::main();
}

/// Lots that differ, so that no call repeats the one before.
const LOTS: u64 = 64;

/// Width and depth of a lot, metres.
fn lot_size(number: u64) -> (f64, f64) {
    let step = (number % LOTS) as f64;
    (10.0 + 0.1 * step, 8.0 + 0.05 * step)
}

fn start_shape(number: u64, (width, depth): (f64, f64)) -> StartShape {
    let (x, z) = (3.0 * number as f64, -2.0 * number as f64);
    let corners = [(0.0, 0.0), (width, 0.0), (width, -depth), (0.0, -depth)];
    let positions = corners.iter().map(|&(dx, dz)| DVec3::new(x + dx, 0.0, z + dz)).collect();
    let mesh = Mesh { positions, faces: vec![Face::new([0, 1, 2, 3])] };
    StartShape::new(mesh, Seed::root(number), "lot")
}

/// One model: its rules in both languages and how to count what comes out.
struct Model {
    program: LazyLock<Program>,
    symbios: &'static [&'static str],
    size: fn(u64) -> (f64, f64),
    /// Leaves of Mansard and of symbios-shape in every model; 1 where models are counted.
    leaves: (usize, usize),
}

fn compiled(text: &str) -> Program {
    let (program, diagnostics) = compile_text("bench.cga", text, &mut SourceMap::default(), &CompileOptions::default());
    program.unwrap_or_else(|| panic!("{:?}", diagnostics.iter().map(|d| &d.message).collect::<Vec<_>>()))
}

/// An extruded lot: one leaf of six faces.
static EXTRUDED_LOT: Model = Model {
    program: LazyLock::new(|| compiled(include_str!("extruded_lot.cga"))),
    symbios: &[r#"Lot --> Extrude(rand(6, 12)) I("Mass")"#],
    size: lot_size,
    leaves: (1, 1),
};

/// Four walls, two slopes, two gable ends and the soffit under them: nine leaves of one face.
static GABLED_HOUSE: Model = Model {
    program: LazyLock::new(|| compiled(include_str!("gabled_house.cga"))),
    symbios: &[
        "Lot --> Extrude(rand(5, 7)) Comp(Faces) { Top: Top | Side: Wall }",
        r#"Top --> Roof(Gable, 35) { Slope: Tiles | GableEnd: Wall }"#,
        r#"Wall --> I("Wall")"#,
        r#"Tiles --> I("Tiles")"#,
    ],
    size: lot_size,
    leaves: (1, 1),
};

/// Ten floors of a row with five windows between walls, over a ledge each.
static FACADE: Model = Model {
    program: LazyLock::new(|| compiled(include_str!("facade.cga"))),
    symbios: &[
        "Lot --> Extrude(30) Comp(Faces) { Front: Facade }",
        "Facade --> Repeat(Y, 3) { Floor }",
        "Floor --> Split(Y) { ~1: Row | 0.3: Ledge }",
        "Row --> Split(X) { 1: Wall | { ~3.6: Tile }* | 1: Wall }",
        "Tile --> Split(X) { ~1: Wall | 1.4: Opening | ~1: Wall }",
        "Opening --> Split(Y) { 0.9: Wall | ~1: Window | 0.5: Wall }",
        r#"Wall --> I("Wall")"#,
        r#"Window --> I("Window")"#,
        r#"Ledge --> I("Ledge")"#,
    ],
    size: |_| (20.0, 15.0),
    leaves: (280, 280),
};

impl Model {
    fn derive(&self, number: u64) -> ShapeTree {
        derive(&self.program, &start_shape(number, (self.size)(number)), &NoAssets, &Limits::default())
    }

    /// Times derivations, each of another lot.
    fn bench(&self, bencher: Bencher) {
        let tree = self.derive(0);
        assert!(tree.diagnostics.is_empty(), "{:?}", tree.diagnostics);
        assert!(self.leaves.0 == 1 || tree.leaves.len() == self.leaves.0, "{} leaves", tree.leaves.len());
        assert!(tree.leaves.iter().all(|leaf| leaf.mesh.faces.iter().all(|f| f.uv(0).is_some())), "uvs everywhere");
        bencher.counter(ItemsCount::new(self.leaves.0)).bench(|| self.derive(next_number()));
    }

    fn bench_symbios(&self, bencher: Bencher) {
        let mut interpreter = symbios_shape::Interpreter::new();
        for line in self.symbios {
            let statement = symbios_shape::grammar::parse_statement(line).expect("a rule of symbios-shape");
            interpreter.add_statement(statement).expect("a rule of symbios-shape");
        }
        let derive = |number: u64| {
            let (width, depth) = (self.size)(number);
            let size = symbios_shape::Vec3::new(width, 0.0, depth);
            let place = symbios_shape::Vec3::new(3.0 * number as f64, 0.0, -2.0 * number as f64);
            let lot = symbios_shape::Scope::new(place, symbios_shape::Quat::IDENTITY, size);
            interpreter.derive(lot, "Lot").expect("symbios-shape derives it")
        };
        assert!(self.leaves.1 == 1 || derive(0).len() == self.leaves.1, "{} leaves", derive(0).len());
        bencher.counter(ItemsCount::new(self.leaves.1)).bench(|| derive(next_number()));
    }
}

/// The number of the next lot on this thread.
fn next_number() -> u64 {
    thread_local!(static NUMBER: Cell<u64> = const { Cell::new(0) });
    NUMBER.replace(NUMBER.get() + 1)
}

/// Meshes; items are models, for the facade leaves.
#[divan::bench_group(threads = [1, 2])]
mod mansard_meshes {
    use super::*;

    #[divan::bench]
    fn extruded_lot(bencher: Bencher) {
        EXTRUDED_LOT.bench(bencher);
    }

    #[divan::bench]
    fn gabled_house(bencher: Bencher) {
        GABLED_HOUSE.bench(bencher);
    }

    #[divan::bench]
    fn facade_of_ten_floors(bencher: Bencher) {
        FACADE.bench(bencher);
    }
}

/// Boxes without meshes; items are models, for the facade leaves.
#[divan::bench_group(threads = [1, 2])]
mod symbios_boxes {
    use super::*;

    #[divan::bench]
    fn extruded_lot(bencher: Bencher) {
        EXTRUDED_LOT.bench_symbios(bencher);
    }

    #[divan::bench]
    fn gabled_house(bencher: Bencher) {
        GABLED_HOUSE.bench_symbios(bencher);
    }

    #[divan::bench]
    fn facade_of_ten_floors(bencher: Bencher) {
        FACADE.bench_symbios(bencher);
    }
}
