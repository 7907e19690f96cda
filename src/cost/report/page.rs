//! A sweep and pictures of its windows → one HTML page that needs no other file and no script.

use std::fmt::Write;

use super::picture::Picture;
use super::plot::{Point, escape, svg};
use super::words::one_more_decimal;
use crate::cost::errors::Metric;
use crate::cost::sweep::{Kind, Row, Sweep};

/// What the page says besides the sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// Name of the recipe's file.
    pub recipe: String,
    /// Pairs of what and how much: view, image, scene, adapter.
    pub facts: Vec<(String, String)>,
    /// Sentences on how it was measured.
    pub method: Vec<String>,
    /// Which row is the recipe's own quality.
    pub own: String,
}

/// The pictures of one window, with a line on each.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    pub title: String,
    pub pictures: Vec<(Picture, String)>,
}

/// Of pages that need no other file.
pub const STYLE: &str = "\
:root{color-scheme:light dark;--back:#fbfbfa;--ink:#1c2330;--soft:#5b6675;--line:#d9dde4;--band:#f1f3f6;--mark:#c2410c}\
@media(prefers-color-scheme:dark){:root{--back:#12161d;--ink:#e5e9f0;--soft:#9aa7b8;--line:#303947;--band:#1a202a;--mark:#fb923c}}\
*{box-sizing:border-box}body{margin:0;background:var(--back);color:var(--ink);font:16px/1.5 system-ui,sans-serif}\
main{max-width:62rem;margin:0 auto;padding:2.5rem 1.25rem 4rem}h1{font-size:1.7rem;margin:0 0 .3rem}\
h2{font-size:1.25rem;margin:2.6rem 0 .6rem}h3{font-size:1.05rem;margin:2rem 0 .3rem}p{max-width:46rem}\
.soft{color:var(--soft)}.lead{font-size:1.08rem}.cost{border-left:3px solid var(--mark);padding-left:.8rem}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.9rem;margin:.8rem 0}\
.wide{overflow-x:auto}th,td{padding:.25rem .8rem .25rem 0;text-align:right;border-bottom:1px solid var(--line);white-space:nowrap}\
th:first-child,td:first-child{text-align:left}th{color:var(--soft);font-weight:600}tr.own td{background:var(--band);font-weight:600}\
td.on{color:var(--mark)}figure{margin:1rem 0}.plots svg,figure svg{width:100%;max-width:680px;height:auto;display:block}\
.panel{display:grid;grid-template-columns:repeat(auto-fill,minmax(15rem,1fr));gap:1rem}.panel figure{margin:0}\
.panel img{width:100%;image-rendering:pixelated;border:1px solid var(--line);display:block}\
figcaption{font-size:.85rem;color:var(--soft);margin-top:.3rem}dl{display:grid;grid-template-columns:max-content 1fr;gap:.1rem 1rem;font-size:.92rem}\
dt{color:var(--soft)}dd{margin:0}code{font-size:.92em}";

/// The whole page.
pub fn html(sweep: &Sweep, about: &About, panels: &[Panel]) -> String {
    let mut out = format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>What accuracy costs: {0}</title><style>{STYLE}</style></head><body><main>\
         <h1>What accuracy costs</h1><p class=\"soft\">{0}</p>",
        escape(&about.recipe)
    );
    lead(&mut out, sweep, about);
    presets(&mut out, sweep, about);
    out.push_str("<h2>All settings</h2><p>Each point is a setting: to the left is faster, below is better. The line joins those that no other \
                  setting beats in both.</p><div class=\"plots\">");
    for metric in Metric::ALL {
        if let Some(plot) = frontier_plot(sweep, about, metric) {
            let _ = write!(out, "<figure>{plot}</figure>");
        }
    }
    out.push_str("</div>");
    pictures(&mut out, panels);
    out.push_str("<h2>Knob by knob</h2><p><b>Alone</b> is the error that the knob itself makes, with everything else as fine as it gets; \
                  <b>in the image</b> is the error with everything else as the recipe has it, which is also what the time is of. The least \
                  errors in reach for their time are marked.</p>");
    for knob in &sweep.knobs {
        section(&mut out, sweep, knob.name, knob.about, knob.metric);
    }
    unswept(&mut out, sweep);
    out.push_str("<h2>How it was measured</h2>");
    for line in &about.method {
        let _ = write!(out, "<p>{}</p>", escape(line));
    }
    out.push_str("<dl>");
    for (what, value) in &about.facts {
        let _ = write!(out, "<dt>{}</dt><dd>{}</dd>", escape(what), escape(value));
    }
    out.push_str("</dl></main></body></html>\n");
    out
}

/// What the recipe's own quality gives up.
fn lead(out: &mut String, sweep: &Sweep, about: &About) {
    let Some(own) = own(sweep, about) else { return };
    let mut parts = vec![format!("light is off by {} of white", Metric::Light.text(own.errors.light))];
    if let Some(edge) = own.errors.edge {
        parts.push(format!("edges lie {} beside their place", Metric::Edge.text(edge)));
    }
    if let Some(miss) = own.errors.shadow {
        parts.push(format!("shadows overlap the true ones by {:.1} %", 100.0 * (1.0 - miss)));
    }
    parts.push(format!("{} of the labels are wrong", Metric::Label.text(own.errors.label)));
    let _ = write!(
        out,
        "<p class=\"lead\">With the recipe’s own quality (<b>{}</b>) the images of a view take <b>{:.0} ms</b>. In the windows \
         that were looked at, {}.</p>",
        escape(&about.own),
        own.times.median,
        parts.join(", ")
    );
}

fn own<'a>(sweep: &'a Sweep, about: &About) -> Option<&'a Row> {
    sweep.rows.iter().find(|row| row.kind == Kind::Preset && row.value == about.own)
}

fn presets(out: &mut String, sweep: &Sweep, about: &About) {
    let rows: Vec<&Row> = sweep.rows.iter().filter(|row| row.kind == Kind::Preset).collect();
    out.push_str("<div class=\"wide\"><table><tr><th>quality</th><th>time</th><th>spread</th>");
    let metrics: Vec<Metric> =
        Metric::ALL.into_iter().filter(|m| rows.iter().any(|r| r.errors.get(*m).is_some())).collect();
    for metric in &metrics {
        let _ = write!(out, "<th>{}</th>", short(*metric));
    }
    out.push_str("<th>frontier</th></tr>");
    let joint = sweep.joint_frontier();
    let on = sweep.rows.iter().zip(joint).filter(|(row, _)| row.kind == Kind::Preset).map(|(_, on)| on);
    for (row, on) in rows.into_iter().zip(on) {
        let class = if row.value == about.own { " class=\"own\"" } else { "" };
        let _ = write!(out, "<tr{class}><td>{}</td>{}", escape(&row.value), times(row));
        for metric in &metrics {
            let text = row.errors.get(*metric).map_or("–".to_owned(), |value| metric.text(value));
            let _ = write!(out, "<td>{text}</td>");
        }
        let _ = write!(out, "<td{}>{}</td></tr>", if on { " class=\"on\"" } else { "" }, if on { "on" } else { "off" });
    }
    out.push_str(
        "</table></div><p class=\"soft\">On the frontier: no other setting measured is faster beyond the spread of times, \
         better in one figure and worse in none.</p>",
    );
}

fn short(metric: Metric) -> &'static str {
    match metric {
        Metric::Light => "light, rms",
        Metric::Worst => "light, 99 %",
        Metric::Shadow => "shadow, 1 − IoU",
        Metric::Edge => "edges",
        Metric::Label => "labels",
        Metric::Height => "ground",
    }
}

fn times(row: &Row) -> String {
    let t = &row.times;
    format!("<td>{:.1} ms</td><td>{:.1} – {:.1}</td>", t.median, t.least, t.most)
}

/// All settings by one metric; `None` where it has no values or they are all the same.
pub fn frontier_plot(sweep: &Sweep, about: &About, metric: Metric) -> Option<String> {
    let on = sweep.frontier(metric);
    let mut points: Vec<Point> = Vec::new();
    for (row, marked) in sweep.rows.iter().zip(on) {
        let Some(error) = row.errors.get(metric) else { continue };
        let label = match row.kind {
            Kind::Preset => row.value.clone(),
            Kind::Combination => row.value.clone(),
            Kind::Knob => format!("{} {}", row.knob, row.value),
        };
        let named = row.kind == Kind::Preset;
        points.push(Point { time: row.times.median, error, label, marked, named });
    }
    let first = points.first()?.error;
    if points.iter().all(|p| (p.error - first).abs() <= 1e-9) {
        return None;
    }
    let own = format!("{} against time, {}", metric.title(), about.recipe);
    Some(svg(&own, &points, &|error| metric.text(error)))
}

/// Errors of a knob alone against time.
pub fn knob_plot(sweep: &Sweep, knob: &str, metric: Metric) -> Option<String> {
    let rows = sweep.of_knob(knob);
    let alone = |row: &Row| row.alone.as_ref().and_then(|errors| errors.get(metric));
    let measured: Vec<(f64, Option<f64>)> = rows.iter().map(|row| (row.times.median, alone(row))).collect();
    let on = crate::cost::pareto::frontier(&measured);
    let points: Vec<Point> = rows
        .iter()
        .zip(on)
        .filter_map(|(row, marked)| {
            Some(Point { time: row.times.median, error: alone(row)?, label: row.value.clone(), marked, named: true })
        })
        .collect();
    let first = points.first()?.error;
    let same = points.iter().all(|p| (p.error - first).abs() <= 0.02 * first.max(1e-9));
    (!same).then(|| svg(&format!("{knob}: {}", metric.title()), &points, &|error| metric.text(error)))
}

fn section(out: &mut String, sweep: &Sweep, knob: &str, about: &str, metric: Metric) {
    let rows = sweep.of_knob(knob);
    let words = one_more_decimal(metric, &rows);
    let _ = write!(
        out,
        "<h3>{}</h3><p class=\"soft\">{}</p><p class=\"cost\">{}</p>",
        escape(knob),
        escape(about),
        escape(&words)
    );
    let light = metric != Metric::Light;
    let head = if light { "<th>light alone</th>" } else { "" };
    let _ = write!(
        out,
        "<div class=\"wide\"><table><tr><th>value</th><th>time</th><th>spread</th><th>{0} alone</th>{head}<th>{0} in the image</th>\
         {1}</tr>",
        short(metric),
        if light { "<th>light in the image</th>" } else { "" }
    );
    let text = |metric: Metric, value: Option<f64>| value.map_or("–".to_owned(), |value| metric.text(value));
    let measured: Vec<_> =
        rows.iter().map(|r| (r.times.median, r.alone.as_ref().and_then(|e| e.get(metric)))).collect();
    let on = crate::cost::pareto::frontier(&measured);
    for ((row, (_, alone)), on) in rows.iter().zip(&measured).zip(on) {
        let class = if on { " class=\"on\"" } else { "" };
        let _ =
            write!(out, "<tr><td>{}</td>{}<td{class}>{}</td>", escape(&row.value), times(row), text(metric, *alone));
        if light {
            let _ = write!(out, "<td>{}</td>", text(Metric::Light, row.alone.as_ref().map(|e| e.light)));
        }
        let _ = write!(out, "<td>{}</td>", text(metric, row.errors.get(metric)));
        if light {
            let _ = write!(out, "<td>{}</td>", text(Metric::Light, Some(row.errors.light)));
        }
        out.push_str("</tr>");
    }
    out.push_str("</table></div>");
    if let Some(plot) = knob_plot(sweep, knob, metric) {
        let _ = write!(out, "<figure>{plot}</figure>");
    }
}

fn pictures(out: &mut String, panels: &[Panel]) {
    if panels.is_empty() {
        return;
    }
    out.push_str("<h2>Pictures of the differences</h2>");
    for panel in panels {
        let _ = write!(out, "<h3>{}</h3><div class=\"panel\">", escape(&panel.title));
        for (picture, caption) in &panel.pictures {
            let _ = write!(
                out,
                "<figure><img alt=\"{0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>",
                escape(caption),
                picture.data_uri()
            );
        }
        out.push_str("</div>");
    }
}

fn unswept(out: &mut String, sweep: &Sweep) {
    if sweep.unswept.is_empty() {
        return;
    }
    out.push_str("<h2>Not swept</h2><ul>");
    for knob in &sweep.unswept {
        let _ = write!(out, "<li><b>{}</b>: {}</li>", escape(knob.knob), escape(knob.reason));
    }
    out.push_str("</ul>");
}
