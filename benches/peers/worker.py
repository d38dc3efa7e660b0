"""One variant of Mitsuba, kept warm: answers each line of its input with one of its output.

    worker.py VARIANT THREADS [avx2]

With `avx2` Dr.Jit compiles its LLVM variants for AVX2, in 8 lanes, whatever more the processor has.

A line is JSON: scene, width, height, samples, seed, picture (where to put the pixels, .npy). The answer holds
seconds: the render until its pixels are there, without loading the scene, and without compiling, which the first render
of a scene (its answer is to be thrown away) has paid for.
"""

import ctypes
import json
import sys
import time
from pathlib import Path

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


def compile_for_avx2():
    """By a function of Dr.Jit's core that its Python module does not show: target, features, lanes."""
    core = ctypes.CDLL(str(Path(dr.__file__).parent / "libdrjit-core.so"))
    core._Z19jit_llvm_set_targetPKcS0_j(b"haswell", b"+avx2,+fma,+f16c,+bmi,+bmi2,+popcnt", ctypes.c_uint(8))
    if core._Z21jit_llvm_vector_widthv() != 8:
        sys.exit("Dr.Jit did not take 8 lanes")


def main():
    variant, threads = sys.argv[1], int(sys.argv[2])
    mi.set_variant(variant)
    dr.set_thread_count(threads)
    if sys.argv[3:] == ["avx2"]:
        compile_for_avx2()
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
