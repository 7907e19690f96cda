//! What may be read and what not.

use super::*;

/// `project/in.txt` beside `secret.txt`; only `project` is allowed.
fn shop() -> (tempfile::TempDir, Access, PathBuf) {
    let shop = tempfile::tempdir().expect("a temporary folder can be made");
    let project = shop.path().join("project");
    std::fs::create_dir_all(project.join("sub")).expect("writable");
    std::fs::write(project.join("in.txt"), "in").expect("writable");
    std::fs::write(shop.path().join("secret.txt"), "secret").expect("writable");
    let access = Access::new(&project).expect("the folder exists");
    let project = project.canonicalize().expect("it exists");
    (shop, access, project)
}

fn refused(access: &Access, base: &Path, named: &str) -> AccessError {
    access.read(base, named, 100).map(|(path, _)| path).expect_err(named)
}

#[test]
fn files_inside_are_read_however_they_are_named() {
    let (_shop, access, project) = shop();
    for named in ["in.txt", "./in.txt", "sub/../in.txt", &project.join("in.txt").to_string_lossy()] {
        let (path, bytes) = access.read(&project, named, 100).expect(named);
        assert_eq!((path, bytes.as_slice()), (project.join("in.txt"), &b"in"[..]));
    }
}

#[test]
fn what_lies_outside_is_refused_whether_it_exists_or_not() {
    let (shop, access, project) = shop();
    let absolute = shop.path().join("secret.txt").to_string_lossy().into_owned();
    for named in ["../secret.txt", "../gone.txt", "sub/../../secret.txt", "gone/../../x", "/etc/passwd", &absolute] {
        let error = refused(&access, &project, named);
        assert!(matches!(error, AccessError::Outside(_)), "{named}: {error}");
    }
    assert!(matches!(refused(&access, &project, "gone.txt"), AccessError::Io { .. }));
    assert!(matches!(refused(&access, &project, "gone/../also_gone.txt"), AccessError::Io { .. }));
}

#[test]
fn names_that_no_file_has_are_refused_unasked() {
    let (_shop, access, project) = shop();
    let long = "a/".repeat(3000);
    for named in ["in\0.txt", "//server/share/a.txt", "\\\\server\\share\\a.txt", &long] {
        assert!(matches!(refused(&access, &project, named), AccessError::Name { .. }), "{named:.20}");
    }
    let one = "x".repeat(1000);
    let error = refused(&access, &project, &one).to_string();
    assert!(error.len() < 300, "{error}");
    // Elsewhere this is a drive; here it is a name that nothing has.
    #[cfg(unix)]
    assert!(matches!(refused(&access, &project, "C:\\Windows\\win.ini"), AccessError::Io { .. }));
}

#[test]
fn large_files_and_folders_are_refused() {
    let (_shop, access, project) = shop();
    std::fs::write(project.join("large.txt"), [b'x'; 101]).expect("writable");
    assert!(matches!(refused(&access, &project, "large.txt"), AccessError::TooLarge { most: 100, .. }));
    assert!(matches!(refused(&access, &project, "sub"), AccessError::NotAFile(_)));
}

#[cfg(unix)]
#[test]
fn links_are_followed_before_the_check() {
    use std::os::unix::fs::symlink;
    let (shop, access, project) = shop();
    symlink(shop.path().join("secret.txt"), project.join("out.txt")).expect("writable");
    symlink(shop.path(), project.join("up")).expect("writable");
    symlink(project.join("in.txt"), project.join("again.txt")).expect("writable");
    for named in ["out.txt", "up/secret.txt", "up/gone.txt"] {
        assert!(matches!(refused(&access, &project, named), AccessError::Outside(_)), "{named}");
    }
    assert_eq!(access.read(&project, "again.txt", 9).expect("it stays inside").1, b"in");
    assert_eq!(access.read(&project, "up/project/in.txt", 9).expect("it comes back in").1, b"in");
    // The root itself by way of a link.
    let alias = shop.path().join("alias");
    symlink(&project, &alias).expect("writable");
    let access = Access::new(&alias).expect("the folder exists");
    for (base, named) in [(alias.clone(), "in.txt".to_owned()), (project, format!("{}/in.txt", alias.display()))] {
        assert_eq!(access.read(&base, &named, 9).expect("it lies in the root").1, b"in");
        assert!(matches!(refused(&access, &base, "gone.txt"), AccessError::Io { .. }));
    }
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_without_waiting() {
    let (_shop, mut access, project) = shop();
    let pipe = project.join("pipe.txt");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo is part of every Unix").success());
    assert!(matches!(refused(&access, &project, "pipe.txt"), AccessError::NotAFile(_)));
    access.allow(Path::new("/dev")).expect("it exists");
    for device in ["/dev/zero", "/dev/null"] {
        assert!(matches!(refused(&access, &project, device), AccessError::NotAFile(_)), "{device}");
    }
}
