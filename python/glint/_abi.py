# SPDX-License-Identifier: MIT
"""The types and functions of glint.h as ctypes sees them. Made by python/make_abi.py from the
header: do not change it by hand."""

from __future__ import annotations

from ctypes import (
    CFUNCTYPE,
    POINTER,
    Structure,
    c_bool,
    c_char,
    c_char_p,
    c_double,
    c_int,
    c_int64,
    c_size_t,
    c_uint32,
    c_uint64,
    c_void_p,
)
from enum import IntEnum
from typing import Any

VERSION = "0.1.0"


class Status(IntEnum):
    """GlintStatus of glint.h."""

    OK = 0
    ERROR_ARGUMENT = 1
    ERROR_SCENE = 2
    ERROR_FILE = 3
    ERROR_MEMORY = 4
    ERROR_THREAD = 5
    CANCELLED = 6


class GlintError(Structure):
    _fields_ = [
        ("status", c_int),
        ("line", c_int),
        ("column", c_int),
        ("path", c_char * 256),
        ("message", c_char * 256),
    ]


class Severity(IntEnum):
    """GlintSeverity of glint.h."""

    ERROR = 0
    WARNING = 1


class GlintDiagnostic(Structure):
    _fields_ = [
        ("severity", c_int),
        ("path", c_char_p),
        ("line", c_int64),
        ("column", c_int64),
        ("message", c_char_p),
        ("excerpt", c_char_p),
        ("caret", c_int),
        ("caret_length", c_int),
    ]


GlintDiagnosticFn = CFUNCTYPE(None, c_void_p, POINTER(GlintDiagnostic))


class GlintAllocator(Structure):
    _fields_ = [
        ("reallocate", CFUNCTYPE(c_void_p, c_void_p, c_void_p, c_size_t, c_size_t)),
        ("user", c_void_p),
    ]


class Phase(IntEnum):
    """GlintPhase of glint.h."""

    READ = 0
    BUILD = 1
    TRACE = 2
    WRITE = 3


class GlintMonitor(Structure):
    _fields_ = [
        ("progress", CFUNCTYPE(None, c_void_p, c_int, c_double)),
        ("cancelled", CFUNCTYPE(c_bool, c_void_p)),
        ("user", c_void_p),
    ]


class Dialect(IntEnum):
    """GlintDialect of glint.h."""

    AUTO = 0
    Y2011 = 1
    Y2012 = 2
    MATERIAL = 3
    Y2013 = 4
    Y2017 = 5
    Y2017B = 6
    Y2018 = 7
    Y2018B = 8
    Y2019 = 9
    GLINT = 10
    COUNT = 11


class GlintShaderId(Structure):
    _fields_ = [
        ("index1", c_uint32),
    ]


class GlintSurfaceId(Structure):
    _fields_ = [
        ("index1", c_uint32),
    ]


class GlintMeshId(Structure):
    _fields_ = [
        ("index1", c_uint32),
    ]


class GlintTextureId(Structure):
    _fields_ = [
        ("index1", c_uint32),
    ]


class GlintSceneDesc(Structure):
    _fields_ = [
        ("dialect", c_int),
        ("thread_count", c_int),
        ("isa", c_char_p),
        ("memory_limit", c_size_t),
        ("allocator", POINTER(GlintAllocator)),
        ("diagnostic", GlintDiagnosticFn),
        ("diagnostic_user", c_void_p),
        ("cookie", c_int),
    ]


GlintReadFn = CFUNCTYPE(c_int64, c_void_p, c_void_p, c_size_t)


class Integrator(IntEnum):
    """GlintIntegrator of glint.h."""

    LIGHT_SAMPLING = 0
    BSDF_SAMPLING = 1
    POINT_LIGHT = 2
    PATH = 3


class GlintImageDesc(Structure):
    _fields_ = [
        ("width", c_int),
        ("height", c_int),
        ("samples", c_int),
        ("back_color", c_double * 3),
        ("exposure", c_double),
        ("integrator", c_int),
        ("max_depth", c_int),
        ("cookie", c_int),
    ]


class CameraType(IntEnum):
    """GlintCameraType of glint.h."""

    PERSPECTIVE = 0
    PARALLEL = 1


class GlintCameraDesc(Structure):
    _fields_ = [
        ("type", c_int),
        ("view_point", c_double * 3),
        ("view_direction", c_double * 3),
        ("view_up", c_double * 3),
        ("projection_normal", c_double * 3),
        ("projection_distance", c_double),
        ("view_width", c_double),
        ("view_height", c_double),
        ("cookie", c_int),
    ]


class ShaderType(IntEnum):
    """GlintShaderType of glint.h."""

    LAMBERTIAN = 0
    PHONG = 1
    RGB_NORMALS = 2
    GLAZED = 3
    GLASS = 4
    BECKMANN = 5
    GGX = 6
    COOK_TORRANCE = 7


class GlintShaderDesc(Structure):
    _fields_ = [
        ("type", c_int),
        ("diffuse_color", c_double * 3),
        ("specular_color", c_double * 3),
        ("exponent", c_double),
        ("mirror_color", c_double * 3),
        ("roughness", c_double),
        ("refractive_index", c_double),
        ("substrate", GlintShaderId),
        ("texture", GlintTextureId),
        ("cookie", c_int),
    ]


class Wrap(IntEnum):
    """GlintWrap of glint.h."""

    REPEAT = 0
    CLAMP = 1


class GlintTextureDesc(Structure):
    _fields_ = [
        ("width", c_int),
        ("height", c_int),
        ("rgb", c_void_p),
        ("wrap", c_int),
        ("cookie", c_int),
    ]


class LightType(IntEnum):
    """GlintLightType of glint.h."""

    POINT = 0
    AMBIENT = 1
    CONSTANT = 2
    NORMAL = 3
    DIRECTIONAL = 4
    RECTANGLE = 5


class Falloff(IntEnum):
    """GlintFalloff of glint.h."""

    DIALECT = 0
    NONE = 1
    INVERSE_SQUARE = 2


class GlintLightDesc(Structure):
    _fields_ = [
        ("type", c_int),
        ("position", c_double * 3),
        ("intensity", c_double * 3),
        ("falloff", c_int),
        ("direction", c_double * 3),
        ("up", c_double * 3),
        ("width", c_double),
        ("height", c_double),
        ("cookie", c_int),
    ]


class GlintMeshDesc(Structure):
    _fields_ = [
        ("positions", c_void_p),
        ("vertex_count", c_size_t),
        ("normals", c_void_p),
        ("texcoords", c_void_p),
        ("triangles", c_void_p),
        ("triangle_count", c_size_t),
        ("cookie", c_int),
    ]


class SurfaceType(IntEnum):
    """GlintSurfaceType of glint.h."""

    SPHERE = 0
    BOX = 1
    CYLINDER = 2
    CONE = 3
    PLANE = 4
    DISC = 5
    GROUP = 6
    MESH = 7


class GlintSurfaceDesc(Structure):
    _fields_ = [
        ("type", c_int),
        ("shader", GlintShaderId),
        ("parent", GlintSurfaceId),
        ("center", c_double * 3),
        ("radius", c_double),
        ("height", c_double),
        ("tip_z", c_double),
        ("point_a", c_double * 3),
        ("point_b", c_double * 3),
        ("normal", c_double * 3),
        ("transform", c_double * 4 * 3),
        ("mesh", GlintMeshId),
        ("source", GlintSurfaceId),
        ("cookie", c_int),
    ]


class GlintSceneInfo(Structure):
    _fields_ = [
        ("dialect", c_int),
        ("width", c_int),
        ("height", c_int),
        ("samples", c_int),
        ("surface_count", c_uint64),
        ("light_count", c_uint32),
        ("shader_count", c_uint32),
    ]


class Sampling(IntEnum):
    """GlintSampling of glint.h."""

    SOBOL = 0
    RANDOM = 1


class GlintRenderDesc(Structure):
    _fields_ = [
        ("width", c_int),
        ("height", c_int),
        ("crop_x", c_int),
        ("crop_y", c_int),
        ("crop_width", c_int),
        ("crop_height", c_int),
        ("samples", c_int),
        ("light", c_int),
        ("depth", c_void_p),
        ("normal", c_void_p),
        ("albedo", c_void_p),
        ("surface", c_void_p),
        ("sampling", c_int),
        ("monitor", POINTER(GlintMonitor)),
        ("cookie", c_int),
    ]


class GlintRay(Structure):
    _fields_ = [
        ("origin", c_double * 3),
        ("direction", c_double * 3),
        ("t_min", c_double),
        ("t_max", c_double),
    ]


class GlintHit(Structure):
    _fields_ = [
        ("t", c_double),
        ("point", c_double * 3),
        ("normal", c_double * 3),
        ("surface", GlintSurfaceId),
        ("shader", GlintShaderId),
    ]


class GlintStats(Structure):
    _fields_ = [
        ("read_seconds", c_double),
        ("build_seconds", c_double),
        ("trace_seconds", c_double),
        ("read_bytes", c_uint64),
        ("camera_rays", c_uint64),
        ("shadow_rays", c_uint64),
        ("other_rays", c_uint64),
        ("primitive_count", c_uint64),
        ("node_count", c_uint64),
        ("leaf_count", c_uint64),
        ("tree_bytes", c_uint64),
        ("sah_cost", c_double),
        ("memory_peak", c_uint64),
        ("thread_count", c_int),
        ("isa", c_char_p),
    ]


class GlintImage(Structure):
    _fields_ = [
        ("width", c_int),
        ("height", c_int),
        ("pixels", c_void_p),
    ]


class GlintLayer(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("components", c_char_p),
        ("pixels", c_void_p),
    ]


class GlintSaveDesc(Structure):
    _fields_ = [
        ("title", c_char_p),
        ("thread_count", c_int),
        ("monitor", POINTER(GlintMonitor)),
        ("layers", POINTER(GlintLayer)),
        ("layer_count", c_int),
        ("cookie", c_int),
    ]


GlintSinkFn = CFUNCTYPE(c_bool, c_void_p, c_void_p, c_size_t)


# name: what it returns, what it takes
FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "glint_status_text": (c_char_p, [c_int]),
    "glint_diagnostic_format": (c_size_t, [POINTER(GlintDiagnostic), c_char_p, c_size_t]),
    "glint_dialect_name": (c_char_p, [c_int]),
    "glint_dialect_from_name": (c_bool, [c_char_p, c_void_p]),
    "glint_isa_name": (c_char_p, [c_int]),
    "glint_version_text": (c_char_p, []),
    "glint_scene_desc_default": (GlintSceneDesc, []),
    "glint_scene_create": (c_int, [POINTER(GlintSceneDesc), POINTER(c_void_p),
        POINTER(GlintError)]),
    "glint_scene_destroy": (None, [c_void_p]),
    "glint_scene_load_file": (c_int, [c_void_p, c_char_p, POINTER(GlintMonitor),
        POINTER(GlintError)]),
    "glint_scene_load_memory": (c_int, [c_void_p, c_void_p, c_size_t, c_char_p,
        POINTER(GlintMonitor), POINTER(GlintError)]),
    "glint_scene_load_stream": (c_int, [c_void_p, GlintReadFn, c_void_p, c_char_p,
        POINTER(GlintMonitor), POINTER(GlintError)]),
    "glint_image_desc_default": (GlintImageDesc, []),
    "glint_camera_desc_default": (GlintCameraDesc, []),
    "glint_shader_desc_default": (GlintShaderDesc, []),
    "glint_texture_desc_default": (GlintTextureDesc, []),
    "glint_mesh_desc_default": (GlintMeshDesc, []),
    "glint_light_desc_default": (GlintLightDesc, []),
    "glint_surface_desc_default": (GlintSurfaceDesc, [c_int]),
    "glint_scene_set_image": (c_int, [c_void_p, POINTER(GlintImageDesc), POINTER(GlintError)]),
    "glint_scene_set_camera": (c_int, [c_void_p, POINTER(GlintCameraDesc), POINTER(GlintError)]),
    "glint_scene_add_light": (c_int, [c_void_p, POINTER(GlintLightDesc), POINTER(GlintError)]),
    "glint_scene_add_shader": (c_int, [c_void_p, POINTER(GlintShaderDesc), POINTER(GlintShaderId),
        POINTER(GlintError)]),
    "glint_scene_add_texture": (c_int, [c_void_p, POINTER(GlintTextureDesc),
        POINTER(GlintTextureId), POINTER(GlintError)]),
    "glint_scene_add_mesh": (c_int, [c_void_p, POINTER(GlintMeshDesc), POINTER(GlintMeshId),
        POINTER(GlintError)]),
    "glint_scene_add_surface": (c_int, [c_void_p, POINTER(GlintSurfaceDesc),
        POINTER(GlintSurfaceId), POINTER(GlintError)]),
    "glint_scene_load_texture": (c_int, [c_void_p, c_char_p, c_int, POINTER(GlintTextureId),
        POINTER(GlintError)]),
    "glint_scene_load_mesh": (c_int, [c_void_p, c_char_p, POINTER(GlintMeshId),
        POINTER(GlintError)]),
    "glint_scene_load_environment": (c_int, [c_void_p, c_char_p, c_double, POINTER(GlintError)]),
    "glint_scene_commit": (c_int, [c_void_p, POINTER(GlintMonitor), POINTER(GlintError)]),
    "glint_scene_info": (None, [c_void_p, POINTER(GlintSceneInfo)]),
    "glint_render_desc_default": (GlintRenderDesc, []),
    "glint_render": (c_int, [c_void_p, POINTER(GlintRenderDesc), c_void_p, POINTER(GlintError)]),
    "glint_trace": (c_bool, [c_void_p, POINTER(GlintRay), POINTER(GlintHit)]),
    "glint_occluded": (c_bool, [c_void_p, POINTER(GlintRay)]),
    "glint_scene_stats": (None, [c_void_p, POINTER(GlintStats)]),
    "glint_save_desc_default": (GlintSaveDesc, []),
    "glint_image_save": (c_int, [POINTER(GlintImage), c_char_p, POINTER(GlintSaveDesc),
        POINTER(GlintError)]),
    "glint_render_save": (c_int, [c_void_p, POINTER(GlintRenderDesc), c_char_p,
        POINTER(GlintSaveDesc), POINTER(GlintError)]),
    "glint_image_check_path": (c_int, [c_char_p, POINTER(GlintError)]),
    "glint_image_encode_png": (c_int, [POINTER(GlintImage), POINTER(GlintSaveDesc), GlintSinkFn,
        c_void_p, POINTER(GlintError)]),
    "glint_image_to_rgb8": (None, [POINTER(GlintImage), c_void_p]),
}
