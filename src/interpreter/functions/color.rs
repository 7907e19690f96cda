//! Colours (reference 6.14): hex texts, RGB and opacity 0..1, HSV with hue in degrees.

use super::super::appearance::{hex, parse_color};
use super::super::value::Value;
use super::Input;
use crate::cga::builtins::Function as F;

pub fn call(function: F, input: &Input) -> Option<Value> {
    let parsed = || parse_color(&input.text(0)).unwrap_or(([0.0; 3], None));
    let x = |i: usize| input.float(i);
    Some(match function {
        F::ColorHexToR => Value::Float(parsed().0[0]),
        F::ColorHexToG => Value::Float(parsed().0[1]),
        F::ColorHexToB => Value::Float(parsed().0[2]),
        F::ColorHexToO => Value::Float(parsed().1.unwrap_or(0.0)),
        F::ColorHexToH => Value::Float(hsv(parsed().0)[0]),
        F::ColorHexToS => Value::Float(hsv(parsed().0)[1]),
        F::ColorHexToV => Value::Float(hsv(parsed().0)[2]),
        F::ColorRgbToHex => Value::text(hex(&[x(0), x(1), x(2)])),
        F::ColorRgboToHex => Value::text(hex(&[x(0), x(1), x(2), x(3)])),
        F::ColorHsvToHex => Value::text(hex(&rgb(x(0), x(1), x(2)))),
        F::ColorHsvoToHex => {
            let [r, g, b] = rgb(x(0), x(1), x(2));
            Value::text(hex(&[r, g, b, x(3)]))
        }
        F::ColorRamp => Value::text(hex(&ramp(&input.text(0), x(1)))),
        _ => return None,
    })
}

fn hsv([r, g, b]: [f64; 3]) -> [f64; 3] {
    let (high, low) = (r.max(g).max(b), r.min(g).min(b));
    let range = high - low;
    let sixth = if range == 0.0 {
        0.0
    } else if high == r {
        ((g - b) / range).rem_euclid(6.0)
    } else if high == g {
        (b - r) / range + 2.0
    } else {
        (r - g) / range + 4.0
    };
    [sixth * 60.0, if high == 0.0 { 0.0 } else { range / high }, high]
}

fn rgb(h: f64, s: f64, v: f64) -> [f64; 3] {
    let (s, v) = (s.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
    let sixth = h.rem_euclid(360.0) / 60.0;
    let part = |offset: f64| {
        let k = (offset + sixth).rem_euclid(6.0);
        v - v * s * k.min(4.0 - k).clamp(0.0, 1.0)
    };
    [part(5.0), part(3.0), part(1.0)]
}

/// Stops of the named gradients (our choice, reference A50); an unknown name is white to black.
fn ramp(name: &str, x: f64) -> [f64; 3] {
    let stops: &[&str] = match name {
        "greenToRed" => &["#00FF00", "#FFFF00", "#FF0000"],
        "yellowToRed" => &["#FFFF00", "#FF0000"],
        "redToBlue" => &["#FF0000", "#FFFFFF", "#0000FF"],
        "orangeToBlue" => &["#FF8000", "#FFFFFF", "#0040FF"],
        "brownToBlue" => &["#804000", "#FFFFFF", "#0040FF"],
        "spectrum" => &["#FF00FF", "#0000FF", "#00FF00", "#FFFF00", "#FF0000"],
        _ => &["#FFFFFF", "#000000"],
    };
    let at = if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) } * (stops.len() - 1) as f64;
    let i = (at as usize).min(stops.len() - 2);
    let color = |k: usize| parse_color(stops[k]).expect("the stops are written as colours").0;
    let (a, b, t) = (color(i), color(i + 1), at - i as f64);
    [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * t)
}
