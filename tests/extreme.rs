//! Scenes and options at the ends of what is legal, and one step beyond: each is rendered right or refused
//! with a reason.

mod support;

mod extreme {
    mod closed;
    mod far;
    mod lamps;
    mod limits;
    mod program;
    mod ranges;
    mod sizes;
    mod sweeps;
}
