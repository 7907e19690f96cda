//! Looks that shapes were given before. In: a look and what is changed about it. Out: the changed look, the same one
//! for the same change, so that what many shapes share is made once and recognised by its address.

use std::sync::Arc;

use super::appearance::Appearance;

/// A change of colour or texture.
#[derive(Clone, Debug, PartialEq)]
pub enum Paint {
    /// sRGB-encoded 0..1; no opacity leaves the one there was.
    Color { rgb: [f64; 3], opacity: Option<f64> },
    /// Colour map, and the opacity map where that is set.
    Texture { path: Arc<str>, opacity_map: Option<Arc<str>> },
}

/// The last few changes.
#[derive(Default)]
pub struct Palette {
    known: Vec<Painted>,
    /// The one to forget next.
    oldest: usize,
}

struct Painted {
    below: Arc<Appearance>,
    paint: Paint,
    result: Arc<Appearance>,
}

impl Palette {
    const MOST: usize = 16;

    /// The look that comes of painting over another one.
    pub fn painted(&mut self, below: &Arc<Appearance>, paint: Paint) -> Arc<Appearance> {
        let same = |known: &&Painted| Arc::ptr_eq(&known.below, below) && known.paint == paint;
        if let Some(known) = self.known.iter().find(same) {
            return known.result.clone();
        }
        let mut appearance = Appearance::clone(below);
        appearance.paint(&paint);
        let result = Arc::new(appearance);
        let painted = Painted { below: below.clone(), paint, result: result.clone() };
        if self.known.len() < Self::MOST {
            self.known.push(painted);
        } else {
            self.known[self.oldest] = painted;
            self.oldest = (self.oldest + 1) % Self::MOST;
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_paint_on_the_same_look_is_one() {
        let (mut palette, plain) = (Palette::default(), Arc::<Appearance>::default());
        let red = |opacity| Paint::Color { rgb: [1.0, 0.0, 0.0], opacity };
        let first = palette.painted(&plain, red(None));
        assert_eq!((first.color[0], first.opacity), (Some(1.0), None));
        assert!(Arc::ptr_eq(&first, &palette.painted(&plain, red(None))));
        let glass = palette.painted(&first, red(Some(0.5)));
        assert_eq!(glass.opacity, Some(0.5));
        assert_eq!(palette.painted(&glass, red(None)).opacity, Some(0.5), "what is not painted stays");
        for i in 0..40 {
            palette.painted(&plain, Paint::Texture { path: format!("{i}.png").into(), opacity_map: None });
        }
        assert_eq!(palette.known.len(), Palette::MOST);
        let again = palette.painted(&plain, red(None));
        assert_eq!((&*again, Arc::ptr_eq(&again, &first)), (&*first, false), "forgotten and made anew");
    }
}
