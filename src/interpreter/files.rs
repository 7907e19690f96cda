//! Files as rules ask for them. In: a name in a rule file. Out: what the file holds, or a warning at the name's place.

use std::path::Path;
use std::sync::Arc;

use super::assets::{Asset, AssetError, ImageInfo, builtin_image};
use super::derivation::Derivation;
use super::operations::unit_cube;
use crate::source::Span;

/// The folder of the rule file that a span lies in.
pub fn folder<'p>(run: &Derivation<'p>, span: Span) -> &'p Path {
    run.program.folder(span.source)
}

/// The geometry of a file or of a built-in cube. What of the file could not be used is warned about.
pub fn geometry(run: &mut Derivation, path: &str, span: Span) -> Result<Arc<Asset>, AssetError> {
    match path {
        "builtin:cube" => Ok(Arc::new(Asset::new(unit_cube()))),
        "builtin:cube:notex" => {
            let mut cube = unit_cube();
            cube.mesh.faces.iter_mut().for_each(|f| f.uvs.clear());
            Ok(Arc::new(Asset::new(cube)))
        }
        path => {
            let asset = run.assets.load(folder(run, span), path)?;
            if !asset.notes.is_empty() {
                run.warn("cga::asset-part", span, || format!("`{path}`: {}", asset.notes.join("; ")));
            }
            Ok(asset)
        }
    }
}

/// Size and channels of an image.
pub fn image(run: &Derivation, path: &str, span: Span) -> Result<ImageInfo, AssetError> {
    match path.starts_with("builtin:") {
        true => builtin_image(path).ok_or_else(|| AssetError::NotFound(path.to_owned())),
        false => run.assets.image(folder(run, span), path),
    }
}

/// Workspace paths that a query matches; a query that cannot be asked matches nothing, with a warning.
pub fn search(run: &mut Derivation, query: &str, span: Span) -> Arc<[Arc<str>]> {
    run.assets.search(folder(run, span), query).unwrap_or_else(|error| {
        run.warn("cga::file-query", span, || error.to_string());
        Arc::default()
    })
}
