//! Moments, image files of lampray's and of other programs, records, outputs, and hostile inputs.

mod film {
    mod bombs;
    mod craft;
    mod curve;
    mod damage;
    mod files;
    mod foreign;
    mod foreign_png;
    mod hostile;
    mod moments;
    mod output;
    mod randomisations;
    mod relative;
    mod sample;
}
