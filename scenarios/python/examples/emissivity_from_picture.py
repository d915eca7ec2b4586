# %% [markdown]
# # Emissivity from a picture
# An inverse problem: a ball of unknown temperature and emissivity between sky and ground, seen in two bands by a camera with noise. A hot ball that emits
# little looks like a colder one that emits more. How much of the sky shines back from it tells them apart, and so does the ratio of the two bands. The given
# picture is drawn by the reference, every wavelength; Gauss-Newton fits pictures drawn by a plan of 0.1 %.

# %%
import argparse
import pathlib

import numpy as np

import pitviper

options = argparse.ArgumentParser(description="Finds a ball's emissivity and temperature from a picture in two bands.", allow_abbrev=False)
options.add_argument("--out", type=pathlib.Path, default=".", metavar="FOLDER", help="where the pictures go")
options.add_argument("--points", type=int, default=15, metavar="N", help="emissivities of the chart (default 15)")
asked, _ = options.parse_known_args()
asked.out.mkdir(parents=True, exist_ok=True)

BANDS = {"mw": (3.7, 4.8), "lw": (8.0, 12.0)}  # um
HIDDEN = np.array([0.73, 331.0])  # emissivity, temperature [K]

SCENARIO = """
atmosphere: clear_us76
ambient: {from: sky}
ground: {material: concrete, temperature: 290 K}
materials:
  coating: {components: [{reflection: lambertian, reflectance: 0.5}]}
entities:
  - {name: ball, shape: {model: ellipsoid, length: 3 m, width: 3 m, height: 3 m}, material: coating, temperature: 320 K, position: [0 m, 60 m, 2 m]}
limits: {temperature: [290 K, 400 K]}
cameras:
  - name: eye
    position: [0 m, 0 m, 3 m]
    look_at: ball
    film: {width: 32, height: 32, pitch: 15 um}
    field_of_view: 4 deg
    aperture: 2 mm
    exposure: 0.1 ms
    samples: 2
    channels:
      - {name: mw, response: {band: [3.7 um, 4.8 um]}, quantum_efficiency: 0.7}
      - {name: lw, response: {band: [8 um, 12 um]}, quantum_efficiency: 0.7}
    stages: [{stage: detector, full_well: 6.5e6, bits: 14, offset: 200, read_noise: 600}]
    truth: [entity]
"""


def scene_of(accuracy: str, output: list[str]) -> pitviper.Scene:
    """The ball seen by a camera that tells these quantities of each band."""
    return pitviper.Scene.load(SCENARIO, set={"accuracy": accuracy, **{f"cameras.eye.channels.{name}.output": output for name in BANDS}})


def draw(scene: pitviper.Scene, emissivity: float, temperature_K: float) -> pitviper.Frame:
    """The picture of a ball of this emissivity and temperature."""
    scene["materials.coating.components.0.reflectance"] = 1.0 - emissivity
    scene.command("temperature", entity="ball", value=f"{temperature_K} K")
    return scene.render()

# %% [markdown]
# ## The picture that is given
# As apparent temperatures, which the detector's noise is in; `snr` says how much of it.

# %%
frame = draw(scene_of("reference", ["apparent_temperature", "snr"]), *HIDDEN)
ball = frame["truth.entity"] == 1
seen = np.array([pitviper.band_radiance(frame[f"{name}.apparent_temperature"][ball], band, "photon/s") for name, band in BANDS.items()])
sigma = seen / np.array([frame[f"{name}.snr"][ball] for name in BANDS])

# %% [markdown]
# ## Gauss-Newton
# Slopes by differences: of emissivity over 0.05, as radiance is linear in it, of temperature over 0.5 K.

# %%
scene = scene_of("0.1 %", ["photon_radiance"])
steps = np.array([0.05, 0.5])


def residual(guess: np.ndarray) -> np.ndarray:
    """What the picture of a guess (emissivity, temperature) lacks, over the noise, shape (2, pixels)."""
    frame = draw(scene, *guess)
    return (seen - np.array([frame[f"{name}.photon_radiance"][ball] for name in BANDS])) / sigma


guess = np.array([0.9, 310.0])
for step in range(6):
    off = residual(guess)
    slopes = np.array([(off - residual(guess + steps * unit)).ravel() / steps.dot(unit) for unit in np.eye(2)]).T
    print(f"step {step}: emissivity {guess[0]:.5f}, temperature {guess[1]:.3f} K, cost per value {np.mean(off**2):.4f}")
    change = np.linalg.lstsq(slopes, off.ravel(), rcond=None)[0]
    guess = guess + change
    if abs(change[0]) < 1e-5:
        break
error = np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
print(f"emissivity  {guess[0]:.5f} +- {error[0]:.5f}, hidden {HIDDEN[0]:.5f}: off by {(guess[0] - HIDDEN[0]) / error[0]:+.2f} sigma")
print(f"temperature {guess[1]:.3f} +- {error[1]:.3f} K, hidden {HIDDEN[1]:.3f} K: off by {(guess[1] - HIDDEN[1]) / error[1]:+.2f} sigma")

# %% [markdown]
# ## The cost about it
# At each emissivity the temperature that fits best is taken: by both bands, and by each alone.

# %%
emissivities = np.linspace(0.6, 0.9, asked.points)
curves = {}
for name, bands in {"both bands": [0, 1], "mid-wave alone": [0], "long-wave alone": [1]}.items():
    costs, temperature_K = [], guess[1]
    for emissivity in emissivities:
        for _ in range(3):
            off = residual(np.array([emissivity, temperature_K]))[bands]
            slope = off - residual(np.array([emissivity, temperature_K + 1.0]))[bands]
            temperature_K += np.sum(off * slope) / np.sum(slope**2)
        costs.append(np.sum(off**2))
    curves[name] = (emissivities, costs)

picture = asked.out / "emissivity_from_picture_cost.png"
pitviper.chart(picture, curves, title="Cost of an emissivity, its temperature refitted", x="emissivity [1]", y="cost [1]", log_y=True)
frame.picture(asked.out / "emissivity_from_picture.png", layer="mw.apparent_temperature")
