/* SPDX-License-Identifier: MIT
 * The model: plain arrays and integer references. It is filled by the reader or by public calls,
 * checked here, and never changed after commit. Elements have no destructor: gi_scene_reset frees
 * the arrays.
 *
 * A value is checked where it enters: the gi_scene_check_ functions return null or one sentence
 * that names the fault, and the caller adds the place (a line of a file, or a field of a desc). */
#pragma once

#include "base/array.h"
#include "light/environment.h"
#include "mesh/mesh.h"
#include "scene/dialect.h"
#include "shape/shape.h"
#include "texture/texture.h"

typedef struct GiCamera {
    GlintCameraType type;
    GiVec view_point, view_direction, view_up;
    GiVec projection_normal; /* zero: opposite to view_direction */
    double projection_distance, view_width, view_height;
} GiCamera;

/* Indices into the scene's arrays that may point nowhere. */
#define GI_NONE UINT32_MAX

typedef struct GiShader {
    GlintShaderType type;
    bool diffuse_given;      /* otherwise the dialect's default is put in at commit */
    GiVec diffuse, specular; /* specular: of microfacet shaders the microfacetColor */
    GiVec mirror;            /* mirrorCoefficient */
    double exponent;
    double roughness;   /* alpha */
    double index;       /* of refraction */
    uint32_t texture;   /* in the place of diffuse, or GI_NONE */
    uint32_t substrate; /* a shader that exists already, or GI_NONE; Glazed has one */
} GiShader;

typedef struct GiLight {
    GlintLightType type;
    GlintFalloff falloff;
    GiVec position, intensity;
    GiVec direction;      /* directional: toward the light; rectangle: its front */
    GiVec up;             /* rectangle */
    double width, height; /* rectangle */
} GiLight;

/* A mesh as a surface. */
typedef struct GiMeshSurface {
    uint32_t mesh;
    GiShapeInfo info;
} GiMeshSurface;

/* An image may be shared by textures that wrap it differently. */
typedef struct GiTexture {
    uint32_t picture;
    GiWrap wrap;
} GiTexture;

typedef enum GiTransformStepKind {
    GI_STEP_TRANSLATE,
    GI_STEP_ROTATE, /* degrees about x, y, z */
    GI_STEP_SCALE,
    GI_STEP_MATRIX /* value.x is an index into matrices */
} GiTransformStepKind;

typedef struct GiTransformStep {
    GiTransformStepKind kind;
    GiVec value;
} GiTransformStep;

/* Its children are drawn under the product of its steps. */
typedef struct GiGroup {
    GI_ARRAY(GiTransformStep) steps;
    GI_ARRAY(GiShapeRef) children;
    bool nests; /* some child is a group */
} GiGroup;

/* A file that the scene is made of. The text is an offset into file_names: the name by which the
 * scene calls it, and behind that name's zero the path by which it was opened. */
typedef struct GiSceneFile {
    GlintFileKind kind;
    uint32_t name, path;
    uint64_t size, digest; /* of the content; 0 of what is not a regular file */
} GiSceneFile;

typedef GI_ARRAY(GiShapeInfo) GiShapeInfos;

typedef struct GiScene {
    GiMemory *memory;
    GlintDialect dialect;    /* AUTO until known */
    bool reverse_transforms; /* a mistake: groups turn round what the dialect says */
    bool has_image, has_camera;
    int width, height, samples;
    GiVec back_color;
    double exposure;
    GiCamera camera;
    GI_ARRAY(GiShader) shaders; /* [0]: Lambertian with all defaults */
    GI_ARRAY(GiLight) lights;
    GI_ARRAY(GiSphere) spheres;
    GI_ARRAY(GiBox) boxes;
    GI_ARRAY(GiCone) cones;
    GI_ARRAY(GiDisc) discs;
    GI_ARRAY(GiPlane) planes;
    GiMeshStore meshes;
    GI_ARRAY(GiMeshSurface) mesh_surfaces;
    GI_ARRAY(GiPicture) pictures;
    GI_ARRAY(GiTexture) textures;
    GiEnvironment environment;
    GlintIntegrator integrator;
    int max_depth;                          /* of the path integrator: surfaces a path may meet */
    GiShapeInfos info[GI_SHAPE_KIND_COUNT]; /* parallel to the arrays above */
    uint32_t shape_count;                   /* of all kinds; the next order */
    GI_ARRAY(GiGroup) groups;
    GI_ARRAY(GiSceneFile) files; /* [0]: the scene's own, when it was loaded */
    GI_ARRAY(char) file_names;
    GI_ARRAY(GiAffine) matrices;
    GI_ARRAY(GiShapeRef) roots; /* what stands directly in the scene, in document order */
} GiScene;

/* False when memory is short; the scene can be reset all the same. */
bool gi_scene_init(GiScene *scene, GiMemory *memory);
void gi_scene_reset(GiScene *scene);

GiCamera gi_camera_default(void);
GiShader gi_shader_default(void);
GiLight gi_light_default(void);

#define GI_IMAGE_PIXEL_LIMIT (1 << 28)
#define GI_SAMPLES_LIMIT     65536
#define GI_SUBSTRATE_LIMIT   8 /* Glazed on Glazed on ... */
#define GI_PATH_LIMIT        4096

/* ---- checks: null, or what is wrong */
const char *gi_scene_check_image_size(double width, double height);
const char *gi_scene_check_camera(const GiCamera *camera);
const char *gi_scene_check_cone(double center_z, double tip_z);
/* A rectangle light's directions; they have a length. */
const char *gi_scene_check_light(const GiLight *light);
/* Whether a shader can be glazed. */
const char *gi_scene_check_substrate(const GiScene *scene, uint32_t substrate);

/* The apex of a cone given by its full opening angle (0 < theta < 180). */
double gi_scene_cone_tip(double center_z, double radius, double theta_degrees);

/* ---- adding; the values have passed the checks. Each gives the ref of the new shape, which is not
 * yet placed anywhere. False when memory is short or a kind has 2^28 shapes. */
bool gi_scene_add_sphere(
    GiScene *scene, GiVec center, double radius, uint32_t shader, GiShapeRef *ref);
bool gi_scene_add_box(GiScene *scene, GiVec a, GiVec b, uint32_t shader, GiShapeRef *ref);
bool gi_scene_add_cylinder(
    GiScene *scene, GiVec center, double radius, double height, uint32_t shader, GiShapeRef *ref);
bool gi_scene_add_cone(GiScene *scene, GiVec center, double radius, double height, double tip_z,
    uint32_t shader, GiShapeRef *ref);
bool gi_scene_add_disc(
    GiScene *scene, GiVec center, GiVec normal, double radius, uint32_t shader, GiShapeRef *ref);
bool gi_scene_add_plane(
    GiScene *scene, GiVec point, GiVec normal, uint32_t shader, GiShapeRef *ref);
bool gi_scene_add_mesh_surface(GiScene *scene, uint32_t mesh, uint32_t shader, GiShapeRef *ref);
bool gi_scene_add_group(GiScene *scene, GiShapeRef *ref);

/* Notes a file; its digest is the caller's to fill. Null when memory is short. */
GiSceneFile *gi_scene_add_file(
    GiScene *scene, GlintFileKind kind, const char *name, const char *path);

/* Appends a step to a group's transform (value; or matrix for GI_STEP_MATRIX). */
bool gi_scene_add_step(GiScene *scene, uint32_t group, GiTransformStepKind kind, GiVec value);
bool gi_scene_add_matrix(GiScene *scene, uint32_t group, const GiAffine *matrix);

/* Places a shape or group in a group (its index), or directly in the scene (GI_SHAPE_NONE). The
 * same ref may be placed any number of times. The caller sees to it that no group contains itself:
 * the reader places a group when it has been closed, the public calls ask
 * gi_scene_group_contains. */
bool gi_scene_place(GiScene *scene, uint32_t group, GiShapeRef ref);

/* Whether a group is the inner one or contains it, at any depth. False when memory is short. */
bool gi_scene_group_contains(const GiScene *scene, uint32_t group, uint32_t inner, bool *contains);

/* The matrix of a group's steps under the rules. False when it is singular or not finite. */
bool gi_scene_group_matrix(
    const GiScene *scene, const GiGroup *group, const GiRules *rules, GiAffine *matrix);
