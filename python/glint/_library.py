# SPDX-License-Identifier: MIT
"""Finds libglint, loads it once, and makes sure that it is the one that _abi.py describes."""

from __future__ import annotations

import ctypes
import os
import threading
from pathlib import Path
from typing import Any

from . import _abi

SONAME = "libglint.so.0"
VARIABLE = "GLINT_LIBRARY"


class Roomy(ctypes.Structure):
    """Has room for what any desc may have become."""

    _fields_ = [("bytes", ctypes.c_char * 4096)]


class Library:
    """The functions of glint.h, by their names. Other Python threads run while one works."""

    def __init__(self, path: str) -> None:
        try:
            self.functions = ctypes.CDLL(path)
            brief = ctypes.PyDLL(path)
        except OSError as error:
            raise ImportError(
                f"the Glint library cannot be loaded: {error}; install libglint0, or name the file "
                f"in the environment variable {VARIABLE} or to glint.use_library()",
                path=path,
            ) from None
        self.path = path
        for name, (returned, taken) in _abi.FUNCTIONS.items():
            function = getattr(self.functions, name, None)
            if function is None:
                raise self.mismatch(f"has no {name}")
            function.restype, function.argtypes = returned, taken
        version = self.functions.glint_version_text().decode()
        if version != _abi.VERSION:
            raise self.mismatch(f"is version {version}")
        self.check_layouts()
        # One ray is done before another thread could have been told to run; by addresses.
        self.trace, self.occluded = brief.glint_trace, brief.glint_occluded
        self.trace.restype = self.occluded.restype = ctypes.c_bool
        self.trace.argtypes = [ctypes.c_void_p] * 3
        self.occluded.argtypes = [ctypes.c_void_p] * 2

    def __getattr__(self, name: str) -> Any:
        return getattr(self.functions, name)

    def mismatch(self, what: str) -> ImportError:
        return ImportError(
            f"the Glint library {self.path} does not fit this package, which is for "
            f"{_abi.VERSION}: it {what}",
            path=self.path,
        )

    def check_layouts(self) -> None:
        """A desc of another layout would be written past its end. Its default function puts the
        same number into the last member of each, so that must be where it is here."""
        found = set()
        for name, (returned, taken) in _abi.FUNCTIONS.items():
            if not name.endswith("_desc_default"):
                continue
            default = ctypes.CFUNCTYPE(Roomy, *taken)((name, self.functions))(*[0 for _ in taken])
            found.add(ctypes.c_int.from_buffer(default, returned.cookie.offset).value)
        if len(found) != 1 or 0 in found:
            raise self.mismatch("lays out its structs in another way")


_lock = threading.RLock()
_loaded: Library | None = None


def find() -> str:
    """What the environment names; in a source tree what its build made; else what is installed."""
    named = os.environ.get(VARIABLE)
    if named:
        return named
    root = Path(__file__).resolve().parents[2]
    built = root / "build" / SONAME
    if (root / "meson.build").is_file() and built.is_file():
        return str(built)
    return SONAME


def library() -> Library:
    """The library, loaded when it is first asked for."""
    global _loaded
    with _lock:
        if _loaded is None:
            _loaded = Library(find())
        return _loaded


def use_library(path: str | os.PathLike[str]) -> None:
    """Uses the Glint library in this file, in the place of the one that would be found.

    Must come before anything that needs a library; a process has one.
    """
    global _loaded
    path = os.path.abspath(os.fspath(path))
    with _lock:
        if _loaded is not None and _loaded.path != path:
            raise RuntimeError(f"another Glint library is in use already: {_loaded.path}")
        _loaded = _loaded or Library(path)


def library_path() -> str:
    """The library's file: a path, or a name that the system's loader finds."""
    return library().path


def instruction_sets() -> list[str]:
    """The instruction sets that the library can use on this machine, fastest first."""
    found: list[str] = []
    while name := library().glint_isa_name(len(found)):
        found.append(name.decode())
    return found
