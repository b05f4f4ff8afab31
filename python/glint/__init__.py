# SPDX-License-Identifier: MIT
"""Glint, an exact and fast ray tracer, from Python.

    import glint

    scene = glint.Scene.from_file("scenes/solids.xml")
    image = scene.render(width=720, height=405)
    image.save("solids.png")

Scenes come from XML (Scene.from_file, from_string, from_stream) or are built by calls (Scene() and
its set_, add_ and load_ functions). They are drawn with render() or render_to(), and asked what
rays meet with trace() and trace_rays(). What goes wrong is a GlintError, with file, line, column,
and for mistakes in a scene all of them as a compiler would print them.

Coordinates are right-handed, colours are linear RGB, rows of pixels run from top to bottom. The
same scene makes the same picture to the last bit on every machine.

The C library is looked for where the environment variable GLINT_LIBRARY says, in the build folder
when this package lies in Glint's sources, and where the system keeps its libraries.
"""

from __future__ import annotations

from ._abi import VERSION as __version__
from ._abi import (
    CameraType,
    Falloff,
    FileKind,
    Integrator,
    LightType,
    ObjectKind,
    Phase,
    Sampling,
    Severity,
    ShaderType,
    Status,
    Wrap,
)
from ._handle import dialects
from ._library import instruction_sets, library_path, use_library
from .building import GroupId, MeshId, ShaderId, SurfaceId, TextureId, Vector
from .camera import Camera
from .errors import Diagnostic, GlintError
from .image import Image, can_save
from .recipe import Recipe, RecipeFile, picture_digest
from .scene import Scene, SceneFile, SceneInfo, Source, Stats
from .tracing import Hit, Hits

__all__ = [
    "Camera",
    "CameraType",
    "Diagnostic",
    "Falloff",
    "FileKind",
    "GlintError",
    "GroupId",
    "Hit",
    "Hits",
    "Image",
    "Integrator",
    "LightType",
    "MeshId",
    "ObjectKind",
    "Phase",
    "Recipe",
    "RecipeFile",
    "Sampling",
    "Scene",
    "SceneFile",
    "SceneInfo",
    "Severity",
    "ShaderId",
    "ShaderType",
    "Source",
    "Stats",
    "Status",
    "SurfaceId",
    "TextureId",
    "Vector",
    "Wrap",
    "__version__",
    "can_save",
    "dialects",
    "instruction_sets",
    "library_path",
    "picture_digest",
    "use_library",
]
