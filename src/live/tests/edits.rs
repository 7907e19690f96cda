//! Random edits: after each one the session shows what a cold build of the same files makes, byte for byte.

use proptest::prelude::*;

use super::workshop::{BLOCK, HOUSE, LIB, RECIPE, RUIN, STREET, Told, Workshop, updated};

/// One save.
#[derive(Clone, Debug)]
enum Edit {
    /// A number of a file is another one: (file, pieces of text, which).
    Number(usize, u8),
    /// A comment or white space in front of a file.
    Comment(usize),
    /// An unused rule or attribute at the front or the end.
    Insert(usize, bool, bool),
    /// A rule has another name wherever it is used.
    Rename(bool),
    /// A rule is gone: who calls it makes leaves.
    Remove,
    /// A file is moved away, or back.
    Away(usize),
    /// A text that does not parse, or parses again.
    Break(usize),
    /// A line of the recipe.
    Recipe(usize, u8),
}

/// The files as they should be.
#[derive(Clone, Debug, Default)]
struct Model {
    numbers: [u8; 8],
    comments: [u8; 6],
    inserted: [Vec<(bool, bool)>; 6],
    renamed: bool,
    removed: bool,
    away: [bool; 6],
    broken: [bool; 6],
    recipe: [u8; 6],
}

const FILES: [&str; 6] = ["town.render", "house.cga", "lib.cga", "block.cga", "street.cga", "ruin.cga"];

/// File, text, and the same with another number.
const NUMBERS: [(usize, &str, &str); 8] = [
    (1, "attr height = 6", "attr height = N"),
    (1, "attr storey = 3", "attr storey = N"),
    (1, "60%", "5N%"),
    (1, "2 * x", "x + N"),
    (1, "roofHip(30)", "roofHip(2N)"),
    (2, "attr tile = 0.4", "attr tile = N"),
    (3, "color(0.6, 0.6, 0.6)", "color(0.N, 0.6, 0.6)"),
    (5, "attr left = 1", "attr left = N"),
];

/// Text of the recipe, and the same with another number.
const LINES: [(&str, &str); 6] = [
    ("seed      3", "seed      N"),
    ("elevation 50deg", "elevation 3Ndeg"),
    ("storey = 2.8m", "storey = N.8m"),
    ("share 40%", "share 3N%"),
    ("{ preset draft }", "{ preset draft  detail 0.Nm }"),
    ("normal(6m, 1m)", "normal(Nm, 1m)"),
];

impl Model {
    fn apply(&mut self, edit: &Edit) {
        match *edit {
            Edit::Number(which, value) => self.numbers[which] = value,
            Edit::Comment(file) => self.comments[file] += 1,
            Edit::Insert(file, front, attribute) => self.inserted[file].push((front, attribute)),
            Edit::Rename(renamed) => self.renamed = renamed,
            Edit::Remove => self.removed = !self.removed,
            Edit::Away(file) => self.away[file] = !self.away[file],
            Edit::Break(file) => self.broken[file] = !self.broken[file],
            Edit::Recipe(line, value) => self.recipe[line] = value,
        }
    }

    fn text(&self, file: usize) -> String {
        let mut text = [RECIPE, HOUSE, LIB, BLOCK, STREET, RUIN][file].to_owned();
        let mut put = |from: &str, to: &str, value: u8| {
            if value > 0 {
                text = text.replace(from, &to.replace('N', &value.to_string()));
            }
        };
        let numbers = NUMBERS.iter().zip(self.numbers).filter(|((of, ..), _)| *of == file);
        numbers.for_each(|((_, from, to), value)| put(from, to, value));
        if file == 0 {
            LINES.iter().zip(self.recipe).for_each(|((from, to), value)| put(from, to, value));
            return format!(
                "{}{text}{}",
                "# more\n".repeat(self.comments[0].into()),
                if self.broken[0] { "}" } else { "" }
            );
        }
        if file == 1 && self.renamed {
            text = text.replace("Facade", "Front");
        }
        if file == 1 && self.removed {
            text = text.replace("Plain --> color(wall)\n", "");
        }
        for (number, (front, attribute)) in self.inserted[file].iter().enumerate() {
            let own = match attribute {
                true => format!("attr own{number} = {number}\n"),
                false => format!("Own{number} --> color(0.{number}, 0, 0) Own{number}a\nOwn{number}a --> NIL\n"),
            };
            // Imports and the version come first.
            let at = if *front { text.find("@StartRule").unwrap_or(0) } else { text.len() };
            text.insert_str(at, &own);
        }
        let broken = if self.broken[file] { "Lot --> (" } else { "" };
        format!("{}{text}{broken}", "// more\n\n".repeat(self.comments[file].into()))
    }

    fn write(&self, shop: &Workshop, before: &Model) {
        for (file, name) in FILES.iter().enumerate() {
            match (self.away[file], before.away[file]) {
                (true, false) => {
                    std::fs::rename(shop.path(name), shop.path(&format!("{name}.away"))).expect("it is there")
                }
                (true, true) => {}
                (false, _) if self.text(file) != before.text(file) || before.away[file] => {
                    shop.write(name, &self.text(file))
                }
                (false, _) => {}
            }
        }
    }
}

fn edit() -> impl Strategy<Value = Edit> {
    prop_oneof![
        4 => (0..NUMBERS.len(), 1..9u8).prop_map(|(which, value)| Edit::Number(which, value)),
        2 => (0..FILES.len()).prop_map(Edit::Comment),
        2 => (1..FILES.len(), any::<bool>(), any::<bool>()).prop_map(|(file, front, attribute)| Edit::Insert(file, front, attribute)),
        1 => any::<bool>().prop_map(Edit::Rename),
        1 => Just(Edit::Remove),
        1 => (0..FILES.len()).prop_map(Edit::Away),
        1 => (0..FILES.len()).prop_map(Edit::Break),
        3 => (0..LINES.len(), 1..9u8).prop_map(|(line, value)| Edit::Recipe(line, value)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn an_edited_town_is_the_town_built_anew(edits in prop::collection::vec(edit(), 1..10)) {
        let shop = Workshop::new();
        let mut session = shop.session();
        let mut shown = None;
        let mut model = Model::default();
        for edit in std::iter::once(&Edit::Number(0, 0)).chain(&edits) {
            let before = model.clone();
            model.apply(edit);
            model.write(&shop, &before);
            let update = updated(&mut session);
            prop_assert!(!update.cancelled);
            match shop.cold() {
                Ok(cold) => {
                    prop_assert!(!update.stands, "{edit:?}: {:?}", update.diagnostics);
                    let told = Told::of(&session);
                    prop_assert_eq!(&told.record, &cold.record, "{:?}", edit);
                    prop_assert!(told == cold, "{:?}", edit);
                    shown = Some(cold);
                }
                Err(messages) => {
                    prop_assert!(update.stands, "{edit:?}: {messages:?}");
                    let told: Vec<&String> = update.diagnostics.iter().map(|d| &d.message).collect();
                    prop_assert_eq!(told, messages.iter().collect::<Vec<_>>());
                    prop_assert_eq!(session.built().is_some(), shown.is_some());
                    if let Some(shown) = &shown {
                        prop_assert!(&Told::of(&session) == shown, "{:?}: the last good scene stands", edit);
                    }
                }
            }
        }
    }
}
