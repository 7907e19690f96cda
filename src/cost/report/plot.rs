//! Times and errors → a plot as SVG: both axes logarithmic, the frontier marked.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

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

/// Pixels.
const SIZE: (u32, u32) = (680, 360);
const INK: RGBColor = RGBColor(28, 35, 48);
const FAINT: RGBColor = RGBColor(201, 207, 217);
const MARK: RGBColor = RGBColor(194, 65, 12);
const OTHER: RGBColor = RGBColor(100, 116, 139);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// A logarithmic axis around positive values, with some air; at least a factor of two wide.
fn axis(values: impl Iterator<Item = f64>) -> Range<f64> {
    let logs: Vec<f64> = values.map(libm::log10).collect();
    let low = logs.iter().copied().fold(f64::INFINITY, f64::min);
    let high = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let air = (0.06 * (high - low)).max(0.15);
    libm::pow(10.0, low - air)..libm::pow(10.0, high + air)
}

/// The plot; `error_text` writes the errors at the axis. Errors of 0 stand at a third of the least that is not.
pub fn svg(title: &str, points: &[Point], error_text: &dyn Fn(f64) -> String) -> String {
    let mut out = String::new();
    draw(SVGBackend::with_string(&mut out, SIZE).into_drawing_area(), title, points, error_text)
        .expect("text in memory takes every shape");
    out
}

fn draw(area: Area, title: &str, points: &[Point], error_text: &dyn Fn(f64) -> String) -> Drawn {
    area.fill(&WHITE)?;
    let least = points.iter().map(|p| p.error).filter(|e| *e > 0.0).fold(f64::INFINITY, f64::min);
    let floor = if least.is_finite() { least / 3.0 } else { 1e-6 };
    let place = |p: &Point| (p.time, p.error.max(floor));
    let (x, y) = if points.is_empty() {
        (1.0..10.0, 0.01..1.0)
    } else {
        (axis(points.iter().map(|p| p.time)), axis(points.iter().map(|p| place(p).1)))
    };
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 14).into_font().color(&INK))
        .margin(8)
        .margin_right(24)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(x.log_scale(), y.log_scale())?;
    chart
        .configure_mesh()
        .bold_line_style(FAINT)
        .light_line_style(WHITE)
        .axis_style(FAINT)
        .label_style(("sans-serif", 12).into_font().color(&INK))
        .x_desc("time of an image")
        .x_label_formatter(&|ms| format!("{} ms", plain(*ms)))
        .y_label_formatter(&|error| error_text(*error))
        .draw()?;
    let mut marked: Vec<&Point> = points.iter().filter(|p| p.marked).collect();
    marked.sort_by(|a, b| a.time.total_cmp(&b.time));
    chart.draw_series(LineSeries::new(marked.into_iter().map(place), MARK.stroke_width(2)))?;
    chart.draw_series(points.iter().map(|p| {
        let style = if p.marked { MARK.filled() } else { OTHER.stroke_width(1) };
        Circle::new(place(p), if p.named { 6 } else { 3 }, style)
    }))?;
    let plotting = chart.plotting_area();
    names(&area, points, &|p| plotting.map_coordinate(&place(p)))?;
    area.present()
}

/// Names of the points, those that are looked for first; one that would lie over another is left out.
fn names(area: &Area, points: &[Point], place: &dyn Fn(&Point) -> (i32, i32)) -> Drawn {
    let mut order: Vec<&Point> = points.iter().filter(|p| p.named || p.marked).collect();
    order.sort_by_key(|p| !p.named);
    let mut taken: Vec<(i32, i32, i32)> = Vec::new();
    for point in order {
        let (x, y) = place(point);
        let width = 6 * point.label.chars().count() as i32;
        let left = if x + 10 + width > SIZE.0 as i32 - 4 { x - 10 - width } else { x + 10 };
        let y = y - 16;
        let free = |&(l, w, at): &(i32, i32, i32)| (y - at).abs() > 13 || left > l + w + 4 || l > left + width + 4;
        if left > 74 && taken.iter().all(free) {
            taken.push((left, width, y));
            let style = ("sans-serif", 11).into_font().color(&INK);
            area.draw(&Text::new(point.label.clone(), (left, y), style))?;
        }
    }
    Ok(())
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
    fn plots_are_well_formed_whatever_the_values() {
        for points in [
            vec![],
            vec![point(1.0, 0.0, true)],
            vec![point(1.0, 0.5, true), point(1.0, 0.5, true), point(2000.0, 0.0, false)],
        ] {
            let svg = svg("a & b", &points, &|e| format!("{e}"));
            assert_eq!(svg.matches("<circle").count(), points.len(), "{svg}");
            assert!(!svg.contains("NaN") && !svg.contains("inf") && !svg.contains("a & b"), "{svg}");
            let mut reader = quick_xml::Reader::from_str(&svg);
            while reader.read_event().expect("it is XML") != quick_xml::events::Event::Eof {}
        }
    }

    #[test]
    fn slower_is_farther_right_and_worse_is_higher() {
        let svg = svg("t", &[point(10.0, 0.5, false), point(100.0, 0.05, false)], &|e| format!("{e}"));
        let number = |key: &str| -> Vec<i32> {
            svg.split("<circle")
                .skip(1)
                .map(|c| c.split_once(&format!("{key}=\"")).unwrap().1.split('"').next().unwrap().parse().unwrap())
                .collect()
        };
        let (x, y) = (number("cx"), number("cy"));
        assert!(x[0] < x[1] && y[0] < y[1], "{svg}");
    }
}
