"""Scenes: a scenario that is open, drawn when asked."""

from __future__ import annotations

import json
import numbers
import os
import pathlib
from typing import Any, Callable, Iterable, Mapping, Sequence

import _pitviper
import numpy as np
from numpy.typing import ArrayLike

from ._arguments import told_as_called
from .frame import Frame
from .physics import Surface


def _plain(value: Any) -> Any:
    """Values as JSON has them. Numbers of numpy are numbers; what is not finite is refused where it is read, as a word that is no number."""
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return value
    if isinstance(value, (np.ndarray, np.bool_)):
        return _plain(value.tolist())
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        number = float(value)
        return number if np.isfinite(number) else repr(number)
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    raise TypeError(f"{type(value).__name__} is nothing that a scenario holds; expected text with a unit, a number, a list, a dict or a bool")


def _yaml(value: Any) -> str:
    """A value as a scenario writes it: text as it is."""
    return value if isinstance(value, str) else json.dumps(_plain(value))


class Scene:
    """A scenario that is open: read once, drawn when asked.

    One call at a time: a second thread gets an InputError. Python's other threads run while it draws. Closing it frees its GL context; it is closed by
    `with`, by `close()` and when it is forgotten.
    """

    def __init__(self, held: "_pitviper.Scene"):
        self._held = held
        self._now: float | None = None

    @staticmethod
    def load(
        scenario: str | os.PathLike | Mapping[str, Any],
        set: Mapping[str, Any] | None = None,
        roots: Iterable[str | os.PathLike] = (),
        base: str | os.PathLike | None = None,
    ) -> "Scene":
        """Reads a scenario: a file, its text (of several lines) or a dict of the same keys.

        set: keys to change, {"cameras.seeker.exposure": "1 ms"}; roots: further folders whose files it may include; base: where a text's or dict's relative
        files are found, unless given the current folder. Errors: InputError with file, line, column, what was expected and the fix.
        """
        sets = [f"{key}={_yaml(value)}" for key, value in (set or {}).items()]
        folders = [pathlib.Path(r) for r in roots]
        text = None
        file = "scenario"
        if isinstance(scenario, Mapping):
            text = json.dumps(_plain(scenario), indent=1)
        elif isinstance(scenario, str) and "\n" in scenario:
            text = scenario
        elif isinstance(scenario, (str, os.PathLike)):
            file = os.fspath(scenario)
        else:
            raise TypeError(f"{type(scenario).__name__} is no scenario; expected a file's name, YAML text or a dict")
        return Scene(_pitviper.Scene(file, text, pathlib.Path(base or "."), sets, folders))

    def close(self) -> None:
        """Frees its GL context, tables and programs. Frames and arrays stay."""
        self._held.close()

    def __enter__(self) -> "Scene":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    @property
    def closed(self) -> bool:
        """Whether close() was called: nothing is drawn any more."""
        return self._held.closed

    @property
    def name(self) -> str:
        """Its scenario's name."""
        return self._held.name

    @property
    def cameras(self) -> list[dict[str, Any]]:
        """Of each camera name, width, height, layers {name: unit} and focal_px, its focal length at first in pixels (angle = atan(pixels / focal_px))."""
        return self._held.cameras()

    @property
    def times(self) -> np.ndarray:
        """Times of the scenario's frames [s], shape (frames,)."""
        start, step, frames = self._held.time()
        return start + step * np.arange(frames)

    @property
    def step(self) -> float:
        """From one frame to the next [s]."""
        return self._held.time()[1]

    @property
    def now(self) -> float:
        """The time of the newest picture [s]; before the first that of the scenario's first frame."""
        return self._held.time()[0] if self._now is None else self._now

    # Keys of the scenario

    def __getitem__(self, key: str) -> Any:
        """What stands at "cameras.seeker.exposure": text with its unit, number, list or dict. List items by number or by their name. A key that the scenario
        leaves to its default is an InputError."""
        return self._held.get(key)

    def __setitem__(self, key: str, value: Any) -> None:
        """Changes a key: "3 deg", [0, "1 m", 2], a dict. The scenario is read anew by its own rules; on an InputError nothing has changed.

        Poses, temperatures, levels and a camera's aim and focal length need no new plan or program inside the scenario's `limits`; others do where the plan
        before does not hold any more: `planned()` says so, `render(draft=True)` shows something meanwhile.
        """
        self._held.set(key, _yaml(value))

    def set(self, keys: Mapping[str, Any]) -> None:
        """Several keys at once, as by scene[key] = value."""
        sets = {s.split("=", 1)[0]: s for s in self._held.sets}
        for key, value in keys.items():
            sets.pop(key, None)
            sets[key] = f"{key}={_yaml(value)}"
        self._held.change(list(sets.values()))

    @told_as_called

    def plan_for(self, variations: Iterable[Mapping[str, Any]], time: float | None = None) -> None:
        """Plans from here on are made for these variations too, dicts of keys as of set(): within `limits`, pictures between them need no plan of their own.
        Without it a plan is made for the scenario's own times, and `limits` for ranges, temperatures and levels alone, not for other directions towards the
        sun."""
        all_sets = [[f"{key}={_yaml(value)}" for key, value in keys.items()] for keys in variations]
        self._held.expect(all_sets, self.now if time is None else float(time))

    def scenario(self) -> dict[str, Any]:
        """The whole scenario as it is read: parts put together, expressions worked out, changes in place."""
        return self._held.tree()

    # The world

    @told_as_called

    def command(self, command: str, time: float | None = None, **keys: Any) -> None:
        """Commands the world with the words of a scenario's `commands`, from `time` on (unless given from now): no new plan, no new program.

            scene.command("temperature", entity="jet", value="320 K")
            scene.command("move", entity="jet", position=["0 m", "2 km", "500 m"])
            scene.command("look", camera="tracker", heading="12 deg", pitch="20 deg")

        Times may not fall. Errors: InputError.
        """
        if "at" in keys:
            raise TypeError("command() takes its time [s] by `time`, not by `at`")
        words = {"command": command, **keys}
        self._held.command(json.dumps(_plain(words)), self.now if time is None else float(time))

    def reset(self) -> None:
        """The world as the scenario has it: commands are forgotten, and time may begin anew."""
        self._held.forget()
        self._now = None

    @told_as_called

    def world(self, time: float | None = None) -> dict[str, Any]:
        """Where everything is: {"entities": {name: {position_m (east, north, up), orientation_wxyz, velocity_m_s, temperatures_K, there}}, "lights": ...,
        "cameras": ...}."""
        return self._held.world(self.now if time is None else float(time))

    # Pictures

    @told_as_called

    def render(
        self,
        time: float | None = None,
        camera: str | None = None,
        draft: bool = False,
        audit: bool = False,
        noise: int = 0,
        progress: Callable[[float], Any] | None = None,
    ) -> Frame:
        """A calibrated frame.

        time: simulation time [s], unless given now; camera: its name, unless given the first. draft: where the plan takes seconds, a picture at once by a
        draft's few groups (20 %, `frame.is_draft`), while the plan is made beside. audit: some pixels are worked out by the reference too (`frame.audit`).
        noise: another draw of the detector's noise; what is fixed, as its pattern, stays. 0: the scenario's own.
        progress: called with the share of a plan that is made. Ctrl + C ends a plan that is being made. Detectors and gimbals that remember go on from frame
        to frame; a frame that does not follow the last one begins as `run --frames` would there.
        Errors: InputError, RuntimeError where the driver cannot do it.
        """
        at = self.now if time is None else float(time)
        told = self._held.draw(camera, at, draft, audit, noise, progress)
        self._now = at
        return Frame(told.pop("frame"), told)

    @told_as_called

    def next(self, camera: str | None = None, **wishes: Any) -> Frame:
        """The frame after the newest; the first, at first."""
        start, step, _ = self._held.time()
        return self.render(start if self._now is None else start + step * (round((self._now - start) / step) + 1), camera, **wishes)

    @told_as_called

    def planned(self, camera: str | None = None) -> bool:
        """Whether the next picture waits for no plan."""
        return self._held.planned(camera, self.now)

    @told_as_called

    def plan(self, camera: str | None = None, progress: Callable[[float], Any] | None = None) -> dict[str, Any]:
        """What its plan chose: wavelengths, tables, terms kept and left out, errors to expect, as `pitviper plan --json` tells them. Made where there is
        none."""
        return json.loads(self._held.plan(camera, True, progress))

    def check(self) -> str:
        """What each camera sees, in words, as `pitviper check` tells it."""
        return self._held.check()

    def audit(self, time: float | None = None, camera: str | None = None) -> dict[str, Any]:
        """A frame's audit: relative errors of some pixels against the reference, every wavelength in double precision."""
        audit = self.render(time, camera, audit=True).audit
        return audit or {"pixels": 0, "errors": []}

    @told_as_called

    def terms(self, column: int, row: int, time: float | None = None, camera: str | None = None) -> dict[str, Any]:
        """What a pixel's light is made of, by the reference: {layer: {unit, all, terms {part: value}, rest, apparent_temperature_K}}, before the sensor."""
        return self._held.terms(camera, self.now if time is None else float(time), column, row)

    @told_as_called

    def spectrum(
        self, column: int, row: int, low_um: float, high_um: float, bins: int = 64, time: float | None = None, camera: str | None = None
    ) -> dict[str, Any]:
        """A pixel's spectral radiance by the reference: wavelength_um (bins,), edge_um (bins + 1,), all (bins,) [W/(m2 sr um)], terms {part: (bins,)}, rest."""
        return self._held.spectrum(camera, self.now if time is None else float(time), column, row, low_um, high_um, bins)

    # Its air and materials

    @told_as_called

    def path(self, start: Sequence[float], end: Sequence[float], wavelength_um: ArrayLike) -> dict[str, Any]:
        """The air between two places (east, north, up [m]), looking from the first: range_m, optical_depth, transmittance, path_radiance [W/(m2 sr um)], each
        of the wavelengths' shape, by the reference: what the air emits and scatters. A value is a mean over the width of the air's own data: 20 1/cm of library
        air, whose bands do not multiply along a path: sum over wavelengths (band_transmittance). Errors: InputError where the earth stands between."""
        return _pitviper.air_path(self._held, tuple(start), tuple(end), wavelength_um)

    @told_as_called

    def sky(self, place: Sequence[float], direction: Sequence[float], wavelength_um: ArrayLike) -> np.ndarray:
        """Radiance of the sky in a direction, without the sun's disc [W/(m2 sr um)], of the wavelengths' shape."""
        return _pitviper.sky_radiance(self._held, tuple(place), tuple(direction), wavelength_um)

    @told_as_called

    def band_transmittance(self, start: Sequence[float], end: Sequence[float], band: tuple, source_K: float) -> float:
        """Share of a black body's light that a band gets through the air between two places."""
        return _pitviper.band_transmittance(self._held, tuple(start), tuple(end), band, source_K)

    @told_as_called

    def material(self, name: str, state: float | None = None) -> Surface:
        """One of its materials, as pitviper.material() has those of the library."""
        return Surface(_pitviper.surface_of(self._held, name, state), name)

    def _repr_png_(self) -> bytes:
        return self.render(draft=True)._repr_png_()

    def __repr__(self) -> str:
        cameras = "" if self.closed else ", cameras " + ", ".join(c["name"] for c in self.cameras)
        return f"<pitviper.Scene {self.name}{' (closed)' if self.closed else cameras}>"
