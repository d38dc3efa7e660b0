use super::sample::{Folder, picture, write};
use lampray::Error;
use lampray::film::{Target, read_exr, read_record};
use std::fs;

#[test]
fn the_format_goes_by_the_extension() {
    let folder = Folder::new();
    for name in ["a.jpg", "a", "png", "a.png.bak", "a.exr "] {
        let Err(Error::Usage(message)) = Target::prepare(folder.join(name)) else {
            panic!("{name} was accepted");
        };
        assert!(
            message.contains(".png") && message.contains(".exr"),
            "{message}"
        );
    }
    write(&picture(0..2), &folder.join("A.EXR"));
    assert!(read_exr(folder.join("A.EXR")).is_ok());
    assert_eq!(folder.names(), ["A.EXR"]);
}

#[test]
fn a_target_that_is_not_used_leaves_no_trace() {
    let folder = Folder::new();
    drop(Target::prepare(folder.join("a.png")).unwrap());
    assert!(folder.names().is_empty());

    fs::write(folder.join("a.png"), "old").unwrap();
    drop(Target::prepare(folder.join("a.png")).unwrap());
    assert_eq!(fs::read(folder.join("a.png")).unwrap(), b"old");
    assert_eq!(folder.names(), ["a.png"]);
}

#[test]
fn what_cannot_be_created_is_said_before_rendering() {
    let folder = Folder::new();
    fs::create_dir(folder.join("folder.png")).unwrap();
    fs::write(folder.join("file"), "").unwrap();
    for name in [
        "missing/a.png",
        "folder.png",
        "file/a.png",
        ".",
        &"x/".repeat(3000),
    ] {
        let outcome = Target::prepare(folder.join(name));
        assert!(matches!(outcome, Err(Error::Create { .. })), "{name}");
    }
    let long = format!("{}.png", "n".repeat(300));
    assert!(matches!(
        Target::prepare(folder.join(long)),
        Err(Error::Create { .. })
    ));
    assert_eq!(folder.names(), ["file", "folder.png"]);
}

#[test]
fn an_old_file_is_replaced_as_a_whole() {
    let folder = Folder::new();
    write(&picture(0..2), &folder.join("a.exr"));
    let open = fs::File::open(folder.join("a.exr")).unwrap();
    let old = fs::read(folder.join("a.exr")).unwrap();
    write(&picture(0..4), &folder.join("a.exr"));
    assert_eq!(read_exr(folder.join("a.exr")).unwrap().record.samples, 4);
    // Who had the old file open goes on reading the old file.
    assert_eq!(
        std::io::read_to_string(open).err().map(|e| e.kind()),
        not_text()
    );
    assert_ne!(fs::read(folder.join("a.exr")).unwrap(), old);
    assert_eq!(folder.names(), ["a.exr"]);
}

/// What reading an EXR as text gives.
fn not_text() -> Option<std::io::ErrorKind> {
    Some(std::io::ErrorKind::InvalidData)
}

#[test]
fn the_same_output_twice_is_refused() {
    let folder = Folder::new();
    fs::create_dir(folder.join("sub")).unwrap();
    let same = [folder.join("a.png"), folder.join("sub/../a.png")];
    assert!(matches!(Target::prepare_all(&same), Err(Error::Usage(_))));
    assert_eq!(folder.names(), ["sub"]);
    let different = [
        folder.join("a.png"),
        folder.join("a.exr"),
        folder.join("sub/a.png"),
    ];
    assert_eq!(Target::prepare_all(&different).unwrap().len(), 3);
}

#[test]
fn a_picture_with_planes_of_wrong_size_is_a_fault_of_ours() {
    let folder = Folder::new();
    for name in ["a.png", "a.exr"] {
        let mut picture = picture(0..2);
        picture.variance.pop();
        let outcome = Target::prepare(folder.join(name)).unwrap().write(&picture);
        assert!(matches!(outcome, Err(Error::Internal(_))));
    }
    assert!(folder.names().is_empty());
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    use std::path::Path;

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn the_mode_is_that_of_any_new_file() {
        let folder = Folder::new();
        fs::write(folder.join("plain"), "").unwrap();
        write(&picture(0..2), &folder.join("a.png"));
        assert_eq!(mode(&folder.join("a.png")), mode(&folder.join("plain")));
        assert_ne!(mode(&folder.join("a.png")), 0o600);
    }

    #[test]
    fn a_private_file_stays_private() {
        let folder = Folder::new();
        fs::write(folder.join("a.png"), "").unwrap();
        fs::set_permissions(folder.join("a.png"), PermissionsExt::from_mode(0o600)).unwrap();
        write(&picture(0..2), &folder.join("a.png"));
        assert_eq!(mode(&folder.join("a.png")), 0o600);
    }

    #[test]
    fn links_are_followed() {
        let folder = Folder::new();
        fs::create_dir(folder.join("sub")).unwrap();
        fs::write(folder.join("sub/file"), "old").unwrap();
        symlink("sub/file", folder.join("link.png")).unwrap();
        symlink("sub/new", folder.join("dangling.exr")).unwrap();
        symlink("loop.png", folder.join("loop.png")).unwrap();
        for link in ["link.png", "dangling.exr"] {
            write(&picture(0..2), &folder.join(link));
            assert!(folder.join(link).is_symlink());
        }
        assert!(read_record(folder.join("sub/file")).is_ok());
        assert!(read_exr(folder.join("sub/new")).is_ok());
        assert_eq!(fs::read_dir(folder.join("sub")).unwrap().count(), 2);
        assert!(matches!(
            Target::prepare(folder.join("loop.png")),
            Err(Error::Create { .. })
        ));
        let same = [folder.join("link.png"), folder.join("sub/file.png")];
        symlink("file", folder.join("sub/file.png")).unwrap();
        assert!(matches!(Target::prepare_all(&same), Err(Error::Usage(_))));
    }

    #[test]
    fn odd_names_are_names() {
        let folder = Folder::new();
        for name in [&b"a\nb.exr"[..], b"\xff\xfe.exr", b" .exr", b"-o.exr"] {
            let path = folder.join(OsStr::from_bytes(name));
            write(&picture(0..2), &path);
            assert!(read_exr(&path).is_ok());
        }
        let longest = folder.join(format!("{}.exr", "n".repeat(251)));
        write(&picture(0..2), &longest);
        assert!(read_exr(&longest).is_ok());
    }

    /// Prepares a device as target. A file beside it would be put in the device's place next, which
    /// must not happen to the machine that runs the tests: it is looked for first, with a name and without.
    fn device(path: &Path) -> Target {
        let target = Target::prepare(path).unwrap();
        let temporary = |entry: std::io::Result<fs::DirEntry>| {
            entry.is_ok_and(|entry| entry.file_name().as_bytes().starts_with(b".lampray"))
        };
        for folder in [Path::new("/dev"), path.parent().unwrap()] {
            assert!(!fs::read_dir(folder).unwrap().any(temporary));
        }
        assert!(target.is_stream());
        target
    }

    #[test]
    fn devices_are_written_into() {
        let folder = Folder::new();
        symlink("/dev/null", folder.join("null.exr")).unwrap();
        for path in [Path::new("/dev/null"), &folder.join("null.exr")] {
            device(path).write(&picture(0..2)).unwrap();
        }
        assert!(
            fs::metadata("/dev/null")
                .unwrap()
                .file_type()
                .is_char_device()
        );
        assert!(folder.join("null.exr").is_symlink());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_a_failure() {
        let folder = Folder::new();
        symlink("/dev/full", folder.join("full.png")).unwrap();
        let outcome = Target::prepare(folder.join("full.png"))
            .unwrap()
            .write(&picture(0..2));
        assert!(matches!(outcome, Err(Error::Stream { .. })));
        assert_eq!(folder.names(), ["full.png"]);
    }

    /// Preparing must not wait for the reader that a pipe does not have yet.
    #[test]
    fn pipes_are_written_into() {
        let folder = Folder::new();
        let pipe = folder.join("pipe.exr");
        let made = std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap();
        assert!(made.success());
        let target = Target::prepare(&pipe).unwrap();
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || read_exr(pipe)
        });
        target.write(&picture(0..2)).unwrap();
        assert_eq!(reader.join().unwrap().unwrap(), picture(0..2));
        assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    }
}
