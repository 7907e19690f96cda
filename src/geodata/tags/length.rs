//! Numbers with units as mappers write them. In: a tag's value. Out: metres, plain numbers, bearings.

/// A plain number: `3`, `2.5`, `2,5`; of several values (`2;3`) the first.
pub fn number(text: &str) -> Option<f64> {
    let text = super::first(text);
    let decimal = if text.contains('.') { text.replace(',', "") } else { text.replacen(',', ".", 1) };
    let plain = decimal.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'));
    decimal.parse().ok().filter(|n: &f64| plain && n.is_finite())
}

/// A length in metres: `14`, `14m`, `3 m`, `12,5`, `45'`, `5'6"`, `30 ft`, `180 cm`, `~10`.
pub fn length(text: &str) -> Option<f64> {
    let text = super::first(text).trim_start_matches(['~', ' ']).to_lowercase();
    if let Some((feet, inches)) = text.split_once('\'').or_else(|| text.split_once('’')) {
        let inches = inches.trim().trim_end_matches(['"', '”', '\'']).trim();
        let inches = if inches.is_empty() { 0.0 } else { number(inches)? };
        return Some(number(feet.trim())? * FOOT + inches * INCH);
    }
    let split = text.find(|c: char| c.is_alphabetic() || c == '"').unwrap_or(text.len());
    let (digits, unit) = text.split_at(split);
    let unit = match unit.trim_end_matches('.') {
        "" | "m" | "metre" | "metres" | "meter" | "meters" | "mt" => 1.0,
        "cm" => 0.01,
        "km" => 1000.0,
        "ft" | "feet" | "foot" => FOOT,
        "in" | "inch" | "inches" | "\"" => INCH,
        _ => return None,
    };
    Some(number(digits.trim())? * unit)
}

const FOOT: f64 = 0.3048;
const INCH: f64 = 0.0254;

/// A bearing in degrees clockwise from north, in [0, 360): `135`, `135°`, `SE`, `NNW`, `south`.
pub fn compass(text: &str) -> Option<f64> {
    const POINTS: [&str; 16] =
        ["n", "nne", "ne", "ene", "e", "ese", "se", "sse", "s", "ssw", "sw", "wsw", "w", "wnw", "nw", "nnw"];
    let text = super::first(text).to_lowercase();
    let short = match text.as_str() {
        "north" => "n",
        "east" => "e",
        "south" => "s",
        "west" => "w",
        "northeast" => "ne",
        "southeast" => "se",
        "southwest" => "sw",
        "northwest" => "nw",
        other => other,
    };
    match POINTS.iter().position(|point| *point == short) {
        Some(index) => Some(index as f64 * 22.5),
        None => number(short.trim_end_matches(['°', ' '])).map(|degrees| degrees.rem_euclid(360.0)),
    }
}
