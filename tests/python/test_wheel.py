# SPDX-License-Identifier: MIT
"""The wheel: what is in it, that it is the same from the same sources, that it works installed."""

import importlib.util
import os
import shutil
import subprocess
import sys
import unittest
import zipfile

from glint import _abi
from support import SCENES, SOURCE, TestCase

NEEDS = [name for name in ("pip", "setuptools", "wheel") if importlib.util.find_spec(name) is None]
OFFLINE = ["--no-index", "--no-deps", "--disable-pip-version-check", "--quiet"]


def pip(*arguments):
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    environment.update(SOURCE_DATE_EPOCH="1700000000", PIP_ROOT_USER_ACTION="ignore")
    command = [sys.executable, "-m", "pip", *map(str, arguments)]
    made = subprocess.run(command, capture_output=True, text=True, env=environment)
    if made.returncode != 0:
        raise AssertionError(made.stdout + made.stderr)


@unittest.skipIf(NEEDS, "not there: " + ", ".join(NEEDS))
class Wheel(TestCase):
    def build(self, place):
        """From a copy, since setuptools leaves files where it works."""
        copy = self.folder / place / "python"
        ignore = shutil.ignore_patterns("__pycache__", "build", "*.egg-info")
        shutil.copytree(SOURCE / "python", copy, ignore=ignore)
        target = self.folder / place / "wheel"
        pip("wheel", *OFFLINE, "--no-build-isolation", "--wheel-dir", target, copy)
        (wheel,) = target.iterdir()
        return wheel

    def test_from_sources_to_a_picture(self):
        wheel, again = self.build("one"), self.build("two")
        self.assertEqual(wheel.name, f"glint-{_abi.VERSION}-py3-none-any.whl")
        self.assertEqual(wheel.read_bytes(), again.read_bytes())
        names = set(zipfile.ZipFile(wheel).namelist())
        modules = {f"glint/{path.name}" for path in (SOURCE / "python" / "glint").glob("*.py")}
        self.assertEqual({n for n in names if n.startswith("glint/")}, modules | {"glint/py.typed"})

        library = os.environ.get("GLINT_LIBRARY")
        if library is None:
            self.skipTest("GLINT_LIBRARY names no library")
        place = self.folder / "installed"
        pip("install", *OFFLINE, "--target", place, wheel)
        code = (
            "import glint, sys\n"
            "glint.Scene.from_file(sys.argv[1]).render_to('a.png', width=40, height=30)\n"
            "print(glint.__file__)\n"
        )
        environment = {**os.environ, "PYTHONPATH": str(place)}
        command = [sys.executable, "-c", code, SCENES / "solids.xml"]
        ended = subprocess.run(
            command, cwd=self.folder, env=environment, capture_output=True, text=True
        )
        self.assertEqual(ended.stdout.strip(), str(place / "glint" / "__init__.py"), ended.stderr)
        self.assertGreater((self.folder / "a.png").stat().st_size, 100)
