// Path: from the camera (or, in parallel projection, the plane through it) to a point, metres.

fn path_to(place: vec3<f32>) -> vec3<f32> {
    let path = place + view.to_origin.xyz;
    return select(path, view.forward.xyz * dot(path, view.forward.xyz), view.forward.w > 0.5);
}
