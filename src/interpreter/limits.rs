//! How much one start shape may become, and how fine. In: numbers of the host. Out: a typed stop.

use crate::geometry::roof::CURVE_BANDS;

/// Bounds per start shape; a bound (`max_`) that is met is an error naming the chain of rules.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Rules within rules.
    pub max_depth: u32,
    /// Blocks of `inline`, `modify` and booleans within each other.
    pub max_blocks: u32,
    /// Shapes made, leaves included.
    pub max_shapes: usize,
    /// Shapes waiting at the same time.
    pub max_pending: usize,
    /// Vertices of all geometry kept (waiting shapes and leaves).
    pub max_vertices: usize,
    /// Expressions within expressions, function calls included.
    pub max_expression_depth: u32,
    /// Elements of an array (reference 1.7).
    pub max_array: usize,
    /// Bytes of printed text and of one string value.
    pub max_text: usize,
    /// Metres: an upright face that is smaller in every direction becomes a leaf before its rule runs, as it is. 0 runs
    /// every rule.
    pub detail: f64,
    /// Bands of planes from the eaves to the top of round roofs, at least 1.
    pub curve_bands: u32,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            max_depth: 1000,
            max_blocks: 32,
            max_shapes: 300_000,
            max_pending: 100_000,
            max_vertices: 2_000_000,
            max_expression_depth: 600,
            max_array: 100_000,
            max_text: 1 << 20,
            detail: 0.0,
            curve_bands: CURVE_BANDS,
        }
    }
}

/// What a derivation says that met a bound it would not end without.
pub const ENDLESS: &[&str] =
    &["cga::limit-calls", "cga::limit-depth", "cga::limit-shapes", "cga::limit-text", "cga::limit-vertices"];

/// Derivation ends here; the reason is in the diagnostics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop;

pub type Outcome<T> = Result<T, Stop>;
