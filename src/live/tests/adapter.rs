//! An adapter that is lost.

use super::workshop::{Workshop, updated};
use crate::frame::Pixels;
use crate::live::{Canvas, Shown, demand_of};

#[test]
fn a_lost_adapter_is_opened_again_with_the_scene_on_it() {
    let Some(_) = crate::gpu::tests::renderer() else { return };
    let shop = Workshop::new();
    let mut session = shop.session();
    updated(&mut session);
    let built = session.built().expect("something is shown").clone();
    let demand = demand_of(&session.views()[0], Shown::After).expect("the view has such an image");
    let mut canvas = Canvas::new();
    let first = canvas.draw(&built, &demand).expect("it can be drawn");
    assert!(first.notes.is_empty() && first.phases.iter().any(|phase| phase.name == "upload"));
    let again = canvas.draw(&built, &demand).expect("it can be drawn");
    assert!(again.phases.iter().all(|phase| phase.name != "upload" && phase.name != "open adapter"));
    canvas.lose_adapter();
    let drawing = canvas.draw(&built, &demand).expect("the adapter comes back");
    assert_eq!(drawing.notes.len(), 1, "{:?}", drawing.notes);
    assert!(drawing.phases.iter().any(|phase| phase.name == "upload"));
    assert_eq!(drawing.frame, first.frame);
    let Pixels::Rgb8(pixels) = &drawing.frame.images[0].pixels else { panic!("a colour image") };
    assert!(pixels.iter().any(|&byte| byte != pixels[0]));
    let mask = demand_of(&session.views()[0], Shown::Mask).expect("the view has a mask");
    assert_eq!((mask.outputs.len(), mask.outputs[0].pass.as_str()), (1, "mask"));
    let before = demand_of(&session.views()[0], Shown::Before).expect("the view has both");
    assert_eq!(before.outputs[0].pass, "before");
}
