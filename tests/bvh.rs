//! The tree of bodies and the kernel that walks it: nothing is lost on the way, and what it finds is
//! what trying every body finds, bit for bit.

mod support;

mod bvh {
    mod crowds;
    mod hits;
    mod large;
    mod pictures;
    mod shape;
}
