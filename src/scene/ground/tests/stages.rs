//! The stage cases of terrain in `../shared/hard-cases/stages.json`, each by its name (`tests/it/stage_cases.rs` holds them
//! against the file).

use glam::{DAffine2, DMat2};

use super::*;
use crate::geodata::terrain::TerrainError;

/// Posts of a raster in metres of the scene's own frame, `step` apart, centred on it.
struct Posts {
    columns: usize,
    rows: usize,
    step: f64,
}

fn frame() -> LocalFrame {
    LocalFrame::new(10.0, 50.0).unwrap()
}

impl Posts {
    fn square(count: usize, step: f64) -> Posts {
        Posts { columns: count, rows: count, step }
    }

    /// Half the width and height between the outermost posts.
    fn half(&self) -> DVec2 {
        DVec2::new((self.columns - 1) as f64, (self.rows - 1) as f64) * self.step / 2.0
    }

    fn raster(&self, height: impl Fn(DVec2) -> f64) -> Raster {
        let crs = "+proj=tmerc +lat_0=50 +lon_0=10 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs";
        let half = self.half();
        let north_west = DVec2::new(-half.x, half.y);
        let step = DVec2::new(self.step, -self.step);
        let transform = DAffine2::from_mat2_translation(DMat2::from_diagonal(step), north_west - step / 2.0);
        let post = |k: usize| north_west + step * DVec2::new((k % self.columns) as f64, (k / self.columns) as f64);
        let heights = (0..self.columns * self.rows).map(|k| height(post(k)) as f32).collect();
        Raster::of_cells(crs, transform, self.columns, heights)
    }

    fn terrain_with(&self, voids: Voids, height: impl Fn(DVec2) -> f64) -> Terrain {
        let half = self.half().max(DVec2::splat(self.step / 4.0));
        Terrain::from_rasters(frame(), -half, half, vec![self.raster(height)], voids).unwrap()
    }

    fn terrain(&self, height: impl Fn(DVec2) -> f64) -> Terrain {
        self.terrain_with(Voids::Fill, height)
    }
}

fn heights(mesh: &GroundMesh) -> (f64, f64) {
    mesh.positions.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.y), h.max(p.y)))
}

/// Vertices lie on a lattice and heights are kept in 32 bits: what they may differ from an exact plane here, metres.
const ROUNDING: f64 = 1e-3;

#[test]
fn dem_plane() {
    let posts = Posts::square(101, 10.0);
    let plane = |p: DVec2| 0.1 * p.x + 0.05 * p.y;
    let terrain = posts.terrain(plane);
    for tolerance in [ROUNDING, 0.1, 10.0] {
        let mesh = build_ground(&square(DVec2::ZERO, 499.0), &terrain, tolerance, &[]).unwrap();
        assert_eq!(mesh.triangles.len(), 2, "{tolerance}");
        assert!(mesh.worst_error_m < ROUNDING, "{}", mesh.worst_error_m);
        assert!(mesh.positions.iter().all(|&p| (p.y - plane(plan(p))).abs() < ROUNDING));
    }
}

#[test]
fn dem_bowl() {
    let terrain = Posts::square(201, 5.0).terrain(|p| p.length_squared() / 2000.0);
    let mut last = (0, f64::INFINITY);
    for tolerance in [4.0, 2.0, 1.0, 0.5, 0.25, 0.1] {
        let mesh = build_ground(&square(DVec2::ZERO, 499.0), &terrain, tolerance, &[]).unwrap();
        let now = (mesh.triangles.len(), mesh.worst_error_m);
        assert!(now.1 <= tolerance && now.1 < last.1 && now.0 > last.0, "{tolerance}: {now:?} after {last:?}");
        // About 1 / tolerance: within a factor of three from one tolerance to the next.
        assert!(last.0 == 0 || now.0 < 6 * last.0, "{tolerance}: {now:?} after {last:?}");
        last = now;
    }
}

#[test]
fn dem_sine() {
    let terrain = Posts::square(401, 2.0).terrain(|p| 10.0 * libm::sin(p.x / 50.0) * libm::sin(p.y / 50.0));
    let build = || build_ground(&square(DVec2::ZERO, 399.0), &terrain, 0.5, &[]).unwrap();
    let mesh = build();
    assert!(mesh.worst_error_m <= 0.5, "{}", mesh.worst_error_m);
    assert_eq!(mesh, build());
}

fn with_hole(p: DVec2) -> f64 {
    let plane = 100.0 + 0.1 * p.x;
    // Readers make NaN of the value that a file declares.
    if p.x.abs() < 100.0 && p.y.abs() < 100.0 { f64::NAN } else { plane }
}

#[test]
fn dem_nodata_hole() {
    let posts = Posts::square(101, 10.0);
    let filled = posts.terrain(with_hole);
    let mesh = build_ground(&square(DVec2::ZERO, 499.0), &filled, 0.5, &[]).unwrap();
    assert!(heights(&mesh).0 > 49.0 && heights(&mesh).1 < 151.0, "{:?}", heights(&mesh));
    assert!(filled.report().filled_from_neighbours >= 19 * 19 && mesh.without_height == 0);
    // The membrane over a hole in a plane is the plane.
    assert!((filled.height(DVec2::new(33.0, -20.0)).unwrap() - 103.3).abs() < 0.05);
    let open = posts.terrain_with(Voids::Open, with_hole);
    assert_eq!(open.height(DVec2::ZERO), None);
    let mesh = build_ground(&square(DVec2::ZERO, 499.0), &open, 0.5, &[]).unwrap();
    assert!(heights(&mesh).0 > 49.0, "{:?}", heights(&mesh));
}

/// Nothing to build from is an error that names the files: level ground is only made where no elevation was asked for.
#[test]
fn dem_all_nodata() {
    let posts = Posts::square(11, 10.0);
    let made =
        Terrain::from_rasters(frame(), -posts.half(), posts.half(), vec![posts.raster(|_| f64::NAN)], Voids::Fill);
    assert!(matches!(made, Err(TerrainError::NoCover(_))));
}

#[test]
fn dem_nan_edge() {
    let plane = |p: DVec2| 50.0 + 0.25 * p.x + 0.5 * p.y;
    let hole = |p: DVec2| if p.length() < 1.0 { f64::NAN } else { plane(p) };
    let terrain = Posts::square(21, 8.0).terrain(hole);
    for p in [DVec2::new(2.4, 0.0), DVec2::new(-2.4, 2.4), DVec2::new(0.0, -2.4), DVec2::ZERO] {
        assert!((terrain.height(p).unwrap() - plane(p)).abs() < ROUNDING, "{p}");
    }
    let open = Posts::square(21, 8.0).terrain_with(Voids::Open, hole);
    assert!(open.height(DVec2::new(2.4, 0.0)).is_some_and(f64::is_finite));
}

#[test]
fn dem_cliff() {
    let terrain = Posts::square(101, 10.0).terrain(|p| if p.x < 0.0 { 0.0 } else { 100.0 });
    for tolerance in [0.5, 5.0, 20.0] {
        let mesh = build_ground(&square(DVec2::ZERO, 499.0), &terrain, tolerance, &[]).unwrap();
        let (least, greatest) = heights(&mesh);
        assert!(least >= 0.0 && greatest <= 100.0, "{least} {greatest}");
        assert!(mesh.worst_error_m <= tolerance, "{}", mesh.worst_error_m);
    }
}

/// A GeoTIFF of 41 x 41 cells of 0.001 degrees around (10, 50) with heights 100,000 (lon - 10) + 50,000 (lat - 50).
fn geotiff(is_point: bool, south_up: bool) -> Vec<u8> {
    use tiff::encoder::{TiffEncoder, colortype::Gray32Float};
    use tiff::tags::Tag;
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut tiff = TiffEncoder::new(&mut bytes).unwrap();
    let mut image = tiff.new_image::<Gray32Float>(41, 41).unwrap();
    let step = 0.001;
    let (row_step, first) = if south_up { (step, 49.98) } else { (-step, 50.02) };
    // The place of the first post; for cells that of its outer corner.
    let half = if is_point { 0.0 } else { 0.5 };
    let (x, y) = (9.98 - half * step, first - half * row_step);
    let matrix = [step, 0.0, 0.0, x, 0.0, row_step, 0.0, y, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    image.encoder().write_tag(Tag::ModelTransformationTag, &matrix[..]).unwrap();
    let keys: [u16; 16] = [1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, if is_point { 2 } else { 1 }, 2048, 0, 1, 4326];
    image.encoder().write_tag(Tag::GeoKeyDirectoryTag, &keys[..]).unwrap();
    let height = |k: usize| {
        let (lon, lat) = (9.98 + step * (k % 41) as f64, first + row_step * (k / 41) as f64);
        (1e5 * (lon - 10.0) + 5e4 * (lat - 50.0)) as f32
    };
    image.write_data(&(0..41 * 41).map(height).collect::<Vec<f32>>()).unwrap();
    bytes.into_inner()
}

#[track_caller]
fn slope_is_found(bytes: &[u8]) {
    let raster = elevation::read("slope.tif", bytes, None, None).unwrap();
    for (lon, lat) in [(10.0, 50.0), (10.0123, 49.9911), (9.9841, 50.0137)] {
        let expected = 1e5 * (lon - 10.0) + 5e4 * (lat - 50.0);
        let got = raster.sample(lon, lat).unwrap();
        // The heights reach 2 km and are kept in 32 bits; half a cell would be 50 m.
        assert!((got - expected).abs() < 2e-4, "{lon} {lat}: {got}, not {expected}");
    }
}

#[test]
fn dem_pixel_centre() {
    slope_is_found(&geotiff(false, false));
    slope_is_found(&geotiff(true, false));
}

#[test]
fn dem_row_order() {
    slope_is_found(&geotiff(false, true));
    slope_is_found(&geotiff(true, true));
}

#[test]
fn dem_anisotropic() {
    let frame = LocalFrame::new(10.0, 60.0).unwrap();
    let (second, count) = (1.0 / 3600.0, 81);
    let place = |k: usize| (10.0 + second * ((k % count) as f64 - 40.0), 60.0 - second * ((k / count) as f64 - 40.0));
    let plane = |p: DVec2| 0.1 * p.x + 0.05 * p.y;
    let height = |k: usize| plane(frame.forward(place(k).0, place(k).1).unwrap()) as f32;
    let step = DVec2::new(second, -second);
    let corner = DVec2::new(10.0, 60.0) - step * 40.5;
    let transform = DAffine2::from_mat2_translation(DMat2::from_diagonal(step), corner);
    let raster = Raster::of_cells("EPSG:4326", transform, count, (0..count * count).map(height).collect());
    let half = DVec2::splat(500.0);
    let terrain = Terrain::from_rasters(frame, -half, half, vec![raster], Voids::Fill).unwrap();
    let at = |x: f64, y: f64| terrain.height(DVec2::new(x, y)).unwrap();
    let gradient = DVec2::new(at(500.0, 0.0) - at(-500.0, 0.0), at(0.0, 500.0) - at(0.0, -500.0)) / 1000.0;
    assert!((gradient / DVec2::new(0.1, 0.05) - DVec2::ONE).abs().max_element() < 1e-6, "{gradient}");
}

#[test]
fn dem_1x1() {
    let one = Posts::square(1, 30.0).terrain(|_| 7.0);
    assert_eq!(one.height(DVec2::new(3.0, -4.0)), Some(7.0));
    for posts in [Posts { columns: 21, rows: 1, step: 30.0 }, Posts { columns: 1, rows: 21, step: 30.0 }] {
        let line = posts.terrain(|p| 100.0 + 0.5 * (p.x + p.y));
        let along = if posts.rows == 1 { DVec2::X } else { DVec2::Y };
        for t in [-200.0, 0.0, 77.0] {
            let got = line.height(along * t).unwrap();
            assert!((got - (100.0 + 0.5 * t)).abs() < ROUNDING, "{t}: {got}");
        }
        let mesh = build_ground(&square(DVec2::ZERO, 10.0), &line, 0.5, &[]).unwrap();
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
    }
}

fn waves(p: DVec2) -> f64 {
    (20.0 * libm::sin(p.x / 37.0) * libm::cos(p.y / 53.0) * 64.0).round() / 64.0
}

/// One raster, and the same in two with a common column.
fn whole_and_halves() -> (Terrain, Terrain) {
    let posts = Posts::square(61, 10.0);
    let half = posts.half();
    let raster = || posts.raster(waves);
    let halves = vec![raster().cropped(0, 0, 31, 61), raster().cropped(30, 0, 31, 61)];
    let terrain = |rasters| Terrain::from_rasters(frame(), -half, half, rasters, Voids::Fill).unwrap();
    (terrain(vec![raster()]), terrain(halves))
}

/// Tiles are never meshed on their own: all are one surface and one mesh, without a crack. In the last cell before the second
/// tile the first one fades out; everywhere else the heights are those of the uncut raster.
#[test]
fn dem_tiles_seam() {
    let (whole, halves) = whole_and_halves();
    let area = square(DVec2::ZERO, 299.0);
    let mesh = build_ground(&area, &halves, 0.5, &[]).unwrap();
    assert_watertight(&mesh, &area);
    for p in mesh.positions.iter().filter(|p| !(0.0..10.0).contains(&p.x)) {
        assert!((p.y - whole.height(plan(*p)).unwrap()).abs() < ROUNDING, "{p}");
    }
    for y in -299..299 {
        let at = |x: f64| halves.height(DVec2::new(x, f64::from(y))).unwrap();
        for x in [0.0, 5.0, 10.0] {
            assert!((at(x - 1e-6) - at(x + 1e-6)).abs() < ROUNDING, "a step at {x} {y}");
        }
    }
}

#[test]
fn dem_building_straddle() {
    let posts = Posts::square(61, 10.0);
    let slope = |p: DVec2| 100.0 + 0.3 * p.x;
    let raster = || posts.raster(slope);
    let halves = vec![raster().cropped(0, 0, 31, 61), raster().cropped(30, 0, 31, 61)];
    let terrain = Terrain::from_rasters(frame(), -posts.half(), posts.half(), halves, Voids::Fill).unwrap();
    let outline = Polygon {
        outer: vec![DVec2::new(-10.0, -5.0), DVec2::new(10.0, -5.0), DVec2::new(10.0, 5.0), DVec2::new(-10.0, 5.0)],
        holes: Vec::new(),
    };
    let (least, greatest) = terrain.extremes_under(&outline).unwrap();
    assert!((least - 97.0).abs() < ROUNDING && (greatest - 103.0).abs() < ROUNDING, "{least} {greatest}");
    for k in 0..=2000 {
        let p = DVec2::new(-10.0 + f64::from(k) / 100.0, 5.0);
        assert!(terrain.height(p).unwrap() >= least - 1e-6, "the ground is below the base at {p}");
    }
}

#[test]
fn dem_int16() {
    let terrain = Posts::square(101, 10.0).terrain(|p| (0.01 * p.x).round());
    let mesh = build_ground(&square(DVec2::ZERO, 499.0), &terrain, 1.1, &[]).unwrap();
    let at = |x: f64, y: f64| height_on(&mesh, DVec2::new(x, y));
    let gradient = DVec2::new(at(490.0, 0.0) - at(-490.0, 0.0), at(0.0, 490.0) - at(0.0, -490.0)) / 980.0;
    assert!((gradient.x / 0.01 - 1.0).abs() < 0.1 && gradient.y.abs() < 1e-3, "{gradient}");
}

#[test]
fn dem_dead_sea() {
    let terrain = Posts::square(31, 30.0).terrain(|_| -430.0);
    assert_eq!(terrain.report().undeclared, 0);
    let mesh = build_ground(&square(DVec2::ZERO, 400.0), &terrain, 0.5, &[]).unwrap();
    assert!(mesh.positions.iter().all(|p| (p.y + 430.0).abs() < 1e-9), "{:?}", heights(&mesh));
}

/// Heights stand on the plan as they are: nothing drops with the distance from the centre.
#[test]
fn geo_drop() {
    let terrain = Posts::square(101, 30.0).terrain(|_| 100.0);
    for p in [DVec2::ZERO, DVec2::splat(1000.0), DVec2::new(-1400.0, 0.0)] {
        assert!((terrain.height(p).unwrap() - 100.0).abs() < 0.01);
    }
}
