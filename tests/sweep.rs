//! `lampray sweep` as scripts meet it: which runs are made, which are made again, what a kill, a second
//! process or a run that cannot be made leaves behind, and what the runs are held against.

mod sweep {
    mod bench;
    mod checks;
    mod expected;
    mod references;
    mod runs;
    mod told;
}
