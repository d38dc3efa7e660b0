//! `lampray diff` as scripts meet it: exit codes, JSON, maps, references, and pictures from strangers.

mod diff {
    #[path = "../film/craft.rs"]
    #[allow(dead_code, reason = "the tests of the reader use all of it")]
    mod craft;
    mod hostile;
    mod limits;
    mod outcome;
    mod references;
    mod run;
}
