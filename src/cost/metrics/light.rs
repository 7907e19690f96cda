//! Light: images in linear light → root mean square and 99th percentile of their difference, as shares of white.
//!
//! Light above white is clipped in both, as an image file does. The truth is a mean of samples: what its own standard
//! error adds to the mean square is taken off again, so that more samples make the figure surer but not smaller.

use super::Rgb;

/// Differences of all channels of all pixels seen so far.
#[derive(Clone, Debug, Default)]
pub struct LightErrors {
    errors: Vec<f32>,
    squares: f64,
    noise: f64,
}

impl LightErrors {
    /// Compares images of one size; `standard_error` is that of `truth`.
    pub fn add(&mut self, image: &[Rgb], truth: &[Rgb], standard_error: &[Rgb]) {
        assert!(image.len() == truth.len() && truth.len() == standard_error.len(), "images of one size");
        for ((image, truth), error) in image.iter().zip(truth).zip(standard_error) {
            for k in 0..3 {
                let off = image[k].clamp(0.0, 1.0) - truth[k].clamp(0.0, 1.0);
                self.errors.push(off.abs());
                self.squares += f64::from(off) * f64::from(off);
                self.noise += f64::from(error[k]) * f64::from(error[k]);
            }
        }
    }

    /// Root mean square over pixels and channels, 1 being white; 0 without pixels.
    pub fn rmse(&self) -> f64 {
        ((self.squares - self.noise).max(0.0) / self.errors.len().max(1) as f64).sqrt()
    }

    /// Root mean square of the truth's own standard error.
    pub fn noise(&self) -> f64 {
        (self.noise / self.errors.len().max(1) as f64).sqrt()
    }

    /// The least difference that at least 99 % of all values do not exceed; 0 without pixels.
    pub fn percentile_99(&self) -> f64 {
        if self.errors.is_empty() {
            return 0.0;
        }
        let mut sorted = self.errors.clone();
        let place = (sorted.len() as f64 * 0.99).ceil() as usize - 1;
        let (_, value, _) = sorted.select_nth_unstable_by(place, f32::total_cmp);
        f64::from(*value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn errors(image: &[Rgb], truth: &[Rgb]) -> LightErrors {
        let mut errors = LightErrors::default();
        errors.add(image, truth, &vec![[0.0; 3]; truth.len()]);
        errors
    }

    #[test]
    fn equal_images_have_no_error_and_white_is_white() {
        let image = [[0.2, 0.5, 1.0], [0.1, 0.0, 3.0]];
        assert_eq!(errors(&image, &[[0.2, 0.5, 1.5], [0.1, 0.0, 1.0]]).rmse(), 0.0);
        assert_eq!(LightErrors::default().percentile_99(), 0.0);
    }

    #[test]
    fn one_pixel_of_a_hundred_is_the_last_percent() {
        let truth = vec![[0.25f32; 3]; 200];
        let mut image = truth.clone();
        image[7] = [0.75; 3];
        image[8] = [0.75; 3];
        let found = errors(&image, &truth);
        assert_eq!(found.percentile_99(), 0.0);
        assert!((found.rmse() - (0.25f64 * 2.0 / 200.0).sqrt()).abs() < 1e-9);
        image[9] = [0.5; 3];
        assert_eq!(errors(&image, &truth).percentile_99(), 0.25);
    }

    /// A constant error under noise is found again, whatever the noise.
    #[test]
    fn noise_of_the_truth_is_taken_off() {
        let noise = |i: usize| if i.is_multiple_of(2) { 0.02 } else { -0.02 };
        let truth: Vec<Rgb> = (0..1000).map(|i| [0.5 + noise(i), 0.5 + noise(i + 1), 0.5 + noise(i)]).collect();
        let mut found = LightErrors::default();
        found.add(&vec![[0.51; 3]; 1000], &truth, &vec![[0.02; 3]; 1000]);
        assert!((found.rmse() - 0.01).abs() < 1e-6 && (found.noise() - 0.02).abs() < 1e-6, "{}", found.rmse());
    }

    proptest! {
        #[test]
        fn a_shift_of_all_values_is_the_error(values in prop::collection::vec(0.0f32..0.9, 1..200), shift in 0.0f32..0.1) {
            let truth: Vec<Rgb> = values.iter().map(|&v| [v; 3]).collect();
            let image: Vec<Rgb> = values.iter().map(|&v| [v + shift; 3]).collect();
            let found = errors(&image, &truth);
            prop_assert!((found.rmse() - f64::from(shift)).abs() < 1e-6);
            prop_assert!((found.percentile_99() - f64::from(shift)).abs() < 1e-6);
        }
    }
}
