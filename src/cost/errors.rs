//! Errors: images of windows and their truth → one number per metric.

use super::metrics::edges::{Displacements, Scene};
use super::metrics::labels::Disagreement;
use super::metrics::light::LightErrors;
use super::metrics::shadow::Overlap;
use super::probe::{Images, Truth};

/// One way to say how far an image is from the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Metric {
    /// Root mean square of linear light, of white.
    Light,
    /// What 99 % of all values of linear light keep within, of white.
    Worst,
    /// 1 - intersection over union of the masks of shadow.
    Shadow,
    /// Root mean square displacement of edges, pixels.
    Edge,
    /// Share of pixels with another object's number.
    Label,
    /// Greatest height between the ground mesh and the elevation data, metres.
    Height,
}

impl Metric {
    pub const ALL: [Metric; 6] =
        [Metric::Light, Metric::Worst, Metric::Shadow, Metric::Edge, Metric::Label, Metric::Height];

    /// Name of the column and of plots.
    pub fn key(self) -> &'static str {
        match self {
            Metric::Light => "rmse",
            Metric::Worst => "p99",
            Metric::Shadow => "shadow_miss",
            Metric::Edge => "edge_px",
            Metric::Label => "labels",
            Metric::Height => "height_m",
        }
    }

    /// For people.
    pub fn title(self) -> &'static str {
        match self {
            Metric::Light => "error of light (root mean square)",
            Metric::Worst => "error of light that 99 % of all values keep within",
            Metric::Shadow => "shadow mask (1 − intersection over union)",
            Metric::Edge => "displacement of edges (root mean square)",
            Metric::Label => "pixels with a wrong label",
            Metric::Height => "height of the ground mesh beside the elevation data (greatest)",
        }
    }

    /// A value in the unit that people read.
    pub fn text(self, value: f64) -> String {
        match self {
            Metric::Edge => format!("{} px", digits(value)),
            Metric::Height => format!("{} m", digits(value)),
            Metric::Light | Metric::Worst | Metric::Shadow | Metric::Label => format!("{} %", digits(100.0 * value)),
        }
    }
}

/// Three digits that count.
pub fn digits(value: f64) -> String {
    let places = match value.abs() {
        v if v >= 100.0 => 0,
        v if v >= 10.0 => 1,
        v if v >= 1.0 => 2,
        v if v >= 0.1 => 3,
        _ => 4,
    };
    format!("{value:.places$}")
}

/// Errors of one setting; 0 is the truth everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    pub light: f64,
    pub worst: f64,
    /// `None` where the view has no shadows.
    pub shadow: Option<f64>,
    /// `None` where the windows have no clean edge.
    pub edge: Option<f64>,
    pub label: f64,
    pub differing: usize,
    /// `None` where there is no elevation.
    pub height: Option<f64>,
    /// Standard error of the truth that `light` was measured with.
    pub noise: f64,
}

impl Errors {
    pub fn get(&self, metric: Metric) -> Option<f64> {
        match metric {
            Metric::Light => Some(self.light),
            Metric::Worst => Some(self.worst),
            Metric::Shadow => self.shadow,
            Metric::Edge => self.edge,
            Metric::Label => Some(self.label),
            Metric::Height => self.height,
        }
    }
}

/// Gathers the errors of windows.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    light: LightErrors,
    overlap: Option<Overlap>,
    edges: Displacements,
    labels: Disagreement,
}

impl Gathered {
    pub fn add(&mut self, images: &Images, truth: &Truth) {
        let true_images = &truth.images;
        self.light.add(&images.light, &true_images.light, &truth.standard_error);
        if let (Some(mask), Some(true_mask)) = (&images.shadow, &true_images.shadow) {
            self.overlap.get_or_insert_default().add(mask, true_mask);
        }
        self.edges.add(&Scene {
            width: images.window.width as usize,
            height: images.window.height as usize,
            image: &images.plain,
            truth: &true_images.plain,
            labels: &true_images.labels,
        });
        self.labels.add(&images.labels, &true_images.labels);
    }

    pub fn errors(&self, height: Option<f64>) -> Errors {
        Errors {
            light: self.light.rmse(),
            worst: self.light.percentile_99(),
            shadow: self.overlap.map(|overlap| 1.0 - overlap.share()),
            edge: self.edges.rms(),
            label: self.labels.share(),
            differing: self.labels.differing,
            height,
            noise: self.light.noise(),
        }
    }
}
