/* SPDX-License-Identifier: MIT
 * The public functions that build a scene by calls: each checks its desc and copies it. */
#include "glint/glint.h"

#include "base/assert.h"
#include "base/cookie.h"
#include "glint_scene.h"

#include <limits.h>
#include <string.h>

/* ---------------------------------------------------------------- defaults and checks */

GlintImageDesc glint_image_desc_default(void) {
    return (GlintImageDesc){
        .width = 512,
        .height = 512,
        .samples = 1,
        .exposure = 1,
        .max_depth = 12,
        .cookie = GI_COOKIE,
    };
}

GlintCameraDesc glint_camera_desc_default(void) {
    return (GlintCameraDesc){
        .view_direction = {0, 0, -1},
        .view_up = {0, 1, 0},
        .projection_distance = 1,
        .view_width = 1,
        .view_height = 1,
        .cookie = GI_COOKIE,
    };
}

GlintShaderDesc glint_shader_desc_default(void) {
    return (GlintShaderDesc){.diffuse_color = {1, 1, 1},
        .specular_color = {1, 1, 1},
        .exponent = 1,
        .roughness = 0.5,
        .refractive_index = 1.5,
        .cookie = GI_COOKIE};
}

GlintLightDesc glint_light_desc_default(void) {
    return (GlintLightDesc){.intensity = {1, 1, 1},
        .direction = {0, 0, -1},
        .up = {0, 1, 0},
        .width = 1,
        .height = 1,
        .cookie = GI_COOKIE};
}

GlintSurfaceDesc glint_surface_desc_default(GlintSurfaceType type) {
    return (GlintSurfaceDesc){
        .type = type,
        .radius = 1,
        .height = 1,
        .normal = {0, 0, 1},
        .transform = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
        .cookie = GI_COOKIE,
    };
}

/* What every building call checks first. */
static GlintStatus check_open(
    const GlintScene *scene, const void *desc, int cookie, const char *made_by, GlintError *error) {
    if (scene == NULL || desc == NULL) return ARGUMENT(error, "scene or desc is null");
    if (cookie != GI_COOKIE) return ARGUMENT(error, "the desc was not made by %s", made_by);
    if (scene->committed) return ARGUMENT(error, "the scene is committed already");
    if (scene->broken) return ARGUMENT(error, "the scene failed to load");
    return GLINT_OK;
}

#define CHECK_OPEN(scene, desc, made_by, error)                                                    \
    do {                                                                                           \
        GlintStatus status_ =                                                                      \
            check_open(scene, desc, (desc) != NULL ? (desc)->cookie : 0, made_by, error);          \
        if (status_ != GLINT_OK) return status_;                                                   \
    } while (0)

GlintStatus glint_scene_set_image(
    GlintScene *scene, const GlintImageDesc *desc, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_image_desc_default", error);
    const char *fault = gi_scene_check_image_size(desc->width, desc->height);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    if (desc->samples < 1 || desc->samples > GI_SAMPLES_LIMIT) {
        return ARGUMENT(error, "samples must be from 1 to %d", GI_SAMPLES_LIMIT);
    }
    if (!is_finite3(desc->back_color)) return ARGUMENT(error, "back_color is not finite");
    if (!isfinite(desc->exposure)) return ARGUMENT(error, "exposure is not finite");
    if ((unsigned)desc->integrator > GLINT_INTEGRATOR_PATH) {
        return ARGUMENT(error, "no such integrator");
    }
    if (desc->max_depth < 1 || desc->max_depth > GI_PATH_LIMIT) {
        return ARGUMENT(error, "max_depth must be from 1 to %d", GI_PATH_LIMIT);
    }
    GiScene *model = &scene->model;
    model->has_image = true;
    model->width = desc->width;
    model->height = desc->height;
    model->samples = desc->samples;
    model->back_color = gi_vec_from(desc->back_color);
    model->exposure = desc->exposure > 0 ? desc->exposure : 1;
    model->integrator = desc->integrator;
    model->max_depth = desc->max_depth;
    return GLINT_OK;
}

static bool is_positive(double value) { return value > 0 && isfinite(value); }

static const char *check_camera(const GlintCameraDesc *desc) {
    if ((unsigned)desc->type > GLINT_CAMERA_PARALLEL) return "no such camera type";
    if (!is_finite3(desc->view_point)) return "view_point is not finite";
    if (!is_finite3(desc->view_direction)) return "view_direction is not finite";
    if (is_zero3(desc->view_direction)) return "view_direction has no length";
    if (!is_finite3(desc->view_up)) return "view_up is not finite";
    if (is_zero3(desc->view_up)) return "view_up has no length";
    if (!is_finite3(desc->projection_normal)) return "projection_normal is not finite";
    if (!is_positive(desc->projection_distance)) {
        return "projection_distance must be positive and finite";
    }
    if (!is_positive(desc->view_width)) return "view_width must be positive and finite";
    if (!is_positive(desc->view_height)) return "view_height must be positive and finite";
    return NULL;
}

GlintStatus gi_glint_camera(const GlintCameraDesc *desc, GiCamera *camera, GlintError *error) {
    if (desc->cookie != GI_COOKIE) {
        return ARGUMENT(error, "the desc was not made by glint_camera_desc_default");
    }
    const char *fault = check_camera(desc);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    *camera = (GiCamera){
        .type = desc->type,
        .view_point = gi_vec_from(desc->view_point),
        .view_direction = gi_vec_from(desc->view_direction),
        .view_up = gi_vec_from(desc->view_up),
        .projection_normal = gi_vec_from(desc->projection_normal),
        .projection_distance = desc->projection_distance,
        .view_width = desc->view_width,
        .view_height = desc->view_height,
    };
    /* What is left is a matter of two vectors; the model's check names them as files do. */
    if (gi_scene_check_camera(camera) != NULL) {
        return ARGUMENT(error, "view_up is parallel to the projection normal");
    }
    return GLINT_OK;
}

GlintStatus glint_scene_set_camera(
    GlintScene *scene, const GlintCameraDesc *desc, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_camera_desc_default", error);
    GiCamera camera;
    GlintStatus status = gi_glint_camera(desc, &camera, error);
    if (status != GLINT_OK) return status;
    scene->model.camera = camera;
    scene->model.has_camera = true;
    return GLINT_OK;
}

static void store3(double to[3], GiVec v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

bool glint_scene_camera(const GlintScene *scene, GlintCameraDesc *desc) {
    GI_ASSERT(scene != NULL && desc != NULL);
    const GiCamera *camera = &scene->model.camera;
    if (!scene->model.has_camera) return false;
    *desc = glint_camera_desc_default();
    desc->type = camera->type;
    store3(desc->view_point, camera->view_point);
    store3(desc->view_direction, camera->view_direction);
    store3(desc->view_up, camera->view_up);
    store3(desc->projection_normal, camera->projection_normal);
    desc->projection_distance = camera->projection_distance;
    desc->view_width = camera->view_width;
    desc->view_height = camera->view_height;
    return true;
}

GlintStatus glint_camera_ray(
    const GlintCameraDesc *desc, double a, double b, GlintRay *ray, GlintError *error) {
    if (desc == NULL || ray == NULL) return ARGUMENT(error, "camera or ray is null");
    GiCamera camera;
    GlintStatus status = gi_glint_camera(desc, &camera, error);
    if (status != GLINT_OK) return status;
    GiView view = gi_view_of(&camera);
    GiVec origin, direction;
    gi_view_ray(&view, a, b, &origin, &direction);
    *ray = (GlintRay){.t_min = 0, .t_max = INFINITY};
    store3(ray->origin, origin);
    store3(ray->direction, direction);
    return GLINT_OK;
}

/* ---------------------------------------------------------------- lights */

static const char *check_light(const GlintLightDesc *desc) {
    if ((unsigned)desc->type > GLINT_LIGHT_RECTANGLE) return "no such light type";
    if ((unsigned)desc->falloff > GLINT_FALLOFF_INVERSE_SQUARE) return "no such falloff";
    if (!is_finite3(desc->position)) return "position is not finite";
    if (!is_finite3(desc->intensity)) return "intensity is not finite";
    if (!is_finite3(desc->direction)) return "direction is not finite";
    if (is_zero3(desc->direction)) return "direction has no length";
    if (!is_finite3(desc->up)) return "up is not finite";
    if (is_zero3(desc->up)) return "up has no length";
    if (!is_positive(desc->width)) return "width must be positive and finite";
    if (!is_positive(desc->height)) return "height must be positive and finite";
    return NULL;
}

GlintStatus glint_scene_add_light(
    GlintScene *scene, const GlintLightDesc *desc, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_light_desc_default", error);
    const char *fault = check_light(desc);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    GiLight light = {
        .type = desc->type,
        .falloff = desc->falloff,
        .position = gi_vec_from(desc->position),
        .intensity = gi_vec_from(desc->intensity),
        .direction = gi_vec_from(desc->direction),
        .up = gi_vec_from(desc->up),
        .width = desc->width,
        .height = desc->height,
    };
    if (light.type == GLINT_LIGHT_RECTANGLE && gi_scene_check_light(&light) != NULL) {
        return ARGUMENT(error, "up is parallel to direction");
    }
    return gi_array_push(&scene->memory, &scene->model.lights, light) ? GLINT_OK
                                                                      : gi_error_memory(error);
}

static bool is_path(const char *path, GlintError *error) {
    if (path != NULL) return true;
    ARGUMENT(error, "path is null");
    return false;
}

GlintStatus glint_scene_load_environment(
    GlintScene *scene, const char *path, double scale, GlintError *error) {
    GlintStatus status = check_open(scene, scene, GI_COOKIE, "", error);
    if (status != GLINT_OK) return status;
    if (!is_path(path, error)) return GLINT_ERROR_ARGUMENT;
    if (!isfinite(scale)) return ARGUMENT(error, "scale is not finite");
    GiEnvironment environment;
    status = gi_environment_load(&environment, &scene->memory, path, scale, error);
    if (status != GLINT_OK) return status;
    gi_environment_free(&scene->model.environment, &scene->memory);
    scene->model.environment = environment;
    return GLINT_OK;
}

/* ---------------------------------------------------------------- textures and shaders */

GlintTextureDesc glint_texture_desc_default(void) {
    return (GlintTextureDesc){.wrap = GLINT_WRAP_REPEAT, .cookie = GI_COOKIE};
}

/* Takes the picture, also when it fails. */
static GlintStatus add_texture(
    GlintScene *scene, GiPicture picture, GlintWrap wrap, GlintTextureId *id, GlintError *error) {
    GiScene *model = &scene->model;
    GiTexture texture = {
        (uint32_t)model->pictures.count, wrap == GLINT_WRAP_CLAMP ? GI_WRAP_CLAMP : GI_WRAP_REPEAT};
    if (!gi_array_reserve(&scene->memory, &model->textures, 1) ||
        !gi_array_push(&scene->memory, &model->pictures, picture)) {
        gi_picture_free(&picture, &scene->memory);
        return gi_error_memory(error);
    }
    model->textures.data[model->textures.count++] = texture;
    if (id != NULL) id->index1 = (uint32_t)model->textures.count;
    return GLINT_OK;
}

GlintStatus glint_scene_add_texture(
    GlintScene *scene, const GlintTextureDesc *desc, GlintTextureId *id, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_texture_desc_default", error);
    if ((unsigned)desc->wrap > GLINT_WRAP_CLAMP) return ARGUMENT(error, "no such wrap");
    if (desc->rgb == NULL) return ARGUMENT(error, "rgb is null");
    if (desc->width < 1 || desc->height < 1) {
        return ARGUMENT(error, "width and height must be positive");
    }
    size_t size = (size_t)desc->width * (size_t)desc->height;
    if (size > GI_IMAGE_PIXEL_LIMIT) return ARGUMENT(error, "width x height exceeds 2^28 pixels");
    size *= 3;
    GiPicture picture = {desc->width, desc->height, gi_memory_allocate(&scene->memory, size)};
    if (picture.rgb == NULL) return gi_error_memory(error);
    memcpy(picture.rgb, desc->rgb, size);
    return add_texture(scene, picture, desc->wrap, id, error);
}

GlintStatus glint_scene_load_texture(
    GlintScene *scene, const char *path, GlintWrap wrap, GlintTextureId *id, GlintError *error) {
    GlintStatus status = check_open(scene, scene, GI_COOKIE, "", error);
    if (status != GLINT_OK) return status;
    if (!is_path(path, error)) return GLINT_ERROR_ARGUMENT;
    if ((unsigned)wrap > GLINT_WRAP_CLAMP) return ARGUMENT(error, "no such wrap");
    GiPicture picture;
    status = gi_picture_load(&picture, &scene->memory, path, error);
    return status == GLINT_OK ? add_texture(scene, picture, wrap, id, error) : status;
}

static const char *check_shader(const GiScene *model, const GlintShaderDesc *desc) {
    if ((unsigned)desc->type > GLINT_SHADER_COOK_TORRANCE) return "no such shader type";
    if (!is_finite3(desc->diffuse_color)) return "diffuse_color is not finite";
    if (!is_finite3(desc->specular_color)) return "specular_color is not finite";
    if (!is_finite3(desc->mirror_color)) return "mirror_color is not finite";
    if (!isfinite(desc->exponent)) return "exponent is not finite";
    if (!is_positive(desc->roughness)) return "roughness must be positive and finite";
    if (!is_positive(desc->refractive_index)) return "refractive_index must be positive and finite";
    if (desc->substrate.index1 >= model->shaders.count) return "substrate is not of this scene";
    if (desc->texture.index1 > model->textures.count) return "texture is not of this scene";
    return desc->type == GLINT_SHADER_GLAZED
               ? gi_scene_check_substrate(model, desc->substrate.index1)
               : NULL;
}

GlintStatus glint_scene_add_shader(
    GlintScene *scene, const GlintShaderDesc *desc, GlintShaderId *id, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_shader_desc_default", error);
    const char *fault = check_shader(&scene->model, desc);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    GiShader shader = {
        .type = desc->type,
        .diffuse_given = true,
        .diffuse = gi_vec_from(desc->diffuse_color),
        .specular = gi_vec_from(desc->specular_color),
        .mirror = gi_vec_from(desc->mirror_color),
        .exponent = desc->exponent,
        .roughness = desc->roughness,
        .index = desc->refractive_index,
        .texture = desc->texture.index1 > 0 ? desc->texture.index1 - 1 : GI_NONE,
        .substrate = desc->type == GLINT_SHADER_GLAZED ? desc->substrate.index1 : GI_NONE,
    };
    uint32_t index = (uint32_t)scene->model.shaders.count;
    if (!gi_array_push(&scene->memory, &scene->model.shaders, shader)) {
        return gi_error_memory(error);
    }
    /* Index 0 is the default shader, so the index is the id. */
    if (id != NULL) id->index1 = index;
    return GLINT_OK;
}

/* ---------------------------------------------------------------- meshes */

GlintMeshDesc glint_mesh_desc_default(void) { return (GlintMeshDesc){.cookie = GI_COOKIE}; }

GlintStatus glint_scene_add_mesh(
    GlintScene *scene, const GlintMeshDesc *desc, GlintMeshId *id, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_mesh_desc_default", error);
    if (desc->positions == NULL || desc->triangles == NULL) {
        return ARGUMENT(error, "positions or triangles is null");
    }
    GiMeshArrays arrays = {
        .positions = (const GiFloat3 *)desc->positions,
        .normals = (const GiFloat3 *)desc->normals,
        .texcoords = (const GiFloat2 *)desc->texcoords,
        .triangles = (const GiCorners *)desc->triangles,
        .vertex_count = desc->vertex_count,
        .triangle_count = desc->triangle_count,
    };
    uint32_t index;
    GiMeshFault fault = {0};
    GlintStatus status = gi_mesh_add(&scene->model.meshes, &scene->memory, &arrays, &index, &fault);
    if (status == GLINT_ERROR_SCENE) return ARGUMENT(error, "%s", fault.message);
    if (status != GLINT_OK) return gi_error_set(error, status, "%s", fault.message);
    if (id != NULL) id->index1 = index + 1;
    return GLINT_OK;
}

GlintStatus glint_scene_load_mesh(
    GlintScene *scene, const char *path, GlintMeshId *id, GlintError *error) {
    GlintStatus status = check_open(scene, scene, GI_COOKIE, "", error);
    if (status != GLINT_OK) return status;
    if (!is_path(path, error)) return GLINT_ERROR_ARGUMENT;
    uint32_t index;
    GiMeshFault fault = {0};
    status = gi_mesh_load(&scene->model.meshes, &scene->memory, scene->thread_count, path, NULL,
        NULL, &index, &fault);
    if (status != GLINT_OK) {
        gi_error_set_path(error, status, path, "%s", fault.message);
        if (error != NULL) error->line = fault.line < INT_MAX ? (int)fault.line : INT_MAX;
        return status;
    }
    if (id != NULL) id->index1 = index + 1;
    return GLINT_OK;
}

/* ---------------------------------------------------------------- surfaces */

/* A group's id is its ref; the ids of other surfaces are their numbers, which stay below. */
static uint32_t group_index(GlintSurfaceId id) { return id.index1 & (GI_SHAPE_INDEX_LIMIT - 1); }

static bool is_group(const GiScene *model, GlintSurfaceId id) {
    return id.index1 >> 28 == GI_SHAPE_GROUP && group_index(id) < model->groups.count;
}

static const char *check_surface(const GiScene *model, const GlintSurfaceDesc *desc) {
    if ((unsigned)desc->type > GLINT_SURFACE_MESH) return "no such surface type";
    if (desc->shader.index1 >= model->shaders.count) return "no such shader";
    if (desc->parent.index1 > 0 && !is_group(model, desc->parent)) {
        return "parent is not a group of this scene";
    }
    if (desc->source.index1 > 0 && !is_group(model, desc->source)) {
        return "source is not a group of this scene";
    }
    if (desc->type == GLINT_SURFACE_MESH &&
        (desc->mesh.index1 == 0 || desc->mesh.index1 > model->meshes.meshes.count)) {
        return "mesh is not of this scene";
    }
    if (!is_finite3(desc->center)) return "center is not finite";
    if (!is_finite3(desc->point_a)) return "point_a is not finite";
    if (!is_finite3(desc->point_b)) return "point_b is not finite";
    if (!is_finite3(desc->normal)) return "normal is not finite";
    if (is_zero3(desc->normal)) return "normal has no length";
    if (!(desc->radius > 0 && isfinite(desc->radius))) return "radius must be positive and finite";
    if (!(desc->height > 0 && isfinite(desc->height))) return "height must be positive and finite";
    if (desc->type == GLINT_SURFACE_CONE) {
        if (!isfinite(desc->tip_z)) return "tip_z is not finite";
        return gi_scene_check_cone(desc->center[2], desc->tip_z);
    }
    return NULL;
}

static bool add_shape(GiScene *model, const GlintSurfaceDesc *desc, GiShapeRef *ref) {
    GiVec center = gi_vec_from(desc->center), normal = gi_vec_from(desc->normal);
    uint32_t shader = desc->shader.index1;
    switch (desc->type) {
    case GLINT_SURFACE_SPHERE: return gi_scene_add_sphere(model, center, desc->radius, shader, ref);
    case GLINT_SURFACE_BOX:
        return gi_scene_add_box(
            model, gi_vec_from(desc->point_a), gi_vec_from(desc->point_b), shader, ref);
    case GLINT_SURFACE_CYLINDER:
        return gi_scene_add_cylinder(model, center, desc->radius, desc->height, shader, ref);
    case GLINT_SURFACE_CONE:
        return gi_scene_add_cone(
            model, center, desc->radius, desc->height, desc->tip_z, shader, ref);
    case GLINT_SURFACE_PLANE:
        return gi_scene_add_plane(model, gi_vec_from(desc->point_a), normal, shader, ref);
    case GLINT_SURFACE_DISC:
        return gi_scene_add_disc(model, center, normal, desc->radius, shader, ref);
    case GLINT_SURFACE_MESH:
        return gi_scene_add_mesh_surface(model, desc->mesh.index1 - 1, shader, ref);
    default: return false;
    }
}

static GlintStatus add_group(
    GiScene *model, const GlintSurfaceDesc *desc, GiShapeRef *ref, GlintError *error) {
    GiAffine matrix, inverse;
    memcpy(matrix.m, desc->transform, sizeof matrix.m);
    if (!gi_affine_invert(&matrix, &inverse)) {
        return ARGUMENT(error, "transform is singular or not finite");
    }
    bool source = desc->source.index1 > 0, cycle = false;
    if (source && desc->parent.index1 > 0 &&
        !gi_scene_group_contains(
            model, group_index(desc->source), group_index(desc->parent), &cycle)) {
        return gi_error_memory(error);
    }
    if (cycle) return ARGUMENT(error, "source contains the parent: it would contain itself");
    if (!gi_scene_add_group(model, ref)) return gi_error_memory(error);
    uint32_t group = gi_shape_index(*ref);
    bool added = gi_scene_add_matrix(model, group, &matrix) &&
                 (!source || gi_scene_place(model, group,
                                 gi_shape_ref(GI_SHAPE_GROUP, group_index(desc->source))));
    return added ? GLINT_OK : gi_error_memory(error);
}

GlintStatus glint_scene_add_surface(
    GlintScene *scene, const GlintSurfaceDesc *desc, GlintSurfaceId *id, GlintError *error) {
    CHECK_OPEN(scene, desc, "glint_surface_desc_default", error);
    GiScene *model = &scene->model;
    const char *fault = check_surface(model, desc);
    if (fault != NULL) return ARGUMENT(error, "%s", fault);
    GiShapeRef ref;
    uint32_t number = model->shape_count + 1;
    if (desc->type == GLINT_SURFACE_GROUP) {
        GlintStatus status = add_group(model, desc, &ref, error);
        if (status != GLINT_OK) return status;
        number = ref.bits;
    } else if (!add_shape(model, desc, &ref)) {
        return gi_error_memory(error);
    }
    uint32_t parent = desc->parent.index1 == 0 ? GI_SHAPE_NONE : group_index(desc->parent);
    if (!gi_scene_place(model, parent, ref)) return gi_error_memory(error);
    if (id != NULL) id->index1 = number;
    return GLINT_OK;
}
