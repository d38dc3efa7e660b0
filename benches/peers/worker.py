"""One variant of Mitsuba, kept warm: answers each line of its input with one of its output.

    worker.py VARIANT THREADS

A line is JSON: scene, width, height, samples, seed, picture (where to put the pixels, .npy). The answer holds
seconds: the render until its pixels are there, without loading the scene, and without compiling, which the first render
of a scene (its answer is to be thrown away) has paid for.
"""

import json
import sys
import time

import drjit as dr
import mitsuba as mi
import numpy as np

from convert import read, to_mitsuba


def render(scene, task):
    start = time.perf_counter()
    image = mi.render(scene, spp=task["samples"], seed=task["seed"])
    if not mi.variant().startswith("scalar"):
        dr.eval(image)
        dr.sync_thread()
    pixels = np.array(image)
    return pixels, time.perf_counter() - start


def main():
    variant, threads = sys.argv[1], int(sys.argv[2])
    mi.set_variant(variant)
    dr.set_thread_count(threads)
    mi.set_log_level(mi.LogLevel.Error)
    loaded = {}
    for line in sys.stdin:
        task = json.loads(line)
        key = (task["scene"], task["width"], task["height"])
        if key not in loaded:
            # One at a time: memory is for the others too.
            loaded.clear()
            loaded[key] = mi.load_dict(to_mitsuba(mi, read(task["scene"]), task["width"], task["height"]))
        pixels, seconds = render(loaded[key], task)
        np.save(task["picture"], pixels)
        print(json.dumps({"seconds": seconds}), flush=True)


main()
