//! Edges: how far the outlines of objects lie beside where they belong, in pixels, to a small part of a pixel.
//!
//! **Definition.** Labels that differ between neighbours of a row (or column) mark an edge. Where the true image is the
//! mean light of every pixel's area, an edge that is steeper than 45° to the row has its whole transition in the two
//! pixels beside the border of labels; let L and R be the true light of the next pixels to the left and to the right. If
//! the edge moves along the row by s pixels, the light summed over the transition changes by s·(L - R), whatever the
//! shape of the transition: so s = Σ (image - truth) / (L - R), summed over the transition and one pixel more on both
//! sides, which holds for shifts up to one pixel. Across the edge that is s times the cosine of the edge's normal to the
//! row, which the true image's gradient gives.
//!
//! Only clean edges are judged: the labels are the same for three pixels on both sides in three rows, the light on each
//! side is even and, beyond the reach of a shift, the same in both images, what lies between the sides is no darker and
//! no brighter than they are, and the contrast is at least [`CONTRAST`].

/// Least difference in light, of white, between the two sides.
const CONTRAST: f32 = 0.08;
/// Greatest difference within one side, of the contrast.
const EVEN: f32 = 0.05;

/// What is compared: light and labels, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    pub width: usize,
    pub height: usize,
    /// Light of the image in question.
    pub image: &'a [f32],
    /// True light.
    pub truth: &'a [f32],
    /// True labels at pixel centres.
    pub labels: &'a [u32],
}

/// Displacements of all clean edges seen so far.
#[derive(Clone, Debug, Default)]
pub struct Displacements {
    squares: f64,
    count: usize,
}

impl Displacements {
    pub fn add(&mut self, scene: &Scene) {
        let pixels = scene.width * scene.height;
        let lengths = [scene.image.len(), scene.truth.len(), scene.labels.len()];
        assert_eq!(lengths, [pixels; 3], "images of one size");
        let (columns, rows) = ((1, scene.width), (scene.width, 1));
        self.along(scene, columns, (scene.width, scene.height));
        self.along(scene, rows, (scene.height, scene.width));
    }

    /// Edges across lines of `size.0` pixels, `step.0` apart in memory; neighbouring lines are `step.1` apart.
    fn along(&mut self, scene: &Scene, step: (usize, usize), size: (usize, usize)) {
        for line in 1..size.1.saturating_sub(1) {
            for left in 2..size.0.saturating_sub(3) {
                let place = line * step.1 + left * step.0;
                if let Some(shift) = displacement(scene, place, step) {
                    self.squares += f64::from(shift) * f64::from(shift);
                    self.count += 1;
                }
            }
        }
    }

    /// Root mean square over clean edges, pixels; `None` where there are none.
    pub fn rms(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.squares / self.count as f64).sqrt())
    }

    /// How many places were judged.
    pub fn count(&self) -> usize {
        self.count
    }
}

/// Shift across the edge between `place` and the next pixel of its line; `None` where there is no clean edge.
fn displacement(scene: &Scene, place: usize, (step, across): (usize, usize)) -> Option<f32> {
    let labels = scene.labels;
    let (one, other) = (labels[place], labels[place + step]);
    if one == other {
        return None;
    }
    let clean = [place - across, place, place + across].into_iter().all(|p| {
        [p - 2 * step, p - step].iter().all(|&q| labels[q] == one)
            && [p + 2 * step, p + 3 * step].iter().all(|&q| labels[q] == other)
    });
    let truth = scene.truth;
    let (left, right) = (truth[place - step], truth[place + 2 * step]);
    let contrast = left - right;
    let uneven = (truth[place - 2 * step] - left).abs().max((truth[place + 3 * step] - right).abs());
    // Beyond the transition and its neighbours only something else than a shift can differ, such as a texture.
    let other_error = |p: usize| (scene.image[p] - truth[p]).abs();
    let beyond = other_error(place - 2 * step).max(other_error(place + 3 * step));
    if !clean || contrast.abs() < CONTRAST || uneven.max(beyond) > EVEN * contrast.abs() {
        return None;
    }
    // A third light between the two, such as a wall beneath a roof's edge, would pass for a shift.
    let (low, high) = (left.min(right) - EVEN * contrast.abs(), left.max(right) + EVEN * contrast.abs());
    let between = |p: usize| [truth[p], scene.image[p]].iter().all(|v| (low..=high).contains(v));
    if !(0..4).map(|i| place + i * step - step).all(between) {
        return None;
    }
    let sum: f32 = (0..4).map(|i| place + i * step - step).map(|p| scene.image[p] - truth[p]).sum();
    cosine(truth, place, step, across).map(|cosine| sum / contrast * cosine)
}

/// Cosine between the edge's normal and the line; `None` for edges nearer to the line than 45°.
fn cosine(truth: &[f32], place: usize, step: usize, across: usize) -> Option<f32> {
    // The transition's middle in the lines before and after: how far the edge runs along the line.
    let middle = |line: usize| (0..4).map(|i| truth[line + i * step - step]).sum::<f32>();
    let contrast = truth[place - step] - truth[place + 2 * step];
    let slope = (middle(place + across) - middle(place - across)) / (2.0 * contrast);
    (slope.abs() <= 1.0).then(|| 1.0 / (1.0 + slope * slope).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIZE: usize = 40;

    /// Light 0.8 left of the line x = at + slope·(y - middle) and 0.2 right of it: the mean over pixels (by 64 rows each),
    /// with the decision at pixel centres.
    fn edge(at: f64, slope: f64) -> (Vec<f32>, Vec<u32>) {
        let border = |y: f64| at + slope * (y - SIZE as f64 / 2.0);
        let share = |x: usize, y: usize| {
            let row = |k: u32| (border(y as f64 + (f64::from(k) + 0.5) / 64.0) - x as f64).clamp(0.0, 1.0);
            (0..64).map(row).sum::<f64>() / 64.0
        };
        let places = || (0..SIZE * SIZE).map(|i| (i % SIZE, i / SIZE));
        let light = places().map(|(x, y)| (0.2 + 0.6 * share(x, y)) as f32).collect();
        let labels = places().map(|(x, y)| u32::from(x as f64 + 0.5 < border(y as f64 + 0.5))).collect();
        (light, labels)
    }

    fn turned<T: Copy>(image: &[T]) -> Vec<T> {
        (0..SIZE * SIZE).map(|i| image[i % SIZE * SIZE + i / SIZE]).collect()
    }

    fn measured(image: &[f32], truth: &[f32], labels: &[u32]) -> Displacements {
        let mut found = Displacements::default();
        found.add(&Scene { width: SIZE, height: SIZE, image, truth, labels });
        found
    }

    #[test]
    fn a_quarter_pixel_reads_a_quarter() {
        for start in [20.0, 20.3, 20.5, 19.9] {
            let ((truth, labels), (image, _)) = (edge(start, 0.0), edge(start + 0.25, 0.0));
            let found = measured(&image, &truth, &labels);
            assert!((found.rms().expect("an edge") - 0.25).abs() < 1e-4, "{:?} at {start}", found.rms());
            let found = measured(&turned(&image), &turned(&truth), &turned(&labels));
            assert!((found.rms().expect("an edge") - 0.25).abs() < 1e-4, "{:?} at {start}, upright", found.rms());
        }
    }

    #[test]
    fn a_slanted_edge_is_measured_across() {
        let slope = 0.75;
        let ((truth, labels), (image, _)) = (edge(20.2, slope), edge(20.2 + 0.25 * 1.25, slope));
        let found = measured(&image, &truth, &labels);
        assert!((found.rms().expect("an edge") - 0.25).abs() < 2e-3, "{:?}", found.rms());
        assert!(found.count() > 10);
    }

    #[test]
    fn one_sample_a_pixel_is_off_by_the_spread_of_a_pixel() {
        // A slowly turning edge: the decision at the centre is off by anything up to half a pixel.
        let (truth, labels) = edge(20.0, 0.11);
        let image: Vec<f32> = labels.iter().map(|&l| if l == 1 { 0.8 } else { 0.2 }).collect();
        let rms = measured(&image, &truth, &labels).rms().expect("an edge");
        assert!((rms - (1.0f64 / 12.0).sqrt()).abs() < 0.03, "{rms}");
    }

    #[test]
    fn weak_uneven_and_crowded_edges_are_left_out() {
        let (truth, labels) = edge(20.0, 0.0);
        let weak: Vec<f32> = truth.iter().map(|v| v * 0.05).collect();
        assert_eq!(measured(&weak, &weak, &labels).rms(), None);
        let uneven: Vec<f32> = truth.iter().enumerate().map(|(i, v)| v + (i % 2) as f32 * 0.1).collect();
        assert_eq!(measured(&uneven, &uneven, &labels).rms(), None);
        let crowded: Vec<u32> = (0..SIZE * SIZE).map(|i| (i % SIZE / 2) as u32).collect();
        assert_eq!(measured(&truth, &truth, &crowded).rms(), None);
    }

    proptest! {
        #[test]
        fn any_shift_reads_itself(start in 15.0f64..25.0, shift in -0.9f64..0.9) {
            let ((truth, labels), (image, _)) = (edge(start, 0.0), edge(start + shift, 0.0));
            let found = measured(&image, &truth, &labels).rms().expect("an edge");
            prop_assert!((found - shift.abs()).abs() < 1e-3, "{} for {}", found, shift);
        }
    }
}
