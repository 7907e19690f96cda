//! `--footprint`. In: "x,z x,z x,z; x,z ..." in metres. Out: a mesh of one face in the plane y = 0, corners in the order given.

use glam::DVec3;
use mansard::geometry::{Face, Mesh};

/// Parses rings separated by `;`: the first is the outline, the others are holes.
pub fn parse(text: &str) -> Result<Mesh, String> {
    let mut positions = Vec::new();
    let mut loops = Vec::new();
    for (number, ring) in text.split(';').enumerate() {
        let first = positions.len() as u32;
        for corner in ring.split_whitespace() {
            positions.push(point(corner).ok_or_else(|| format!("`{corner}` is not a corner: write x,z in metres"))?);
        }
        let count = positions.len() as u32 - first;
        if count < 3 {
            let which = if number == 0 { "the outline".to_owned() } else { format!("hole {number}") };
            return Err(format!("{which} has {count} corners, at least 3 are needed"));
        }
        loops.push((first..first + count).collect::<Vec<u32>>());
    }
    let holes = loops.split_off(1);
    let outer = loops.remove(0);
    Ok(Mesh { positions, faces: vec![Face::with_holes(outer, holes)] })
}

fn point(corner: &str) -> Option<DVec3> {
    let (x, z) = corner.split_once(',')?;
    let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    Some(DVec3::new(number(x)?, 0.0, number(z)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_and_mistakes() {
        let mesh = parse("0,0 10,0 10,-8 0,-8; 2,-2 2,-4 4,-4").expect("two rings");
        assert_eq!(mesh.positions.len(), 7);
        assert_eq!(mesh.faces[0].holes[0][..], [4, 5, 6]);
        assert_eq!(mesh.positions[2], DVec3::new(10.0, 0.0, -8.0));
        assert_eq!(parse("0,0 1,1").unwrap_err(), "the outline has 2 corners, at least 3 are needed");
        assert!(parse("0,0 1,x 2,2").unwrap_err().contains("`1,x`"));
        assert!(parse("0,0 1,inf 2,2").is_err());
        assert!(parse("").is_err());
    }
}
