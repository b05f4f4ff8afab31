# SPDX-License-Identifier: MIT
"""Arrays of numbers in and out: NumPy's where NumPy is, else memoryviews of the same shape. Both
are indexed `a[y, x, c]`, lie in memory row by row, and are what the library reads and writes."""

from __future__ import annotations

import ctypes
import functools
import math
import struct
from array import array
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

    Bytes = NDArray[numpy.uint8]
    Integers = NDArray[numpy.uint32]
    Floats = NDArray[numpy.float32]
    Doubles = NDArray[numpy.float64]
    Booleans = NDArray[numpy.bool_]
else:
    Bytes = Integers = Floats = Doubles = Booleans = memoryview

# The letters that array, memoryview and struct have for the kinds of numbers, and NumPy's names.
KINDS = {"B": "uint8", "I": "uint32", "f": "float32", "d": "float64", "?": "bool"}


@functools.cache
def numpy_or_none() -> ModuleType | None:
    try:
        import numpy
    except ImportError:
        return None
    return numpy


def make(kind: str, *shape: int) -> Any:
    """Zeros."""
    numpy = numpy_or_none()
    if numpy is not None:
        return numpy.zeros(shape, KINDS[kind])
    count = math.prod(shape)
    data = memoryview(bytearray(count * struct.calcsize(kind)))
    return data.cast(kind, shape) if count > 0 else data.cast(kind)  # no dimension may be 0


def address(values: Any) -> int:
    """Where an array of make() or take() lies; the caller keeps it alive."""
    view = memoryview(values)
    return ctypes.addressof(ctypes.c_char.from_buffer(view)) if view.nbytes > 0 else 0


def take(name: str, values: Any, kind: str, *columns: int | None) -> Any:
    """The caller's numbers as an array of rows of this shape, copied only where needed. None in the
    shape is any number."""
    numpy = numpy_or_none()
    found = take_numpy(numpy, name, values, kind) if numpy else take_plain(name, values, kind)
    if found.ndim == 1 and len(found) == 0:
        return make(kind, 0, *(column or 0 for column in columns))
    shape = found.shape[1:]
    if len(shape) != len(columns) or any(c not in (None, s) for c, s in zip(columns, shape)):
        wanted = shape_text("n", *("n" if column is None else column for column in columns))
        raise ValueError(f"{name} must have the shape {wanted}, not {shape_text(*found.shape)}")
    return found


def shape_text(*shape: object) -> str:
    return " x ".join(map(str, shape)) or "1"


def take_numpy(numpy: Any, name: str, values: Any, kind: str) -> Any:
    found = numpy.asarray(values)
    if found.size > 0 and kind in "BI":
        if found.dtype.kind not in "iu":
            raise TypeError(f"{name} must hold whole numbers, not {found.dtype}")
        most = numpy.iinfo(KINDS[kind]).max
        if found.min() < 0 or found.max() > most:
            raise ValueError(f"{name} must hold numbers from 0 to {most}")
    elif found.dtype.kind not in "fiub":
        raise TypeError(f"{name} must hold numbers, not {found.dtype}")
    return numpy.require(found, KINDS[kind], ["C", "W"])


def take_plain(name: str, values: Any, kind: str) -> Any:
    try:
        view = memoryview(values)
    except TypeError:
        return from_rows(name, values, kind)
    if view.format == kind and view.c_contiguous and not view.readonly:
        return view
    return from_rows(name, view.tolist(), kind)


def from_rows(name: str, values: Any, kind: str) -> Any:
    """Lists in lists, as deep as the first of each goes."""
    shape: list[int] = []
    level = [values]
    while level and hasattr(level[0], "__len__") and not isinstance(level[0], str):
        shape.append(len(level[0]))
        if any(len(row) != shape[-1] for row in level):
            raise ValueError(f"{name} must have rows of one length")
        level = [item for row in level for item in row]
    try:
        flat = array(kind, level)
    except OverflowError:
        raise ValueError(f"{name} has a number that is out of range") from None
    return memoryview(bytearray(flat)).cast(kind, shape) if level else memoryview(flat)
