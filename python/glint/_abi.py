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
    c_float,
    c_int,
    c_int64,
    c_size_t,
    c_uint32,
    c_uint64,
    c_uint8,
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
    _enums_ = {"status": Status}


class Severity(IntEnum):
    """GlintSeverity of glint.h."""

    ERROR = 0
    WARNING = 1
    NOTE = 2


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
        ("rule", c_char_p),
        ("hint", c_char_p),
    ]
    _enums_ = {"severity": Severity}


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
        ("keep_sources", c_bool),
        ("reverse_transforms", c_bool),
        ("cookie", c_int),
    ]
    _enums_ = {"dialect": Dialect}


GlintReadFn = CFUNCTYPE(c_int64, c_void_p, c_void_p, c_size_t)


class ObjectKind(IntEnum):
    """GlintObjectKind of glint.h."""

    SURFACE = 0
    LIGHT = 1
    SHADER = 2
    CAMERA = 3
    KIND_COUNT = 4


class GlintSource(Structure):
    _fields_ = [
        ("path", c_char_p),
        ("name", c_char_p),
        ("line", c_int64),
        ("column", c_int64),
    ]


class FileKind(IntEnum):
    """GlintFileKind of glint.h."""

    SCENE = 0
    MESH = 1
    TEXTURE = 2
    ENVIRONMENT = 3


class GlintSceneFile(Structure):
    _fields_ = [
        ("kind", c_int),
        ("name", c_char_p),
        ("path", c_char_p),
        ("size", c_uint64),
        ("digest", c_uint64),
    ]
    _enums_ = {"kind": FileKind}


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
    _enums_ = {"integrator": Integrator}


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
    _enums_ = {"type": CameraType}


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
    _enums_ = {"type": ShaderType}


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
    _enums_ = {"wrap": Wrap}


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
    _enums_ = {"type": LightType, "falloff": Falloff}


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
    _enums_ = {"type": SurfaceType}


class Mistake(IntEnum):
    """GlintMistake of glint.h."""

    SHIFTED = 0
    PIXEL_SPAN = 1
    WINDOW_SWAPPED = 2
    WINDOW_SQUARE = 3
    WINDOW_PIXELS = 4
    VIEW_LENGTH = 5
    UP_LENGTH = 6
    UP_SKEWED = 7
    WINDOW_TILT = 8
    WINDOW_DISTANCE = 9
    FIRST_HIT = 10
    LAST_HIT = 11
    TRANSFORMS_REVERSED = 12
    NORMALS_MATRIX = 13
    NORMALS_LENGTH = 14
    NORMALS_INWARD = 15
    NORMALS_FACING = 16
    NORMALS_FLAT = 17
    NO_SHADOWS = 18
    SHADOW_ACNE = 19
    SHADOW_BEYOND = 20
    SHADOW_REVERSED = 21
    LIGHT_MISSING = 22
    LAST_LIGHT = 23
    NO_AMBIENT = 24
    NO_FALLOFF = 25
    FALLOFF = 26
    FALLOFF_LINEAR = 27
    DIFFUSE_PI = 28
    DIFFUSE_BEHIND = 29
    NO_SPECULAR = 30
    SPECULAR_BEHIND = 31
    SPECULAR_COSINE = 32
    REFLECTED_HIGHLIGHT = 33
    NO_RECURSION = 34
    TEXTURE_FLIPPED = 35
    NO_BACKGROUND = 36
    NO_EXPOSURE = 37
    ONE_SAMPLE = 38
    FLIPPED = 39
    MIRRORED = 40
    TRANSPOSED = 41
    BGR = 42
    BRIGHTNESS = 43
    GAMMA_MISSING = 44
    GAMMA_TWICE = 45
    SRGB = 46
    TRUNCATED = 47
    WRAPPED = 48
    COUNT = 49


class GlintMistakes(Structure):
    _fields_ = [
        ("set", c_uint64),
        ("light", c_int),
        ("shift_x", c_int),
        ("shift_y", c_int),
        ("factor", c_double),
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
    _enums_ = {"dialect": Dialect}


class Sampling(IntEnum):
    """GlintSampling of glint.h."""

    SOBOL = 0
    RANDOM = 1


class Show(IntEnum):
    """GlintShow of glint.h."""

    PICTURE = 0
    NORMAL = 1
    DEPTH = 2
    UV = 3
    ID = 4
    COST = 5
    SHADOW = 6
    COUNT = 7


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
        ("camera", POINTER(GlintCameraDesc)),
        ("show", c_int),
        ("shown_range", c_void_p),
        ("mistakes", GlintMistakes),
        ("cookie", c_int),
    ]
    _enums_ = {"sampling": Sampling, "show": Show}


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


class RayKind(IntEnum):
    """GlintRayKind of glint.h."""

    CAMERA = 0
    MIRRORED = 1
    REFRACTED = 2
    SCATTERED = 3
    PROBE = 4


class RayEnd(IntEnum):
    """GlintRayEnd of glint.h."""

    NOTHING = 0
    SURFACE = 1
    LIGHT = 2


class GlintExplainRay(Structure):
    _fields_ = [
        ("kind", c_int),
        ("end", c_int),
        ("parent", c_uint32),
        ("level", c_uint32),
        ("origin", c_double * 3),
        ("direction", c_double * 3),
        ("t_min", c_double),
        ("factor", c_double * 3),
        ("weight", c_double),
        ("density", c_double),
        ("inside", c_bool),
        ("t", c_double),
        ("point", c_double * 3),
        ("normal", c_double * 3),
        ("geometric_normal", c_double * 3),
        ("n_dot_v", c_double),
        ("surface", GlintSurfaceId),
        ("surface_type", c_int),
        ("triangle", c_uint32),
        ("light", c_uint32),
        ("shader", GlintShaderId),
        ("lit", c_bool),
        ("local_shader", GlintShaderId),
        ("local_factor", c_double * 3),
        ("diffuse_color", c_double * 3),
    ]
    _enums_ = {"kind": RayKind, "end": RayEnd, "surface_type": SurfaceType}


class BranchFate(IntEnum):
    """GlintBranchFate of glint.h."""

    FOLLOWED = 0
    NOTHING = 1
    TOO_LIGHT = 2
    TOO_DEEP = 3
    NOT_CHOSEN = 4
    ENDED = 5
    NO_TREE = 6


class GlintExplainBranch(Structure):
    _fields_ = [
        ("kind", c_int),
        ("fate", c_int),
        ("ray", c_uint32),
        ("layer", c_uint32),
        ("child", c_uint32),
        ("factor", c_double * 3),
        ("weight", c_double),
        ("chance", c_double),
        ("survival", c_double),
    ]
    _enums_ = {"kind": RayKind, "fate": BranchFate}


class GlintExplainLayer(Structure):
    _fields_ = [
        ("ray", c_uint32),
        ("shader", GlintShaderId),
        ("inside", c_bool),
        ("behind", c_bool),
        ("total", c_bool),
        ("cosine", c_double),
        ("cosine_behind", c_double),
        ("ratio", c_double),
        ("reflectance", c_double),
    ]


class LightFate(IntEnum):
    """GlintLightFate of glint.h."""

    ARRIVES = 0
    BLOCKED = 1
    EVERYWHERE = 2
    BEHIND = 3
    UNSEEN_SIDE = 4
    OFF = 5
    TURNED_AWAY = 6
    ON_SURFACE = 7
    ABSORBED = 8


class GlintExplainLight(Structure):
    _fields_ = [
        ("fate", c_int),
        ("ray", c_uint32),
        ("light", c_uint32),
        ("direction", c_double * 3),
        ("distance", c_double),
        ("n_dot_l", c_double),
        ("n_dot_h", c_double),
        ("falloff", c_double),
        ("strength", c_double * 3),
        ("diffuse", c_double * 3),
        ("highlight", c_double * 3),
        ("reflected", c_double * 3),
        ("fresnel", c_double),
        ("distribution", c_double),
        ("masking", c_double),
        ("density", c_double),
        ("share", c_double),
        ("term", c_double * 3),
        ("shadow_begin", c_double),
        ("shadow_end", c_double),
        ("blocker", GlintSurfaceId),
        ("blocker_type", c_int),
        ("blocker_triangle", c_uint32),
        ("blocker_light", c_uint32),
        ("blocker_distance", c_double),
        ("blocker_point", c_double * 3),
        ("addition", c_uint32),
    ]
    _enums_ = {"fate": LightFate, "blocker_type": SurfaceType}


class GlintExplainAddition(Structure):
    _fields_ = [
        ("ray", c_uint32),
        ("light", c_uint32),
        ("amount", c_double * 3),
        ("sum", c_double * 3),
    ]


class GlintExplainSample(Structure):
    _fields_ = [
        ("x", c_int),
        ("y", c_int),
        ("sample", c_int),
        ("samples", c_int),
        ("film_x", c_double),
        ("film_y", c_double),
        ("rays", POINTER(GlintExplainRay)),
        ("layers", POINTER(GlintExplainLayer)),
        ("branches", POINTER(GlintExplainBranch)),
        ("lights", POINTER(GlintExplainLight)),
        ("additions", POINTER(GlintExplainAddition)),
        ("ray_count", c_size_t),
        ("layer_count", c_size_t),
        ("branch_count", c_size_t),
        ("light_count", c_size_t),
        ("addition_count", c_size_t),
        ("color", c_double * 3),
        ("sum", c_double * 3),
    ]


class GlintExplainPixel(Structure):
    _fields_ = [
        ("x", c_int),
        ("y", c_int),
        ("samples", c_int),
        ("sum", c_double * 3),
        ("exposure", c_double),
        ("color", c_float * 3),
        ("rgb", c_uint8 * 3),
    ]


class GlintExplainSink(Structure):
    _fields_ = [
        ("sample", CFUNCTYPE(None, c_void_p, POINTER(GlintExplainSample))),
        ("pixel", CFUNCTYPE(None, c_void_p, POINTER(GlintExplainPixel))),
        ("user", c_void_p),
        ("only_sample", c_int),
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


class GlintRule(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("severity", c_int),
        ("summary", c_char_p),
        ("help", c_char_p),
    ]
    _enums_ = {"severity": Severity}


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


class GlintRecipeFile(Structure):
    _fields_ = [
        ("kind", c_int),
        ("name", c_char_p),
        ("size", c_uint64),
        ("digest", c_uint64),
        ("bytes", c_void_p),
    ]
    _enums_ = {"kind": FileKind}


class GlintRecipe(Structure):
    _fields_ = [
        ("version", c_char * 32),
        ("dialect", c_int),
        ("width", c_int),
        ("height", c_int),
        ("crop_x", c_int),
        ("crop_y", c_int),
        ("crop_width", c_int),
        ("crop_height", c_int),
        ("samples", c_int),
        ("light", c_int),
        ("sampling", c_int),
        ("mistakes", GlintMistakes),
        ("has_pixels", c_bool),
        ("pixels", c_uint64),
        ("files", POINTER(GlintRecipeFile)),
        ("file_count", c_int),
    ]
    _enums_ = {"dialect": Dialect, "sampling": Sampling}


class GlintSaveDesc(Structure):
    _fields_ = [
        ("title", c_char_p),
        ("thread_count", c_int),
        ("monitor", POINTER(GlintMonitor)),
        ("layers", POINTER(GlintLayer)),
        ("layer_count", c_int),
        ("recipe", POINTER(GlintRecipe)),
        ("cookie", c_int),
    ]


GlintSinkFn = CFUNCTYPE(c_bool, c_void_p, c_void_p, c_size_t)


class ElementKind(IntEnum):
    """GlintElementKind of glint.h."""

    NUMBER = 0
    WHOLE_NUMBER = 1
    IMAGE_SIZE = 2
    VECTOR = 3
    POINT = 4
    COLOR = 5
    WORD = 6
    TEXT = 7
    SCENE = 8
    CAMERA = 9
    SURFACE = 10
    SHADER = 11
    BSDF = 12
    BRDF = 13
    TEXTURE = 14
    LIGHT = 15
    ENVIRONMENT = 16
    INTEGRATOR = 17


class ElementRange(IntEnum):
    """GlintElementRange of glint.h."""

    ANY = 0
    POSITIVE = 1
    SAMPLES = 2
    NOT_ZERO = 3
    NO_ZEROS = 4
    ANGLE = 5
    BIT = 6
    DEPTH = 7
    PIXELS = 8


class GlintElement(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("kind", c_int),
        ("range", c_int),
        ("required", c_bool),
        ("default_text", c_char_p),
        ("example", c_char_p),
        ("choices", c_char_p),
        ("alias_of", c_char_p),
        ("default_type", c_char_p),
        ("years", c_char_p),
        ("help", c_char_p),
    ]
    _enums_ = {"kind": ElementKind, "range": ElementRange}


class GlintElementType(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("kind", c_int),
        ("alias_of", c_char_p),
        ("years", c_char_p),
        ("help", c_char_p),
    ]
    _enums_ = {"kind": ElementKind}


class GlintFormatDesc(Structure):
    _fields_ = [
        ("allocator", POINTER(GlintAllocator)),
        ("diagnostic", GlintDiagnosticFn),
        ("diagnostic_user", c_void_p),
        ("cookie", c_int),
    ]


class ChangeKind(IntEnum):
    """GlintChangeKind of glint.h."""

    SAME = 0
    ROUNDING = 1
    DIFFERENT = 2


class GlintChange(Structure):
    _fields_ = [
        ("kind", c_int),
        ("line", c_int64),
        ("column", c_int64),
        ("message", c_char_p),
    ]
    _enums_ = {"kind": ChangeKind}


GlintChangeFn = CFUNCTYPE(None, c_void_p, POINTER(GlintChange))


class GlintUpgradeDesc(Structure):
    _fields_ = [
        ("dialect", c_int),
        ("change", GlintChangeFn),
        ("change_user", c_void_p),
        ("allocator", POINTER(GlintAllocator)),
        ("diagnostic", GlintDiagnosticFn),
        ("diagnostic_user", c_void_p),
        ("cookie", c_int),
    ]
    _enums_ = {"dialect": Dialect}


class GlintCompareDesc(Structure):
    _fields_ = [
        ("tolerance", c_int),
        ("pixels_per_degree", c_double),
        ("flip", c_bool),
        ("flip_map", c_void_p),
        ("difference", c_void_p),
        ("cookie", c_int),
    ]


class GlintComparison(Structure):
    _fields_ = [
        ("max", c_int),
        ("mean", c_double),
        ("percent", c_double),
        ("relative", c_double),
        ("flip", c_double),
    ]


class GlintHypothesis(Structure):
    _fields_ = [
        ("mistakes", GlintMistakes),
        ("explains", c_double),
    ]


class Verdict(IntEnum):
    """GlintVerdict of glint.h."""

    SAME = 0
    ROUNDING = 1
    EXPLAINED = 2
    UNCLEAR = 3


HYPOTHESIS_LIMIT = 8


class GlintGrade(Structure):
    _fields_ = [
        ("verdict", c_int),
        ("comparison", GlintComparison),
        ("hypotheses", GlintHypothesis * 8),
        ("hypothesis_count", c_int),
        ("rivals", c_int),
        ("tried", c_int),
        ("pairs_tried", c_int),
        ("from_scene", c_bool),
        ("size_differs", c_bool),
        ("width", c_int),
        ("height", c_int),
        ("reference", GlintImage),
    ]
    _enums_ = {"verdict": Verdict}


class GlintGradeDesc(Structure):
    _fields_ = [
        ("scene", GlintSceneDesc),
        ("compare", GlintCompareDesc),
        ("width", c_int),
        ("height", c_int),
        ("samples", c_int),
        ("pairs", c_bool),
        ("monitor", POINTER(GlintMonitor)),
        ("cookie", c_int),
    ]


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
    "glint_scene_source": (c_bool, [c_void_p, c_int, c_uint32, POINTER(GlintSource)]),
    "glint_scene_file": (c_bool, [c_void_p, c_int, POINTER(GlintSceneFile)]),
    "glint_scene_missing_file": (c_char_p, [c_void_p, c_size_t]),
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
    "glint_mistake_name": (c_char_p, [c_int]),
    "glint_mistake_text": (c_char_p, [c_int]),
    "glint_mistake_from_name": (c_bool, [c_char_p, c_void_p]),
    "glint_mistakes_format": (c_size_t, [POINTER(GlintMistakes), c_char_p, c_size_t]),
    "glint_mistakes_parse": (c_bool, [c_char_p, POINTER(GlintMistakes), POINTER(c_char_p)]),
    "glint_scene_commit": (c_int, [c_void_p, POINTER(GlintMonitor), POINTER(GlintError)]),
    "glint_scene_info": (None, [c_void_p, POINTER(GlintSceneInfo)]),
    "glint_scene_camera": (c_bool, [c_void_p, POINTER(GlintCameraDesc)]),
    "glint_render_desc_default": (GlintRenderDesc, []),
    "glint_render": (c_int, [c_void_p, POINTER(GlintRenderDesc), c_void_p, POINTER(GlintError)]),
    "glint_camera_ray": (c_int, [POINTER(GlintCameraDesc), c_double, c_double, POINTER(GlintRay),
        POINTER(GlintError)]),
    "glint_trace": (c_bool, [c_void_p, POINTER(GlintRay), POINTER(GlintHit)]),
    "glint_occluded": (c_bool, [c_void_p, POINTER(GlintRay)]),
    "glint_explain": (c_int, [c_void_p, POINTER(GlintRenderDesc), POINTER(GlintExplainSink),
        POINTER(GlintError)]),
    "glint_scene_shader": (c_bool, [c_void_p, GlintShaderId, POINTER(GlintShaderDesc)]),
    "glint_scene_light": (c_bool, [c_void_p, c_uint32, POINTER(GlintLightDesc)]),
    "glint_scene_background": (c_bool, [c_void_p, c_void_p]),
    "glint_scene_stats": (None, [c_void_p, POINTER(GlintStats)]),
    "glint_rule_at": (c_bool, [c_int, POINTER(GlintRule)]),
    "glint_scene_check": (c_int, [c_void_p, POINTER(GlintMonitor), POINTER(GlintError)]),
    "glint_save_desc_default": (GlintSaveDesc, []),
    "glint_image_save": (c_int, [POINTER(GlintImage), c_char_p, POINTER(GlintSaveDesc),
        POINTER(GlintError)]),
    "glint_render_save": (c_int, [c_void_p, POINTER(GlintRenderDesc), c_char_p,
        POINTER(GlintSaveDesc), POINTER(GlintError)]),
    "glint_image_check_path": (c_int, [c_char_p, POINTER(GlintError)]),
    "glint_image_encode_png": (c_int, [POINTER(GlintImage), POINTER(GlintSaveDesc), GlintSinkFn,
        c_void_p, POINTER(GlintError)]),
    "glint_scene_recipe": (c_int, [c_void_p, POINTER(GlintRenderDesc), c_bool,
        POINTER(POINTER(GlintRecipe)), POINTER(GlintError)]),
    "glint_recipe_load": (c_int, [c_char_p, POINTER(POINTER(GlintRecipe)), POINTER(GlintError)]),
    "glint_recipe_destroy": (None, [POINTER(GlintRecipe)]),
    "glint_recipe_format": (c_size_t, [POINTER(GlintRecipe), c_char_p, c_size_t]),
    "glint_image_digest": (c_int, [POINTER(GlintImage), c_void_p, POINTER(GlintError)]),
    "glint_picture_digest": (c_int, [c_char_p, c_void_p, POINTER(GlintError)]),
    "glint_image_load": (c_int, [c_char_p, POINTER(GlintImage), POINTER(GlintError)]),
    "glint_image_free": (None, [POINTER(GlintImage)]),
    "glint_image_to_rgb8": (None, [POINTER(GlintImage), c_void_p]),
    "glint_element_at": (c_bool, [c_int, POINTER(GlintElement)]),
    "glint_element_type_at": (c_bool, [c_int, POINTER(GlintElementType)]),
    "glint_element_fits": (c_bool, [c_int, c_int]),
    "glint_element_kind_text": (c_char_p, [c_int]),
    "glint_element_range_text": (c_char_p, [c_int]),
    "glint_format_desc_default": (GlintFormatDesc, []),
    "glint_format": (c_int, [c_void_p, c_size_t, c_char_p, POINTER(GlintFormatDesc), GlintSinkFn,
        c_void_p, POINTER(GlintError)]),
    "glint_upgrade_desc_default": (GlintUpgradeDesc, []),
    "glint_upgrade": (c_int, [c_void_p, c_size_t, c_char_p, POINTER(GlintUpgradeDesc), GlintSinkFn,
        c_void_p, c_void_p, POINTER(GlintError)]),
    "glint_file_save": (c_int, [c_char_p, c_void_p, c_size_t, POINTER(GlintError)]),
    "glint_compare_desc_default": (GlintCompareDesc, []),
    "glint_image_compare": (c_int, [POINTER(GlintImage), POINTER(GlintImage),
        POINTER(GlintCompareDesc), POINTER(GlintComparison), POINTER(GlintError)]),
    "glint_verdict_name": (c_char_p, [c_int]),
    "glint_grade_desc_default": (GlintGradeDesc, []),
    "glint_grade": (c_int, [POINTER(GlintImage), c_char_p, POINTER(GlintGradeDesc),
        POINTER(GlintGrade), POINTER(GlintError)]),
    "glint_grade_format": (c_size_t, [POINTER(GlintGrade), c_char_p, c_size_t]),
    "glint_hypothesis_format": (c_size_t, [POINTER(GlintHypothesis), c_char_p, c_size_t]),
}
