# %% [markdown]
# # Apparent temperature
# A thermal camera knows the radiance of a band and says which black body has as much. What a real surface (emissivity) and the air between (transmittance,
# light of its own) make of that is worked out here, and shown in a picture.

# %%
import argparse
import pathlib

import numpy as np

import pitviper

options = argparse.ArgumentParser(description="A table from radiance to apparent temperature, and what emissivity and air do to it.", allow_abbrev=False)
options.add_argument("--out", type=pathlib.Path, default=".", metavar="FOLDER", help="where the pictures go")
asked, _ = options.parse_known_args()
asked.out.mkdir(parents=True, exist_ok=True)

BAND = (3.7, 4.8)  # um
SKIN_K, AROUND_K = 308.0, 280.0

# %% [markdown]
# ## The table
# As a camera holds it: temperatures at even steps of log radiance, linear between. Exact is `apparent_temperature`.

# %%
temperatures_K = np.linspace(200.0, 900.0, 7001)
radiances = pitviper.band_radiance(temperatures_K, BAND)
back_K = pitviper.apparent_temperature(radiances, BAND)
print(f"there and back: at most {np.max(np.abs(back_K - temperatures_K)):.1e} K off")

nodes = np.linspace(np.log(radiances[0]), np.log(radiances[-1]), 256)
table_K = pitviper.apparent_temperature(np.exp(nodes), BAND)
looked_up_K = np.interp(np.log(radiances), nodes, table_K)
print(f"a table of {len(nodes)} entries: at most {np.max(np.abs(looked_up_K - temperatures_K)):.4f} K off")

# %% [markdown]
# ## Emissivity and air
# Radiance at the camera is transmittance x (emissivity x Planck(skin) + (1 - emissivity) x Planck(around)) + what the air between sends.

# %%
keys = {"cameras.tracker.channels.mw.output": "apparent_temperature", "cameras.tracker.truth": ["temperature", "range"]}
scene = pitviper.Scene.load(pitviper.home / "scenarios/jet_and_sky.yaml", set=keys)
wavelengths_um = np.linspace(*BAND, 400)
eye, jet = (np.array(scene.world(1.0)[kind][name]["position_m"]) for kind, name in (("cameras", "tracker"), ("entities", "jet")))
ahead = (jet - eye) / np.linalg.norm(jet - eye)


def apparent_K(emissivity: float, range_m: float) -> float:
    """Of a skin of this emissivity at a range."""
    leaves = emissivity * pitviper.planck(wavelengths_um, SKIN_K) + (1.0 - emissivity) * pitviper.planck(wavelengths_um, AROUND_K)
    air = scene.path(eye, eye + range_m * ahead, wavelengths_um)
    arrives = air["transmittance"] * leaves + air["path_radiance"]
    return pitviper.apparent_temperature(pitviper.band_integral(wavelengths_um, arrives, BAND), BAND)


ranges_m = np.geomspace(10.0, 10e3, 25)
curves = {f"emissivity {e:g}": (ranges_m / 1e3, [apparent_K(e, r) for r in ranges_m]) for e in (1.0, 0.9, 0.6, 0.3)}
for range_m in (10.0, 1e3, 10e3):
    transmittance = scene.band_transmittance(eye, eye + range_m * ahead, BAND, SKIN_K)
    told = ", ".join(f"{apparent_K(e, range_m):.1f} K ({e:g})" for e in (1.0, 0.9, 0.6, 0.3))
    print(f"{range_m / 1e3:5.2f} km, transmittance {transmittance:.3f}: a skin of {SKIN_K:g} K seems to have (by emissivity) {told}")

# %% [markdown]
# ## A picture
# The jet as the camera sees it: its paint emits less than a black body, and a part of that is lost on the way. Painted ideally black it has what the formula
# says.

# %%
frame = scene.render(1.0)
skin = np.abs(frame["truth.temperature"] - SKIN_K) < 0.5
seen_K = np.median(frame["mw.apparent_temperature"][skin])
range_m = float(np.median(frame["truth.range"][skin]))
paint = scene.material("grey_aircraft_paint").emissivity(wavelengths_um).mean()
scene["entities.jet.material"] = "blackbody"
black_K = np.median(scene.render(1.0)["mw.apparent_temperature"][skin])
print(f"in the picture at {range_m:.0f} m: a painted skin (emissivity {paint:.2f}) seems to have {seen_K:.2f} K")
print(f"a black one {black_K:.2f} K, by the formula {apparent_K(1.0, range_m):.2f} K")

frame.picture(asked.out / "apparent_temperature.png", layer="mw.apparent_temperature", range=(275.0, 315.0))
picture = asked.out / "apparent_temperature_chart.png"
title = f"A skin of {SKIN_K:g} K, {AROUND_K:g} K around it"
pitviper.chart(picture, curves, title=title, x="range [km]", y="apparent temperature [K]", log_x=True)
