//! In: the centre line of a road or bridge. Out: heights along it.

use glam::DVec2;

use crate::geodata::terrain::Terrain;

/// The line with a point wherever the terrain can bend, and the terrain's height at each point, metres. `None` if the
/// terrain has no height at one of them.
pub fn along_ground(line: &[DVec2], terrain: &Terrain) -> Option<Vec<(DVec2, f64)>> {
    let mut points = Vec::with_capacity(line.len());
    for (i, &a) in line.iter().enumerate() {
        points.push(a);
        if let Some(&b) = line.get(i + 1) {
            points.extend(terrain.bends(a, b).into_iter().map(|t| a.lerp(b, t)));
        }
    }
    points.into_iter().map(|p| Some((p, terrain.height(p)?))).collect()
}

/// Heights of a bridge's deck, one per point of the line: straight from the ground at one end to the ground at the
/// other, but never below the ground in between. `None` if an end has no ground.
pub fn bridge_deck(line: &[DVec2], terrain: &Terrain) -> Option<Vec<f64>> {
    let (from, to) = (terrain.height(*line.first()?)?, terrain.height(*line.last()?)?);
    let mut along = vec![0.0];
    for w in line.windows(2) {
        along.push(along[along.len() - 1] + w[0].distance(w[1]));
    }
    let length = along[along.len() - 1];
    let share = |s: f64| if length > 0.0 { s / length } else { 0.0 };
    let deck = |(s, p): (&f64, &DVec2)| {
        let straight = from + (to - from) * share(*s);
        terrain.height(*p).map_or(straight, |ground| straight.max(ground))
    };
    Some(along.iter().zip(line).map(deck).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_ground_gives_level_decks() {
        let line = [DVec2::ZERO, DVec2::new(30.0, 0.0), DVec2::new(30.0, 10.0)];
        assert_eq!(bridge_deck(&line, &Terrain::flat()), Some(vec![0.0; 3]));
        assert_eq!(along_ground(&line, &Terrain::flat()).map(|p| p.len()), Some(3));
        assert_eq!(bridge_deck(&[], &Terrain::flat()), None);
        assert_eq!(bridge_deck(&line[..1], &Terrain::flat()), Some(vec![0.0]));
    }
}
