"""Spectra, bands, surfaces and charts: functions over arrays.

Wavelengths are in um, temperatures in K, angles in rad. A band is (low, high), where it responds by 1, or (wavelengths, values), linear between. Wherever
a number stands an array of any shape may. Errors are InputError: what is no number, negative, or outside 0.1 to 1000 um.
"""

from __future__ import annotations

import os
import pathlib
from typing import Any, Iterable, Mapping, Sequence

import _pitviper
import numpy as np
from numpy.typing import ArrayLike

from ._arguments import told_as_called

Band = tuple


def _result(array: np.ndarray) -> Any:
    return float(array) if array.ndim == 0 else array


@told_as_called


def planck(wavelength_um: ArrayLike, temperature_K: ArrayLike, unit: str = "W") -> Any:
    """Spectral radiance of a black body, shape (temperatures..., wavelengths...) [W/(m2 sr um)], or [photon/(s m2 sr um)] by unit="photon/s"."""
    return _result(_pitviper.planck(wavelength_um, temperature_K, unit))


@told_as_called


def planck_slope(wavelength_um: ArrayLike, temperature_K: ArrayLike, unit: str = "W") -> Any:
    """dB/dT of planck(), laid out alike [W/(m2 sr um K)]."""
    return _result(_pitviper.planck_slope(wavelength_um, temperature_K, unit))


@told_as_called


def band_radiance(temperature_K: ArrayLike, band: Band, unit: str = "W") -> Any:
    """Black body's radiance in a band, shape of the temperatures [W/(m2 sr)], [photon/(s m2 sr)]. Relative error below 1e-10."""
    return _result(_pitviper.band_radiance(temperature_K, band, unit))


@told_as_called


def band_radiance_slope(temperature_K: ArrayLike, band: Band, unit: str = "W") -> Any:
    """dL/dT of band_radiance() [W/(m2 sr K)]."""
    return _result(_pitviper.band_radiance_slope(temperature_K, band, unit))


@told_as_called


def apparent_temperature(radiance: ArrayLike, band: Band, unit: str = "W") -> Any:
    """Temperature of the black body that has so much of a band [K], from 20 to 20000 K; 0 of less, 20000 of more. Relative error below 1e-8."""
    return _result(_pitviper.apparent_temperature(radiance, band, unit))


@told_as_called


def band_integral(wavelength_um: ArrayLike, values: ArrayLike, band: Band | None = None) -> float:
    """Integral of a table, linear between its wavelengths, times the band's response if one is given [unit of the values x um]. Exact."""
    return _pitviper.band_integral(wavelength_um, values, band)


@told_as_called


def band_mean(wavelength_um: ArrayLike, values: ArrayLike, band: Band) -> float:
    """Mean of a table as a band sees it: its integral with the response over that of the response."""
    return _pitviper.band_mean(wavelength_um, values, band)


def direction(angle_rad: float, azimuth_rad: float = 0.0) -> tuple[float, float, float]:
    """Unit vector at an angle to a surface's normal (z) and an azimuth about it."""
    return (float(np.sin(angle_rad) * np.cos(azimuth_rad)), float(np.sin(angle_rad) * np.sin(azimuth_rad)), float(np.cos(angle_rad)))


class Surface:
    """What a material's surface reflects, emits and lets through. Textures count as 1. Angles count from its normal, 0 to pi/2."""

    def __init__(self, held: "_pitviper.Surface", name: str):
        self._held = held
        self.name = name

    @property
    def valid_um(self) -> tuple[float, float]:
        """Wavelengths of which it has data."""
        return self._held.valid_um

    @property
    def states(self) -> dict[str, Any] | None:
        """What it changes with: {"temperature": bool, "low", "high"}; None: with nothing."""
        return self._held.states

    @told_as_called

    def brdf(self, wavelength_um: ArrayLike, light: Sequence[float], views: Sequence[Sequence[float]]) -> np.ndarray:
        """BRDF [1/sr], shape (views, wavelengths). Directions are unit vectors from the surface, z its normal (`direction()`)."""
        return self._held.brdf(wavelength_um, tuple(light), [tuple(v) for v in views])

    @told_as_called

    def reflectance(self, wavelength_um: ArrayLike, angle_rad: ArrayLike = 0.0) -> Any:
        """Directional-hemispherical reflectance, shape (angles..., wavelengths...)."""
        return _result(self._held.reflectance(wavelength_um, angle_rad))

    @told_as_called

    def emissivity(self, wavelength_um: ArrayLike, angle_rad: ArrayLike = 0.0) -> Any:
        """Given, or by Kirchhoff what is neither reflected nor let through; shape as reflectance()."""
        return _result(self._held.emissivity(wavelength_um, angle_rad))

    @told_as_called

    def transmittance(self, wavelength_um: ArrayLike, angle_rad: ArrayLike = 0.0) -> Any:
        """Of the whole layer that the surface stands for; shape as reflectance()."""
        return _result(self._held.transmittance(wavelength_um, angle_rad))

    def _repr_png_(self) -> bytes:
        import tempfile

        low, high = self.valid_um
        wavelength_um = np.geomspace(max(low, 0.3), min(high, 14.0), 400)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "surface.png"
            curves = {"emissivity": (wavelength_um, self.emissivity(wavelength_um)), "reflectance": (wavelength_um, self.reflectance(wavelength_um))}
            chart(file, curves, title=self.name, x="wavelength [um]", y="along the normal [1]", log_x=True)
            return file.read_bytes()

    def __repr__(self) -> str:
        return f"<pitviper.Surface {self.name}, {self.valid_um[0]:g} to {self.valid_um[1]:g} um>"


@told_as_called


def material(name: str, state: float | None = None) -> Surface:
    """A material of the library, a file of one, or a substance by its optical constants, without a scenario. `state`: of one that changes with something: its
    temperature [K], wetness, thickness of its film [um]. Errors: InputError with the names there are."""
    return Surface(_pitviper.surface(name, state), name)


def chart(
    file: str | os.PathLike,
    curves: Mapping[str, tuple[ArrayLike, ArrayLike]],
    title: str = "",
    x: str = "",
    y: str = "",
    log_x: bool = False,
    log_y: bool = False,
    dashed: Iterable[str] = (),
) -> None:
    """A PNG of curves {name: (x, y)} in one panel, with axes `x` and `y`; those of `dashed` are to compare with. Needs VTK, as the build has it."""
    apart = set(dashed)
    series = [
        {"name": name, "x": np.asarray(a, float).ravel().tolist(), "y": np.asarray(b, float).ravel().tolist(), "dashed": name in apart}
        for name, (a, b) in curves.items()
    ]
    _pitviper.charts([{"title": title, "x": x, "y": y, "log_x": log_x, "log_y": log_y, "series": series}], 1, pathlib.Path(file))
