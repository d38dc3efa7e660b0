//! FLIP, SSIM and MS-SSIM against other programs, and where those have no answer.

mod perceptual {
    mod edges;
    mod flip;
    mod pictures;
    mod similarity;
}
