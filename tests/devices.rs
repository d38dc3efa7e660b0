//! Choosing a device: what users may ask for, and what they are told when it is not there.

mod support;

use lampray::Error;
use lampray::device::{DeviceInfo, DeviceKind, DeviceRequest};
use lampray::render::{VULKAN_HINT, devices, open};
use std::process::{Command, Output};

fn request(text: &str) -> DeviceRequest {
    text.parse().unwrap()
}

#[test]
fn requests_are_read() {
    let read = [
        ("auto", DeviceRequest::Auto),
        ("cpu", DeviceRequest::Cpu),
        ("gpu", DeviceRequest::Hardware),
        ("hardware", DeviceRequest::Hardware),
        ("software", DeviceRequest::Software),
        ("0", DeviceRequest::Index(0)),
        ("12", DeviceRequest::Index(12)),
        ("-1", DeviceRequest::Name("-1".into())),
        ("GeForce RTX", DeviceRequest::Name("GeForce RTX".into())),
        ("CPU", DeviceRequest::Cpu),
        (
            "pci:0000:65:00.0",
            DeviceRequest::Pci("0000:65:00.0".into()),
        ),
        (
            "pci:0000:AF:00.0",
            DeviceRequest::Pci("0000:af:00.0".into()),
        ),
    ];
    for (text, wanted) in read {
        assert_eq!(request(text), wanted, "{text}");
    }
    for nothing in ["", "pci:"] {
        let refused = nothing.parse::<DeviceRequest>().unwrap_err();
        assert!(matches!(refused, Error::Usage(_)), "{refused}");
    }
}

/// The message of a request that cannot be met: one line that names all that there is.
fn refusal(request: &DeviceRequest, require: Option<DeviceKind>) -> String {
    let Err(Error::Device(text)) = open(request, require) else {
        panic!("{request:?} with {require:?} was not refused as a device");
    };
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

#[test]
fn what_is_missing_is_said_with_what_is_there() {
    for (text, named) in [
        ("99", "no device 99"),
        ("No Such Card", "\"No Such Card\""),
        ("pci:ffff:ff:1f.7", "ffff:ff:1f.7"),
    ] {
        let message = refusal(&request(text), None);
        assert!(message.contains(named), "{message}");
        for info in devices() {
            assert!(
                message.contains(&info.name),
                "{message} does not name {}",
                info.name
            );
        }
    }
}

/// The kinds of graphics device that this machine lacks.
#[test]
fn a_kind_that_is_missing_is_refused() {
    for (kind, text) in [
        (DeviceKind::Hardware, "gpu"),
        (DeviceKind::Software, "software"),
    ] {
        if devices().iter().any(|info| info.kind == kind) {
            continue;
        }
        let message = refusal(&request(text), None);
        assert!(
            message.contains("no ") && message.contains("there are:"),
            "{message}"
        );
        refusal(&DeviceRequest::Auto, Some(kind));
    }
}

#[test]
fn what_is_required_and_not_met_is_refused() {
    let message = refusal(&DeviceRequest::Cpu, Some(DeviceKind::Hardware));
    assert!(message.contains("--require hardware"), "{message}");
    assert!(message.contains("built-in CPU renderer"), "{message}");
    refusal(&DeviceRequest::Cpu, Some(DeviceKind::Software));
    assert!(open(&DeviceRequest::Cpu, Some(DeviceKind::Cpu)).is_ok());
}

fn opened(request: &DeviceRequest) -> DeviceInfo {
    open(request, None).unwrap().device.info().clone()
}

#[test]
fn the_twin_can_be_asked_for_in_every_way() {
    let all = devices();
    let last = all.len() - 1;
    assert_eq!(all[last].kind, DeviceKind::Cpu);
    assert_eq!(opened(&DeviceRequest::Index(last)), all[last]);
    assert_eq!(opened(&DeviceRequest::Cpu), all[last]);
}

#[test]
fn a_graphics_device_is_found_by_number_name_and_address() {
    // Held while others are opened, so that a machine without one says so, or fails.
    let Some(_gpu) = support::gpu("choosing a graphics device") else {
        return;
    };
    let first = devices()[0].clone();
    assert_eq!(opened(&DeviceRequest::Index(0)), first);
    let part = first.name[..first.name.len() / 2].to_uppercase();
    assert_eq!(opened(&request(&part)), first);
    if !first.pci.is_empty() {
        assert_eq!(opened(&DeviceRequest::Pci(first.pci.clone())), first);
    }
    let auto = open(&DeviceRequest::Auto, None).unwrap();
    assert_eq!(*auto.device.info(), first);
    // Software is announced, hardware needs no word.
    assert_eq!(auto.remark.is_some(), first.kind == DeviceKind::Software);
}

const SCENE: &str = "version = 1\n[camera]\nposition = [0.0, 0.0, 0.0]\nlook_at = [0.0, 0.0, -1.0]\nfov = 40.0\n\
    [image]\nwidth = 4\nheight = 4\n[render]\nsamples = 1\n[background]\nemission = [1.0, 1.0, 1.0]\n\
    [materials.white]\nalbedo = [0.5, 0.5, 0.5]\n[[spheres]]\ncenter = [0.0, 0.0, -4.0]\nradius = 1.0\nmaterial = \"white\"\n";

/// Runs the program where no graphics driver can be found.
fn without_drivers(arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    Command::new(env!("CARGO_BIN_EXE_lampray"))
        .args(arguments)
        .current_dir(&folder)
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// On other systems graphics devices come without the files that these tests hide.
#[cfg(target_os = "linux")]
mod without_vulkan {
    use super::*;

    #[test]
    fn rendering_falls_back_and_says_so_once() {
        let output = without_drivers(&["render", "scene.toml", "--json"]);
        let (notes, record) = (text(&output.stderr), text(&output.stdout));
        assert_eq!(output.status.code(), Some(0), "{notes}");
        let about: Vec<_> = notes
            .lines()
            .filter(|line| line.contains("Vulkan"))
            .collect();
        assert_eq!(about.len(), 1, "{notes}");
        assert!(
            about[0].contains("mesa-vulkan-drivers") && about[0].contains("CPU"),
            "{notes}"
        );
        let record: serde_json::Value = serde_json::from_str(&record).unwrap();
        assert_eq!(record["device"]["kind"], "cpu");
    }

    #[test]
    fn quiet_is_quiet() {
        let output = without_drivers(&["render", "scene.toml", "-q"]);
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(text(&output.stderr), "");
    }

    #[test]
    fn what_must_be_there_and_is_not_exits_with_69() {
        for arguments in [
            &["render", "scene.toml", "--device", "software"][..],
            &["render", "scene.toml", "--device", "gpu"],
            &["render", "scene.toml", "--require", "software"],
            &["render", "scene.toml", "--require", "hardware"],
            &["render", "scene.toml", "--device", "7"],
        ] {
            let output = without_drivers(arguments);
            let notes = text(&output.stderr);
            assert_eq!(output.status.code(), Some(69), "{arguments:?}: {notes}");
            assert_eq!(notes.lines().count(), 1, "{arguments:?}: {notes}");
            assert!(
                notes.contains("built-in CPU renderer"),
                "{arguments:?}: {notes}"
            );
        }
        let output = without_drivers(&["render", "scene.toml", "--device", "software"]);
        assert!(text(&output.stderr).contains(VULKAN_HINT));
    }

    #[test]
    fn the_list_names_the_package() {
        let output = without_drivers(&["devices"]);
        let list = text(&output.stdout);
        assert_eq!(output.status.code(), Some(0));
        assert!(
            list.contains("built-in CPU renderer") && list.contains("mesa-vulkan-drivers"),
            "{list}"
        );
    }
}

#[test]
fn wrong_arguments_exit_with_2() {
    for arguments in [
        &["render", "scene.toml", "--device", ""][..],
        &["render", "scene.toml", "--require", "fast"],
    ] {
        let output = without_drivers(arguments);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            text(&output.stderr)
        );
    }
}
