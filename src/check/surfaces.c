/* SPDX-License-Identifier: MIT
 * Rules of surfaces that are in each other's way. */
#include "check/inside.h"

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- the same twice */

enum { NUMBERS = 8 };

/* All that makes a surface what it is: kind, numbers, transform. */
typedef struct Key {
    uint64_t hash;
    uint32_t order, item;
    uint32_t kind, content; /* content: a mesh, or an instance's tree */
    double numbers[NUMBERS];
    const GiAffine *to_world; /* null: none */
} Key;

static uint64_t mix(uint64_t hash, const void *bytes, size_t size) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size; i++) hash = (hash ^ byte[i]) * UINT64_C(1099511628211);
    return hash ^ hash >> 29;
}

/* Copies vectors and numbers; a zero has one sign. */
static void put(double *to, int *count, double value) { to[(*count)++] = value + 0.0; }

static void put_vec(double *to, int *count, GiVec v) {
    put(to, count, v.x);
    put(to, count, v.y);
    put(to, count, v.z);
}

static void put_numbers(const GiShapes *shapes, GiShapeRef own, double *to) {
    uint32_t i = gi_shape_index(own);
    int n = 0;
    switch (gi_shape_kind(own)) {
    case GI_SHAPE_SPHERE:
        put_vec(to, &n, shapes->spheres[i].center);
        put(to, &n, shapes->spheres[i].radius);
        break;
    case GI_SHAPE_BOX:
        put_vec(to, &n, shapes->boxes[i].low);
        put_vec(to, &n, shapes->boxes[i].high);
        break;
    case GI_SHAPE_CONE:
        put_vec(to, &n, shapes->cones[i].center);
        put(to, &n, shapes->cones[i].radius);
        put(to, &n, shapes->cones[i].slope);
        put(to, &n, shapes->cones[i].half_height);
        break;
    case GI_SHAPE_DISC:
        put_vec(to, &n, shapes->discs[i].center);
        put_vec(to, &n, shapes->discs[i].normal);
        put(to, &n, shapes->discs[i].radius);
        break;
    case GI_SHAPE_PLANE:
        put_vec(to, &n, shapes->planes[i].point);
        put_vec(to, &n, shapes->planes[i].normal);
        break;
    default: break;
    }
}

static Key key_of(const GiCheck *check, const GiCheckItem *item, uint32_t index) {
    const GiShapes *shapes = check->world->trace.shapes;
    Key key = {.order = item->order, .item = index};
    GiShapeRef own = gi_shape_unplaced(shapes, item->ref);
    uint32_t i = gi_shape_index(item->ref);
    key.kind = (uint32_t)gi_shape_kind(own);
    if (gi_shape_kind(item->ref) == GI_SHAPE_PLACED) {
        key.to_world = &shapes->transforms[shapes->placements[i].transform].to_world;
    } else if (gi_shape_kind(item->ref) == GI_SHAPE_INSTANCE) {
        const GiInstance *instance = &shapes->instances[i];
        key.to_world = &shapes->transforms[instance->transform].to_world;
        /* Each tree is the first member of its store. */
        key.content = (uint32_t)((const GiTreeStore *)instance->tree - check->world->inner);
    } else if (gi_shape_kind(item->ref) == GI_SHAPE_MESH) {
        key.content = i;
    }
    put_numbers(shapes, own, key.numbers);
    key.hash = mix(UINT64_C(14695981039346656037), key.numbers, sizeof key.numbers);
    key.hash = mix(key.hash, &key.kind, sizeof key.kind);
    key.hash = mix(key.hash, &key.content, sizeof key.content);
    for (int row = 0; key.to_world != NULL && row < 3; row++) {
        for (int k = 0; k < 4; k++) {
            double value = key.to_world->m[row][k] + 0.0;
            key.hash = mix(key.hash, &value, sizeof value);
        }
    }
    return key;
}

static int compare_keys(const void *a, const void *b) {
    const Key *left = a, *right = b;
    if (left->hash != right->hash) return left->hash < right->hash ? -1 : 1;
    if (left->order != right->order) return left->order < right->order ? -1 : 1;
    return left->item < right->item ? -1 : 1;
}

static bool is_same(const Key *a, const Key *b) {
    if (a->hash != b->hash || a->kind != b->kind || a->content != b->content) return false;
    if ((a->to_world == NULL) != (b->to_world == NULL)) return false;
    for (int i = 0; i < NUMBERS; i++) {
        if (a->numbers[i] != b->numbers[i]) return false;
    }
    for (int row = 0; a->to_world != NULL && row < 3; row++) {
        for (int k = 0; k < 4; k++) {
            if (a->to_world->m[row][k] != b->to_world->m[row][k]) return false;
        }
    }
    return true;
}

/* The later of two, by its number in the order of the file. */
typedef struct Twin {
    uint32_t item, first_item;
} Twin;

static int compare_twins(const void *a, const void *b) {
    const Twin *left = a, *right = b;
    return left->item < right->item ? -1 : left->item > right->item;
}

static void report_twin(GiCheck *check, const GiCensus *items, const Twin *twin) {
    const GiCheckItem *item = &items->data[twin->item], *first = &items->data[twin->first_item];
    int64_t place = gi_check_place(check, GLINT_OBJECT_SURFACE, item->order + 1);
    const char *word = gi_check_word(check, item->ref);
    char name[GI_CHECK_NAME];
    if (item->order == first->order) {
        gi_check_add(
            check, GI_CHECK_DUPLICATE, place, "this %s is put twice into the same place", word);
        return;
    }
    gi_check_name(check, GLINT_OBJECT_SURFACE, first->order + 1, name);
    gi_check_add(check, GI_CHECK_DUPLICATE, place,
        "this %s is never seen: the %s %s is the same in the same place", word, word, name);
}

/* Of one tree: within an instance what is in it. */
static bool check_duplicates(GiCheck *check, const GiCensus *items) {
    size_t size = items->count * sizeof(Key);
    GI_ARRAY(Twin) twins = {0};
    Key *keys = gi_memory_allocate(check->memory, size);
    if (keys == NULL && items->count > 0) return false;
    for (size_t i = 0; i < items->count; i++) {
        keys[i] = key_of(check, &items->data[i], (uint32_t)i);
    }
    if (items->count > 0) qsort(keys, items->count, sizeof *keys, compare_keys);
    bool good = true;
    size_t first = 0;
    for (size_t i = 1; i < items->count && good; i++) {
        if (is_same(&keys[i], &keys[first])) {
            Twin twin = {keys[i].item, keys[first].item};
            good = gi_array_push(check->memory, &twins, twin);
        } else {
            first = i;
        }
    }
    if (twins.count > 0) qsort(twins.data, twins.count, sizeof *twins.data, compare_twins);
    for (size_t i = 0; i < twins.count; i++) report_twin(check, items, &twins.data[i]);
    gi_array_free(check->memory, &twins);
    gi_memory_free(check->memory, keys, size);
    return good;
}

static bool check_inner_duplicates(GiCheck *check) {
    bool good = true;
    for (size_t i = 0; i < check->world->inner_count && good; i++) {
        GiCensus items = {0};
        const GiTree *tree = &check->world->inner[i].tree;
        if (gi_census_is_mesh(tree) || gi_check_stopped(check)) continue;
        good = gi_census(check, tree, &items) && check_duplicates(check, &items);
        gi_array_free(check->memory, &items);
    }
    return good;
}

/* ---------------------------------------------------------------- one in the other */

enum { PAIRS = 64, GRID = 96, LEAST = 3 };

typedef struct Pair {
    uint32_t first, second; /* orders */
    int count[2];           /* rays that met both at once, by which of them came first */
} Pair;

static void note_pair(Pair *pairs, int *count, uint32_t a, uint32_t b) {
    uint32_t first = a < b ? a : b, second = a < b ? b : a;
    for (int i = 0; i < *count; i++) {
        if (pairs[i].first == first && pairs[i].second == second) {
            pairs[i].count[a > b]++;
            return;
        }
    }
    if (*count == PAIRS) return;
    pairs[*count] = (Pair){first, second, {0, 0}};
    pairs[(*count)++].count[a > b]++;
}

/* Whether right behind what the ray met there is another surface, as near as rounding can tell,
 * that turns to the same side and looks otherwise. */
static void look_behind(const GiCheck *check, const GiSight *sight, Pair *pairs, int *count) {
    const GiWorld *world = check->world;
    const GiShapes *shapes = world->trace.shapes;
    const GiTraceHit *hit = &sight->hit;
    GiTraceRay ray = {sight->origin, sight->direction, gi_world_eye_error(world, world->view.eye),
        INFINITY, hit->shape.bits, hit->instance};
    GiTraceHit other;
    if (gi_shape_kind(hit->shape) == GI_SHAPE_RECTANGLE) return;
    if (!world->kernel->closest(&world->trace, &ray, &other)) return;
    if (gi_shape_kind(other.shape) == GI_SHAPE_RECTANGLE) return;
    const GiShapeInfo *a = gi_shape_info(shapes, hit->shape, hit->instance);
    const GiShapeInfo *b = gi_shape_info(shapes, other.shape, other.instance);
    if (a->shader == b->shader) return;
    GiSurfacePoint at = gi_shape_point(
        shapes, hit->shape, hit->instance, sight->origin, sight->direction, hit->t, true);
    GiSurfacePoint behind = gi_shape_point(
        shapes, other.shape, other.instance, sight->origin, sight->direction, other.t, true);
    if (fabs(other.t - hit->t) > at.error + behind.error) return;
    if (gi_dot(at.geometric, behind.geometric) > 0.999999) {
        note_pair(pairs, count, a->order, b->order);
    }
}

static void check_coincident(GiCheck *check) {
    Pair pairs[PAIRS];
    int count = 0;
    if (check->survey.seen == 0) return;
    for (int i = 0; i < GRID * GRID; i++) {
        GiSight sight;
        double a = (i % GRID + 0.5) / GRID, b = (i / GRID + 0.5) / GRID;
        if (i % 1024 == 0 && gi_check_stopped(check)) return;
        if (gi_survey_look(check, a, b, &sight)) look_behind(check, &sight, pairs, &count);
    }
    for (int i = 0; i < count; i++) {
        char name[GI_CHECK_NAME];
        /* Where the same numbers are on both sides the first one wins everywhere: no harm done. */
        if (pairs[i].count[0] < LEAST || pairs[i].count[1] < LEAST) continue;
        gi_check_name(check, GLINT_OBJECT_SURFACE, pairs[i].first + 1, name);
        gi_check_add(check, GI_CHECK_COINCIDENT,
            gi_check_place(check, GLINT_OBJECT_SURFACE, pairs[i].second + 1),
            "this surface lies in the one %s: which of the two is seen is left to rounding", name);
    }
}

void gi_check_surfaces(GiCheck *check) {
    if (!check_duplicates(check, &check->census) || !check_inner_duplicates(check)) {
        check->status = GLINT_ERROR_MEMORY;
        return;
    }
    check_coincident(check);
}
