//! Where an image belongs. In: layout, view, split, image name. Out: the path below the dataset's folder, no suffix.
//!
//! The two LEVIR-CD dialects follow the loaders of open-cd and torchgeo (`docs/render.md`, "Layouts").

use std::path::PathBuf;

use crate::spec::render_spec::{LayoutSpec, Pair, Split};

/// Path of one image below the dataset's folder, without suffix. Images outside the pair of a LEVIR layout stand
/// beside `A`, `B` and `label` in a folder of their own name, where the loaders do not look.
pub fn image_path(layout: &LayoutSpec, split: Split, view: &str, image: &str) -> PathBuf {
    match layout {
        LayoutSpec::Plain => PathBuf::from(view).join(image),
        LayoutSpec::Levir(pair) => PathBuf::from(split.name()).join(role(pair, image)).join(view),
        LayoutSpec::LevirFlat(pair) => PathBuf::from(role(pair, image)).join(format!("{}_{view}", split.name())),
    }
}

/// Whether an image is the label of a LEVIR pair: loaders expect 0 and 255 there, whatever levels or classes it holds.
pub fn is_levir_label(layout: &LayoutSpec, image: &str) -> bool {
    match layout {
        LayoutSpec::Plain => false,
        LayoutSpec::Levir(pair) | LayoutSpec::LevirFlat(pair) => pair.label == image,
    }
}

fn role<'a>(pair: &Pair, image: &'a str) -> &'a str {
    match image {
        i if i == pair.a => "A",
        i if i == pair.b => "B",
        i if i == pair.label => "label",
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levir_dialects() {
        let pair = Pair { a: "before".into(), b: "after".into(), label: "mask".into() };
        let flat = LayoutSpec::LevirFlat(pair.clone());
        let levir = LayoutSpec::Levir(pair);
        let path = |layout: &LayoutSpec, image| image_path(layout, Split::Val, "town_nadir_1", image);
        assert_eq!(path(&levir, "after"), PathBuf::from("val/B/town_nadir_1"));
        assert_eq!(path(&levir, "ids"), PathBuf::from("val/ids/town_nadir_1"));
        assert_eq!(path(&flat, "before"), PathBuf::from("A/val_town_nadir_1"));
        assert_eq!(path(&flat, "mask"), PathBuf::from("label/val_town_nadir_1"));
        assert_eq!(path(&LayoutSpec::Plain, "mask"), PathBuf::from("town_nadir_1/mask"));
    }
}
