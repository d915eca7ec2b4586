"""The examples of scenarios/python/examples run as scripts, find what they should, and are in step with their notebooks.

PYTHONPATH=scenarios/python /usr/bin/python3 -m unittest tests/python/test_examples.py
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HOME = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = HOME / "scenarios/python/examples"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(HOME / "scenarios/python")}
KERNEL = "--f=/tmp/kernel.json"  # what Jupyter may begin a kernel with: no short form of an option
PNG = b"\x89PNG\r\n\x1a\n"
NUMBER = r"([-+]?\d+\.?\d*(?:e[-+]?\d+)?)"


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name)

    def said(self, name: str, *options: str) -> str:
        """What an example prints, run in a folder of its own."""
        words = [sys.executable, EXAMPLES / f"{name}.py", KERNEL, "--out", self.out, *options]
        run = subprocess.run(words, env=ENVIRONMENT, cwd=self.out, capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def numbers(self, pattern: str, text: str) -> list[float]:
        """What stands at each # of the pattern, which is plain text otherwise."""
        found = re.search(re.escape(pattern).replace(r"\#", NUMBER), text)
        self.assertIsNotNone(found, f"'{pattern}' is not in:\n{text}")
        return [float(group) for group in found.groups()]

    def assert_pictures(self, *names: str):
        for name in names:
            self.assertTrue((self.out / f"{name}.png").read_bytes().startswith(PNG), name)

    def test_centroid_tracker(self):
        said = self.said("centroid_tracker", "--frames", "60")
        first, rms, most = self.numbers("first # pixels off, after 20 frames # (RMS), at most #", said)
        self.assertGreater(first, 10.0)
        self.assertLess(rms, 1.0)
        self.assertLess(most, 3.0)
        self.assert_pictures("centroid_tracker", "centroid_tracker_off")

    def test_snr_falls_with_range_and_haze(self):
        said = self.said("snr_against_range", "--ranges", "3")
        found = [self.numbers(f"visibility {v} km: SNR # at 2 km, # at 30 km; SNR 5 at # km", said) for v in (2, 5, 23)]
        for near, far, reach_km in found:
            self.assertGreater(near, 100.0)
            self.assertLess(far, 5.0)
            self.assertTrue(2.0 < reach_km < 30.0)
        for hazy, clear in zip(found, found[1:]):
            self.assertTrue(all(a < b for a, b in zip(hazy, clear)), said)
        self.assert_pictures("snr_against_range")

    def test_labelled_pictures(self):
        said = self.said("labelled_pictures", "--samples", "12")
        pictures, masks, _, largest, different = self.numbers("# pictures, # masks of # to # pixels; # pixels differ from truth.entity", said)
        self.assertEqual((pictures, masks, different), (12, 12, 0))
        self.assertGreater(largest, 500)
        told = json.loads((self.out / "labelled_pictures_12/annotations.json").read_text())
        self.assertEqual([c["name"] for c in told["categories"]], ["aircraft"])
        self.assert_pictures("labelled_pictures")

    def test_emissivity_from_picture(self):
        said = self.said("emissivity_from_picture", "--points", "3")
        found, error, hidden = self.numbers("emissivity  # +- #, hidden #", said)
        self.assertLess(error, 0.002)
        self.assertLess(abs(found - hidden), 3.0 * error)
        found_K, error_K, hidden_K = self.numbers("temperature # +- # K, hidden # K", said)
        self.assertLess(abs(found_K - hidden_K), 3.0 * error_K)
        self.assert_pictures("emissivity_from_picture", "emissivity_from_picture_cost")

    def check_apparent_temperature(self, said: str):
        self.assertLess(self.numbers("there and back: at most # K off", said)[0], 1e-6)
        self.assertLess(self.numbers("a table of 256 entries: at most # K off", said)[0], 0.05)
        before = (1.0, 308.0)
        for range_km in (" 0.01", " 1.00", "10.00"):
            line = f"{range_km} km, transmittance #: a skin of 308 K seems to have (by emissivity) # K (1), # K (0.9)"
            transmittance, black_K, grey_K = self.numbers(line, said)
            self.assertTrue(transmittance < before[0] and grey_K < black_K < before[1], said)
            before = (transmittance, black_K)
        seen_K, formula_K = self.numbers("a black one # K, by the formula # K", said)
        # The picture's accuracy of 1 % of the radiance, over 3.7 % of it a kelvin at 300 K.
        self.assertLess(abs(seen_K - formula_K), 0.27)
        self.assert_pictures("apparent_temperature", "apparent_temperature_chart")

    def test_apparent_temperature(self):
        self.check_apparent_temperature(self.said("apparent_temperature"))

    def test_a_notebook_runs(self):
        """Its cells, one after another, as a kernel would; the last, which shows pictures by IPython, is left out."""
        book = json.loads((EXAMPLES / "apparent_temperature.ipynb").read_text())
        code = ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code"]
        self.assertIn("IPython", code[-1])
        cells = f"import sys; sys.argv[1:] = [{KERNEL!r}]\n" + "\n".join(f"exec({cell!r}, globals())" for cell in code[:-1])
        run = subprocess.run([sys.executable, "-c", cells], env=ENVIRONMENT, cwd=self.out, capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.check_apparent_temperature(run.stdout)

    def test_notebooks_are_in_step(self):
        run = subprocess.run([sys.executable, EXAMPLES / "notebooks.py", "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    unittest.main()
