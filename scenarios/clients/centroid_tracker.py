#!/usr/bin/env python3
"""A centroid tracker: keeps the brightest thing in the middle of a camera's picture, in lockstep. Begin it, and beside it:

    pitviper stream scenarios/track.yaml --clock lockstep --commands 7380 --video track.mp4

Guidance and tracking are the user's; this is the least that closes the loop: sky subtracted, centroid of what is left, camera turned by what it is off.
"""
import argparse
import math

import numpy as np

from pitviper_commands import Commands
from pitviper_ring import Ring

options = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
options.add_argument("--commands", default="7380", metavar="PLACE", help="as given to pitviper stream (default 7380)")
options.add_argument("--shared-memory", default="/pitviper", metavar="NAME", help="as given to pitviper stream (default /pitviper)")
options.add_argument("--frames", type=int, default=100, metavar="N", help="to steer (default 100)")
options.add_argument("--heading", type=float, default=0.0, metavar="DEG", help="where it looks first")
options.add_argument("--pitch", type=float, default=0.0, metavar="DEG", help="where it looks first")
options.add_argument("--field", type=float, default=1.5, metavar="DEG", help="horizontal field of view of the camera")
asked = options.parse_args()

commands, ring = Commands(asked.commands), Ring(asked.shared_memory, 30.0)
heading, pitch, focal_px = asked.heading, asked.pitch, 0.5 * ring.width / math.tan(math.radians(0.5 * asked.field))
right_rate = down_rate = 0.0  # pixels a frame: a target that crosses evenly is led
offs = []
for _ in range(asked.frames):
    said = commands.step(command="look", camera=ring.camera, heading=f"{heading} deg", pitch=f"{pitch} deg")
    picture = ring.next(10.0)[next(iter(ring.layers))].astype(float)
    light = np.maximum(picture - np.median(picture) - 6.0 * np.std(picture[:8]), 0.0)
    rows, columns = np.indices(light.shape)
    right = (light * (columns + 0.5)).sum() / max(light.sum(), 1e-9) - 0.5 * ring.width if light.any() else 0.0
    down = (light * (rows + 0.5)).sum() / max(light.sum(), 1e-9) - 0.5 * ring.height if light.any() else 0.0
    right_rate, down_rate = right_rate + 0.5 * right, down_rate + 0.5 * down
    heading += math.degrees(math.atan((right + right_rate) / focal_px)) / math.cos(math.radians(pitch))
    pitch -= math.degrees(math.atan((down + down_rate) / focal_px))
    offs.append(math.hypot(right, down))
    print(f"frame {said['frame']}: off by {right:+.2f}, {down:+.2f} pixels; truth {said['cameras'][0].get('target')}")
commands.send(end=True)
print(f"{asked.frames} frames, the centroid {offs[0]:.2f} pixels from the middle in the first, at most {max(offs[len(offs) // 2:]):.2f} in the second half")
