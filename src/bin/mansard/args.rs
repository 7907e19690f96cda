//! The command line, as a type. In: words. Out: [`Args`], or clap's own usage error (exit code 2).

use std::path::PathBuf;

use clap::{Parser, Subcommand, ValueEnum};

/// A compiler for declarative city scenes: rules and maps in, change-detection datasets with exact masks out.
///
/// Exit codes: 0 done, 1 the input is wrong, 2 the command line is wrong or the machine cannot do it.
#[derive(Debug, Parser)]
#[command(name = "mansard", version, max_term_width = 100)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
    /// Print errors only
    #[arg(long, short, global = true)]
    pub quiet: bool,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Check rule files (.cga) and recipes (.render)
    Check {
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Report what rule files written for CityEngine meet here; folders are searched for .cga files
        #[arg(long)]
        cityengine: bool,
        /// `json` prints one object per line, `short` one line per mistake (per folder with `--cityengine`)
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
        #[command(flatten)]
        recipe: RecipeOptions,
    },
    /// Lay out rule files (.cga); their meaning and comments stay
    Fmt {
        /// Files to write in place; `-` is standard input
        #[arg(required_unless_present = "stdin", value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Write nothing, name the files that would change, and exit with 1 if there are any
        #[arg(long)]
        check: bool,
        /// Read standard input, write to standard output
        #[arg(long)]
        stdin: bool,
    },
    /// Say what a diagnostic code means, with an example and the fix
    Explain {
        /// Such as `cga::unknown-name`, or without `cga::`
        code: String,
    },
    /// Run a rule file on a footprint, or on several
    Derive(DeriveArgs),
    /// Build the meshes of a recipe's scene as binary glTF
    Build {
        recipe: PathBuf,
        /// The .glb file; recipes of several scenes get one file each, `NAME-SCENE.glb`
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// What the rules report, per feature and in total, as a .csv or .json file
        #[arg(long, value_name = "FILE")]
        reports: Option<PathBuf>,
        /// Check every feature's meshes: a table by defect, NAME.validation.json beside the output, exit code 1 if
        /// something is invalid
        #[arg(long)]
        validate: bool,
        #[command(flatten)]
        options: RecipeOptions,
        #[command(flatten)]
        work: WorkOptions,
    },
    /// Make the dataset of a recipe
    Render(RenderArgs),
    /// Follow a recipe and everything it names: what is saved is seen at once
    Watch(WatchArgs),
    /// Show what a recipe will derive and draw, what not, and why; needs no GPU
    Plan {
        recipe: PathBuf,
        #[arg(long, value_enum, default_value_t = PlanFormat::Text)]
        format: PlanFormat,
        #[command(flatten)]
        options: RecipeOptions,
        #[command(flatten)]
        work: WorkOptions,
    },
    /// Measure what accuracy costs in time: every knob of a recipe's own scene against the reference renderer
    Cost {
        recipe: PathBuf,
        /// Folder of cost.csv, the plots and cost.html, made if it is missing
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        #[command(flatten)]
        measure: CostOptions,
        #[command(flatten)]
        options: RecipeOptions,
        #[command(flatten)]
        work: WorkOptions,
    },
    /// Say what differs between two recipes, two git revisions or two output folders
    ///
    /// Exit codes: 0 the same, 1 different, 2 trouble.
    Diff(DiffArgs),
    /// Make a dataset again from its manifest and compare every file
    ///
    /// Exit codes: 0 verified, 1 something differs, 2 it cannot be verified, as where an input is missing or is not what it was.
    Verify(VerifyArgs),
    /// Serve an editor: the Language Server Protocol on standard input and output
    Lsp {
        /// The only way there is; some editors name it
        #[arg(long)]
        stdio: bool,
    },
    /// Look into a phase
    Dump {
        #[arg(value_enum)]
        phase: Phase,
        /// A .cga or .render file (`tree` wants a .cga file and derives it on a 10 m x 8 m footprint)
        file: PathBuf,
    },
    /// Make a fictional town: DIR/NAME.osm and DIR/NAME.tif
    Town {
        #[arg(long, default_value_t = 0)]
        seed: u64,
        /// 1 to 1,000,000
        #[arg(long, default_value_t = 400)]
        buildings: u32,
        /// Folder, made if it is missing
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        #[arg(long, default_value = "town")]
        name: String,
    },
}

/// Options of commands that read a recipe.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct RecipeOptions {
    /// Value of an argument that the recipe declares; paths are relative to the working folder
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// One more folder tree that the recipe may read from
    #[arg(long, value_name = "DIR")]
    pub allow: Vec<PathBuf>,
}

#[derive(Clone, Debug, clap::Args)]
pub struct CostOptions {
    /// The view to measure, by name; the first one with a colour image otherwise
    #[arg(long, value_name = "VIEW")]
    pub view: Option<String>,
    /// Runs that each time is the median of
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub repeats: u32,
    /// Windows of the view that are compared with the reference
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub windows: u32,
    /// Pixels per side of a window
    #[arg(long, value_name = "PIXELS", default_value_t = 256, value_parser = clap::value_parser!(u32).range(8..=2048))]
    pub side: u32,
    /// Mean standard error of the reference at which it stops, percent of white
    #[arg(long, value_name = "PERCENT", default_value_t = 0.15)]
    pub noise: f64,
}

#[derive(Clone, Debug, Default, clap::Args)]
pub struct WorkOptions {
    /// Threads; results do not depend on it
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,
}

#[derive(Clone, Debug, clap::Args)]
pub struct RenderArgs {
    pub recipe: PathBuf,
    /// Folder of the dataset, made if it is missing
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Only these views, by name, `*` stands for anything; several with commas
    #[arg(long, value_delimiter = ',', value_name = "VIEWS")]
    pub views: Vec<String>,
    /// What the rules report, per feature and in total, as one more .csv or .json file; the dataset has both anyway
    #[arg(long, value_name = "FILE")]
    pub reports: Option<PathBuf>,
    /// Who draws; `wgpu` if there is an adapter, else `reference`
    #[arg(long, value_enum)]
    pub backend: Option<BackendName>,
    /// Samples per pixel of the reference, at least; 32, or 8 where it stands in
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=65_536))]
    pub samples: Option<u32>,
    #[command(flatten)]
    pub options: RecipeOptions,
    #[command(flatten)]
    pub work: WorkOptions,
}

#[derive(Clone, Debug, clap::Args)]
pub struct DiffArgs {
    /// A recipe, a folder that `mansard render` wrote, or REVISION:PATH of a recipe in git; with --recipe a revision
    pub a: String,
    /// What A is compared with, named likewise
    pub b: String,
    /// The recipe that is compared in two revisions
    #[arg(long, value_name = "FILE")]
    pub recipe: Option<PathBuf>,
    /// Folder for pictures of the differences, diff.json and diff.html, made if it is missing; recipes are drawn
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Draw recipes and compare their pixels too
    #[arg(long)]
    pub pixels: bool,
    /// `json` prints everything, lists uncut
    #[arg(long, value_enum, default_value_t = ReportFormat::Text)]
    pub format: ReportFormat,
    #[command(flatten)]
    pub options: RecipeOptions,
    #[command(flatten)]
    pub work: WorkOptions,
}

#[derive(Clone, Debug, clap::Args)]
pub struct WatchArgs {
    pub recipe: PathBuf,
    /// No window: one line of JSON per update on standard output, and the picture in a file
    #[arg(long)]
    pub headless: bool,
    /// Print updates and what happens in the window as lines of JSON
    #[arg(long, conflicts_with = "headless")]
    pub json: bool,
    /// Folder of the window's screenshots
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub screenshots: PathBuf,
    /// The picture, written whole after every update that changes it
    #[arg(long, value_name = "FILE", requires = "headless")]
    pub png: Option<PathBuf>,
    /// The view to draw, by name; the recipe's first otherwise
    #[arg(long, value_name = "VIEW")]
    pub view: Option<String>,
    /// The image of the view to draw
    #[arg(long, value_enum, default_value_t = ShownName::After)]
    pub state: ShownName,
    /// The scene to show, by name; the recipe's first otherwise
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<String>,
    /// End after this many updates; exit code 1 if the last one failed
    #[arg(long, value_name = "N", requires = "headless")]
    pub updates: Option<u64>,
    /// End after the first update
    #[arg(long, requires = "headless", conflicts_with = "updates")]
    pub once: bool,
    #[command(flatten)]
    pub options: RecipeOptions,
    #[command(flatten)]
    pub work: WorkOptions,
}

#[derive(Clone, Debug, clap::Args)]
pub struct VerifyArgs {
    /// A folder that `mansard render` wrote
    pub dir: PathBuf,
    /// Where the recipe lies; it is searched for about the dataset and the working folder otherwise
    #[arg(long, value_name = "FILE")]
    pub recipe: Option<PathBuf>,
    /// Folder with inputs, whatever their names; may be given several times
    #[arg(long, value_name = "DIR")]
    pub inputs: Vec<PathBuf>,
    /// What is taken for the same colours
    #[arg(long, value_enum, default_value_t = ColoursName::Exact)]
    pub colours: ColoursName,
    /// Make the geometry again and leave the images alone; needs no GPU
    #[arg(long)]
    pub no_images: bool,
    #[arg(long, value_enum, default_value_t = ReportFormat::Text)]
    pub format: ReportFormat,
    #[command(flatten)]
    pub work: WorkOptions,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ColoursName {
    /// Equal to the bit
    Exact,
    /// On another adapter or driver within 1/255, depths within 1e-5 of themselves; labels are always exact
    Close,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShownName {
    Before,
    After,
    Mask,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BackendName {
    /// On a Vulkan, Metal or DirectX 12 adapter
    Wgpu,
    /// Rays on the CPU: exact visibility, noise that is told
    Reference,
}

#[derive(Clone, Debug, clap::Args)]
pub struct DeriveArgs {
    /// The .cga file
    pub rules: PathBuf,
    /// Corners "x,z x,z ..." in metres, y up, in the order given, holes after `;`; may be given several times: the
    /// start shapes see each other
    #[arg(long, value_name = "RINGS", allow_hyphen_values = true, required = true)]
    pub footprint: Vec<String>,
    /// A street along an edge of the footprint, counted from 0
    #[arg(long, value_name = "EDGE=METRES")]
    pub street_width: Vec<String>,
    /// Values of an edge attribute, edge by edge
    #[arg(long, value_name = "NAME=VALUE,...")]
    pub edge_attr: Vec<String>,
    /// Start rule; the file's own @StartRule otherwise
    #[arg(long, value_name = "RULE")]
    pub start: Option<String>,
    /// Value of an attribute of the rules; may be given several times
    #[arg(long = "attr", value_name = "NAME=VALUE")]
    pub attributes: Vec<String>,
    /// Seed of every random draw
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    #[arg(long, value_enum, default_value_t = DeriveFormat::Tree)]
    pub format: DeriveFormat,
    /// Standard output otherwise
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// What the rules report, as a .csv or .json file
    #[arg(long, value_name = "FILE")]
    pub reports: Option<PathBuf>,
    /// One more folder tree that rules may read from
    #[arg(long, value_name = "DIR")]
    pub allow: Vec<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Text,
    /// `FILE:LINE:COLUMN: error[CODE]: MESSAGE`, as editors read it
    Short,
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ReportFormat {
    Text,
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PlanFormat {
    Text,
    Json,
    Dot,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeriveFormat {
    Tree,
    Json,
    Glb,
    Obj,
    /// A picture, 640 × 480
    Png,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Phase {
    Ast,
    Program,
    Tree,
}
