/* SPDX-License-Identifier: MIT
 *
 * Glint: an exact and fast ray tracer for course scenes and large analytic scenes.
 *
 * This is the only public header. It is C11 and can be included from C++.
 *
 * The life of a picture:
 *
 *     glint_scene_create      an empty scene, which the caller changes from one thread
 *     glint_scene_load_file   ... filled from an XML file, or with glint_scene_add_...
 *     glint_scene_commit      checks it and builds the tree; from here on it is immutable
 *     glint_render            draws it into memory of the caller's
 *     glint_image_save        writes PNG, PFM or EXR
 *     glint_scene_destroy     frees everything the scene ever made
 *
 * Conventions:
 *   - Every desc struct is made by its glint_..._desc_default function and then changed. A struct
 *     that skipped the default is refused with GLINT_ERROR_ARGUMENT.
 *   - Functions that can fail return a GlintStatus and fill *error when error is not null.
 *   - Strings passed in are copied; strings handed to callbacks live until the callback returns.
 *   - A null scene, or an id that the scene did not give out, is a mistake of the program: it is
 *     refused with GLINT_ERROR_ARGUMENT where that costs nothing, and asserted where it does not.
 *   - The library never prints, never exits, reads no environment variable and keeps no global
 *     state that a caller could notice. Different scenes may be used from different threads, which
 *     take part in the work and need a megabyte of stack, as its own threads have.
 *   - Coordinates are right-handed. Colours are linear RGB. Rows of pixels run top to bottom.
 *   - The picture does not depend on the number of threads, the instruction set or the compiler,
 *     to the last bit.
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(GLINT_SHARED) && defined(_WIN32)
#define GLINT_API __declspec(dllimport)
#elif defined(__GNUC__)
#define GLINT_API __attribute__((visibility("default")))
#else
#define GLINT_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_VERSION_MAJOR 0
#define GLINT_VERSION_MINOR 1
#define GLINT_VERSION_PATCH 0

/* ---------------------------------------------------------------- status and errors */

/* Every status: name and what it says. */
#define GLINT_STATUS_LIST(X)                                                                       \
    X(OK, "no error")                                                                              \
    X(ERROR_ARGUMENT, "an argument of a call is out of range")                                     \
    X(ERROR_SCENE, "the scene has errors")                                                         \
    X(ERROR_FILE, "a file cannot be read or written")                                              \
    X(ERROR_MEMORY, "not enough memory")                                                           \
    X(ERROR_THREAD, "the system refused a thread")                                                 \
    X(CANCELLED, "the caller cancelled")

typedef enum GlintStatus {
#define GLINT_STATUS_ENUM(name, text) GLINT_##name,
    GLINT_STATUS_LIST(GLINT_STATUS_ENUM)
#undef GLINT_STATUS_ENUM
} GlintStatus;

/* The first thing that went wrong. line and column count from 1 and are 0 where there is none;
 * path names the scene file or the picture. Long texts are cut. */
typedef struct GlintError {
    GlintStatus status;
    int line, column;
    char path[256];
    char message[256];
} GlintError;

/* What the status says, for example "not enough memory". Never null. */
GLINT_API const char *glint_status_text(GlintStatus status);

typedef enum GlintSeverity {
    GLINT_SEVERITY_ERROR,
    GLINT_SEVERITY_WARNING, /* legal, but surely a mistake */
    GLINT_SEVERITY_NOTE     /* may well be meant */
} GlintSeverity;

/* One finding in a scene file. Loading reports all of them, not just the first. */
typedef struct GlintDiagnostic {
    GlintSeverity severity;
    const char *path;    /* as given to the load function */
    int64_t line;        /* from 1; 0: the file as a whole */
    int64_t column;      /* from 1, in characters (code points); a tab is one */
    const char *message; /* one sentence without a full stop */
    const char *excerpt; /* the line, cut to a window round the place; null when there is none */
    int caret;           /* index into excerpt, in characters, of the place */
    int caret_length;    /* at least 1 */
    const char *rule;    /* the name of its GlintRule; null: none */
    const char *hint;    /* how to mend it: one sentence without a full stop; null: nothing */
} GlintDiagnostic;

typedef void (*GlintDiagnosticFn)(void *user, const GlintDiagnostic *diagnostic);

/* Writes the diagnostic the way a compiler prints it, "path:line:column: error: message", the
 * excerpt and a caret under the place, then the hint, each line ended by a newline. Warnings and
 * notes end with their rule in brackets. At most size bytes are written, always zero-terminated
 * when size > 0. Returns the length without the cut. */
GLINT_API size_t glint_diagnostic_format(
    const GlintDiagnostic *diagnostic, char *buffer, size_t size);

/* ---------------------------------------------------------------- callbacks */

/* Memory. new_size 0 frees and returns null; pointer null allocates; otherwise like realloc.
 * Must be safe to call from several threads. Blocks need the alignment of malloc. */
typedef struct GlintAllocator {
    void *(*reallocate)(void *user, void *pointer, size_t old_size, size_t new_size);
    void *user;
} GlintAllocator;

typedef enum GlintPhase {
    GLINT_PHASE_READ,  /* parsing the scene file */
    GLINT_PHASE_BUILD, /* building the tree */
    GLINT_PHASE_TRACE, /* drawing */
    GLINT_PHASE_WRITE  /* encoding and writing the picture */
} GlintPhase;

/* Progress and cancel, both optional and both called only on the thread that made the call, many
 * times a second. fraction runs from 0 to 1; it is negative when the end is not known (a stream).
 * When cancelled returns true the running call returns GLINT_CANCELLED soon (within a few tens of
 * milliseconds). */
typedef struct GlintMonitor {
    void (*progress)(void *user, GlintPhase phase, double fraction);
    bool (*cancelled)(void *user);
    void *user;
} GlintMonitor;

/* ---------------------------------------------------------------- dialects and instruction sets */

/* The years of the course differ in their rules; docs/scene-format.md lists them. */
typedef enum GlintDialect {
    GLINT_DIALECT_AUTO, /* found from the content of the file; built scenes: GLINT */
    GLINT_DIALECT_2011,
    GLINT_DIALECT_2012,
    GLINT_DIALECT_MATERIAL,
    GLINT_DIALECT_2013,
    GLINT_DIALECT_2017,
    GLINT_DIALECT_2017B,
    GLINT_DIALECT_2018,
    GLINT_DIALECT_2018B,
    GLINT_DIALECT_2019,
    GLINT_DIALECT_GLINT, /* the rules without any year's quirks */
    GLINT_DIALECT_COUNT
} GlintDialect;

/* The name used in files and options ("2012", "glint", ...); null for a value out of range. */
GLINT_API const char *glint_dialect_name(GlintDialect dialect);
/* The opposite. False, and *dialect untouched, when there is no such name. */
GLINT_API bool glint_dialect_from_name(const char *name, GlintDialect *dialect);

/* The instruction sets this build can use on this machine, fastest first: "avx512", "avx2",
 * "sse2", "portable". Null at index >= the number of them. */
GLINT_API const char *glint_isa_name(int index);

/* "0.1.0" */
GLINT_API const char *glint_version_text(void);

/* ---------------------------------------------------------------- scene */

typedef struct GlintScene GlintScene;

typedef struct GlintShaderId {
    uint32_t index1;
} GlintShaderId; /* zero: the default shader */
typedef struct GlintSurfaceId {
    uint32_t index1;
} GlintSurfaceId; /* zero: none */
typedef struct GlintMeshId {
    uint32_t index1;
} GlintMeshId; /* zero: none */
typedef struct GlintTextureId {
    uint32_t index1;
} GlintTextureId; /* zero: none */

typedef struct GlintSceneDesc {
    GlintDialect dialect;            /* default AUTO; any other value overrides the file's */
    int thread_count;                /* 0 (default): one per core; 1: only the caller's thread */
    const char *isa;                 /* null (default): the fastest; or a glint_isa_name */
    size_t memory_limit;             /* bytes; 0 (default): nine tenths of the machine's */
    const GlintAllocator *allocator; /* null (default): the C library's; copied */
    GlintDiagnosticFn diagnostic;    /* null (default): findings go only to GlintError */
    void *diagnostic_user;
    bool keep_sources; /* false (default); true: glint_scene_source answers. The scene file then
                          stays in memory */
    bool reverse_transforms; /* false (default); true: GLINT_MISTAKE_TRANSFORMS_REVERSED, which is
                                made when the scene is committed */
    int cookie;              /* private */
} GlintSceneDesc;

GLINT_API GlintSceneDesc glint_scene_desc_default(void);

/* Makes an empty scene in *scene. Errors: ARGUMENT (unknown isa, negative thread count), MEMORY. */
GLINT_API GlintStatus glint_scene_create(
    const GlintSceneDesc *desc, GlintScene **scene, GlintError *error);

/* Frees the scene and all it holds. Null is allowed. */
GLINT_API void glint_scene_destroy(GlintScene *scene);

/* ---- from XML */

/* Reads a scene file into an empty scene. Every error of the file is reported through the
 * scene's diagnostic callback; the first is also left in *error. After an error the scene can
 * only be asked for its files and be destroyed. Large files, and those of meshes, are mapped while
 * they are read: a program that cuts one short meanwhile ends this one with SIGBUS. With
 * keep_sources the scene file is not. Errors: SCENE, FILE, MEMORY, CANCELLED. monitor may be null.
 */
GLINT_API GlintStatus glint_scene_load_file(
    GlintScene *scene, const char *path, const GlintMonitor *monitor, GlintError *error);

/* The same from memory. name stands for the path in messages and may be a path: files that the
 * scene names are looked up relative to it. The bytes are not kept. */
GLINT_API GlintStatus glint_scene_load_memory(GlintScene *scene, const void *bytes, size_t size,
    const char *name, const GlintMonitor *monitor, GlintError *error);

/* The same from a stream. read fills at most size bytes and returns how many; 0 is the end and a
 * negative value a failure (GLINT_ERROR_FILE). */
typedef int64_t (*GlintReadFn)(void *user, void *buffer, size_t size);
GLINT_API GlintStatus glint_scene_load_stream(GlintScene *scene, GlintReadFn read, void *user,
    const char *name, const GlintMonitor *monitor, GlintError *error);

/* What of a scene stands in a place of its file. */
typedef enum GlintObjectKind {
    GLINT_OBJECT_SURFACE, /* by GlintSurfaceId */
    GLINT_OBJECT_LIGHT,   /* the k-th, in the order of the scene */
    GLINT_OBJECT_SHADER,  /* by GlintShaderId */
    GLINT_OBJECT_CAMERA,  /* the k-th; the last one counts */
    GLINT_OBJECT_KIND_COUNT
} GlintObjectKind;

typedef struct GlintSource {
    const char *path;     /* as given to the load function */
    const char *name;     /* its name attribute; "" for none */
    int64_t line, column; /* of its start tag, from 1, in characters */
} GlintSource;

/* Where an object stands in the file that was loaded with keep_sources. index1 counts from 1.
 * False: there is none, or its place is not known. The strings live as long as the scene. From one
 * thread at a time. */
GLINT_API bool glint_scene_source(
    GlintScene *scene, GlintObjectKind kind, uint32_t index1, GlintSource *source);

/* The files that a scene is made of. */
typedef enum GlintFileKind {
    GLINT_FILE_SCENE,
    GLINT_FILE_MESH,
    GLINT_FILE_TEXTURE,
    GLINT_FILE_ENVIRONMENT
} GlintFileKind;

typedef struct GlintSceneFile {
    GlintFileKind kind;
    const char
        *name; /* as the scene calls it; of the scene itself: as given to the load function */
    const char *path; /* as it was opened; a stream's or memory's is its name */
    uint64_t size;    /* bytes when it was read; 0 of what was no regular file */
    uint64_t digest;  /* CRC-64/XZ of its content; 0 likewise */
} GlintSceneFile;

/* The scene's own file is the first (index 0), the others follow in the order in which they were
 * loaded, each once; also after a load that failed, when these are the files that were found.
 * False, and *file untouched, behind the last. The strings live as long as the scene. */
GLINT_API bool glint_scene_file(const GlintScene *scene, int index, GlintSceneFile *file);

/* The files that the scene names and that were not found, each once, after a load that failed: the
 * place where each was looked for first. Null at an index >= the number of them. The string lives
 * as long as the scene. */
GLINT_API const char *glint_scene_missing_file(const GlintScene *scene, size_t index);

/* ---- by calls */

/* How light is gathered; docs/scene-format.md, integrators. */
typedef enum GlintIntegrator {
    GLINT_INTEGRATOR_LIGHT_SAMPLING,
    GLINT_INTEGRATOR_BSDF_SAMPLING,
    GLINT_INTEGRATOR_POINT_LIGHT,
    GLINT_INTEGRATOR_PATH /* global illumination */
} GlintIntegrator;

typedef struct GlintImageDesc {
    int width, height; /* pixels; each at least 1, at most 2^28 together; default 512 x 512 */
    int samples; /* per pixel, drawn on a regular n x n grid, n = round(sqrt); 1 (default) to 65536
                  */
    double back_color[3];       /* linear; default black */
    double exposure;            /* factor of every pixel; <= 0 is ignored; default 1 */
    GlintIntegrator integrator; /* LIGHT_SAMPLING */
    int max_depth; /* of GLINT_INTEGRATOR_PATH: surfaces a path may meet; 1 to 4096; 12 */
    int cookie;
} GlintImageDesc;

typedef enum GlintCameraType { GLINT_CAMERA_PERSPECTIVE, GLINT_CAMERA_PARALLEL } GlintCameraType;

/* The window of view_width x view_height stands at view_point + projection_distance along
 * view_direction, tilted so that projection_normal is its normal. The parallel camera's window is
 * centred at view_point. Lengths of the vectors do not matter. */
typedef struct GlintCameraDesc {
    GlintCameraType type;
    double view_point[3];        /* 0 0 0 */
    double view_direction[3];    /* 0 0 -1 */
    double view_up[3];           /* 0 1 0; not parallel to the projection normal */
    double projection_normal[3]; /* 0 0 0 (default): opposite to view_direction */
    double projection_distance;  /* > 0; 1 */
    double view_width;           /* > 0; 1 */
    double view_height;          /* > 0; 1 */
    int cookie;
} GlintCameraDesc;

typedef enum GlintShaderType {
    GLINT_SHADER_LAMBERTIAN,
    GLINT_SHADER_PHONG,       /* Blinn-Phong: the exponent acts on normal . half vector */
    GLINT_SHADER_RGB_NORMALS, /* (normal + 1) / 2 */
    GLINT_SHADER_GLAZED,      /* a clear coat over a substrate: mirrors by Fresnel's formula */
    GLINT_SHADER_GLASS,       /* mirrors and refracts */
    GLINT_SHADER_BECKMANN,    /* microfacets (Walter et al. 2007) over a diffuse base */
    GLINT_SHADER_GGX,
    GLINT_SHADER_COOK_TORRANCE
} GlintShaderType;

typedef struct GlintShaderDesc {
    GlintShaderType type;
    double diffuse_color[3];  /* 1 1 1 */
    double specular_color[3]; /* of the highlight: Phong, microfacets, Cook-Torrance; 1 1 1 */
    double exponent;          /* Phong; 1 */
    double mirror_color[3];   /* of a mirror by Schlick's formula, added to Lambertian, Phong and
                                 microfacets; 0 0 0: none */
    double roughness;         /* microfacets (alpha), Cook-Torrance; > 0; 0.5 */
    double refractive_index;  /* glazed, glass, microfacets, Cook-Torrance; > 0; 1.5 */
    GlintShaderId substrate;  /* under the glaze; zero: the default shader. At most 8 glazed shaders
                                 may lie on each other */
    GlintTextureId texture;   /* in the place of diffuse_color; zero: none */
    int cookie;
} GlintShaderDesc;

/* What a texture shows beyond its picture. */
typedef enum GlintWrap {
    GLINT_WRAP_REPEAT, /* the picture again */
    GLINT_WRAP_CLAMP   /* its edge */
} GlintWrap;

typedef struct GlintTextureDesc {
    int width, height;  /* pixels; each at least 1, at most 2^28 together */
    const uint8_t *rgb; /* width * height * 3 bytes, top row first; 255 is 1, linear. Copied */
    GlintWrap wrap;     /* REPEAT */
    int cookie;
} GlintTextureDesc;

typedef enum GlintLightType {
    GLINT_LIGHT_POINT,       /* with hard shadows */
    GLINT_LIGHT_AMBIENT,     /* adds intensity * diffuse colour everywhere */
    GLINT_LIGHT_CONSTANT,    /* adds the diffuse colour everywhere */
    GLINT_LIGHT_NORMAL,      /* adds (normal + 1) / 2 everywhere */
    GLINT_LIGHT_DIRECTIONAL, /* from infinitely far away, with hard shadows */
    GLINT_LIGHT_RECTANGLE    /* shines from one side of a rectangle, with soft shadows */
} GlintLightType;

typedef enum GlintFalloff {
    GLINT_FALLOFF_DIALECT, /* as the dialect has it; GLINT: none */
    GLINT_FALLOFF_NONE,
    GLINT_FALLOFF_INVERSE_SQUARE
} GlintFalloff;

typedef struct GlintLightDesc {
    GlintLightType type;
    double position[3];   /* point, rectangle (its centre); 0 0 0 */
    double intensity[3];  /* of a rectangle: radiance; 1 1 1 */
    GlintFalloff falloff; /* point */
    double direction[3];  /* directional: toward the light; rectangle: to the side that shines. Any
                             length but zero; 0 0 -1 */
    double up[3];         /* rectangle: along its height; any length but zero, not parallel to
                             direction; 0 1 0 */
    double width, height; /* rectangle; > 0; 1 */
    int cookie;
} GlintLightDesc;

/* Triangles. All arrays are copied; normals and texcoords may be null (the default). */
typedef struct GlintMeshDesc {
    const float *positions; /* vertex_count * 3 */
    size_t vertex_count;
    const float *normals;      /* vertex_count * 3, of any length, blended over each triangle */
    const float *texcoords;    /* vertex_count * 2: u to the right, v up, in the texture */
    const uint32_t *triangles; /* triangle_count * 3 indices of vertices, counted from 0. Seen from
                                  where they run counterclockwise is the side of the normal */
    size_t triangle_count;     /* at least 1; at most 2^28 in a scene */
    int cookie;
} GlintMeshDesc;

typedef enum GlintSurfaceType {
    GLINT_SURFACE_SPHERE,   /* center, radius */
    GLINT_SURFACE_BOX,      /* point_a, point_b: two opposite corners */
    GLINT_SURFACE_CYLINDER, /* center, radius, height; axis along z, closed */
    GLINT_SURFACE_CONE,     /* center, radius (in the centre plane), height, tip_z; closed */
    GLINT_SURFACE_PLANE,    /* point_a, normal; infinite */
    GLINT_SURFACE_DISC,     /* center, normal, radius */
    GLINT_SURFACE_GROUP,    /* children under transform; source: drawn once more */
    GLINT_SURFACE_MESH      /* mesh: its triangles */
} GlintSurfaceType;

typedef struct GlintSurfaceDesc {
    GlintSurfaceType type;
    GlintShaderId shader;   /* zero: Lambertian with all defaults; a group has none */
    GlintSurfaceId parent;  /* the group it belongs to; zero: the scene */
    double center[3];       /* 0 0 0 */
    double radius;          /* > 0; 1 */
    double height;          /* > 0; 1 */
    double tip_z;           /* z of the apex; not center[2]; 0 */
    double point_a[3];      /* 0 0 0 */
    double point_b[3];      /* 0 0 0 */
    double normal[3];       /* 0 0 1; any length but zero */
    double transform[3][4]; /* group: rows of an invertible affine matrix; identity */
    GlintMeshId mesh;       /* of a mesh; any number of surfaces may have the same */
    GlintSurfaceId source;  /* group: a group that exists already and is drawn here once more, with
                               all it contains now or later, under this one's transform; it must
                               not contain the parent. zero: none */
    int cookie;
} GlintSurfaceDesc;

GLINT_API GlintImageDesc glint_image_desc_default(void);
GLINT_API GlintCameraDesc glint_camera_desc_default(void);
GLINT_API GlintShaderDesc glint_shader_desc_default(void);
GLINT_API GlintTextureDesc glint_texture_desc_default(void);
GLINT_API GlintMeshDesc glint_mesh_desc_default(void);
GLINT_API GlintLightDesc glint_light_desc_default(void);
GLINT_API GlintSurfaceDesc glint_surface_desc_default(GlintSurfaceType type);

/* Each checks its desc and copies it. Errors: ARGUMENT (with the field named in error->message;
 * also when the scene is committed already), MEMORY. The id pointers may be null. */
GLINT_API GlintStatus glint_scene_set_image(
    GlintScene *scene, const GlintImageDesc *desc, GlintError *error);
GLINT_API GlintStatus glint_scene_set_camera(
    GlintScene *scene, const GlintCameraDesc *desc, GlintError *error);
GLINT_API GlintStatus glint_scene_add_light(
    GlintScene *scene, const GlintLightDesc *desc, GlintError *error);
GLINT_API GlintStatus glint_scene_add_shader(
    GlintScene *scene, const GlintShaderDesc *desc, GlintShaderId *id, GlintError *error);
GLINT_API GlintStatus glint_scene_add_texture(
    GlintScene *scene, const GlintTextureDesc *desc, GlintTextureId *id, GlintError *error);
GLINT_API GlintStatus glint_scene_add_mesh(
    GlintScene *scene, const GlintMeshDesc *desc, GlintMeshId *id, GlintError *error);
GLINT_API GlintStatus glint_scene_add_surface(
    GlintScene *scene, const GlintSurfaceDesc *desc, GlintSurfaceId *id, GlintError *error);

/* The same from files; path is opened as it stands. Every call reads its file anew, so keep the id.
 * Errors, with the path and, for meshes, the line in *error: ARGUMENT, FILE (also a picture that is
 * broken), SCENE (a mesh that is broken), MEMORY, THREAD. */

/* A PNG or JPEG picture. */
GLINT_API GlintStatus glint_scene_load_texture(
    GlintScene *scene, const char *path, GlintWrap wrap, GlintTextureId *id, GlintError *error);
/* A mesh: .obj, .msh or .ply. */
GLINT_API GlintStatus glint_scene_load_mesh(
    GlintScene *scene, const char *path, GlintMeshId *id, GlintError *error);
/* A cube map (PFM, docs/scene-format.md) as what rays see that hit nothing, in the place of
 * back_color; scale is a factor of its values. A second call replaces the first. */
GLINT_API GlintStatus glint_scene_load_environment(
    GlintScene *scene, const char *path, double scale, GlintError *error);

/* ---------------------------------------------------------------- mistakes */

/* Typical mistakes of ray tracers that are being written. A scene can be drawn with them on purpose
 * (GlintRenderDesc.mistakes), and glint_grade finds out whether a picture was drawn with one. Each:
 * constant, name, what it is. docs/grade.md says more. Those of the camera, of what rays meet, of
 * lights and of surfaces come first; from FLIPPED on they concern the finished picture alone. */
#define GLINT_MISTAKE_LIST(X)                                                                      \
    X(SHIFTED, "shifted", "the picture is shifted by half a pixel: rays miss the pixels' centres") \
    X(PIXEL_SPAN, "pixel-span", "pixels are divided by width - 1, not by width")                   \
    X(WINDOW_SWAPPED, "window-swapped", "viewWidth and viewHeight are exchanged")                  \
    X(WINDOW_SQUARE, "window-square", "viewHeight is ignored: the window is a square")             \
    X(WINDOW_PIXELS, "window-pixels", "viewHeight is ignored: the window has the pixels' shape")   \
    X(VIEW_LENGTH, "view-length", "the view direction is not normalised")                          \
    X(UP_LENGTH, "up-length", "the camera's right and up are not normalised")                      \
    X(UP_SKEWED, "up-skewed", "viewUp is taken as it is, not at right angles to the view")         \
    X(WINDOW_TILT, "window-tilt", "projNormal is ignored")                                         \
    X(WINDOW_DISTANCE, "window-distance", "projDistance is ignored")                               \
    X(FIRST_HIT, "first-hit", "not the nearest surface is seen, but the first of the file")        \
    X(LAST_HIT, "last-hit", "not the nearest surface is seen, but the last of the file")           \
    X(TRANSFORMS_REVERSED, "transforms-reversed", "a group's transforms act in reverse order")     \
    X(NORMALS_MATRIX, "normals-matrix",                                                            \
        "normals are transformed by the matrix, not by its inverse transpose")                     \
    X(NORMALS_LENGTH, "normals-length", "normals are not normalised")                              \
    X(NORMALS_INWARD, "normals-inward", "normals point inward")                                    \
    X(NORMALS_FACING, "normals-facing", "normals are turned toward the viewer")                    \
    X(NORMALS_FLAT, "normals-flat", "the vertex normals of meshes are ignored")                    \
    X(NO_SHADOWS, "no-shadows", "shadows are missing")                                             \
    X(SHADOW_ACNE, "shadow-acne",                                                                  \
        "shadow rays start without an epsilon: surfaces shadow themselves")                        \
    X(SHADOW_BEYOND, "shadow-beyond", "surfaces behind the light cast shadows")                    \
    X(SHADOW_REVERSED, "shadow-reversed", "shadow rays run away from the light")                   \
    X(LIGHT_MISSING, "light-missing", "a light is missing")                                        \
    X(LAST_LIGHT, "last-light", "only the last light counts")                                      \
    X(NO_AMBIENT, "no-ambient", "ambient light is missing")                                        \
    X(NO_FALLOFF, "no-falloff", "light does not fall off with the distance")                       \
    X(FALLOFF, "falloff", "light falls off with the square of the distance, and should not")       \
    X(FALLOFF_LINEAR, "falloff-linear", "light falls off with the distance, not with its square")  \
    X(DIFFUSE_PI, "diffuse-pi",                                                                    \
        "the diffuse colour has a factor 1/pi, or has none, against the year")                     \
    X(DIFFUSE_BEHIND, "diffuse-behind", "surfaces are lit from behind: |n.l| for max(0, n.l)")     \
    X(NO_SPECULAR, "no-specular", "highlights are missing")                                        \
    X(SPECULAR_BEHIND, "specular-behind",                                                          \
        "highlights are not limited to lit sides: |n.h|, any n.l")                                 \
    X(SPECULAR_COSINE, "specular-cosine",                                                          \
        "highlights have a factor n.l, or have none, against the year")                            \
    X(REFLECTED_HIGHLIGHT, "reflected-highlight", "highlights use r.v (Phong), not n.h (Blinn)")   \
    X(NO_RECURSION, "no-recursion", "mirrors, glass and paths send no rays on")                    \
    X(TEXTURE_FLIPPED, "texture-flipped", "textures are upside down")                              \
    X(NO_BACKGROUND, "no-background", "the background colour is missing")                          \
    X(NO_EXPOSURE, "no-exposure", "the exposure is ignored")                                       \
    X(ONE_SAMPLE, "one-sample", "only one sample a pixel is drawn")                                \
    X(FLIPPED, "flipped", "the picture is upside down")                                            \
    X(MIRRORED, "mirrored", "left and right are exchanged")                                        \
    X(TRANSPOSED, "transposed", "rows and columns are exchanged (square pictures)")                \
    X(BGR, "bgr", "red and blue are exchanged")                                                    \
    X(BRIGHTNESS, "brightness", "all light has a wrong factor")                                    \
    X(GAMMA_MISSING, "gamma-missing", "gamma is missing: linear values were written")              \
    X(GAMMA_TWICE, "gamma-twice", "gamma is applied twice")                                        \
    X(SRGB, "srgb", "the sRGB curve is used, not the power 2.2")                                   \
    X(TRUNCATED, "truncated", "values are cut, not rounded, to 8 bits")                            \
    X(WRAPPED, "wrapped", "values beyond 255 begin again at 0, and are not clamped")

typedef enum GlintMistake {
#define GLINT_MISTAKE_ENUM(constant, name, text) GLINT_MISTAKE_##constant,
    GLINT_MISTAKE_LIST(GLINT_MISTAKE_ENUM)
#undef GLINT_MISTAKE_ENUM
        GLINT_MISTAKE_COUNT
} GlintMistake;

/* The bit of a mistake in a set. */
#define GLINT_MISTAKE_BIT(mistake) (UINT64_C(1) << (mistake))

/* Mistakes to make together, and how far they go. All zero: none. */
typedef struct GlintMistakes {
    uint64_t set;         /* of GLINT_MISTAKE_BIT */
    int light;            /* LIGHT_MISSING: which, from 1 in the order of the scene; 0: the first */
    int shift_x, shift_y; /* SHIFTED: half pixels that the picture moves to the right and down, -4
                             to 4; both 0: 1 and -1, as when rays pass the pixels' lower left
                             corners */
    double factor;        /* BRIGHTNESS, to nine digits after the point; 0: 1/2 */
} GlintMistakes;

/* The name used in options ("no-shadows"), and what it is in a sentence. Null out of range. */
GLINT_API const char *glint_mistake_name(GlintMistake mistake);
GLINT_API const char *glint_mistake_text(GlintMistake mistake);
/* The opposite. False, and *mistake untouched, when there is no such name. */
GLINT_API bool glint_mistake_from_name(const char *name, GlintMistake *mistake);

/* Mistakes as text: names with commas between them, and where it is not the usual, how far they go:
 * "no-shadows,light-missing=2", "shifted=1:-1", "brightness=0.25". At most size bytes are written,
 * always zero-terminated when size > 0; returns the length without the cut. */
GLINT_API size_t glint_mistakes_format(const GlintMistakes *mistakes, char *buffer, size_t size);
/* The opposite, added to *mistakes. False when it is not understood; *wrong is then where. */
GLINT_API bool glint_mistakes_parse(const char *text, GlintMistakes *mistakes, const char **wrong);

/* ---------------------------------------------------------------- commit, render, trace */

/* Builds the tree. After it the scene is immutable and may be traced from many threads at once.
 * Errors: ARGUMENT (no camera or image, committed twice), SCENE (too many surfaces), MEMORY,
 * THREAD, CANCELLED. monitor may be null. */
GLINT_API GlintStatus glint_scene_commit(
    GlintScene *scene, const GlintMonitor *monitor, GlintError *error);

typedef struct GlintSceneInfo {
    GlintDialect dialect; /* the one in force; AUTO before commit when it is not known yet */
    int width, height, samples;
    uint64_t surface_count; /* as traced: groups spread out */
    uint32_t light_count, shader_count;
} GlintSceneInfo;

GLINT_API void glint_scene_info(const GlintScene *scene, GlintSceneInfo *info);

/* The scene's camera, as a desc that can be changed and drawn with. A projection normal that the
 * scene does not give is 0 0 0. False when the scene has no camera. */
GLINT_API bool glint_scene_camera(const GlintScene *scene, GlintCameraDesc *camera);

/* Where samples of large lights, environments and paths fall. */
typedef enum GlintSampling {
    GLINT_SAMPLING_SOBOL, /* scrambled low-discrepancy sequences */
    GLINT_SAMPLING_RANDOM /* plain random numbers: noisier, to compare with */
} GlintSampling;

/* What pixels show: the picture, or something that explains it. The values are those that the
 * picture is made of. They are found by one ray through the middle of each pixel, whatever the
 * samples; the cost is that of as many samples as the desc asks for, 0: of one. light, and the
 * outputs beside the pixels, must be left alone.
 * docs/views.md has pictures. */
typedef enum GlintShow {
    GLINT_SHOW_PICTURE,
    GLINT_SHOW_NORMAL, /* (normal + 1) / 2, as RGBNormals has it */
    GLINT_SHOW_DEPTH,  /* distance from the ray's origin: near white, far black */
    GLINT_SHOW_UV,     /* texture coordinates as red and green; blue where there are none */
    GLINT_SHOW_ID,     /* a colour for each surface */
    GLINT_SHOW_COST,   /* nodes, leaves and exact tests of all rays of the pixel, traced one by one;
                          with a legend. The same on every machine */
    GLINT_SHOW_SHADOW, /* the part of the lights with a place or direction that the point faces and
                          nothing hides: all white, none black */
    GLINT_SHOW_COUNT
} GlintShow;

typedef struct GlintRenderDesc {
    int width, height;           /* 0 (default): the scene's */
    int crop_x, crop_y;          /* top left corner of the part to draw; 0 */
    int crop_width, crop_height; /* 0 (default): all that is right of and below the corner */
    int samples;                 /* per pixel, as in GlintImageDesc; 0 (default): the scene's */
    /* Light of one kind only: 0 (default): all; k > 0: of the k-th light, in the order of the
     * scene; -1: what comes from none of them (background, environment, RGBNormals). Up to
     * rounding, these parts sum up to the whole. */
    int light;
    /* Where to put what the camera rays met, a value a pixel in the order of the pixels; each may
     * be null (default). Means over the samples of a pixel, but for the surface. A light is met as
     * if nothing were there. */
    float *depth;      /* distance from the origin of the ray; 0 where it meets nothing */
    float *normal;     /* 3 a pixel: the normal that is shaded with; 0 0 0 where nothing is met */
    float *albedo;     /* 3 a pixel: the diffuse colour, textures included; of glazing what is
                        * under it, of glass 0 */
    uint32_t *surface; /* GlintSurfaceId of the first sample's surface; 0: none */
    GlintSampling sampling;      /* SOBOL */
    const GlintMonitor *monitor; /* null */
    /* Drawn with in the place of the scene's camera: the picture is the one of a scene with this
     * camera, to the last bit, and nothing is built anew. null (default): the scene's. Read before
     * the call returns. */
    const GlintCameraDesc *camera;
    GlintShow show;      /* PICTURE */
    double *shown_range; /* null (default), or where to put two numbers: of DEPTH the distances that
                          * are white and black, of COST 0 and what is white */
    /* To draw wrongly on purpose; none (default). Those of the finished picture change colours
     * only, not depth and the like, and count from the corner of the part that is drawn.
     * TRANSFORMS_REVERSED is asked of the scene's desc, and ignored here. */
    GlintMistakes mistakes;
    int cookie;
} GlintRenderDesc;

GLINT_API GlintRenderDesc glint_render_desc_default(void);

/* Draws into pixels: crop_width * crop_height * 3 floats, linear RGB, top row first, no padding.
 * One call at a time per scene. Errors: ARGUMENT, MEMORY, CANCELLED (pixels are then partly
 * drawn). */
GLINT_API GlintStatus glint_render(
    GlintScene *scene, const GlintRenderDesc *desc, float *pixels, GlintError *error);

typedef struct GlintRay {
    double origin[3];
    double direction[3]; /* of length 1e-100 to 1e100; t counts in this length */
    double t_min, t_max; /* open interval; t_max may be INFINITY */
} GlintRay;

typedef struct GlintHit {
    double t;
    double point[3];
    double normal[3];       /* unit, outward, never turned toward the ray */
    GlintSurfaceId surface; /* in the order in which surfaces were added, groups not counted; zero:
                               a rectangle light of a dialect where these can be seen */
    GlintShaderId shader;
} GlintHit;

/* The ray through a place of the window: a runs from 0 at its left to 1, b from 0 at its bottom.
 * The middle of the pixel (x, y) of a picture of w x h pixels, y from the top, is a = (x + 0.5) /
 * w, b = 1 - (y + 0.5) / h. t_min is 0 and t_max INFINITY; the direction has length 1. Errors:
 * ARGUMENT (a camera that glint_scene_set_camera would refuse). */
GLINT_API GlintStatus glint_camera_ray(
    const GlintCameraDesc *camera, double a, double b, GlintRay *ray, GlintError *error);

/* The nearest hit of a ray in a committed scene. False: none, and *hit is untouched. Any number of
 * threads may call it. Arguments are not checked in release builds. */
GLINT_API bool glint_trace(const GlintScene *scene, const GlintRay *ray, GlintHit *hit);

/* Whether anything is hit. The same rules. */
GLINT_API bool glint_occluded(const GlintScene *scene, const GlintRay *ray);

/* ---------------------------------------------------------------- explaining pixels */

/* Why a pixel has its colour: every ray that was traced for it, what it met, what each light did
 * there, and every number that was added, in the order in which it was added. All this is noted
 * while the pixel is drawn, by the code that draws pictures.
 *
 * A sample of a pixel is explained by six arrays whose elements refer to each other by index
 * (GLINT_NONE: to none). Rays form a tree: the camera's is rays[0], and a parent stands before
 * its children. Vectors are in world space, colours linear. */
#define GLINT_NONE UINT32_MAX

typedef enum GlintRayKind {
    GLINT_RAY_CAMERA,
    GLINT_RAY_MIRRORED,
    GLINT_RAY_REFRACTED,
    GLINT_RAY_SCATTERED, /* in a direction that the shader drew: a path goes on */
    GLINT_RAY_PROBE      /* the same, but it looks for lights and the environment only */
} GlintRayKind;

typedef enum GlintRayEnd {
    GLINT_RAY_END_NOTHING, /* it left the scene */
    GLINT_RAY_END_SURFACE,
    GLINT_RAY_END_LIGHT /* a rectangle light of a dialect where these can be seen */
} GlintRayEnd;

typedef struct GlintExplainRay {
    GlintRayKind kind;
    GlintRayEnd end;
    uint32_t parent; /* the ray at whose end this one begins */
    uint32_t level;  /* camera rays: 1 */
    double origin[3];
    double direction[3]; /* unit, but for rounding */
    double t_min;        /* met only behind this */
    double factor[3];    /* of what it brings */
    double weight;       /* of the ray tree, for the years that drop what weighs too little */
    double density;      /* per solid angle, of the drawing of its direction; 0: not drawn */
    bool inside;         /* it runs in glass (years that count) */

    /* Of what it met, unless that is nothing. */
    double t; /* distance */
    double point[3];
    double normal[3];           /* unit, outward: the one that is shaded with */
    double geometric_normal[3]; /* of the surface itself */
    double n_dot_v;             /* v: back along the ray */
    GlintSurfaceId surface;     /* zero: a light */
    GlintSurfaceType surface_type;
    uint32_t triangle; /* of a mesh: in the order of its file, from 0; else GLINT_NONE */
    uint32_t light;    /* met: the k-th of the scene, from 1; 0: none */
    GlintShaderId shader;

    /* Of the light that the surface reflects. Glass reflects none, glazing leaves it to what is
     * under it. */
    bool lit; /* lights are looked at; the rest counts only then */
    GlintShaderId local_shader;
    double local_factor[3];  /* of what lights add, in the sample */
    double diffuse_color[3]; /* textures included */
} GlintExplainRay;

/* What became of a ray that might go on from a surface. */
typedef enum GlintBranchFate {
    GLINT_BRANCH_FOLLOWED,   /* it is rays[child] */
    GLINT_BRANCH_NOTHING,    /* it would add nothing, or no direction was drawn */
    GLINT_BRANCH_TOO_LIGHT,  /* its weight is below the year's limit */
    GLINT_BRANCH_TOO_DEEP,   /* behind the deepest level */
    GLINT_BRANCH_NOT_CHOSEN, /* a path goes on in one direction only, drawn by chance */
    GLINT_BRANCH_ENDED,      /* the path was ended by chance (Russian roulette) */
    GLINT_BRANCH_NO_TREE     /* the integrator follows none */
} GlintBranchFate;

typedef struct GlintExplainBranch {
    GlintRayKind kind;
    GlintBranchFate fate;
    uint32_t ray;     /* at whose end it begins */
    uint32_t layer;   /* that sends it; GLINT_NONE: the shader under all layers drew it */
    uint32_t child;   /* the ray, when it is followed */
    double factor[3]; /* relative to the ray's */
    double weight;    /* as that of the ray it would be */
    double chance;    /* with which a path goes on here; 1 in a ray tree */
    double survival;  /* ... and with which it is not ended by Russian roulette. The child's factor
                         is this factor times the ray's, over both chances; that of a drawn
                         direction times what the shader reflects from there, over its density */
} GlintExplainBranch;

/* A glazing, glass, or the mirror coefficient of another shader. */
typedef struct GlintExplainLayer {
    uint32_t ray; /* that met it */
    GlintShaderId shader;
    bool inside;          /* glass: the ray runs in it */
    bool behind;          /* seen from behind, where a layer does nothing or is black */
    bool total;           /* glass: total internal reflection */
    double cosine;        /* n.v, n on the side of v in glass */
    double cosine_behind; /* of the refracted ray; 0 where there is none */
    double ratio;         /* glass: index before the boundary over that behind; else 0 */
    double reflectance;   /* that Fresnel's or Schlick's formula gives; of a mirror coefficient, a
                             colour, the largest component */
} GlintExplainLayer;

/* What became of a light at a point. */
typedef enum GlintLightFate {
    GLINT_LIGHT_ARRIVES,    /* nothing is in the way */
    GLINT_LIGHT_BLOCKED,    /* a surface is in the way */
    GLINT_LIGHT_EVERYWHERE, /* ambient and its like: nothing can be in the way */
    /* The rest adds nothing, and no shadow ray is traced. */
    GLINT_LIGHT_BEHIND,      /* n.l is not positive */
    GLINT_LIGHT_UNSEEN_SIDE, /* the surface is seen from behind and black there */
    GLINT_LIGHT_OFF,         /* the light itself has no strength here */
    GLINT_LIGHT_TURNED_AWAY, /* a rectangle light shines to its other side */
    GLINT_LIGHT_ON_SURFACE,  /* the light is at the point itself */
    GLINT_LIGHT_ABSORBED     /* the surface reflects nothing of it toward the viewer */
} GlintLightFate;

/* term = strength * reflected * share, and the sample gets local_factor of the ray times this. */
typedef struct GlintExplainLight {
    GlintLightFate fate;
    uint32_t ray;   /* at whose end */
    uint32_t light; /* the k-th of the scene, from 1; 0: the environment */
    /* All but the term is 0 where nothing can be in the way. */
    double direction[3];                   /* l: unit, toward the light or the point drawn on it */
    double distance;                       /* INFINITY: directional light, environment */
    double n_dot_l, n_dot_h;               /* h: half way between l and v */
    double falloff;                        /* of a point light: 1 / distance^2, or 1; else 1 */
    double strength[3];                    /* E: intensity * falloff, or radiance over density */
    double diffuse[3], highlight[3];       /* parts of the shader's formula, n.l included */
    double reflected[3];                   /* their sum */
    double fresnel, distribution, masking; /* F, D, G of microfacets; 0 elsewhere */
    double density;                        /* with which a large light drew l; 0: not drawn */
    double share;                          /* of a large light: the weight beside other ways to find
                                              it, times 1/pi where the year needs it; else 1 */
    double term[3];
    double shadow_begin, shadow_end; /* distances between which the shadow ray looks; both 0: there
                                        was none */
    /* What is in the way, nearest first; of GLINT_LIGHT_BLOCKED. */
    GlintSurfaceId blocker; /* zero: a rectangle light, blocker_light */
    GlintSurfaceType blocker_type;
    uint32_t blocker_triangle, blocker_light;
    double blocker_distance;
    double blocker_point[3];
    uint32_t addition; /* what was added; GLINT_NONE: nothing */
} GlintExplainLight;

/* Something that was added to a sample. sum is the sample's colour after it. */
typedef struct GlintExplainAddition {
    uint32_t ray;
    uint32_t light; /* index of the GlintExplainLight; GLINT_NONE: what the ray's end shows by
                       itself, which is background, a light that is seen, or RGBNormals */
    double amount[3];
    double sum[3];
} GlintExplainAddition;

typedef struct GlintExplainSample {
    int x, y;              /* pixel, from the top left */
    int sample, samples;   /* number from 0; how many the pixel has */
    double film_x, film_y; /* the place in the pixel: 0 to 1 from its lower left corner */
    const GlintExplainRay *rays;
    const GlintExplainLayer *layers;
    const GlintExplainBranch *branches;
    const GlintExplainLight *lights;
    const GlintExplainAddition *additions;
    size_t ray_count, layer_count, branch_count, light_count, addition_count;
    double color[3]; /* the sum of all additions */
    double sum[3];   /* of the samples so far, with this one */
} GlintExplainSample;

typedef struct GlintExplainPixel {
    int x, y, samples;
    double sum[3];   /* of all samples */
    double exposure; /* sum / samples * exposure, rounded to float, is the linear colour */
    float color[3];  /* what glint_render gives, to the last bit */
    uint8_t rgb[3];  /* the same with gamma 2.2 in 8 bits, as in a PNG */
} GlintExplainPixel;

/* Each function may be null. What is pointed to lives until it returns. They are called on the
 * caller's thread: sample for each sample of a pixel in order, then pixel. */
typedef struct GlintExplainSink {
    void (*sample)(void *user, const GlintExplainSample *sample);
    void (*pixel)(void *user, const GlintExplainPixel *pixel);
    void *user;
    int only_sample; /* 0: all; k > 0: only the k-th of each pixel is drawn, whose sum is then its
                        own colour, and pixel is not called. A pixel has fewer: none */
} GlintExplainSink;

/* Explains the pixels of the crop, row by row from the top left. desc is that of glint_render; its
 * depth, normal, albedo and surface are left alone. One call at a time per scene, and none while
 * it is drawn. The work of a pixel is about that of drawing it. Errors: ARGUMENT, MEMORY,
 * CANCELLED. */
GLINT_API GlintStatus glint_explain(GlintScene *scene, const GlintRenderDesc *desc,
    const GlintExplainSink *sink, GlintError *error);

/* What a shader, or the k-th light from 1, of the scene is: a desc as glint_scene_add_... takes it.
 * After commit a shader without a diffuse colour has the one that its year gives it. False: there
 * is none. */
GLINT_API bool glint_scene_shader(
    const GlintScene *scene, GlintShaderId id, GlintShaderDesc *shader);
GLINT_API bool glint_scene_light(const GlintScene *scene, uint32_t light, GlintLightDesc *desc);

/* The linear colour of a ray that meets nothing, where there is no environment, and whether there
 * is one. */
GLINT_API bool glint_scene_background(const GlintScene *scene, double back_color[3]);

/* ---------------------------------------------------------------- statistics */

/* What the phases took and found so far. Seconds are wall time; counts are of the last render. */
typedef struct GlintStats {
    double read_seconds, build_seconds, trace_seconds;
    uint64_t read_bytes;
    uint64_t camera_rays, shadow_rays;
    uint64_t other_rays; /* mirrored, refracted, scattered */
    uint64_t primitive_count, node_count, leaf_count, tree_bytes;
    double sah_cost;      /* expected node visits plus primitive block tests of a random ray */
    uint64_t memory_peak; /* bytes asked of the allocator at the same time */
    int thread_count;
    const char *isa;
} GlintStats;

GLINT_API void glint_scene_stats(const GlintScene *scene, GlintStats *stats);

/* ---------------------------------------------------------------- checks */

/* What a finding is an instance of. docs/check.md has an example of each. */
typedef struct GlintRule {
    const char *name; /* "light-inside-solid": never changes its meaning */
    GlintSeverity severity;
    const char *summary; /* what is found: one sentence, with its full stop */
    const char *help;    /* why it is told, and what to do: sentences */
} GlintRule;

/* The rule at an index from 0 on, those of errors first. False behind the last. All texts live as
 * long as the program. */
GLINT_API bool glint_rule_at(int index, GlintRule *rule);

/* Looks for what is legal in a committed scene but surely a mistake, and reports it through the
 * scene's diagnostic callback, on this thread, in the order of the file: warnings and notes, never
 * errors. Load the scene with keep_sources, or findings have no place. Of each rule the first ten
 * findings are told and the others counted, in one more without a place. For some rules a few small
 * pictures are drawn. Takes
 * milliseconds, with a hundred thousand surfaces a second or two. Not while the scene is drawn.
 * monitor may be null. Errors: ARGUMENT (the scene is not committed), MEMORY, THREAD, CANCELLED. */
GLINT_API GlintStatus glint_scene_check(
    GlintScene *scene, const GlintMonitor *monitor, GlintError *error);

/* ---------------------------------------------------------------- pictures */

typedef struct GlintImage {
    int width, height;
    const float *pixels; /* width * height * 3, as glint_render left them */
} GlintImage;

/* Further values of every pixel, for formats that have room for them (EXR). They are written as
 * they are. The channels of a layer are called "name.X", "name.Y" and so on. */
typedef struct GlintLayer {
    const char *name;       /* letters, digits, '.', '_', '-', a letter first; at most 28 */
    const char *components; /* one letter each, 1 to 4: "XYZ", "RGB", "Z" */
    const float *pixels;    /* width * height * components, top row first */
} GlintLayer;

/* What it takes to draw a picture once more. */
typedef struct GlintRecipeFile {
    GlintFileKind kind;
    const char *name; /* as in GlintSceneFile; characters below 32 are question marks */
    uint64_t size, digest;
    const void *bytes; /* the content; null when it is not embedded */
} GlintRecipeFile;

typedef struct GlintRecipe {
    char version[32];     /* of the program that drew it */
    GlintDialect dialect; /* the one in force */
    int width, height;    /* of the whole picture; crop_... is the part that was drawn */
    int crop_x, crop_y, crop_width, crop_height;
    int samples, light; /* as in GlintRenderDesc */
    GlintSampling sampling;
    GlintMistakes mistakes;       /* with TRANSFORMS_REVERSED, which a scene's desc asks for */
    bool has_pixels;              /* of a picture that was finished */
    uint64_t pixels;              /* CRC-64/XZ of its 8-bit values, top row first */
    const GlintRecipeFile *files; /* the scene's own first; none of a scene built by calls */
    int file_count;
} GlintRecipe;

typedef struct GlintSaveDesc {
    const char *title; /* text "Title" of the file, normally the scene's name; null: none */
    int thread_count;  /* 0 (default): one per core */
    const GlintMonitor *monitor; /* null */
    const GlintLayer *layers;    /* null; refused unless the format is EXR */
    int layer_count;             /* 0 to 256 */
    const GlintRecipe *recipe;   /* text "Glint" of a PNG, with the files that it embeds; null:
                                  * none, but glint_render_save makes one without files */
    int cookie;
} GlintSaveDesc;

GLINT_API GlintSaveDesc glint_save_desc_default(void);

/* Writes path, in the format of its extension: .png (8 bits, gamma 2.2), .pfm (linear float) or
 * .exr (linear float, compressed, with layers; by a module that may be missing). The file appears
 * whole or not at all: it is written under a temporary name, then renamed. Errors: ARGUMENT
 * (extension, layers), FILE (also a missing module), MEMORY, CANCELLED. */
GLINT_API GlintStatus glint_image_save(
    const GlintImage *image, const char *path, const GlintSaveDesc *desc, GlintError *error);

/* Draws and writes path: what glint_render, glint_scene_recipe without files (unless save has a
 * recipe, or desc a camera) and glint_image_save would write, to the byte. A
 * PNG is encoded while it is drawn, and its pixels need no memory beyond what is under way. Both
 * descs count, but for save's thread_count: the scene's threads do it. One call at a time per
 * scene. Errors: ARGUMENT, FILE, MEMORY, THREAD, CANCELLED (nothing is then written). */
GLINT_API GlintStatus glint_render_save(GlintScene *scene, const GlintRenderDesc *desc,
    const char *path, const GlintSaveDesc *save, GlintError *error);

/* Whether there is a format for this name and Glint can write it; a question to ask before drawing.
 * Nothing is written. Errors: ARGUMENT (extension), FILE (a missing module). */
GLINT_API GlintStatus glint_image_check_path(const char *path, GlintError *error);

/* Encodes a PNG and hands its bytes to sink, in order. sink returns false to stop
 * (GLINT_ERROR_FILE). */
typedef bool (*GlintSinkFn)(void *user, const void *bytes, size_t size);
GLINT_API GlintStatus glint_image_encode_png(const GlintImage *image, const GlintSaveDesc *desc,
    GlintSinkFn sink, void *user, GlintError *error);

/* The recipe of what glint_render would draw now, to be destroyed by the caller. with_files: with
 * the content of the scene and of all files that it names, for which it must have been loaded with
 * keep_sources. Errors: ARGUMENT (also a desc with a camera, or that shows something else than the
 * picture: neither has a recipe), FILE (a file has changed since, or cannot be read), MEMORY. */
GLINT_API GlintStatus glint_scene_recipe(const GlintScene *scene, const GlintRenderDesc *desc,
    bool with_files, GlintRecipe **recipe, GlintError *error);

/* The recipe in a PNG. Errors: ARGUMENT, FILE (also when there is none, or this version does not
 * understand it), MEMORY. */
GLINT_API GlintStatus glint_recipe_load(const char *path, GlintRecipe **recipe, GlintError *error);

/* Null is allowed. */
GLINT_API void glint_recipe_destroy(GlintRecipe *recipe);

/* The recipe as the lines that stand in a PNG. Like snprintf: at most size bytes are written,
 * zero-terminated when size > 0; returns the length without the cut. */
GLINT_API size_t glint_recipe_format(const GlintRecipe *recipe, char *buffer, size_t size);

/* CRC-64/XZ of the 8-bit values of a picture: of linear pixels as a PNG would hold them, and of a
 * PNG or JPEG file as it is. Errors: ARGUMENT, FILE, MEMORY. */
GLINT_API GlintStatus glint_image_digest(
    const GlintImage *image, uint64_t *digest, GlintError *error);
GLINT_API GlintStatus glint_picture_digest(const char *path, uint64_t *digest, GlintError *error);

/* Reads a picture: .png and .jpeg (any kind of pixels; 8 bits count, transparency does not), .pfm,
 * .exr (stored in rows; R, G and B or Y). The first bytes of the file tell the format. 8-bit values
 * become the linear ones that glint_image_save writes as the same values again. image->pixels is
 * freed with glint_image_free. Errors: ARGUMENT, FILE (also a missing module), MEMORY. */
GLINT_API GlintStatus glint_image_load(const char *path, GlintImage *image, GlintError *error);
GLINT_API void glint_image_free(GlintImage *image); /* of glint_image_load; all zero is allowed */

/* The 8-bit values that the PNG would hold: width * height * 3 bytes. */
GLINT_API void glint_image_to_rgb8(const GlintImage *image, uint8_t *rgb);

/* ---------------------------------------------------------------- what a scene file may hold */

/* What stands in an element: a value, or, from GLINT_ELEMENT_SCENE on, other elements. */
typedef enum GlintElementKind {
    GLINT_ELEMENT_NUMBER,
    GLINT_ELEMENT_WHOLE_NUMBER,
    GLINT_ELEMENT_IMAGE_SIZE, /* two whole numbers */
    GLINT_ELEMENT_VECTOR,     /* three numbers, like the next two */
    GLINT_ELEMENT_POINT,
    GLINT_ELEMENT_COLOR,
    GLINT_ELEMENT_WORD, /* one of choices */
    GLINT_ELEMENT_TEXT,
    GLINT_ELEMENT_SCENE,
    GLINT_ELEMENT_CAMERA,
    GLINT_ELEMENT_SURFACE,
    GLINT_ELEMENT_SHADER,
    GLINT_ELEMENT_BSDF,
    GLINT_ELEMENT_BRDF,
    GLINT_ELEMENT_TEXTURE,
    GLINT_ELEMENT_LIGHT,
    GLINT_ELEMENT_ENVIRONMENT,
    GLINT_ELEMENT_INTEGRATOR
} GlintElementKind;

typedef enum GlintElementRange {
    GLINT_RANGE_ANY,
    GLINT_RANGE_POSITIVE,
    GLINT_RANGE_SAMPLES,  /* 0 to 65536 */
    GLINT_RANGE_NOT_ZERO, /* the vector has a length */
    GLINT_RANGE_NO_ZEROS, /* nor has it a component that is zero */
    GLINT_RANGE_ANGLE,    /* between 0 and 180, both excluded */
    GLINT_RANGE_BIT,      /* 0 or 1 */
    GLINT_RANGE_DEPTH,    /* 1 to 4096 */
    GLINT_RANGE_PIXELS    /* each at least 1, together at most 2^28 */
} GlintElementRange;

/* An element in the places where it means the same. One of the same name may follow that stands
 * elsewhere, or has another default there. */
typedef struct GlintElement {
    const char *name; /* files may write it in any case */
    GlintElementKind kind;
    GlintElementRange range;
    bool required;            /* an object that it may stand in needs it; the scene does not */
    const char *default_text; /* null: there is none */
    const char *example;      /* of a value; null for what holds elements */
    const char *choices;      /* of a word: all there are, separated by blanks; else null */
    const char *alias_of;     /* null, or the element that it is another word for */
    const char *default_type; /* the type that is meant when the file says none; null: it must */
    const char *years;        /* dialects that it was made for, separated by blanks; null: all */
    const char *help;         /* a phrase */
} GlintElement;

/* A type of the elements of a kind. */
typedef struct GlintElementType {
    const char *name; /* exactly so */
    GlintElementKind kind;
    const char *alias_of; /* null, or the type that it is another word for */
    const char *years;    /* as above */
    const char *help;
} GlintElementType;

/* The element or type at an index from 0 on; element 0 is the scene. False behind the last. All
 * texts live as long as the program. */
GLINT_API bool glint_element_at(int index, GlintElement *element);
GLINT_API bool glint_element_type_at(int index, GlintElementType *type);

/* Whether the element at an index may stand in one of the type at another; type -1: in the scene
 * itself. */
GLINT_API bool glint_element_fits(int element, int type);

/* "a number", "a surface"; "greater than 0", null for ANY. */
GLINT_API const char *glint_element_kind_text(GlintElementKind kind);
GLINT_API const char *glint_element_range_text(GlintElementRange range);

/* ---------------------------------------------------------------- scene files as text */

typedef struct GlintFormatDesc {
    const GlintAllocator *allocator; /* null (default): the C library's */
    GlintDiagnosticFn diagnostic;    /* what is wrong with the file; null (default): only *error */
    void *diagnostic_user;
    int cookie;
} GlintFormatDesc;

GLINT_API GlintFormatDesc glint_format_desc_default(void);

/* Lays a scene file out as docs/format-tools.md says and hands the bytes, UTF-8, to sink. Comments
 * and the spelling of numbers stay as they are, and so does all that the file means. Laid out
 * again it does not change. The files that the scene names are not opened. name stands for the path
 * in messages. Nothing is handed out unless the file is a good scene. Any number of threads may
 * call it. Errors: ARGUMENT, SCENE, FILE (sink returned false), MEMORY. */
GLINT_API GlintStatus glint_format(const void *bytes, size_t size, const char *name,
    const GlintFormatDesc *desc, GlintSinkFn sink, void *user, GlintError *error);

/* ---- upgrading */

typedef enum GlintChangeKind {
    GLINT_CHANGE_SAME,     /* written otherwise, and the picture is the same to the last bit */
    GLINT_CHANGE_ROUNDING, /* the same but for the last digits */
    GLINT_CHANGE_DIFFERENT /* the rules have no counterpart: pixels may differ */
} GlintChangeKind;

typedef struct GlintChange {
    GlintChangeKind kind;
    int64_t line, column; /* in the old text, from 1 */
    const char *message;  /* what changes, and why */
} GlintChange;

typedef void (*GlintChangeFn)(void *user, const GlintChange *change);

typedef struct GlintUpgradeDesc {
    GlintDialect dialect; /* of the old text; AUTO (default): what it says or shows */
    GlintChangeFn change; /* each change, in the order of the text; null (default): none is told */
    void *change_user;
    const GlintAllocator *allocator; /* null (default): the C library's */
    GlintDiagnosticFn diagnostic;    /* as of GlintFormatDesc */
    void *diagnostic_user;
    int cookie;
} GlintUpgradeDesc;

GLINT_API GlintUpgradeDesc glint_upgrade_desc_default(void);

/* Rewrites a scene of any dialect by the rules of `glint` so that it draws the same picture, and
 * hands the bytes, UTF-8, to sink. What the rules do not allow is told as GLINT_CHANGE_DIFFERENT; a
 * scene of which no change but GLINT_CHANGE_SAME is told draws the same bits. Only what has to
 * change is touched: comments, layout and numbers stay. docs/format-tools.md lists what is done.
 * *dialect, when not null, becomes the old text's. The rest is as with glint_format. */
GLINT_API GlintStatus glint_upgrade(const void *bytes, size_t size, const char *name,
    const GlintUpgradeDesc *desc, GlintSinkFn sink, void *user, GlintDialect *dialect,
    GlintError *error);

/* Writes a file whole or not at all: under a temporary name that is then changed to path. A file
 * that is replaced keeps its permissions, a link its place. Errors: ARGUMENT, FILE, MEMORY. */
GLINT_API GlintStatus glint_file_save(
    const char *path, const void *bytes, size_t size, GlintError *error);
/* ---------------------------------------------------------------- comparing and grading */

typedef struct GlintCompareDesc {
    int tolerance; /* a pixel differs when a channel is apart by more, of 255; 0 to 255; 2 */
    /* How large pixels are to the eye: 67.02 (default) is a screen 3840 pixels wide, seen from as
     * far as it is wide. 1 to 1000. */
    double pixels_per_degree;
    bool flip;         /* true (default); false: GlintComparison.flip is not worked out, and 0 */
    float *flip_map;   /* null, or where to put the FLIP error of each pixel: width * height */
    float *difference; /* null, or where to put a picture, width * height * 3 linear values, whose
                          8-bit values are 8 times as large as the differences */
    int cookie;
} GlintCompareDesc;

GLINT_API GlintCompareDesc glint_compare_desc_default(void);

/* Of the 8-bit values that glint_image_to_rgb8 gives, but for relative. */
typedef struct GlintComparison {
    int max;         /* the largest difference of a channel, 0 to 255 */
    double mean;     /* of all channels' differences */
    double percent;  /* of the pixels with a channel that differs by more than the tolerance */
    double relative; /* mean difference of linear values over the mean of the reference's */
    double flip;     /* mean FLIP error, 0 to 1: how far apart they look (Andersson et al. 2020) */
} GlintComparison;

/* Compares a picture with the reference, which is of the same size. Errors: ARGUMENT (also two
 * sizes), MEMORY. */
GLINT_API GlintStatus glint_image_compare(const GlintImage *image, const GlintImage *reference,
    const GlintCompareDesc *desc, GlintComparison *comparison, GlintError *error);

/* One or two mistakes that were tried, and what they explain: 1 minus the sum of the differences
 * beyond the tolerance that are left, over that of the picture without mistakes. */
typedef struct GlintHypothesis {
    GlintMistakes mistakes;
    double explains; /* 1: all; 0 or less: nothing */
} GlintHypothesis;

typedef enum GlintVerdict {
    GLINT_VERDICT_SAME,      /* all 8-bit values are equal */
    GLINT_VERDICT_ROUNDING,  /* none differs by more than the tolerance, or isolated pixels do, and
                                no mistake explains these */
    GLINT_VERDICT_EXPLAINED, /* the first hypothesis explains the difference, and no other does */
    GLINT_VERDICT_UNCLEAR    /* none explains most of it, or several do about equally well */
} GlintVerdict;

/* "same", "rounding", "explained", "unclear"; null out of range. */
GLINT_API const char *glint_verdict_name(GlintVerdict verdict);

enum { GLINT_HYPOTHESIS_LIMIT = 8 };

typedef struct GlintGrade {
    GlintVerdict verdict;
    GlintComparison comparison; /* with the right picture */
    /* What explains most, best first. ROUNDING: TRUNCATED where that explains it. UNCLEAR: the
     * first `rivals` of them are about equally good. */
    GlintHypothesis hypotheses[GLINT_HYPOTHESIS_LIMIT];
    int hypothesis_count, rivals;
    int tried, pairs_tried; /* mistakes, and pairs of them */
    bool from_scene;        /* false: the reference is a picture, so mistakes of a finished
                               picture alone were tried */
    bool size_differs;      /* the picture has not the size it should have; then all the rest is
                               about a right picture of its size */
    int width, height;      /* as it should be */
    GlintImage reference;   /* the right picture, at the size of the picture; to be freed with
                               glint_image_free */
} GlintGrade;

typedef struct GlintGradeDesc {
    GlintSceneDesc scene; /* for the scene, when the reference is one */
    GlintCompareDesc compare;
    int width, height;           /* of the picture that was asked for; 0 (default): the scene's */
    int samples;                 /* likewise */
    bool pairs;                  /* true (default); false: one mistake at a time */
    const GlintMonitor *monitor; /* null; the fraction is of GLINT_PHASE_TRACE */
    int cookie;
} GlintGradeDesc;

GLINT_API GlintGradeDesc glint_grade_desc_default(void);

/* Finds out how a picture differs from what it should be and which mistake, or which two, explain
 * it, by drawing the scene with each of them. reference is a scene, or a picture (.png, .jpg,
 * .jpeg, .pfm, .exr). Errors: ARGUMENT, FILE, SCENE, MEMORY, THREAD, CANCELLED. */
GLINT_API GlintStatus glint_grade(const GlintImage *image, const char *reference,
    const GlintGradeDesc *desc, GlintGrade *grade, GlintError *error);

/* What was found, in one sentence without a full stop: "shadows are missing (no-shadows): explains
 * 97 % of the difference". At most size bytes are written, always zero-terminated when size > 0.
 * Returns the length without the cut. */
GLINT_API size_t glint_grade_format(const GlintGrade *grade, char *buffer, size_t size);

/* The same of the mistakes of one hypothesis. */
GLINT_API size_t glint_hypothesis_format(
    const GlintHypothesis *hypothesis, char *buffer, size_t size);

#ifdef __cplusplus
}
#endif
