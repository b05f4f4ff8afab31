# SPDX-License-Identifier: MIT
"""From a scene to a picture."""

from __future__ import annotations

import os
from collections.abc import Sequence
from ctypes import POINTER, byref, pointer
from typing import Any

from . import _abi
from ._abi import Sampling
from ._arrays import address, make
from ._descs import choose, desc
from ._handle import Handle, path_bytes
from ._monitor import Monitor, Progress
from .camera import Camera
from .errors import check
from .image import Image, layer_columns, layer_kind
from .recipe import Recipe


class Rendering(Handle):
    """The part of a Scene that draws it."""

    def render(
        self,
        *,
        width: int = 0,
        height: int = 0,
        samples: int = 0,
        crop: Sequence[int] | None = None,
        light: int = 0,
        layers: Sequence[str] = (),
        sampling: Sampling | str = Sampling.SOBOL,
        camera: Camera | None = None,
        embed: bool = False,
        progress: Progress | None = None,
    ) -> Image:
        """Draws the scene into memory.

        width, height: pixels, whatever the scene says; the window keeps its shape. 0: the scene's.
        samples: per pixel, on a regular n x n grid, n = round(sqrt); to 65536. 0: the scene's.
        crop: (x, y, width, height): only this part of the picture, from its top left corner.
        light: k > 0: only what comes from the k-th light; -1: what comes from none of them. The
        parts sum up to the whole, 0, but for rounding.
        layers: what to keep of what the camera rays meet: "depth", "normal", "albedo", "surface".
        sampling: where samples of large lights and paths fall: "sobol", or "random", which is
        noisier, to compare with.
        camera: in the place of the scene's; nothing is built anew, see Scene.camera.
        embed: put the scene and all its files into the recipe, and so into a PNG; the scene must
        have been loaded with keep_sources.
        progress: is called with the Phase and the share done, from 0 to 1; to stop, it raises any
        exception, which then comes out of this call. Ctrl-C stops as well.
        """
        if isinstance(layers, str):
            layers = [layers]
        settings = self._render_desc(width, height, samples, crop, light, sampling, camera)
        across, down = self._size(settings)
        pixels = make("f", down, across, 3)
        found = {
            name: make(layer_kind(name), down, across, *layer_columns(name)) for name in layers
        }
        for name, values in found.items():
            setattr(settings, name, address(values))
        self.commit(progress=progress)
        recipe = self._recipe(settings, embed)
        # Where nothing can be drawn the library says why, unless the address is null.
        anything = make("f", 1)
        target = address(pixels) or address(anything)
        self._draw("glint_render", settings, target, progress=progress)
        return Image(pixels, title=self._title(), layers=found, recipe=recipe)

    def render_to(
        self,
        path: str | os.PathLike[str],
        *,
        width: int = 0,
        height: int = 0,
        samples: int = 0,
        crop: Sequence[int] | None = None,
        light: int = 0,
        layers: Sequence[str] = (),
        sampling: Sampling | str = Sampling.SOBOL,
        camera: Camera | None = None,
        embed: bool = False,
        progress: Progress | None = None,
    ) -> None:
        """Draws the scene into a file: .png, .pfm or .exr; the same bytes as render() and save().

        A PNG is encoded while it is drawn and never stands in memory as a whole. layers are for
        .exr. The other arguments are those of render().
        """
        if layers:
            if not os.fspath(path).lower().endswith(".exr"):
                raise ValueError("only .exr has room for layers")
            encoded = path_bytes(path)
            error = _abi.GlintError()
            check(self._library.glint_image_check_path(encoded, byref(error)), error)
            image = self.render(
                width=width,
                height=height,
                samples=samples,
                crop=crop,
                light=light,
                layers=layers,
                sampling=sampling,
                camera=camera,
                embed=embed,
                progress=progress,
            )
            image.save(path, progress=progress)
            return
        settings = self._render_desc(width, height, samples, crop, light, sampling, camera)
        title = self._title()
        save = desc(self._library, "save")
        save.title = None if title is None else title.encode("utf-8", "replace")
        encoded = path_bytes(path)
        self.commit(progress=progress)
        recipe = self._recipe(settings, embed) if embed else None
        if recipe is not None:
            save.recipe = recipe._pointer
        self._draw("glint_render_save", settings, encoded, save, progress=progress)

    def _render_desc(
        self,
        width: int,
        height: int,
        samples: int,
        crop: Sequence[int] | None,
        light: int,
        sampling: Sampling | str,
        camera: Camera | None,
    ) -> Any:
        values: dict[str, Any] = {}
        if crop is not None:
            names = ("crop_x", "crop_y", "crop_width", "crop_height")
            if len(crop) != len(names):
                raise ValueError("crop needs 4 numbers: x, y, width, height")
            values = dict(zip(names, crop))
        kind = choose(Sampling, "sampling", sampling)
        values.update(width=width, height=height, samples=samples, light=light, sampling=kind)
        settings = desc(self._library, "render", **values)
        if camera is not None:
            settings.camera = pointer(camera._struct())
        return settings

    def _recipe(self, settings: Any, embed: bool) -> Recipe | None:
        """Of what would be drawn; there is none with another camera."""
        if settings.camera and not embed:
            return None
        found = POINTER(_abi.GlintRecipe)()
        self._call("glint_scene_recipe", byref(settings), embed, byref(found))
        return Recipe(found)

    def _size(self, settings: Any) -> tuple[int, int]:
        """What the library will draw, or nothing where it will refuse."""
        info = _abi.GlintSceneInfo()
        self._library.glint_scene_info(self._live(), byref(info))
        width = settings.crop_width or (settings.width or info.width) - settings.crop_x
        height = settings.crop_height or (settings.height or info.height) - settings.crop_y
        possible = width > 0 and height > 0 and width * height <= 1 << 28
        return (width, height) if possible else (0, 0)

    def _title(self) -> str | None:
        return os.path.basename(self._name) or None

    def _draw(self, name: str, settings: Any, *arguments: Any, progress: Progress | None) -> None:
        error = _abi.GlintError()
        with self._alone() as native, Monitor(progress) as monitor:
            settings.monitor = pointer(monitor)
            targets = [a if isinstance(a, (int, bytes)) else byref(a) for a in arguments]
            function = getattr(self._library, name)
            check(function(native, byref(settings), *targets, byref(error)), error)
