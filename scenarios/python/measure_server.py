"""What a sweep's Python function runs in: frames come in through stdin, numbers go out through stdout, one line each way.

    python3 measure_server.py FILE FUNCTION

A request is a line of JSON, {"width", "height", "camera", "number", "time", "layers": [{"name", "unit"}], "attributes", "targets", "sample", "seed", "factors"},
and the layers' pixels as float32, row by row from the top; the answer {"values": [numbers]} or {"error": text}.
"""

import importlib.util
import json
import os
import pathlib
import sys
import traceback
from collections.abc import Mapping

import numpy as np


class MeasuredFrame(Mapping):
    """A frame as the function gets it: frame["mw.radiance"] is an array (height, width), float32, read-only."""

    def __init__(self, told, pixels):
        self._layers = {layer["name"]: p for layer, p in zip(told["layers"], pixels)}
        self.units = {layer["name"]: layer["unit"] for layer in told["layers"]}
        self.camera, self.number, self.time = told["camera"], told["number"], told["time"]
        self.attributes, self.targets = told["attributes"], told["targets"]
        self.shape = told["height"], told["width"]

    def __getitem__(self, layer):
        return self._layers[layer]

    def __iter__(self):
        return iter(self._layers)

    def __len__(self):
        return len(self._layers)


def where_it_failed(error, file):
    """The line of the user's file, and what was thrown."""
    lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if pathlib.Path(f.filename).resolve() == file]
    return f"{'line ' + str(lines[-1]) + ': ' if lines else ''}{type(error).__name__}: {error}"


def function_of(file, name):
    spec = importlib.util.spec_from_file_location("measures", file)
    if spec is None or spec.loader is None:
        raise ImportError("not a file of Python")
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(file.parent))
    spec.loader.exec_module(module)
    function = getattr(module, name, None)
    if not callable(function):
        raise AttributeError(f"there is no function '{name}'")
    return function


def main():
    requests = sys.stdin.buffer
    # What the function prints must not come between the answers.
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)

    def answer(message):
        answers.write(json.dumps(message) + "\n")
        answers.flush()

    file = pathlib.Path(sys.argv[1]).resolve()
    try:
        function = function_of(file, sys.argv[2])
    except BaseException as error:  # whatever the user's file does while it is read
        answer({"error": where_it_failed(error, file)})
        return
    answer({"ready": True})
    while line := requests.readline():
        told = json.loads(line)
        height, width = told["height"], told["width"]
        pixels = []
        for _ in told["layers"]:
            array = np.frombuffer(requests.read(4 * height * width), dtype="<f4").reshape(height, width)
            pixels.append(array)
        try:
            values = function(MeasuredFrame(told, pixels), {"sample": told["sample"], "seed": told["seed"], **told["factors"]})
            values = [float(v) for v in np.atleast_1d(np.asarray(values, dtype=float))]
            answer({"values": [v if np.isfinite(v) else None for v in values]})
        except Exception as error:
            answer({"error": where_it_failed(error, file)})


main()
