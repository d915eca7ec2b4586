# %% [markdown]
# # Labelled pictures
# A jet in random places and attitudes, drawn by `pitviper sweep`, as a COCO data set (pictures, boxes, masks) and as one HDF5 file. The masks are decoded
# here and held against the HDF5's truth, pixel by pixel; sixteen pictures with their boxes are laid on a sheet.

# %%
import argparse
import json
import pathlib
import struct
import subprocess
import zlib

import h5py
import numpy as np

import pitviper

options = argparse.ArgumentParser(description="Pictures of a jet with boxes and masks, as COCO and HDF5.", allow_abbrev=False)
options.add_argument("--out", type=pathlib.Path, default=".", metavar="FOLDER", help="where the data set goes")
options.add_argument("--samples", type=int, default=200, metavar="N", help="pictures (default 200)")
asked, _ = options.parse_known_args()
asked.out.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## The sweep
# `vary` says what is drawn by chance, `set` which keys of the scenario follow it. Within `limits` one plan of the wavelengths holds for all pictures.

# %%
SWEEP = f"""
sweep: labelled_pictures
scenario: {json.dumps(str(pitviper.home / "scenarios/jet_and_sky.yaml"))}
design: latin_hypercube
samples: {asked.samples}
vary:
  - {{name: range, log_uniform: [300 m, 3000 m]}}
  - {{name: right, uniform: [-1 deg, 1 deg]}}
  - {{name: up, uniform: [-0.7 deg, 0.7 deg]}}
  - {{name: heading, uniform: [0 deg, 360 deg]}}
  - {{name: pitch, uniform: [-30 deg, 30 deg]}}
  - {{name: roll, uniform: [-60 deg, 60 deg]}}
set:
  limits: {{range: [250 m, 3.5 km]}}
  entities.jet.motion:
    - time: 0 s
      position: ["= $range * tan($right)", $range, "= 200 m + $range * tan($up)"]
      heading: $heading
      pitch: $pitch
      roll: $roll
  cameras:
    - name: eye
      position: [0 m, 0 m, 200 m]
      heading: 0 deg
      film: {{width: 160, height: 120, pitch: 15 um}}
      field_of_view: 3 deg
      aperture: 60 mm
      exposure: 0.5 ms
      channels: [{{name: mw, response: {{band: [3.7 um, 4.8 um]}}, quantum_efficiency: insb_mwir, output: counts}}]
      stages: [{{stage: detector, full_well: 6.5e6, bits: 14, offset: 200, read_noise: 600}}]
      truth: [entity, range, temperature, targets]
sinks: [{{sink: coco, categories: {{jet: aircraft}}}}, {{sink: hdf5}}]
"""
data = asked.out / f"labelled_pictures_{asked.samples}"
sweep = data.with_suffix(".yaml")
sweep.write_text(SWEEP)
print(subprocess.run([pitviper.program, "sweep", sweep, "--out", data], check=True, stdout=subprocess.PIPE, text=True).stdout.strip())

# %% [markdown]
# ## Masks

# %%
def mask_of(counts: str, height: int, width: int) -> np.ndarray:
    """COCO's compressed run lengths as a mask, shape (height, width). Runs go down the columns, of 0 and 1 in turn; each is written in groups of five bits, the
    lowest first, as what it has more than the run two before."""
    runs: list[int] = []
    value = shift = 0
    for letter in counts:
        group = ord(letter) - 48
        value |= (group & 31) << shift
        shift += 5
        if not group & 32:  # the last of its run; its fifth bit is the sign
            if group & 16:
                value -= 1 << shift
            runs.append(value + (runs[-2] if len(runs) > 2 else 0))
            value = shift = 0
    return np.repeat(np.arange(len(runs)) % 2, runs).astype(bool).reshape(width, height).T


told = json.loads((data / "annotations.json").read_text())
with h5py.File(data / "eye.h5") as file:
    pictures, entities, numbers = file["mw.counts"][:], file["truth.entity"][:], list(file["number"])
frame_of = {image["id"]: numbers.index(image["number"]) for image in told["images"]}
different = 0
for a in told["annotations"]:
    mask = mask_of(a["segmentation"]["counts"], *a["segmentation"]["size"])
    different += np.count_nonzero(mask != (entities[frame_of[a["image_id"]]] == a["entity"]))
areas = [a["area"] for a in told["annotations"]]
print(f"{len(numbers)} pictures, {len(areas)} masks of {min(areas)} to {max(areas)} pixels; {different} pixels differ from truth.entity")

# %% [markdown]
# ## A sheet

# %%
def write_png(file: pathlib.Path, rgb: np.ndarray) -> None:
    """An array (height, width, 3) of bytes as a PNG."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    height, width, _ = rgb.shape
    rows = np.hstack([np.zeros((height, 1), np.uint8), rgb.reshape(height, 3 * width)])  # a 0 before each row: stored as it is
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))


boxes = {frame_of[a["image_id"]]: a["bbox"] for a in told["annotations"]}
tiles = []
for k in range(min(16, len(pictures)) // 4 * 4):
    above = pictures[k] - np.percentile(pictures[k], 1)
    grey = (255 * np.clip(0.05 + np.arcsinh(above / 50.0) / 6.0, 0.0, 1.0)).astype(np.uint8)
    tile = np.repeat(grey[..., None], 3, axis=2).repeat(2, axis=0).repeat(2, axis=1)
    if k in boxes:
        left, top, width, height = (2 * v for v in boxes[k])
        framed = tile[max(top - 2, 0) : top + height + 2, max(left - 2, 0) : left + width + 2]
        inside = framed[1:-1, 1:-1].copy()
        framed[:] = (0, 220, 120)
        framed[1:-1, 1:-1] = inside
    tiles.append(np.pad(tile, ((2, 2), (2, 2), (0, 0)), constant_values=40))
write_png(asked.out / "labelled_pictures.png", np.vstack([np.hstack(tiles[k : k + 4]) for k in range(0, len(tiles), 4)]))
