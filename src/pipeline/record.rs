//! What the manifest says of a run. In: the recipe, the built scenes, the views. Out: the manifest's blocks.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::build::BuiltScene;
use super::memory::files;
use super::recipe::Recipe;
use crate::dataset::manifest::{AcquisitionRecord, InputFile, ReportRecord};
use crate::dataset::writer::sha256;
use crate::interpreter::FileAssets;
use crate::interpreter::reports::Report;
use crate::plan::demand::{Projection, ViewDemand};
use crate::plan::effects::{Ambient, Bands, BitDepth, Look, Sensor};
use crate::plan::sun::to_angles;
use crate::scene::{Scene, TriMesh};
use crate::source::{Access, SourceMap};
use crate::spec::render_spec::{FileRef, Origin};

/// Sums of `report` over features, by name; by name and type where there are several types.
pub fn report_records(totals: &[Report]) -> BTreeMap<String, ReportRecord> {
    let key = |report: &Report| match totals.iter().filter(|r| r.name == report.name).count() {
        1 => report.name.to_string(),
        _ => format!("{} ({})", report.name, report.kind.name()),
    };
    let record = |r: &Report| ReportRecord { count: r.count, sum: r.sum, min: r.min, max: r.max };
    totals.iter().map(|report| (key(report), record(report))).collect()
}

/// Every input by content: texts as they were read, map and elevation files from disk.
pub fn inputs(recipe: &Recipe, sources: &SourceMap, built: &[BuiltScene]) -> std::io::Result<Vec<InputFile>> {
    let mut inputs: Vec<InputFile> = sources
        .files()
        .iter()
        // Values of the command line are texts of their own, told under `arguments`.
        .filter(|file| !file.name.starts_with("--set "))
        .map(|file| InputFile {
            role: if file.name.ends_with(".cga") { "rules" } else { "recipe" },
            name: base_name(&file.name),
            path: below_root(Path::new(&*file.name), &recipe.access),
            bytes: file.text.len() as u64,
            sha256: sha256(file.text.as_bytes()),
        })
        .collect();
    for scene in &recipe.spec.scenes {
        let files = scene.maps.iter().map(|f| ("map", f)).chain(scene.elevations.iter().map(|f| ("elevation", f)));
        for (role, file) in files.filter(|(_, f)| f.origin != Origin::Shipped) {
            inputs.push(input(role, file, recipe)?);
        }
    }
    inputs.extend(built.iter().flat_map(|scene| scene.files.iter().cloned()));
    inputs.sort();
    inputs.dedup();
    Ok(inputs)
}

fn input(role: &'static str, file: &FileRef, recipe: &Recipe) -> std::io::Result<InputFile> {
    let path = file.resolve(&recipe.access).map_err(std::io::Error::other)?;
    hash_file(role, base_name(&file.written), &path, &recipe.access)
}

/// Geometry files that rules inserted.
pub fn asset_files(assets: &FileAssets) -> std::io::Result<Vec<InputFile>> {
    let hash = |path: PathBuf| hash_file("asset", base_name(&path.to_string_lossy()), &path, assets.access());
    assets.files().into_iter().filter(|path| path.is_file()).map(hash).collect()
}

fn hash_file(role: &'static str, name: String, path: &Path, access: &Access) -> std::io::Result<InputFile> {
    let (bytes, sha256) = file_sha256(path)?;
    Ok(InputFile { role, name, path: below_root(path, access), bytes, sha256 })
}

/// Length and SHA-256 of a file of any length.
pub fn file_sha256(path: &Path) -> std::io::Result<(u64, String)> {
    let (bytes, hash) = files::hash_file(path)?;
    Ok((bytes, hash.iter().map(|b| format!("{b:02x}")).collect()))
}

/// Where an existing file lies below the recipe's folder, with `/`; `None` for what lies elsewhere.
pub fn below_root(path: &Path, access: &Access) -> Option<String> {
    let real = path.canonicalize().ok()?;
    let parts = real.strip_prefix(access.root()).ok()?.iter().map(|part| part.to_string_lossy());
    Some(parts.collect::<Vec<_>>().join("/"))
}

/// Manifests name files without folders, so that they do not depend on where a run took place.
fn base_name(path: &str) -> String {
    Path::new(path).file_name().map_or_else(|| path.to_owned(), |n| n.to_string_lossy().into_owned())
}

/// Hash of all geometry, materials and labels of a scene: of the labels and the hash of each mesh, in order, then of the
/// materials.
pub fn geometry_hash(scene: &Scene) -> String {
    let digests: Vec<[u8; 32]> = scene.objects.par_iter().map(|object| object.mesh.digest(mesh_hash)).collect();
    let mut hash = Sha256::new();
    for (object, digest) in scene.objects.iter().zip(digests) {
        let labels = format!(
            "{:?} {} {} {:?} {} {}",
            object.feature.map(|f| f.to_string()),
            object.instance,
            object.class.name(),
            object.presence,
            object.change,
            object.level
        );
        hash.update(labels.as_bytes());
        hash.update(digest);
    }
    for material in &scene.materials {
        hash.update(format!("{material:?}").as_bytes());
    }
    hash.finalize().iter().map(|b| format!("{b:02x}")).collect()
}

fn mesh_hash(mesh: &TriMesh) -> [u8; 32] {
    let mut hash = Sha256::new();
    for p in &mesh.positions {
        hash.update(bytemuck::bytes_of(p));
    }
    hash.update(bytemuck::cast_slice(&mesh.normals));
    hash.update(bytemuck::cast_slice(&mesh.uvs));
    for (set, uvs) in &mesh.uv_sets {
        hash.update([*set]);
        hash.update(bytemuck::cast_slice(uvs));
    }
    hash.update(bytemuck::cast_slice(&mesh.triangles));
    for group in &mesh.groups {
        hash.update(format!("{group:?}").as_bytes());
    }
    hash.finalize().into()
}

/// Camera, sun and effects of one acquisition for the manifest.
pub fn acquisition_record(demand: &ViewDemand) -> AcquisitionRecord {
    let camera = &demand.camera;
    let (projection, half_x, half_y) = match camera.projection {
        Projection::Perspective { tan_x, tan_y } => ("perspective", tan_x, tan_y),
        Projection::Orthographic { half_x, half_y } => ("orthographic", half_x, half_y),
    };
    let sun = demand.sun.map(|sun| to_angles(sun.direction));
    AcquisitionRecord {
        images: demand.outputs.iter().map(|o| o.pass.clone()).collect(),
        width: camera.width,
        height: camera.height,
        position: camera.position.to_array(),
        right: camera.right.to_array(),
        up: camera.up.to_array(),
        forward: camera.forward.to_array(),
        projection,
        half_x,
        half_y,
        sun_elevation: sun.map(|(elevation, _)| elevation),
        sun_azimuth: sun.map(|(_, azimuth)| azimuth),
        effects: demand.outputs.iter().filter_map(|o| Some((o.pass.clone(), effects_record(&o.look)?))).collect(),
    }
}

/// What an image has besides sun and ambient light, in the units of [`Look`].
fn effects_record(look: &Look) -> Option<Value> {
    let mut record = serde_json::Map::new();
    let mut add =
        |name: &str, value: Option<Value>| value.into_iter().for_each(|v| drop(record.insert(name.into(), v)));
    let occluded = matches!(look.ambient, Ambient::Sky { occluded: true, .. });
    add("ambient", occluded.then(|| "sky_with_occlusion".into()));
    let haze = look.haze.map(|h| {
        json!({ "extinction": h.extinction, "scale_height": h.scale_height, "base": h.base, "airlight": h.airlight })
    });
    add("atmosphere", haze);
    let clouds = look.clouds.map(|c| {
        json!({ "key": c.key, "cover": c.cover, "height": c.height, "size": c.size, "depth": c.depth, "colour": c.color })
    });
    add("clouds", clouds);
    let ground = look.ground.as_ref().map(|g| {
        let kind = format!("{:?}", g.kind).to_lowercase();
        json!({ "key": g.key, "kind": kind, "share": g.strength, "within": g.reach, "discs": g.around.len() })
    });
    add("ground", ground);
    add("sensor", look.sensor.as_ref().map(sensor_record));
    (!record.is_empty()).then_some(Value::Object(record))
}

fn sensor_record(sensor: &Sensor) -> Value {
    let bands = match sensor.bands {
        Bands::Rgb => "rgb",
        Bands::Nir(_) => "nir",
        Bands::Panchromatic(_) => "panchromatic",
        Bands::FalseColor(_) => "false_colour",
    };
    let infrared = sensor.bands.near_infrared().map(|n| {
        json!({ "sun": n.sun, "zenith": n.zenith, "ground": n.ground, "extinction": n.extinction, "airlight": n.airlight })
    });
    json!({
        "key": sensor.key,
        "psf": sensor.psf,
        "exposure": sensor.exposure,
        "noise": sensor.read_noise,
        "full_well": sensor.full_well,
        "depth": if sensor.depth == BitDepth::Sixteen { 16 } else { 8 },
        "bands": bands,
        "near_infrared": infrared,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::effects::{Haze, NirLight, Shadows};

    #[test]
    fn effects_are_recorded_where_there_are_any() {
        let mut look = Look::plain(Shadows::Soft, Ambient::Constant([0.3; 3]));
        assert_eq!(effects_record(&look), None);
        let haze = Haze { extinction: [1e-4, 2e-4, 3e-4], scale_height: 900.0, base: -3.0, airlight: [0.3, 0.3, 0.4] };
        look.haze = Some(haze);
        let infrared = NirLight { sun: 0.9, zenith: 0.1, ground: 0.2, extinction: 5e-5, airlight: 0.2 };
        look.sensor = Some(Sensor {
            key: u64::MAX,
            psf: 0.5,
            exposure: 1.5,
            read_noise: 0.01,
            full_well: 9000.0,
            depth: BitDepth::Sixteen,
            bands: Bands::Nir(infrared),
        });
        let record = effects_record(&look).expect("there are effects");
        assert_eq!(record["atmosphere"]["extinction"][2], 3e-4);
        assert_eq!((&record["sensor"]["bands"], &record["sensor"]["depth"]), (&json!("nir"), &json!(16)));
        assert_eq!(record["sensor"]["near_infrared"]["zenith"], 0.1);
        // Keys are whole numbers of 64 bits, which text keeps.
        assert!(record.to_string().contains("18446744073709551615"));
        assert!(record.get("clouds").is_none() && record.get("ground").is_none() && record.get("ambient").is_none());
        look.ambient = Ambient::Sky { zenith: [0.2; 3], ground: [0.1; 3], occluded: true };
        assert_eq!(effects_record(&look).expect("there are effects")["ambient"], "sky_with_occlusion");
    }
}
