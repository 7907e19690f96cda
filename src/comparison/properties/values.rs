//! Values of a recipe → text, in metres, degrees and percent.

use crate::spec::draw::Distribution;
use crate::spec::filter::{CLASSES, Filter, FilterTerm, Order, TagTest};
use crate::spec::render_spec::{
    AmbientSpec, Amount, AreaSpec, BudgetSpec, CloudsSpec, EffectOverrides, EffectsSpec, ExposureSpec, FileRef,
    FixedKnobs, GroundSpec, HazeSpec, Lens, Origin, QualitySpec, RenderSpec, RuleAssignment, SensorSpec, SetSpec,
    StateSpec, SunColour, SunPosition, SunSpec, ValueSpec,
};

type Properties = Vec<(String, String)>;

/// A file as a recipe names it.
pub fn file_text(file: &FileRef) -> String {
    match &file.origin {
        Origin::Shipped => format!("\"mansard:{}\"", file.written),
        Origin::Beside(_) | Origin::CommandLine => format!("\"{}\"", file.written),
    }
}

/// What tells an assignment from others.
pub fn rule_key(rule: &RuleAssignment) -> String {
    format!("{} for {}", file_text(&rule.file), filter(&rule.filter))
}

pub fn number(d: &Distribution) -> String {
    with_unit(d, 1.0, "")
}

pub fn length(d: &Distribution) -> String {
    with_unit(d, 1.0, " m")
}

pub fn angle(d: &Distribution) -> String {
    with_unit(d, 1.0, "°")
}

pub fn share(d: &Distribution) -> String {
    with_unit(d, 100.0, " %")
}

fn with_unit(d: &Distribution, scale: f64, unit: &str) -> String {
    let one = |x: f64| format!("{}{unit}", rounded(x * scale));
    match d {
        Distribution::Fixed(value) => one(*value),
        Distribution::Uniform { low, high } => format!("uniform({}, {})", one(*low), one(*high)),
        Distribution::Normal { mean, deviation } => format!("normal({}, {})", one(*mean), one(*deviation)),
        Distribution::Choice(alternatives) => {
            let one = |(d, weight): &(Distribution, f64)| format!("{weight}: {}", with_unit(d, scale, unit));
            format!("choice({})", alternatives.iter().map(one).collect::<Vec<_>>().join(", "))
        }
    }
}

/// Without what scaling adds in the last place; still apart wherever recipes can write numbers apart.
fn rounded(x: f64) -> f64 {
    let twelve = format!("{x:.12e}").parse().unwrap_or(x);
    if (twelve - x).abs() <= 1e-15 * x.abs() { twelve } else { x }
}

pub fn value(value: &ValueSpec) -> String {
    match value {
        ValueSpec::Number(d) => number(d),
        ValueSpec::Bool(value) => value.to_string(),
        ValueSpec::Text(text) => format!("\"{text}\""),
        ValueSpec::TextChoice(alternatives) => {
            let one = |(text, weight): &(String, f64)| format!("{weight}: \"{text}\"");
            format!("choice({})", alternatives.iter().map(one).collect::<Vec<_>>().join(", "))
        }
    }
}

pub fn amount(amount: &Amount) -> String {
    match amount {
        Amount::All => "all".to_owned(),
        Amount::Share(d) => share(d),
        Amount::Count(d) => format!("{} objects", number(d)),
    }
}

pub fn area(area: &AreaSpec) -> String {
    match area {
        AreaSpec::BoundingBox { west, south, east, north } => format!("bbox {west}, {south}, {east}, {north}"),
        AreaSpec::Around { latitude, longitude, width, height } => {
            format!("center {latitude}, {longitude} size {width} m x {height} m")
        }
        AreaSpec::Polygon(corners) => {
            let one = |(lat, lon): &(f64, f64)| format!("({lat}, {lon})");
            format!("polygon {}", corners.iter().map(one).collect::<Vec<_>>().join(", "))
        }
    }
}

pub fn filter(filter: &Filter) -> String {
    let term = |term: &FilterTerm| match term {
        FilterTerm::Class { class, tags } => {
            let named = |class| CLASSES.iter().find(|(_, known)| *known == class).map_or("?", |(name, _)| name);
            let class = class.map_or("all", named);
            tags.as_ref().map_or_else(|| class.to_owned(), |tags| format!("{class}[{}]", test(tags)))
        }
        FilterTerm::Object { kind, id } => format!("{}/{id}", crate::spec::ast::object_word(*kind)),
    };
    filter.terms.iter().map(term).collect::<Vec<_>>().join(", ")
}

fn test(of: &TagTest) -> String {
    let list = |tests: &[TagTest], between: &str| tests.iter().map(grouped).collect::<Vec<_>>().join(between);
    match of {
        TagTest::Any(tests) => list(tests, " | "),
        TagTest::All(tests) => list(tests, " & "),
        TagTest::Not(inner) => format!("!{}", grouped(inner)),
        TagTest::Has(tag) => format!("{tag} = *"),
        TagTest::Kind(value) => value.clone(),
        TagTest::Is { tag, value } => format!("{tag} = {value}"),
        TagTest::Compares { tag, order, value } => {
            let order = match order {
                Order::Less => "<",
                Order::LessOrEqual => "<=",
                Order::Greater => ">",
                Order::GreaterOrEqual => ">=",
            };
            format!("{tag} {order} {value}")
        }
    }
}

fn grouped(of: &TagTest) -> String {
    match of {
        TagTest::Any(_) | TagTest::All(_) => format!("({})", test(of)),
        TagTest::Not(_) | TagTest::Has(_) | TagTest::Kind(_) | TagTest::Is { .. } | TagTest::Compares { .. } => {
            test(of)
        }
    }
}

pub fn set(of: &SetSpec, spec: &RenderSpec) -> String {
    let list = |sets: &[SetSpec], between: &str| {
        format!("({})", sets.iter().map(|inner| set(inner, spec)).collect::<Vec<_>>().join(between))
    };
    match of {
        SetSpec::All => "all".to_owned(),
        SetSpec::Terrain => "terrain".to_owned(),
        SetSpec::Class(class) => {
            CLASSES.iter().find(|(_, known)| known == class).map_or("?", |(name, _)| *name).to_owned()
        }
        SetSpec::Vegetation => "vegetation".to_owned(),
        SetSpec::Change(change) => spec.changes[*change].name.clone(),
        SetSpec::Changed => "changed".to_owned(),
        SetSpec::Any(sets) => list(sets, " | "),
        SetSpec::Every(sets) => list(sets, " & "),
        SetSpec::Not(inner) => format!("!{}", set(inner, spec)),
    }
}

pub fn state(state: &StateSpec, spec: &RenderSpec) -> String {
    let names =
        |changes: &[usize]| changes.iter().map(|&c| spec.changes[c].name.as_str()).collect::<Vec<_>>().join(", ");
    match state {
        StateSpec::Before => "before".to_owned(),
        StateSpec::After(changes) => names(changes),
        StateSpec::Both(changes) => format!("both({})", names(changes)),
    }
}

/// The two given ones of gsd, fov and altitude.
pub fn lens(lens: &Lens) -> Vec<(&'static str, String)> {
    let perspective = ("projection", "perspective".to_owned());
    match lens {
        Lens::GsdFov { gsd, fov } => vec![perspective, ("gsd", length(gsd)), ("fov", angle(fov))],
        Lens::GsdAltitude { gsd, altitude } => vec![perspective, ("gsd", length(gsd)), ("altitude", length(altitude))],
        Lens::FovAltitude { fov, altitude } => vec![perspective, ("fov", angle(fov)), ("altitude", length(altitude))],
        Lens::Orthographic { gsd } => vec![("projection", "orthographic".to_owned()), ("gsd", length(gsd))],
    }
}

pub fn sun(at: &str, sun: &SunSpec, out: &mut Properties) {
    let SunSpec { span: _, position, disc, intensity, colour } = sun;
    let mut add = |what: &str, value: String| out.push((format!("{at}.{what}"), value));
    match position {
        SunPosition::Angles { elevation, azimuth } => {
            add("elevation", angle(elevation));
            add("azimuth", angle(azimuth));
        }
        SunPosition::Arc { declination, tilt, turn } => {
            add("declination", angle(declination));
            add("tilt", angle(tilt));
            add("turn", angle(turn));
        }
    }
    add("disc", angle(disc));
    add("intensity", number(intensity));
    add(
        "colour",
        match colour {
            SunColour::Fixed([r, g, b]) => format!("{r}, {g}, {b}"),
            SunColour::ClearSky { turbidity } => format!("clear_sky({})", number(turbidity)),
        },
    );
}

pub fn effects(at: &str, effects: &EffectsSpec, out: &mut Properties) {
    let EffectsSpec { shadows, ambient, atmosphere, clouds, ground, vegetation, sensor } = effects;
    let mut add = |what: &str, value: String| out.push((format!("{at}.{what}"), value));
    add("shadows", word(shadows));
    add("ambient", light(ambient));
    add("atmosphere", or_off(atmosphere.as_ref(), haze));
    add("clouds", or_off(clouds.as_ref(), layer));
    add("ground", or_off(ground.as_ref(), lies));
    add("vegetation", if *vegetation { "trees" } else { "off" }.to_owned());
    add("sensor", or_off(sensor.as_ref(), taken));
}

/// What a pass says of effects, only where it says something.
pub fn overrides(at: &str, over: &EffectOverrides, out: &mut Properties) {
    let EffectOverrides { shadows, ambient, atmosphere, clouds, ground, vegetation, sensor } = over;
    let mut add = |what: &str, value: Option<String>| out.extend(value.map(|value| (format!("{at}.{what}"), value)));
    add("shadows", shadows.as_ref().map(word));
    add("ambient", ambient.as_ref().map(light));
    add("atmosphere", atmosphere.as_ref().map(|own| or_off(own.as_ref(), haze)));
    add("clouds", clouds.as_ref().map(|own| or_off(own.as_ref(), layer)));
    add("ground", ground.as_ref().map(|own| or_off(own.as_ref(), lies)));
    add("vegetation", vegetation.map(|trees| if trees { "trees" } else { "off" }.to_owned()));
    add("sensor", sensor.as_ref().map(|own| or_off(own.as_ref(), taken)));
}

fn or_off<T>(value: Option<&T>, text: fn(&T) -> String) -> String {
    value.map_or("off".to_owned(), text)
}

/// The recipe's word of a variant without fields.
fn word(variant: &impl std::fmt::Debug) -> String {
    format!("{variant:?}").to_lowercase()
}

fn light(ambient: &AmbientSpec) -> String {
    match ambient {
        AmbientSpec::Off => "off".to_owned(),
        AmbientSpec::Constant([r, g, b]) => format!("constant({r}, {g}, {b})"),
        AmbientSpec::Sky { occluded: false } => "sky".to_owned(),
        AmbientSpec::Sky { occluded: true } => "sky_with_occlusion".to_owned(),
    }
}

fn haze(haze: &HazeSpec) -> String {
    let HazeSpec { visibility, scale_height } = haze;
    format!("haze visibility {} scale_height {}", length(visibility), length(scale_height))
}

fn layer(clouds: &CloudsSpec) -> String {
    let CloudsSpec { cover, height, size, depth } = clouds;
    format!("{} height {} size {} depth {}", share(cover), length(height), length(size), number(depth))
}

fn lies(ground: &GroundSpec) -> String {
    let GroundSpec { kind, share: part, within } = ground;
    format!("{} share {} within {}", word(kind), share(part), length(within))
}

fn taken(sensor: &SensorSpec) -> String {
    let SensorSpec { psf, exposure, noise, full_well, bits, bands } = sensor;
    let exposure = match exposure {
        ExposureSpec::Factor(d) => number(d),
        ExposureSpec::Auto => "auto".to_owned(),
    };
    let well = full_well.as_ref().map_or("none".to_owned(), number);
    let (psf, noise, bands) = (number(psf), share(noise), word(bands));
    format!("psf {psf} px, exposure {exposure}, noise {noise}, full_well {well}, depth {bits} bit, bands {bands}")
}

pub fn quality(at: &str, quality: &QualitySpec, out: &mut Properties) {
    let QualitySpec { supersample, shadow_map, shadow_samples, sky_samples, field_map, detail_m, curves, budget } =
        quality;
    let mut add = |what: &str, value: String| out.push((format!("{at}.{what}"), value));
    add("antialiasing", (supersample * supersample).to_string());
    add("shadow_map", shadow_map.to_string());
    add("shadow_samples", shadow_samples.to_string());
    add("sky_samples", sky_samples.to_string());
    add("field_map", field_map.to_string());
    add("detail", format!("{detail_m} m"));
    add("curves", curves.to_string());
    let Some(BudgetSpec { error, edge, height, shadow, fixed }) = budget else { return };
    let FixedKnobs { .. } = fixed;
    for (what, limit) in [("error", error), ("edge", edge), ("height", height), ("shadow", shadow)] {
        if let Some(limit) = limit {
            add(&format!("budget {what}"), limit.to_string());
        }
    }
    add("budget leaves fixed", format!("{fixed:?}"));
}
