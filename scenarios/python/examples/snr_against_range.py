# %% [markdown]
# # Signal to noise against range
# A jet comes nose on at 600 m of height, in haze of three visibilities; a small mid-wave camera looks up at it. Truth tells of each frame what the jet's
# signal is over the detector's noise in its best pixel. That is of the mean over many frames: one frame of each range is enough. From 8 km on the jet is lower
# than a pixel, and its signal falls with the square of the range as well.

# %%
import argparse
import pathlib

import numpy as np

import pitviper

options = argparse.ArgumentParser(description="Signal to noise of a jet against its range, for three visibilities.", allow_abbrev=False)
options.add_argument("--out", type=pathlib.Path, default=".", metavar="FOLDER", help="where the pictures go")
options.add_argument("--ranges", type=int, default=16, metavar="N", help="of each visibility, between 2 and 30 km (default 16)")
options.add_argument("--accuracy", default="1 %", metavar="PERCENT", help="of light and of what is true of targets (default 1 %%)")
asked, _ = options.parse_known_args()
asked.out.mkdir(parents=True, exist_ok=True)

WANTED_SNR = 5.0

# %% [markdown]
# ## The scenario
# That of `jet_and_sky.yaml` with a camera that has a detector, another air, and limits that the plan of its wavelengths holds for. Far
# away the jet is a hundredth of its pixel's light and less; truth keeps the accuracy of such a difference too.

# %%
camera = {
    "name": "search",
    "position": ["0 m", "0 m", "20 m"],
    "look_at": "jet",
    "film": {"width": 65, "height": 65, "pitch": "15 um"},
    "focal_length": "50 mm",
    "aperture": "12 mm",
    "exposure": "1 ms",
    "channels": [{"name": "mw", "response": {"band": ["3.7 um", "4.8 um"]}, "quantum_efficiency": "insb_mwir", "output": "counts"}],
    "stages": [{"stage": "detector", "full_well": 6.5e6, "bits": 14, "offset": 200, "read_noise": 600}],
    "truth": ["targets"],
}


def snr_at(ranges_m: np.ndarray, visibility: str) -> np.ndarray:
    """Signal to noise at each range, of its shape."""
    air = {"library": "clear_us76", "visibility": visibility}
    keys = {"cameras": [camera], "atmosphere": air, "limits": {"range": ["1.5 km", "35 km"]}, "accuracy": asked.accuracy}
    with pitviper.Scene.load(pitviper.home / "scenarios/jet_and_sky.yaml", set=keys) as scene:
        snr = []
        for range_m in ranges_m:
            scene.command("move", entity="jet", position=["0 m", f"{range_m} m", "600 m"], heading="180 deg")
            snr.append(scene.render().targets[0]["channels"]["mw"]["snr"])
        return np.array(snr)

# %% [markdown]
# ## Ranges at which it is still seen
# Between two ranges log SNR is taken as linear.

# %%
ranges_m = np.geomspace(2e3, 30e3, asked.ranges)
curves = {}
for visibility in ("2 km", "5 km", "23 km"):
    snr = snr_at(ranges_m, visibility)
    reach_m = np.interp(-np.log(WANTED_SNR), -np.log(snr), ranges_m)
    curves[f"visibility {visibility}"] = (ranges_m / 1e3, snr)
    ends = f"SNR {snr[0]:.1f} at {ranges_m[0] / 1e3:g} km, {snr[-1]:.2f} at {ranges_m[-1] / 1e3:g} km"
    print(f"visibility {visibility}: {ends}; SNR {WANTED_SNR:g} at {reach_m / 1e3:.2f} km")

# %%
wanted = f"SNR {WANTED_SNR:g}"
curves[wanted] = (ranges_m[[0, -1]] / 1e3, [WANTED_SNR, WANTED_SNR])
picture = asked.out / "snr_against_range.png"
pitviper.chart(picture, curves, title="A jet nose on, 3.7 to 4.8 um", x="range [km]", y="signal to noise [1]", log_y=True, dashed=[wanted])
