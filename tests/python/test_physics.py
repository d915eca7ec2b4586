"""Spectra, bands, surfaces and air as functions over arrays, against closed forms."""

import unittest

import numpy as np
import pitviper
from pitviper import InputError, band_integral, band_mean, band_radiance, planck, planck_slope

from support import Folder, bench, scenarios

# CODATA 2018, exact but for the last: h, c, k; Stefan and Boltzmann's, Wien's.
H, C, K = 6.62607015e-34, 299792458.0, 1.380649e-23
SIGMA, WIEN_UM_K = 5.670374419e-8, 2897.771955
ALL = (0.1, 1000.0)  # um


def planck_closed(um, kelvin):
    """W/(m2 sr um)"""
    m = um * 1e-6
    return 2 * H * C**2 / m**5 / np.expm1(H * C / (m * K * kelvin)) * 1e-6


class Planck(unittest.TestCase):
    def test_against_its_law(self):
        um, kelvin = np.array([0.5, 3.0, 4.0, 10.0, 300.0]), np.array([77.0, 300.0, 5772.0])
        expected = planck_closed(um[None, :], kelvin[:, None])
        np.testing.assert_allclose(planck(um, kelvin), expected, rtol=1e-12)  # both are double precision of one formula

    def test_in_photons(self):
        um = np.array([4.0, 10.0])
        np.testing.assert_allclose(planck(um, 300.0, unit="photon/s"), planck(um, 300.0) * um * 1e-6 / (H * C), rtol=1e-12)
        np.testing.assert_allclose(planck_slope(um, 300.0, "photon/s"), planck_slope(um, 300.0) * um * 1e-6 / (H * C), rtol=1e-12)

    def test_slope_is_the_derivative(self):
        step = 0.01  # its square times the third derivative is below 1e-7 here
        for um in (3.0, 10.0):
            finite = (planck(um, 300.0 + step) - planck(um, 300.0 - step)) / (2 * step)
            self.assertAlmostEqual(planck_slope(um, 300.0) / finite, 1.0, delta=1e-7)

    def test_wien(self):
        for kelvin in (200.0, 300.0, 5772.0):
            um = np.linspace(0.9, 1.1, 20001) * WIEN_UM_K / kelvin
            self.assertAlmostEqual(um[np.argmax(planck(um, kelvin))] * kelvin, WIEN_UM_K, delta=WIEN_UM_K * 2e-5)  # two steps of the grid

    def test_shapes(self):
        one = planck(4.0, 300.0)
        self.assertIsInstance(one, float)
        self.assertIsInstance(planck(np.float32(4.0), np.int64(300)), float)
        self.assertEqual(planck([4.0, 5.0], 300.0).shape, (2,))
        self.assertEqual(planck(4.0, [300.0, 310.0, 320.0]).shape, (3,))
        self.assertEqual(planck([4.0, 5.0], [300.0, 310.0, 320.0]).shape, (3, 2))
        grid = planck(np.ones((2, 3)) * 4.0, np.full((4, 5), 300.0))
        self.assertEqual(grid.shape, (4, 5, 2, 3))
        self.assertTrue(np.all(grid == one))
        both = planck([4.0, 5.0], [300.0, 310.0])
        self.assertEqual(both[1, 0], planck(4.0, 310.0))
        self.assertEqual(planck([], 300.0).shape, (0,))

    def test_other_kinds_and_orders_of_arrays(self):
        kelvin = np.array([[300.0, 310.0], [320.0, 330.0]])
        plain = planck(4.0, kelvin)
        np.testing.assert_array_equal(planck(4.0, np.asfortranarray(kelvin)), plain)
        np.testing.assert_array_equal(planck(4.0, kelvin[::-1, ::-1]), plain[::-1, ::-1])
        np.testing.assert_array_equal(planck(4.0, kelvin.astype(int)), plain)
        np.testing.assert_array_equal(planck(4.0, kelvin.astype(">f8")), plain)

    def test_cold_is_dark(self):
        self.assertEqual(planck(4.0, 0.0), 0.0)
        self.assertEqual(band_radiance(0.0, (8.0, 12.0)), 0.0)

    def test_mistakes(self):
        for um, kelvin in ((0.0, 300), (-4.0, 300), (np.nan, 300), (4.0, np.nan), (4.0, np.inf), (4.0, -1.0), (0.09, 300), (1000.1, 300), ([4.0, np.nan], 300)):
            for of in (planck, planck_slope):
                with self.subTest(um=um, kelvin=kelvin), self.assertRaises(InputError):
                    of(um, kelvin)
        with self.assertRaises(InputError):
            planck(4.0, 300.0, unit="lm")
        for wrong in ("x", None, 300 + 1j, {}):
            with self.subTest(wrong), self.assertRaises((TypeError, ValueError)):
                planck(4.0, wrong)


class Bands(unittest.TestCase):
    def test_stefan_boltzmann(self):
        # Beyond 1000 um lies 15/pi^4 (x^3/3 - x^4/8 + ...) of it, x = hc/(1000 um k T); in dL/dT a quarter of the first term.
        for kelvin in (300.0, 3000.0):
            x = H * C / (1e-3 * K * kelvin)
            beyond = 15 / np.pi**4 * (x**3 / 3 - x**4 / 8)
            self.assertAlmostEqual(band_radiance(kelvin, ALL) / (SIGMA * kelvin**4 / np.pi), 1.0 - beyond, delta=1e-8)
            slope = pitviper.band_radiance_slope(kelvin, ALL)
            self.assertAlmostEqual(slope / (4 * SIGMA * kelvin**3 / np.pi), 1.0 - 15 / np.pi**4 * x**3 / 12, delta=1e-8)

    def series(self, kelvin, low, high, photons=False):
        """Planck's integral from low to high by its series (Widger and Woodall 1976), in W/(m2 sr) or photon/(s m2 sr)."""

        def beyond(um):
            x = H * C / (um * 1e-6 * K * kelvin)
            n = np.arange(1, 400)
            if photons:
                return 2 * K**3 * kelvin**3 / (H**3 * C**2) * np.sum(np.exp(-n * x) * (x**2 / n + 2 * x / n**2 + 2 / n**3))
            return 2 * K**4 * kelvin**4 / (H**3 * C**2) * np.sum(np.exp(-n * x) * (x**3 / n + 3 * x**2 / n**2 + 6 * x / n**3 + 6 / n**4))

        return beyond(high) - beyond(low)

    def test_8_to_12_um_at_300_K(self):
        for kelvin, low, high in ((300.0, 8.0, 12.0), (300.0, 3.6, 4.9), (77.0, 8.0, 12.0), (2000.0, 0.4, 14.0)):
            with self.subTest(kelvin=kelvin, low=low, high=high):
                self.assertAlmostEqual(band_radiance(kelvin, (low, high)) / self.series(kelvin, low, high), 1.0, delta=1e-10)
                photons = self.series(kelvin, low, high, photons=True)
                self.assertAlmostEqual(band_radiance(kelvin, (low, high), "photon/s") / photons, 1.0, delta=1e-10)

    def test_slope_is_the_derivative(self):
        for unit in ("W", "photon/s"):
            finite = (band_radiance(300.01, (8, 12), unit) - band_radiance(299.99, (8, 12), unit)) / 0.02
            self.assertAlmostEqual(pitviper.band_radiance_slope(300.0, (8, 12), unit) / finite, 1.0, delta=1e-7)

    def test_apparent_temperature_is_the_inverse(self):
        kelvin = np.array([[25.0, 77.0, 250.0], [300.0, 1000.0, 19000.0]])
        for unit in ("W", "photon/s"):
            found = pitviper.apparent_temperature(band_radiance(kelvin, (3.6, 4.9), unit), (3.6, 4.9), unit)
            self.assertEqual(found.shape, kelvin.shape)
            np.testing.assert_allclose(found, kelvin, rtol=1e-8)
        self.assertEqual(pitviper.apparent_temperature(0.0, (3.6, 4.9)), 0.0)
        self.assertEqual(pitviper.apparent_temperature(1e30, (3.6, 4.9)), 20000.0)

    def test_a_band_as_a_table(self):
        box = band_radiance(300.0, (8.0, 12.0))
        self.assertAlmostEqual(band_radiance(300.0, ([8.0, 12.0], [1.0, 1.0])), box, delta=box * 1e-12)
        self.assertAlmostEqual(band_radiance(300.0, (np.array([8.0, 9.0, 12.0]), np.array([0.5, 0.5, 0.5]))), 0.5 * box, delta=box * 1e-12)
        # A triangle: the weighted sum over fine steps, whose error is their square.
        um = np.linspace(8.0, 12.0, 40001)
        fine = np.trapezoid if hasattr(np, "trapezoid") else np.trapz
        expected = fine(planck(um, 300.0) * np.interp(um, [8, 10, 12], [0, 1, 0]), um)
        self.assertAlmostEqual(band_radiance(300.0, ([8, 10, 12], [0, 1, 0])) / expected, 1.0, delta=1e-8)

    def test_shapes(self):
        self.assertIsInstance(band_radiance(300, (8, 12)), float)
        self.assertEqual(band_radiance([300.0], (8, 12)).shape, (1,))
        self.assertEqual(band_radiance(np.full((2, 3), 300.0), (8, 12)).shape, (2, 3))
        self.assertEqual(pitviper.band_radiance_slope(np.full((2, 3), 300.0), (8, 12)).shape, (2, 3))

    def test_integrals_of_tables_are_exact(self):
        # Of straight pieces, by hand; rounding of double precision.
        self.assertAlmostEqual(band_integral([1.0, 2.0, 4.0], [0.0, 3.0, 1.0]), 0.5 * 3.0 + 2.0 * 2.0, delta=1e-14)
        # Times a box that cuts pieces: 2..3 of the line from 3 to 1.
        self.assertAlmostEqual(band_integral([1.0, 2.0, 4.0], [0.0, 3.0, 1.0], (2.0, 3.0)), 2.5, delta=1e-14)
        # Two slopes: integral of x (2 - x) over 0..2 from 1: 4/3.
        self.assertAlmostEqual(band_integral([1.0, 3.0], [0.0, 2.0], ([1.0, 3.0], [2.0, 0.0])), 4.0 / 3.0, delta=1e-13)
        self.assertAlmostEqual(band_mean([1.0, 3.0], [0.0, 2.0], ([1.0, 3.0], [2.0, 0.0])), 4.0 / 3.0 / 2.0, delta=1e-13)
        # Two equal wavelengths are a step.
        self.assertAlmostEqual(band_integral([1.0, 2.0, 2.0, 3.0], [1.0, 1.0, 5.0, 5.0]), 6.0, delta=1e-14)

    def test_mistakes(self):
        bands = (
            ((12.0, 8.0), "falls"),
            ((8.0, 8.0), "is empty"),
            ((8.0,), "is one"),
            ((8.0, 9.0, 10.0), "are three"),
            ((np.nan, 9.0), "no number"),
            ((0.01, 9.0), "too short"),
            (([8.0, 9.0], [1.0]), "lengths"),
            (([8.0, 9.0], [0.0, 0.0]), "zero throughout"),
            (([8.0, 9.0], [1.0, -1.0]), "negative"),
            (([9.0, 8.0], [1.0, 1.0]), "falls"),
            (([8.0, 9.0], [1.0, np.nan]), "no number"),
            (("a", "b"), "words"),
            ((8.0, [1.0, 2.0]), "a number and a table"),
            ((np.ones((2, 2)) * 8, np.ones((2, 2))), "tables of two dimensions"),
        )
        for band, what in bands:
            with self.subTest(what, band=band), self.assertRaises(InputError):
                band_radiance(300.0, band)
        for band in (None, 8.0):
            with self.subTest(band=band), self.assertRaises((InputError, TypeError)):
                band_radiance(300.0, band)
        for kelvin in (-1.0, np.nan, np.inf, [300.0, -1.0]):
            with self.subTest(kelvin=kelvin), self.assertRaises(InputError):
                band_radiance(kelvin, (8, 12))
        with self.assertRaises(InputError):
            pitviper.apparent_temperature(-1.0, (8, 12))
        with self.assertRaises(InputError):
            band_integral([1.0, 2.0], [1.0])
        with self.assertRaises(InputError):
            band_integral([1.0, 2.0], [1.0, 1.0], (0.5, 1.5))
        with self.assertRaises(InputError):
            band_mean([2.0, 1.0], [1.0, 1.0], (1.0, 2.0))


class Surfaces(unittest.TestCase):
    def test_what_an_opaque_material_does_not_reflect_it_emits(self):
        um, angles = np.linspace(1.0, 12.0, 23), np.array([0.0, 0.5, 1.2, np.pi / 2])
        for name in ("grey_aircraft_paint", "aluminium_sheet", "concrete", "phong_r1"):
            with self.subTest(name):
                m = pitviper.material(name)
                low, high = m.valid_um
                within = um[(um >= low) & (um <= high)]
                reflected, emitted, passed = m.reflectance(within, angles), m.emissivity(within, angles), m.transmittance(within, angles)
                self.assertEqual(reflected.shape, (4, len(within)))
                self.assertTrue(np.all(passed == 0.0))
                np.testing.assert_allclose(emitted, 1.0 - reflected, atol=1e-12)
                self.assertTrue(np.all((reflected >= 0.0) & (reflected <= 1.0)))
                self.assertGreater(np.ptp(reflected), 0.0)

    def test_a_black_body(self):
        m = pitviper.material("blackbody")
        self.assertEqual((m.emissivity(10.0), m.reflectance(10.0), m.transmittance(10.0), m.states), (1.0, 0.0, 0.0, None))

    def test_a_window_lets_through(self):
        m = pitviper.material("germanium_window")
        low, high = m.valid_um
        um = np.linspace(low, high, 9)
        sums = m.reflectance(um) + m.transmittance(um) + m.emissivity(um)
        np.testing.assert_allclose(sums, 1.0, atol=1e-9)
        self.assertGreater(m.transmittance(um).max(), 0.2)

    def test_brdf_is_the_same_both_ways(self):
        there, back = pitviper.direction(0.3, 0.2), pitviper.direction(0.9, 2.0)
        for name in ("grey_aircraft_paint", "aluminium", "phong_r1"):
            with self.subTest(name):
                m = pitviper.material(name)
                one, other = m.brdf([1.0, 2.0], there, [back]), m.brdf([1.0, 2.0], back, [there])
                self.assertEqual(one.shape, (1, 2))
                self.assertTrue(np.all(one > 0.0))
                np.testing.assert_allclose(one, other, rtol=1e-9)

    def test_a_lambertian_brdf_is_its_reflectance_over_pi(self):
        m = pitviper.material("white_lambertian")
        views = [pitviper.direction(a) for a in (0.0, 0.7, 1.4)]
        np.testing.assert_allclose(m.brdf([0.6], pitviper.direction(0.5), views) * np.pi, m.reflectance(0.6), rtol=1e-12)

    def test_brdf_integrates_to_reflectance(self):
        m = pitviper.material("grey_aircraft_paint")
        # Gauss in cos^2, even in azimuth: rho = integral of brdf cos dw.
        x, w = np.polynomial.legendre.leggauss(48)
        azimuths = (np.arange(96) + 0.5) * 2 * np.pi / 96
        angles = np.arccos(np.sqrt(0.5 * (x + 1)))
        views = [pitviper.direction(a, z) for a in angles for z in azimuths]
        values = m.brdf([4.0], pitviper.direction(0.4), views).reshape(len(x), len(azimuths))
        total = np.sum(values.mean(axis=1) * 0.5 * w) * np.pi
        self.assertAlmostEqual(total / m.reflectance(4.0, 0.4), 1.0, delta=0.01)  # the material's own table of reflectance, and this sum

    def test_directions_are_unit_vectors(self):
        self.assertEqual(pitviper.direction(0.0), (0.0, 0.0, 1.0))
        np.testing.assert_allclose(pitviper.direction(np.pi / 2, np.pi / 2), (0, 1, 0), atol=1e-15)

    def test_states(self):
        with pitviper.Scene.load(scenarios / "thin_films.yaml") as scene:
            names = [n for n in scene.scenario()["materials"] if scene.material(n).states]
            self.assertTrue(names)
            states = scene.material(names[0]).states
            low, high = states["low"], states["high"]
            self.assertNotEqual(*(scene.material(names[0], state).reflectance(0.55) for state in (low, high)))
            for wrong in (high * 2 + 1, float("nan")):
                with self.subTest(wrong), self.assertRaises(InputError):
                    scene.material(names[0], wrong)
            with self.assertRaises(InputError):
                scene.material("nothing")
        with self.assertRaises(InputError):
            pitviper.material("blackbody", 300.0)

    def test_shapes(self):
        m = pitviper.material("concrete")
        self.assertIsInstance(m.reflectance(4.0), float)
        self.assertEqual(m.reflectance([4.0, 5.0]).shape, (2,))
        self.assertEqual(m.emissivity(4.0, [0.0, 0.1, 0.2]).shape, (3,))
        self.assertEqual(m.emissivity(np.full((2, 2), 4.0), np.zeros((3, 1))).shape, (3, 1, 2, 2))

    def test_mistakes(self):
        m = pitviper.material("concrete")
        low, high = m.valid_um
        for um, angle in ((high * 1.01, 0.0), (low * 0.99, 0.0), (np.nan, 0.0), (4.0, 1.6), (4.0, -0.1), (4.0, np.nan)):
            for of in (m.reflectance, m.emissivity, m.transmittance):
                with self.subTest(um=um, angle=angle), self.assertRaises(InputError):
                    of(um, angle)
        for light, view in (((0, 0, 2), (0, 0, 1)), ((0, 0, 1), (0, 0, -1)), ((0, 0, np.nan), (0, 0, 1))):
            with self.subTest(light=light, view=view), self.assertRaises(InputError):
                m.brdf(4.0, light, [view])
        with self.assertRaises((TypeError, InputError)):
            m.brdf(4.0, (0, 0), [(0, 0, 1)])
        with self.assertRaises(InputError) as caught:
            pitviper.material("concrte")
        self.assertIn("concrete", str(caught.exception))

    def test_mistakes_name_the_material(self):
        for name in ("coated_sapphire_window", "aluminium", "concrete"):
            m = pitviper.material(name)
            with self.subTest(name), self.assertRaises(InputError) as caught:
                m.reflectance(m.valid_um[1] * 1.5)
            self.assertIn(f"'{name}'", str(caught.exception))

    def test_a_chart_and_a_picture(self):
        folder = Folder()
        self.addCleanup(folder.remove)
        file = folder.path / "curves.png"
        pitviper.chart(file, {"300 K": ([8.0, 10.0, 12.0], planck([8.0, 10.0, 12.0], 300.0))}, title="black body", x="um", y="W/(m2 sr um)", dashed=["300 K"])
        self.assertEqual(file.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(pitviper.material("concrete")._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        for curves in ({}, {"a": ([1.0, 2.0], [1.0])}):
            with self.subTest(curves), self.assertRaises(InputError):
                pitviper.chart(folder.path / "other.png", curves)


class Air(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = pitviper.Scene.load(scenarios / "jet_and_sky.yaml")

    @classmethod
    def tearDownClass(cls):
        cls.scene.close()

    def test_transmittance_is_of_the_optical_depth(self):
        um = np.linspace(3.5, 5.0, 31)
        path = self.scene.path((0, 0, 5), (0, 2000, 600), um)
        self.assertAlmostEqual(path["range_m"], np.hypot(2000, 595), delta=1e-9)
        np.testing.assert_allclose(path["transmittance"], np.exp(-path["optical_depth"]), rtol=1e-12)
        self.assertGreater(np.ptp(path["transmittance"]), 0.5)  # CO2 at 4.3 um is black, the window around 4 um is clear
        self.assertTrue(np.all(path["path_radiance"] > 0.0))
        # Air of 288 K and less: never more than a black body that is as warm, plus what it scatters of the sun: below 4.2 um.
        thermal = um > 4.2
        self.assertTrue(np.all(path["path_radiance"][thermal] <= planck(um, 289.0)[thermal]))

    def test_the_way_back_is_as_clear(self):
        um = np.array([4.0, 4.6])
        there, back = self.scene.path((0, 0, 5), (0, 2000, 600), um), self.scene.path((0, 2000, 600), (0, 0, 5), um)
        np.testing.assert_allclose(there["optical_depth"], back["optical_depth"], rtol=1e-3)  # the same line, its layers summed from the other end
        self.assertEqual(there["range_m"], back["range_m"])

    def test_no_way_at_all(self):
        path = self.scene.path((0, 0, 5), (0, 0, 5), [4.0, 4.5])
        self.assertEqual((path["range_m"], path["transmittance"].tolist(), path["path_radiance"].tolist()), (0.0, [1.0, 1.0], [0.0, 0.0]))

    def test_shapes(self):
        for um, shape in ((4.0, ()), ([4.0], (1,)), (np.full((2, 3), 4.0), (2, 3))):
            path = self.scene.path((0, 0, 5), (0, 100, 5), um)
            for key in ("optical_depth", "transmittance", "path_radiance"):
                with self.subTest(key, shape=shape):
                    self.assertEqual(np.shape(path[key]), shape)
            self.assertEqual(np.shape(self.scene.sky((0, 0, 5), (0, 0, 1), um)), shape)

    def test_sky(self):
        um = np.linspace(8.0, 12.0, 9)
        zenith, low = self.scene.sky((0, 0, 5), (0, 0, 1), um), self.scene.sky((0, 0, 5), (0, 3, 0.2), um)
        self.assertTrue(np.all(zenith > 0.0) and np.all(low > zenith))
        self.assertTrue(np.all(low < planck(um, 289.0)))
        np.testing.assert_array_equal(zenith, self.scene.sky((0, 0, 5), (0, 0, 10), um))

    def test_band_transmittance_is_the_mean_that_a_band_sees(self):
        step = 0.001
        um = np.arange(3.7 + step / 2, 4.8, step)
        path = self.scene.path((0, 0, 5), (0, 2000, 600), um)
        weights = planck(um, 600.0)
        expected = np.sum(weights * path["transmittance"]) / np.sum(weights)
        found = self.scene.band_transmittance((0, 0, 5), (0, 2000, 600), (3.7, 4.8), 600.0)
        self.assertAlmostEqual(found, expected, delta=1e-3)  # by middles of bins of 5 1/cm

    def test_without_air(self):
        with pitviper.Scene.load(bench()) as scene:
            path = scene.path((0, 0, 0), (0, 1000, 0), [4.0, 10.0])
            self.assertEqual((path["transmittance"].tolist(), path["path_radiance"].tolist()), ([1.0, 1.0], [0.0, 0.0]))
            self.assertEqual(scene.band_transmittance((0, 0, 0), (0, 1000, 0), (3.7, 4.8), 300.0), 1.0)
            # Its background is 250 K.
            np.testing.assert_allclose(scene.sky((0, 0, 0), (0, 0, 1), [4.0, 10.0]), planck([4.0, 10.0], 250.0), rtol=1e-9)

    def test_mistakes(self):
        place, far = (0, 0, 5), (0, 2000, 600)
        for call, what in (
            (lambda: self.scene.path(place, (0, np.nan, 0), 4.0), "no number"),
            (lambda: self.scene.path(place, (0, 3e5, -3000), 4.0), "behind the earth"),
            (lambda: self.scene.path(place, far, -4.0), "wavelength"),
            (lambda: self.scene.path(place, far, np.nan), "wavelength"),
            (lambda: self.scene.sky(place, (0, 0, 0), 4.0), "length 0"),
            (lambda: self.scene.sky(place, (0, 1, -1), 4.0), "down"),
            (lambda: self.scene.band_transmittance(place, far, (4.8, 3.7), 300.0), "falls"),
            (lambda: self.scene.band_transmittance(place, far, (3.7, 4.8), -300.0), "cold"),
            (lambda: self.scene.band_transmittance(place, far, (3.7, 4.8), np.nan), "no number"),
        ):
            with self.subTest(what), self.assertRaises(InputError):
                call()
        for wrong in ((0, 0), (0, 0, 0, 0), "abc", (0, 0, "a"), None):
            with self.subTest(wrong), self.assertRaises((TypeError, InputError)):
                self.scene.path(wrong, far, 4.0)
