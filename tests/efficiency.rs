//! Interruption by efficiency beside its mean and variance, which `closed_forms` and `estimators` hold.
//!
//! | file | what is held |
//! |---|---|
//! | `pilot` | what a pilot finds depends on scene, knobs and seed alone |
//! | `same` | the bits of a picture do not depend on how the work is split, stopped and resumed, nor on how rays find bodies |
//! | `bounds` | scenes in which paths could split or go on without end |

mod support;

mod efficiency {
    mod bounds;
    mod pilot;
    mod same;
}
