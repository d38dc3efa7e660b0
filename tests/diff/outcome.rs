//! What decides, and how it is said.

use super::run::{diff, folder, json};
use std::fs;

#[test]
fn the_verdict_is_the_exit_code() {
    let darker: &[&str] = &["materials.white.albedo=[0.6, 0.5, 0.4]"];
    let folder = folder(&[
        ("a.exr", 512, 1, &[]),
        ("b.exr", 512, 2, &[]),
        ("darker.exr", 512, 3, darker),
        ("few.exr", 4, 4, &[]),
    ]);
    let at = folder.path();
    let (code, same) = json(at, &["a.exr", "b.exr"]);
    assert_eq!((code, &same["conclusion"]), (0, &"same".into()));
    assert_eq!(same["verdict"]["outcome"], "same");
    assert!(
        same["verdict"]["supported_margin"]
            .as_f64()
            .is_some_and(|margin| margin < 0.01)
    );
    let (code, different) = json(at, &["a.exr", "darker.exr"]);
    assert_eq!((code, &different["conclusion"]), (1, &"different".into()));
    assert_eq!(
        different["kinship"]["knobs"][0]["knob"],
        "materials.white.albedo"
    );
    let (code, unsure) = json(at, &["a.exr", "few.exr"]);
    assert_eq!(
        (code, &unsure["conclusion"]),
        (3, &"not-enough-samples".into())
    );
    assert!(
        unsure["verdict"]["needed"]["test"]
            .as_u64()
            .is_some_and(|n| n > 4)
    );
    // In words, too.
    let (_, words, _) = diff(at, &["a.exr", "b.exr"]);
    assert!(words.contains("verdict: same expected image"), "{words}");
    let (_, words, _) = diff(at, &["a.exr", "darker.exr"]);
    assert!(
        words.contains("verdict: different") && words.contains(" ± "),
        "{words}"
    );
    let (_, words, _) = diff(at, &["a.exr", "few.exr"]);
    assert!(
        words.contains("not enough samples to tell") && words.contains("about "),
        "{words}"
    );
    // A wide margin is enough for few samples; alpha and tolerance move the verdict as well.
    assert_eq!(diff(at, &["a.exr", "few.exr", "--margin", "0.5"]).0, 0);
    assert_eq!(
        diff(at, &["a.exr", "darker.exr", "--tolerance", "0.9"]).0,
        3
    );
}

#[test]
fn records_say_which_pictures_are_paired_and_what_else_differs() {
    let one: &[&str] = &["materials.white.albedo=[0.71, 0.6, 0.5]"];
    let two: &[&str] = &[
        "materials.white.albedo=[0.71, 0.6, 0.5]",
        "light.strategy=sample",
    ];
    let folder = folder(&[
        ("a.exr", 16, 1, &[]),
        ("one.exr", 16, 1, one),
        ("two.exr", 16, 1, two),
        ("later.exr", 16, 2, two),
    ]);
    let at = folder.path();
    let (code, paired) = json(at, &["a.exr", "one.exr"]);
    assert_eq!((code, &paired["verdict"]["paired"]), (1, &true.into()));
    assert_eq!(paired["kinship"]["mixed"], false);
    let (_, mixed) = json(at, &["a.exr", "two.exr"]);
    assert_eq!(mixed["kinship"]["mixed"], true);
    let (_, words, _) = diff(at, &["a.exr", "two.exr"]);
    assert!(
        words.contains("warning: more differs than one knob"),
        "{words}"
    );
    assert!(
        words.contains("knob light.strategy: \"mis\" -> \"sample\""),
        "{words}"
    );
    let (_, independent) = json(at, &["a.exr", "later.exr"]);
    assert_eq!(independent["verdict"]["paired"], false);
    // The same samples: nothing differs at all.
    let (code, same) = json(at, &["a.exr", "a.exr"]);
    assert_eq!((code, &same["identical"]), (0, &true.into()));
}

#[test]
fn what_is_not_a_pair_of_pictures_is_trouble() {
    let folder = folder(&[
        ("a.exr", 4, 1, &[]),
        ("wide.png", 4, 1, &["image.width=40"]),
    ]);
    let at = folder.path();
    fs::write(at.join("empty.png"), "").expect("a file");
    for (a, b, words) in [
        ("s.toml", "s.toml", "neither"),
        ("a.exr", "none.exr", "cannot read"),
        ("a.exr", "empty.png", "neither"),
        ("a.exr", "wide.png", "only pictures of one size"),
        ("a.exr", ".", "cannot read"),
    ] {
        let (code, _, message) = diff(at, &[a, b]);
        assert_eq!(code, 2, "{a} {b}: {message}");
        assert!(message.contains(words), "{a} {b}: {message}");
    }
    assert_eq!(diff(at, &["a.exr"]).0, 2);
    assert_eq!(diff(at, &[]).0, 2);
}

/// One sample has no variance: nothing can be said yet, which is not to say that they differ.
#[test]
fn one_sample_a_pixel_is_not_enough() {
    let folder = folder(&[("a.exr", 1, 1, &[]), ("b.exr", 1, 2, &[])]);
    let (code, unsure) = json(folder.path(), &["a.exr", "b.exr"]);
    assert_eq!(
        (code, &unsure["conclusion"]),
        (3, &"not-enough-samples".into())
    );
    assert!(
        unsure["no_verdict"]
            .as_str()
            .is_some_and(|reason| reason.contains("2 samples"))
    );
}

/// The default seed is the same for all, so two strategies compared without a thought are paired.
#[test]
fn two_strategies_of_one_seed_are_the_same_image() {
    let hits: &[&str] = &["light.strategy=hit"];
    let folder = folder(&[("both.exr", 8, 0, &[]), ("hits.exr", 8, 0, hits)]);
    let (code, paired) = json(folder.path(), &["both.exr", "hits.exr"]);
    assert_eq!(paired["kinship"]["same_estimator"], false);
    assert!(code == 0 || code == 3, "{}", paired["verdict"]);
}

/// Of an edited scene file nobody can say whether more was changed than the knob that shows.
#[test]
fn a_changed_scene_file_is_named() {
    let folder = folder(&[("a.exr", 4, 1, &[])]);
    let at = folder.path();
    let text = std::fs::read_to_string(at.join("s.toml")).expect("the scene");
    std::fs::write(
        at.join("s.toml"),
        text.replace("9.0, 9.0, 9.0", "8.0, 8.0, 8.0"),
    )
    .expect("a scene");
    let render = [
        "render", "s.toml", "-q", "--device", "cpu", "-s", "4", "-o", "b.exr",
    ];
    assert!(super::run::lampray(at, &render).status.success());
    let (_, words, _) = diff(at, &["a.exr", "b.exr"]);
    assert!(words.contains("knob materials.lamp.emission"), "{words}");
    assert!(
        words.contains("scene text: differs") && !words.contains("warning"),
        "{words}"
    );
}
