"""Measures lampray beside Mitsuba 3; `run` makes ready what it needs and starts it.

Of each case all programs take turns (A B C, then C B A) with a new seed each; a first turn, in which
Mitsuba compiles, is thrown away. Printed are medians with the middle half, and ratios lampray : Mitsuba as medians of
each turn's own ratio. A ratio at equal samples is that of paths a second; at equal error, that of
1 / (MSE x time), with the MSE against lampray's `reference` of many samples, whose noise is taken out. Before
any time is printed the means must agree: lampray's and Mitsuba's against that reference, whole and by tiles.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba

mitsuba.set_variant("scalar_rgb")

from agree import MOST_TILE_Z, MOST_Z, digits, disagreement, median, spread, squared_error
from programs import LAMPRAY, ROOT, THREADS, Cannot, Lampray, Mitsuba

VARIANTS = ["llvm_ad_rgb", "scalar_rgb"]


def cases(quick):
    """Name, scene, lampray's settings, side of the picture, samples a pixel."""
    side = 64 if quick else 256
    samples = 16 if quick else 64
    rooms = [("room-1000", "1000", 32 if quick else 128), ("room-10000", "10000", 16 if quick else 64)]
    sample = ["light.strategy=sample"]
    made = [("cornell", "cornell", [], side, samples), ("cornell-sample", "cornell", sample, side, samples)]
    made += [(name, spheres, [], small, 16) for name, spheres, small in rooms]
    return made


def scene_file(what, folder):
    """The Cornell box with its directional ball made diffuse, which Mitsuba can do exactly, or a room."""
    file = folder / f"{what}.toml"
    if what == "cornell":
        text = (ROOT / "scenes/cornell.toml").read_text()
        text, changed = re.subn('scatter = "directional"', 'scatter = "diffuse"', text)
        assert changed == 1, "scenes/cornell.toml has one directional material"
    else:
        printed = subprocess.run([LAMPRAY, "bench", "--print-room", what], check=True, capture_output=True, text=True)
        text = printed.stdout
    file.write_text(text)
    return str(file)


def reference(task, programs, factor):
    """By the last of lampray's devices, in its preset `reference`, of a seed of its own."""
    last = [program for program in programs if isinstance(program, Lampray)][-1]
    return last.render(task | {"samples": task["samples"] * factor, "seed": 999_983, "settings": []})


def take_turns(task, programs, repeats):
    """What each program rendered, turn by turn; a program that cannot render the scene is said so and left out."""
    found = {program.name: [] for program in programs}
    for turn in range(repeats + 1):
        for program in programs if turn % 2 == 0 else reversed(programs):
            if program.name not in found:
                continue
            try:
                made = program.render(task | {"seed": 1 + turn})
            except Cannot as reason:
                del found[program.name]
                print(f"  {program.name:<28} cannot: {reason}")
                continue
            if turn:
                found[program.name].append(made)
            print(".", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return found


def judge(name, found, truth):
    """Whether all programs see the reference's picture; says how far off each is."""
    fair = True
    for program, renders in found.items():
        whole, tile = disagreement([render["pixels"] for render in renders], truth)
        wrong = whole > MOST_Z or tile > MOST_TILE_Z
        fair &= not wrong
        word = "DISAGREES" if wrong else "agrees"
        print(f"  {program:<28} {word} with the reference: largest z {whole:.1f} of the mean, {tile:.1f} of 8 x 8 tiles")
    return fair


def show(found, truth, paths):
    """Speeds and errors of each program, then lampray's ratios to each of Mitsuba's variants."""
    speeds, gains = {}, {}
    print(f"  {'program':<28} {'Msamples/s':>10} {'[middle half]':>18} {'MSE':>10} {'1/(MSE x s)':>12}")
    for program, renders in found.items():
        speeds[program] = [paths / render["seconds"] / 1e6 for render in renders]
        errors = [squared_error(render["pixels"], truth) for render in renders]
        gains[program] = [1 / (error * render["seconds"]) for error, render in zip(errors, renders)]
        row = [digits(median(speeds[program])), spread(speeds[program]), f"{median(errors):.3e}", digits(median(gains[program]))]
        print(f"  {program:<28} {row[0]:>10} {row[1]:>18} {row[2]:>10} {row[3]:>12}")
    for ours in (name for name in found if name.startswith("lampray")):
        for theirs in (name for name in found if name.startswith("mitsuba")):
            samples = [a / b for a, b in zip(speeds[ours], speeds[theirs])]
            errors = [a / b for a, b in zip(gains[ours], gains[theirs])]
            print(
                f"  {ours} : {theirs}   equal samples {digits(median(samples))} {spread(samples)}"
                f"   equal error {digits(median(errors))} {spread(errors)}"
            )


def options():
    parser = argparse.ArgumentParser(prog="benches/peers/run", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small pictures and 3 turns: is it all working?")
    parser.add_argument("--device", action="append", help="lampray's device, may be given several times [software, cpu]")
    parser.add_argument("--set", action="append", default=[], help="a knob for lampray, PATH=VALUE")
    parser.add_argument("--case", action="append", help="only this case; may be given several times")
    parser.add_argument("--avx2", action="store_true", help="Mitsuba's LLVM variant also compiled for AVX2: 8 lanes, as lavapipe")
    parser.add_argument("--repeats", type=int, help="turns that count [5; of --quick 3]")
    return parser.parse_args()


def main():
    chosen = options()
    repeats = chosen.repeats or (3 if chosen.quick else 5)
    fair, truths = True, {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        programs = [Lampray(device, chosen.set, folder) for device in chosen.device or ["software", "cpu"]]
        programs += [Mitsuba(variant, folder) for variant in VARIANTS]
        if chosen.avx2:
            programs.append(Mitsuba("llvm_ad_rgb", folder, "avx2"))
        print(f"lampray beside Mitsuba {mitsuba.__version__}, {THREADS} threads each, {repeats} turns", flush=True)
        if chosen.quick:
            print("--quick shows that all works: its pictures are too small for Mitsuba's wavefronts, quote no ratio of it")
        for name, what, settings, side, samples in cases(chosen.quick):
            if chosen.case and name not in chosen.case:
                continue
            task = {"scene": scene_file(what, folder), "settings": settings, "width": side, "height": side, "samples": samples}
            print(f"\n{name}: {side} x {side}, {samples} samples a pixel {' '.join(settings)}", flush=True)
            key = (what, side)
            if key not in truths:
                truths[key] = reference(task, programs, 16)
            truth = truths[key]
            found = take_turns(task, programs, repeats)
            if judge(name, found, truth):
                show(found, truth, side * side * samples)
            else:
                fair = False
        for program in programs:
            program.close()
    if not fair:
        print("\nSome pictures disagree: the times of those cases compare nothing and are not shown.")
    sys.exit(0 if fair else 1)


main()
