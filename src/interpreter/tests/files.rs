//! Files that rules read and look for: rules of a project in a temporary folder, prints out.

use std::path::PathBuf;

use super::*;
use crate::cga::compile;
use crate::interpreter::FileAssets;
use crate::source::{Access, Project};

/// A CityEngine project `town` with what the tests need.
pub struct Shop {
    folder: tempfile::TempDir,
}

/// A box of this size with its least corner at (1, 2, 3), in two groups and two materials.
pub fn box_obj(x: f64, y: f64, z: f64) -> String {
    let mut out = String::from("mtllib box.mtl\n");
    for corner in 0..8 {
        let pick = |bit: u32, size: f64| if corner & bit > 0 { size } else { 0.0 };
        out += &format!("v {} {} {}\n", 1.0 + pick(1, x), 2.0 + pick(2, y), 3.0 + pick(4, z));
    }
    out += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\ng walls\nusemtl stone\nf 5/1 6/2 8/3 7/4\nf 6/1 2/2 4/3 8/4\nf 2/1 1/2 3/3 4/4\nf 1/1 5/2 7/3 3/4\n";
    out + "g lids\nusemtl tin\nf 7/1 8/2 4/3 3/4\nf 1/1 2/2 6/3 5/4\n"
}

/// A picture of this size; with an alpha channel if `alpha`.
pub fn png(width: u32, height: u32, alpha: bool) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    let image =
        image::DynamicImage::new(width, height, if alpha { image::ColorType::Rgba8 } else { image::ColorType::Rgb8 });
    image.write_to(&mut out, image::ImageFormat::Png).expect("memory is writable");
    out.into_inner()
}

impl Shop {
    pub fn new() -> Self {
        let shop = Shop { folder: tempfile::tempdir().expect("a temporary folder can be made") };
        shop.write("town/assets/box.mtl", "newmtl stone\nKd 0.5 0.25 0\nmap_Kd images/wall.png\nnewmtl tin\nPm 1\n");
        for (name, x, y, z) in [("cube", 1.0, 1.0, 1.0), ("slab", 4.0, 1.0, 4.0), ("tower", 2.0, 8.0, 2.0)] {
            shop.write(&format!("town/assets/{name}.obj"), box_obj(x, y, z));
        }
        shop.write("town/assets/images/wall.png", png(8, 4, false));
        shop.write("town/assets/images/tall.png", png(4, 8, false));
        shop.write("town/assets/images/leaf.png", png(4, 4, true));
        shop.write("town/assets/data/words.txt", "one\r\ntwo\x07");
        shop.write("town/assets/data/table.csv", "name;height\noak;12.5\n");
        shop.write("town/assets/data/numbers.csv", "1,2,3\n4,5,x\n");
        shop.write("town/assets/look.cgamat", "metallic,0.5\ncolormap,images/wall.png\ncolormap.su,0.25\n");
        shop.write("secret/secret.txt", "secret");
        shop
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("below the folder")).expect("writable");
        std::fs::write(path, content).expect("writable");
    }

    /// The assets of the project, and the tree of rules derived on the 20 x 10 lot.
    #[track_caller]
    pub fn derive(&self, rules: &str) -> (ShapeTree, FileAssets) {
        self.write("town/rules/test.cga", rules);
        let path = self.path("town/rules/test.cga");
        let project = Project::of(path.parent().expect("a folder"));
        let access = Access::new(project.tree()).expect("it exists");
        let mut sources = SourceMap::default();
        let (program, found) = compile(&path, &access, &mut sources, &CompileOptions::default());
        let messages: Vec<&str> = found.iter().map(|d| d.message.as_str()).collect();
        let program = program.unwrap_or_else(|| panic!("{rules}\n{messages:?}"));
        let assets = FileAssets::new(access);
        (derive(&program, &start(ground(LOT), 0), &assets, &Limits::default()), assets)
    }

    /// What rules print that must run without any message.
    #[track_caller]
    pub fn prints(&self, rules: &str) -> Vec<String> {
        let (tree, _) = self.derive(rules);
        let messages: Vec<&str> = tree.diagnostics.iter().map(|d| d.message.as_str()).collect();
        assert!(messages.is_empty(), "{rules}\n{messages:?}");
        tree.prints
    }

    /// What is printed, and the codes of what is warned of.
    #[track_caller]
    pub fn warned(&self, rules: &str) -> (Vec<String>, Vec<&'static str>) {
        let (tree, _) = self.derive(rules);
        (tree.prints, tree.diagnostics.iter().map(|d| d.code).collect())
    }
}

/// The value of an expression as it prints on a 4 m x 1 m x 4 m block.
#[track_caller]
fn value(expression: &str) -> String {
    let rules = format!("Lot --> s(4, 1, 4) primitiveCube() print({expression}) NIL");
    Shop::new().prints(&rules).join("\n")
}

#[test]
fn files_exist_or_not() {
    let cases = [
        ("cube.obj", true),
        ("images/wall.png", true),
        ("/town/assets/cube.obj", true),
        ("rules/test.cga", false),
        ("data/words.txt", true),
        ("builtin:brick", true),
        ("builtin:cube", true),
        ("builtin:nothing", false),
        ("gone.obj", false),
        ("images", false),
        ("../secret/secret.txt", false),
        ("/secret/secret.txt", false),
    ];
    for (name, there) in cases {
        assert_eq!(value(&format!("fileExists(\"{name}\")")), there.to_string(), "{name}");
    }
}

#[test]
fn searches_give_sorted_workspace_paths() {
    assert_eq!(value("fileSearch(\"*.obj\")"), "/town/assets/cube.obj;/town/assets/slab.obj;/town/assets/tower.obj;");
    assert_eq!(value("fileSearch(\"images/?a*.png\")"), "/town/assets/images/tall.png;/town/assets/images/wall.png;");
    assert_eq!(value("filesSearch(\"*.png Name=l*\")"), "(1)[/town/assets/images/leaf.png]");
    assert_eq!(value("fileSearch(\"*secret*\")"), "");
    assert_eq!(value("size(filesSearch(\"$.*/(cube|slab)[.]obj\"))"), "2");
    let (prints, codes) = Shop::new().warned("Lot --> print(fileSearch(\"$(\")) NIL");
    assert_eq!((prints, codes), (vec![String::new()], vec!["cga::file-query"]));
}

#[test]
fn what_a_search_finds_can_be_used() {
    let shop = Shop::new();
    let (tree, assets) = shop.derive("Lot --> s(0, 0, 0) i(fileRandom(\"*tower.obj\")) A.");
    assert!(tree.diagnostics.iter().next().is_none());
    let (low, high) = tree.leaves[0].mesh.bounds().expect("it has corners");
    near(&(high - low).to_array(), &[2.0, 8.0, 2.0]);
    let read: Vec<PathBuf> = ["box.mtl", "tower.obj"].iter().map(|f| shop.path("town/assets").join(f)).collect();
    assert_eq!(assets.files(), read.iter().map(|p| p.canonicalize().expect("it exists")).collect::<Vec<_>>());
}

#[test]
fn a_random_file_is_one_of_those_found() {
    let rules =
        "Lot --> 50 : A(0)\nA(n) --> case n < 40 : print(fileBasename(fileRandom(\"*.obj\"))) A(n + 1) else : NIL";
    let prints = Shop::new().prints(&rules.replace("50 : A(0)", "A(0)"));
    for name in ["cube", "slab", "tower"] {
        assert!(prints.iter().any(|p| p == name), "{name} in {prints:?}");
    }
    let (prints, codes) = Shop::new().warned("Lot --> print(fileRandom(\"*.gone\")) NIL");
    assert_eq!((prints, codes), (vec![String::new()], vec!["cga::missing-file"]));
}

#[test]
fn texts_and_tables() {
    assert_eq!(value("readTextFile(\"data/words.txt\")"), "one\ntwo?");
    assert_eq!(value("readStringTable(\"data/table.csv\")[1, 0]"), "oak");
    assert_eq!(value("readFloatTable(\"data/table.csv\")[1, 1] * 2"), "25");
    assert_eq!(value("sum(readFloatTable(\"data/numbers.csv\")[0, 0:2])"), "6");
    assert_eq!(value("isnan(readFloatTable(\"data/numbers.csv\")[1, 2])"), "true");
    assert_eq!(value("nColumns(readStringTable(\"data/numbers.csv\"))"), "3");
    for call in
        ["readTextFile(\"gone.txt\")", "readTextFile(\"data/table.csv\")", "readTextFile(\"../secret/secret.txt\")"]
    {
        let (prints, codes) = Shop::new().warned(&format!("Lot --> print(\"[\" + {call} + \"]\") NIL"));
        assert_eq!((prints, codes), (vec!["[]".to_owned()], vec!["cga::missing-file"]), "{call}");
    }
    let (prints, codes) = Shop::new().warned("Lot --> print(size(readStringTable(\"gone.csv\"))) NIL");
    assert_eq!((prints, codes), (vec!["0".to_owned()], vec!["cga::missing-file"]));
}

#[test]
fn large_texts_and_tables_are_refused() {
    let shop = Shop::new();
    shop.write("town/assets/large.txt", "x".repeat(5 << 20));
    shop.write("town/assets/large.csv", "1,".repeat(100_001));
    let rules = "Lot --> print(len(readTextFile(\"large.txt\")) + size(readFloatTable(\"large.csv\"))) NIL";
    let (tree, _) = shop.derive(rules);
    assert_eq!(tree.prints, ["0"]);
    let messages: Vec<&str> = tree.diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert_eq!(messages.len(), 2, "{messages:?}");
    assert!(messages.iter().any(|m| m.contains("larger than 4194304 bytes")), "{messages:?}");
    assert!(messages.iter().any(|m| m.contains("more than 100000 cells")), "{messages:?}");
}

#[test]
fn what_assets_and_images_tell() {
    assert_eq!(value("assetInfo(\"tower.obj\", sy) + assetInfo(\"tower.obj\", tz)"), "11");
    assert_eq!(value("assetInfo(\"builtin:cube\", sx)"), "1");
    assert_eq!(value("assetNamingInfo(\"cube.obj\", g)"), "walls;lids;");
    assert_eq!(value("assetNamingInfos(\"cube.obj\", m)"), "(2)[stone,tin]");
    assert_eq!(value("imageInfo(\"images/wall.png\", sx) / imageInfo(\"images/wall.png\", sy)"), "2");
    assert_eq!(value("imageInfo(\"builtin:brick\", sx)"), "128");
    let calls = "assetInfo(\"gone.obj\", sx) + imageInfo(\"data/words.txt\", sx)";
    let (prints, codes) = Shop::new().warned(&format!("Lot --> print({calls}) NIL"));
    assert_eq!((prints, codes), (vec!["0".to_owned()], vec!["cga::missing-file"; 2]));
}

#[test]
fn metadata_of_the_wanted_type_or_the_default() {
    let shop = Shop::new();
    let gltf = r#"{"asset": {"version": "2.0", "extras": {"height": 7.5, "kind": "tree", "evergreen": true}}}"#;
    shop.write("town/assets/meta.gltf", gltf);
    let call = |key: &str, default: &str| format!("print(assetMetadata(\"meta.gltf\", \"{key}\", {default}))");
    let calls = [
        call("height", "1"),
        call("height", "\"none\""),
        call("kind", "\"none\""),
        call("evergreen", "false"),
        call("gone", "3"),
    ];
    assert_eq!(shop.prints(&format!("Lot --> {} NIL", calls.join(" "))), ["7.5", "none", "tree", "true", "3"]);
}

/// Prints base names on a block of 4 x 1 x 4 m.
#[track_caller]
fn names(expression: &str) -> String {
    value(expression).replace("/town/assets/", "").replace("images/", "").replace(".obj", "").replace(".png", "")
}

#[test]
fn files_sorted_by_how_they_suit_the_scope() {
    assert_eq!(names("assetsSortRatio(fileSearch(\"*.obj\"), xy)"), "slab;cube;tower;");
    assert_eq!(names("assetsSortRatio(filesSearch(\"*.obj\"), xyz)"), "(3)[slab,cube,tower]");
    assert_eq!(names("assetsSortSize(fileSearch(\"*.obj\"), x, 0)"), "slab;tower;cube;");
    assert_eq!(names("assetsSortSize(fileSearch(\"*.obj\"), x, 1)"), "slab;tower;");
    assert_eq!(names("assetsSortSize(fileSearch(\"*.obj\"), xyz, 0.5)"), "slab;");
    assert_eq!(names("imagesSortRatio(fileSearch(\"images/*\"), xy)"), "wall;leaf;tall;");
    assert_eq!(names("imagesSortRatio(fileSearch(\"images/*\"), yx)"), "tall;leaf;wall;");
}

#[test]
fn the_best_files_for_the_scope() {
    assert_eq!(names("assetBestRatio(\"*.obj\", \"xy\")"), "slab");
    assert_eq!(names("assetBestSize(\"*.obj\", \"y\")"), "cube");
    assert_eq!(names("imageBestRatio(\"images/*\", \"xz\")"), "leaf");
    assert_eq!(names("assetApproxRatio(\"*.obj\", \"xy\", 1)"), "slab");
    assert_eq!(names("assetApproxSize(\"*.obj\", \"x\", 1)"), "slab");
    assert_eq!(names("imageApproxRatio(\"images/*\", \"xy\", 1)"), "wall");
    assert_eq!(names("assetFitSize(\"*.obj\", \"xyz\", 0.1)"), "slab");
    let (prints, codes) = Shop::new().warned("Lot --> print(assetBestRatio(\"*.obj\", \"up\")) NIL");
    assert_eq!((prints[0].as_str(), codes), ("", vec!["cga::file-axes", "cga::missing-file"]));
}

#[test]
fn approximations_draw_among_the_best() {
    let call = |function: &str, axes: &str, n: u32| {
        let rules = format!(
            "Lot --> s(4, 1, 4) primitiveCube() A(0)\n\
             A(n) --> case n < 40 : print(fileBasename({function}(\"*.obj\", \"{axes}\", {n}))) A(n + 1) else : NIL"
        );
        let mut prints = Shop::new().prints(&rules);
        prints.sort();
        prints.dedup();
        prints.join(" ")
    };
    assert_eq!(call("assetApproxRatio", "xy", 2), "cube slab");
    assert_eq!(call("assetApproxSize", "x", 2), "slab tower");
    assert_eq!(call("assetFitSize", "x", 1), "slab tower");
    assert_eq!(call("assetFitSize", "x", 0), "cube slab tower");
}

#[test]
fn imported_files_look_in_their_own_project() {
    let shop = Shop::new();
    shop.write("town/lib/rules/l.cga", "f = fileExists(\"own.txt\")\nLot --> print(f) NIL");
    shop.write("town/lib/assets/own.txt", "x");
    let rules = "import l : \"/town/lib/rules/l.cga\"\nLot --> print(fileExists(\"own.txt\")) print(l.f) NIL";
    assert_eq!(shop.prints(rules), ["false", "true"]);
}

#[cfg(unix)]
#[test]
fn nothing_outside_the_project_is_reached() {
    let shop = Shop::new();
    let link = |to: &str, at: &str| std::os::unix::fs::symlink(shop.path(to), shop.path(at)).expect("writable");
    link("secret", "town/assets/door");
    link("secret/secret.txt", "town/assets/window.txt");
    link("town", "town/assets/loop");
    let made = std::process::Command::new("mkfifo").arg(shop.path("town/assets/pipe.txt")).status();
    assert!(made.expect("mkfifo is part of every Unix").success());
    let names = [
        "door/secret.txt".to_owned(),
        "window.txt".to_owned(),
        "pipe.txt".to_owned(),
        shop.path("secret/secret.txt").to_string_lossy().into_owned(),
        "/etc/passwd".to_owned(),
        "C:/secret/secret.txt".to_owned(),
        "//host/share/secret.txt".to_owned(),
        "x".repeat(5000),
        format!("{}secret/secret.txt", "../".repeat(300)),
    ];
    for name in names {
        for call in ["readTextFile", "readStringTable", "imageInfo", "i"] {
            let call = match call {
                "i" => format!("i(\"{name}\")"),
                "imageInfo" => format!("print(imageInfo(\"{name}\", sx))"),
                _ => format!("print(len(str({call}(\"{name}\"))))"),
            };
            let (prints, codes) = shop.warned(&format!("Lot --> {call} NIL"));
            assert_eq!(codes.len(), 1, "{call:.60}: {codes:?}");
            assert!(prints.iter().all(|p| p == "0" || p == "5"), "{call:.60}: {prints:?}");
        }
    }
    let found = shop.prints("Lot --> print(fileSearch(\"*.txt\")) NIL");
    assert_eq!(found, ["/town/assets/data/words.txt;"]);
}
