#!/usr/bin/env python3
"""MSE and RMSE of two 4K PNGs by `lampray diff`, beside npm's odiff-bin, in turns in one run.

    cargo build --release
    npm install --prefix /tmp/odiff odiff-bin@4.5.0
    python3 benches/diff_against_odiff.py /tmp/odiff/node_modules/.bin/odiff [REPEATS]

Both are whole processes that read two files of 3840 x 2160 and write no picture; odiff counts
pixels by colour distance, lampray sums squared errors in linear light. The pictures are rendered
here; with Pillow they are measured as written by it, too (zlib at level 6). Prints medians and their
ratio; exit code 1 if lampray is slower.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LAMPRAY = ROOT / "target/release/lampray"


def render(folder):
    files = []
    for seed in (1, 2):
        file = folder / f"{seed}.png"
        subprocess.run(
            [LAMPRAY, "render", ROOT / "scenes/cornell.toml", "--width", "3840", "--height", "2160",
             "--spp", "4", "--seed", str(seed), "-q", "-o", file],
            check=True,
        )
        files.append(file)
    return files


def by_pillow(files):
    try:
        from PIL import Image
    except ImportError:
        return None
    copies = []
    for file in files:
        copy = file.with_name("pillow-" + file.name)
        Image.open(file).convert("RGB").save(copy, compress_level=6)
        copies.append(copy)
    return copies


def seconds(command):
    start = time.perf_counter()
    subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    return time.perf_counter() - start


def measure(name, files, odiff, repeats):
    ours = [LAMPRAY, "diff", *files, "--metric", "mse", "--metric", "rmse"]
    theirs = [odiff, *files]
    times = {"lampray": [], "odiff": []}
    for command in (ours, theirs):
        seconds(command)
    for _ in range(repeats):
        times["lampray"].append(seconds(ours))
        times["odiff"].append(seconds(theirs))
    lampray, other = (statistics.median(times[who]) for who in ("lampray", "odiff"))
    size = sum(file.stat().st_size for file in files) / 1e6
    print(f"{name} ({size:.1f} MB): lampray {lampray:.3f} s, odiff {other:.3f} s, ratio {lampray / other:.2f}")
    return lampray <= other


def main():
    odiff = sys.argv[1]
    repeats = int(sys.argv[2]) if len(sys.argv) > 2 else 9
    with tempfile.TemporaryDirectory() as folder:
        files = render(Path(folder))
        faster = [measure("written by lampray", files, odiff, repeats)]
        copies = by_pillow(files)
        if copies:
            faster.append(measure("written by Pillow", copies, odiff, repeats))
    sys.exit(0 if all(faster) else 1)


main()
