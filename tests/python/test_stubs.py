"""What the module says of itself: docstrings, annotations, units."""

import inspect
import pathlib
import re
import unittest

import pitviper


def members():
    """Every public name: (dotted name, object). Classes, their methods and properties, and functions."""
    for name in pitviper.__all__:
        thing = getattr(pitviper, name)
        if isinstance(thing, (str, pathlib.Path)):
            continue
        yield name, thing
        if not inspect.isclass(thing):
            continue
        for inner, member in vars(thing).items():
            if not inner.startswith("_") and (callable(member) or isinstance(member, (property, staticmethod, classmethod))):
                yield f"{name}.{inner}", member


def function_of(member):
    if isinstance(member, property):
        return member.fget
    return getattr(member, "__func__", member)


class Documented(unittest.TestCase):
    def test_all_is_what_there_is(self):
        public = {n for n, v in vars(pitviper).items() if not n.startswith("_") and not inspect.ismodule(v)} | {"__version__"}
        self.assertEqual(set(pitviper.__all__), public)
        self.assertRegex(pitviper.__version__, r"^\d+\.\d+\.\d+$")
        self.assertEqual(sorted(pitviper.__all__), list(pitviper.__all__))

    def test_every_public_name_has_a_docstring(self):
        self.assertTrue(pitviper.__doc__)
        self.assertEqual([name for name, member in members() if not (inspect.getdoc(member) or "").strip()], [])

    def test_a_docstring_is_its_own(self):
        # What is inherited tells of another.
        self.assertEqual([n for n, m in members() if inspect.isclass(m) and m.__doc__ in [b.__doc__ for b in m.__mro__[1:]]], [])

    def test_parameters_and_returns_are_annotated(self):
        missing = []
        for name, member in members():
            if inspect.isclass(member):
                continue
            signature = inspect.signature(function_of(member))
            if signature.return_annotation is inspect.Signature.empty:
                missing.append(f"{name} ->")
            missing += [f"{name}({p.name})" for p in signature.parameters.values() if p.name != "self" and p.annotation is inspect.Parameter.empty]
        self.assertEqual(missing, [])

    def test_annotations_mean_something(self):
        import typing

        for name, member in members():
            if inspect.isclass(member):
                continue
            with self.subTest(name):
                self.assertIn("return", typing.get_type_hints(function_of(member)))

    def test_units_are_named(self):
        unit = r"\[[^\]]*(W|K|s|um|pixels|m|1/sr)[^\]]*\]"
        for name in (
            "planck planck_slope band_radiance band_radiance_slope apparent_temperature band_integral Surface.brdf Frame.time Frame.shape Frame.targets "
            "Scene.times Scene.step Scene.now Scene.render Scene.spectrum Scene.path Scene.sky material"
        ).split():
            with self.subTest(name):
                self.assertRegex(inspect.getdoc(dict(members())[name]), unit)
        # A bare number says its unit by its name.
        plain = {"time", "column", "row", "bins", "noise", "state", "set", "range"}
        wrong = []
        for name, member in members():
            if inspect.isclass(member):
                continue
            for p in inspect.signature(function_of(member)).parameters.values():
                if str(p.annotation) in ("float", "int", "float | None") and p.name not in plain and not re.search(r"_(um|K|rad|m|s)$", p.name):
                    wrong.append(f"{name}({p.name})")
        self.assertEqual(wrong, [])

    def test_it_is_typed(self):
        self.assertTrue((pathlib.Path(pitviper.__file__).parent / "py.typed").is_file())

    def test_input_error_is_a_value_error(self):
        self.assertTrue(issubclass(pitviper.InputError, ValueError))
        with self.assertRaises(pitviper.InputError) as caught:
            pitviper.planck(4.0, -1.0)
        error = caught.exception
        self.assertEqual((error.line, error.column), (None, None))
        for part in (error.file, error.wrong, error.expected, error.fix):
            self.assertTrue(part and part in str(error), part)
