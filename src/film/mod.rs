//! Sums of samples, and the files made of them.
