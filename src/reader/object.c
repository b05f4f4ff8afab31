/* SPDX-License-Identifier: MIT
 * From values to the model: what an element means once it is complete. */
#include "reader/state.h"

#include <string.h>

static GiVec slot(const GiReader *reader, GiSlot which) { return gi_reader_slot(reader, which); }

static bool is_group(const GiFrame *frame) {
    return frame->type != NULL && frame->element->kind == GI_KIND_SURFACE &&
           frame->type->value == GLINT_SURFACE_GROUP;
}

/* The group (or the scene) that a child of the frame is placed in. */
static uint32_t group_of(const GiFrame *parent) {
    return is_group(parent) ? parent->index : GI_SHAPE_NONE;
}

/* ---------------------------------------------------------------- names */

void gi_object_name(GiReader *reader, const GiFrame *frame, GiNamed named) {
    const char *name = reader->tags.data + frame->name;
    if (!gi_reader_is_named(reader, frame)) return;
    if (!gi_names_set(&reader->names, gi_span(name), named)) gi_reader_out_of_memory(reader);
}

void gi_object_remember(GiReader *reader, const GiFrame *frame, GlintObjectKind kind) {
    GiSources *sources = reader->source->sources;
    if (sources == NULL) return;
    const char *name = reader->tags.data + frame->name;
    if (!gi_sources_add(sources, kind, frame->place.offset, name)) gi_reader_out_of_memory(reader);
}

void gi_object_remember_idle(GiReader *reader, const GiFrame *frame) {
    GiSources *sources = reader->source->sources;
    if (sources == NULL) return;
    if (!gi_array_push(sources->memory, &sources->idle, frame->place.offset)) {
        gi_reader_out_of_memory(reader);
    }
}

void gi_object_name_value(GiReader *reader, const GiFrame *frame, GiVec value) {
    if (!gi_reader_is_named(reader, frame)) return;
    uint32_t index = (uint32_t)reader->names.values.count;
    if (!gi_array_push(reader->memory, &reader->names.values, value)) {
        gi_reader_out_of_memory(reader);
        return;
    }
    gi_object_name(reader, frame, (GiNamed){.kind = (uint8_t)frame->element->kind, .index = index});
}

/* ---------------------------------------------------------------- slots */

static uint64_t slot_bits(GiSlot first, GiSlot last) {
    return ((UINT64_C(2) << last) - 1) & ~((UINT64_C(1) << first) - 1);
}

uint64_t gi_object_slots(GiKind kind) {
    switch (kind) {
    case GI_KIND_CAMERA: return slot_bits(GI_SLOT_VIEW_POINT, GI_SLOT_VIEW_HEIGHT);
    case GI_KIND_SURFACE: return slot_bits(GI_SLOT_CENTER, GI_SLOT_DATA);
    case GI_KIND_SHADER:
    case GI_KIND_BSDF: return slot_bits(GI_SLOT_DIFFUSE, GI_SLOT_REFRACTION);
    case GI_KIND_BRDF: return slot_bits(GI_SLOT_ROUGHNESS, GI_SLOT_REFRACTION);
    case GI_KIND_TEXTURE: return slot_bits(GI_SLOT_PICTURE, GI_SLOT_PICTURE);
    case GI_KIND_LIGHT: return slot_bits(GI_SLOT_POSITION, GI_SLOT_LIGHT_HEIGHT);
    case GI_KIND_ENVIRONMENT: return slot_bits(GI_SLOT_FILENAME, GI_SLOT_SCALE_FACTOR);
    case GI_KIND_INTEGRATOR: return slot_bits(GI_SLOT_MAX_DEPTH, GI_SLOT_MAX_DEPTH);
    default: return 0;
    }
}

/* The same slot may have another default in another type. */
void gi_object_use_type(GiReader *reader, const GiType *type) {
    if (type == reader->type) return;
    reader->type = type;
    reader->required = 0;
    for (int row = 0; gi_elements[row].name != NULL; row++) {
        const GiElement *element = &gi_elements[row];
        if ((element->contexts & type->context) == 0) continue;
        reader->defaults[element->slot] = reader->row_defaults[row];
        if (element->required) reader->required |= UINT64_C(1) << element->slot;
    }
}

bool gi_object_is_complete(GiReader *reader, const GiFrame *frame) {
    const GiType *type = frame->type;
    gi_object_use_type(reader, type);
    uint64_t missing = reader->required & ~reader->given;
    if (missing == 0) return true;
    for (const GiElement *e = gi_elements; e->name != NULL; e++) {
        bool here = (e->contexts & type->context) != 0 && (missing >> e->slot & 1) != 0;
        if (!here) continue;
        gi_report_add(&reader->report, frame->place,
            1 + (int)strlen(reader->tags.data + frame->tag), "%s needs `%s`: %s", type->name,
            e->name, e->help);
    }
    return false;
}

/* ---------------------------------------------------------------- beginning and values */

void gi_object_begin(GiReader *reader, GiFrame *frame) {
    if (is_group(frame)) {
        GiShapeRef ref;
        if (!gi_scene_add_group(reader->scene, &ref)) {
            gi_reader_out_of_memory(reader);
            return;
        }
        frame->index = gi_shape_index(ref);
        return;
    }
    reader->given &= ~gi_object_slots(frame->element->kind);
}

static void add_step(
    GiReader *reader, const GiFrame *parent, GiTransformStepKind kind, GiVec value) {
    if (!is_group(parent)) return; /* a surface of unknown type */
    if (!gi_scene_add_step(reader->scene, parent->index, kind, value)) {
        gi_reader_out_of_memory(reader);
    }
}

/* Files are loaded as soon as they are named, so that what is wrong with them is told there. */
static void set_file(GiReader *reader, GiFrame *parent, GiSlot slot, GiVec value, GiPlace place) {
    uint32_t index;
    bool good = slot == GI_SLOT_DATA ? gi_files_mesh(reader, value, place, &index)
                                     : gi_files_picture(reader, value, place, &index);
    if (good) {
        gi_reader_put(reader, slot, gi_vec(index, 0, 0), place);
    } else {
        parent->broken = true;
    }
}

static bool is_glazing(const GiFrame *frame) {
    return frame->type != NULL && (frame->type->context & (GI_IN_GLAZED | GI_IN_GLAZED_BSDF)) != 0;
}

void gi_object_set(
    GiReader *reader, GiFrame *parent, const GiElement *element, GiVec value, GiPlace place) {
    GiScene *scene = reader->scene;
    switch (element->slot) {
    case GI_SLOT_IMAGE:
        scene->has_image = true;
        scene->width = (int)value.x;
        scene->height = (int)value.y;
        break;
    case GI_SLOT_SAMPLES: scene->samples = value.x > 1 ? (int)value.x : 1; break;
    case GI_SLOT_BACK_COLOR: scene->back_color = value; break;
    case GI_SLOT_EXPOSURE:
        if (value.x > 0) scene->exposure = value.x;
        break;
    case GI_SLOT_TRANSLATE: add_step(reader, parent, GI_STEP_TRANSLATE, value); break;
    case GI_SLOT_ROTATE: add_step(reader, parent, GI_STEP_ROTATE, value); break;
    case GI_SLOT_SCALE: add_step(reader, parent, GI_STEP_SCALE, value); break;
    case GI_SLOT_ENVIRONMENT:
        if (!gi_files_environment(reader, value, place)) parent->broken = true;
        break;
    case GI_SLOT_INTEGRATOR:
        scene->integrator = (GlintIntegrator)value.x;
        scene->max_depth = (int)value.y;
        break;
    case GI_SLOT_DATA:
    case GI_SLOT_PICTURE: set_file(reader, parent, element->slot, value, place); break;
    case GI_SLOT_REFRACTION:
        if (is_glazing(parent)) parent->refraction = value.x;
        gi_reader_put(reader, element->slot, value, place);
        break;
    case GI_SLOT_DISTTYPE:
        /* What roughness and index stand before it is what counts. */
        if (parent->type != NULL) gi_object_use_type(reader, parent->type);
        value.y = slot(reader, GI_SLOT_ROUGHNESS).x;
        value.z = slot(reader, GI_SLOT_REFRACTION).x;
        gi_reader_put(reader, element->slot, value, place);
        break;
    default: gi_reader_put(reader, element->slot, value, place); break;
    }
}

/* ---------------------------------------------------------------- camera, light */

/* The element that a fault of the camera is about: the one that the sentence begins with. */
static GiPlace place_of_fault(const GiReader *reader, const GiFrame *frame, const char *fault) {
    for (const GiElement *e = gi_elements; e->name != NULL; e++) {
        size_t size = strlen(e->name);
        if (e->contexts != GI_IN_CAMERA || !gi_reader_is_given(reader, e->slot)) continue;
        if (strncmp(fault, e->name, size) == 0 && fault[size] == ' ') {
            return reader->slots[e->slot].place;
        }
    }
    if (gi_reader_is_given(reader, GI_SLOT_PROJ_NORMAL)) {
        return reader->slots[GI_SLOT_PROJ_NORMAL].place;
    }
    if (gi_reader_is_given(reader, GI_SLOT_VIEW_DIR)) return reader->slots[GI_SLOT_VIEW_DIR].place;
    return frame->place;
}

static void finish_camera(GiReader *reader, GiFrame *frame) {
    GiCamera camera = {
        .type =
            frame->type != NULL ? (GlintCameraType)frame->type->value : GLINT_CAMERA_PERSPECTIVE,
        .view_point = slot(reader, GI_SLOT_VIEW_POINT),
        .view_direction = slot(reader, GI_SLOT_VIEW_DIR),
        .view_up = slot(reader, GI_SLOT_VIEW_UP),
        .projection_normal = slot(reader, GI_SLOT_PROJ_NORMAL),
        .projection_distance = slot(reader, GI_SLOT_PROJ_DISTANCE).x,
        .view_width = slot(reader, GI_SLOT_VIEW_WIDTH).x,
        .view_height = slot(reader, GI_SLOT_VIEW_HEIGHT).x,
    };
    const char *fault = frame->broken ? NULL : gi_scene_check_camera(&camera);
    if (fault != NULL) {
        bool normal = gi_reader_is_given(reader, GI_SLOT_PROJ_NORMAL);
        bool parallel = strstr(fault, "parallel") != NULL;
        gi_report_add(&reader->report, place_of_fault(reader, frame, fault), 1, "%s%s", fault,
            !parallel ? ""
            : normal
                ? ": what is up in the picture is then undefined"
                : ", which is viewDir turned round: what is up in the picture is then undefined");
        frame->broken = true;
    }
    if (frame->broken) {
        gi_object_name(reader, frame, (GiNamed){.kind = GI_KIND_CAMERA, .broken = true});
        return;
    }
    reader->scene->camera = camera;
    reader->scene->has_camera = true;
    gi_object_remember(reader, frame, GLINT_OBJECT_CAMERA);
    if (!gi_reader_is_named(reader, frame)) return;
    uint32_t index = (uint32_t)reader->cameras.count;
    if (!gi_array_push(reader->memory, &reader->cameras, camera)) {
        gi_reader_out_of_memory(reader);
        return;
    }
    gi_object_name(reader, frame, (GiNamed){.kind = GI_KIND_CAMERA, .index = index});
}

/* How the places of a rectangle are found; false, with the error reported, when they cannot be. */
static bool read_area(GiReader *reader, const GiFrame *frame, GiLight *light) {
    light->direction = slot(reader, GI_SLOT_DIRECTION);
    if (light->type == GLINT_LIGHT_DIRECTIONAL) return true;
    light->up = slot(reader, GI_SLOT_UP);
    light->width = slot(reader, GI_SLOT_LIGHT_WIDTH).x;
    light->height = slot(reader, GI_SLOT_LIGHT_HEIGHT).x;
    if (gi_scene_check_light(light) == NULL) return true;
    GiSlot which = gi_reader_is_given(reader, GI_SLOT_UP) ? GI_SLOT_UP : GI_SLOT_DIRECTION;
    bool given = gi_reader_is_given(reader, which);
    gi_report_add(&reader->report, given ? reader->slots[which].place : frame->place, 1,
        "upDir is parallel to normalDir: how the rectangle is turned is then undefined");
    return false;
}

static bool read_light(GiReader *reader, const GiFrame *frame, GiLight *light) {
    if (frame->type == NULL || frame->broken || !gi_object_is_complete(reader, frame)) return false;
    *light = gi_light_default();
    light->type = (GlintLightType)frame->type->value;
    light->position = slot(reader, GI_SLOT_POSITION);
    light->intensity = slot(reader, GI_SLOT_INTENSITY);
    bool area = light->type == GLINT_LIGHT_DIRECTIONAL || light->type == GLINT_LIGHT_RECTANGLE;
    return !area || read_area(reader, frame, light);
}

static void finish_light(GiReader *reader, GiFrame *frame) {
    GiLight light;
    if (!read_light(reader, frame, &light)) {
        gi_object_name(reader, frame, (GiNamed){.kind = GI_KIND_LIGHT, .broken = true});
        return;
    }
    if (gi_reader_is_given(reader, GI_SLOT_FALLOFF)) {
        bool none = reader->slots[GI_SLOT_FALLOFF].value.x == 0;
        light.falloff = none ? GLINT_FALLOFF_NONE : GLINT_FALLOFF_INVERSE_SQUARE;
    }
    size_t index = reader->scene->lights.count;
    if (index >= UINT32_MAX || !gi_array_push(reader->memory, &reader->scene->lights, light)) {
        gi_reader_out_of_memory(reader);
        return;
    }
    gi_object_remember(reader, frame, GLINT_OBJECT_LIGHT);
    gi_object_name(reader, frame, (GiNamed){.kind = GI_KIND_LIGHT, .index = (uint32_t)index});
}

/* ---------------------------------------------------------------- environment, integrator */

/* Sets what the scene has one of, and names it: the value is all there is to it. */
static void finish_value(
    GiReader *reader, GiFrame *frame, GiFrame *parent, bool good, GiVec value, GiPlace place) {
    if (good) {
        bool broken = parent->broken;
        parent->broken = false;
        gi_object_set(reader, parent, frame->element, value, place);
        good = !parent->broken;
        parent->broken |= broken;
    }
    if (good) {
        gi_object_name_value(reader, frame, value);
    } else {
        parent->broken = true;
        gi_object_name(
            reader, frame, (GiNamed){.kind = (uint8_t)frame->element->kind, .broken = true});
    }
}

static void finish_environment(GiReader *reader, GiFrame *frame, GiFrame *parent) {
    bool good = frame->type != NULL && !frame->broken && gi_object_is_complete(reader, frame);
    GiVec value = slot(reader, GI_SLOT_FILENAME);
    value.z = slot(reader, GI_SLOT_SCALE_FACTOR).x;
    finish_value(reader, frame, parent, good, value, reader->slots[GI_SLOT_FILENAME].place);
}

static void finish_integrator(GiReader *reader, GiFrame *frame, GiFrame *parent) {
    bool good = frame->type != NULL && !frame->broken;
    GiVec value = {0, slot(reader, GI_SLOT_MAX_DEPTH).x, 0};
    if (good) value.x = frame->type->value;
    finish_value(reader, frame, parent, good, value, frame->place);
}

/* ---------------------------------------------------------------- surfaces */

/* The rules of docs/scene-format.md, 5.4, for the apex. False when there is no cone. */
static bool find_tip(
    GiReader *reader, const GiFrame *frame, GiVec center, double radius, double *tip) {
    bool tip_given = gi_reader_is_given(reader, GI_SLOT_TIPZ);
    bool theta_given = gi_reader_is_given(reader, GI_SLOT_THETA);
    bool radius_given = gi_reader_is_given(reader, GI_SLOT_RADIUS);
    bool by_angle = !tip_given && (theta_given || !radius_given);
    *tip = by_angle ? gi_scene_cone_tip(center.z, radius, slot(reader, GI_SLOT_THETA).x)
                    : slot(reader, GI_SLOT_TIPZ).x;
    const char *fault = gi_scene_check_cone(center.z, *tip);
    if (fault == NULL && !isfinite(radius / (*tip - center.z))) {
        fault = "the cone is too steep or too flat for its slope to be a number";
    }
    if (fault == NULL) return true;
    GiPlace place = tip_given     ? reader->slots[GI_SLOT_TIPZ].place
                    : theta_given ? reader->slots[GI_SLOT_THETA].place
                                  : frame->place;
    gi_report_add(&reader->report, place, 1, "%s%s", fault,
        tip_given     ? ""
        : theta_given ? ": theta is too near to 180"
                      : ": with a radius and without tipz the apex is at z = 0; give tipz");
    return false;
}

static bool group_is_good(const GiScene *scene, uint32_t group, GlintDialect dialect) {
    GiAffine matrix;
    return gi_scene_group_matrix(
        scene, &scene->groups.data[group], gi_dialect_rules(dialect), &matrix);
}

static void report_group(GiReader *reader, GiPlace place) {
    gi_report_add(&reader->report, place, 8,
        "the transform of this group cannot be inverted: it flattens the group, or its numbers "
        "are too large or too small");
}

/* The product has the same determinant in either order of its factors, but numbers may overflow in
 * one order only. Which order counts is known at the end of the file. */
static bool check_group(GiReader *reader, GiFrame *frame) {
    bool last_first = group_is_good(reader->scene, frame->index, GLINT_DIALECT_GLINT);
    bool first_first = group_is_good(reader->scene, frame->index, GLINT_DIALECT_2017B);
    if (last_first && first_first) return true;
    if (!last_first && !first_first) {
        report_group(reader, frame->place);
        return false;
    }
    GiDoubtfulGroup doubtful = {frame->index, frame->place};
    if (!gi_array_push(reader->memory, &reader->doubtful, doubtful)) {
        gi_reader_out_of_memory(reader);
        return false;
    }
    return true;
}

void gi_object_check_groups(GiReader *reader, GlintDialect dialect) {
    for (size_t i = 0; i < reader->doubtful.count; i++) {
        const GiDoubtfulGroup *doubtful = &reader->doubtful.data[i];
        if (!group_is_good(reader->scene, doubtful->group, dialect)) {
            report_group(reader, doubtful->place);
        }
    }
}

static bool add_shape(GiReader *reader, GiFrame *frame, GiShapeRef *ref) {
    GiScene *scene = reader->scene;
    GiVec center = slot(reader, GI_SLOT_CENTER);
    double radius = slot(reader, GI_SLOT_RADIUS).x, height = slot(reader, GI_SLOT_HEIGHT).x, tip;
    uint32_t shader = frame->index;
    bool added = true;
    switch ((GlintSurfaceType)frame->type->value) {
    case GLINT_SURFACE_SPHERE:
        added = gi_scene_add_sphere(scene, center, radius, shader, ref);
        break;
    case GLINT_SURFACE_BOX:
        added = gi_scene_add_box(
            scene, slot(reader, GI_SLOT_MIN_PT), slot(reader, GI_SLOT_MAX_PT), shader, ref);
        break;
    case GLINT_SURFACE_CYLINDER:
        added = gi_scene_add_cylinder(scene, center, radius, height, shader, ref);
        break;
    case GLINT_SURFACE_CONE:
        if (!find_tip(reader, frame, center, radius, &tip)) return false;
        added = gi_scene_add_cone(scene, center, radius, height, tip, shader, ref);
        break;
    case GLINT_SURFACE_PLANE:
        added = gi_scene_add_plane(
            scene, slot(reader, GI_SLOT_POINT), slot(reader, GI_SLOT_NORMAL), shader, ref);
        break;
    case GLINT_SURFACE_DISC:
        added = gi_scene_add_disc(
            scene, slot(reader, GI_SLOT_POINT), slot(reader, GI_SLOT_NORMAL), radius, shader, ref);
        break;
    case GLINT_SURFACE_GROUP: {
        *ref = gi_shape_ref(GI_SHAPE_GROUP, frame->index);
        return check_group(reader, frame);
    }
    case GLINT_SURFACE_MESH:
        if (!gi_object_is_complete(reader, frame)) return false;
        added =
            gi_scene_add_mesh_surface(scene, (uint32_t)slot(reader, GI_SLOT_DATA).x, shader, ref);
        break;
    }
    if (!added) gi_reader_out_of_memory(reader);
    return added;
}

static void place_shape(GiReader *reader, const GiFrame *parent, GiShapeRef ref) {
    if (!gi_scene_place(reader->scene, group_of(parent), ref)) gi_reader_out_of_memory(reader);
}

static void finish_surface(GiReader *reader, GiFrame *frame, GiFrame *parent) {
    GiShapeRef ref;
    if (frame->type == NULL || frame->broken || !add_shape(reader, frame, &ref)) {
        parent->broken = true;
        gi_object_name(reader, frame, (GiNamed){.kind = GI_KIND_SURFACE, .broken = true});
        return;
    }
    if (gi_shape_kind(ref) != GI_SHAPE_GROUP) {
        gi_object_remember(reader, frame, GLINT_OBJECT_SURFACE);
    }
    place_shape(reader, parent, ref);
    if (gi_reader_is_named(reader, frame)) {
        gi_object_name(reader, frame, (GiNamed){.kind = GI_KIND_SURFACE, .shape = ref});
    }
}

/* ---------------------------------------------------------------- the whole */

static void finish_scene(GiReader *reader, const GiFrame *frame) {
    GiPlace root = reader->report.root;
    int length = 1 + (int)strlen(reader->tags.data + frame->tag);
    if (!reader->camera_seen) {
        gi_report_add(
            &reader->report, root, length, "the scene has no camera: add a `camera` element");
    }
    if (!reader->image_seen) {
        gi_report_add(&reader->report, root, length,
            "the scene has no image size: add, for example, <image>512 512</image>");
    }
}

void gi_object_finish(GiReader *reader, GiFrame *frame, GiFrame *parent) {
    switch (frame->element->kind) {
    case GI_KIND_SCENE: finish_scene(reader, frame); break;
    case GI_KIND_CAMERA: finish_camera(reader, frame); break;
    case GI_KIND_SHADER:
    case GI_KIND_BSDF: gi_shading_finish_shader(reader, frame, parent); break;
    case GI_KIND_BRDF: gi_shading_finish_brdf(reader, frame, parent); break;
    case GI_KIND_TEXTURE: gi_shading_finish_texture(reader, frame, parent); break;
    case GI_KIND_LIGHT: finish_light(reader, frame); break;
    case GI_KIND_ENVIRONMENT: finish_environment(reader, frame, parent); break;
    case GI_KIND_INTEGRATOR: finish_integrator(reader, frame, parent); break;
    default: finish_surface(reader, frame, parent); break;
    }
}

void gi_object_refer(GiReader *reader, GiFrame *frame, GiFrame *parent, const GiNamed *named) {
    GiNamed copy = *named; /* naming it again may move the table */
    switch ((GiKind)copy.kind) {
    case GI_KIND_SCENE: break;
    case GI_KIND_CAMERA:
        reader->scene->camera = reader->cameras.data[copy.index];
        reader->scene->has_camera = true;
        gi_object_remember(reader, frame, GLINT_OBJECT_CAMERA);
        break;
    case GI_KIND_SURFACE: place_shape(reader, parent, copy.shape); break;
    case GI_KIND_SHADER:
    case GI_KIND_BSDF: gi_shading_give(reader, frame, parent, copy.index); break;
    case GI_KIND_LIGHT: {
        GiLight light = reader->scene->lights.data[copy.index];
        if (!gi_array_push(reader->memory, &reader->scene->lights, light)) {
            gi_reader_out_of_memory(reader);
            return;
        }
        gi_object_remember(reader, frame, GLINT_OBJECT_LIGHT);
        break;
    }
    default: {
        GiVec value = reader->names.values.data[copy.index];
        if (!gi_value_check(reader, frame->element, value, frame->place,
                1 + (int)strlen(reader->tags.data + frame->tag))) {
            frame->broken = parent->broken = true;
            copy.broken = true;
        } else {
            gi_object_set(reader, parent, frame->element, value, frame->place);
        }
        break;
    }
    }
    if (gi_reader_is_named(reader, frame)) gi_object_name(reader, frame, copy);
}
