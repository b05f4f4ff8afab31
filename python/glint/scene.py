# SPDX-License-Identifier: MIT
"""The scene: how it comes from a file, and what is known of it."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable
from ctypes import byref
from dataclasses import dataclass
from typing import Any, BinaryIO, TypeVar

from . import _abi
from ._abi import FileKind, ObjectKind
from ._descs import choose, integer
from ._handle import path_bytes
from ._monitor import Progress
from .building import Building
from .camera import Camera
from .errors import Diagnostic, text
from .rendering import Rendering
from .tracing import Tracing

Self = TypeVar("Self", bound="Scene")


@dataclass(frozen=True)
class SceneInfo:
    """What a scene holds."""

    dialect: str
    """The one in force; "auto" before commit() when it is not known yet."""
    width: int
    """Pixels of its picture."""
    height: int
    samples: int
    """Per pixel."""
    surface_count: int
    """As traced: groups spread out."""
    light_count: int
    shader_count: int


@dataclass(frozen=True)
class Stats:
    """What the phases took and found so far: seconds of wall time; rays of the last picture."""

    read_seconds: float
    build_seconds: float
    trace_seconds: float
    read_bytes: int
    camera_rays: int
    shadow_rays: int
    other_rays: int
    """Mirrored, refracted, scattered."""
    primitive_count: int
    node_count: int
    leaf_count: int
    tree_bytes: int
    sah_cost: float
    """Node visits and block tests that a random ray expects."""
    memory_peak: int
    """Bytes that the library asked for at the same time."""
    thread_count: int
    isa: str


@dataclass(frozen=True)
class SceneFile:
    """A file that a scene is made of."""

    kind: FileKind
    name: str
    """As the scene calls it; of the scene itself: as it was loaded."""
    path: str
    """As it was opened."""
    size: int
    """Bytes; 0 of what is no regular file."""
    digest: int
    """CRC-64/XZ of its content; 0 likewise."""


@dataclass(frozen=True)
class Source:
    """The place of an object in the scene file."""

    path: str
    name: str
    """Its name attribute; empty for none."""
    line: int
    """Of its start tag, from 1."""
    column: int
    """From 1, in characters."""


class Scene(Building, Rendering, Tracing):
    """A scene: first filled, from XML or by calls, then drawn and asked what rays meet.

        with glint.Scene.from_file("scenes/solids.xml") as scene:
            scene.render().save("solids.png")

    dialect: "auto" finds the rules from the content; any other of dialects() overrides the file's.
    threads: 0: one per core; 1: only the caller's.
    isa: one of instruction_sets(); None: the fastest. The picture is the same.
    memory_limit: bytes; 0: nine tenths of the machine's.
    keep_sources: keep the scene file in memory, so that source() and embed know of it.

    A scene may be used from several threads: one call at a time runs, the others wait; only rays
    are traced at any time. close(), or the end of a `with`, frees it, as does the last reference.
    """

    @classmethod
    def from_file(
        cls: type[Self],
        path: str | os.PathLike[str],
        *,
        dialect: str = "auto",
        threads: int = 0,
        isa: str | None = None,
        memory_limit: int = 0,
        keep_sources: bool = False,
        progress: Progress | None = None,
    ) -> Self:
        """Reads an XML file. Raises a GlintError with all mistakes in it, see its diagnostics."""
        scene = cls(
            dialect=dialect,
            threads=threads,
            isa=isa,
            memory_limit=memory_limit,
            keep_sources=keep_sources,
        )
        scene._load("glint_scene_load_file", path, progress=progress)
        return scene

    @classmethod
    def from_string(
        cls: type[Self],
        xml: str | bytes,
        *,
        name: str | os.PathLike[str] = "string",
        dialect: str = "auto",
        threads: int = 0,
        isa: str | None = None,
        memory_limit: int = 0,
        keep_sources: bool = False,
        progress: Progress | None = None,
    ) -> Self:
        """The same from memory. name stands for the path in messages and may be one: files that
        the scene names are looked for from there."""
        scene = cls(
            dialect=dialect,
            threads=threads,
            isa=isa,
            memory_limit=memory_limit,
            keep_sources=keep_sources,
        )
        data = xml.encode() if isinstance(xml, str) else bytes(xml)
        scene._load("glint_scene_load_memory", name, data, len(data), progress=progress)
        return scene

    @classmethod
    def from_stream(
        cls: type[Self],
        stream: BinaryIO,
        *,
        name: str | os.PathLike[str] = "stream",
        dialect: str = "auto",
        threads: int = 0,
        isa: str | None = None,
        memory_limit: int = 0,
        keep_sources: bool = False,
        progress: Progress | None = None,
    ) -> Self:
        """The same from an open binary file, in chunks as they are needed."""
        scene = cls(
            dialect=dialect,
            threads=threads,
            isa=isa,
            memory_limit=memory_limit,
            keep_sources=keep_sources,
        )
        reader = Reader(stream.read)
        try:
            scene._load("glint_scene_load_stream", name, reader.callback, None, progress=progress)
        finally:
            if reader.raised is not None:
                raise reader.raised
        return scene

    def _load(
        self, function: str, path: str | os.PathLike[str], *before: Any, progress: Progress | None
    ) -> None:
        self._name = os.fsdecode(path)
        self._long_call(function, *before, path_bytes(path), progress=progress)

    @property
    def name(self) -> str:
        """The path or name it was loaded by; empty when it was built by calls."""
        return self._name

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The findings in its file: warnings at most, or there would be no scene."""
        return tuple(self._diagnostics)

    @property
    def info(self) -> SceneInfo:
        """What it holds."""
        found = _abi.GlintSceneInfo()
        self._library.glint_scene_info(self._live(), byref(found))
        values = members(found)
        values["dialect"] = text(self._library.glint_dialect_name(found.dialect))
        return SceneInfo(**values)

    @property
    def stats(self) -> Stats:
        """What the phases took and found so far."""
        found = _abi.GlintStats()
        self._library.glint_scene_stats(self._live(), byref(found))
        values = members(found)
        values["isa"] = text(found.isa)
        return Stats(**values)

    @property
    def camera(self) -> Camera:
        """Its camera. One made of it by dataclasses.replace() can be given to render()."""
        found = _abi.GlintCameraDesc()
        if not self._library.glint_scene_camera(self._live(), byref(found)):
            raise ValueError("the scene has no camera")
        return Camera._of(found)

    @property
    def files(self) -> list[SceneFile]:
        """The files it is made of: its own first, then meshes, textures and the environment."""
        files: list[SceneFile] = []
        found = _abi.GlintSceneFile()
        while self._library.glint_scene_file(self._live(), len(files), byref(found)):
            values = members(found)
            values.update(kind=FileKind(found.kind), name=text(found.name), path=text(found.path))
            files.append(SceneFile(**values))
        return files

    def source(self, kind: ObjectKind | str, number: int) -> Source | None:
        """Where an object stands in the file, when it was loaded with keep_sources; None where that
        is not known.

        kind: "surface" (number: its SurfaceId, as of a Hit), "shader" (its ShaderId), "light" or
        "camera" (the k-th, from 1).
        """
        found, what = _abi.GlintSource(), choose(ObjectKind, "kind", kind)
        number = integer("number", number)
        if number < 1:
            return None
        with self._alone() as native:
            if not self._library.glint_scene_source(native, what, number, byref(found)):
                return None
            return Source(text(found.path), text(found.name), found.line, found.column)

    def __repr__(self) -> str:
        if self.closed:
            return "<glint.Scene, closed>"
        info = self.info
        name = f" {self._name!r}" if self._name else ""
        return (
            f"<glint.Scene{name}: {info.width} x {info.height} pixels, "
            f"{info.surface_count} surfaces, {info.light_count} lights>"
        )


class Reader:
    """Hands the bytes of a stream to the library, and keeps an exception until C is left."""

    def __init__(self, read: Callable[[int], bytes]) -> None:
        self.read = read
        self.raised: BaseException | None = None
        self.callback = _abi.GlintReadFn(self.on_read)

    def on_read(self, _user: object, buffer: int, size: int) -> int:
        try:
            data = self.read(size)
            ctypes.memmove(buffer, data, len(data))
            return len(data)
        except BaseException as error:
            self.raised = error
            return -1


def members(struct: ctypes.Structure) -> dict[str, Any]:
    """By name."""
    return {name: getattr(struct, name) for name, *_ in struct._fields_}
