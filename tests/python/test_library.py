# SPDX-License-Identifier: MIT
"""Which library is used, and which are refused. Each case is a process of its own."""

import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import glint
from support import SOURCE, TestCase

CC = os.environ.get("CC", "gcc")
PACKAGE = Path(glint.__file__).parents[1]


def python(code, *arguments, package=PACKAGE, **variables):
    """What the code prints, last line of an error included."""
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "GLINT_LIBRARY")}
    environment.update(PYTHONPATH=str(package), **variables)
    command = [sys.executable, "-c", "import sys, glint\n" + code, *map(str, arguments)]
    ended = subprocess.run(command, capture_output=True, text=True, env=environment)
    return (ended.stdout + "".join(ended.stderr.splitlines()[-1:])).strip()


class Finding(TestCase):
    def test_by_variable_and_by_argument(self):
        library = os.environ.get("GLINT_LIBRARY")
        if library is None:
            self.skipTest("GLINT_LIBRARY names no library")
        show = "print(glint.library_path(), glint.instruction_sets()[-1])"
        self.assertEqual(python(show, GLINT_LIBRARY=library), f"{library} portable")
        use = "glint.use_library(sys.argv[1])\n" + show
        self.assertEqual(python(use, library), f"{os.path.abspath(library)} portable")
        again = use + "\nglint.use_library('/other.so')"
        self.assertIn("another Glint library is in use already", python(again, library))

    def test_in_the_build_folder(self):
        """A package in a source tree uses what this tree has built."""
        tree = self.folder / "glint"
        shutil.copytree(PACKAGE / "glint", tree / "python" / "glint")
        (tree / "build").mkdir()
        (tree / "meson.build").touch()
        built = tree / "build" / "libglint.so.0"
        shutil.copy(find_library(), built)
        says = python("print(glint.library_path())", package=tree / "python")
        self.assertEqual(says, str(built))

    def test_there_is_none(self):
        says = python("glint.Scene()", GLINT_LIBRARY="/nowhere/libglint.so")
        self.assertIn("ImportError: the Glint library cannot be loaded", says)
        self.assertIn("install libglint0, or name the file", says)


def find_library():
    """The file that this process uses."""
    with open("/proc/self/maps") as maps:
        glint.library_path()
    with open("/proc/self/maps") as maps:
        return next(line.split()[-1] for line in maps if "libglint" in line)


@unittest.skipUnless(shutil.which(CC), "there is no C compiler")
class Refusing(TestCase):
    def library(self, header):
        """One with all functions of a changed glint.h, that do nothing."""
        (self.folder / "glint").mkdir()
        (self.folder / "glint" / "glint.h").write_text(header)
        from glint import _abi

        lines = ["#include <glint/glint.h>"]
        for name in _abi.FUNCTIONS:
            if name.endswith("_desc_default"):
                kind = _abi.FUNCTIONS[name][0].__name__
                taken = "GlintSurfaceType type" if "surface" in name else "void"
                lines.append(f"{kind} {name}({taken}) {{ return ({kind}){{.cookie = 77}}; }}")
            elif name == "glint_version_text":
                lines.append(f'const char *{name}(void) {{ return "{_abi.VERSION}"; }}')
        (self.folder / "lib.c").write_text("\n".join(lines))
        others = [name for name in _abi.FUNCTIONS if f"{name}(" not in "\n".join(lines)]
        stubs = "\n".join(f"void {name}(void) {{}}" for name in others)
        (self.folder / "stubs.c").write_text(stubs)
        made = self.folder / "libother.so"
        sources = [self.folder / "lib.c", self.folder / "stubs.c"]
        flags = ["-shared", "-fPIC", "-w", "-I", self.folder]
        subprocess.run([CC, *flags, *sources, "-o", made], check=True)
        return str(made)

    def test_of_another_layout(self):
        header = (SOURCE / "include" / "glint" / "glint.h").read_text()
        longer = header.replace("double exposure; ", "double exposure, more[40]; ")
        self.assertNotEqual(longer, header)
        says = python("glint.Scene()", GLINT_LIBRARY=self.library(longer))
        self.assertIn("lays out its structs in another way", says)

    def test_of_this_layout(self):
        header = (SOURCE / "include" / "glint" / "glint.h").read_text()
        says = python("print(glint.library_path())", GLINT_LIBRARY=self.library(header))
        self.assertEqual(says, str(self.folder / "libother.so"))

    def test_that_is_none(self):
        says = python("glint.Scene()", GLINT_LIBRARY="libm.so.6")
        self.assertIn("does not fit this package", says)
        self.assertIn("it has no glint_", says)
