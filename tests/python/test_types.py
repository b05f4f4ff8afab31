# SPDX-License-Identifier: MIT
"""The annotations: they hold in themselves, and a caller's mistakes are found by them."""

import shutil
import subprocess
import unittest
from pathlib import Path

import glint
from support import TestCase

MYPY = "/usr/bin/mypy"  # that of the system, whose NumPy it knows
PACKAGE = Path(glint.__file__).parent

CALLER = """\
import glint

scene = glint.Scene.from_file("a.xml")
shader = scene.add_shader("phong", exponent=3)
scene.add_sphere((0, 0, 0), shader=shader)
depth: float = scene.render(layers=["depth"]).depth[0, 0]
hit = scene.trace((0, 0, 0), (0, 0, 1))
if hit is not None:
    t: float = hit.t

scene.add_sphere((0, 0, 0), shader=3)
scene.add_sphere((0, 0, 0), shader=scene.load_texture("a.png"))
scene.add_box((0, 0, 0))
print(scene.trace((0, 0, 0), (0, 0, 1)).t)
"""


@unittest.skipUnless(shutil.which(MYPY), "mypy is not there")
class Types(TestCase):
    def mypy(self, *arguments):
        command = [MYPY, "--strict", f"--cache-dir={self.folder}", *arguments]
        environment = {"MYPYPATH": str(PACKAGE.parent), "PATH": "/usr/bin:/bin"}
        return subprocess.run(command, capture_output=True, text=True, env=environment).stdout

    def test_package(self):
        self.assertIn("Success", self.mypy(PACKAGE))

    def test_caller(self):
        (self.folder / "caller.py").write_text(CALLER)
        says = self.mypy(self.folder / "caller.py")
        found = [int(line.split(":")[1]) for line in says.splitlines() if "caller.py" in line]
        self.assertEqual(found, [11, 12, 13, 14], says)
