# SPDX-License-Identifier: MIT
"""Single rays, and many of them."""

from __future__ import annotations

import math
from ctypes import addressof, byref
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _abi
from ._arrays import make, numpy_or_none, take
from ._descs import numbers
from ._handle import Handle
from .building import ShaderId, SurfaceId, Vector
from .camera import triple

if TYPE_CHECKING:
    from ._arrays import Booleans, Doubles, Integers


@dataclass(frozen=True)
class Hit:
    """What a ray meets first."""

    t: float
    """In lengths of the ray's direction."""
    point: tuple[float, float, float]
    normal: tuple[float, float, float]
    """Unit, outward, never turned toward the ray."""
    surface: SurfaceId
    """0: a rectangle light, of a dialect where these can be seen."""
    shader: ShaderId


@dataclass(frozen=True, eq=False)
class Hits:
    """What n rays meet first. Where one meets nothing t is infinite and the rest is 0."""

    t: Doubles
    """n numbers, in lengths of the ray's direction."""
    point: Doubles
    """n x 3."""
    normal: Doubles
    """n x 3: unit, outward, never turned toward the ray."""
    surface: Integers
    """n SurfaceIds; 0: nothing, or a rectangle light that can be seen."""
    shader: Integers
    """n ShaderIds."""

    def __len__(self) -> int:
        return len(self.t)


class Tracing(Handle):
    """The part of a Scene that is asked what rays meet. Any number of threads may ask."""

    def trace(
        self, origin: Vector, direction: Vector, t_min: float = 0.0, t_max: float = math.inf
    ) -> Hit | None:
        """The nearest hit of a ray; None: there is none.

        direction: of length 1e-100 to 1e100; t counts in this length.
        t_min, t_max: hits lie between, neither counts.
        """
        self.commit()
        ray, hit = make_ray(origin, direction, t_min, t_max), _abi.GlintHit()
        if not self._library.trace(self._live(), byref(ray), byref(hit)):
            return None
        return Hit(
            t=hit.t,
            point=triple(hit.point),
            normal=triple(hit.normal),
            surface=SurfaceId(hit.surface.index1),
            shader=ShaderId(hit.shader.index1),
        )

    def occluded(
        self, origin: Vector, direction: Vector, t_min: float = 0.0, t_max: float = math.inf
    ) -> bool:
        """Whether a ray meets anything. The arguments are those of trace()."""
        self.commit()
        ray = make_ray(origin, direction, t_min, t_max)
        return bool(self._library.occluded(self._live(), byref(ray)))

    def trace_rays(
        self, origins: Any, directions: Any, t_min: Any = 0.0, t_max: Any = math.inf
    ) -> Hits:
        """The nearest hits of n rays.

        origins, directions: n x 3 each, as arrays or lists, or three numbers for all rays.
        t_min, t_max: n numbers each, or one for all.
        """
        self.commit()
        rays, hits = make_rays(origins, directions, t_min, t_max)
        native, trace = self._live(), self._library.trace
        for ray, hit in zip(addresses(rays), addresses(hits)):
            trace(native, ray, hit)
        return read_hits(hits)

    def occluded_rays(
        self, origins: Any, directions: Any, t_min: Any = 0.0, t_max: Any = math.inf
    ) -> Booleans:
        """Of each of n rays whether it meets anything. The arguments are those of trace_rays()."""
        self.commit()
        rays, _ = make_rays(origins, directions, t_min, t_max)
        native, occluded = self._live(), self._library.occluded
        found: Booleans = make("?", len(rays))
        for i, ray in enumerate(addresses(rays)):
            found[i] = occluded(native, ray)
        return found


# The library does not look at rays it is handed, so that is done here.


def make_ray(origin: Vector, direction: Vector, t_min: float, t_max: float) -> _abi.GlintRay:
    ray = _abi.GlintRay(
        tuple(numbers("origin", origin, 3)), tuple(numbers("direction", direction, 3)), t_min, t_max
    )
    if not all(map(math.isfinite, ray.origin)):
        raise ValueError("origin is not finite")
    if not all(map(math.isfinite, ray.direction)):
        raise ValueError("direction is not finite")
    if not any(ray.direction):
        raise ValueError("direction has no length")
    if math.isnan(ray.t_min) or math.isnan(ray.t_max):
        raise ValueError("t_min and t_max must be numbers")
    return ray


def make_rays(origins: Any, directions: Any, t_min: Any, t_max: Any) -> tuple[Any, Any]:
    """Arrays of GlintRay and GlintHit; no hit yet."""
    numpy = numpy_or_none()
    if numpy is None:
        return make_rays_plain(origins, directions, t_min, t_max)
    vectors = {"origins": origins, "directions": directions}
    limits = {"t_min": t_min, "t_max": t_max}
    found = {n: numpy.asarray(v, "float64") for n, v in (vectors | limits).items()}
    for name in vectors:
        if found[name].shape[-1:] != (3,):
            raise ValueError(f"{name} must be three numbers, or rows of three")
        if not numpy.isfinite(found[name]).all():
            raise ValueError(f"{name} are not all finite")
    if not found["directions"].any(axis=-1).all():
        raise ValueError("not all directions have a length")
    if any(numpy.isnan(found[name]).any() for name in limits):
        raise ValueError("t_min and t_max must be numbers")
    shapes = [found[n].shape[:-1] for n in vectors] + [found[n].shape for n in limits]
    shape = numpy.broadcast_shapes((1,), *shapes)
    if len(shape) != 1:
        raise ValueError("rays come in a row: origins and directions are n x 3")
    rays, hits = numpy.zeros(shape, _abi.GlintRay), numpy.zeros(shape, _abi.GlintHit)
    for name, values in zip(("origin", "direction", "t_min", "t_max"), found.values()):
        rays[name] = values
    hits["t"] = math.inf
    return rays, hits


def make_rays_plain(origins: Any, directions: Any, t_min: Any, t_max: Any) -> tuple[Any, Any]:
    """The same without NumPy."""
    columns = [origins, directions]
    columns = [c if len(c) > 0 and hasattr(c[0], "__len__") else [c] for c in columns]
    columns += [c if hasattr(c, "__len__") else [c] for c in (t_min, t_max)]
    lengths = {len(column) for column in columns} - {1}
    if len(lengths) > 1:
        raise ValueError("there are different numbers of origins, directions and limits")
    count = lengths.pop() if lengths else 1
    repeated = [column if len(column) == count else column * count for column in columns]
    rays, hits = (_abi.GlintRay * count)(*map(make_ray, *repeated)), (_abi.GlintHit * count)()
    for hit in hits:
        hit.t = math.inf
    return rays, hits


def addresses(structs: Any) -> range:
    """Where the structs of an array lie."""
    size = memoryview(structs).itemsize
    start = structs.ctypes.data if hasattr(structs, "ctypes") else addressof(structs)
    return range(start, start + len(structs) * size, size)


def read_hits(hits: Any) -> Hits:
    numpy = numpy_or_none()
    if numpy is not None:
        return Hits(
            t=hits["t"].copy(),
            point=hits["point"].copy(),
            normal=hits["normal"].copy(),
            surface=hits["surface"]["index1"].copy(),
            shader=hits["shader"]["index1"].copy(),
        )
    return Hits(
        t=take("t", [hit.t for hit in hits], "d"),
        point=take("point", [list(hit.point) for hit in hits], "d", 3),
        normal=take("normal", [list(hit.normal) for hit in hits], "d", 3),
        surface=take("surface", [hit.surface.index1 for hit in hits], "I"),
        shader=take("shader", [hit.shader.index1 for hit in hits], "I"),
    )
