#!/usr/bin/env python3
"""Runs the tests of the Python module.

    python3 tests/python/run.py [--xml FILE] [NAME ...]

NAME: a file (test_physics), one of its classes (test_physics.Bands) or tests (test_physics.Bands.test_shapes); without one all of test_*.py. The module is
that of PITVIPER_BUILD, or of the checkout's `build`. PITVIPER_LONG=1 makes those long that look for leaks. Exit codes: 0 all passed, 1 some failed
or are not there.
"""

import argparse
import faulthandler
import os
import pathlib
import sys
import time
import traceback
import unittest
from xml.sax.saxutils import quoteattr

here = pathlib.Path(__file__).resolve().parent
root = here.parents[1]

HANGS_S = 1800


class Outcome:
    """Of one test: its failures (text each), or why it was skipped."""

    def __init__(self, suite, name):
        self.suite, self.name = suite, name
        self.failures = []
        self.skipped = None
        self.seconds = 0.0


class Results(unittest.TestResult):
    """Keeps what became of each test, in order. What fails outside of tests, as a class's set-up, counts as one."""

    def __init__(self):
        super().__init__()
        self.outcomes = {}

    def outcome(self, test):
        key = test.id()
        if key not in self.outcomes:
            parts = key.split(".")
            self.outcomes[key] = Outcome(".".join(parts[:-1]) or "tests", parts[-1]) if key[-1] != ")" else Outcome("tests", key)
        return self.outcomes[key]

    def startTest(self, test):
        super().startTest(test)
        # What waits for ever ends with its place, whatever thread it is in; no machine is that slow.
        faulthandler.dump_traceback_later(HANGS_S, exit=True)
        self.outcome(test).seconds = -time.monotonic()

    def stopTest(self, test):
        super().stopTest(test)
        faulthandler.cancel_dump_traceback_later()
        self.outcome(test).seconds += time.monotonic()

    def fails(self, test, error, what=""):
        own = [f for f in traceback.extract_tb(error[2]) if pathlib.Path(f.filename).parent == here]
        place = f"{pathlib.Path(own[-1].filename).name}:{own[-1].lineno}: " if own else ""
        line = " ".join(str(error[1]).split("\n", 1)[0].split())
        self.outcome(test).failures.append(f"{place}{what}{error[0].__name__}: {line}\n" + "".join(traceback.format_exception(*error)))

    def addError(self, test, error):
        super().addError(test, error)
        self.fails(test, error)

    def addFailure(self, test, error):
        super().addFailure(test, error)
        self.fails(test, error)

    def addSubTest(self, test, part, error):
        super().addSubTest(test, part, error)
        if error is not None:
            self.fails(test, error, part._subDescription() + " ")

    def addUnexpectedSuccess(self, test):
        super().addUnexpectedSuccess(test)
        self.outcome(test).failures.append("passed, though it was expected to fail")

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self.outcome(test).skipped = reason


def attribute(text):
    """In double quotes, on one line."""
    plain = "".join(c if c >= " " or c == "\n" else "?" for c in text).replace("\n", "\x00")
    return quoteattr(plain.replace('"', "\x01")).replace("\x01", "&quot;").replace("\x00", "&#x0A;")


def xml_of(outcomes):
    """As gtest writes it."""
    failed = sum(bool(o.failures) for o in outcomes)
    seconds = sum(o.seconds for o in outcomes)
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    lines.append(f'<testsuites tests="{len(outcomes)}" failures="{failed}" disabled="0" errors="0" time="{seconds:.3f}" name="AllTests">')
    for suite in dict.fromkeys(o.suite for o in outcomes):
        of = [o for o in outcomes if o.suite == suite]
        lines.append(f'  <testsuite name={attribute(suite)} tests="{len(of)}" failures="{sum(bool(o.failures) for o in of)}">')
        for o in of:
            result = "completed" if o.skipped is None else "skipped"
            head = f'    <testcase name={attribute(o.name)} status="run" result="{result}" time="{o.seconds:.3f}" classname={attribute(o.suite)}'
            lines.append(head + (">" if o.failures else " />"))
            lines.extend(f'      <failure message={attribute(f)} type=""></failure>' for f in o.failures)
            if o.failures:
                lines.append("    </testcase>")
        lines.append("  </testsuite>")
    lines.append("</testsuites>")
    return "\n".join(lines) + "\n"


def tests_named(names):
    loader = unittest.TestLoader()
    if not names:
        return loader.discover(str(here), "test_*.py", str(here))
    return loader.loadTestsFromNames([pathlib.PurePath(n).name.removesuffix(".py") for n in names])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--xml", metavar="FILE", help="also a report as gtest writes it")
    parser.add_argument("--trace", action="store_true", help="also the lines that led to a failure")
    parser.add_argument("--times", action="store_true", help="also how long each test took")
    wanted = parser.parse_args()
    os.environ.setdefault("PITVIPER_HOME", str(root))
    os.environ.setdefault("PITVIPER_BUILD", str(root / "build"))
    sys.path[:0] = [str(here), str(root / "scenarios" / "python")]
    tests = tests_named(wanted.names)
    results = Results()
    tests.run(results)
    outcomes = list(results.outcomes.values())
    for o in outcomes:
        if o.failures:
            print(f"FAILED {o.suite}.{o.name}: {o.failures[0] if wanted.trace else o.failures[0].splitlines()[0]}")
    if wanted.times:
        for o in sorted(outcomes, key=lambda o: -o.seconds):
            print(f"{o.seconds:8.2f} s  {o.suite}.{o.name}")
    failed = sum(bool(o.failures) for o in outcomes)
    skipped = sum(o.skipped is not None for o in outcomes)
    print(f"{len(outcomes) - failed - skipped} passed, {failed} failed, {skipped} skipped")
    if wanted.xml:
        pathlib.Path(wanted.xml).write_text(xml_of(outcomes), encoding="utf-8")
    return 1 if failed or not outcomes else 0


if __name__ == "__main__":
    sys.exit(main())
