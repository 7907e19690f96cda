//! What the integration tests share. In: names and texts. Out: temporary folders with towns and recipes, runs of the
//! built program, the real data where it is there.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A temporary folder that is removed at the end of the test.
pub struct Workshop {
    folder: tempfile::TempDir,
}

/// What a run of the program left.
pub struct Run {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Workshop {
    pub fn new() -> Self {
        Workshop { folder: tempfile::tempdir().expect("a temporary folder can be made") }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("inside the folder")).expect("the folder is writable");
        std::fs::write(&path, content).expect("the folder is writable");
        path
    }

    /// A small town beside the recipe: `town.osm` and `town.tif`.
    pub fn town(&self, buildings: u32) {
        mansard::town::write_town(3, buildings, self.folder.path(), "town", &|_| {}).expect("the folder is writable");
    }

    /// Runs the program in the folder.
    pub fn run(&self, args: &[&str]) -> Run {
        self.run_with(args, &[])
    }

    /// [`Workshop::run`] with variables of the environment.
    pub fn run_with(&self, args: &[&str], variables: &[(&str, &str)]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_mansard"))
            .args(args)
            .envs(variables.iter().copied())
            .current_dir(self.folder.path())
            .output()
            .expect("the program was built");
        Run::new(output)
    }

    /// Names of everything in a folder below, sorted; empty if the folder does not exist.
    pub fn list(&self, folder: &str) -> Vec<String> {
        let mut names = Vec::new();
        let mut folders = vec![self.path(folder)];
        while let Some(folder) = folders.pop() {
            let Ok(entries) = std::fs::read_dir(&folder) else { continue };
            for entry in entries {
                let path = entry.expect("the folder can be listed").path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let below = path.strip_prefix(self.folder.path()).expect("inside the folder");
                    names.push(below.to_string_lossy().into_owned());
                }
            }
        }
        names.sort();
        names
    }
}

impl Run {
    fn new(output: Output) -> Self {
        Run {
            code: output.status.code().expect("the program ends by itself"),
            stdout: String::from_utf8(output.stdout).expect("the program prints UTF-8"),
            stderr: String::from_utf8(output.stderr).expect("the program prints UTF-8"),
        }
    }

    /// Fails the test with everything that was printed unless the exit code is this one.
    pub fn expect(self, code: i32) -> Self {
        assert_eq!(self.code, code, "stdout:\n{}\nstderr:\n{}", self.stdout, self.stderr);
        self
    }

    /// Fails unless standard error holds all of these.
    pub fn says(self, texts: &[&str]) -> Self {
        // miette wraps long lines, so white space does not count.
        let flat = |t: &str| t.split_whitespace().filter(|w| *w != "│").collect::<Vec<_>>().join(" ");
        let all = flat(&self.stderr);
        for text in texts {
            assert!(all.contains(&flat(text)), "`{text}` is missing from\n{}", self.stderr);
        }
        self
    }
}

/// A file of the shared real data; `None`, with a printed line, where the folder is missing (a failure in CI).
pub fn shared(name: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if folder.is_dir() {
        return Some(folder.join(name));
    }
    assert!(std::env::var_os("CI").is_none(), "{} is missing", folder.display());
    eprintln!("skipped: {} is not there", folder.display());
    None
}

/// Whether the renderer can run here; a failure where `MANSARD_REQUIRE_GPU=1`.
pub fn has_adapter() -> bool {
    match mansard::gpu::Renderer::new() {
        Ok(_) => true,
        Err(error) => {
            assert!(std::env::var("MANSARD_REQUIRE_GPU").as_deref() != Ok("1"), "{error}");
            eprintln!("skipped: {error}");
            false
        }
    }
}
