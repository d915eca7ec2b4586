"""What the tests share: scenarios, the program's own frames beside the module's, what this process holds."""

import copy
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

import numpy as np
import pitviper

root = pathlib.Path(__file__).resolve().parents[2]
scenarios = root / "scenarios"
program = pathlib.Path(os.environ["PITVIPER_BUILD"]) / "pitviper"

# A black plate that fills the view of a camera, in no air: drawn at once, and its radiance is Planck's.
BENCH = {
    "name": "bench",
    "seed": 3,
    "time": {"start": "0 s", "rate": "25 Hz", "frames": 50},
    "background": {"temperature": "250 K"},
    "entities": [
        {
            "name": "plate",
            "shape": {"model": "plate", "width": "30 m", "height": "30 m"},
            "material": "blackbody",
            "temperature": "300 K",
            "position": ["0 m", "20 m", "0 m"],
            "heading": "180 deg",
        }
    ],
    "cameras": [
        {
            "name": "eye",
            "position": ["0 m", "0 m", "0 m"],
            "heading": "0 deg",
            "film": {"width": 48, "height": 32, "pitch": "20 um"},
            "focal_length": "20 mm",
            "aperture": "10 mm",
            "exposure": "1 ms",
            "channels": [{"name": "mw", "response": {"band": ["3.6 um", "4.9 um"]}, "quantum_efficiency": 0.8, "output": ["radiance"]}],
        }
    ],
}


def bench(width=48, height=32):
    scenario = copy.deepcopy(BENCH)
    scenario["cameras"][0]["film"].update(width=width, height=height)
    return scenario


def detector(**keys):
    """The bench seen by a detector with noise, fixed pattern and temporal; and the electrons of an ideal one."""
    scenario = bench()
    camera = scenario["cameras"][0]
    camera["channels"][0]["output"] = ["counts", "electrons"]
    stage = {"stage": "detector", "full_well": 4e6, "bits": 16, "gain": 0.01, "offset": 500, "read_noise": 600, "dsnu": 3000, "prnu": 0.01}
    camera["stages"] = [{**stage, **keys}]
    return scenario


class Folder:
    """Temporary, of a test class; gone with it."""

    def __init__(self):
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="pitviper_py_"))

    def remove(self):
        shutil.rmtree(self.path, ignore_errors=True)


def as_option(key, value):
    return f"{key}={value if isinstance(value, str) else json.dumps(value)}"


def run_program(folder, scenario, sets, frames):
    """Frames of `pitviper run`, as read_frame() has them. `scenario`: a file, or a dict; `frames`: "0:2"."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=folder))
    if isinstance(scenario, dict):
        file = folder / "scenario.yaml"
        file.write_text(json.dumps(scenario, indent=1))  # as the module writes it: its hash is the same
        scenario = file
    options = [word for key, value in (sets or {}).items() for word in ("--set", as_option(key, value))]
    told = subprocess.run(
        [str(program), "run", str(scenario), "--out", str(folder / "out"), "--frames", frames, "--no-history", *options],
        capture_output=True,
        text=True,
        check=False,
    )
    if told.returncode != 0:
        raise AssertionError(f"pitviper run ended with {told.returncode}: {told.stderr}")
    return [pitviper.read_frame(file) for file in pitviper.frames_in(folder / "out")]


def same_bits(a, b):
    """Whether two arrays hold the same bits: no tolerance, and no number equals no number."""
    return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()


def layers_that_differ(one, other):
    """Names of layers that differ in a bit, or that one of two frames has alone."""
    return [name for name in {**dict.fromkeys(one), **dict.fromkeys(other)} if name not in one or name not in other or not same_bits(one[name], other[name])]


# OpenEXR's own attributes, which are single precision in a file.
SINGLE = ("worldToCamera", "expTime", "aperture", "framesPerSecond")


def numbers_of(value):
    """Numbers, if a value is nothing else."""
    if isinstance(value, str) and re.fullmatch(r"[-+0-9.eEinfa ]+", value) and " " in value:
        value = value.split(" ")
    try:
        return np.array(value, dtype=float)
    except (TypeError, ValueError):
        return None


def attributes_that_differ(drawn, read, audit=False):
    """Names of attributes that a drawn frame and one that was read from a file have differently. `audit`: those of an audit too, which a program's run makes of
    some of its frames."""
    wrong = []
    for name in sorted(set(drawn) | set(read)):
        if name == "pitviper.picture" or (name.startswith("pitviper.audit.") and not audit):  # the first tells of a picture that the file has besides
            continue
        if name not in drawn or name not in read:
            wrong.append(name)
            continue
        a, b = drawn[name], read[name]
        if a == b:
            continue
        x, y = numbers_of(a), numbers_of(b)
        if name in SINGLE and x is not None:
            x, y = np.float32(x), np.float32(y)
        if x is None or y is None or not np.array_equal(x, y, equal_nan=True):
            wrong.append(name)
    return wrong


def resident_kB():
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:"))


def threads():
    return len(os.listdir("/proc/self/task"))


def open_files():
    return len(os.listdir("/proc/self/fd"))


def address(array):
    return array.__array_interface__["data"][0]
