# SPDX-License-Identifier: MIT
"""What can go wrong, in the words of the library."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from . import _abi
from ._abi import Severity, Status
from ._library import Library


def text(encoded: bytes | None) -> str:
    """A text of the library, perhaps cut in the middle of a letter."""
    return (encoded or b"").decode("utf-8", "replace")


@dataclass(frozen=True)
class Diagnostic:
    """One finding in a scene file. `str()` is what a compiler would print: place, message, the
    line and a caret under the place."""

    severity: Severity
    path: str
    """As given when the scene was loaded."""
    line: int
    """From 1; 0: the file as a whole."""
    column: int
    """From 1, in characters."""
    message: str
    """One sentence without a full stop."""
    excerpt: str | None
    """The line, cut to a window round the place; None where there is none."""
    caret: int
    """Index into excerpt of the place, in characters."""
    caret_length: int
    """At least 1."""
    rule: str | None
    """The name of the rule, such as "light-inside-solid"."""
    hint: str | None
    """How to mend it; None where there is nothing to say."""
    text: str
    """All of it, laid out; each line ends with a newline."""

    def __str__(self) -> str:
        return self.text.rstrip("\n")

    @classmethod
    def of(cls, library: Library, pointer: Any) -> Diagnostic:
        size = library.glint_diagnostic_format(pointer, None, 0) + 1
        buffer = ctypes.create_string_buffer(size)
        library.glint_diagnostic_format(pointer, buffer, size)
        found = pointer.contents
        return cls(
            severity=Severity(found.severity),
            path=text(found.path),
            line=found.line,
            column=found.column,
            message=text(found.message),
            excerpt=None if found.excerpt is None else text(found.excerpt),
            caret=found.caret,
            caret_length=found.caret_length,
            rule=None if found.rule is None else text(found.rule),
            hint=None if found.hint is None else text(found.hint),
            text=text(buffer.value),
        )


class GlintError(Exception):
    """A call of the library failed.

    For a scene with mistakes `str()` shows them all, with the lines they are in.
    """

    status: Status
    message: str
    """The first thing that went wrong, in one sentence."""
    path: str
    """The scene, mesh or picture; empty where there is none."""
    line: int
    """From 1; 0 where there is none."""
    column: int
    """From 1; 0 where there is none."""
    diagnostics: tuple[Diagnostic, ...]
    """All findings of a scene that could not be loaded, warnings too, in the order of the file."""

    def __init__(
        self,
        status: Status,
        message: str,
        path: str = "",
        line: int = 0,
        column: int = 0,
        diagnostics: Sequence[Diagnostic] = (),
    ) -> None:
        super().__init__(status, message, path, line, column, tuple(diagnostics))
        self.status = status
        self.message = message
        self.path = path
        self.line = line
        self.column = column
        self.diagnostics = tuple(diagnostics)

    def __str__(self) -> str:
        if self.diagnostics:
            return "\n".join(str(diagnostic) for diagnostic in self.diagnostics)
        place = self.path
        for number in (self.line, self.column):
            place += f":{number}" if place and number > 0 else ""
        return f"{place}: {self.message}" if place else self.message


def check(
    status: int, error: _abi.GlintError, diagnostics: Sequence[Diagnostic] = ()
) -> None:
    """Raises what a call has left in error, unless all went well."""
    if status == Status.OK:
        return
    raise GlintError(
        Status(status),
        text(error.message) or text(b""),
        text(error.path),
        error.line,
        error.column,
        diagnostics,
    )
