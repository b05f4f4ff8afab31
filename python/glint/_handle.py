# SPDX-License-Identifier: MIT
"""The scene that the library holds: its life, and how its functions are called."""

from __future__ import annotations

import os
import threading
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import byref, c_int, c_void_p
from types import TracebackType
from typing import Any, TypeVar

from . import _abi
from ._descs import desc, integer, unknown
from ._library import library
from ._monitor import Monitor, Progress
from .errors import Diagnostic, check

Self = TypeVar("Self", bound="Handle")


def path_bytes(path: str | os.PathLike[str]) -> bytes:
    """For the library, to which a zero byte would be the end."""
    encoded = os.fsencode(path)
    if b"\0" in encoded:
        raise ValueError("a path cannot contain a zero byte")
    return encoded


def dialects() -> list[str]:
    """The names of the dialects: the rules of the course's years, "glint", and "auto", which finds
    the year from the content of the file."""
    found: list[str] = []
    while name := library().glint_dialect_name(len(found)):
        found.append(name.decode())
    return found


def dialect_number(name: str) -> int:
    number = c_int()
    if not library().glint_dialect_from_name(name.encode(), byref(number)):
        raise unknown("dialect", name, dialects())
    return number.value


class Native:
    """A GlintScene. Every call holds a reference while it runs, and with the last one the scene is
    destroyed: so it can be closed at any time, from any thread."""

    def __init__(self, pointer: c_void_p) -> None:
        self._as_parameter_ = pointer  # what ctypes hands over
        weakref.finalize(self, library().glint_scene_destroy, pointer)


class Handle:
    """What all parts of a Scene share."""

    def __init__(
        self,
        *,
        dialect: str = "auto",
        threads: int = 0,
        isa: str | None = None,
        memory_limit: int = 0,
        keep_sources: bool = False,
    ) -> None:
        lib = library()
        self._library = lib
        self._lock = threading.RLock()
        self._busy = False
        self._committed = False
        self._name = ""
        found: list[Diagnostic] = []
        self._diagnostics = found
        # Kept, since C does not keep it.
        self._callback = _abi.GlintDiagnosticFn(
            lambda _user, pointer: found.append(Diagnostic.of(lib, pointer))
        )
        settings = desc(lib, "scene", dialect=dialect_number(dialect), thread_count=threads)
        settings.isa = None if isa is None else isa.encode()
        settings.memory_limit = max(integer("memory_limit", memory_limit, 64), 0)
        settings.diagnostic = self._callback
        settings.keep_sources = keep_sources
        pointer, error = c_void_p(), _abi.GlintError()
        check(lib.glint_scene_create(byref(settings), byref(pointer), byref(error)), error)
        self._native: Native | None = Native(pointer)

    # ------------------------------------------------------------ life

    def close(self) -> None:
        """Frees the scene and all it holds; when a call is under way, at its end. Images stay."""
        self._native = None

    @property
    def closed(self) -> bool:
        """Whether close() was called."""
        return self._native is None

    def __enter__(self: Self) -> Self:
        self._live()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def commit(self, *, progress: Progress | None = None) -> None:
        """Builds the tree. After it the scene cannot be changed any more.

        There is no need to call it: the first picture or ray does. It is there to have the time
        and the errors of building apart. A second call does nothing.

        progress is called with the Phase and the share done, from 0 to 1; to stop, it raises any
        exception, which then comes out of this call.
        """
        if self._committed:
            return
        with self._lock:
            if not self._committed:
                self._long_call("glint_scene_commit", progress=progress)
                self._committed = True

    # ------------------------------------------------------------ calls

    def _live(self) -> Native:
        if self._native is None:
            raise ValueError("the scene is closed")
        return self._native

    @contextmanager
    def _alone(self) -> Iterator[Native]:
        """For functions of which a scene bears one at a time."""
        with self._lock:
            if self._busy:
                raise RuntimeError("the scene is busy with the call that reports this progress")
            self._busy = True
            try:
                yield self._live()
            finally:
                self._busy = False

    def _call(self, name: str, *arguments: Any) -> None:
        """A function that takes the scene first and an error last."""
        error = _abi.GlintError()
        with self._alone() as native:
            check(getattr(self._library, name)(native, *arguments, byref(error)), error)

    def _long_call(self, name: str, *arguments: Any, progress: Progress | None) -> None:
        """The same with a monitor before the error."""
        error, before = _abi.GlintError(), len(self._diagnostics)
        with self._alone() as native, Monitor(progress) as monitor:
            function = getattr(self._library, name)
            status = function(native, *arguments, byref(monitor), byref(error))
            check(status, error, self._diagnostics[before:])
