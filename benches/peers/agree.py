"""Do the pictures agree, how wrong is each, and what do repeated times say?"""

import numpy as np

TILES = 8
# Of 3 channels and of 3 x 64 tiles in a handful of cases nobody should see one by chance; tiles have
# rare bright paths in them, so theirs is wide.
MOST_Z, MOST_TILE_Z = 4.5, 8.0


def median(values):
    return float(np.median(values))


def spread(values):
    low, high = np.quantile(values, [0.25, 0.75])
    return f"[{digits(low)} .. {digits(high)}]"


def digits(value):
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def squared_error(pixels, reference):
    """Mean squared error of a picture, without the reference's own noise; linear light, mean of channels."""
    squares = (pixels - reference["pixels"]) ** 2
    return float(np.mean(squares - reference["variance"]))


def tiles(values):
    """Sums over TILES x TILES parts of a picture."""
    height, width, channels = values.shape
    parts = values.reshape(TILES, height // TILES, TILES, width // TILES, channels)
    return parts.sum(axis=(1, 3))


def disagreement(pictures, reference):
    """The largest z of the picture's mean and of its tiles, between the mean of some pictures and a reference.

    The noise of the pictures is read from how they differ from the reference, pixel by pixel, so that a
    program need not state it; pixels are independent.
    """
    count = len(pictures)
    mean = np.mean(pictures, axis=0)
    noise = np.mean([(picture - reference["pixels"]) ** 2 for picture in pictures], axis=0) / count
    noise += reference["variance"]
    apart = mean - reference["pixels"]
    whole = apart.sum(axis=(0, 1)) / np.sqrt(noise.sum(axis=(0, 1)))
    parts = tiles(apart) / np.sqrt(tiles(noise))
    return float(np.abs(whole).max()), float(np.abs(parts).max())
