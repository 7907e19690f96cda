//! Effects in recipes: what they mean, and what is said of mistakes.

use super::{loaded, message, mistakes, small};
use crate::spec::draw::Distribution;
use crate::spec::render_spec::{
    AmbientSpec, BandsSpec, CloudsSpec, EffectsSpec, ExposureSpec, GroundKindSpec, GroundSpec, HazeSpec, SensorSpec,
    SetSpec, ShadowsSpec, SunColour,
};

fn effects(text: &str) -> EffectsSpec {
    let spec = loaded(&small(&format!("effects {{ {text} }}\ndataset d {{ views c }}")));
    spec.datasets[0].effects.clone()
}

const fn fixed(value: f64) -> Distribution {
    Distribution::Fixed(value)
}

#[test]
fn every_effect_is_off_unless_asked_for() {
    assert_eq!(effects(""), EffectsSpec::OFF);
    let off = "shadows off; ambient off; atmosphere off; clouds off; ground off; vegetation off; sensor off";
    assert_eq!(effects(off), EffectsSpec::OFF);
    assert_eq!(loaded(&small("dataset d { views c }")).datasets[0].effects, EffectsSpec::OFF);
}

#[test]
fn effects_have_units_draws_and_defaults() {
    let found = effects(
        "shadows soft; ambient sky_with_occlusion\n atmosphere haze visibility uniform(5km, 20km)\n\
         clouds 30% height 2km size 300m depth uniform(2, 9)\n ground ash share 40% within 12m\n vegetation trees\n\
         sensor psf 0.6px exposure auto\n noise 1% full_well 20000 depth 16bit bands false_color",
    );
    let uniform = |low, high| Distribution::Uniform { low, high };
    let ground = GroundSpec { kind: GroundKindSpec::Ash, share: fixed(0.4), within: fixed(12.0) };
    let sensor = SensorSpec {
        psf: fixed(0.6),
        exposure: ExposureSpec::Auto,
        noise: fixed(0.01),
        full_well: Some(fixed(20_000.0)),
        bits: 16,
        bands: BandsSpec::FalseColour,
    };
    let clouds = CloudsSpec { cover: fixed(0.3), height: fixed(2000.0), size: fixed(300.0), depth: uniform(2.0, 9.0) };
    let expected = EffectsSpec {
        shadows: ShadowsSpec::Soft,
        ambient: AmbientSpec::Sky { occluded: true },
        atmosphere: Some(HazeSpec { visibility: uniform(5000.0, 20_000.0), scale_height: fixed(1200.0) }),
        clouds: Some(clouds),
        ground: Some(ground),
        vegetation: true,
        sensor: Some(sensor),
    };
    assert_eq!(found, expected);
    let plain = effects("sensor bands nir").sensor.expect("it is asked for");
    assert_eq!((plain.bits, plain.full_well, plain.exposure), (8, None, ExposureSpec::Factor(fixed(1.0))));
    assert_eq!(effects("ground puddles").ground.expect("it is asked for").within, fixed(25.0));
}

#[test]
fn passes_override_effects_one_by_one() {
    let spec = loaded(&small(
        "effects { shadows hard; clouds 50%; atmosphere haze }\ndataset d { views c }\n\
         pass p { show all & !vegetation\n clouds off; sensor noise 2% }",
    ));
    let dataset = spec.datasets[0].effects.clone();
    let pass = dataset.with(&spec.passes[1].effects);
    assert_eq!((pass.shadows, pass.clouds.is_some(), pass.atmosphere), (ShadowsSpec::Hard, false, dataset.atmosphere));
    assert_eq!(pass.sensor.expect("the pass has one").noise, fixed(0.02));
    let SetSpec::Every(sets) = &spec.passes[1].show else { panic!("{:?}", spec.passes[1].show) };
    assert_eq!(sets[1], SetSpec::Not(Box::new(SetSpec::Vegetation)));
}

#[test]
fn the_sun_of_a_clear_sky_has_a_turbidity() {
    let colour = |text: &str| {
        loaded(&small(&format!("sun {{ colour {text} }}\ndataset d {{ views c }}"))).datasets[0].sun.colour.clone()
    };
    assert_eq!(colour("clear_sky"), SunColour::ClearSky { turbidity: fixed(3.0) });
    let drawn = Distribution::Uniform { low: 2.0, high: 5.0 };
    assert_eq!(colour("clear_sky(uniform(2, 5))"), SunColour::ClearSky { turbidity: drawn });
    assert_eq!(colour("1, 0.5, 25%"), SunColour::Fixed([1.0, 0.5, 0.25]));
    let found = message(&small("sun { colour clear_sky(11) }"), "spec::out-of-range");
    assert_eq!(found, "the turbidity of a clear sky lies between 2 and 8, `11` does not | ");
    let found = message(&small("sun { colour clear_sky(2, 3) }"), "spec::wrong-value");
    assert_eq!(found, "`clear_sky(2, 3)` is not of the form `clear_sky` or `clear_sky(3)` | ");
    let found = message(&small("sun { colour clearsky }"), "spec::wrong-value");
    assert_eq!(found, "`clearsky` is not `clear_sky` | did you mean `clear_sky`?");
}

/// Every mistake has its own words.
#[test]
fn mistakes_in_effects_are_named() {
    let found: Vec<String> = [
        ("atmosphere haze visibility 20", "spec::missing-unit"),
        ("atmosphere fog", "spec::wrong-value"),
        ("atmosphere haze visibility 20m", "spec::out-of-range"),
        ("atmosphere off visibility 20km", "spec::wrong-value"),
        ("atmosphere haze visibility 3km visibility 4km", "spec::repeated-property"),
        ("clouds on", "spec::wrong-value"),
        ("clouds 30", "spec::missing-unit"),
        ("clouds uniform(50%, 120%)", "spec::out-of-range"),
        ("clouds 30% height 2000", "spec::missing-unit"),
        ("ground mud", "spec::wrong-value"),
        ("ground ash 40%", "spec::syntax"),
        ("ground ash share 40m", "spec::wrong-unit"),
        ("vegetation on", "spec::wrong-value"),
        ("vegetation trees(3)", "spec::wrong-value"),
        ("sensor", "spec::wrong-value"),
        ("sensor on", "spec::wrong-value"),
        ("sensor depth 12bit", "spec::wrong-value"),
        ("sensor depth 16", "spec::missing-unit"),
        ("sensor bands swir", "spec::wrong-value"),
        ("sensor exposure bright", "spec::wrong-value"),
        ("sensor full_well 0", "spec::out-of-range"),
        ("ambient sky(3)", "spec::wrong-value"),
    ]
    .into_iter()
    .map(|(text, code)| format!("{text}\n    {}", message(&small(&format!("effects {{ {text} }}")), code)))
    .collect();
    insta::assert_snapshot!(found.join("\n"));
}

#[test]
fn passes_say_the_same_of_their_mistakes() {
    let found = mistakes(&small("pass p { show all\n clouds 30\n sensor depth 9bit }"));
    assert_eq!(found, [("spec::missing-unit", "30".to_owned()), ("spec::wrong-value", "9bit".to_owned())]);
}
