//! In: the class of an object and one of its materials. Out: how bright the surface is in the near infrared (about
//! 850 nm), which no colour says.
//!
//! What a surface is, is read from its built-in texture, from its class, from words in the names of its material and
//! texture file, and at last from its colour: land cover that is greener than red and blue is taken for leaves. Levels
//! are typical reflectances of the ECOSTRESS library (Meerdink et al. 2019): leaves scatter half of the light beyond
//! 700 nm, soil grows brighter towards the infrared, water swallows it, and what people build is nearly grey.

use super::model::SceneClass;
use crate::interpreter::material::Material;

/// What the near infrared tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Surface {
    Leaves,
    /// Grass that is partly dry, stubble, bare soil between plants.
    DryPlants,
    Soil,
    Water,
    Mineral,
}

/// Gain of the built-in textures that stand for one material.
const TEXTURES: &[(&str, f64)] = &[
    ("builtin:grass", 3.3),
    ("builtin:forest", 9.0),
    ("builtin:meadow", 2.2),
    ("builtin:farmland", 1.5),
    ("builtin:ground", 1.5),
    ("builtin:soil", 1.4),
    ("builtin:sand", 1.2),
    ("builtin:water", 0.1),
];

/// Words in names of materials and texture files.
const WORDS: &[(&str, Surface)] = &[
    ("grass", Surface::Leaves),
    ("lawn", Surface::Leaves),
    ("leaf", Surface::Leaves),
    ("leaves", Surface::Leaves),
    ("foliage", Surface::Leaves),
    ("hedge", Surface::Leaves),
    ("forest", Surface::Leaves),
    ("meadow", Surface::DryPlants),
    ("crop", Surface::DryPlants),
    ("bark", Surface::Soil),
    ("soil", Surface::Soil),
    ("dirt", Surface::Soil),
    ("mulch", Surface::Soil),
    ("water", Surface::Water),
];

/// Reflectance of a healthy canopy.
const CANOPY: f64 = 0.45;

/// The factor on the luminance (0.2126, 0.7152, 0.0722) of a surface's linear RGB albedo that gives its albedo at about
/// 850 nm; the product is cut at 0.95 by who uses it.
pub fn near_infrared_gain(class: SceneClass, material: &Material) -> f64 {
    let texture = material.colormap.as_deref().unwrap_or_default();
    if let Some((_, gain)) = TEXTURES.iter().find(|(name, _)| *name == texture) {
        return *gain;
    }
    match surface(class, material, texture) {
        // Under a texture the colour is a tint and says nothing of how bright the leaves are.
        Surface::Leaves if !texture.is_empty() => 4.0,
        Surface::Leaves => (CANOPY / luminance(material.color)).clamp(1.5, 8.0),
        Surface::DryPlants => 2.0,
        Surface::Soil if !texture.is_empty() => 1.4,
        // A little brighter than red.
        Surface::Soil => (1.25 * linear(material.color[0]) / luminance(material.color)).clamp(1.2, 2.5),
        Surface::Water => 0.1,
        Surface::Mineral => 1.1,
    }
}

fn surface(class: SceneClass, material: &Material, texture: &str) -> Surface {
    if class == SceneClass::Water {
        return Surface::Water;
    }
    let names = [&*material.name, texture].map(str::to_lowercase);
    if let Some((_, surface)) = WORDS.iter().find(|(word, _)| names.iter().any(|name| name.contains(word))) {
        return *surface;
    }
    let [r, g, b] = material.color;
    match class {
        SceneClass::Terrain | SceneClass::Landuse | SceneClass::Natural | SceneClass::Leisure => {
            if g > 1.02 * r && g > 1.02 * b {
                Surface::Leaves
            } else if r >= g && g > 1.1 * b {
                Surface::Soil
            } else {
                Surface::Mineral
            }
        }
        SceneClass::Vegetation => Surface::Leaves,
        SceneClass::Building | SceneClass::Highway | SceneClass::Water => Surface::Mineral,
    }
}

/// Of an sRGB-encoded channel (IEC 61966-2-1).
fn linear(c: f64) -> f64 {
    if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
}

/// Rec. 709, of an sRGB-encoded colour; black is taken for nearly black.
fn luminance(color: [f64; 3]) -> f64 {
    let [r, g, b] = color.map(linear);
    (0.2126 * r + 0.7152 * g + 0.0722 * b).max(1e-3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::texture::builtin;

    /// Mean red and near-infrared albedo.
    fn bands(class: SceneClass, texture: Option<&str>, color: [f64; 3]) -> (f64, f64) {
        let material = Material { color, colormap: texture.map(Into::into), ..Material::default() };
        let gain = near_infrared_gain(class, &material);
        let image = texture.map(|name| builtin(name).expect("it is built in"));
        let texels =
            image.iter().flat_map(|image| image.pixels()).map(|p| [0, 1, 2].map(|c| f64::from(p.0[c]) / 255.0));
        let mut texels: Vec<[f64; 3]> = texels.collect();
        if texels.is_empty() {
            texels.push([1.0; 3]);
        }
        let count = texels.len() as f64;
        // The tint of a texture multiplies in linear light.
        let tinted = |t: [f64; 3], c: usize| linear(t[c]) * linear(color[c]);
        let red = texels.iter().map(|t| tinted(*t, 0)).sum::<f64>() / count;
        let light = |t: &[f64; 3]| 0.2126 * tinted(*t, 0) + 0.7152 * tinted(*t, 1) + 0.0722 * tinted(*t, 2);
        let infrared = texels.iter().map(|t| (gain * light(t)).min(0.95)).sum::<f64>() / count;
        (red, infrared)
    }

    fn ndvi((red, infrared): (f64, f64)) -> f64 {
        (infrared - red) / (infrared + red)
    }

    /// Every (texture, tint) that a shipped rule file gives to a surface of its own kind.
    fn shipped(rules: &'static str) -> Vec<(&'static str, [f64; 3])> {
        let hex = |text: &str| {
            let digit = |at: usize| u8::from_str_radix(&text[at..at + 2], 16).map(|v| f64::from(v) / 255.0);
            let at = text.find('#').map(|at| at + 1)?;
            Some([digit(at).ok()?, digit(at + 2).ok()?, digit(at + 4).ok()?])
        };
        let lines: Vec<&str> = rules.lines().collect();
        let textured = lines.iter().enumerate().filter_map(|(i, line)| {
            let start = line.find("builtin:")?;
            let name = &line[start..start + line[start..].find('"')?];
            Some((name, hex(line).or_else(|| hex(lines[i - 1])).unwrap_or([1.0; 3])))
        });
        textured.collect()
    }

    #[test]
    fn land_cover_of_the_shipped_rules_is_told_apart() {
        let tiles = shipped(include_str!("../../rules/landcover.cga"));
        assert!(tiles.len() >= 9, "{tiles:?}");
        for (name, tint) in tiles {
            let class = if name == "builtin:water" { SceneClass::Water } else { SceneClass::Landuse };
            let both = bands(class, Some(name), tint);
            let expected = match name {
                "builtin:grass" => (0.4..0.5, 0.4..0.9),
                "builtin:forest" => (0.35..0.5, 0.7..0.95),
                "builtin:meadow" => (0.4..0.55, 0.25..0.6),
                "builtin:farmland" | "builtin:ground" => (0.25..0.45, 0.02..0.25),
                "builtin:sand" => (0.5..0.8, 0.0..0.2),
                "builtin:water" => (0.0..0.05, -1.0..0.0),
                "builtin:rock" | "builtin:concrete" => (0.1..0.5, -0.05..0.15),
                _ => panic!("{name} is not expected in the rules"),
            };
            assert!(expected.0.contains(&both.1), "{name} {both:?}");
            assert!(expected.1.contains(&ndvi(both)), "{name} {both:?} {}", ndvi(both));
        }
    }

    #[test]
    fn what_people_build_is_nearly_grey() {
        let streets = shipped(include_str!("../../rules/street.cga"));
        let industrial = shipped(include_str!("../../rules/industrial.cga"));
        let residential = shipped(include_str!("../../rules/residential.cga"));
        let built = streets
            .iter()
            .map(|tile| (SceneClass::Highway, *tile))
            .chain(industrial.iter().chain(&residential).map(|tile| (SceneClass::Building, *tile)));
        let mut count = 0;
        for (class, (name, tint)) in built.filter(|(_, (name, _))| *name != "builtin:soil") {
            let both = bands(class, Some(name), tint);
            assert!(ndvi(both).abs() < 0.15, "{name} {both:?}");
            count += 1;
        }
        assert!(count >= 6, "{count}");
        // A green house is paint.
        assert_eq!(near_infrared_gain(SceneClass::Building, &green()), 1.1);
    }

    fn green() -> Material {
        Material { color: [0.36, 0.48, 0.25], ..Material::default() }
    }

    #[test]
    fn plain_colours_of_land_cover_speak_by_class_and_hue() {
        for class in [SceneClass::Terrain, SceneClass::Landuse, SceneClass::Natural, SceneClass::Leisure] {
            let both = bands(class, None, green().color);
            assert!((0.4..0.5).contains(&both.1) && ndvi(both) > 0.4, "{both:?}");
        }
        let (_, lake) = bands(SceneClass::Water, None, [0.4, 0.6, 0.8]);
        assert!(lake < 0.05, "{lake}");
        let soil = bands(SceneClass::Landuse, None, [0.5, 0.4, 0.3]);
        assert!((0.0..0.3).contains(&ndvi(soil)), "{soil:?}");
    }

    #[test]
    fn names_of_files_and_materials_count() {
        let named = |name: &str, file: Option<&str>| {
            let material = Material { name: name.into(), colormap: file.map(Into::into), ..Material::default() };
            near_infrared_gain(SceneClass::Building, &material)
        };
        assert_eq!(named("", Some("assets/Oak_Leaf.png")), 4.0);
        assert_eq!(named("pool water", None), 0.1);
        assert_eq!(named("", Some("assets/brick.png")), 1.1);
    }
}
