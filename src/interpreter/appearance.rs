//! The two layers of material (reference 3.9). In: `color`, `texture`, `set(material.*)` and asset materials.
//! Out: an [`Appearance`], which holds only what was set, and the material it comes to.

mod finish;
mod pairs;

use std::sync::Arc;

use super::palette::Paint;
use super::value::Value;
use crate::cga::builtins::{Attr, MapLayer, MapPart, MaterialAttr};

const COLORMAP: MaterialAttr = MaterialAttr::Map(MapLayer::Color, MapPart::Path);
pub const OPACITYMAP: MaterialAttr = MaterialAttr::Map(MapLayer::Opacity, MapPart::Path);

/// The name without `material.`.
fn name_of(attr: MaterialAttr) -> &'static str {
    let name = Attr::Material(attr).info().name;
    name.strip_prefix("material.").unwrap_or(name)
}

/// Material attributes that were set explicitly. Colours are sRGB-encoded 0..1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Appearance {
    pub name: Option<Arc<str>>,
    pub color: [Option<f64>; 3],
    pub opacity: Option<f64>,
    pub roughness: Option<f64>,
    pub metallic: Option<f64>,
    pub colormap: Option<Arc<str>>,
    /// By name without `material.`, sorted.
    pub other: Vec<(Arc<str>, Value)>,
}

impl Appearance {
    /// Changes colour or texture.
    pub fn paint(&mut self, paint: &Paint) {
        match paint {
            Paint::Color { rgb, opacity } => {
                self.color = rgb.map(Some);
                self.opacity = opacity.or(self.opacity);
            }
            Paint::Texture { path, opacity_map } => {
                if let Some(map) = opacity_map {
                    self.set(OPACITYMAP, Value::String(map.clone()));
                }
                self.colormap = Some(path.clone());
            }
        }
    }

    /// Sets one attribute; a colour that cannot be read leaves it as it was.
    pub fn set(&mut self, attr: MaterialAttr, value: Value) {
        let share = |value: &Value| Some(value.to_float().clamp(0.0, 1.0));
        match attr {
            MaterialAttr::Name => self.name = Some(value.to_text()),
            MaterialAttr::Color(channel) => self.color[usize::from(channel.min(2))] = share(&value),
            MaterialAttr::ColorRgb => {
                if let Some((rgb, _)) = parse_color(&value.to_text()) {
                    self.color = rgb.map(Some);
                }
            }
            MaterialAttr::Opacity => self.opacity = share(&value),
            MaterialAttr::Roughness => self.roughness = share(&value),
            MaterialAttr::Metallic => self.metallic = share(&value),
            COLORMAP => self.colormap = Some(value.to_text()),
            other => self.set_other(name_of(other).into(), value),
        }
    }

    fn set_other(&mut self, name: Arc<str>, value: Value) {
        match self.other.binary_search_by(|(n, _)| n.cmp(&name)) {
            Ok(place) => self.other[place].1 = value,
            Err(place) => self.other.insert(place, (name, value)),
        }
    }

    /// Reads one attribute if it was set.
    pub fn get(&self, attr: MaterialAttr) -> Option<Value> {
        match attr {
            MaterialAttr::Name => self.name.clone().map(Value::String),
            MaterialAttr::Color(channel) => self.color[usize::from(channel.min(2))].map(Value::Float),
            MaterialAttr::ColorRgb => match self.color {
                [None, None, None] => None,
                color => Some(Value::text(hex(&color.map(|c| c.unwrap_or(1.0))))),
            },
            MaterialAttr::Opacity => self.opacity.map(Value::Float),
            MaterialAttr::Roughness => self.roughness.map(Value::Float),
            MaterialAttr::Metallic => self.metallic.map(Value::Float),
            COLORMAP => self.colormap.clone().map(Value::String),
            other => {
                let place = self.other.binary_search_by(|(n, _)| (**n).cmp(name_of(other))).ok()?;
                Some(self.other[place].1.clone())
            }
        }
    }

    /// What an unset attribute reads as (reference 5.5).
    pub fn default_value(attr: MaterialAttr) -> Value {
        use MaterialAttr as M;
        match attr {
            M::Shader => Value::text("CityEngineShader"),
            M::ColorRgb => Value::text("#ffffff"),
            M::Color(_) | M::Opacity | M::Shininess | M::BumpValue | M::Roughness => Value::Float(1.0),
            M::Map(_, MapPart::ScaleU | MapPart::ScaleV) => Value::Float(1.0),
            M::Map(_, MapPart::OffsetU | MapPart::OffsetV | MapPart::Rotation) => Value::Float(0.0),
            M::Ambient(_) | M::Specular(_) | M::Emissive(_) | M::Reflectivity | M::Metallic => Value::Float(0.0),
            M::DoubleSided => Value::Bool(true),
            M::OpacityMode => Value::text("blend"),
            M::OpacityCutoff => Value::Float(0.5),
            M::Name | M::Map(_, MapPart::Path) => Value::text(""),
        }
    }

    /// This layer over another: what is set here wins.
    pub fn over(&self, below: &Appearance) -> Appearance {
        let mut out = below.clone();
        out.name = self.name.clone().or(out.name);
        for i in 0..3 {
            out.color[i] = self.color[i].or(out.color[i]);
        }
        out.opacity = self.opacity.or(out.opacity);
        out.roughness = self.roughness.or(out.roughness);
        out.metallic = self.metallic.or(out.metallic);
        out.colormap = self.colormap.clone().or(out.colormap);
        for (name, value) in &self.other {
            out.set_other(name.clone(), value.clone());
        }
        out
    }
}

/// `#rrggbb` or `#rrggbboo` as colour and opacity, 0..1; `None` if it is neither.
pub fn parse_color(text: &str) -> Option<([f64; 3], Option<f64>)> {
    let digits = text.strip_prefix('#')?.as_bytes();
    let digit = |i: usize| char::from(digits[i]).to_digit(16);
    let pair = |i: usize| Some(f64::from(digit(i)? * 16 + digit(i + 1)?) / 255.0);
    let opacity = match digits.len() {
        6 => None,
        8 => Some(pair(6)?),
        _ => return None,
    };
    Some(([pair(0)?, pair(2)?, pair(4)?], opacity))
}

/// Parts 0..1 as upper-case hex, rounded half up (reference 6.14).
pub fn hex(parts: &[f64]) -> String {
    let mut out = String::from("#");
    for part in parts {
        let byte = (part.clamp(0.0, 1.0) * 255.0 + 0.5).floor() as u8;
        out.push_str(&format!("{byte:02X}"));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_bytes_over_255() {
        assert_eq!(parse_color("#ff8000"), Some(([1.0, 128.0 / 255.0, 0.0], None)));
        assert_eq!(parse_color("#00000080"), Some(([0.0; 3], Some(128.0 / 255.0))));
        for bad in ["ff8000", "#ff80", "#gg8000", "#ff80é0", ""] {
            assert_eq!(parse_color(bad), None, "{bad}");
        }
        assert_eq!(hex(&[0.2, 0.5, 1.0]), "#3380FF");
    }

    #[test]
    fn what_a_shape_sets_wins_over_its_asset() {
        let mut asset = Appearance::default();
        asset.set(MaterialAttr::Color(0), Value::Float(0.25));
        asset.set(MaterialAttr::Shininess, Value::Float(5.0));
        let mut shape = Appearance::default();
        shape.set(MaterialAttr::Color(1), Value::Float(0.5));
        let material = shape.over(&asset).material();
        assert_eq!(material.color, [0.25, 0.5, 1.0]);
        assert_eq!(material.other, vec![("shininess".into(), "5".into())]);
    }
}
