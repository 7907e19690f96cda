//! Ray: a half line with what its tests need. In: origin and direction. Out: where it meets boxes and triangles.
//!
//! Triangles are met watertight (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"): triangles that
//! share an edge evaluate it to exactly opposite numbers, and rounding can only make a sign zero, never wrong, so with
//! zero counted as inside no ray slips between neighbours. Boxes are widened by the rounding of the triangle test.

/// Corners, metres from the tracer's origin.
pub type Triangle = [[f64; 3]; 3];

/// Least corners of four boxes, by axis, and their greatest ones.
pub type Boxes = [[[f32; 4]; 3]; 2];

/// Direction need not be of unit length; distances are in units of it.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: [f64; 3],
    pub direction: [f64; 3],
    inverse: [f64; 3],
    /// Origin shifted so that the near and far planes of boxes move apart by the slack.
    from_near: [f64; 3],
    from_far: [f64; 3],
    /// Axes of the sheared frame in which the ray runs along z, and the shear.
    axes: [usize; 3],
    shear: [f64; 3],
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    pub t: f64,
    /// Shares of the three corners; their sum is 1.
    pub weights: [f64; 3],
}

impl Ray {
    /// `extent`: the greatest distance along an axis between the origin and anything the ray may meet.
    pub fn new(origin: [f64; 3], direction: [f64; 3], extent: f64) -> Ray {
        let size = direction.map(f64::abs);
        let z = if size[0] > size[1] && size[0] > size[2] {
            0
        } else if size[1] > size[2] {
            1
        } else {
            2
        };
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if direction[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        let shear = [direction[x] / direction[z], direction[y] / direction[z], 1.0 / direction[z]];
        let inverse = direction.map(|d| 1.0 / d);
        // Sheared coordinates are at most twice the extent, with two roundings each.
        let slack = 16.0 * f64::EPSILON * extent;
        let shifted = |sign: f64| std::array::from_fn(|k| origin[k] + sign * slack.copysign(inverse[k]));
        Ray { origin, direction, inverse, from_near: shifted(1.0), from_far: shifted(-1.0), axes: [x, y, z], shear }
    }

    /// Distances at which the ray enters boxes, infinite for those that it is not inside of somewhere between `near` and
    /// `far`. Planes that the ray runs in count as inside: NaN is no bound (Ize 2013, "Robust BVH Ray Traversal").
    #[inline]
    pub fn enters(&self, boxes: &Boxes, near: f64, far: f64) -> [f64; 4] {
        let (mut enter, mut leave) = ([near; 4], [far; 4]);
        for (k, inverse) in self.inverse.into_iter().enumerate() {
            let first = usize::from(inverse.is_sign_negative());
            let (entries, exits) = (&boxes[first][k], &boxes[1 - first][k]);
            for i in 0..4 {
                // Comparisons that NaN fails.
                let entry = (f64::from(entries[i]) - self.from_near[k]) * inverse;
                enter[i] = if entry > enter[i] { entry } else { enter[i] };
                let exit = (f64::from(exits[i]) - self.from_far[k]) * inverse;
                leave[i] = if exit < leave[i] { exit } else { leave[i] };
            }
        }
        std::array::from_fn(
            |i| if enter[i] <= leave[i] * (1.0 + 4.0 * f64::EPSILON) { enter[i] } else { f64::INFINITY },
        )
    }

    /// Where the ray's line meets a triangle, from either side; borders count. Triangles seen edge-on are missed.
    #[inline]
    pub fn crosses(&self, triangle: &Triangle) -> Option<Crossing> {
        let [x, y, z] = self.axes;
        let sheared = triangle.map(|corner| {
            let depth = corner[z] - self.origin[z];
            let across = corner[x] - self.origin[x] - self.shear[0] * depth;
            let along = corner[y] - self.origin[y] - self.shear[1] * depth;
            [across, along, self.shear[2] * depth]
        });
        let [a, b, c] = sheared;
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let sum = u + v + w;
        if sum == 0.0 {
            return None;
        }
        let weights = [u / sum, v / sum, w / sum];
        Some(Crossing { t: (u * a[2] + v * b[2] + w * c[2]) / sum, weights })
    }
}
