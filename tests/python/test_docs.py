# SPDX-License-Identifier: MIT
"""The examples of docs/python.md and of the package's own page are true: they are run, and say what
they say there."""

import contextlib
import doctest
import io
import os
import re

import glint
from support import SCENES, SOURCE, TestCase, needs_numpy


class Docs(TestCase):
    def run_page(self, path):
        """All examples of a page, one after the other, in a folder with the scenes."""
        os.symlink(SCENES, self.folder / "scenes")
        where = os.getcwd()
        self.addCleanup(os.chdir, where)
        os.chdir(self.folder)
        names = {}
        for match in re.finditer(r"^```python\n(.*?)^```", path.read_text(), flags=re.M | re.S):
            line = path.read_text()[: match.start()].count("\n") + 1
            code = match[1]
            if ">>>" not in code:
                with contextlib.redirect_stdout(io.StringIO()):
                    exec(compile("\n" * line + code, path, "exec"), names)
                continue
            flags = doctest.ELLIPSIS | doctest.IGNORE_EXCEPTION_DETAIL
            test = doctest.DocTestParser().get_doctest(code, names, path.name, str(path), line)
            runner, said = doctest.DocTestRunner(optionflags=flags), []
            runner.run(test, out=said.append, clear_globs=False)
            names.update(test.globs)
            self.assertEqual(runner.failures, 0, "".join(said))

    @needs_numpy
    def test_python_page(self):
        self.run_page(SOURCE / "docs" / "python.md")

    def test_readmes(self):
        self.run_page(SOURCE / "python" / "README.md")
        os.unlink(self.folder / "scenes")
        self.run_page(SOURCE / "README.md")

    def test_everything_public_is_described(self):
        for name in glint.__all__:
            thing = getattr(glint, name)
            if name != "Vector" and not isinstance(thing, str):
                self.assertTrue(thing.__doc__, name)
        for name in dir(glint.Scene):
            if not name.startswith("_"):
                self.assertTrue(getattr(glint.Scene, name).__doc__, name)
