"""pitviper: infrared and optronic sensor scenes in calibrated units, called from Python.

    import pitviper
    scene = pitviper.Scene.load("scenarios/jet_and_sky.yaml")
    frame = scene.render(0.5)
    frame["mw.radiance"]            # numpy array (height, width), float32, W/(m2 sr)

A Scene draws what a scenario says; its keys are changed by `scene["entities.jet.temperature"] = "320 K"`, its world by `scene.command(...)`. Mistakes
are `InputError`, with the place, what was expected and the fix.
"""

import os as _os
import pathlib as _pathlib
import sys as _sys


home = _pathlib.Path(__file__).resolve().parents[3]
"""The checkout: `home / "scenarios"` has the scenarios."""
_build = _pathlib.Path(_os.environ.get("PITVIPER_BUILD") or home / "build")
program = _build / "pitviper"
"""The program that was built with the module, for commands: `subprocess.run([pitviper.program, "sweep", ...])`."""


def _load_extension():
    """The built module: in PITVIPER_BUILD, or the checkout's `build`."""
    _os.environ.setdefault("PITVIPER_HOME", str(home))
    build = _build
    _sys.path.insert(0, str(build))
    try:
        import _pitviper

        return _pitviper
    except ImportError as error:
        version = ".".join(map(str, _sys.version_info[:2]))
        raise ImportError(
            f"pitviper's module is not in {build}, or not for Python {version} ({error}); "
            "fix: build it by `./pitviper build`, use the distribution's python3, or set PITVIPER_BUILD to its folder"
        ) from error
    finally:
        _sys.path.remove(str(build))


_extension = _load_extension()

from ._pitviper_names import InputError, __version__  # noqa: E402
from .frame import Frame, frames_in, read_frame  # noqa: E402
from .physics import (  # noqa: E402
    Surface,
    apparent_temperature,
    band_integral,
    band_mean,
    band_radiance,
    band_radiance_slope,
    chart,
    direction,
    material,
    planck,
    planck_slope,
)
from .scene import Scene  # noqa: E402

__all__ = [
    "Frame",
    "InputError",
    "Scene",
    "Surface",
    "__version__",
    "apparent_temperature",
    "band_integral",
    "band_mean",
    "band_radiance",
    "band_radiance_slope",
    "chart",
    "direction",
    "frames_in",
    "home",
    "material",
    "planck",
    "planck_slope",
    "program",
    "read_frame",
]
