# SPDX-License-Identifier: MIT
"""Fills the desc structs of the library: defaults are the library's, only what the caller gave is
written, and nothing that does not fit is cut silently."""

from __future__ import annotations

import ctypes
import difflib
import operator
from collections.abc import Iterable
from enum import IntEnum
from typing import Any, TypeVar

from ._library import Library

Kind = TypeVar("Kind", bound=IntEnum)


def choose(kinds: type[Kind], name: str, value: Kind | str | None) -> Kind | None:
    """The member of an enum that value is or names, as in "inverse_square"; None stays."""
    if value is None or isinstance(value, kinds):
        return value
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a {kinds.__name__} or its name, not {value!r}")
    known = [kind.name.lower() for kind in kinds]
    if value in known:
        return kinds[value.upper()]
    raise unknown(name, value, known)


def unknown(name: str, value: str, known: Iterable[str]) -> ValueError:
    known = list(known)
    near = difflib.get_close_matches(value, known, 1)
    hint = f"did you mean {near[0]!r}?" if near else "there are " + ", ".join(known)
    return ValueError(f"unknown {name} {value!r}: {hint}")


def integer(name: str, value: Any, bits: int = 32) -> int:
    """A whole number that a C int holds."""
    number = operator.index(value)
    if not -(1 << (bits - 1)) <= number < 1 << (bits - 1):
        raise ValueError(f"{name} is out of range: {number}")
    return number


def numbers(name: str, value: Any, count: int) -> list[float]:
    found = [float(number) for number in value]
    if len(found) != count:
        raise ValueError(f"{name} needs {count} numbers; found {len(found)}")
    return found


def put(struct: ctypes.Structure, name: str, kind: Any, value: Any) -> None:
    """Writes one member, by its kind: a number, an id, numbers in a row, or rows of them."""
    if kind is ctypes.c_int:
        value = integer(name, value)
    elif kind is ctypes.c_double:
        value = float(value)
    elif issubclass(kind, ctypes.Array) and issubclass(kind._type_, ctypes.Array):
        rows = list(value)
        if len(rows) != kind._length_:
            raise ValueError(f"{name} needs {kind._length_} rows; found {len(rows)}")
        row = kind._type_
        value = kind(*(row(*numbers(name, values, row._length_)) for values in rows))
    elif issubclass(kind, ctypes.Array):
        value = kind(*numbers(name, value, kind._length_))
    elif issubclass(kind, ctypes.Structure):  # an id
        value = kind(value)
    setattr(struct, name, value)


def desc(library: Library, what: str, *arguments: int, **values: Any) -> Any:
    """The desc of this name with these values; None stands for the default."""
    struct = getattr(library, f"glint_{what}_desc_default")(*arguments)
    for name, kind in struct._fields_:
        value = values.pop(name, None)
        if value is not None:
            put(struct, name, kind, value)
    assert not values, values
    return struct
