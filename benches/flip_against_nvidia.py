"""FLIP at 1920x1080, lampray against NVIDIA's own tool, one run of each in turn.

    pip install flip-evaluator==1.7 numpy
    python benches/flip_against_nvidia.py [runs]

Only the calls are timed: flip_evaluator.evaluate, which uses all cores, and what benches/flip.rs
times. Prints the medians, their ratio and the two means.
"""

import statistics
import subprocess
import sys
import time

import flip_evaluator
import numpy as np

WIDTH, HEIGHT = 1920, 1080
ALLOWED = 1.5


def picture(noise):
    """As in benches/flip.rs."""
    y, x, c = np.meshgrid(np.arange(HEIGHT), np.arange(WIDTH), np.arange(3), indexing="ij")
    grain = (x * 73 + y * 151 + c * 199 + x * y % 251) % 256
    ramp = (x // 9 + y // 12 + 40 * c) % 256
    return ((ramp * (256 - noise) + grain * noise) / 65536).astype(np.float32)


def theirs(kind, reference, test):
    start = time.perf_counter()
    values = flip_evaluator.evaluate(reference, test, kind.upper(), applyMagma=False)[0]
    seconds = time.perf_counter() - start
    # The tool's own mean is a sum of two million f32, and off by 2e-4.
    return seconds, float(values[..., 0].mean(dtype=np.float64))


def ours(kind, bench):
    bench.stdin.write(kind + "\n")
    bench.stdin.flush()
    seconds, mean = bench.stdout.readline().split()
    return float(seconds), float(mean)


def main():
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 9
    command = ["cargo", "bench", "-q", "--bench", "flip", "--", "--serve"]
    pipe = subprocess.PIPE
    bench = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)
    reference, test = picture(16), picture(64)
    slow = False
    for kind in ("ldr", "hdr"):
        ours(kind, bench), theirs(kind, reference, test)
        pairs = [(ours(kind, bench), theirs(kind, reference, test)) for _ in range(runs)]
        medians = [statistics.median(run[who][0] for run in pairs) for who in (0, 1)]
        ratio = medians[0] / medians[1]
        slow |= ratio > ALLOWED
        print(
            f"{kind}: lampray {medians[0]:.3f} s, NVIDIA {medians[1]:.3f} s, ratio {ratio:.2f}; "
            f"means {pairs[0][0][1]:.6f} and {pairs[0][1][1]:.6f}"
        )
    bench.stdin.close()
    bench.wait()
    sys.exit(slow)


if __name__ == "__main__":
    main()
