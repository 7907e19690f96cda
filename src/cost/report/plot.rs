//! Times and errors → a plot as SVG: both axes logarithmic, the frontier marked. Colours follow the page's theme.

use std::fmt::Write;

/// One setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Milliseconds.
    pub time: f64,
    pub error: f64,
    pub label: String,
    /// On the frontier.
    pub marked: bool,
    /// Drawn larger: what people look for first.
    pub named: bool,
}

const WIDTH: f64 = 680.0;
const HEIGHT: f64 = 360.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 48.0;

/// Style of plots: ink, faint lines and an accent, for light and dark.
pub const STYLE: &str = "\
.plot{color:#1c2330;--faint:#c9cfd9;--mark:#c2410c;--other:#64748b}\
@media(prefers-color-scheme:dark){.plot{color:#e5e9f0;--faint:#3a4352;--mark:#fb923c;--other:#8fa0b8}}\
.plot text{fill:currentColor;font:12px system-ui,sans-serif}\
.plot .title{font-weight:600;font-size:13px}\
.plot .grid{stroke:var(--faint);stroke-width:1}\
.plot .way{fill:none;stroke:var(--mark);stroke-width:1.5}\
.plot .on{fill:var(--mark)}\
.plot .off{fill:none;stroke:var(--other);stroke-width:1.3}\
.plot .name{font-size:11px}";

/// A logarithmic axis: from data to pixels.
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// Around the values, with some air; at least a factor of two wide.
    fn new(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Axis {
        let logs: Vec<f64> = values.map(libm::log10).collect();
        let low = logs.iter().copied().fold(f64::INFINITY, f64::min);
        let high = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let air = (0.06 * (high - low)).max(0.15);
        Axis { low: low - air, high: high + air, from, to }
    }

    fn at(&self, value: f64) -> f64 {
        self.from + (libm::log10(value) - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// 1, 2 and 5 of every decade; whole decades alone where there are many.
    fn ticks(&self) -> Vec<f64> {
        let steps: &[f64] = if self.high - self.low > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        let all = decades.flat_map(|d| steps.iter().map(move |s| s * libm::pow(10.0, f64::from(d))));
        all.filter(|v| (self.low..=self.high).contains(&libm::log10(*v))).collect()
    }
}

/// The plot; `error_text` writes the errors at the axis. Errors of 0 stand at a third of the least that is not.
pub fn svg(title: &str, points: &[Point], error_text: &dyn Fn(f64) -> String) -> String {
    let least = points.iter().map(|p| p.error).filter(|e| *e > 0.0).fold(f64::INFINITY, f64::min);
    let floor = if least.is_finite() { least / 3.0 } else { 1e-6 };
    let height = |p: &Point| p.error.max(floor);
    let mut out = format!(
        "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" \
         aria-label=\"{0}\"><style>{STYLE}</style><text class=\"title\" x=\"{LEFT}\" y=\"18\">{0}</text>",
        escape(title)
    );
    if points.is_empty() {
        out.push_str("</svg>");
        return out;
    }
    let x = Axis::new(points.iter().map(|p| p.time), LEFT, WIDTH - RIGHT);
    let y = Axis::new(points.iter().map(height), HEIGHT - BOTTOM, TOP);
    grid(&mut out, &x, &y, error_text);
    let mut marked: Vec<&Point> = points.iter().filter(|p| p.marked).collect();
    marked.sort_by(|a, b| a.time.total_cmp(&b.time));
    let way: Vec<String> = marked.iter().map(|p| format!("{:.1},{:.1}", x.at(p.time), y.at(height(p)))).collect();
    let _ = write!(out, "<polyline class=\"way\" points=\"{}\"/>", way.join(" "));
    for point in points {
        let (class, radius) = (if point.marked { "on" } else { "off" }, if point.named { 6.0 } else { 3.5 });
        let _ = write!(
            out,
            "<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\"><title>{}: {} in {:.1} ms</title></circle>",
            x.at(point.time),
            y.at(height(point)),
            escape(&point.label),
            escape(&error_text(point.error)),
            point.time
        );
    }
    names(&mut out, points, &|p| (x.at(p.time), y.at(height(p))));
    out.push_str("</svg>");
    out
}

fn grid(out: &mut String, x: &Axis, y: &Axis, error_text: &dyn Fn(f64) -> String) {
    let bottom = HEIGHT - BOTTOM;
    for tick in x.ticks() {
        let at = x.at(tick);
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{TOP}\" y2=\"{bottom}\"/>\
             <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{} ms</text>",
            bottom + 18.0,
            plain(tick)
        );
    }
    for tick in y.ticks() {
        let at = y.at(tick);
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            WIDTH - RIGHT,
            LEFT - 8.0,
            at + 4.0,
            escape(&error_text(tick))
        );
    }
    let middle = (LEFT + WIDTH - RIGHT) / 2.0;
    let _ = write!(out, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">time of an image</text>", HEIGHT - 8.0);
}

/// Names of the points, those that are looked for first; one that would lie over another is left to its tooltip.
fn names(out: &mut String, points: &[Point], place: &dyn Fn(&Point) -> (f64, f64)) {
    let mut order: Vec<&Point> = points.iter().filter(|p| p.named || p.marked).collect();
    order.sort_by_key(|p| !p.named);
    let mut taken: Vec<(f64, f64, f64)> = Vec::new();
    for point in order {
        let (x, y) = place(point);
        let width = 6.0 * point.label.chars().count() as f64;
        let left = if x + 10.0 + width > WIDTH - 4.0 { x - 10.0 - width } else { x + 10.0 };
        let y = y - 6.0;
        let free =
            |&(l, w, at): &(f64, f64, f64)| (y - at).abs() > 13.0 || left > l + w + 4.0 || l > left + width + 4.0;
        if left > LEFT && taken.iter().all(free) {
            taken.push((left, width, y));
            let _ = write!(out, "<text class=\"name\" x=\"{left:.1}\" y=\"{y:.1}\">{}</text>", escape(&point.label));
        }
    }
}

/// A number without needless digits.
fn plain(value: f64) -> String {
    if value >= 1.0 { format!("{}", value.round()) } else { format!("{}", (value * 1e6).round() / 1e6) }
}

/// Text as HTML and XML take it.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(time: f64, error: f64, marked: bool) -> Point {
        Point { time, error, label: format!("{time} & <{error}>"), marked, named: false }
    }

    #[test]
    fn slower_is_farther_right_and_worse_is_higher() {
        let axis = Axis::new([1.0, 10.0, 100.0].into_iter(), 0.0, 100.0);
        assert!((axis.at(10.0) - 50.0).abs() < 1e-9 && axis.at(1.0) > 0.0 && axis.at(100.0) < 100.0);
        assert_eq!(axis.ticks(), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
    }

    #[test]
    fn plots_are_well_formed_whatever_the_values() {
        for points in [
            vec![],
            vec![point(1.0, 0.0, true)],
            vec![point(1.0, 0.5, true), point(1.0, 0.5, true), point(2000.0, 0.0, false)],
        ] {
            let svg = svg("a & b", &points, &|e| format!("{e}"));
            assert_eq!(svg.matches("<circle").count(), points.len());
            assert!(!svg.contains("NaN") && !svg.contains("inf") && !svg.contains("a & b"), "{svg}");
            let mut reader = quick_xml::Reader::from_str(&svg);
            while reader.read_event().expect("it is XML") != quick_xml::events::Event::Eof {}
        }
    }
}
