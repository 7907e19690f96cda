// Path: from the camera (or, in parallel projection, the plane through it) to a point, metres.

fn path_to(place: vec3<f32>) -> vec3<f32> {
    let along = view.forward.xyz * dot(place, view.forward.xyz);
    return select(place, along, view.forward.w > 0.5);
}
