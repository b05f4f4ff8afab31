# SPDX-License-Identifier: MIT
"""Scenes built by calls: image, camera, shaders, textures, lights and surfaces."""

from __future__ import annotations

import os
from collections.abc import Sequence
from ctypes import byref
from typing import Any, TypeVar

from . import _abi
from ._abi import CameraType, Falloff, Integrator, LightType, ShaderType, SurfaceType, Wrap
from ._arrays import address, take
from ._descs import choose, desc
from ._handle import Handle, path_bytes

Vector = Sequence[float]
"""Three numbers: a tuple, a list or an array."""


class ShaderId(int):
    """A shader of a scene; 0 is the default one, white and Lambertian."""


class TextureId(int):
    """A texture of a scene."""


class MeshId(int):
    """A mesh of a scene, which any number of surfaces may show."""


class SurfaceId(int):
    """A surface of a scene: its number, from 1, in the order of adding; groups are not counted."""


class GroupId(SurfaceId):
    """A group of a scene. It has no number among the surfaces."""


Id = TypeVar("Id", bound=int)


class Building(Handle):
    """The part of a Scene that fills it."""

    def set_image(
        self,
        width: int,
        height: int,
        *,
        samples: int | None = None,
        back_color: Vector | None = None,
        exposure: float | None = None,
        integrator: Integrator | str | None = None,
        max_depth: int | None = None,
    ) -> None:
        """Says what picture the scene makes.

        width, height: pixels; each at least 1, at most 2^28 together.
        samples: per pixel, on a regular n x n grid, n = round(sqrt); 1 (default) to 65536.
        back_color: linear RGB where nothing is met; default black.
        exposure: factor of every pixel; default 1.
        integrator: "light_sampling" (default), "bsdf_sampling", "point_light", or "path" for
        light that has been reflected.
        max_depth: of "path": surfaces a path may meet; 1 to 4096; default 12.
        """
        self._put(
            "set",
            "image",
            width=width,
            height=height,
            samples=samples,
            back_color=back_color,
            exposure=exposure,
            integrator=choose(Integrator, "integrator", integrator),
            max_depth=max_depth,
        )

    def set_camera(
        self,
        type: CameraType | str = CameraType.PERSPECTIVE,
        *,
        view_point: Vector | None = None,
        view_direction: Vector | None = None,
        view_up: Vector | None = None,
        projection_normal: Vector | None = None,
        projection_distance: float | None = None,
        view_width: float | None = None,
        view_height: float | None = None,
    ) -> None:
        """Places the camera, "perspective" or "parallel".

        The window of view_width x view_height stands at view_point + projection_distance along
        view_direction; the parallel camera's is centred at view_point. Coordinates are
        right-handed.

        view_point: the eye; default 0 0 0.
        view_direction: of any length; default 0 0 -1.
        view_up: of any length, not parallel to the normal of the window; default 0 1 0.
        projection_normal: of the window, which may be tilted; default opposite to view_direction.
        projection_distance, view_width, view_height: > 0; default 1.
        """
        self._put(
            "set",
            "camera",
            type=choose(CameraType, "camera type", type),
            view_point=view_point,
            view_direction=view_direction,
            view_up=view_up,
            projection_normal=projection_normal,
            projection_distance=projection_distance,
            view_width=view_width,
            view_height=view_height,
        )

    # ------------------------------------------------------------ light

    def add_light(
        self,
        type: LightType | str = LightType.POINT,
        *,
        position: Vector | None = None,
        intensity: Vector | None = None,
        falloff: Falloff | str | None = None,
        direction: Vector | None = None,
        up: Vector | None = None,
        width: float | None = None,
        height: float | None = None,
    ) -> None:
        """Adds a light: "point", "directional", "rectangle", or without shadows "ambient" (adds
        intensity x diffuse colour everywhere), "constant" (the diffuse colour), "normal"
        ((normal + 1) / 2).

        position: of a point, or the centre of a rectangle; default 0 0 0.
        intensity: linear RGB; of a rectangle its radiance; default 1 1 1.
        falloff: of a point: "none", "inverse_square", or "dialect" (default).
        direction: toward a directional light; to the side on which a rectangle shines; of any
        length; default 0 0 -1.
        up: of a rectangle, along its height; of any length; default 0 1 0.
        width, height: of a rectangle; > 0; default 1.
        """
        self._put(
            "add",
            "light",
            type=choose(LightType, "light type", type),
            position=position,
            intensity=intensity,
            falloff=choose(Falloff, "falloff", falloff),
            direction=direction,
            up=up,
            width=width,
            height=height,
        )

    def load_environment(self, path: str | os.PathLike[str], scale: float = 1.0) -> None:
        """Reads a cube map (PFM) as what rays see that hit nothing, in the place of back_color.
        scale is a factor of its values. A second call replaces the first."""
        self._call("glint_scene_load_environment", path_bytes(path), float(scale))

    # ------------------------------------------------------------ shaders and textures

    def add_shader(
        self,
        type: ShaderType | str = ShaderType.LAMBERTIAN,
        *,
        diffuse_color: Vector | None = None,
        specular_color: Vector | None = None,
        exponent: float | None = None,
        mirror_color: Vector | None = None,
        roughness: float | None = None,
        refractive_index: float | None = None,
        substrate: ShaderId | None = None,
        texture: TextureId | None = None,
    ) -> ShaderId:
        """Adds a shader for surfaces to name.

        type: "lambertian", "phong" (Blinn-Phong), "rgb_normals", "glazed" (a clear coat over a
        substrate), "glass", "beckmann" or "ggx" (microfacets over a diffuse base) or
        "cook_torrance".

        diffuse_color: linear RGB; default 1 1 1.
        specular_color: of the highlight (phong, microfacets, cook_torrance); default 1 1 1.
        exponent: phong; default 1.
        mirror_color: of a mirror that is added to lambertian, phong and microfacets; default none.
        roughness: microfacets, cook_torrance; > 0; default 0.5.
        refractive_index: glazed, glass, microfacets, cook_torrance; > 0; default 1.5.
        substrate: the shader under the glaze; at most 8 glazes may lie on each other.
        texture: in the place of diffuse_color.
        """
        return self._add(
            "shader",
            ShaderId,
            type=choose(ShaderType, "shader type", type),
            diffuse_color=diffuse_color,
            specular_color=specular_color,
            exponent=exponent,
            mirror_color=mirror_color,
            roughness=roughness,
            refractive_index=refractive_index,
            substrate=substrate,
            texture=texture,
        )

    def add_texture(self, pixels: Any, *, wrap: Wrap | str = Wrap.REPEAT) -> TextureId:
        """Adds a picture as a texture: height x width x 3 bytes, top row first, 255 is 1, linear;
        an array or lists. Outside of it wrap shows it again ("repeat") or its edge ("clamp")."""
        rgb = take("pixels", pixels, "B", None, 3)
        height, width, _ = rgb.shape
        kind = choose(Wrap, "wrap", wrap)
        fields = {"width": width, "height": height, "rgb": address(rgb), "wrap": kind}
        return self._add("texture", TextureId, **fields)

    def load_texture(
        self, path: str | os.PathLike[str], *, wrap: Wrap | str = Wrap.REPEAT
    ) -> TextureId:
        """Reads a PNG or JPEG picture as a texture. Every call reads anew, so keep the id."""
        id = _abi.GlintTextureId()
        kind = choose(Wrap, "wrap", wrap)
        self._call("glint_scene_load_texture", path_bytes(path), kind, byref(id))
        return TextureId(id.index1)

    # ------------------------------------------------------------ meshes

    def add_mesh(
        self, positions: Any, triangles: Any, *, normals: Any = None, texcoords: Any = None
    ) -> MeshId:
        """Adds triangles; add_mesh_surface() shows them.

        positions: n x 3 single-precision numbers, one row a vertex.
        triangles: m x 3 indices of vertices, from 0; at least one row. Seen from where they run
        counterclockwise is the side of the normal.
        normals: n x 3, of any length, blended over each triangle; default: the triangle's own.
        texcoords: n x 2: u to the right, v up, in the texture.
        """
        vertices = take("positions", positions, "f", 3)
        corners = take("triangles", triangles, "I", 3)
        extra = {
            name: take(name, values, "f", columns)
            for name, values, columns in (("normals", normals, 3), ("texcoords", texcoords, 2))
            if values is not None
        }
        for name, values in extra.items():
            if len(values) != len(vertices):
                raise ValueError(f"{name} must have a row for each of the {len(vertices)} vertices")
        return self._add(
            "mesh",
            MeshId,
            positions=address(vertices),
            vertex_count=len(vertices),
            triangles=address(corners),
            triangle_count=len(corners),
            **{name: address(values) for name, values in extra.items()},
        )

    def load_mesh(self, path: str | os.PathLike[str]) -> MeshId:
        """Reads a mesh (.obj, .msh or .ply). Every call reads anew, so keep the id."""
        id = _abi.GlintMeshId()
        self._call("glint_scene_load_mesh", path_bytes(path), byref(id))
        return MeshId(id.index1)

    def add_mesh_surface(
        self, mesh: MeshId, *, shader: ShaderId | None = None, parent: GroupId | None = None
    ) -> SurfaceId:
        """Shows a mesh; all its triangles are one surface."""
        return self._surface(SurfaceType.MESH, mesh=mesh, shader=shader, parent=parent)

    # ------------------------------------------------------------ surfaces

    def add_sphere(
        self,
        center: Vector = (0, 0, 0),
        radius: float = 1.0,
        *,
        shader: ShaderId | None = None,
        parent: GroupId | None = None,
    ) -> SurfaceId:
        """Adds a sphere. radius: > 0. parent, here and below: the group it belongs to."""
        return self._surface(
            SurfaceType.SPHERE, center=center, radius=radius, shader=shader, parent=parent
        )

    def add_box(
        self,
        point_a: Vector,
        point_b: Vector,
        *,
        shader: ShaderId | None = None,
        parent: GroupId | None = None,
    ) -> SurfaceId:
        """Adds a box along the axes between two opposite corners."""
        return self._surface(
            SurfaceType.BOX, point_a=point_a, point_b=point_b, shader=shader, parent=parent
        )

    def add_cylinder(
        self,
        center: Vector = (0, 0, 0),
        radius: float = 1.0,
        height: float = 1.0,
        *,
        shader: ShaderId | None = None,
        parent: GroupId | None = None,
    ) -> SurfaceId:
        """Adds a closed cylinder along z. radius, height: > 0."""
        return self._surface(
            SurfaceType.CYLINDER,
            center=center,
            radius=radius,
            height=height,
            shader=shader,
            parent=parent,
        )

    def add_cone(
        self,
        center: Vector,
        radius: float,
        height: float,
        tip_z: float,
        *,
        shader: ShaderId | None = None,
        parent: GroupId | None = None,
    ) -> SurfaceId:
        """Adds a closed cone along z, of this height round its centre; double where the tip lies
        between its ends. radius: in the plane of the centre; > 0. height: > 0. tip_z: z of the
        apex; not that of the centre."""
        return self._surface(
            SurfaceType.CONE,
            center=center,
            radius=radius,
            height=height,
            tip_z=tip_z,
            shader=shader,
            parent=parent,
        )

    def add_plane(
        self,
        point: Vector = (0, 0, 0),
        normal: Vector = (0, 0, 1),
        *,
        shader: ShaderId | None = None,
        parent: GroupId | None = None,
    ) -> SurfaceId:
        """Adds an infinite plane. normal: of any length but zero."""
        return self._surface(
            SurfaceType.PLANE, point_a=point, normal=normal, shader=shader, parent=parent
        )

    def add_disc(
        self,
        center: Vector = (0, 0, 0),
        normal: Vector = (0, 0, 1),
        radius: float = 1.0,
        *,
        shader: ShaderId | None = None,
        parent: GroupId | None = None,
    ) -> SurfaceId:
        """Adds a disc. normal: of any length but zero. radius: > 0."""
        return self._surface(
            SurfaceType.DISC,
            center=center,
            normal=normal,
            radius=radius,
            shader=shader,
            parent=parent,
        )

    def add_group(
        self,
        transform: Sequence[Vector] | None = None,
        *,
        parent: GroupId | None = None,
        source: GroupId | None = None,
    ) -> GroupId:
        """Adds a group, for other surfaces to name as their parent.

        transform: three rows of four numbers, an invertible affine matrix; default: none.
        source: a group that is drawn here once more, with all it contains now or later, under
        this one's transform; it must not contain the parent.
        """
        kind = SurfaceType.GROUP
        fields = {"transform": transform, "parent": parent, "source": source}
        return self._add("surface", GroupId, kind, **fields)

    # ------------------------------------------------------------ calls

    def _put(self, verb: str, what: str, **values: Any) -> None:
        struct = desc(self._library, what, **values)
        self._call(f"glint_scene_{verb}_{what}", byref(struct))

    def _add(self, what: str, kind: type[Id], *arguments: int, **values: Any) -> Id:
        struct = desc(self._library, what, *arguments, **values)
        id = getattr(_abi, f"Glint{what.capitalize()}Id")()
        self._call(f"glint_scene_add_{what}", byref(struct), byref(id))
        return kind(id.index1)

    def _surface(self, type: SurfaceType, **values: Any) -> SurfaceId:
        return self._add("surface", SurfaceId, type, **values)
