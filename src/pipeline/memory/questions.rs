//! What derivations asked of files. In: the questions of each derivation. Out: which of them have another answer now.
//!
//! Geometry and material files are made of several files; a change of any file that is read so far and is no image, text
//! or table counts for all of them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, RwLock};

use sha2::{Digest, Sha256};

use super::files::FileTable;
use crate::interpreter::assets::{Asset, AssetError, Assets, ImageInfo, Pairs, Table};
use crate::interpreter::used::Bits;

/// A question; the folder is that of the rule file that asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Locate,
    Load,
    Shown,
    Search,
    Image,
    Text,
    Table,
    Material,
}

type Numbers = BTreeMap<(Kind, PathBuf), BTreeMap<String, u32>>;
type Answer = [u8; 32];

/// All questions so far, by number, with their last answers.
#[derive(Debug, Default)]
pub struct Questions {
    numbers: RwLock<Numbers>,
    answers: BTreeMap<u32, Answer>,
}

/// Files that write down what one derivation asks.
pub struct Noting<'a> {
    files: &'a dyn Assets,
    questions: &'a Questions,
    asked: Mutex<Bits>,
}

impl Questions {
    fn number(&self, kind: Kind, folder: &Path, name: &str) -> u32 {
        let key = (kind, folder.to_owned());
        let known = self.numbers.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(&number) = known.get(&key).and_then(|names| names.get(name)) {
            return number;
        }
        drop(known);
        let mut numbers = self.numbers.write().unwrap_or_else(PoisonError::into_inner);
        let next = numbers.values().map(BTreeMap::len).sum::<usize>() as u32;
        *numbers.entry(key).or_default().entry(name.to_owned()).or_insert(next)
    }

    /// Asks everything again. `read` are the files behind geometry and materials. Out: the questions whose answers changed,
    /// and those that were never answered before.
    pub fn ask_again(&mut self, assets: &dyn Assets, files: &mut FileTable, read: &[PathBuf]) -> Bits {
        let solid = solid(files, read);
        let numbers = self.numbers.get_mut().unwrap_or_else(PoisonError::into_inner);
        let mut changed = Bits::default();
        for ((kind, folder), names) in numbers.iter() {
            for (name, &number) in names {
                let answer = answer(*kind, folder, name, assets, files, solid);
                if self.answers.insert(number, answer) != Some(answer) {
                    changed.insert(number);
                }
            }
        }
        changed
    }

    /// Writes down the answers to questions that are new since the last time.
    pub fn learn(&mut self, assets: &dyn Assets, files: &mut FileTable, read: &[PathBuf]) {
        let numbers = self.numbers.get_mut().unwrap_or_else(PoisonError::into_inner);
        let mut of_read: Option<Answer> = None;
        for ((kind, folder), names) in numbers.iter() {
            for (name, &number) in names {
                self.answers.entry(number).or_insert_with(|| {
                    let solid = *of_read.get_or_insert_with(|| solid(files, read));
                    answer(*kind, folder, name, assets, files, solid)
                });
            }
        }
    }
}

/// Hash of all files of which geometry and materials are made.
fn solid(files: &mut FileTable, read: &[PathBuf]) -> Answer {
    let plain = ["png", "jpg", "jpeg", "tif", "tiff", "tga", "bmp", "txt", "csv"];
    let is_plain =
        |path: &Path| path.extension().is_some_and(|e| plain.iter().any(|plain| e.eq_ignore_ascii_case(plain)));
    let mut hash = Sha256::new();
    for path in read.iter().filter(|path| !is_plain(path)) {
        hash.update(format!("{path:?} {:?}", files.content(path)));
    }
    hash.finalize().into()
}

fn answer(kind: Kind, folder: &Path, name: &str, assets: &dyn Assets, files: &mut FileTable, solid: Answer) -> Answer {
    let located = || assets.locate(folder, name);
    let mut content = |path: Option<Arc<str>>| path.map(|path| (files.content(Path::new(&*path)), path));
    let text = match kind {
        Kind::Locate => format!("{:?}", located()),
        Kind::Load | Kind::Material => format!("{:?} {:?} {solid:?}", content(located()), located()),
        Kind::Shown => format!("{:?}", assets.shown(folder, &name.into())),
        Kind::Search => format!("{:?}", assets.search(folder, name)),
        Kind::Image => format!("{:?} {:?}", assets.image(folder, name), content(located())),
        Kind::Text | Kind::Table => format!("{:?}", content(located())),
    };
    Sha256::digest(text).into()
}

impl<'a> Noting<'a> {
    pub fn new(files: &'a dyn Assets, questions: &'a Questions) -> Noting<'a> {
        Noting { files, questions, asked: Mutex::default() }
    }

    /// The questions so far.
    pub fn asked(self) -> Bits {
        self.asked.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, kind: Kind, folder: &Path, name: &str) {
        let number = self.questions.number(kind, folder, name);
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).insert(number);
    }
}

impl Assets for Noting<'_> {
    fn locate(&self, folder: &Path, name: &str) -> Option<Arc<str>> {
        self.note(Kind::Locate, folder, name);
        self.files.locate(folder, name)
    }

    fn load(&self, folder: &Path, name: &str) -> Result<Arc<Asset>, AssetError> {
        self.note(Kind::Load, folder, name);
        self.files.load(folder, name)
    }

    fn shown(&self, folder: &Path, located: &Arc<str>) -> Arc<str> {
        self.note(Kind::Shown, folder, located);
        self.files.shown(folder, located)
    }

    fn search(&self, folder: &Path, query: &str) -> Result<Arc<[Arc<str>]>, AssetError> {
        self.note(Kind::Search, folder, query);
        self.files.search(folder, query)
    }

    fn image(&self, folder: &Path, name: &str) -> Result<ImageInfo, AssetError> {
        self.note(Kind::Image, folder, name);
        self.files.image(folder, name)
    }

    fn text(&self, folder: &Path, name: &str) -> Result<Arc<str>, AssetError> {
        self.note(Kind::Text, folder, name);
        self.files.text(folder, name)
    }

    fn table(&self, folder: &Path, name: &str, most: usize) -> Table {
        self.note(Kind::Table, folder, name);
        self.files.table(folder, name, most)
    }

    fn material(&self, folder: &Path, name: &str) -> Result<Arc<Pairs>, AssetError> {
        self.note(Kind::Material, folder, name);
        self.files.material(folder, name)
    }
}
