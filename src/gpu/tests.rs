//! Pictures of scenes whose pixels are known beforehand. Without an adapter they say so and pass, unless
//! `MANSARD_REQUIRE_GPU` is 1.

mod coverage;
mod economy;
mod effects;
mod hard;
mod lighting;
mod shaders;
mod tiling;
pub(crate) mod town;

use super::Renderer;

/// A renderer, or `None` with a line saying that the test was skipped.
pub(crate) fn renderer() -> Option<Renderer> {
    match Renderer::new() {
        Ok(renderer) => Some(renderer),
        Err(error) if std::env::var("MANSARD_REQUIRE_GPU").is_ok_and(|v| v == "1") => panic!("{error}"),
        Err(error) => {
            println!("skipped: {error}");
            None
        }
    }
}
