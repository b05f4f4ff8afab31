#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the tests of the Python package beside this file.

    run.py [--plain] [NAME...]    those whose file or name contains one of these; default: all

--plain leaves out those that need NumPy, without a word of skipping them.
Which package is tested PYTHONPATH says, which library GLINT_LIBRARY. Ends with "N passed, N failed
[, N skipped]"."""

import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))


def each(suite):
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from each(test)
        else:
            yield test


def needs_numpy(test):
    return hasattr(getattr(test, test._testMethodName), "needs_numpy")


class Result(unittest.TestResult):
    passed = 0

    def addSuccess(self, test):
        self.passed += 1

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        print(f"skip python: {test.id()}: {reason}")

    def addFailure(self, test, error):
        super().addFailure(test, error)
        self.show(test, self.failures[-1][1])

    def addError(self, test, error):
        super().addError(test, error)
        self.show(test, self.errors[-1][1])

    def addSubTest(self, test, subtest, error):
        super().addSubTest(test, subtest, error)
        if error is not None:
            self.show(subtest, (self.failures + self.errors)[-1][1])

    @staticmethod
    def show(test, text):
        print(f"FAIL python: {test.id()}")
        for line in text.rstrip().splitlines()[-20:]:
            print("  " + line)


def main():
    sys.path.insert(0, HERE)
    names = [name for name in sys.argv[1:] if name != "--plain"]
    tests = list(each(unittest.defaultTestLoader.discover(HERE)))
    wanted = [test for test in tests if not names or any(name in test.id() for name in names)]
    if "--plain" in sys.argv:
        wanted = [test for test in wanted if not needs_numpy(test)]
    result = Result()
    unittest.TestSuite(wanted).run(result)
    failed = len(result.failures) + len(result.errors)
    skipped = f", {len(result.skipped)} skipped" if result.skipped else ""
    print(f"{result.passed} passed, {failed} failed{skipped}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
