# %% [markdown]
# # A tracker in the loop
# Lockstep: the camera looks where the tracker says, the next frame is drawn, the tracker looks at it, and so on. The tracker is yours: here the sky is
# subtracted, the centroid of what is left is taken, and the camera is turned by what it is off and by the drift that this has had so far. The half pixel that
# stays is the hot nozzle's edge, whose pixels are full or sky: with 0.05 ms of exposure and 4 x 4 samples a pixel it is a tenth.

# %%
import argparse
import math
import pathlib

import numpy as np

import pitviper

options = argparse.ArgumentParser(description="A centroid tracker keeps a jet in the middle of the picture.", allow_abbrev=False)
options.add_argument("--out", type=pathlib.Path, default=".", metavar="FOLDER", help="where the pictures go")
options.add_argument("--frames", type=int, default=100, metavar="N", help="to steer (default 100)")
asked, _ = options.parse_known_args()
asked.out.mkdir(parents=True, exist_ok=True)

scene = pitviper.Scene.load(pitviper.home / "scenarios/track.yaml")

# %% [markdown]
# ## The tracker

# %%
def centroid_off(counts: np.ndarray) -> np.ndarray:
    """How far the light that is no sky is from the middle of the picture, (right, down) [pixels]; 0 where there is none. counts: (height, width)."""
    counts = counts.astype(float)
    light = np.maximum(counts - np.median(counts) - 6.0 * np.std(counts[:8]), 0.0)
    if not light.any():
        return np.zeros(2)
    rows, columns = np.indices(light.shape)
    height, width = light.shape
    return np.array([np.average(columns + 0.5, weights=light) - 0.5 * width, np.average(rows + 0.5, weights=light) - 0.5 * height])


class Tracker:
    """Where to look [deg], from what each picture is off. A target that crosses evenly is led: its drift is summed up."""

    def __init__(self, heading: float, pitch: float, focal_px: float):
        self.heading, self.pitch, self.focal_px = heading, pitch, focal_px
        self.drift = np.zeros(2)

    def see(self, off: np.ndarray) -> None:
        self.drift += 0.5 * off
        right, down = np.degrees(np.arctan((off + self.drift) / self.focal_px))
        self.heading += right / math.cos(math.radians(self.pitch))
        self.pitch -= down

# %% [markdown]
# ## The loop

# %%
camera = scene.cameras[0]
tracker = Tracker(heading=-9.7, pitch=22.7, focal_px=0.5 * camera["width"] / math.tan(math.radians(0.5 * 1.5)))
offs = []
for k in range(asked.frames):
    scene.command("look", camera="tracker", heading=f"{tracker.heading} deg", pitch=f"{tracker.pitch} deg", time=k * scene.step)
    frame = scene.render(time=k * scene.step)
    offs.append(centroid_off(frame["mw.counts"]))
    tracker.see(offs[-1])
    if k % 10 == 0:
        print(f"frame {k:3d}: the jet is off by {offs[-1][0]:+7.2f} pixels to the right, {offs[-1][1]:+7.2f} down")

off_px = np.hypot(*np.transpose(offs))
rms = math.sqrt(np.mean(off_px[20:] ** 2))
print(f"first {off_px[0]:.2f} pixels off, after 20 frames {rms:.3f} (RMS), at most {off_px[20:].max():.3f}")

# %%
frame.picture(asked.out / "centroid_tracker.png", layer="mw.counts")
times = scene.step * np.arange(asked.frames)
pitviper.chart(
    asked.out / "centroid_tracker_off.png",
    {"centroid off the middle": (times, np.maximum(off_px, 1e-3))},
    title="Centroid tracker",
    x="time [s]",
    y="off the middle [pixels]",
    log_y=True,
)
