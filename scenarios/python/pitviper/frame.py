"""Calibrated frames: numpy arrays with names, units and all that is known of them."""

from __future__ import annotations

import os
import pathlib
import tempfile
from typing import Any, Iterator, Mapping

import _pitviper
import numpy as np


class Frame(Mapping):
    """A calibrated frame of one camera. `frame["mw.radiance"]` is a numpy array.

    Arrays are (height, width), float32, row 0 at the top, read-only, and views of the frame's own memory: nothing is copied, and an array keeps its frame.
    Channels come first, then truth layers ("truth.range").
    """

    def __init__(self, held: "_pitviper.Frame", told: Mapping[str, Any] | None = None):
        self._held = held
        self._told = dict(told or {})
        self._attributes: dict[str, Any] | None = None

    def __getitem__(self, layer: str) -> np.ndarray:
        try:
            return self._held.layer(layer)
        except (KeyError, TypeError):
            raise KeyError(f"there is no layer '{layer}'; expected one of {', '.join(self)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._held.layers())

    def __len__(self) -> int:
        return len(self._held.layers())

    # By what they are, not by their pixels.
    __eq__ = object.__eq__
    __hash__ = object.__hash__

    @property
    def units(self) -> dict[str, str]:
        """Unit of each layer: "W/(m2 sr)", "K", "1"."""
        return self._held.units()

    @property
    def camera(self) -> str:
        """Name of its camera."""
        return self._held.camera

    @property
    def number(self) -> int:
        """Frame number: of the tick of the scenario's time that is nearest."""
        return self._held.number

    @property
    def time(self) -> float:
        """Simulation time [s]."""
        return self._held.time_s

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width) [pixels]."""
        return self._held.height, self._held.width

    @property
    def attributes(self) -> dict[str, Any]:
        """Everything that its file's header would say: pose, optics, bands, calibration, plan, error to expect."""
        if self._attributes is None:
            self._attributes = self._held.attributes()
        return self._attributes

    @property
    def targets(self) -> list[dict[str, Any]]:
        """A dict for each body, plume, flare and lamp, of a camera with `truth: [targets]`: name, kind, column, row, box (left, top, right, bottom) [pixels],
        range_m, range_rate_m_s, sight_rate_rad_s (right, up), visible (share of its outline), channels {name: {unit, own, total, contrast, snr, saturated}}."""
        return self._held.targets()

    @property
    def predicted_error(self) -> dict[str, float]:
        """Relative error that its plan expects at most, by layer; empty where nobody knows: of a reference, a file, an accuracy of `none`."""
        return self._told.get("predicted_error", {})

    @property
    def audit(self) -> dict[str, Any] | None:
        """What the reference found of some of its pixels: pixels, errors (relative), largest, channel, asked; None where it was not audited."""
        return self._told.get("audit")

    @property
    def is_draft(self) -> bool:
        """Drawn by a draft's few groups of wavelengths (20 %), while the plan was being made."""
        return self._told.get("draft", False)

    @property
    def outside_limits(self) -> bool:
        """Something that it shows is beyond the scenario's `limits`: its error is not known."""
        return self._told.get("outside_limits", False)

    def save(self, file: str | os.PathLike, compression: str = "none") -> None:
        """Writes .exr, .fits, .tiff, .json (with PNGs), .hdr (ENVI) or .raw. `compression`: "none" or "zip", of EXR. Errors: InputError, OSError."""
        self._held.write(pathlib.Path(file), compression)

    def picture(self, file: str | os.PathLike, layer: str | None = None, truth: bool = False, range: tuple[float, float] | None = None) -> None:
        """A PNG with colour bar and unit. `layer`: this one alone; `truth`: truth layers too; `range`: ends of the bars, in the layers' unit."""
        self._held.picture(pathlib.Path(file), layer, truth, range)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "frame.png"
            self.picture(file)
            return file.read_bytes()

    def __repr__(self) -> str:
        height, width = self.shape
        return f"<pitviper.Frame {self.number} of camera {self.camera}, {width}x{height}, {self.time:g} s: {', '.join(self)}>"


def read_frame(file: str | os.PathLike) -> Frame:
    """A frame from an EXR, FITS, TIFF, ENVI, raw or PNG file. Errors: InputError for other, damaged or truncated files."""
    return Frame(_pitviper.read_frame(pathlib.Path(file)))


def frames_in(folder: str | os.PathLike) -> list[pathlib.Path]:
    """The files of a folder that are frames, in natural order. Errors: InputError."""
    return _pitviper.frames_in(pathlib.Path(folder))
