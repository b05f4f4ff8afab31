/* SPDX-License-Identifier: MIT
 * The walk over the old text: what each element needs is in the files upgrade_..., what concerns
 * the scene as a whole, and words of other years, here. */
#include "format/upgrade.h"

#include "base/error.h"
#include "reader/name.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- notes */

void gi_upgrade_note(
    GiUpgrade *upgrade, GlintChangeKind kind, size_t token, const char *format, ...) {
    char message[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    size_t size = strlen(message) + 1;
    GiUpgradeNote note = {kind, upgrade->document->tokens.data[token].begin, upgrade->texts.count,
        upgrade->notes.count};
    if (!gi_array_reserve(upgrade->memory, &upgrade->texts, size) ||
        !gi_array_push(upgrade->memory, &upgrade->notes, note)) {
        upgrade->failed = true;
        return;
    }
    memcpy(upgrade->texts.data + upgrade->texts.count, message, size);
    upgrade->texts.count += size;
}

static int compare_notes(const void *a, const void *b) {
    const GiUpgradeNote *left = a, *right = b;
    if (left->offset != right->offset) return left->offset < right->offset ? -1 : 1;
    return left->order < right->order ? -1 : 1;
}

/* In the order of the text, so that it is counted once. */
static void tell_notes(GiUpgrade *upgrade, GlintChangeFn change, void *user) {
    const char *text = upgrade->document->text.data;
    int64_t line = 1, column = 1;
    size_t at = 0;
    if (change == NULL || upgrade->notes.count == 0) return;
    qsort(upgrade->notes.data, upgrade->notes.count, sizeof(GiUpgradeNote), compare_notes);
    for (size_t i = 0; i < upgrade->notes.count; i++) {
        const GiUpgradeNote *note = &upgrade->notes.data[i];
        for (; at < note->offset; at++) {
            column += ((unsigned char)text[at] & 0xc0) != 0x80;
            if (text[at] != '\n') continue;
            line++;
            column = 1;
        }
        const GlintChange told = {note->kind, line, column, upgrade->texts.data + note->text};
        change(user, &told);
    }
}

/* ---------------------------------------------------------------- names */

/* An attribute as the reader sees it; data null: it is not given. */
static GiSpan plain_attribute(GiUpgrade *upgrade, size_t token, const char *name, GiText *plain) {
    GiSpan value = gi_document_attribute_value(upgrade->document, token, name);
    if (value.data != NULL && !gi_document_decode(upgrade->document, &value, plain)) {
        upgrade->failed = true;
    }
    return value;
}

/* What each element stands for, as the reader takes it: a name means what had it last. */
static void find_targets(GiUpgrade *upgrade) {
    const GiDocument *document = upgrade->document;
    GiNames names;
    GiText plain = {0};
    gi_names_init(&names, upgrade->memory);
    for (size_t i = 0; i < document->tokens.count && !upgrade->failed; i++) {
        const GiToken *token = &document->tokens.data[i];
        size_t target = i;
        if (token->refers) {
            GiSpan ref = plain_attribute(upgrade, i, "ref", &plain);
            const GiNamed *named = gi_names_get(&names, ref);
            if (named != NULL) target = upgrade->targets.data[named->index];
        }
        if (!gi_array_push(upgrade->memory, &upgrade->targets, target)) upgrade->failed = true;
        bool ends = token->kind == GI_TOKEN_END || token->kind == GI_TOKEN_EMPTY;
        size_t start = token->match < i ? token->match : i;
        if (!ends || upgrade->failed || token->ignored) continue;
        GiSpan name = plain_attribute(upgrade, start, "name", &plain);
        if (name.data == NULL || upgrade->failed) continue;
        if (!gi_names_set(&names, name, (GiNamed){.index = (uint32_t)start})) {
            upgrade->failed = true;
        }
    }
    gi_array_free(upgrade->memory, &plain);
    gi_names_reset(&names);
}

/* ---------------------------------------------------------------- words of other years */

const char *gi_upgrade_name(const GiUpgrade *upgrade, size_t token) {
    const GiElement *element = upgrade->document->tokens.data[token].element;
    return element->alias_of != NULL ? element->alias_of : element->name;
}

static void upgrade_words(GiUpgrade *upgrade, size_t token) {
    const GiDocument *document = upgrade->document;
    const GiToken *start = &document->tokens.data[token];
    const char *name = gi_upgrade_name(upgrade, token);
    GiSpan written = gi_document_name(document, token);
    if (!gi_span_is(written, name)) {
        gi_edit_rename(&upgrade->edits, token, name);
        if (start->element->alias_of != NULL) {
            gi_upgrade_note(upgrade, GLINT_CHANGE_SAME, token, "`%s` is called `%s` now",
                start->element->name, name);
        }
    }
    if (start->type == NULL || start->refers) return;
    GiSpan type = gi_document_attribute_value(document, token, "type");
    const char *now = start->type->alias_of != NULL ? start->type->alias_of : start->type->name;
    /* What has no type any more that is meant, like cubemap, gets it. */
    bool meant = start->element->alias_of == NULL && type.data == NULL;
    if (meant || (type.data != NULL && gi_span_is(type, now))) return;
    gi_edit_set_attribute(&upgrade->edits, token, "type", now);
    gi_upgrade_note(upgrade, GLINT_CHANGE_SAME, token, "the type is called `%s` now", now);
}

/* ---------------------------------------------------------------- the scene as a whole */

static bool find_environment(const GiDocument *document, size_t *token) {
    for (size_t i = 0; i < document->tokens.count; i++) {
        const GiElement *element = document->tokens.data[i].element;
        if (element == NULL || element->kind != GI_KIND_ENVIRONMENT) continue;
        *token = i;
        return true;
    }
    return false;
}

/* Whether the eye is in a box or cylinder of a group or the scene; true as well when it would take
 * too long to tell. */
typedef struct Inside {
    const GiScene *scene;
    const GiRules *rules;
    int64_t left; /* visits */
} Inside;

static bool holds(const GiScene *scene, GiShapeRef ref, GiVec p) {
    uint32_t i = gi_shape_index(ref);
    if (gi_shape_kind(ref) == GI_SHAPE_BOX) {
        const GiBox *b = &scene->boxes.data[i];
        return p.x >= b->low.x && p.y >= b->low.y && p.z >= b->low.z && p.x <= b->high.x &&
               p.y <= b->high.y && p.z <= b->high.z;
    }
    if (gi_shape_kind(ref) != GI_SHAPE_CONE) return false;
    const GiCone *c = &scene->cones.data[i];
    GiVec d = gi_sub(p, c->center);
    return c->slope == 0 && fabs(d.z) <= c->half_height &&
           d.x * d.x + d.y * d.y <= c->radius * c->radius;
}

static bool is_inside(Inside *inside, const GiShapeRef *refs, size_t count, GiVec eye, int depth) {
    enum { DEPTH_LIMIT = 1000 };
    for (size_t i = 0; i < count; i++) {
        if (inside->left-- <= 0 || depth > DEPTH_LIMIT) return true;
        if (gi_shape_kind(refs[i]) != GI_SHAPE_GROUP) {
            if (holds(inside->scene, refs[i], eye)) return true;
            continue;
        }
        const GiGroup *group = &inside->scene->groups.data[gi_shape_index(refs[i])];
        GiAffine matrix, inverse;
        if (!gi_scene_group_matrix(inside->scene, group, inside->rules, &matrix)) return true;
        gi_affine_invert(&matrix, &inverse);
        GiVec there = gi_affine_point(&inverse, eye);
        if (is_inside(inside, group->children.data, group->children.count, there, depth + 1)) {
            return true;
        }
    }
    return false;
}

static void tell_lost_exits(GiUpgrade *upgrade, size_t root) {
    const GiScene *scene = &upgrade->document->scene;
    if (upgrade->from->entering_only == upgrade->to->entering_only) return;
    if (scene->boxes.count == 0 && scene->cones.count == 0) return;
    Inside inside = {scene, upgrade->from, 1000000};
    bool parallel = scene->camera.type == GLINT_CAMERA_PARALLEL;
    if (!parallel &&
        !is_inside(&inside, scene->roots.data, scene->roots.count, scene->camera.view_point, 0)) {
        return;
    }
    gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, root,
        "the eye may be in a box or cylinder, whose inside a ray did not meet and now does");
}

static void tell_shadows(GiUpgrade *upgrade, size_t root) {
    const GiRules *from = upgrade->from, *to = upgrade->to;
    if (from->shadow_distance == to->shadow_distance) return;
    if (!upgrade->has_points && !upgrade->has_large) return;
    gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, root,
        "shadow rays began at a distance of %g and now do at the surface: what is nearer casts "
        "shadows now",
        from->shadow_distance);
}

/* Normals of the second nappe. */
static void upgrade_cone(GiUpgrade *upgrade, size_t token, uint32_t order) {
    const GiScene *scene = &upgrade->document->scene;
    if (upgrade->from->cone_geometric == upgrade->to->cone_geometric) return;
    const GiShapeInfos *infos = &scene->info[GI_SHAPE_CONE];
    for (size_t low = 0, high = infos->count; low < high;) {
        size_t middle = low + (high - low) / 2;
        if (infos->data[middle].order < order) {
            low = middle + 1;
            continue;
        }
        high = middle;
        if (infos->data[middle].order > order) continue;
        const GiCone *cone = &scene->cones.data[middle];
        if (cone->slope == 0 || fabs(cone->radius / cone->slope) >= cone->half_height) return;
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, token,
            "normals beyond the apex of a double cone were those of the other side and are now at "
            "right angles to the surface");
        return;
    }
}

static void upgrade_scene(GiUpgrade *upgrade, size_t root) {
    const GiDocument *document = upgrade->document;
    GiSpan old = gi_document_attribute_value(document, root, "dialect");
    if (!gi_span_is((GiSpan){old.data != NULL ? old.data : "", old.size}, upgrade->to->name)) {
        gi_edit_set_attribute(&upgrade->edits, root, "dialect", upgrade->to->name);
        gi_upgrade_note(upgrade, GLINT_CHANGE_SAME, root, "the rules of %s become those of %s",
            upgrade->from->name, upgrade->to->name);
    }
    tell_lost_exits(upgrade, root);
    tell_shadows(upgrade, root);
    size_t sky;
    if (upgrade->from->environment_lights != upgrade->to->environment_lights &&
        document->scene.integrator != GLINT_INTEGRATOR_POINT_LIGHT &&
        find_environment(document, &sky)) {
        gi_upgrade_note(upgrade, GLINT_CHANGE_DIFFERENT, sky,
            "the environment was only seen and now lights the surfaces");
    }
}

/* ---------------------------------------------------------------- the walk */

static void find_lights(GiUpgrade *upgrade) {
    const GiScene *scene = &upgrade->document->scene;
    size_t token;
    bool sampled = scene->integrator != GLINT_INTEGRATOR_POINT_LIGHT;
    bool environment = find_environment(upgrade->document, &token);
    upgrade->has_large = sampled && environment &&
                         (upgrade->from->environment_lights || upgrade->to->environment_lights);
    for (size_t i = 0; i < scene->lights.count; i++) {
        GlintLightType type = scene->lights.data[i].type;
        upgrade->has_points |= type == GLINT_LIGHT_POINT || type == GLINT_LIGHT_DIRECTIONAL;
        upgrade->has_large |= sampled && type == GLINT_LIGHT_RECTANGLE;
    }
}

static void walk(GiUpgrade *upgrade) {
    const GiDocument *document = upgrade->document;
    uint32_t group = 0, surface = 0;
    for (size_t i = 0; i < document->tokens.count && !upgrade->failed; i++) {
        const GiToken *token = &document->tokens.data[i];
        if (!gi_token_opens(token) || token->element == NULL) continue;
        upgrade_words(upgrade, i);
        gi_upgrade_value(upgrade, i);
        if (token->element->kind == GI_KIND_SCENE) upgrade_scene(upgrade, i);
        if (token->refers || token->type == NULL) continue;
        bool is_group = token->type->context == GI_IN_GROUP;
        switch (token->type->kind) {
        case GI_KIND_LIGHT: gi_upgrade_light(upgrade, i); break;
        case GI_KIND_SHADER:
        case GI_KIND_BSDF: gi_upgrade_shader(upgrade, i); break;
        case GI_KIND_SURFACE:
            if (is_group) {
                gi_upgrade_group(upgrade, i, group++);
            } else {
                gi_upgrade_surface(upgrade, i);
                upgrade_cone(upgrade, i, surface++);
            }
            break;
        default: break;
        }
    }
}

GlintStatus gi_upgrade_write(
    const GiDocument *document, GlintChangeFn change, void *user, GiText *text, GlintError *error) {
    GiUpgrade upgrade = {.document = document,
        .memory = document->memory,
        .from = gi_dialect_rules(document->scene.dialect),
        .to = gi_dialect_rules(GLINT_DIALECT_GLINT),
        .edits = {.document = document}};
    find_lights(&upgrade);
    find_targets(&upgrade);
    walk(&upgrade);
    bool good = !upgrade.failed && gi_edits_apply(&upgrade.edits, text);
    if (good) tell_notes(&upgrade, change, user);
    gi_edits_reset(&upgrade.edits);
    gi_array_free(upgrade.memory, &upgrade.notes);
    gi_array_free(upgrade.memory, &upgrade.texts);
    gi_array_free(upgrade.memory, &upgrade.targets);
    return good ? GLINT_OK : gi_error_memory(error);
}
