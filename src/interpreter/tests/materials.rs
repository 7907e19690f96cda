//! Materials: every attribute, the two layers, material files, and what leaves carry out.

use super::files::Shop;
use crate::interpreter::material::{MapLayer, OpacityMode};

/// Every material attribute: its name, a value, how the value reads, how it reads before it is set.
const ATTRIBUTES: &[(&str, &str, &str, &str)] = &[
    ("material.name", r##""brick""##, "brick", ""),
    ("material.shader", r##""CityEnginePBRShader""##, "CityEnginePBRShader", "CityEngineShader"),
    ("material.color.r", "0.25", "0.25", "1"),
    ("material.color.g", "0.25", "0.25", "1"),
    ("material.color.b", "0.25", "0.25", "1"),
    ("material.ambient.r", "0.25", "0.25", "0"),
    ("material.ambient.g", "0.25", "0.25", "0"),
    ("material.ambient.b", "0.25", "0.25", "0"),
    ("material.specular.r", "0.25", "0.25", "0"),
    ("material.specular.g", "0.25", "0.25", "0"),
    ("material.specular.b", "0.25", "0.25", "0"),
    ("material.emissive.r", "0.25", "0.25", "0"),
    ("material.emissive.g", "0.25", "0.25", "0"),
    ("material.emissive.b", "0.25", "0.25", "0"),
    ("material.color.rgb", r##""#FF8000""##, r##"#FF8000"##, r##"#ffffff"##),
    ("material.opacity", "0.5", "0.5", "1"),
    ("material.color.a", "0.5", "0.5", "1"),
    ("material.reflectivity", "0.5", "0.5", "0"),
    ("material.shininess", "12", "12", "1"),
    ("material.bumpValue", "2", "2", "1"),
    ("material.bump", "2", "2", "1"),
    ("material.metallic", "0.5", "0.5", "0"),
    ("material.roughness", "0.5", "0.5", "1"),
    ("material.doubleSided", "false", "false", "true"),
    ("material.opacitymap.mode", r##""mask""##, "mask", "blend"),
    ("material.opacitymap.cutoff", "0.25", "0.25", "0.5"),
    ("material.colormap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.colormap.su", "2", "2", "1"),
    ("material.colormap.sv", "3", "3", "1"),
    ("material.colormap.tu", "0.5", "0.5", "0"),
    ("material.colormap.tv", "-0.5", "-0.5", "0"),
    ("material.colormap.rw", "45", "45", "0"),
    ("material.bumpmap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.bumpmap.su", "2", "2", "1"),
    ("material.bumpmap.sv", "3", "3", "1"),
    ("material.bumpmap.tu", "0.5", "0.5", "0"),
    ("material.bumpmap.tv", "-0.5", "-0.5", "0"),
    ("material.bumpmap.rw", "45", "45", "0"),
    ("material.dirtmap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.dirtmap.su", "2", "2", "1"),
    ("material.dirtmap.sv", "3", "3", "1"),
    ("material.dirtmap.tu", "0.5", "0.5", "0"),
    ("material.dirtmap.tv", "-0.5", "-0.5", "0"),
    ("material.dirtmap.rw", "45", "45", "0"),
    ("material.specularmap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.specularmap.su", "2", "2", "1"),
    ("material.specularmap.sv", "3", "3", "1"),
    ("material.specularmap.tu", "0.5", "0.5", "0"),
    ("material.specularmap.tv", "-0.5", "-0.5", "0"),
    ("material.specularmap.rw", "45", "45", "0"),
    ("material.opacitymap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.opacitymap.su", "2", "2", "1"),
    ("material.opacitymap.sv", "3", "3", "1"),
    ("material.opacitymap.tu", "0.5", "0.5", "0"),
    ("material.opacitymap.tv", "-0.5", "-0.5", "0"),
    ("material.opacitymap.rw", "45", "45", "0"),
    ("material.normalmap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.normalmap.su", "2", "2", "1"),
    ("material.normalmap.sv", "3", "3", "1"),
    ("material.normalmap.tu", "0.5", "0.5", "0"),
    ("material.normalmap.tv", "-0.5", "-0.5", "0"),
    ("material.normalmap.rw", "45", "45", "0"),
    ("material.emissivemap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.emissivemap.su", "2", "2", "1"),
    ("material.emissivemap.sv", "3", "3", "1"),
    ("material.emissivemap.tu", "0.5", "0.5", "0"),
    ("material.emissivemap.tv", "-0.5", "-0.5", "0"),
    ("material.emissivemap.rw", "45", "45", "0"),
    ("material.occlusionmap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.occlusionmap.su", "2", "2", "1"),
    ("material.occlusionmap.sv", "3", "3", "1"),
    ("material.occlusionmap.tu", "0.5", "0.5", "0"),
    ("material.occlusionmap.tv", "-0.5", "-0.5", "0"),
    ("material.occlusionmap.rw", "45", "45", "0"),
    ("material.roughnessmap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.roughnessmap.su", "2", "2", "1"),
    ("material.roughnessmap.sv", "3", "3", "1"),
    ("material.roughnessmap.tu", "0.5", "0.5", "0"),
    ("material.roughnessmap.tv", "-0.5", "-0.5", "0"),
    ("material.roughnessmap.rw", "45", "45", "0"),
    ("material.metallicmap", r##""images/wall.png""##, "/town/assets/images/wall.png", ""),
    ("material.metallicmap.su", "2", "2", "1"),
    ("material.metallicmap.sv", "3", "3", "1"),
    ("material.metallicmap.tu", "0.5", "0.5", "0"),
    ("material.metallicmap.tv", "-0.5", "-0.5", "0"),
    ("material.metallicmap.rw", "45", "45", "0"),
];

#[test]
fn every_attribute_is_read_and_set() {
    let shop = Shop::new();
    let reads: String = ATTRIBUTES.iter().map(|(name, ..)| format!("print({name}) ")).collect();
    let defaults: Vec<&str> = ATTRIBUTES.iter().map(|row| row.3).collect();
    assert_eq!(shop.prints(&format!("Lot --> {reads} NIL")), defaults);
    for (name, value, read, _) in ATTRIBUTES {
        let rules = format!("Lot --> set({name}, {value}) A\nA --> print({name}) NIL");
        assert_eq!(shop.prints(&rules), [*read], "{name}");
    }
}

#[test]
fn leaves_carry_every_layer() {
    let rules = r##"
Lot --> texture("images/leaf.png") set(material.colormap.su, 2) set(material.colormap.rw, 90)
  set(material.normalmap, "images/wall.png") set(material.normalmap.tv, 0.5) set(material.emissive.g, 0.5)
  set(material.opacitymap.mode, "mask") set(material.opacitymap.cutoff, 0.75) set(material.doubleSided, false)
  set(material.specular.r, 0.25) set(material.dirtmap, "") A.
"##;
    let (tree, _) = Shop::new().derive(rules);
    let m = &tree.leaves[0].material;
    assert!(m.colormap.as_deref().is_some_and(|path| path.ends_with("town/assets/images/leaf.png")));
    assert_eq!((m.colormap_transform.scale, m.colormap_transform.rotation), ([2.0, 1.0], 90.0));
    let layers: Vec<MapLayer> = m.maps.iter().map(|map| map.layer).collect();
    assert_eq!(layers, [MapLayer::Opacity, MapLayer::Normal], "an image with alpha is an opacity map too");
    assert_eq!(m.maps[1].transform.offset, [0.0, 0.5]);
    assert_eq!((m.emissive, m.double_sided), ([0.0, 0.5, 0.0], false));
    assert_eq!((m.opacity_mode, m.opacity_cutoff), (OpacityMode::Mask, 0.75));
    assert_eq!(m.other, [("specular.r".into(), "0.25".into())]);
}

#[test]
fn a_texture_without_alpha_takes_the_opacity_map_away() {
    let show = "print(material.colormap + \" \" + material.opacitymap)";
    let rules = format!(
        "Lot --> texture(\"images/leaf.png\") {show} texture(\"images/wall.png\") {show} texture(\"\") {show} NIL"
    );
    let leaf = "/town/assets/images/leaf.png";
    assert_eq!(Shop::new().prints(&rules), [&format!("{leaf} {leaf}"), "/town/assets/images/wall.png ", " "]);
}

#[test]
fn what_the_shape_sets_wins_over_its_geometry() {
    let show = "print(material.name + \" \" + material.color.rgb + \" \" + material.metallic)";
    let rules = format!(
        "Lot --> i(\"cube.obj\") {show} set(material.color.b, 1) {show} resetMaterial() {show}\n\
         comp(m) {{ all : {show} NIL }} color(\"#ffffff\") resetMaterial(all) {show}\n\
         i(\"cube.obj\") color(1, 1, 1) resetMaterial(geometry) {show} NIL"
    );
    let expected = [
        "stone #804000 0",
        "stone #8040FF 0",
        "stone #804000 0",
        "stone #804000 0",
        "tin #ffffff 1",
        " #ffffff 0",
        " #FFFFFF 0",
    ];
    assert_eq!(Shop::new().prints(&rules), expected);
}

#[test]
fn materials_are_set_from_pairs() {
    let show = "print(material.color.r + \" \" + material.colormap + \" \" + material.doubleSided)";
    let row = "setMaterial([\"color.r\", \"0.5\", \"colormap\", \"images/wall.png\", \"doubleSided\", \"false\"])";
    let columns = "setMaterial([\"color.r\", \"0.25\"; \"doubleSided\", \"true\"])";
    let rules = format!("Lot --> {row} {show} {columns} {show} NIL");
    let wall = "/town/assets/images/wall.png";
    assert_eq!(Shop::new().prints(&rules), [format!("0.5 {wall} false"), format!("0.25 {wall} true")]);
    for bad in [
        "[\"color.r\"]",
        "[\"colour\", \"1\"]",
        "[\"metallic\", \"much\"]",
        "[\"a\", \"b\", \"c\"; \"d\", \"e\", \"f\"]",
    ] {
        let (prints, codes) = Shop::new().warned(&format!("Lot --> setMaterial({bad}) print(material.metallic) NIL"));
        assert_eq!((prints[0].as_str(), codes), ("0", vec!["cga::material-pairs"]), "{bad}");
    }
}

#[test]
fn materials_are_got_as_pairs() {
    let shop = Shop::new();
    let get = |what: &str| {
        shop.prints(&format!("Lot --> i(\"cube.obj\") set(material.shininess, 5) print(getMaterial({what})) NIL"))
            .join("\n")
    };
    assert_eq!(get("shape, changed"), "(2)[shininess,5]");
    let squeezed = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(
        squeezed(get("geometry, changed")),
        "(5x2) name stone color.r 0.5 color.g 0.25 color.b 0 colormap /town/assets/images/wall.png"
    );
    assert!(get("used, changed").starts_with("(6x2)"));
    let all = get("used, all");
    assert!(all.contains("metallicmap.rw") && all.contains("CityEngineShader") && !all.contains("color.rgb"), "{all}");
    let copied = "Lot --> i(\"cube.obj\") A(getMaterial(used, all))\nA(m) --> primitiveCube() setMaterial(m) print(material.color.g + material.colormap) NIL";
    assert_eq!(shop.prints(copied), ["0.25/town/assets/images/wall.png"]);
}

#[test]
fn materials_are_read_from_files() {
    let shop = Shop::new();
    let rules = "Lot --> setMaterial(readMaterial(\"look.cgamat\")) print(material.metallic + material.colormap.su)\n\
                 print(material.colormap) setMaterial(readMaterial(\"box.mtl\")) print(material.name + material.color.r) NIL";
    assert_eq!(shop.prints(rules), ["0.75", "/town/assets/images/wall.png", "stone0.5"]);
    let (_, codes) =
        shop.warned("Lot --> setMaterial(readMaterial(\"cube.obj\")) print(size(readMaterial(\"gone.mtl\"))) NIL");
    assert_eq!(codes, ["cga::missing-file"; 2]);
}

#[test]
fn a_missing_texture_reads_as_the_stand_in() {
    let (prints, codes) = Shop::new().warned(
        "Lot --> texture(\"gone.png\") print(material.colormap) set(material.bumpmap, \"builtin:none\") print(material.bumpmap) NIL",
    );
    assert_eq!(prints, ["builtin:unknowntexture.png"; 2]);
    assert_eq!(codes, ["cga::missing-texture"; 2]);
}
