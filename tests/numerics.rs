//! What rounding must not do: surfaces that shadow or light themselves, closed boxes that leak,
//! distances that lose their digits, and samples that are not numbers.

mod support;

mod numerics {
    mod bodies;
    mod closed;
    mod far;
    mod finite;
    mod self_hits;
}
