"""Frames of a pitviper stream from shared memory, as numpy arrays without a copy.

    from pitviper_ring import Ring
    for frame in Ring("/pitviper"):
        counts = frame["mw.counts"]            # uint16 [height, width], in place: valid until the ring comes round
        print(frame.sequence, counts.max(), frame.sight_ecef, frame.held())

The layout is that of sim/stream/ring/pitviper_stream.h, version 1. Reading only: nothing here can disturb the writer or other readers.
"""
import ctypes
import mmap
import os
import time

import numpy as np

LAYERS = 16
LAYER = np.dtype([("name", "S64"), ("unit", "S32"), ("radiance_unit", "S32"), ("type", "u4"), ("maximum", "u4"), ("offset", "u8")])
HEADER = np.dtype([("magic", "S8"), ("version", "u4"), ("header_bytes", "u4"), ("slot_bytes", "u8"), ("total_bytes", "u8"), ("slots", "u4"),
                   ("layers", "u4"), ("width", "u4"), ("height", "u4"), ("writer_pid", "i8"), ("rate_hz", "f8"), ("program", "S32"),
                   ("scenario", "S128"), ("camera", "S64"), ("layer", LAYER, LAYERS), ("published", "u8"), ("wake", "u4"), ("ended", "u4")])
FRAME = np.dtype([("lock", "u8"), ("sequence", "u8"), ("host_frame", "u8"), ("flags", "u8"), ("time_ns", "i8"), ("exposure_start_ns", "i8"),
                  ("exposure_end_ns", "i8"), ("render_start_tai_ns", "i8"), ("render_end_tai_ns", "i8"), ("due_tai_ns", "i8"),
                  ("sent_tai_ns", "i8"), ("pose_age_ns", "i8"), ("dropped", "u8"), ("late", "u8"), ("repeated", "u8"), ("accuracy", "f8"),
                  ("predicted_error", "f8"), ("position_ecef_m", "f8", 3), ("latitude_deg", "f8"), ("longitude_deg", "f8"), ("height_m", "f8"),
                  ("orientation_ecef_wxyz", "f8", 4), ("sight_ecef", "f8", 3), ("truth_column_px", "f8"), ("truth_row_px", "f8"),
                  ("exposure_s", "f8"), ("gain", "f8", LAYERS), ("offset", "f8", LAYERS)])
LATE, REPEATED, OUTSIDE_LIMITS, SATURATED = 1, 2, 4, 8
_libc = ctypes.CDLL(None, use_errno=True)
_FUTEX = {"x86_64": 202, "aarch64": 98}.get(os.uname().machine, 0)


class _Time(ctypes.Structure):
    _fields_ = [("s", ctypes.c_long), ("ns", ctypes.c_long)]


def _lives(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True


class Frame:
    """One frame in place: its record's fields as attributes, its layers by name."""

    def __init__(self, ring, number):
        self._ring, self._number = ring, number
        self._at = ring._header_bytes + number % ring._slots * ring._slot_bytes
        self._record = np.frombuffer(ring._map, FRAME, 1, self._at)[0]

    def __getattr__(self, name):
        value = self._record[name]
        return value.item() if value.shape == () else value

    def __getitem__(self, layer):
        """uint16 counts, or float32 in the layer's unit; [height, width], row 0 at the top."""
        of = self._ring.layers[layer]
        shape = self._ring.height, self._ring.width
        return np.frombuffer(self._ring._map, np.uint16 if of["type"] == 0 else np.float32, shape[0] * shape[1], self._at + int(of["offset"])).reshape(shape)

    def radiance(self, layer):
        """W/(m2 sr) on the axis: a copy."""
        k = list(self._ring.layers).index(layer)
        return self.offset[k] + self.gain[k] * self[layer].astype(np.float64)

    def held(self):
        """Whether it is still the frame that it was: False where the ring has come round meanwhile."""
        return int(np.frombuffer(self._ring._map, np.uint64, 1, self._at)[0]) == 2 * self._number + 2


class Ring:
    """Iterates over frames as they come; ends with the stream. `lost`: frames that were overwritten before they were read."""

    def __init__(self, name="/pitviper", wait_s=0.0):
        until = time.monotonic() + wait_s
        while True:
            try:
                with open("/dev/shm/" + name.lstrip("/"), "rb") as file:
                    self._map = mmap.mmap(file.fileno(), 0, mmap.MAP_SHARED, mmap.PROT_READ)
                if len(self._map) >= HEADER.itemsize and self._map[:8] == b"pitviper" and _lives(int(np.frombuffer(self._map, HEADER, 1)[0]["writer_pid"])):
                    break
                raise FileNotFoundError(name)
            except (FileNotFoundError, ValueError):
                if time.monotonic() >= until:
                    raise FileNotFoundError(f"no pitviper stream at {name}: is 'pitviper stream' running?") from None
                time.sleep(0.01)
        self._head = np.frombuffer(self._map, HEADER, 1)[0]
        if self._head["version"] != 1:
            raise ValueError(f"{name} is of version {self._head['version']} of the layout, this reader of 1")
        self._header_bytes, self._slots, self._slot_bytes = (int(self._head[k]) for k in ("header_bytes", "slots", "slot_bytes"))
        self.width, self.height = int(self._head["width"]), int(self._head["height"])
        self.camera, self.scenario = self._head["camera"].decode(), self._head["scenario"].decode()
        self.layers = {layer["name"].decode(): layer for layer in self._head["layer"][: self._head["layers"]]}
        self._wake_address = np.frombuffer(self._map, np.uint8).ctypes.data + HEADER.fields["wake"][1]
        self._next, self.lost = int(self._head["published"]), 0

    def next(self, timeout_s=None):
        """The next frame; None where none comes in time, or the stream has ended (`ended`)."""
        until = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            wake, ended, published = int(self._head["wake"]), self.ended, int(self._head["published"])  # in this order: a last frame is not missed
            while self._next < published:
                oldest = max(0, published - self._slots + 1)
                if self._next < oldest:
                    self.lost += oldest - self._next
                    self._next = oldest
                frame = Frame(self, self._next)
                self._next += 1
                if frame.held():
                    return frame
                self.lost += 1
            left = 1.0 if until is None else min(1.0, until - time.monotonic())
            if ended or left <= 0.0:
                return None
            if _FUTEX:
                _libc.syscall(_FUTEX, ctypes.c_void_p(self._wake_address), 0, ctypes.c_uint(wake), ctypes.byref(_Time(int(left), int(left % 1 * 1e9))), None, 0)
            else:
                time.sleep(0.0005)

    @property
    def ended(self):
        """Said by the writer, or it was killed."""
        return bool(self._head["ended"]) or not _lives(int(self._head["writer_pid"]))

    def __iter__(self):
        while (frame := self.next()) is not None:
            yield frame


if __name__ == "__main__":
    import argparse

    options = argparse.ArgumentParser(description="Prints what comes through a pitviper stream's shared memory.")
    options.add_argument("name", nargs="?", default="/pitviper", help="of the object (default /pitviper)")
    options.add_argument("--wait", type=float, default=10.0, metavar="S", help="how long to wait for the stream to begin")
    options.add_argument("--quiet", action="store_true", help="the last line alone")
    asked = options.parse_args()
    ring, count = Ring(asked.name, asked.wait), 0
    print(f"{ring.scenario}, camera {ring.camera}, {ring.width} x {ring.height}, layers {', '.join(ring.layers)}")
    for frame in ring:
        count += 1
        if not asked.quiet:
            name = next(iter(ring.layers))
            print(f"frame {frame.sequence}: {name} {frame[name].min()} to {frame[name].max()}, flags {frame.flags}, held {frame.held()}")
    print(f"{count} frames, {ring.lost} lost")
