/* SPDX-License-Identifier: MIT */
#include "scene/scene.h"

#include "math/elementary.h"

#include <string.h>

bool gi_scene_init(GiScene *scene, GiMemory *memory) {
    memset(scene, 0, sizeof *scene);
    scene->memory = memory;
    scene->samples = 1;
    scene->exposure = 1;
    scene->max_depth = 12;
    scene->camera = gi_camera_default();
    return gi_array_push(memory, &scene->shaders, gi_shader_default());
}

void gi_scene_reset(GiScene *scene) {
    GiMemory *memory = scene->memory;
    for (size_t i = 0; i < scene->groups.count; i++) {
        gi_array_free(memory, &scene->groups.data[i].steps);
        gi_array_free(memory, &scene->groups.data[i].children);
    }
    for (int kind = 0; kind < GI_SHAPE_KIND_COUNT; kind++) {
        gi_array_free(memory, &scene->info[kind]);
    }
    gi_array_free(memory, &scene->shaders);
    gi_array_free(memory, &scene->lights);
    gi_array_free(memory, &scene->spheres);
    gi_array_free(memory, &scene->boxes);
    gi_array_free(memory, &scene->cones);
    gi_array_free(memory, &scene->discs);
    gi_array_free(memory, &scene->planes);
    gi_mesh_store_free(&scene->meshes, memory);
    gi_array_free(memory, &scene->mesh_surfaces);
    for (size_t i = 0; i < scene->pictures.count; i++) {
        gi_picture_free(&scene->pictures.data[i], memory);
    }
    gi_array_free(memory, &scene->pictures);
    gi_array_free(memory, &scene->textures);
    gi_environment_free(&scene->environment, memory);
    gi_array_free(memory, &scene->groups);
    gi_array_free(memory, &scene->files);
    gi_array_free(memory, &scene->file_names);
    gi_array_free(memory, &scene->matrices);
    gi_array_free(memory, &scene->roots);
}

GiCamera gi_camera_default(void) {
    return (GiCamera){
        .type = GLINT_CAMERA_PERSPECTIVE,
        .view_direction = {0, 0, -1},
        .view_up = {0, 1, 0},
        .projection_distance = 1,
        .view_width = 1,
        .view_height = 1,
    };
}

GiShader gi_shader_default(void) {
    return (GiShader){.type = GLINT_SHADER_LAMBERTIAN,
        .diffuse = {1, 1, 1},
        .specular = {1, 1, 1},
        .exponent = 1,
        .roughness = 1,
        .index = 1,
        .texture = GI_NONE,
        .substrate = GI_NONE};
}

GiLight gi_light_default(void) {
    return (GiLight){.type = GLINT_LIGHT_POINT,
        .intensity = {1, 1, 1},
        .direction = {0, 0, -1},
        .up = {0, 1, 0},
        .width = 1,
        .height = 1};
}

/* ---------------------------------------------------------------- files */

static bool append_text(GiScene *scene, const char *text, uint32_t *at) {
    size_t size = strlen(text) + 1, count = scene->file_names.count;
    if (count + size > UINT32_MAX || !gi_array_reserve(scene->memory, &scene->file_names, size)) {
        return false;
    }
    memcpy(scene->file_names.data + count, text, size);
    scene->file_names.count += size;
    *at = (uint32_t)count;
    return true;
}

GiSceneFile *gi_scene_add_file(
    GiScene *scene, GlintFileKind kind, const char *name, const char *path) {
    GiSceneFile file = {.kind = kind};
    if (!append_text(scene, name, &file.name) || !append_text(scene, path, &file.path) ||
        !gi_array_push(scene->memory, &scene->files, file)) {
        return NULL;
    }
    return &scene->files.data[scene->files.count - 1];
}

/* ---------------------------------------------------------------- checks */

const char *gi_scene_check_image_size(double width, double height) {
    if (!(width >= 1 && height >= 1)) return "the image needs a positive width and height";
    if (width * height > GI_IMAGE_PIXEL_LIMIT) return "the image has more than 2^28 pixels";
    return NULL;
}

const char *gi_scene_check_camera(const GiCamera *camera) {
    if (gi_vec_is_zero(camera->view_direction)) return "viewDir has no length";
    if (gi_vec_is_zero(camera->view_up)) return "viewUp has no length";
    GiVec normal = gi_vec_is_zero(camera->projection_normal) ? camera->view_direction
                                                             : camera->projection_normal;
    GiVec side = gi_cross(gi_normalize(camera->view_up), gi_normalize(normal));
    if (gi_length(side) < 1e-12) return "viewUp is parallel to the projection normal";
    if (!(camera->projection_distance > 0)) return "projDistance must be positive";
    if (!(camera->view_width > 0)) return "viewWidth must be positive";
    if (!(camera->view_height > 0)) return "viewHeight must be positive";
    return NULL;
}

const char *gi_scene_check_cone(double center_z, double tip_z) {
    return tip_z == center_z ? "the apex of the cone lies in its centre plane" : NULL;
}

const char *gi_scene_check_light(const GiLight *light) {
    GiVec side = gi_cross(gi_normalize(light->up), gi_normalize(light->direction));
    return gi_length(side) < 1e-12 ? "the up direction is parallel to the normal" : NULL;
}

const char *gi_scene_check_substrate(const GiScene *scene, uint32_t substrate) {
    int depth = 1;
    for (; scene->shaders.data[substrate].type == GLINT_SHADER_GLAZED; depth++) {
        if (depth >= GI_SUBSTRATE_LIMIT) return "Glazed shaders lie more than 8 deep on each other";
        substrate = scene->shaders.data[substrate].substrate;
    }
    return NULL;
}

double gi_scene_cone_tip(double center_z, double radius, double theta_degrees) {
    double sine, cosine;
    gi_sincos_degrees(theta_degrees / 2, &sine, &cosine);
    return center_z + radius * cosine / sine;
}

/* ---------------------------------------------------------------- shapes */

/* Appends to one kind's array and to its info, or to neither. */
#define ADD_SHAPE(scene, array, kind_, shader_, ref, ...)                                          \
    do {                                                                                           \
        GiShapeInfos *infos = &(scene)->info[kind_];                                               \
        if ((array)->count >= GI_SHAPE_INDEX_LIMIT ||                                              \
            !gi_array_reserve((scene)->memory, (array), 1) ||                                      \
            !gi_array_reserve((scene)->memory, infos, 1)) {                                        \
            return false;                                                                          \
        }                                                                                          \
        *(ref) = gi_shape_ref((kind_), (uint32_t)(array)->count);                                  \
        (array)->data[(array)->count++] = (__VA_ARGS__);                                           \
        infos->data[infos->count++] = (GiShapeInfo){(shader_), (scene)->shape_count++};            \
        return true;                                                                               \
    } while (0)

bool gi_scene_add_sphere(
    GiScene *scene, GiVec center, double radius, uint32_t shader, GiShapeRef *ref) {
    ADD_SHAPE(scene, &scene->spheres, GI_SHAPE_SPHERE, shader, ref, (GiSphere){center, radius});
}

bool gi_scene_add_box(GiScene *scene, GiVec a, GiVec b, uint32_t shader, GiShapeRef *ref) {
    GiBox box = {
        {fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z)},
        {fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z)},
    };
    ADD_SHAPE(scene, &scene->boxes, GI_SHAPE_BOX, shader, ref, box);
}

bool gi_scene_add_cylinder(
    GiScene *scene, GiVec center, double radius, double height, uint32_t shader, GiShapeRef *ref) {
    ADD_SHAPE(
        scene, &scene->cones, GI_SHAPE_CONE, shader, ref, (GiCone){center, radius, 0, height / 2});
}

bool gi_scene_add_cone(GiScene *scene, GiVec center, double radius, double height, double tip_z,
    uint32_t shader, GiShapeRef *ref) {
    ADD_SHAPE(scene, &scene->cones, GI_SHAPE_CONE, shader, ref,
        (GiCone){center, radius, -radius / (tip_z - center.z), height / 2});
}

bool gi_scene_add_disc(
    GiScene *scene, GiVec center, GiVec normal, double radius, uint32_t shader, GiShapeRef *ref) {
    ADD_SHAPE(scene, &scene->discs, GI_SHAPE_DISC, shader, ref,
        (GiDisc){center, gi_normalize(normal), radius});
}

bool gi_scene_add_plane(
    GiScene *scene, GiVec point, GiVec normal, uint32_t shader, GiShapeRef *ref) {
    ADD_SHAPE(
        scene, &scene->planes, GI_SHAPE_PLANE, shader, ref, (GiPlane){point, gi_normalize(normal)});
}

bool gi_scene_add_mesh_surface(GiScene *scene, uint32_t mesh, uint32_t shader, GiShapeRef *ref) {
    if (scene->mesh_surfaces.count >= GI_SHAPE_INDEX_LIMIT ||
        !gi_array_reserve(scene->memory, &scene->mesh_surfaces, 1)) {
        return false;
    }
    size_t index = scene->mesh_surfaces.count++;
    scene->mesh_surfaces.data[index] = (GiMeshSurface){mesh, {shader, scene->shape_count++}};
    *ref = gi_shape_ref(GI_SHAPE_MESH, (uint32_t)index);
    return true;
}

/* ---------------------------------------------------------------- groups */

bool gi_scene_add_group(GiScene *scene, GiShapeRef *ref) {
    if (scene->groups.count >= GI_SHAPE_INDEX_LIMIT) return false;
    *ref = gi_shape_ref(GI_SHAPE_GROUP, (uint32_t)scene->groups.count);
    return gi_array_push(scene->memory, &scene->groups, (GiGroup){0});
}

bool gi_scene_add_step(GiScene *scene, uint32_t group, GiTransformStepKind kind, GiVec value) {
    return gi_array_push(
        scene->memory, &scene->groups.data[group].steps, (GiTransformStep){kind, value});
}

bool gi_scene_add_matrix(GiScene *scene, uint32_t group, const GiAffine *matrix) {
    double index = (double)scene->matrices.count;
    return gi_array_push(scene->memory, &scene->matrices, *matrix) &&
           gi_scene_add_step(scene, group, GI_STEP_MATRIX, gi_vec(index, 0, 0));
}

bool gi_scene_place(GiScene *scene, uint32_t group, GiShapeRef ref) {
    if (group == GI_SHAPE_NONE) return gi_array_push(scene->memory, &scene->roots, ref);
    GiGroup *parent = &scene->groups.data[group];
    parent->nests |= gi_shape_kind(ref) == GI_SHAPE_GROUP;
    return gi_array_push(scene->memory, &parent->children, ref);
}

bool gi_scene_group_contains(const GiScene *scene, uint32_t group, uint32_t inner, bool *contains) {
    size_t count = scene->groups.count;
    GI_ARRAY(uint32_t) found = {0}; /* each group once, in the order in which they are met */
    uint8_t *seen = gi_memory_allocate(scene->memory, count);
    bool good = seen != NULL && gi_array_push(scene->memory, &found, group);
    if (good) memset(seen, 0, count);
    *contains = group == inner;
    for (size_t i = 0; good && !*contains && i < found.count; i++) {
        const GiGroup *next = &scene->groups.data[found.data[i]];
        for (size_t k = 0; good && next->nests && k < next->children.count; k++) {
            uint32_t child = gi_shape_index(next->children.data[k]);
            if (gi_shape_kind(next->children.data[k]) != GI_SHAPE_GROUP || seen[child]) continue;
            seen[child] = 1;
            *contains |= child == inner;
            good = gi_array_push(scene->memory, &found, child);
        }
    }
    gi_array_free(scene->memory, &found);
    gi_memory_free(scene->memory, seen, count);
    return good;
}

bool gi_scene_group_matrix(
    const GiScene *scene, const GiGroup *group, const GiRules *rules, GiAffine *matrix) {
    GiAffine product = gi_affine_identity, inverse;
    bool first_listed_first = rules->first_listed_first != scene->reverse_transforms;
    for (size_t i = 0; i < group->steps.count; i++) {
        const GiTransformStep *step = &group->steps.data[i];
        GiAffine next;
        switch (step->kind) {
        case GI_STEP_TRANSLATE: next = gi_affine_translate(step->value); break;
        case GI_STEP_ROTATE: next = gi_affine_rotate_degrees(step->value); break;
        case GI_STEP_SCALE: next = gi_affine_scale(step->value); break;
        default: next = scene->matrices.data[(size_t)step->value.x]; break;
        }
        product = first_listed_first ? gi_affine_multiply(&next, &product)
                                     : gi_affine_multiply(&product, &next);
    }
    *matrix = product;
    return gi_affine_invert(&product, &inverse);
}
