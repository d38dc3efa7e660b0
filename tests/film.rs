//! Moments, image files and their records, outputs, and hostile inputs.

mod film {
    mod curve;
    mod files;
    mod hostile;
    mod moments;
    mod output;
    mod sample;
}
