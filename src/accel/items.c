/* SPDX-License-Identifier: MIT */
#include "accel/items.h"

#include "accel/kernel_box.h"
#include "port/machine.h"

#include <math.h>
#include <stdlib.h>

/* ---------------------------------------------------------------- kernel space */

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool box_is_empty(const GiBox *box) { return box->low.x > box->high.x; }

/* Walks over what the tree stands over: the refs, then mesh by mesh the triangles. */
typedef struct Cursor {
    const GiShapes *shapes;
    const GiTreeInput *input;
    size_t next_ref, mesh;
    uint32_t next_triangle; /* of that mesh */
} Cursor;

static Cursor cursor_at(const GiShapes *shapes, const GiTreeInput *input, size_t index) {
    Cursor cursor = {.shapes = shapes, .input = input, .next_ref = index};
    if (index < input->ref_count) return cursor;
    cursor.next_ref = input->ref_count;
    index -= input->ref_count;
    while (index >= shapes->meshes[input->meshes[cursor.mesh]].triangle_count) {
        index -= shapes->meshes[input->meshes[cursor.mesh++]].triangle_count;
    }
    cursor.next_triangle = (uint32_t)index;
    return cursor;
}

static GiShapeRef cursor_next(Cursor *cursor) {
    const GiTreeInput *input = cursor->input;
    if (cursor->next_ref < input->ref_count) return input->refs[cursor->next_ref++];
    const GiMesh *mesh = &cursor->shapes->meshes[input->meshes[cursor->mesh]];
    while (cursor->next_triangle == mesh->triangle_count) {
        mesh = &cursor->shapes->meshes[input->meshes[++cursor->mesh]];
        cursor->next_triangle = 0;
    }
    return gi_shape_ref(GI_SHAPE_TRIANGLE, mesh->first_triangle + cursor->next_triangle++);
}

/* The median of the centres of up to 255 shapes, evenly picked. */
static GiVec median_center(const GiShapes *shapes, const GiTreeInput *input, size_t count) {
    enum { SAMPLE = 255 };
    double samples[3][SAMPLE];
    size_t found = 0, step = count / SAMPLE + 1;
    for (size_t i = 0; i < count && found < SAMPLE; i += step) {
        Cursor cursor = cursor_at(shapes, input, i);
        GiBox box = gi_shape_bounds(shapes, cursor_next(&cursor), GI_SHAPE_NONE);
        if (!gi_box_is_bounded(&box)) continue;
        samples[0][found] = box.low.x / 2 + box.high.x / 2;
        samples[1][found] = box.low.y / 2 + box.high.y / 2;
        samples[2][found] = box.low.z / 2 + box.high.z / 2;
        found++;
    }
    if (found == 0) return gi_vec(0, 0, 0);
    for (int axis = 0; axis < 3; axis++) {
        qsort(samples[axis], found, sizeof samples[axis][0], compare_doubles);
    }
    return gi_vec(samples[0][found / 2], samples[1][found / 2], samples[2][found / 2]);
}

/* ---------------------------------------------------------------- the items */

/* What one worker has seen, on cache lines of its own. */
typedef struct Survey {
    _Alignas(64) GiBox bounds; /* of what is bounded */
    size_t bounded, unbounded;
    GiExtent extent; /* of the items */
} Survey;

typedef struct Prepare {
    const GiShapes *shapes;
    const GiTreeInput *input;
    const GiMesh *mesh;
    GiVec center;
    double scale;
    GiBuildItem *items;
    Survey *surveys; /* a worker's each */
    size_t worker_count;
} Prepare;

static const GiBox empty_box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static GiBox box_around(const GiBox *a, const GiBox *b) {
    return (GiBox){{gi_smaller(a->low.x, b->low.x), gi_smaller(a->low.y, b->low.y),
                       gi_smaller(a->low.z, b->low.z)},
        {gi_larger(a->high.x, b->high.x), gi_larger(a->high.y, b->high.y),
            gi_larger(a->high.z, b->high.z)}};
}

static void reset_surveys(Prepare *prepare) {
    for (size_t i = 0; i < prepare->worker_count; i++) {
        prepare->surveys[i] = (Survey){empty_box, 0, 0, {gi_bounds_empty(), gi_bounds_empty()}};
    }
}

static Survey join_surveys(const Prepare *prepare) {
    Survey all = prepare->surveys[0];
    for (size_t i = 1; i < prepare->worker_count; i++) {
        const Survey *survey = &prepare->surveys[i];
        const GiExtent *extent = &survey->extent;
        all.bounds = box_around(&all.bounds, &survey->bounds);
        all.bounded += survey->bounded;
        all.unbounded += survey->unbounded;
        gi_bounds_grow(&all.extent.bounds, extent->bounds.low, extent->bounds.high);
        gi_bounds_grow(&all.extent.centers, extent->centers.low, extent->centers.high);
    }
    return all;
}

static void survey_refs(void *context, size_t begin, size_t end, int worker) {
    const Prepare *prepare = context;
    GiBox bounds = prepare->surveys[worker].bounds;
    for (size_t i = begin; i < end; i++) {
        GiBox box = gi_shape_bounds(prepare->shapes, prepare->input->refs[i], GI_SHAPE_NONE);
        if (gi_box_is_bounded(&box)) bounds = box_around(&bounds, &box);
    }
    prepare->surveys[worker].bounds = bounds;
}

static void survey_vertices(void *context, size_t begin, size_t end, int worker) {
    const Prepare *prepare = context;
    const float(*positions)[3] =
        prepare->shapes->triangles.positions + prepare->mesh->first_position;
    GiBox bounds = prepare->surveys[worker].bounds;
    for (size_t i = begin; i < end; i++) {
        GiVec at = gi_vec(positions[i][0], positions[i][1], positions[i][2]);
        const GiBox box = {at, at};
        bounds = box_around(&bounds, &box);
    }
    prepare->surveys[worker].bounds = bounds;
}

static double scale_of(const GiBox *bounds, GiVec center) {
    double reach = box_is_empty(bounds) ? 0 : gi_box_reach(bounds, center);
    int exponent = 0;
    if (reach > 0) frexp(reach, &exponent);
    return ldexp(1, exponent < -1000 ? 1000 : -exponent);
}

/* The scale, unless a mesh has vertices outside of its triangles. */
static double guess_scale(GiPool *pool, Prepare *prepare) {
    const GiTreeInput *input = prepare->input;
    reset_surveys(prepare);
    gi_parallel_for(pool, input->ref_count, 4096, survey_refs, prepare);
    for (size_t i = 0; i < input->mesh_count; i++) {
        prepare->mesh = &prepare->shapes->meshes[input->meshes[i]];
        gi_parallel_for(pool, prepare->mesh->position_count, 16384, survey_vertices, prepare);
    }
    Survey survey = join_surveys(prepare);
    return scale_of(&survey.bounds, prepare->center);
}

static void prepare_items(void *context, size_t begin, size_t end, int worker) {
    const Prepare *prepare = context;
    Survey survey = prepare->surveys[worker];
    Cursor cursor = cursor_at(prepare->shapes, prepare->input, begin);
    for (size_t i = begin; i < end; i++) {
        GiShapeRef ref = cursor_next(&cursor);
        GiBuildItem *item = &prepare->items[i];
        GiBox bounds = gi_shape_bounds(prepare->shapes, ref, GI_SHAPE_NONE);
        if (!gi_box_is_bounded(&bounds)) {
            item->low[0] = NAN;
            survey.unbounded += !box_is_empty(&bounds);
            continue;
        }
        GiBounds box = gi_kernel_box(&bounds, prepare->center, prepare->scale);
        gi_build_set(item, &box, ref.bits);
        gi_extent_grow(&survey.extent, &box);
        survey.bounds = box_around(&survey.bounds, &bounds);
        survey.bounded++;
    }
    prepare->surveys[worker] = survey;
}

/* Drops the items that have no bounded box, keeping the order. */
static void drop_items(GiBuildItem *items, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (!isnan(items[i].low[0])) items[kept++] = items[i];
    }
}

/* Makes the items, and finds the scale on the way. */
static Survey make_items(GiPool *pool, Prepare *prepare, size_t count) {
    double scale = guess_scale(pool, prepare);
    Survey survey;
    do {
        prepare->scale = scale;
        reset_surveys(prepare);
        gi_parallel_for(pool, count, 4096, prepare_items, prepare);
        survey = join_surveys(prepare);
        scale = scale_of(&survey.bounds, prepare->center);
    } while (scale != prepare->scale);
    if (survey.bounded < count) drop_items(prepare->items, count);
    return survey;
}

/* ---------------------------------------------------------------- the whole */

static GlintStatus list_unbounded(
    GiMemory *memory, const Prepare *prepare, size_t count, size_t unbounded, GiTreeStore *store) {
    store->tree.bounds = (GiBox){empty_box.high, empty_box.low};
    store->unbounded = gi_memory_allocate(memory, unbounded * sizeof *store->unbounded);
    if (store->unbounded == NULL) return GLINT_ERROR_MEMORY;
    store->unbounded_capacity = unbounded;
    Cursor cursor = cursor_at(prepare->shapes, prepare->input, 0);
    for (size_t i = 0; i < count; i++) {
        GiShapeRef ref = cursor_next(&cursor);
        GiBox box = gi_shape_bounds(prepare->shapes, ref, GI_SHAPE_NONE);
        if (gi_box_is_bounded(&box) || box_is_empty(&box)) continue;
        store->unbounded[store->tree.unbounded_count++] = ref;
    }
    return GLINT_OK;
}

static size_t input_count(const GiShapes *shapes, const GiTreeInput *input) {
    size_t count = input->ref_count;
    for (size_t i = 0; i < input->mesh_count; i++) {
        count += shapes->meshes[input->meshes[i]].triangle_count;
    }
    return count;
}

GlintStatus gi_items_make(GiMemory *memory, GiPool *pool, const GiShapes *shapes,
    const GiTreeInput *input, GiTreeStore *store, GiItems *items) {
    size_t count = input_count(shapes, input), workers = (size_t)gi_pool_worker_count(pool);
    store->tree.center = median_center(shapes, input, count);
    *items = (GiItems){.capacity = count};
    items->items = gi_memory_allocate_lines(memory, count, sizeof *items->items);
    gi_machine_large_pages(items->items, count * sizeof *items->items);
    Survey *surveys = gi_memory_allocate_lines(memory, workers, sizeof *surveys);
    GlintStatus status = GLINT_ERROR_MEMORY;
    if (items->items != NULL && surveys != NULL) {
        Prepare prepare = {.shapes = shapes,
            .input = input,
            .center = store->tree.center,
            .items = items->items,
            .surveys = surveys,
            .worker_count = workers};
        const Survey survey = make_items(pool, &prepare, count);
        items->count = survey.bounded;
        items->extent = survey.extent;
        store->tree.scale = prepare.scale;
        store->tree.bounds = survey.bounds;
        status = GLINT_OK;
        if (survey.unbounded > 0) {
            status = list_unbounded(memory, &prepare, count, survey.unbounded, store);
        }
    }
    gi_memory_free_lines(memory, surveys, workers, sizeof *surveys);
    if (status != GLINT_OK || items->count == 0) gi_items_free(memory, items);
    return status;
}

void gi_items_free(GiMemory *memory, GiItems *items) {
    gi_memory_free_lines(memory, items->items, items->capacity, sizeof *items->items);
    items->items = NULL;
}
