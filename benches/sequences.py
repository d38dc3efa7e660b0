"""Error against samples under each render.sequence, with the fitted exponent.

    cargo build --release
    python3 benches/sequences.py [LAMPRAY [SIZE [PAIRS [DEVICE [SEQUENCES]]]]]

Renders scenes/cornell.toml at SIZE x SIZE pixels (48) with 32, 128, 512, 2048 and 8192 samples, PAIRS times (4)
with two seeds each. Half the mean squared difference of two renders that share nothing is the mean squared error
of one, whatever the truth is: no reference is needed. The exponent is the slope of log RMSE by log samples, fitted to
each pair by least squares; its 95 % interval is Student's over the pairs.

Two rooms: all of light transport, and direct light alone (render.max_bounces = 1), which has fewer dimensions. Two
cuts: 8 randomisations, the default, and 2, the fewest.
"""

import json
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

SAMPLES = [32, 128, 512, 2048, 8192]
SEQUENCES = ["independent", "stratified", "sobol", "blue-noise"]
ROOMS = {"all light": [], "direct light": ["render.max_bounces=1"]}
# Two-sided 95 % of Student's t, by degrees of freedom.
STUDENT = [math.nan, 12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365]


def render(lampray, device, size, samples, seed, knobs, out):
    scene = Path(__file__).parent.parent / "scenes" / "cornell.toml"
    command = [lampray, "-q", "render", scene, "--width", size, "--height", size, "--spp", samples, "--seed", seed]
    command += ["--device", device, "-o", out]
    for knob in knobs:
        command += ["--set", knob]
    subprocess.run([str(word) for word in command], check=True)


def squared_error(lampray, a, b):
    """Of one of two pictures of the same expected image that share no numbers."""
    done = subprocess.run([lampray, "diff", a, b, "--json"], capture_output=True, text=True)
    figures = {figure["metric"]: figure["value"] for figure in json.loads(done.stdout)["figures"]}
    return figures["mse"] / 2


def slope(samples, errors):
    x, y = [math.log(n) for n in samples], [math.log(e) for e in errors]
    return statistics.linear_regression(x, y).slope


def study(lampray, device, size, pairs, knobs):
    """Root mean squared error by samples, and the exponents of the pairs."""
    errors = []
    with tempfile.TemporaryDirectory() as folder:
        files = [str(Path(folder) / name) for name in ("a.exr", "b.exr")]
        for pair in range(pairs):
            errors.append([])
            for place, samples in enumerate(SAMPLES):
                for side, out in enumerate(files):
                    seed = 1000 * pair + 10 * place + side + 1
                    render(lampray, device, size, samples, seed, knobs, out)
                errors[-1].append(squared_error(lampray, *files))
    means = [math.sqrt(statistics.mean(column)) for column in zip(*errors)]
    return means, [slope(SAMPLES, [math.sqrt(e) for e in row]) for row in errors]


def main():
    given = dict(enumerate(sys.argv[1:]))
    lampray = given.get(0, "target/release/lampray")
    size, pairs = int(given.get(1, 48)), int(given.get(2, 4))
    device = given.get(3, "auto")
    sequences = given.get(4, ",".join(SEQUENCES)).split(",")
    heads = " | ".join(f"RMSE at {samples}" for samples in SAMPLES)
    print(f"| light | sequence | randomisations | {heads} | exponent |")
    print("|---" * (4 + len(SAMPLES)) + "|")
    for room, knobs in ROOMS.items():
        for sequence in sequences:
            for cut in ["-"] if sequence == "independent" else [8, 2]:
                sets = [f"render.sequence={sequence}"] + knobs
                sets += [] if cut == "-" else [f"render.randomisations={cut}"]
                means, slopes = study(lampray, device, size, pairs, sets)
                spread = STUDENT[pairs - 1] * statistics.stdev(slopes) / math.sqrt(pairs)
                cells = " | ".join(f"{error:.5f}" for error in means)
                exponent = f"{statistics.mean(slopes):.3f} +- {spread:.3f}"
                print(f"| {room} | {sequence} | {cut} | {cells} | {exponent} |", flush=True)


main()
