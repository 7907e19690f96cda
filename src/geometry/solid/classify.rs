//! Which pieces of the facets are kept. In: the settled arrangement. Out: per facet the cells that belong to the
//! result.

use std::collections::BTreeMap;

use glam::DVec3;

use super::arrange::Arrangement;
use super::cells::{self, Cell};
use super::facets::{Edge, Facet, Facets, edge};
use super::meet::Meetings;
use super::{OpenMeshes, Operator, SolidError};
use crate::geometry::body::Body;

/// Kept cells of one facet that lie alike.
pub struct Piece {
    pub facet: usize,
    pub triangles: Vec<[u32; 3]>,
    /// The facet was not cut.
    pub is_whole: bool,
    pub is_shared: bool,
    pub is_flipped: bool,
}

/// Where a cell lies against the other operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Lie {
    Outside,
    Inside,
    /// On a facet that looks the same way.
    Along,
    /// On a facet that looks the other way.
    Against,
}

pub fn kept(
    facets: &Facets,
    meetings: &Meetings,
    arrangement: &Arrangement,
    operator: Operator,
    open: OpenMeshes,
) -> Result<Vec<Piece>, SolidError> {
    let judge = Judge::new(facets, meetings, arrangement, open);
    let mut of_component: BTreeMap<u32, Lie> = BTreeMap::new();
    let mut pieces = Vec::new();
    for (number, facet) in facets.list.iter().enumerate() {
        let is_whole = !arrangement.roots.contains_key(&number);
        let cells = match is_whole {
            true => Vec::from_iter(cells::whole(facets, facet)),
            false => cells::of(facets, facet, &arrangement.edges(number), &arrangement.border(facet))?,
        };
        let mut groups: BTreeMap<(bool, bool), Vec<[u32; 3]>> = BTreeMap::new();
        for cell in cells {
            let lie = match of_component.get(&facet.component) {
                Some(&lie) => lie,
                None => judge.lie(number, &cell),
            };
            if !judge.is_met(facet.component) {
                of_component.insert(facet.component, lie);
            }
            if let Some(is_flipped) = judge.keeps(operator, facet, lie) {
                // What is left of a body does not show what touched it.
                let is_shared = lie == Lie::Along || (judge.is_flat && lie == Lie::Against);
                groups.entry((is_shared, is_flipped)).or_default().extend(cell.triangles);
            }
        }
        for ((is_shared, is_flipped), triangles) in groups {
            pieces.push(Piece { facet: number, triangles, is_whole, is_shared, is_flipped });
        }
    }
    Ok(pieces)
}

struct Judge<'a> {
    facets: &'a Facets,
    meetings: &'a Meetings,
    /// Both operands lie in one plane.
    is_flat: bool,
    /// The closed components of each operand.
    closed: [Body; 2],
    /// Open components that count as half spaces.
    half_spaces: BTreeMap<u32, (u8, Body)>,
}

impl<'a> Judge<'a> {
    fn new(facets: &'a Facets, meetings: &'a Meetings, arrangement: &Arrangement, open: OpenMeshes) -> Judge<'a> {
        let closed = [0, 1].map(|operand| {
            let is_closed = |f: &usize| facets.components[facets.list[*f].component as usize].is_closed;
            body(facets, facets.of(operand).filter(is_closed))
        });
        let is_flat = facets.list.first().is_some_and(|plane| {
            let on = |v: &u32| plane.height(facets.position(*v)).abs() <= facets.pool.tolerance;
            facets.list.iter().all(|f| f.loops.iter().flatten().all(on))
        });
        let mut judge = Judge { facets, meetings, is_flat, closed, half_spaces: BTreeMap::new() };
        if open == OpenMeshes::HalfSpaces && !is_flat {
            judge.find_half_spaces(arrangement);
        }
        judge
    }

    fn find_half_spaces(&mut self, arrangement: &Arrangement) {
        let facets = self.facets;
        let mut balance: BTreeMap<(u32, Edge), i32> = BTreeMap::new();
        for facet in facets.list.iter().filter(|f| !facets.components[f.component as usize].is_closed) {
            for (a, b) in facet.edges() {
                *balance.entry((facet.component, edge(a, b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
        let mut borders: BTreeMap<u32, Vec<Edge>> = BTreeMap::new();
        for ((component, border), _) in balance.into_iter().filter(|(_, n)| *n != 0) {
            borders.entry(component).or_default().push(border);
        }
        let operand_of = |component: u32| facets.list.iter().find(|f| f.component == component).map(|f| f.operand);
        for (component, border) in borders {
            let Some(operand) = operand_of(component).filter(|_| self.is_met(component)) else { continue };
            let other = usize::from(1 - operand);
            let open =
                facets.of(1 - operand).filter(|&f| !facets.components[facets.list[f].component as usize].is_closed);
            let open = body(facets, open);
            if !border.iter().any(|e| self.crosses(*e, arrangement, &self.closed[other], &open)) {
                let own = facets.of(operand).filter(|&f| facets.list[f].component == component);
                self.half_spaces.insert(component, (operand, body(facets, own)));
            }
        }
    }

    /// Whether an open edge runs through the inside of a body or through an open surface.
    fn crosses(&self, border: Edge, arrangement: &Arrangement, closed: &Body, open: &Body) -> bool {
        let near = 10.0 * self.facets.pool.tolerance;
        let mut chain = arrangement.along(border[0], border[1]);
        chain.push(border[1]);
        let at = |v: u32| self.facets.position(v);
        let pierces = |&v: &u32| open.distance(at(v)) <= near;
        let runs_inside = |w: &[u32]| {
            let middle = (at(w[0]) + at(w[1])) / 2.0;
            closed.winding(middle) != 0 && closed.distance(middle) > near
        };
        chain[1..chain.len() - 1].iter().any(pierces) || chain.windows(2).any(runs_inside)
    }

    /// Whether a cell is part of the result, and if so whether it is turned over. A surface that
    /// encloses nothing takes nothing away.
    fn keeps(&self, operator: Operator, facet: &Facet, lie: Lie) -> Option<bool> {
        use Lie as L;
        let lie = if self.is_flat && lie == L::Against { L::Along } else { lie };
        match (operator, facet.operand, lie) {
            (Operator::Union, _, L::Outside) | (Operator::Union, 0, L::Along) => Some(false),
            (Operator::Intersect, _, L::Inside) | (Operator::Intersect, 0, L::Along) => Some(false),
            (Operator::Subtract, 0, L::Outside | L::Against) => Some(false),
            (Operator::Subtract, 1, L::Inside) if self.is_solid(facet.component) => Some(true),
            _ => None,
        }
    }

    fn is_met(&self, component: u32) -> bool {
        self.meetings.components.iter().any(|&(a, b)| a == component || b == component)
    }

    fn lie(&self, number: usize, cell: &Cell) -> Lie {
        let facet = &self.facets.list[number];
        let inner = (facet.flat)(cell.inner);
        for &other in self.meetings.coplanar.get(&number).into_iter().flatten() {
            let other = &self.facets.list[other];
            // Both are seen along the same axis.
            if other.contains_along(facet.flat, &self.facets.pool.positions, inner) {
                let along = facet.normal.dot(other.normal) > 0.0;
                let sheets = !self.is_solid(facet.component) && !self.is_solid(other.component);
                return if along || sheets { Lie::Along } else { Lie::Against };
            }
        }
        if self.is_inside(1 - facet.operand, facet.component, cell.inner) { Lie::Inside } else { Lie::Outside }
    }

    fn is_solid(&self, component: u32) -> bool {
        self.facets.components[component as usize].is_closed || self.half_spaces.contains_key(&component)
    }

    /// Whether a point of a component lies inside an operand.
    fn is_inside(&self, operand: u8, component: u32, p: DVec3) -> bool {
        let meets = |&other: &u32| {
            let pair = (component.min(other), component.max(other));
            self.meetings.components.contains(&pair)
        };
        let mut half_spaces = self.half_spaces.iter().filter(|(other, (own, _))| *own == operand && meets(other));
        self.closed[usize::from(operand)].winding(p) != 0 || half_spaces.any(|(_, (_, body))| body.is_behind(p))
    }
}

fn body(facets: &Facets, numbers: impl Iterator<Item = usize>) -> Body {
    let cells = numbers.filter_map(|f| cells::whole(facets, &facets.list[f]));
    let corners = |t: [u32; 3]| t.map(|v| facets.position(v));
    Body::new(cells.flat_map(|c| c.triangles).map(corners).collect())
}
