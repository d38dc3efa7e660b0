"""The programs that are compared: each renders a task and says how long that took."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
LAMPRAY = ROOT / "target/release/lampray"
THREADS = 2
# lampray's exit code where a device cannot do what it is asked to.
NO_DEVICE = 69


class Cannot(Exception):
    """A program cannot render this scene; the text says why."""


def environment():
    """Two threads for everybody: rayon's, lavapipe's."""
    own = {"RAYON_NUM_THREADS": str(THREADS), "LP_NUM_THREADS": str(THREADS)}
    return os.environ | own


class Lampray:
    """A process a render, on one device. Its time is that from the first dispatch to the finished picture: no
    start, no compiling, no files."""

    def __init__(self, device, settings, folder):
        self.name = f"lampray --device {device}"
        self.device, self.settings, self.folder = device, settings, folder

    def render(self, task):
        file = self.folder / "lampray.exr"
        command = [LAMPRAY, "render", task["scene"], "--device", self.device, "--json", "-q", "-o", file]
        for knob in ("width", "height", "samples", "seed"):
            command += [f"--{knob}", str(task[knob])]
        for setting in task["settings"] + self.settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True, env=environment())
        if done.returncode == NO_DEVICE:
            raise Cannot(done.stderr.strip())
        if done.returncode:
            raise RuntimeError(done.stderr.strip())
        record = json.loads(done.stdout)
        seconds = record["seconds"]["total"] - record["seconds"]["setup"]
        return {"seconds": seconds, "record": record, **layers(file)}

    def close(self):
        pass


class Mitsuba:
    """A process that stays, so that compiling is paid once and not timed."""

    def __init__(self, variant, folder, *target):
        self.name = " ".join(["mitsuba", variant, *target])
        self.picture = folder / f"{'-'.join([variant, *target])}.npy"
        command = [sys.executable, HERE / "worker.py", variant, str(THREADS), *target]
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, env=environment())

    def render(self, task):
        wanted = {key: task[key] for key in ("scene", "width", "height", "samples", "seed")}
        self.process.stdin.write(json.dumps(wanted | {"picture": str(self.picture)}) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.name} ended")
        return {"seconds": json.loads(line)["seconds"], "pixels": np.load(self.picture).astype(np.float64)}

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def layers(file):
    """The mean of each pixel, and the variance of that mean."""
    import mitsuba as mi

    bitmap = mi.Bitmap(str(file))
    values = np.array(bitmap, dtype=np.float64)
    names = [field.name for field in bitmap.struct_()]
    of = lambda *wanted: values[..., [names.index(name) for name in wanted]]
    variance = of("variance.R", "variance.G", "variance.B") / of("samples")
    return {"pixels": of("R", "G", "B"), "variance": variance}
