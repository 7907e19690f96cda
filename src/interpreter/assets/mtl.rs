//! Material libraries of OBJ files. In: the bytes of a `.mtl` file and a way to name textures. Out: materials by name,
//! with the attributes of the rule language that they come to. What has no such attribute is skipped.

use crate::cga::builtins::{MapLayer, MapPart, MaterialAttr};
use crate::interpreter::appearance::Appearance;
use crate::interpreter::value::Value;

/// Materials in the order of the file. `place` gives a texture file the name that textures are loaded by.
pub fn read(bytes: &[u8], place: &dyn Fn(&str) -> String) -> Vec<(String, Appearance)> {
    let text = String::from_utf8_lossy(bytes);
    let mut out: Vec<(String, Appearance)> = Vec::new();
    for line in text.lines() {
        let statement = line.split('#').next().unwrap_or("").trim();
        let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((statement, ""));
        if keyword == "newmtl" {
            let name = rest.trim();
            out.push((name.to_owned(), Appearance { name: Some(name.into()), ..Appearance::default() }));
        } else if let Some((_, material)) = out.last_mut() {
            match layer(keyword) {
                Some(layer) => map(material, layer, rest, place),
                None => values(material, keyword, rest),
            }
        }
    }
    out
}

fn layer(keyword: &str) -> Option<MapLayer> {
    Some(match keyword.to_ascii_lowercase().as_str() {
        "map_kd" => MapLayer::Color,
        "map_bump" | "bump" => MapLayer::Bump,
        "map_ks" => MapLayer::Specular,
        "map_d" => MapLayer::Opacity,
        "norm" => MapLayer::Normal,
        "map_ke" => MapLayer::Emissive,
        "map_pr" => MapLayer::Roughness,
        "map_pm" => MapLayer::Metallic,
        _ => return None,
    })
}

fn values(material: &mut Appearance, keyword: &str, rest: &str) {
    let numbers: Vec<f64> =
        rest.split_whitespace().map_while(|w| w.parse::<f64>().ok()).filter(|x| x.is_finite()).collect();
    let Some(&x) = numbers.first() else { return };
    let mut one = |attr, x: f64| material.set(attr, Value::Float(x));
    let rgb: fn(u8) -> MaterialAttr = match keyword {
        "Kd" => MaterialAttr::Color,
        "Ka" => MaterialAttr::Ambient,
        "Ks" => MaterialAttr::Specular,
        "Ke" => MaterialAttr::Emissive,
        "d" => return one(MaterialAttr::Opacity, x),
        "Tr" => return one(MaterialAttr::Opacity, 1.0 - x),
        "Ns" => return one(MaterialAttr::Shininess, x.clamp(0.0, 128.0)),
        "Pr" => return one(MaterialAttr::Roughness, x),
        "Pm" => return one(MaterialAttr::Metallic, x),
        _ => return,
    };
    // One number stands for all three.
    for channel in 0..3 {
        one(rgb(channel), numbers.get(usize::from(channel)).copied().unwrap_or(x).clamp(0.0, 1.0));
    }
}

/// `map_Kd -s 2 2 -o 0.5 0 file name.png`: options, then the rest of the line.
fn map(material: &mut Appearance, layer: MapLayer, rest: &str, place: &dyn Fn(&str) -> String) {
    let mut set = |part, value| material.set(MaterialAttr::Map(layer, part), value);
    let mut rest = rest.trim();
    while let Some(option) = rest.strip_prefix('-') {
        let (name, after) = option.split_once(char::is_whitespace).unwrap_or((option, ""));
        rest = after.trim_start();
        let most = match name {
            "s" | "o" | "t" => 3,
            "mm" => 2,
            _ => 1,
        };
        let mut numbers = Vec::new();
        for place in 0..most {
            let (word, after) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
            let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
            // Options of several numbers may have fewer; others take a word.
            if number.is_none() && (place > 0 || most > 1) {
                break;
            }
            numbers.extend(number);
            rest = after.trim_start();
        }
        let parts = match name {
            "s" => [MapPart::ScaleU, MapPart::ScaleV],
            "o" => [MapPart::OffsetU, MapPart::OffsetV],
            _ => continue,
        };
        for (part, x) in parts.into_iter().zip(numbers) {
            set(part, Value::Float(x));
        }
    }
    if !rest.is_empty() {
        set(MapPart::Path, Value::text(place(&rest.replace('\\', "/"))));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_told_from_names() {
        let text = "newmtl a\nKd 1 0.5 0\nKe 0.25\nTr 0.25\nNs 200\nPm 1 # metal\n\
                    map_Kd -s 2 3 -o 0.5 my wall.png\nbump -bm 0.4 sub\\b.png\nmap_d -clamp on d.png\nnewmtl b c\n";
        let materials = read(text.as_bytes(), &|file| format!("x/{file}"));
        assert_eq!(materials.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["a", "b c"]);
        let get = |attr| materials[0].1.get(attr);
        let map = |layer, part| get(MaterialAttr::Map(layer, part));
        assert_eq!(materials[0].1.color, [Some(1.0), Some(0.5), Some(0.0)]);
        assert_eq!(get(MaterialAttr::Emissive(2)), Some(Value::Float(0.25)));
        assert_eq!(get(MaterialAttr::Opacity), Some(Value::Float(0.75)));
        assert_eq!(get(MaterialAttr::Shininess), Some(Value::Float(128.0)));
        assert_eq!(get(MaterialAttr::Metallic), Some(Value::Float(1.0)));
        assert_eq!(map(MapLayer::Color, MapPart::Path), Some(Value::text("x/my wall.png")));
        assert_eq!(map(MapLayer::Color, MapPart::ScaleV), Some(Value::Float(3.0)));
        assert_eq!(map(MapLayer::Color, MapPart::OffsetU), Some(Value::Float(0.5)));
        assert_eq!(map(MapLayer::Color, MapPart::OffsetV), None);
        assert_eq!(map(MapLayer::Bump, MapPart::Path), Some(Value::text("x/sub/b.png")));
        assert_eq!(map(MapLayer::Opacity, MapPart::Path), Some(Value::text("x/d.png")));
    }
}
