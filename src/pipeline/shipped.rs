//! Rule files that come with the program: `"mansard:residential.cga"` in a recipe.

/// Name and text, sorted by name.
const FILES: &[(&str, &str)] = &[
    ("building.cga", include_str!("../../rules/building.cga")),
    ("damage.cga", include_str!("../../rules/damage.cga")),
    ("industrial.cga", include_str!("../../rules/industrial.cga")),
    ("landcover.cga", include_str!("../../rules/landcover.cga")),
    ("residential.cga", include_str!("../../rules/residential.cga")),
    ("street.cga", include_str!("../../rules/street.cga")),
];

/// The text of a shipped rule file.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|(n, _)| *n == name).map(|(_, text)| *text)
}

/// All names, for messages.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}
