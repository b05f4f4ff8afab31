# SPDX-License-Identifier: MIT
"""Why a pixel has its colour: every ray, what it met, and every number that was added."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import Array, Structure, byref, pointer
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

from . import _abi
from ._abi import Sampling
from ._monitor import Monitor
from .camera import Camera, Triple, triple
from .errors import check
from .rendering import Rendering

NONE = 0xFFFFFFFF  # GLINT_NONE


@dataclass(frozen=True)
class ExplainedSample:
    """A sample of a pixel. Rays form a tree: the camera's is the first.

    The elements of the lists have the members of the structs in glint.h: kinds and fates are enums,
    colours and places tuples, a reference to an element of another list is its index, or None.
    """

    film: tuple[float, float]
    """The place in the pixel: 0 to 1 from its lower left corner."""
    rays: list[Any]
    """GlintExplainRay: what each ray met."""
    layers: list[Any]
    """GlintExplainLayer: glazing, glass and mirrors on the way."""
    branches: list[Any]
    """GlintExplainBranch: what became of rays that might go on."""
    lights: list[Any]
    """GlintExplainLight: what each light did where."""
    additions: list[Any]
    """GlintExplainAddition: what was added, in its order."""
    color: Triple
    """The sum of all additions, linear."""


@dataclass(frozen=True)
class Explanation:
    """Why a pixel has its colour."""

    x: int
    y: int
    samples: list[ExplainedSample]
    color: Triple
    """What render() gives, to the last bit: the mean of the samples times exposure."""
    exposure: float
    rgb: tuple[int, int, int]
    """The same in 8 bits, as in a PNG."""


class Explaining(Rendering):
    """The part of a Scene that says why."""

    def explain(
        self,
        x: int,
        y: int,
        *,
        width: int = 0,
        height: int = 0,
        samples: int = 0,
        light: int = 0,
        sampling: Sampling | str = Sampling.SOBOL,
        camera: Camera | None = None,
    ) -> Explanation:
        """Why the pixel x, y (from the top left) of a picture has its colour.

        All this is noted while the pixel is drawn, by the code that draws pictures. The other
        arguments are those of render().
        """
        crop: Sequence[int] = (x, y, 1, 1)
        settings = self._render_desc(width, height, samples, crop, light, sampling, camera)
        self.commit()
        drawn: list[ExplainedSample] = []
        pixels: list[Any] = []
        members: dict[str, Any] = dict(_abi.GlintExplainSink._fields_)
        sink = _abi.GlintExplainSink(
            members["sample"](lambda _user, found: drawn.append(sample(found.contents))),
            members["pixel"](lambda _user, found: pixels.append(plain(found.contents))),
        )
        error = _abi.GlintError()
        with self._alone() as native, Monitor(None) as monitor:
            settings.monitor = pointer(monitor)
            explain = self._library.glint_explain
            check(explain(native, byref(settings), byref(sink), byref(error)), error)
        (pixel,) = pixels
        return Explanation(x, y, drawn, pixel.color, pixel.exposure, pixel.rgb)


def sample(found: Any) -> ExplainedSample:
    return ExplainedSample(
        film=(found.film_x, found.film_y),
        rays=[plain(found.rays[i]) for i in range(found.ray_count)],
        layers=[plain(found.layers[i]) for i in range(found.layer_count)],
        branches=[plain(found.branches[i]) for i in range(found.branch_count)],
        lights=[plain(found.lights[i]) for i in range(found.light_count)],
        additions=[plain(found.additions[i]) for i in range(found.addition_count)],
        color=triple(found.color),
    )


def plain(struct: Any) -> SimpleNamespace:
    """The members of a struct as Python has them."""
    enums = getattr(struct, "_enums_", {})
    result = SimpleNamespace()
    for name, *_ in struct._fields_:
        value = getattr(struct, name)
        if name in enums:
            value = enums[name](value)
        elif isinstance(value, Array):
            value = tuple(value)
        elif isinstance(value, Structure):  # an id
            value = value.index1
        elif value == NONE and isinstance(value, int):
            value = None
        setattr(result, name, value)
    return result
