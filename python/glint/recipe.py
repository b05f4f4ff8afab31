# SPDX-License-Identifier: MIT
"""The recipe that a PNG of Glint carries: what it takes to draw the picture once more."""

from __future__ import annotations

import ctypes
import os
import weakref
from ctypes import POINTER, byref
from dataclasses import dataclass
from typing import Any

from . import _abi
from ._abi import FileKind
from ._handle import path_bytes
from ._library import library
from .errors import check, text


@dataclass(frozen=True)
class RecipeFile:
    """A file that the picture was made of."""

    kind: FileKind
    name: str
    """As the scene calls it; the scene itself: as it was loaded."""
    size: int
    """Bytes."""
    digest: int
    """CRC-64/XZ of its content."""
    content: bytes | None
    """None when it is not embedded."""


class Recipe:
    """What it takes to draw a picture once more. `str()` is how it stands in a PNG."""

    def __init__(self, pointer: Any) -> None:
        """For the functions that make one: Recipe.load() and Scene.render()."""
        self._pointer = pointer
        weakref.finalize(self, library().glint_recipe_destroy, pointer)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Recipe:
        """The recipe in a PNG that Glint has written."""
        pointer, error = POINTER(_abi.GlintRecipe)(), _abi.GlintError()
        check(library().glint_recipe_load(path_bytes(path), byref(pointer), byref(error)), error)
        return cls(pointer)

    def __str__(self) -> str:
        size = library().glint_recipe_format(self._pointer, None, 0) + 1
        buffer = ctypes.create_string_buffer(size)
        library().glint_recipe_format(self._pointer, buffer, size)
        return text(buffer.value)

    @property
    def version(self) -> str:
        """Of the Glint that drew it."""
        return text(self._pointer.contents.version)

    @property
    def dialect(self) -> str:
        """The rules in force."""
        return text(library().glint_dialect_name(self._pointer.contents.dialect))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the whole picture, in pixels."""
        return self._pointer.contents.width, self._pointer.contents.height

    @property
    def crop(self) -> tuple[int, int, int, int]:
        """The part that was drawn: x, y, width, height."""
        found = self._pointer.contents
        return found.crop_x, found.crop_y, found.crop_width, found.crop_height

    @property
    def samples(self) -> int:
        """Per pixel."""
        return int(self._pointer.contents.samples)

    @property
    def light(self) -> int:
        """As for Scene.render()."""
        return int(self._pointer.contents.light)

    @property
    def pixels_digest(self) -> int | None:
        """CRC-64/XZ of the 8-bit values; None of a picture that was not written yet."""
        found = self._pointer.contents
        return int(found.pixels) if found.has_pixels else None

    @property
    def files(self) -> list[RecipeFile]:
        """The scene's own first; none of a scene built by calls."""
        found = self._pointer.contents
        return [recipe_file(found.files[i]) for i in range(found.file_count)]


def recipe_file(found: Any) -> RecipeFile:
    return RecipeFile(
        kind=FileKind(found.kind),
        name=text(found.name),
        size=found.size,
        digest=found.digest,
        content=ctypes.string_at(found.bytes, found.size) if found.bytes else None,
    )


def picture_digest(path: str | os.PathLike[str]) -> int:
    """CRC-64/XZ of the 8-bit values of a PNG or JPEG file."""
    digest, error = ctypes.c_uint64(), _abi.GlintError()
    check(library().glint_picture_digest(path_bytes(path), byref(digest), byref(error)), error)
    return digest.value
