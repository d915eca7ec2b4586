"""Scenes from Python: values, memory, keys, commands, noise, threads, signals."""

import functools
import gc
import os
import random
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
import unittest
import weakref

import numpy as np
import pitviper
from pitviper import InputError, Scene

import support
from support import Folder, address, attributes_that_differ, bench, detector, layers_that_differ, run_program, same_bits, scenarios

SMALL = {"cameras.seeker.film": {"width": 64, "height": 64, "pitch": "20 um"}, "audit": 0}
LIMITS = {
    "limits": {"range": ["500 m", "5 km"], "temperature": ["250 K", "900 K"]},
    "accuracy": "1 %",
    "cameras.tracker.film": {"width": 80, "height": 60, "pitch": "15 um"},
}
JET = scenarios / "jet_and_sky.yaml"


def cold():
    """Keys that no plan in a cache is made for, and whose plan takes seconds."""
    return {"entities.jet.temperature": f"{random.uniform(300, 320):.9f} K", "accuracy": "0.2 %"}


@functools.lru_cache
def jet_frame():
    """Of the scenario as it is, at 0.2 s."""
    with Scene.load(JET) as scene:
        return scene.render(0.2)


class Case(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Folder()
        cls.addClassCleanup(cls.folder.remove)

    def scene(self, *given, **keys):
        scene = Scene.load(*given, **keys)
        self.addCleanup(scene.close)
        return scene

    def same_frame(self, one, other):
        self.assertEqual(layers_that_differ(one, other), [])


class AgainstTheProgram(Case):
    """Bit for bit what `pitviper run` writes."""

    def same(self, drawn, read):
        self.same_frame(drawn, read)
        self.assertEqual((drawn.units, drawn.camera, drawn.number, drawn.shape), (read.units, read.camera, read.number, read.shape))
        self.assertEqual(drawn.time, read.time)
        self.assertEqual(attributes_that_differ(drawn.attributes, read.attributes), [])

    def compare(self, scenario, sets, frames, read=None):
        first, last = frames
        read = read or run_program(self.folder.path, scenario, sets, f"{first}:{last}")
        self.assertEqual(len(read), last - first + 1)
        scene = self.scene(scenario, set=sets)
        drawn = [scene.render(scene.times[k]) for k in range(first, last + 1)]
        for d, r in zip(drawn, read):
            self.same(d, r)
        return scene, drawn, read

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.written = run_program(cls.folder.path, scenarios / "first_light.yaml", SMALL, "24")[0]
        with Scene.load(scenarios / "first_light.yaml", set=SMALL) as scene:
            cls.drawn = scene.render(scene.times[24])

    def test_first_light_in_three_bands_with_a_flare(self):
        self.same(self.drawn, self.written)
        radiances, truth = {f"{c}.radiance" for c in ("mw", "lw", "vis")}, {f"truth.{t}" for t in ("range", "entity", "part", "temperature")}
        self.assertEqual(set(self.drawn), radiances | truth | {"mw.flux"})
        self.assertGreater(self.drawn["vis.radiance"].max(), 10 * np.median(self.drawn["vis.radiance"]))  # the flare burns

    def test_jet_and_sky_three_frames_in_order(self):
        scene, drawn, read = self.compare(JET, None, (0, 2))
        self.assertFalse(same_bits(drawn[0]["mw.radiance"], drawn[2]["mw.radiance"]))
        # The program audits some of its first frame.
        audited = scene.render(scene.times[0], audit=True)
        self.assertEqual(attributes_that_differ(audited.attributes, read[0].attributes, audit=True), [])
        self.assertIn("pitviper.audit.mw.largest", audited.attributes)
        scene.reset()
        again = [scene.next() for _ in range(3)]
        self.assertEqual([f.number for f in again], [0, 1, 2])
        for a, d in zip(again, drawn):
            self.same_frame(a, d)

    def test_insb_camera_with_noise_at_its_first_frame_and_at_frame_5(self):
        film = {"cameras.seeker.film": {"width": 96, "height": 80, "pitch": "15 um"}, "audit": 0}
        read = run_program(self.folder.path, scenarios / "insb_camera.yaml", film, "0:5")
        scene, (first,), _ = self.compare(scenarios / "insb_camera.yaml", film, (0, 0), read[:1])
        self.same_frame(scene.render(scene.times[5]), read[5])
        self.assertEqual(first.units, {"mw.counts": "count", "mw.apparent_temperature": "K", "mw.radiance": "W/(m2 sr)"})
        self.assertTrue(layers_that_differ(read[0], read[5]))
        # In any order: what it was before leaves nothing.
        self.same_frame(scene.render(0.0), first)

    def test_track_within_limits(self):
        self.compare(scenarios / "track.yaml", {"audit": 0}, (0, 2))

    def test_track_on_a_gimbal(self):
        gimbal = {"driver": "centroid", "rate": "30 deg/s", "lag": "20 ms", "azimuth": "40 deg", "elevation": ["-40 deg", "40 deg"]}
        gimbal["tracker"] = {"channel": "mw", "threshold": 6, "gate": [60, 60]}
        gimbal["jitter"] = {"rms": "200 urad", "corner": "30 Hz"}
        sets = {"audit": 0, "cameras.tracker.look_at": "jet", "cameras.tracker.gimbal": gimbal}
        scene, drawn, read = self.compare(scenarios / "track.yaml", sets, (0, 2))
        self.assertEqual(drawn[2].attributes["pitviper.gimbal.driver"], "centroid")
        # Out of order it begins as a run of that frame would.
        self.same_frame(scene.render(scene.times[2]), drawn[2])
        self.same_frame(scene.render(scene.times[0]), read[0])

    def test_a_detector_that_remembers(self):
        sets = {"cameras.eye.stages.0.lag": 0.3, "entities.plate.temperature": [["0 s", "300 K"], ["0.1 s", "308 K"]]}
        scene, drawn, _ = self.compare(detector(), sets, (2, 4))
        self.same_frame(scene.render(scene.times[3]), drawn[1])
        self.same_frame(scene.render(scene.times[2]), drawn[0])

    def test_attributes_have_one_type(self):
        # What is read from a file is used as what was drawn.
        drawn, read = self.drawn.attributes, self.written.attributes
        self.assertEqual([(n, type(v), type(read[n])) for n, v in drawn.items() if type(v) is not type(read[n])], [])

    def test_channels_come_first(self):
        for frame in (self.drawn, self.written):
            kinds = [name.startswith("truth.") for name in frame]
            self.assertEqual(kinds, sorted(kinds))

    def test_predicted_errors_are_of_their_layers(self):
        # Each is its channel's, as the header says.
        channels = {name: self.drawn.attributes[f"pitviper.predicted_error.{name}"] for name in ("mw", "lw", "vis")}
        expected = {layer: channels[layer.split(".")[0]] for layer in self.drawn if not layer.startswith("truth.")}
        self.assertEqual(self.drawn.predicted_error, expected)
        self.assertEqual(self.written.predicted_error, {})

    def test_a_saved_frame_is_the_frame(self):
        frame = self.scene(detector()).render()
        for ending in ("exr", "fits", "tiff", "tif", "raw", "hdr", "json"):
            with self.subTest(ending):
                file = self.folder.path / f"saved.{ending}"
                frame.save(file)
                back = pitviper.read_frame(file)
                self.same_frame(frame, back)
                self.assertEqual((frame.units, frame.number, frame.camera), (back.units, back.number, back.camera))
        zipped = self.folder.path / "zipped.exr"
        frame.save(str(zipped), compression="zip")
        self.same_frame(frame, pitviper.read_frame(str(zipped)))

    def test_what_cannot_be_saved_or_read(self):
        frame = self.scene(bench()).render()
        for file in ("x.bogus", "x", ""):
            with self.subTest(file), self.assertRaises(InputError):
                frame.save(self.folder.path / file)
        with self.assertRaises(InputError):
            frame.save(self.folder.path / "x.exr", compression="zop")
        with self.assertRaises(OSError):
            frame.save(self.folder.path / "no" / "such" / "x.exr")
        broken = self.folder.path / "broken.exr"
        frame.save(broken)
        broken.write_bytes(broken.read_bytes()[:-700])
        with self.assertRaises(InputError):
            pitviper.read_frame(broken)
        with self.assertRaises(InputError):
            pitviper.read_frame(self.folder.path / "none.exr")
        with self.assertRaises(InputError):
            pitviper.frames_in(self.folder.path / "nowhere")
        with self.assertRaises((InputError, KeyError)):
            frame.picture(self.folder.path / "x.png", layer="nope")
        for ends in ((2.0, 1.0), (float("nan"), 1.0)):
            with self.subTest(ends), self.assertRaises(InputError):
                frame.picture(self.folder.path / "x.png", range=ends)

    def test_pictures(self):
        frame = self.scene(bench()).render()
        file = self.folder.path / "picture.png"
        frame.picture(file, layer="mw.radiance", range=(0.0, 3.0))
        self.assertEqual(file.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(frame._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(self.scene(bench())._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")


class Memory(Case):
    def test_arrays_are_views_of_the_frame(self):
        frame = self.scene(detector()).render()
        for name in frame:
            with self.subTest(name):
                a, b = frame[name], frame[name]
                self.assertEqual(address(a), address(b))
                self.assertTrue(np.shares_memory(a, b))
                self.assertEqual((a.dtype, a.shape, a.flags.c_contiguous, a.flags.owndata), (np.float32, frame.shape, True, False))
        self.assertEqual(len({address(frame[name]) for name in frame}), len(frame))

    def test_arrays_are_read_only(self):
        array = self.scene(bench()).render()["mw.radiance"]
        before = array.copy()
        with self.assertRaises(ValueError):
            array[0, 0] = 1.0
        with self.assertRaises(ValueError):
            array.setflags(write=True)
        with self.assertRaises(ValueError):
            np.add(array, 1.0, out=array)
        self.assertTrue(same_bits(array, before))

    def test_arrays_outlive_frame_and_scene(self):
        scene = Scene.load(bench())
        frame = scene.render()
        array, before = frame["mw.radiance"], frame["mw.radiance"].copy()
        del frame
        scene.render(1.0, noise=3)
        scene.close()
        del scene
        gc.collect()
        filler = [np.full(array.shape, 7.0, np.float32) for _ in range(200)]
        self.assertTrue(same_bits(array, before))
        del filler

    def test_a_frame_outlives_its_scene(self):
        scene = Scene.load(bench())
        frame = scene.render()
        scene.close()
        del scene
        gc.collect()
        self.assertAlmostEqual(frame["mw.radiance"].mean() / pitviper.band_radiance(300.0, (3.6, 4.9)), 1.0, delta=1e-3)
        self.assertEqual(frame.attributes["pitviper.camera"], "eye")

    def test_a_large_frame_is_not_copied(self):
        scene = self.scene(bench(640, 512))
        frame = scene.render()
        self.assertEqual(frame["mw.radiance"].nbytes, 640 * 512 * 4)
        resident = support.resident_kB()
        tracemalloc.start()
        held = [frame["mw.radiance"] for _ in range(1000)]
        traced = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        self.assertEqual({address(a) for a in held}, {address(frame["mw.radiance"])})
        # A thousand copies are 1.3 GB; a thousand views 100 to 200 bytes each and what is beside them.
        self.assertLess(traced, 1e6)
        self.assertLess(support.resident_kB() - resident, 5000)

    def test_frames_do_not_share(self):
        scene = self.scene(bench())
        one, other = scene.render(0.0), scene.render(0.04)
        self.assertFalse(np.shares_memory(one["mw.radiance"], other["mw.radiance"]))

    def test_a_frame_is_a_mapping(self):
        frame = self.scene(detector()).render()
        self.assertEqual(list(frame), ["mw.counts", "mw.electrons"])
        self.assertEqual(len(frame), 2)
        self.assertIn("mw.counts", frame)
        self.assertNotIn("nope", frame)
        self.assertEqual([n for n, _ in frame.items()], list(frame))
        self.assertEqual(list(frame.units), list(frame))
        with self.assertRaises(KeyError) as caught:
            frame["mw.count"]
        self.assertIn("mw.counts", str(caught.exception))
        self.assertEqual(frame.get("nope", 3), 3)
        self.assertNotIn(0, frame)

    def test_frames_are_compared(self):
        scene = self.scene(bench())
        one, other = scene.render(0.0), scene.render(0.0)
        self.assertTrue(one == one)
        self.assertIn(one == other, (True, False))
        self.assertIn(other, [one, other])
        self.assertEqual(len({one, other, one}), 2)


class Keys(Case):
    def test_get_and_set(self):
        scene = self.scene(JET)
        self.assertEqual(scene["entities.jet.temperature"], "308 K")
        self.assertEqual(scene["entities.0.temperature"], "308 K")
        self.assertEqual(scene["cameras.tracker.film"], {"width": 320, "height": 240, "pitch": "15 um"})
        self.assertEqual(scene["cameras.tracker.film.width"], 320)
        self.assertEqual(scene["cameras.tracker.position"], ["0 m", "0 m", "5 m"])
        scene["entities.jet.temperature"] = "37 degC"
        self.assertEqual(scene["entities.jet.temperature"], "37 degC")
        self.assertAlmostEqual(scene.world()["entities"]["jet"]["temperatures_K"][0], 310.15, delta=1e-9)
        scene["cameras.tracker.position"] = ["0 m", "1 m", "0.002 km"]
        self.assertEqual(scene.world()["cameras"]["tracker"]["position_m"], (0.0, 1.0, 2.0))
        scene["cameras.tracker.samples"] = np.int32(2)
        self.assertEqual(scene["cameras.tracker.samples"], 2)
        self.assertEqual(scene.scenario()["cameras"][0]["samples"], 2)

    def test_values_of_numpy(self):
        scene = self.scene(bench())
        for key, value, plain in (
            ("cameras.eye.samples", np.int32(2), 2),
            ("cameras.eye.samples", np.array(3), 3),
            ("cameras.eye.motion_blur", np.bool_(True), True),
            ("cameras.eye.optics", np.float32(0.5), 0.5),
            ("entities.plate.position", np.array(["0 m", "20 m", "1 m"]), ["0 m", "20 m", "1 m"]),
            ("name", np.str_("other"), "other"),
        ):
            with self.subTest(key, value=value):
                scene[key] = value
                self.assertEqual((scene[key], type(scene[key])), (plain, type(plain)))

    def test_numbers_keep_all_their_digits(self):
        scene = self.scene(bench())
        for number in (0.1 + 0.2, 1 / 3, np.float64(2 / 7)):
            scene["cameras.eye.optics"] = number
            self.assertEqual(scene["cameras.eye.optics"], float(number))
        for number in (0, 7, 10**15 + 1, 2**53 - 1):
            scene["seed"] = number
            self.assertEqual((scene["seed"], type(scene["seed"])), (number, int))

    def test_what_stands_there_may_be_written_back(self):
        scene = self.scene(JET, set=LIMITS)
        before = scene.render(0.2)
        for key, value in scene.scenario().items():
            scene[key] = value
            self.assertEqual(scene[key], value)
        self.same_frame(scene.render(0.2), before)
        self.same_frame(self.scene(scene.scenario(), base=scenarios).render(0.2), before)

    def test_a_camera_of_the_bench(self):
        scene = self.scene(bench())
        (eye,) = scene.cameras
        self.assertEqual((eye["name"], eye["width"], eye["height"], eye["layers"]), ("eye", 48, 32, {"mw.radiance": "W/(m2 sr)"}))
        self.assertEqual((scene.name, scene.step, len(scene.times), scene.times[1], scene.now), ("bench", 0.04, 50, 0.04, 0.0))

    def test_units(self):
        scene = self.scene(bench())
        in_kelvin = self.radiance(scene)
        scene["entities.plate.temperature"] = "26.85 degC"
        np.testing.assert_allclose(self.radiance(scene), in_kelvin, rtol=1e-6)
        for wrong in ("300", 300, "300 m", "300 Kelvins", "", "hot", True, None, [300], {"a": 1}):
            with self.subTest(wrong), self.assertRaises(InputError):
                scene["entities.plate.temperature"] = wrong
        np.testing.assert_allclose(self.radiance(scene), in_kelvin, rtol=1e-6)

    def radiance(self, scene):
        return scene.render(0.0)["mw.radiance"]

    def test_several_at_once(self):
        scene = self.scene(bench())
        keys = {"entities.plate.temperature": "310 K", "cameras.eye.film": {"width": 16, "height": 8, "pitch": "20 um"}}
        scene.set(keys)
        frame = scene.render()
        self.assertEqual(frame.shape, (8, 16))
        self.assertAlmostEqual(frame["mw.radiance"].mean() / pitviper.band_radiance(310.0, (3.6, 4.9)), 1.0, delta=1e-3)
        self.same_frame(frame, self.scene(bench(), set=keys).render())
        # Each alone is a mistake: focal length, aperture and f-number go together.
        for wrong in ({"cameras.eye.f_number": 4}, {"cameras.eye.f_number": 4, "cameras.eye.aperture": "6 mm"}):
            with self.subTest(wrong), self.assertRaises(InputError):
                scene.set(wrong)
        scene.set({"cameras.eye.f_number": 4, "cameras.eye.aperture": "5 mm"})
        self.assertEqual(scene["cameras.eye.f_number"], 4)

    def test_a_key_in_a_map_that_was_set(self):
        scene = self.scene(bench())
        scene["cameras.eye.film.width"] = 20
        scene["cameras.eye.film"] = {"width": 16, "height": 8, "pitch": "20 um"}
        self.assertEqual(scene.render().shape, (8, 16))
        scene["cameras.eye.film.width"] = 24
        self.assertEqual(scene.render().shape, (8, 24))
        # The same by set(): the newest holds.
        scene.set({"cameras.eye.film": {"width": 12, "height": 8, "pitch": "20 um"}})
        self.assertEqual(scene.render().shape, (8, 12))

    def test_a_failed_set_changes_nothing(self):
        scene = self.scene(JET)
        before = scene.render(0.2)
        for wrong in (
            {"entities.jet.temperature": "-3 K"},
            {"entities.jet.temperature": "320 K", "entities.jet.nothing": 1},
            {"entities.jet.temperature": "320 K", "cameras.tracker.exposure": float("nan")},
            {"entities.jot.temperature": "320 K"},
            {"cameras.tracker.position": [float("nan"), "0 m", "0 m"]},
            {"cameras.tracker.position": ["0 m", "0 m"]},
            {"": 1},
        ):
            with self.subTest(wrong), self.assertRaises(InputError):
                scene.set(wrong)
        with self.assertRaises(TypeError):
            scene["entities.jet.temperature"] = object()
        self.assertEqual(scene["entities.jet.temperature"], "308 K")
        self.same_frame(scene.render(0.2), before)

    def test_set_back_gives_the_same_bits(self):
        scene = self.scene(JET, set=LIMITS)
        before = scene.render(0.2)
        scene["entities.jet.temperature"] = "330 K"
        other = scene.render(0.2)
        self.assertFalse(same_bits(other["mw.radiance"], before["mw.radiance"]))
        scene["entities.jet.temperature"] = "308 K"
        self.same_frame(scene.render(0.2), before)

    def within_limits(self, key, value):
        """Drawn by the plan there is; it agrees with a fresh scene's within what is asked."""
        scene = self.scene(JET, set=LIMITS)
        before = scene.render(0.2)
        scene[key] = value
        frame = scene.render(0.2)
        self.assertEqual(frame.attributes["pitviper.plan"], before.attributes["pitviper.plan"])
        self.assertFalse(frame.outside_limits)
        self.assertFalse(same_bits(frame["mw.radiance"], before["mw.radiance"]))
        fresh = self.scene(JET, set={**LIMITS, key: value}).render(0.2)
        np.testing.assert_allclose(frame["mw.radiance"], fresh["mw.radiance"], rtol=0.01)
        for name in ("pitviper.scenario_sha256", "pitviper.scenario_content"):
            self.assertEqual(frame.attributes[name], fresh.attributes[name])

    def test_what_is_within_limits_is_planned(self):
        scene = self.scene(JET, set=LIMITS)
        scene.render(0.2)
        # Another each time, which no cache has a plan for.
        kelvin, metres = random.uniform(320, 340), random.uniform(0, 90)
        for key, value in (("entities.jet.temperature", f"{kelvin:.9f} K"), ("cameras.tracker.position", ["0 m", f"{metres:.9f} m", "5 m"])):
            with self.subTest(key):
                scene[key] = value
                self.assertTrue(scene.planned())

    def test_a_temperature_within_limits_needs_no_plan(self):
        self.within_limits("entities.jet.temperature", "340 K")

    def test_a_camera_moved_within_limits_needs_no_plan(self):
        self.within_limits("cameras.tracker.position", ["40 m", "100 m", "8 m"])

    def test_a_field_of_view_within_limits_needs_no_plan(self):
        self.within_limits("cameras.tracker.field_of_view", "1.2 deg")

    def test_a_body_moved_within_limits_needs_no_plan(self):
        motion = [{"time": "0 s", "position": ["-240 m", "1.9 km", "650 m"]}, {"time": "2 s", "position": ["240 m", "1.9 km", "650 m"]}]
        self.within_limits("entities.jet.motion", motion)

    def test_a_plan_for_variations_holds_at_them(self):
        # The sky beside the jet, towards the sun's side and away from it, against every wavelength in double precision.
        small = {**LIMITS, "cameras.tracker.film": {"width": 16, "height": 12, "pitch": "75 um"}}
        scene = self.scene(JET, set=small)

        def places(k):
            angle = 2.0 * np.pi * k / 8.0
            where = [f"{1500.0 * np.cos(angle)} m", f"{1500.0 * np.sin(angle)} m", "600 m"]
            return {"entities.jet.motion": [{"time": "0 s", "position": where}]}

        scene.plan_for([places(k) for k in range(8)])
        plans = set()
        for k in (0.5, 5.5):
            scene.set(places(k))
            sky = scene.render(0.0)
            plans.add(sky.attributes["pitviper.plan"])
            exact = self.scene(JET, set={**small, **places(k), "accuracy": "reference"}).render(0.0)
            with self.subTest(k):
                self.assertLessEqual(abs(sky["mw.radiance"][0, 0] / exact["mw.radiance"][0, 0] - 1.0), 0.01)
        self.assertEqual(len(plans), 1)

    def test_beyond_limits_it_says_so_or_plans_anew(self):
        scene = self.scene(JET, set=LIMITS)
        before = scene.render(0.2)
        self.assertFalse(before.outside_limits)
        plain = {key: scene[key] for key in ("entities.jet.temperature", "cameras.tracker.position")}
        for key, value in (("entities.jet.temperature", "1200 K"), ("cameras.tracker.position", ["0 m", "-8 km", "5 m"])):
            with self.subTest(key):
                scene.set({**plain, key: value})
                frame = scene.render(0.2)
                fresh = self.scene(JET, set={**LIMITS, key: value}).render(0.2)
                anew = frame.attributes["pitviper.plan"] != before.attributes["pitviper.plan"]
                self.assertTrue(frame.outside_limits or anew)
                self.assertEqual(frame.outside_limits, fresh.outside_limits)
                if anew:
                    np.testing.assert_allclose(frame["mw.radiance"], fresh["mw.radiance"], rtol=0.01)

    def test_a_command_beyond_limits_says_so(self):
        scene = self.scene(JET, set=LIMITS)
        self.assertFalse(scene.render(0.08).outside_limits)
        scene.command("temperature", entity="jet", value="1200 K", time=0.1)
        self.assertTrue(scene.render(0.1).outside_limits)

    def not_drawn_as_before(self, scenario, sets, key, value):
        scene = self.scene(scenario, set=sets)
        before = scene.render(0.2)
        scene[key] = value
        frame = scene.render(0.2)
        self.same_frame(frame, self.scene(scenario, set={**sets, key: value}).render(0.2))
        self.assertTrue(layers_that_differ(frame, before))

    def test_other_keys_are_not_drawn_as_before(self):
        for key, value in (("cameras.tracker.motion_blur", True), ("atmosphere", "hazy_us76")):
            with self.subTest(key):
                self.not_drawn_as_before(JET, LIMITS, key, value)

    def test_other_keys_of_the_bench_are_not_drawn_as_before(self):
        limits = {"limits": {"range": ["5 m", "50 m"], "temperature": ["250 K", "900 K"]}, "accuracy": "1 %"}
        for key, value in (
            ("cameras.eye.film.width", 40),
            ("cameras.eye.film.pitch", "15 um"),
            ("cameras.eye.samples", 3),
            ("cameras.eye.channels.mw.response", {"band": ["3.6 um", "4.2 um"]}),
            ("cameras.eye.channels.mw.output", ["radiance", "flux"]),
            ("cameras.eye.aperture", "5 mm"),
            ("cameras.eye.exposure", "20 ms"),
            ("cameras.eye.optics", 0.5),
            ("cameras.eye.truth", ["range"]),
            ("entities.plate.material", "concrete"),
            ("entities.plate.shape", {"model": "sphere", "radius": "20 cm"}),
            ("background.temperature", "280 K"),
            ("seed", 9),
        ):
            with self.subTest(key):
                scenario = detector()
                scenario["entities"][0].update(shape={"model": "plate", "width": "50 cm", "height": "50 cm"})
                self.not_drawn_as_before(scenario, limits, key, value)

    def test_a_detectors_keys(self):
        for key, value in (("read_noise", 0), ("offset", 100), ("gain", 0.005), ("prnu", 0.05)):
            with self.subTest(key):
                scene = self.scene(detector())
                before = scene.render(0.2)
                scene[f"cameras.eye.stages.0.{key}"] = value
                frame = scene.render(0.2)
                self.assertFalse(same_bits(frame["mw.counts"], before["mw.counts"]))
                self.same_frame(frame, self.scene(detector(**{key: value})).render(0.2))

    def test_mistakes(self):
        scene = self.scene(bench())
        for key in ("nothing", "entities.plate.nothing", "entities.other", "entities.7", "entities.plate.temperature.more", "", ".", "cameras.eye.exposure."):
            with self.subTest(key), self.assertRaises(InputError):
                scene[key]
        for key in (3, None, ("a",)):
            with self.subTest(key), self.assertRaises(TypeError):
                scene[key]
            with self.subTest(key), self.assertRaises(TypeError):
                scene[key] = 1
        self.assertNotIn("x", scene.scenario())


class Loading(Case):
    def test_a_dict_a_text_and_a_file_are_one_scenario(self):
        import json

        text = json.dumps(bench(), indent=1)
        file = self.folder.path / "bench.yaml"
        file.write_text(text)
        frames = [self.scene(s).render() for s in (bench(), text, file, str(file))]
        for other in frames[1:]:
            self.same_frame(frames[0], other)

    def test_where_a_text_is_wrong(self):
        text = "name: x\ntime: {rate: 25 Hz, frames: 2}\nentities:\n  - {name: a, shape: {model: plate, width: 1 m, heigth: 2 m}}\n"
        with self.assertRaises(InputError) as caught:
            Scene.load(text)
        error = caught.exception
        column = text.splitlines()[3].index("heigth") + 1
        self.assertEqual((error.line, error.column), (4, column))
        self.assertIn("heigth", error.wrong)
        self.assertIn("height", error.expected)
        for part in (f"{error.file}:4:{column}", error.wrong, error.expected, error.fix):
            self.assertIn(part, str(error))

    def test_where_yaml_is_wrong(self):
        with self.assertRaises(InputError) as caught:
            Scene.load("name: x\nentities: [\n")
        self.assertIsNotNone(caught.exception.line)

    def test_relative_files(self):
        (self.folder.path / "part.yaml").write_text("background: {temperature: 260 K}\n")
        scenario = {"include": "part.yaml", **{k: v for k, v in bench().items() if k != "background"}}
        scene = self.scene(scenario, base=self.folder.path)
        self.assertEqual(scene["background.temperature"], "260 K")
        with self.assertRaises(InputError):
            Scene.load(scenario, base=self.folder.path / "elsewhere")

    def test_mistakes(self):
        for wrong in (3, None, 2.5, object(), b"name: x\n", ["a"]):
            with self.subTest(wrong), self.assertRaises((TypeError, InputError)):
                Scene.load(wrong)
        for wrong in ("nothere.yaml", self.folder.path, "", {}, {"nam": "x"}, {"name": float("nan"), "time": float("inf")}, "a: b\na: c\n", "- 1\n- 2\n", "\n"):
            with self.subTest(wrong), self.assertRaises(InputError):
                Scene.load(wrong)
        with self.assertRaises(InputError) as caught:
            Scene.load(bench(), set={"entities.plate.temprature": "3 K"})
        self.assertIn("temperature", str(caught.exception))
        with self.assertRaises(TypeError):
            Scene.load({"name": object()})
        circle = []
        circle.append(circle)
        with self.assertRaises((RecursionError, ValueError)):
            Scene.load({"name": circle})

    def test_a_scene_without_cameras(self):
        scene = self.scene(scenarios / "lamp_on_plane.yaml")
        self.assertEqual(scene.cameras, [])
        self.assertEqual(scene.world()["lights"]["lamp"]["position_m"], (0.0, 0.0, 5.0))
        for call in (scene.render, scene.plan, scene.planned, lambda: scene.terms(0, 0)):
            with self.assertRaises(InputError):
                call()


class Commands(Case):
    def same_as(self, scenario, command, at, frames):
        """As it goes along: commanded when it is time, and by a scenario with the same entry under `commands`. Says in which frames it shows."""
        name, keys = command
        live, plain = self.scene(scenario), self.scene(scenario)
        written = self.scene({**scenario, "commands": [{"command": name, "at": f"{at!r} s", **keys}]})
        given, changed = False, []
        for k in frames:
            if live.times[k] >= at and not given:
                live.command(name, time=at, **keys)
                given = True
            frame = live.render(live.times[k])
            self.same_frame(frame, written.render(live.times[k]))
            changed.append(bool(layers_that_differ(frame, plain.render(live.times[k]))))
        return changed

    def test_each_is_as_a_scenarios(self):
        lit = detector()
        lit["entities"][0]["material"] = "concrete"
        lit["lights"] = [{"name": "lamp", "intensity": "40 W/(sr um)", "position": ["0 m", "10 m", "8 m"], "level": 0.5}]
        for name, keys in (
            ("temperature", {"entity": "plate", "value": "305 K"}),
            ("move", {"entity": "plate", "position": ["0 m", "40 m", "3 m"], "heading": "150 deg"}),
            ("look", {"camera": "eye", "heading": "30 deg", "field_of_view": "5 deg"}),
            ("gain", {"camera": "eye", "factor": 1.5}),
            ("light", {"light": "lamp", "level": 2.5}),
        ):
            with self.subTest(name):
                self.assertEqual(self.same_as(lit, (name, keys), 1.0, (24, 25, 26)), [False, True, True])

    def test_a_command_between_frames_shows_in_the_next(self):
        for at in (0.4 + 1e-5, 0.405, 0.41, 0.42, 0.43, 0.439):
            with self.subTest(at=at):
                self.assertEqual(self.same_as(bench(), ("temperature", {"entity": "plate", "value": "320 K"}), at, (10, 11, 12)), [False, True, True])

    def test_a_command_holds_from_its_time_on_and_not_before(self):
        # Given ahead, and looked at from before: as a scenario's.
        for at in (1.0, 0.405, 0.43):
            with self.subTest(at=at):
                command = {"command": "temperature", "entity": "plate", "value": "320 K"}
                scene = self.scene(bench())
                scene.command(**command, time=at)
                written = self.scene({**bench(), "commands": [{**command, "at": f"{at!r} s"}]})
                for k in (9, 10, 11, 24, 25, 26):
                    with self.subTest(k=k):
                        self.assertEqual(scene.world(scene.times[k])["entities"], written.world(scene.times[k])["entities"])
                        self.same_frame(scene.render(scene.times[k]), written.render(scene.times[k]))

    def test_a_detector_that_remembers_saw_what_was_commanded(self):
        command = {"command": "temperature", "entity": "plate", "value": "305 K"}
        scene, written = self.scene(detector(lag=0.4)), self.scene({**detector(lag=0.4), "commands": [{**command, "at": "0.08 s"}]})
        plain = self.scene(detector(lag=0.4)).render(0.0)
        self.assertLess(written.render(0.2)["mw.electrons"].max(), 4e6)  # its wells do not fill
        self.same_frame(scene.render(0.0), plain)
        self.same_frame(scene.render(0.04), written.render(0.04))
        scene.command(**command, time=0.08)
        self.same_frame(scene.render(0.08), written.render(0.08))
        # One that does not follow, for which frames before are drawn.
        self.same_frame(scene.render(0.28), written.render(0.28))

    def test_its_time_by_the_scenarios_word(self):
        # `at` is one of the words: it holds from then on, or it is refused.
        scene = self.scene(bench())
        try:
            scene.command("temperature", entity="plate", value="320 K", at="1 s")
        except (InputError, TypeError):
            return
        self.assertEqual([scene.world(t)["entities"]["plate"]["temperatures_K"] for t in (0.5, 1.0)], [[300.0], [320.0]])

    def test_now_unless_a_time_is_given(self):
        scene = self.scene(bench())
        scene.render(0.4)
        scene.command("temperature", entity="plate", value="320 K")
        self.assertAlmostEqual(scene.render()["mw.radiance"].mean() / pitviper.band_radiance(320.0, (3.6, 4.9)), 1.0, delta=1e-3)
        self.assertEqual(scene.now, 0.4)

    def test_times_may_not_fall(self):
        scene = self.scene(bench())
        scene.command("temperature", entity="plate", value="320 K", time=1.0)
        before = scene.render(1.0)
        with self.assertRaises(InputError):
            scene.command("temperature", entity="plate", value="340 K", time=0.5)
        self.same_frame(scene.render(1.0), before)
        scene.command("temperature", entity="plate", value="330 K", time=1.0)
        self.assertFalse(same_bits(scene.render(1.0)["mw.radiance"], before["mw.radiance"]))

    def test_reset(self):
        scene = self.scene(bench())
        before = scene.render(1.0)
        scene.command("temperature", entity="plate", value="320 K", time=1.0)
        self.assertTrue(layers_that_differ(scene.render(1.0), before))
        scene.reset()
        self.assertEqual(scene.now, 0.0)
        self.same_frame(scene.render(1.0), before)
        scene.command("temperature", entity="plate", value="320 K", time=0.2)

    def test_commands_hold_through_changed_keys(self):
        scene = self.scene(bench())
        scene.command("temperature", entity="plate", value="320 K", time=0.2)
        scene["cameras.eye.film.width"] = 20
        frame = scene.render(0.4)
        self.assertEqual(frame.shape, (32, 20))
        self.assertAlmostEqual(frame["mw.radiance"].mean() / pitviper.band_radiance(320.0, (3.6, 4.9)), 1.0, delta=1e-3)
        scene["cameras.eye.film.width"] = 48
        self.same_frame(scene.render(0.4), self.scene({**bench(), "entities": [{**bench()["entities"][0], "temperature": "320 K"}]}).render(0.4))

    def test_a_key_that_a_command_needs(self):
        scene = self.scene(bench())
        scene.command("temperature", entity="plate", value="320 K", time=0.2)
        before = scene.render(0.4)
        with self.assertRaises(InputError):
            scene["entities.plate.name"] = "board"
        self.same_frame(scene.render(0.4), before)

    def test_the_world(self):
        scene = self.scene(JET)
        world = scene.world(1.0)
        jet = world["entities"]["jet"]
        np.testing.assert_allclose(jet["position_m"], (0.0, 1400.0, 610.0), atol=0.5)  # half way, by a smooth course
        np.testing.assert_allclose(jet["velocity_m_s"], (240.0, 0.0, 10.0), atol=1.0)
        self.assertAlmostEqual(np.linalg.norm(jet["orientation_wxyz"]), 1.0, delta=1e-12)
        self.assertTrue(jet["there"])
        self.assertEqual(jet["temperatures_K"][0], 308.0)
        self.assertEqual(world["cameras"]["tracker"]["position_m"], (0.0, 0.0, 5.0))
        self.assertEqual(world["cameras"]["tracker"]["exposure_s"], 0.002)
        scene.command("move", entity="jet", position=["0 m", "2 km", "500 m"], time=0.0)
        self.assertEqual(scene.world(1.0)["entities"]["jet"]["position_m"], (0.0, 2000.0, 500.0))

    def test_mistakes(self):
        scene = self.scene(bench())
        before = scene.render(0.4)
        for name, keys in (
            ("nonsense", {}),
            ("temperature", {}),
            ("temperature", {"entity": "plate", "value": "320"}),
            ("temperature", {"entity": "other", "value": "320 K"}),
            ("temperature", {"entity": "plate", "value": "320 K", "more": 1}),
            ("temperature", {"entity": "plate", "value": float("nan")}),
            ("temperature", {"entity": "plate", "value": "nan K"}),
            ("move", {"entity": "plate", "position": ["0 m", "1 m"]}),
            ("look", {"camera": "other", "heading": "3 deg"}),
        ):
            with self.subTest(name, keys=keys), self.assertRaises(InputError):
                scene.command(name, **keys)
        for time_s in (float("nan"), float("inf")):
            with self.assertRaises(InputError):
                scene.command("temperature", entity="plate", value="320 K", time=time_s)
        with self.assertRaises(TypeError):
            scene.command("temperature", entity="plate", value=object())
        with self.assertRaises((TypeError, InputError)):
            scene.command(3)
        self.same_frame(scene.render(0.4), before)


class Drafts(Case):
    def test_a_draft_and_then_as_asked(self):
        scene = self.scene(JET, set={**cold(), "accuracy": "1 %"})
        self.assertFalse(scene.planned())
        draft = scene.render(0.2, draft=True)
        self.assertTrue(draft.is_draft)
        self.assertFalse(scene.planned())
        frame = scene.render(0.2)
        self.assertFalse(frame.is_draft)
        self.assertTrue(scene.planned())
        # What it is off by: 20 % of a pixel, and what is asked.
        np.testing.assert_allclose(draft["mw.radiance"], frame["mw.radiance"], rtol=0.2)
        self.assertTrue(layers_that_differ(draft, frame))
        # A plan that is there is no draft's business.
        self.assertFalse(scene.render(0.2, draft=True).is_draft)
        self.same_frame(scene.render(0.2, draft=True), frame)

    def test_a_scene_may_be_closed_while_its_plan_is_made(self):
        scene = Scene.load(JET, set=cold())
        self.assertTrue(scene.render(0.2, draft=True).is_draft)
        scene.close()
        self.assertTrue(scene.closed)

    def test_keys_changed_while_its_plan_is_made(self):
        scene = self.scene(JET, set=cold())
        scene.render(0.2, draft=True)
        scene["accuracy"] = "1 %"
        scene["entities.jet.temperature"] = "308 K"
        self.same_frame(scene.render(0.2), jet_frame())


class Noise(Case):
    def test_draws(self):
        scene = self.scene(detector())
        own, three = scene.render(0.2), scene.render(0.2, noise=3)
        self.assertFalse(same_bits(own["mw.counts"], three["mw.counts"]))
        self.assertTrue(same_bits(own["mw.electrons"], three["mw.electrons"]))
        self.same_frame(scene.render(0.2, noise=3), three)
        self.same_frame(scene.render(0.2), own)
        self.assertFalse(same_bits(scene.render(0.2, noise=4)["mw.counts"], three["mw.counts"]))
        self.assertFalse(same_bits(scene.render(0.24, noise=3)["mw.counts"], three["mw.counts"]))
        self.same_frame(self.scene(detector()).render(0.2, noise=3), three)

    def test_draws_of_a_detector_that_remembers(self):
        # A frame by itself is the frame of a run with the same draw, whatever was drawn before.
        scenario = detector(lag=0.4, dsnu=0, prnu=0)
        run = self.scene(scenario)
        third = [run.render(t, noise=3) for t in run.times[:4]][3]
        alone = self.scene(scenario)
        self.same_frame(alone.render(alone.times[3], noise=3), third)
        self.same_frame(alone.render(alone.times[3], noise=3), third)
        other = self.scene(scenario)
        other.render(other.times[2], noise=7)
        other.reset()
        self.assertFalse(same_bits(other.render(other.times[3], noise=7)["mw.counts"], third["mw.counts"]))
        self.same_frame(other.render(other.times[3], noise=3), third)

    def test_the_mean_of_draws_is_the_signal(self):
        scene = self.scene(detector(dsnu=0, prnu=0))
        frames = [scene.render(0.2, noise=k) for k in range(1, 41)]
        counts = np.array([f["mw.counts"] for f in frames], dtype=float)
        signal = 500 + 0.01 * np.asarray(frames[0]["mw.electrons"], dtype=float)
        off = counts - signal
        draws, pixels = len(frames), off[0].size
        self.assertLess(abs(off.mean()), 4 * off.std() / np.sqrt(draws * pixels))
        # Each pixel by itself: of 1536 none is 5 standard errors off but once in 1000 times.
        error = off.mean(axis=0) / (off.std(axis=0, ddof=1) / np.sqrt(draws))
        self.assertLess(np.mean(np.abs(error) > 4), 0.01)
        # As large as shot, read and the converter's noise are together.
        electrons = float(frames[0]["mw.electrons"].mean())
        expected = np.sqrt(0.01**2 * (electrons + 600**2) + 1 / 12)
        self.assertAlmostEqual(off.std() / expected, 1.0, delta=4 / np.sqrt(2 * draws * pixels))
        # Draws know nothing of each other, nor pixels of their neighbours.
        self.assertLess(abs(np.corrcoef(off[0].ravel(), off[1].ravel())[0, 1]), 4 / np.sqrt(pixels))
        self.assertLess(abs(np.corrcoef(off[:, :, 1:].ravel(), off[:, :, :-1].ravel())[0, 1]), 4 / np.sqrt(draws * pixels))

    def test_the_fixed_pattern_stays(self):
        scene = self.scene(detector(dsnu=3000, prnu=0.02))
        halves = [np.mean([scene.render(0.2, noise=k)["mw.counts"] for k in draws], axis=0) for draws in (range(1, 13), range(13, 25))]
        halves = [h - h.mean() for h in halves]
        self.assertGreater(np.corrcoef(halves[0].ravel(), halves[1].ravel())[0, 1], 0.95)  # the pattern is 10 times what 12 draws leave of noise

    def test_mistakes(self):
        scene = self.scene(bench())
        for wrong in (-1, 1.5, "a", None, 2**64):
            with self.subTest(wrong), self.assertRaises((TypeError, ValueError, OverflowError)):
                scene.render(0.0, noise=wrong)


class Reference(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.jet = Scene.load(JET)
        cls.addClassCleanup(cls.jet.close)

    def test_terms_sum_to_all(self):
        frame = self.jet.render(0.2)
        height, width = frame.shape
        for column, row in ((width // 2, height // 2), (3, 4), (width - 1, height - 1), (0, 0)):
            with self.subTest(column=column, row=row):
                told = self.jet.terms(column, row, 0.2)["mw.radiance"]
                self.assertEqual(told["unit"], "W/(m2 sr)")
                self.assertAlmostEqual((sum(told["terms"].values()) + told["rest"]) / told["all"], 1.0, delta=1e-4)
                self.assertLess(abs(told["rest"]), 1e-2 * told["all"])
                self.assertAlmostEqual(frame["mw.radiance"][row, column] / told["all"], 1.0, delta=0.01)  # what was asked
                self.assertAlmostEqual(pitviper.apparent_temperature(told["all"], (3.7, 4.8)), told["apparent_temperature_K"], delta=1e-3)

    def test_a_spectrum_is_the_channels(self):
        frame = self.jet.render(0.2)
        row, column = (n // 2 for n in frame.shape)
        told = self.jet.spectrum(column, row, 3.7, 4.8, bins=20, time=0.2)
        self.assertEqual((told["edge_um"].shape, told["wavelength_um"].shape, told["all"].shape), ((21,), (20,), (20,)))
        self.assertEqual((told["edge_um"][0], told["edge_um"][-1]), (3.7, 4.8))
        total = np.sum(told["all"] * np.diff(told["edge_um"]))
        self.assertAlmostEqual(total / frame["mw.radiance"][row, column], 1.0, delta=0.02)
        np.testing.assert_allclose(sum(told["terms"].values()) + told["rest"], told["all"], rtol=1e-4)

    def test_audit(self):
        told = self.jet.audit(0.2)
        self.assertGreater(told["pixels"], 0)
        self.assertEqual(len(told["errors"]), told["pixels"])
        self.assertEqual((told["asked"], told["channel"]), (0.01, "mw"))
        self.assertTrue(all(0.0 <= e <= told["asked"] for e in told["errors"]), told["errors"])
        self.assertLessEqual(told["largest"], told["asked"])
        self.assertIsNone(self.jet.render(0.2).audit)
        self.same_frame(self.jet.render(0.2, audit=True), self.jet.render(0.2))

    def test_plan_and_check(self):
        plan = self.jet.plan()
        self.assertEqual((plan["name"], plan["accuracy"]), ("tracker", 0.01))
        self.assertEqual([c["name"] for c in plan["channels"]], ["mw"])
        self.assertTrue(self.jet.planned())
        self.assertIn("camera tracker: 320x240 pixels, 1 layer", self.jet.check())
        self.assertIn("jet", self.jet.check())

    def test_targets(self):
        scene = self.scene(JET, set={"cameras.tracker.truth": ["targets"]})
        (jet,) = scene.render(0.2).targets
        self.assertEqual((jet["name"], jet["visible"]), ("jet", 1.0))
        origin = np.linalg.norm(np.subtract(scene.world(0.2)["entities"]["jet"]["position_m"], (0, 0, 5)))
        self.assertAlmostEqual(jet["range_m"], origin, delta=8.0)  # to its middle, which is within half its length of its origin
        left, top, right, bottom = jet["box"]
        self.assertTrue(left < jet["column"] < right and top < jet["row"] < bottom)
        self.assertGreater(jet["channels"]["mw"]["contrast"], 0.0)

    def test_mistakes(self):
        for column, row in ((-1, 0), (0, -1), (320, 0), (0, 240)):
            with self.subTest(column=column, row=row), self.assertRaises(InputError):
                self.jet.terms(column, row)
            with self.subTest(column=column, row=row), self.assertRaises(InputError):
                self.jet.spectrum(column, row, 3.7, 4.8)
        for low, high, bins in ((4.8, 3.7, 8), (3.7, 3.7, 8), (float("nan"), 4.8, 8), (3.7, 4.8, 0), (3.7, 4.8, 10**6), (3.7, 4.8, -1)):
            with self.subTest(low=low, high=high, bins=bins), self.assertRaises(InputError):
                self.jet.spectrum(0, 0, low, high, bins)
        for camera in ("other", ""):
            with self.subTest(camera), self.assertRaises(InputError):
                self.jet.render(camera=camera)
        for time_s in (float("nan"), float("inf"), -float("inf"), np.nan, 1e12, -1e12, 1e300):
            with self.subTest(time_s), self.assertRaises(InputError):
                self.jet.render(time_s)
        for time_s in (float("nan"), float("inf")):
            with self.subTest(time_s), self.assertRaises(InputError):
                self.jet.world(time_s)
        for wrong in (dict(camera=3), dict(time="x"), dict(time=[1.0, 2.0]), dict(draft="x", time=None, camera=[])):
            with self.subTest(wrong), self.assertRaises((TypeError, ValueError)):
                self.jet.render(**wrong)
        for wrong in ((1.5, 0), ("a", 0), (None, 0)):
            with self.subTest(wrong), self.assertRaises(TypeError):
                self.jet.terms(*wrong)


class Life(Case):
    def test_next_goes_through_the_scenarios_times(self):
        scene = self.scene(bench())
        frames = [scene.next() for _ in scene.times]
        self.assertEqual([f.number for f in frames], list(range(50)))
        self.assertEqual([f.time for f in frames], scene.times.tolist())
        scene.render(1.0)
        self.assertEqual((scene.now, scene.next().number), (1.0, 26))

    def test_several_scenes_side_by_side(self):
        alone = []
        for kelvin in (300, 320, 340):
            with Scene.load(bench(), set={"entities.plate.temperature": f"{kelvin} K"}) as scene:
                alone.append([scene.render(t) for t in (0.0, 0.04, 0.08)])
        scenes = [self.scene(bench(), set={"entities.plate.temperature": f"{kelvin} K"}) for kelvin in (300, 320, 340)]
        for k, t in enumerate((0.0, 0.04, 0.08)):
            for scene, frames in zip(scenes, alone):
                self.same_frame(scene.render(t), frames[k])
        self.assertTrue(layers_that_differ(alone[0][0], alone[1][0]))

    def test_with(self):
        with Scene.load(bench()) as scene:
            scene.render()
            self.assertFalse(scene.closed)
        self.assertTrue(scene.closed)
        with self.assertRaises(ZeroDivisionError), Scene.load(bench()) as scene:
            1 / 0
        self.assertTrue(scene.closed)

    def test_what_is_closed_is_closed(self):
        scene = Scene.load(JET)
        scene.close()
        scene.close()
        for name, call in (
            ("render", scene.render),
            ("next", scene.next),
            ("planned", scene.planned),
            ("plan", scene.plan),
            ("audit", scene.audit),
            ("world", scene.world),
            ("reset", scene.reset),
            ("terms", lambda: scene.terms(0, 0)),
            ("spectrum", lambda: scene.spectrum(0, 0, 3.7, 4.8)),
            ("command", lambda: scene.command("temperature", entity="jet", value="320 K")),
            ("set", lambda: scene.set({"entities.jet.temperature": "320 K"})),
            ("[]=", lambda: scene.__setitem__("entities.jet.temperature", "320 K")),
            ("_repr_png_", scene._repr_png_),
        ):
            with self.subTest(name), self.assertRaises(InputError) as caught:
                call()
            self.assertIn("closed", str(caught.exception))
        self.assertIn("closed", repr(scene))

    def test_forgotten_scenes_are_closed(self):
        Scene.load(bench()).render()
        gc.collect()
        before = support.threads()
        for _ in range(5):
            Scene.load(bench()).render()
        gc.collect()
        self.assertLessEqual(support.threads(), before)

    def test_many_scenes_leave_nothing(self):
        many = 1000 if os.environ.get("PITVIPER_LONG") else 200
        for k in range(many):
            with Scene.load(bench(16, 8)) as scene:
                scene.render()
                if k % 4 == 0:
                    scene["entities.plate.temperature"] = "310 K"
                    scene.render()
            if k == 49:
                gc.collect()
                resident, threads, files = support.resident_kB(), support.threads(), support.open_files()
        del scene
        gc.collect()
        self.assertLess(support.resident_kB() - resident, 20000)
        self.assertLessEqual(support.threads(), threads)
        self.assertLessEqual(support.open_files(), files)

    def test_many_frames_leave_nothing(self):
        scene = self.scene(detector())
        for k in range(130):
            frame = scene.render(0.04 * (k % 50), noise=k)
            frame.attributes, frame.targets, frame["mw.counts"]  # noqa: B018
            scene["entities.plate.temperature"] = f"{300 + k % 3} K"
            if k == 49:
                gc.collect()
                resident = support.resident_kB()
        gc.collect()
        self.assertLess(support.resident_kB() - resident, 20000)


# Keys and cameras may be read at any time: what is read is what was or what is, and no mixture.
READS_WHILE_IT_CHANGES = f"""
import sys
sys.path[:0] = {sys.path!r}
import pitviper, support, threading
scene = pitviper.Scene.load(support.bench())
ends = threading.Event()

def read():
    while not ends.is_set():
        film, told, whole = scene["cameras.eye.film"], scene.cameras[0], scene.scenario()
        if film["width"] not in (20, 48) or told["width"] not in (20, 48) or len(whole["cameras"]) != 1:
            print(film, told, whole)

readers = [threading.Thread(target=read) for _ in range(2)]
for r in readers:
    r.start()
try:
    for k in range(400):
        scene["cameras.eye.film.width"] = 20 if k % 2 else 48
finally:
    ends.set()
    for r in readers:
        r.join()
"""


class Threads(Case):
    def while_it_plans(self, scene, work, **wishes):
        """Does some work on this thread while another renders; returns what became of the other."""
        begun, over = threading.Event(), threading.Event()
        became = []

        def progress(share):
            begun.set()
            over.wait(60)

        def render():
            try:
                became.append(scene.render(0.2, progress=progress, **wishes))
            except BaseException as error:
                became.append(error)
            begun.set()

        other = threading.Thread(target=render)
        other.start()
        begun.wait(60)
        try:
            work()
        finally:
            over.set()
            other.join()
        return became[0]

    def test_a_second_thread_is_told(self):
        scene = self.scene(JET, set={**cold(), "accuracy": "1 %"})

        def work():
            for name, call in (
                ("render", scene.render),
                ("set", lambda: scene.set({"entities.jet.temperature": "300 K"})),
                ("command", lambda: scene.command("temperature", entity="jet", value="320 K")),
                ("world", scene.world),
                ("planned", scene.planned),
                ("terms", lambda: scene.terms(0, 0)),
                ("close", scene.close),
            ):
                with self.subTest(name), self.assertRaises(InputError) as caught:
                    call()
                self.assertIn("another thread", str(caught.exception))
            # What asks nothing of its thread is told at any time.
            self.assertEqual((scene.name, scene.closed, scene["cameras.tracker.samples"]), ("jet_and_sky", False, 1))

        frame = self.while_it_plans(scene, work)
        self.assertIsInstance(frame, pitviper.Frame)
        self.same_frame(frame, scene.render(0.2))

    def test_scenes_of_their_own(self):
        expected = self.scene(bench()).render(0.4)
        wrong = []

        def render():
            try:
                with Scene.load(bench()) as scene:
                    for _ in range(20):
                        wrong.extend(layers_that_differ(scene.render(0.4), expected))
            except BaseException as error:
                wrong.append(error)

        several = [threading.Thread(target=render) for _ in range(3)]
        for t in several:
            t.start()
        for t in several:
            t.join()
        self.assertEqual(wrong, [])

    def test_one_thread_after_another(self):
        scene = self.scene(bench())
        frames = [scene.render(0.4)]
        for _ in range(3):
            t = threading.Thread(target=lambda: frames.append(scene.render(0.4)))
            t.start()
            t.join()
        self.assertEqual(len(frames), 4)
        for f in frames:
            self.same_frame(f, frames[0])

    def test_reading_while_another_changes(self):
        # In a process of its own, as it may end that.
        told = subprocess.run([sys.executable, "-X", "faulthandler", "-c", READS_WHILE_IT_CHANGES], capture_output=True, text=True, check=False)
        self.assertEqual((told.returncode, told.stdout, told.stderr), (0, "", ""))

    def test_others_run_while_it_draws(self):
        scene = self.scene(bench(800, 600), set={"cameras.eye.samples": 4})
        scene.render()
        ends = threading.Event()
        counted = [0]

        def count():
            while not ends.is_set():
                counted[0] += 1
                time.sleep(0.0001)

        other = threading.Thread(target=count)
        other.start()
        try:
            before = counted[0]
            for k in range(3):
                scene.render(0.04 * k)
            during = counted[0] - before
        finally:
            ends.set()
            other.join()
        # Held through a picture, the lock lets it count once or twice between two.
        self.assertGreater(during, 15)


class Interrupts(Case):
    def setUp(self):
        super().setUp()
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)

    def usable(self, scene):
        with self.assertRaises(InputError):
            scene.render(camera="other")
        scene["accuracy"] = "1 %"
        scene["entities.jet.temperature"] = "308 K"
        self.same_frame(scene.render(0.2), jet_frame())

    def test_ctrl_c_ends_a_plan(self):
        for with_progress in (True, False):
            with self.subTest(with_progress=with_progress):
                scene = self.scene(JET, set=cold())
                shares = []

                def told(share):
                    if not shares:
                        os.kill(os.getpid(), signal.SIGINT)
                    shares.append(share)

                if not with_progress:
                    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
                    timer.start()
                with self.assertRaises(KeyboardInterrupt):
                    scene.render(0.2, progress=told if with_progress else None)
                # Given up, not waited for.
                self.assertFalse(scene.planned())
                self.assertTrue(all(s < 1.0 for s in shares), shares)

    def test_ctrl_c_ends_plan_of_its_own(self):
        scene = self.scene(JET, set=cold())
        threading.Timer(0.5, signal.raise_signal, (signal.SIGINT,)).start()
        with self.assertRaises(KeyboardInterrupt):
            scene.plan()
        self.assertFalse(scene.planned())
        self.usable(scene)

    def test_ctrl_c_ends_waiting_for_a_drafts_plan(self):
        scene = self.scene(JET, set=cold())
        self.assertTrue(scene.render(0.2, draft=True).is_draft)
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            scene.render(0.2)
        self.usable(scene)

    def test_ctrl_c_while_it_draws(self):
        # Nothing is given up that is nearly done; the interrupt comes all the same, as itself.
        scene = self.scene(bench(800, 600), set={"cameras.eye.samples": 4})
        before = scene.render(0.4)
        for after in (0.05, 0.15):
            with self.subTest(after=after):
                threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT)).start()
                with self.assertRaises(KeyboardInterrupt):
                    for _ in range(200):
                        scene.render(0.4)
        self.same_frame(scene.render(0.4), before)

    def test_progress_is_told(self):
        class Thing:
            pass

        scene = self.scene(JET, set={**cold(), "accuracy": "1 %"})
        shares, on, things = [], set(), []

        def told(share):
            shares.append(share)
            on.add(threading.get_ident())
            thing = Thing()
            things.append(weakref.ref(thing))
            return thing

        scene.render(0.2, progress=told)
        self.assertGreater(len(shares), 2)
        self.assertTrue(all(isinstance(s, float) and 0.0 <= s <= 1.0 for s in shares), shares)
        self.assertEqual(shares, sorted(shares))
        self.assertEqual(on, {threading.get_ident()})
        # What it returns is let go.
        gc.collect()
        self.assertEqual([r for r in things if r() is not None], [])

    def test_what_progress_throws_comes_through(self):
        class Enough(Exception):
            pass

        for ask in ("render", "plan"):
            with self.subTest(ask):
                scene = self.scene(JET, set=cold())
                calls = []

                def told(share):
                    calls.append(share)
                    raise Enough(ask)

                with self.assertRaises(Enough):
                    scene.render(0.2, progress=told) if ask == "render" else scene.plan(progress=told)
                self.assertEqual(len(calls), 1)
                self.assertFalse(scene.planned())

    def test_what_progress_throws_while_it_draws(self):
        scene = self.scene(bench(800, 600), set={"cameras.eye.samples": 4})
        before = scene.render(0.4)

        def told(share):
            raise ArithmeticError("enough")

        with self.assertRaises(ArithmeticError):
            for _ in range(50):
                scene.render(0.4, progress=told)
        self.same_frame(scene.render(0.4), before)

    def test_progress_may_not_use_the_scene(self):
        scene = self.scene(JET, set=cold())
        with self.assertRaises(InputError):
            scene.render(0.2, progress=lambda share: scene.planned())
