# SPDX-License-Identifier: MIT
"""What the tests share: where things are, small scenes, a folder of one's own."""

import importlib.util
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
SCENES = SOURCE / "scenes"

HAS_NUMPY = importlib.util.find_spec("numpy") is not None


def needs_numpy(test):
    """Marks a test."""
    test.needs_numpy = True
    return unittest.skipUnless(HAS_NUMPY, "NumPy is not there")(test)


BALL = """\
<scene dialect="glint">
  <image>16 12</image>
  <camera type="PerspectiveCamera">
    <viewPoint>0 0 4</viewPoint>
    <viewWidth>1.6</viewWidth><viewHeight>1.2</viewHeight>
  </camera>
  <surface type="Sphere"/>
  <light><position>4 5 6</position></light>
  <light><position>-4 5 6</position></light>
</scene>
"""


class TestCase(unittest.TestCase):
    """A test with an empty folder, `self.folder`."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)


def values(array):
    """The numbers of an array, NumPy's or not, in lists."""
    return array.tolist()


def flat(array):
    """All numbers of an array in one list."""
    level = array.tolist()
    while level and isinstance(level[0], list):
        level = [item for row in level for item in row]
    return level
