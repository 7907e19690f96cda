//! The table of the language: which blocks there are, which keys each has, and what may stand in a property.
//!
//! The parser cuts bodies into properties with it, the checker refuses with it what is not evaluated yet, and a test
//! holds `docs/render.md` to it.

/// One kind of block.
#[derive(Debug)]
pub struct BlockShape {
    pub kind: &'static str,
    pub keys: &'static [Key],
}

/// One property of a block.
#[derive(Debug)]
pub struct Key {
    pub key: &'static str,
    /// Words that may follow the values, each with values of its own.
    pub clauses: &'static [&'static str],
    /// Whether `{ name = value }` may follow.
    pub body: bool,
    /// Whether the property may be given several times.
    pub repeats: bool,
    /// Whether the checker evaluates it; otherwise giving it is a `spec::not-supported-yet` error.
    pub evaluated: bool,
}

const fn key(key: &'static str) -> Key {
    Key { key, clauses: &[], body: false, repeats: false, evaluated: true }
}

impl Key {
    const fn clauses(self, clauses: &'static [&'static str]) -> Key {
        Key { clauses, ..self }
    }

    const fn body(self) -> Key {
        Key { body: true, ..self }
    }

    const fn repeats(self) -> Key {
        Key { repeats: true, ..self }
    }

    const fn later(self) -> Key {
        Key { evaluated: false, ..self }
    }
}

const ATMOSPHERE: Key = key("atmosphere").clauses(&["visibility", "scale_height"]);
const CLOUDS: Key = key("clouds").clauses(&["height", "size", "depth"]);
const GROUND: Key = key("ground").clauses(&["share", "within"]);
const SENSOR: Key = key("sensor").clauses(&["psf", "exposure", "noise", "full_well", "depth", "bands"]);

/// All blocks of the language.
pub const BLOCKS: &[BlockShape] = &[
    BlockShape {
        kind: "scene",
        keys: &[
            key("seed"),
            key("map").repeats(),
            key("elevation").repeats(),
            key("imagery").repeats().later(),
            key("area").clauses(&["center", "size", "bbox", "polygon"]),
            key("rules").clauses(&["for", "start"]).body().repeats(),
            key("missing").body().repeats(),
        ],
    },
    BlockShape {
        kind: "change",
        keys: &[
            key("of"),
            key("within").clauses(&["center", "size", "bbox", "polygon"]).later(),
            key("share"),
            key("count"),
            key("rules").clauses(&["for", "start"]).body().repeats(),
            key("effect"),
            key("level").clauses(&["share", "rules", "start", "effect"]).body().repeats(),
            key("non_target"),
        ],
    },
    BlockShape {
        kind: "camera",
        keys: &[
            key("projection"),
            key("size"),
            key("gsd"),
            key("fov"),
            key("altitude"),
            key("off_nadir"),
            key("azimuth"),
            key("heading"),
            key("position").later(),
            key("target").clauses(&["jitter"]).later(),
            key("clip").clauses(&["near", "far"]).later(),
        ],
    },
    BlockShape {
        kind: "sun",
        keys: &[
            key("elevation"),
            key("azimuth"),
            key("declination"),
            key("tilt"),
            key("turn"),
            key("date").later(),
            key("time").later(),
            key("place").later(),
            key("disc"),
            key("intensity"),
            key("colour"),
        ],
    },
    BlockShape {
        kind: "effects",
        keys: &[key("shadows"), key("ambient"), ATMOSPHERE, CLOUDS, GROUND, key("vegetation"), SENSOR],
    },
    BlockShape {
        kind: "pass",
        keys: &[
            key("show").clauses(&["only", "with", "mark", "as"]),
            key("acquisition").clauses(&["redraw"]),
            key("shadows"),
            key("ambient"),
            ATMOSPHERE,
            CLOUDS,
            GROUND,
            key("vegetation"),
            SENSOR,
        ],
    },
    BlockShape {
        kind: "quality",
        keys: &[
            key("preset"),
            key("antialiasing"),
            key("shadow_map"),
            key("shadow_samples"),
            key("sky_samples"),
            key("field_map"),
            key("detail"),
            key("curves"),
            key("error"),
            key("edge"),
            key("height"),
            key("shadow"),
        ],
    },
    BlockShape {
        kind: "dataset",
        keys: &[
            key("views"),
            key("scenes"),
            key("passes"),
            key("sun"),
            key("effects"),
            key("quality"),
            key("layout"),
            key("split").clauses(&["train", "val", "test"]),
            key("tiles").clauses(&["overlap"]).later(),
            key("format"),
            key("correction"),
        ],
    },
];

/// Words that cannot name a change.
pub const RESERVED: &[&str] = &["all", "both", "before", "changed", "unchanged", "terrain", "vegetation"];

impl BlockShape {
    pub fn find(kind: &str) -> Option<&'static BlockShape> {
        BLOCKS.iter().find(|shape| shape.kind == kind)
    }

    pub fn key(&self, key: &str) -> Option<&'static Key> {
        self.keys.iter().find(|candidate| candidate.key == key)
    }
}

#[cfg(test)]
mod tests {
    use super::BLOCKS;

    /// The page's row or list of a key names it in backquotes inside its block's section.
    #[test]
    fn the_documentation_names_every_key_and_says_which_come_later() {
        let page = include_str!("../../docs/render.md");
        for block in BLOCKS {
            let start = page.find(&format!("\n### {}\n", block.kind)).expect("every block has a section");
            let section = &page[start + 5..];
            let section = &section[..section.find("\n##").unwrap_or(section.len())];
            for key in block.keys {
                let row =
                    section.lines().find(|line| line.starts_with('|') && line.contains(&format!("`{}`", key.key)));
                let row = row.unwrap_or_else(|| panic!("{} {} is not in the table", block.kind, key.key));
                assert!(
                    key.evaluated || block.kind == "pass" || row.contains("**later**"),
                    "{} {}",
                    block.kind,
                    key.key
                );
                for clause in key.clauses.iter().filter(|_| key.evaluated) {
                    assert!(row.contains(clause), "{} {} {clause}", block.kind, key.key);
                }
            }
        }
    }

    #[test]
    fn every_error_code_is_documented() {
        let page = include_str!("../../docs/render.md");
        for source in [
            include_str!("mod.rs"),
            include_str!("parse.rs"),
            include_str!("properties.rs"),
            include_str!("expression.rs"),
            include_str!("inputs.rs"),
            include_str!("inherit.rs"),
            include_str!("read.rs"),
            include_str!("check/mod.rs"),
            include_str!("check/values.rs"),
            include_str!("check/filters.rs"),
            include_str!("check/scene.rs"),
            include_str!("check/change.rs"),
            include_str!("check/camera.rs"),
            include_str!("check/effects.rs"),
            include_str!("check/light.rs"),
            include_str!("check/quality.rs"),
            include_str!("check/pass.rs"),
            include_str!("check/dataset.rs"),
        ] {
            for code in source.split("\"spec::").skip(1).filter_map(|rest| rest.split('"').next()) {
                let named = page.contains(&format!("`{code}`")) || page.contains(&format!("`spec::{code}`"));
                assert!(named, "spec::{code} is not in docs/render.md");
            }
        }
    }

    #[test]
    fn a_clause_is_never_a_key_of_its_block_except_inside_levels() {
        for block in BLOCKS {
            for key in block.keys.iter().filter(|key| key.key != "level") {
                for clause in key.clauses {
                    assert!(block.key(clause).is_none(), "{} {} {clause}", block.kind, key.key);
                }
            }
        }
    }
}
