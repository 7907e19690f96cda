//! `mirror` and `mirrorScope` (reference 4.7, 4.12). In: a flag per axis. Out: mirrored geometry, or a scope seen from
//! the other end.

use std::sync::Arc;

use glam::DVec3;

use super::super::shape::Shape;
use super::args::Args;
use crate::geometry::transform::turn_loops;

fn flags(args: &Args) -> [bool; 3] {
    [args.bool(0), args.bool(1), args.bool(2)]
}

/// `mirrorScope`: the origin goes to the other end and the size changes its sign; geometry stays.
pub fn scope(args: &Args, shape: &mut Shape) {
    shape.bake();
    for (i, flag) in flags(args).into_iter().enumerate() {
        if flag {
            shape.scope.frame.origin += shape.scope.frame.axes.col(i) * shape.scope.size[i];
            shape.scope.size[i] = -shape.scope.size[i];
        }
    }
    shape.binding = shape.scope;
}

/// `mirror`: geometry is mirrored inside the scope; faces still point outwards.
pub fn geometry(args: &Args, shape: &mut Shape) {
    shape.bake();
    let scope = shape.scope;
    let flags = flags(args);
    let form = Arc::make_mut(&mut shape.form);
    for p in &mut form.mesh.positions {
        let mut q: DVec3 = scope.frame.local_from_world(*p);
        for i in 0..3 {
            if flags[i] {
                q[i] = scope.size[i] - q[i];
            }
        }
        *p = scope.frame.world_from_local(q);
    }
    for n in form.mesh.faces.iter_mut().flat_map(|f| &mut f.normals) {
        let mut q = scope.frame.local_direction(*n);
        for i in 0..3 {
            if flags[i] {
                q[i] = -q[i];
            }
        }
        *n = scope.frame.axes * q;
    }
    if flags.iter().filter(|f| **f).count() % 2 == 1 {
        form.mesh.faces.iter_mut().for_each(turn_loops);
    }
    form.instanced = false;
}
