# SPDX-License-Identifier: MIT
"""Pictures: linear pixels in memory, what the camera rays met, and files of them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from ctypes import POINTER, byref, c_uint64, cast, pointer, string_at
from typing import TYPE_CHECKING, Any

from . import _abi
from ._arrays import address, make, numpy_or_none, take
from ._descs import desc, unknown
from ._handle import path_bytes
from ._library import library
from ._monitor import Monitor, Progress
from .errors import check
from .recipe import Recipe

if TYPE_CHECKING:
    from ._arrays import Bytes, Floats, Integers

# What a picture can have beside its colours: the kind of number, the letters of its components.
LAYERS = {
    "depth": ("f", "Z"),
    "normal": ("f", "XYZ"),
    "albedo": ("f", "RGB"),
    "surface": ("I", "I"),
}


def layer_kind(name: str) -> str:
    """Its kind of numbers."""
    if name not in LAYERS:
        raise unknown("layer", name, LAYERS)
    return LAYERS[name][0]


def layer_columns(name: str) -> tuple[int, ...]:
    """The shape of one of its pixels."""
    count = len(LAYERS[name][1])
    return (count,) if count > 1 else ()


class Image:
    """A picture. Notebooks show it.

    Arrays are NumPy's where NumPy is installed, else memoryviews of the same shape and numbers.
    """

    pixels: Floats
    """height x width x 3 single-precision numbers, linear RGB, top row first."""
    title: str | None
    """Is written into files."""
    layers: dict[str, Any]
    """By name what render() was asked for: see depth, normal, albedo and surface."""
    recipe: Recipe | None
    """What it takes to draw it once more; it goes into a PNG. None of pictures of one's own, and of
    those drawn with another camera."""

    def __init__(
        self,
        pixels: Any,
        *,
        title: str | None = None,
        layers: Mapping[str, Any] | None = None,
        recipe: Recipe | None = None,
    ) -> None:
        """A picture of these pixels: an array of height x width x 3, or rows of rows. An array in
        single precision is not copied."""
        self.pixels = take("pixels", pixels, "f", None, 3)
        if self.pixels.nbytes == 0:
            raise ValueError("a picture has at least one pixel")
        self.title = title
        self.recipe = recipe
        self.layers = {}
        for name, values in (layers or {}).items():
            found = take(name, values, layer_kind(name), self.width, *layer_columns(name))
            if len(found) != self.height:
                raise ValueError(f"{name} must have as many rows as the picture, {self.height}")
            self.layers[name] = found

    @property
    def width(self) -> int:
        """Pixels."""
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        """Pixels."""
        return int(self.pixels.shape[0])

    # ------------------------------------------------------------ layers

    def _layer(self, name: str) -> Any:
        if name not in self.layers:
            raise AttributeError(f"the picture has no {name}: render(layers=[{name!r}]) adds it")
        return self.layers[name]

    @property
    def depth(self) -> Floats:
        """height x width: distance from the origin of the ray; 0 where it meets nothing. A mean
        over the samples of the pixel."""
        found: Floats = self._layer("depth")
        return found

    @property
    def normal(self) -> Floats:
        """height x width x 3: the normal that is shaded with; 0 0 0 where nothing is met. A mean
        over the samples of the pixel."""
        found: Floats = self._layer("normal")
        return found

    @property
    def albedo(self) -> Floats:
        """height x width x 3: the diffuse colour, textures included; of glazing what is under it,
        of glass 0. A mean over the samples of the pixel."""
        found: Floats = self._layer("albedo")
        return found

    @property
    def surface(self) -> Integers:
        """height x width: the SurfaceId of what the pixel's first sample met; 0: nothing."""
        found: Integers = self._layer("surface")
        return found

    # ------------------------------------------------------------ 8 bits

    def rgb8(self) -> Bytes:
        """height x width x 3 bytes: what a PNG of the picture holds (gamma 2.2)."""
        found: Bytes = make("B", self.height, self.width, 3)
        library().glint_image_to_rgb8(byref(self._struct()), address(found))
        return found

    def digest(self) -> int:
        """CRC-64/XZ of the 8-bit values: that of the PNG, see picture_digest()."""
        digest, error = c_uint64(), _abi.GlintError()
        struct = self._struct()
        check(library().glint_image_digest(byref(struct), byref(digest), byref(error)), error)
        return digest.value

    def png(self) -> bytes:
        """The bytes of a PNG file of the picture."""
        parts: list[bytes] = []

        def sink(_user: object, data: int, size: int) -> bool:
            parts.append(string_at(data, size))
            return True

        lib, error = library(), _abi.GlintError()
        struct, settings = self._struct(), self._save_desc()
        encode = lib.glint_image_encode_png
        taker = _abi.GlintSinkFn(sink)
        check(encode(byref(struct), byref(settings), taker, None, byref(error)), error)
        return b"".join(parts)

    def _repr_png_(self) -> bytes:
        return self.png()

    def __repr__(self) -> str:
        with_layers = f" with {', '.join(self.layers)}" if self.layers else ""
        return f"<glint.Image {self.width} x {self.height}{with_layers}>"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        """For numpy.asarray(image): the pixels."""
        numpy = numpy_or_none()
        if numpy is None:
            raise TypeError("NumPy is not installed")
        return numpy.array(self.pixels, dtype) if copy else numpy.asarray(self.pixels, dtype)

    # ------------------------------------------------------------ files

    def save(self, path: str | os.PathLike[str], *, progress: Progress | None = None) -> None:
        """Writes the picture, in the format of the name's end: .png (8 bits, gamma 2.2), .pfm
        (linear single precision) or .exr (the same, compressed, with all layers).

        The file appears whole or not at all. progress: as for Scene.render().
        """
        encoded = path_bytes(path)
        lib, error = library(), _abi.GlintError()
        struct, settings = self._struct(), self._save_desc()
        kept: list[Any] = []
        if os.fspath(path).lower().endswith(".exr"):
            kept = self._put_layers(settings)
        with Monitor(progress) as monitor:
            settings.monitor = pointer(monitor)
            check(
                lib.glint_image_save(byref(struct), encoded, byref(settings), byref(error)), error
            )
        del kept  # the layers' numbers had to live until here

    def _struct(self) -> _abi.GlintImage:
        return _abi.GlintImage(self.width, self.height, address(self.pixels))

    def _save_desc(self) -> Any:
        settings = desc(library(), "save")
        settings.title = None if self.title is None else self.title.encode("utf-8", "replace")
        if self.recipe is not None:
            settings.recipe = self.recipe._pointer
        return settings

    def _put_layers(self, settings: Any) -> list[Any]:
        """Returns what must be kept while settings are used."""
        kept = [as_floats(values) for values in self.layers.values()]
        layers = (_abi.GlintLayer * len(kept))()
        for layer, name, values in zip(layers, self.layers, kept):
            layer.name = name.encode()
            layer.components = LAYERS[name][1].encode()
            layer.pixels = address(values)
        settings.layers = cast(layers, POINTER(_abi.GlintLayer))
        settings.layer_count = len(kept)
        return [*kept, layers]


def as_floats(values: Any) -> Any:
    """A layer as files hold it."""
    numpy = numpy_or_none()
    if numpy is not None:
        return numpy.ascontiguousarray(values, "float32")
    if values.format == "f":
        return values
    found = make("f", *values.shape)
    plain, flat = found.cast("B").cast("f"), values.cast("B").cast(values.format)
    for i, value in enumerate(flat):
        plain[i] = value
    return found


def can_save(path: str | os.PathLike[str]) -> None:
    """Raises a GlintError when there is no format for this name, or none that this library can
    write: a question to ask before drawing. Nothing is written."""
    error = _abi.GlintError()
    check(library().glint_image_check_path(path_bytes(path), byref(error)), error)
