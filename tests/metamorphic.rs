//! What must not change, or must change in a known way, when a scene does: no reference is needed.
//!
//! The relations are those of Segura et al., "A Survey on Metamorphic Testing" (2016), of the kinds
//! that light obeys: it is linear in what shines, its colours do not mix, it knows no unit of length
//! and no order of bodies. Where a relation holds for every sample, films must be equal bit for bit;
//! where it holds for means alone, within 4 standard errors at a standard error of 0.3 % or less.
//!
//! Bit equality follows from IEEE arithmetic and was seen on the twin and on lavapipe (Mesa 22.3.6).
//! WGSL does not promise all of it: its divisions and roots may be off by units in the last place that
//! need not be the same at every power of two.

mod support;

mod metamorphic {
    mod colour;
    mod gloss;
    mod lamps;
    mod length;
    mod order;
    mod room;
}
