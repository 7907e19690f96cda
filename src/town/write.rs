//! The town as OSM XML. In: the plan. Out: a file of nodes, then ways, then relations, as planet files have them.
//!
//! Ways and relations are gathered in a second temporary file while nodes are written, so memory does not grow
//! with the town.

use std::fs::File;
use std::io::{BufWriter, Seek, Write};
use std::path::Path;

use glam::DVec2;

use super::TownError;
use super::layout::{BLOCK, RIVER_HALF, Street, Town, Use};
use super::lots::{self, Thing};
use crate::output;

/// Centre of the town, degrees.
pub const CENTRE_LON: f64 = -30.0;
pub const CENTRE_LAT: f64 = 45.0;
/// Metres per degree at the centre (WGS 84 radii of curvature at 45°).
pub const METRES_PER_DEGREE: DVec2 = DVec2::new(78_846.805_72, 111_131.777_41);

/// Ground metres to longitude and latitude.
pub fn lon_lat(p: DVec2) -> DVec2 {
    DVec2::new(CENTRE_LON, CENTRE_LAT) + p / METRES_PER_DEGREE
}

struct Writer<'a> {
    town: &'a Town,
    nodes: BufWriter<tempfile::NamedTempFile>,
    /// Ways and relations wait here until all nodes are out.
    ways: BufWriter<File>,
    relations: Vec<u8>,
    next_node: u64,
    next_way: u64,
    next_relation: u64,
}

/// Writes the town; the file appears under its name only when it is complete.
pub fn osm(town: &Town, path: &Path, heard: &dyn Fn(u64)) -> Result<(), TownError> {
    Ok(write(town, path, heard).map_err(|source| output::OutputError::new(path, source))?)
}

fn write(town: &Town, path: &Path, heard: &dyn Fn(u64)) -> std::io::Result<()> {
    let mut writer = Writer {
        town,
        nodes: BufWriter::new(output::aside(path)?),
        ways: BufWriter::new(output::scratch(path)?),
        relations: Vec::new(),
        next_node: 1,
        next_way: 1,
        next_relation: 1,
    };
    let reach = town.half_size() + BLOCK * 0.5;
    let (lo, hi) = (lon_lat(-reach), lon_lat(reach));
    writeln!(writer.nodes, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
    writeln!(writer.nodes, "<osm version=\"0.6\" generator=\"mansard town\">")?;
    let bounds = [lo.y, lo.x, hi.y, hi.x].map(|v| format!("{v:.7}"));
    let [s, w, n, e] = bounds;
    writeln!(writer.nodes, " <bounds minlat=\"{s}\" minlon=\"{w}\" maxlat=\"{n}\" maxlon=\"{e}\"/>")?;
    writer.streets()?;
    writer.river()?;
    writer.blocks(heard)?;
    writer.finish(path)
}

impl Writer<'_> {
    fn blocks(&mut self, heard: &dyn Fn(u64)) -> std::io::Result<()> {
        let mut left = self.town.buildings;
        for (column, row) in self.town.blocks() {
            let planned = self.town.block_use(column, row);
            let used = if left == 0 && planned != Use::River { Use::Field } else { planned };
            for thing in lots::block(self.town, column, row, used) {
                if thing.is_building() {
                    if left == 0 {
                        continue;
                    }
                    left -= 1;
                    heard(1);
                }
                self.thing(&thing)?;
            }
        }
        // A grid too small for the number asked goes on beyond its northern edge.
        let mut row = self.town.rows;
        while left > 0 {
            for column in 0..self.town.columns {
                for thing in lots::block(self.town, column, row, Use::Houses) {
                    if thing.is_building() && left > 0 {
                        left -= 1;
                        heard(1);
                        self.thing(&thing)?;
                    }
                }
            }
            row += 1;
        }
        Ok(())
    }

    /// Streets between the blocks; those running north cross the river only where they are more than residential.
    fn streets(&mut self) -> std::io::Result<()> {
        let town = self.town;
        let mut crossing = vec![0u64; ((town.columns + 1) * (town.rows + 1)) as usize];
        for row in 0..=town.rows {
            for column in 0..=town.columns {
                let p = town.warp(town.corner(column, row));
                crossing[(row * (town.columns + 1) + column) as usize] = self.node(p)?;
            }
        }
        let at = |c: u32, r: u32| crossing[(r * (town.columns + 1) + c) as usize];
        for row in 0..=town.rows {
            let mut refs = vec![at(0, row)];
            for column in 0..town.columns {
                self.bend(&mut refs, town.corner(column, row), DVec2::X * BLOCK.x)?;
                refs.push(at(column + 1, row));
                if refs.len() > 60 || column + 1 == town.columns {
                    self.street(&refs, town.row_street(row), false)?;
                    refs = vec![at(column + 1, row)];
                }
            }
        }
        for column in 0..=town.columns {
            let class = town.column_street(column);
            for row in 0..town.rows {
                let bridge = row == town.river_row;
                if bridge && class == Street::Residential {
                    continue;
                }
                let mut refs = vec![at(column, row)];
                self.bend(&mut refs, town.corner(column, row), DVec2::Y * BLOCK.y)?;
                refs.push(at(column, row + 1));
                self.street(&refs, class, bridge)?;
            }
        }
        Ok(())
    }

    /// Points between two crossings, where the street bends.
    fn bend(&mut self, refs: &mut Vec<u64>, from: DVec2, along: DVec2) -> std::io::Result<()> {
        for i in 1..4 {
            let p = self.town.warp(from + along * (f64::from(i) / 4.0));
            refs.push(self.node(p)?);
        }
        Ok(())
    }

    fn street(&mut self, refs: &[u64], class: Street, bridge: bool) -> std::io::Result<()> {
        let mut tags = vec![("highway", class.tag().to_owned())];
        if bridge {
            tags.extend([("bridge", "yes".to_owned()), ("layer", "1".to_owned())]);
        }
        self.way(refs, &tags).map(|_| ())
    }

    fn river(&mut self) -> std::io::Result<()> {
        let town = self.town;
        let reach = town.half_size().x + BLOCK.x * 0.5;
        // One polygon per stretch of some 40 blocks keeps ways under OSM's 2,000 nodes.
        let steps = ((2.0 * reach) / 12.0).ceil() as usize;
        let x = |i: usize| -reach + 2.0 * reach * i as f64 / steps as f64;
        for first in (0..steps).step_by(500) {
            let last = (first + 500).min(steps);
            let bank = |i: usize, side: f64| town.warp(DVec2::new(x(i), town.river(x(i)) + side * RIVER_HALF));
            let south = (first..=last).map(|i| bank(i, -1.0));
            let north = (first..=last).rev().map(|i| bank(i, 1.0));
            let ring: Vec<DVec2> = south.chain(north).collect();
            let tags = vec![("natural", "water".to_owned()), ("water", "river".to_owned())];
            self.thing(&Thing { ring, hole: None, open: false, tags })?;
        }
        Ok(())
    }

    fn thing(&mut self, thing: &Thing) -> std::io::Result<()> {
        let outer = self.ring(&thing.ring, !thing.open)?;
        let Some(hole) = &thing.hole else {
            self.way(&outer, &thing.tags)?;
            return Ok(());
        };
        let inner = self.ring(hole, true)?;
        let (outer, inner) = (self.way(&outer, &[])?, self.way(&inner, &[])?);
        writeln!(self.relations, " <relation id=\"{}\">", self.next_relation)?;
        writeln!(self.relations, "  <member type=\"way\" ref=\"{outer}\" role=\"outer\"/>")?;
        writeln!(self.relations, "  <member type=\"way\" ref=\"{inner}\" role=\"inner\"/>")?;
        writeln!(self.relations, "  <tag k=\"type\" v=\"multipolygon\"/>")?;
        for (k, v) in &thing.tags {
            writeln!(self.relations, "  <tag k=\"{k}\" v=\"{v}\"/>")?;
        }
        writeln!(self.relations, " </relation>")?;
        self.next_relation += 1;
        Ok(())
    }

    fn ring(&mut self, ring: &[DVec2], closed: bool) -> std::io::Result<Vec<u64>> {
        let mut refs = Vec::with_capacity(ring.len() + 1);
        for &p in ring {
            refs.push(self.node(p)?);
        }
        if closed {
            refs.push(refs[0]);
        }
        Ok(refs)
    }

    fn node(&mut self, p: DVec2) -> std::io::Result<u64> {
        let (id, at) = (self.next_node, lon_lat(p));
        writeln!(self.nodes, " <node id=\"{id}\" lat=\"{:.7}\" lon=\"{:.7}\"/>", at.y, at.x)?;
        self.next_node += 1;
        Ok(id)
    }

    fn way(&mut self, refs: &[u64], tags: &[(&'static str, String)]) -> std::io::Result<u64> {
        let id = self.next_way;
        writeln!(self.ways, " <way id=\"{id}\">")?;
        for r in refs {
            writeln!(self.ways, "  <nd ref=\"{r}\"/>")?;
        }
        for (k, v) in tags {
            writeln!(self.ways, "  <tag k=\"{k}\" v=\"{v}\"/>")?;
        }
        writeln!(self.ways, " </way>")?;
        self.next_way += 1;
        Ok(id)
    }

    fn finish(mut self, path: &Path) -> std::io::Result<()> {
        let mut ways = self.ways.into_inner().map_err(std::io::IntoInnerError::into_error)?;
        ways.rewind()?;
        std::io::copy(&mut ways, &mut self.nodes)?;
        self.nodes.write_all(&self.relations)?;
        writeln!(self.nodes, "</osm>")?;
        output::keep(self.nodes, path)
    }
}
