//! In: a `scene` block. Out: a [`SceneSpec`].

use super::{Checker, all, get};
use crate::spec::ast::{Block, Clause, Expr, ExprKind, Property};
use crate::spec::filter::Filter;
use crate::spec::render_spec::{AreaSpec, FileRef, MissingTag, RuleAssignment, SceneSpec};
use crate::spec::units::Dimension;

/// Seeds are written as decimal numbers, which are exact up to here.
const GREATEST_SEED: u64 = 1 << 53;

impl Checker<'_> {
    pub fn scene(&mut self, block: &Block) -> Option<SceneSpec> {
        let properties = &block.properties;
        let seed = match get(properties, "seed") {
            Some(seed) => self.one(seed).and_then(|v| self.whole(v, Dimension::Plain, 0, GREATEST_SEED)),
            None => Some(0),
        };
        self.required(properties, "map", block.span, "a scene");
        let maps = self.files(properties, "map");
        let elevations = self.files(properties, "elevation");
        let area = match get(properties, "area") {
            Some(area) => self.area(area).map(Some),
            None => Some(None),
        };
        let rules: Vec<Option<RuleAssignment>> = all(properties, "rules").map(|rules| self.rules(rules)).collect();
        let mut missing = Some(Vec::new());
        for property in all(properties, "missing") {
            let found = self.missing(property);
            missing = missing.zip(found).map(|(mut all, found)| {
                all.extend(found);
                all
            });
        }
        Some(SceneSpec {
            name: self.block_name(block),
            span: block.span,
            seed: seed?,
            maps: maps.filter(|maps| !maps.is_empty())?,
            elevations: elevations?,
            area: area?,
            rules: rules.into_iter().collect::<Option<_>>()?,
            missing: missing?,
        })
    }

    fn files(&mut self, properties: &[Property], key: &'static str) -> Option<Vec<FileRef>> {
        let mut files = Vec::new();
        let mut complete = true;
        for property in all(properties, key) {
            if property.values.is_empty() {
                self.error("spec::wrong-value", property.span, format!("`{key}` names a file"));
                complete = false;
            }
            for value in &property.values {
                match self.file(value, false) {
                    Some(file) => files.push(file),
                    None => complete = false,
                }
            }
        }
        complete.then_some(files)
    }

    /// `missing building { height = uniform(4m, 8m) }`.
    fn missing(&mut self, property: &Property) -> Option<Vec<MissingTag>> {
        let filter = if property.values.is_empty() { Some(Filter::all()) } else { self.filter(&property.values) };
        let Some(body) = property.body.as_ref().filter(|body| !body.is_empty()) else {
            self.error("spec::missing-property", property.span, "`missing` says which tags: `{ height = 6m }`");
            return None;
        };
        let values: Vec<_> = body.iter().map(|assignment| self.value_spec(&assignment.value)).collect();
        let filter = filter?;
        let tags = body.iter().zip(values).map(|(assignment, value)| {
            let tag = assignment.name.text.clone();
            Some(MissingTag { filter: filter.clone(), tag, value: value?, span: assignment.name.span })
        });
        tags.collect()
    }

    fn area(&mut self, property: &Property) -> Option<AreaSpec> {
        let clause = |word: &str| property.clause(word);
        let wrong_form = !property.values.is_empty()
            || property
                .clauses
                .iter()
                .enumerate()
                .any(|(i, clause)| property.clauses[..i].iter().any(|before| before.word.text == clause.word.text));
        match (clause("center"), clause("size"), clause("bbox"), clause("polygon")) {
            _ if wrong_form => {}
            (Some(center), Some(size), None, None) => return self.around(center, size),
            (None, None, Some(bbox), None) => return self.bounding_box(bbox),
            (None, None, None, Some(polygon)) => return self.polygon(polygon),
            _ => {}
        }
        self.error_with_help(
            "spec::wrong-value",
            property.span,
            "this is not an area",
            "write `area center LAT, LON size 2km x 2km`, `area bbox WEST, SOUTH, EAST, NORTH` or \
             `area polygon (LAT, LON), (LAT, LON), (LAT, LON), …`",
        );
        None
    }

    fn around(&mut self, center: &Clause, size: &Clause) -> Option<AreaSpec> {
        let place = match center.values.as_slice() {
            [latitude, longitude] => self.place(latitude, longitude),
            values => {
                if !values.iter().any(super::values::is_unbound) {
                    self.error("spec::wrong-value", center.word.span, "`center` takes latitude and longitude");
                }
                None
            }
        };
        let size = self.one_of(&size.values, "size", size.word.span).and_then(|size| self.extent(size));
        let ((latitude, longitude), (width, height)) = place.zip(size)?;
        Some(AreaSpec::Around { latitude, longitude, width, height })
    }

    /// `2km x 1km`, or `2km` for a square.
    fn extent(&mut self, size: &Expr) -> Option<(f64, f64)> {
        let (width, height) = match &size.kind {
            ExprKind::By(width, height) => (&**width, &**height),
            _ => (size, size),
        };
        let (width, height) = (self.quantity(width, Dimension::Length), self.quantity(height, Dimension::Length));
        let (width, height) = width.zip(height)?;
        // The local frame of a scene is made for cities, see geodata.
        if !(width > 0.0 && height > 0.0 && width <= 100_000.0 && height <= 100_000.0) {
            let message = format!("an area is more than 0 and at most 100km wide and high, not {size}");
            self.error("spec::out-of-range", size.span, message);
            return None;
        }
        Some((width, height))
    }

    fn bounding_box(&mut self, bbox: &Clause) -> Option<AreaSpec> {
        let [west, south, east, north] = bbox.values.as_slice() else {
            if !bbox.values.iter().any(super::values::is_unbound) {
                self.error("spec::wrong-value", bbox.word.span, "`bbox` takes west, south, east, north in degrees");
            }
            return None;
        };
        let low = self.place(south, west);
        let high = self.place(north, east);
        let ((s, w), (n, e)) = low.zip(high)?;
        if w >= e || s >= n {
            let message = format!("the box from {w}, {s} to {e}, {n} is empty");
            self.error_with_help("spec::wrong-value", bbox.word.span, message, "`bbox` takes west, south, east, north");
            return None;
        }
        Some(AreaSpec::BoundingBox { west: w, south: s, east: e, north: n })
    }

    fn polygon(&mut self, polygon: &Clause) -> Option<AreaSpec> {
        let mut corners = Vec::new();
        for value in &polygon.values {
            match &value.kind {
                ExprKind::Group(place) if place.len() == 2 => corners.push(self.place(&place[0], &place[1])?),
                _ => {
                    self.wrong(value, "a corner `(latitude, longitude)`");
                    return None;
                }
            }
        }
        if corners.len() < 3 {
            self.error("spec::wrong-value", polygon.word.span, "a polygon has at least three corners");
            return None;
        }
        Some(AreaSpec::Polygon(corners))
    }

    /// Latitude and longitude in degrees; the unit may be left out.
    pub fn place(&mut self, latitude: &Expr, longitude: &Expr) -> Option<(f64, f64)> {
        let lat = self.degrees(latitude);
        let lon = self.degrees(longitude);
        let (lat, lon) = lat.zip(lon)?;
        if lat.abs() >= 90.0 || lon.abs() > 180.0 {
            let (value, name, limit) =
                if lat.abs() >= 90.0 { (latitude, "latitude", 90) } else { (longitude, "longitude", 180) };
            let message = format!("the {name} `{value}` is not between -{limit} and {limit}");
            let help = "are latitude and longitude exchanged?";
            self.error_with_help("spec::out-of-range", value.span, message, help);
            return None;
        }
        Some((lat, lon))
    }

    fn degrees(&mut self, value: &Expr) -> Option<f64> {
        match value.kind {
            ExprKind::Quantity { unit: None, .. } => self.quantity(value, Dimension::Plain),
            _ => self.quantity(value, Dimension::Angle),
        }
    }
}
