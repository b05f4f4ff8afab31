# SPDX-License-Identifier: MIT
"""A camera of its own: to look at a scene from elsewhere, and to know the rays of its pixels."""

from __future__ import annotations

from ctypes import byref
from dataclasses import dataclass, fields
from typing import Any

from . import _abi
from ._abi import CameraType
from ._descs import desc
from ._library import library
from .errors import check

Triple = tuple[float, float, float]


def triple(values: Any) -> Triple:
    x, y, z = values
    return x, y, z


@dataclass(frozen=True)
class Camera:
    """A camera, with the meanings and defaults of Scene.set_camera().

    dataclasses.replace(camera, view_point=(0, 0, 9)) is the same camera from another place.
    """

    type: CameraType = CameraType.PERSPECTIVE
    view_point: Triple = (0.0, 0.0, 0.0)
    view_direction: Triple = (0.0, 0.0, -1.0)
    view_up: Triple = (0.0, 1.0, 0.0)
    projection_normal: Triple = (0.0, 0.0, 0.0)
    projection_distance: float = 1.0
    view_width: float = 1.0
    view_height: float = 1.0

    def ray(self, a: float, b: float) -> tuple[Triple, Triple]:
        """Origin and direction (unit) of the ray through a place of the window: a runs from 0 at
        its left to 1, b from 0 at its bottom. The middle of the pixel (x, y) of a picture of w x h
        pixels, y from the top, is a = (x + 0.5) / w, b = 1 - (y + 0.5) / h."""
        ray, error = _abi.GlintRay(), _abi.GlintError()
        struct = self._struct()
        lib = library()
        status = lib.glint_camera_ray(byref(struct), float(a), float(b), byref(ray), byref(error))
        check(status, error)
        return triple(ray.origin), triple(ray.direction)

    def _struct(self) -> Any:
        return desc(library(), "camera", **{f.name: getattr(self, f.name) for f in fields(self)})

    @classmethod
    def _of(cls, struct: Any) -> Camera:
        values = {}
        for field in fields(cls):
            value = getattr(struct, field.name)
            values[field.name] = tuple(value) if hasattr(value, "__len__") else value
        values["type"] = CameraType(values["type"])
        return cls(**values)
