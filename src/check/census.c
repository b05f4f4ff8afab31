/* SPDX-License-Identifier: MIT
 * Which surfaces stand where. After commit the trees know it: what is in a leaf is in the scene. */
#include "check/inside.h"

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- lists */

static int compare_items(const void *a, const void *b) {
    const GiCheckItem *left = a, *right = b;
    if (left->order != right->order) return left->order < right->order ? -1 : 1;
    return left->ref.bits < right->ref.bits ? -1 : left->ref.bits > right->ref.bits;
}

/* What stands in the leaves of a tree, but for ranges of triangles. False from visit ends it. */
typedef bool (*Visit)(void *user, GiShapeRef ref);

static bool visit_leaves(const GiTree *tree, Visit visit, void *user) {
    for (uint32_t i = 0; i < tree->sphere_block_count; i++) {
        const GiSphereBlock *block = &tree->sphere_blocks[i];
        for (int k = 0; k < GI_TREE_WIDTH; k++) {
            if (block->radius[k] >= 0 && !visit(user, block->shape[k])) return false;
        }
    }
    for (uint32_t i = 0; i < tree->box_block_count; i++) {
        const GiBoxBlock *block = &tree->box_blocks[i];
        for (int k = 0; k < GI_TREE_WIDTH; k++) {
            bool full = block->low[0][k] <= block->high[0][k];
            if (full && !visit(user, block->shape[k])) return false;
        }
    }
    for (uint32_t i = 0; i < tree->unbounded_count; i++) {
        if (!visit(user, tree->unbounded[i])) return false;
    }
    return true;
}

bool gi_census_is_mesh(const GiTree *tree) {
    if (tree->has_triangles) return true;
    return tree->box_block_count > 0 &&
           gi_shape_kind(tree->box_blocks[0].shape[0]) == GI_SHAPE_TRIANGLE;
}

typedef struct FirstOrder {
    const GiShapes *shapes;
    uint32_t order;
} FirstOrder;

static bool take_lower(void *user, GiShapeRef ref) {
    FirstOrder *first = user;
    uint32_t order = gi_shape_info(first->shapes, ref, GI_SHAPE_NONE)->order;
    if (order < first->order) first->order = order;
    return true;
}

/* The first of the surfaces in an instance's tree. */
static uint32_t first_order(const GiShapes *shapes, const GiTree *tree) {
    FirstOrder first = {shapes, GI_NONE};
    visit_leaves(tree, take_lower, &first);
    return first.order;
}

typedef struct Listing {
    const GiCheck *check;
    GiCensus *items;
    bool *seen; /* of each mesh, whether it is listed */
} Listing;

static GiBox mesh_bounds(const GiScene *scene, const GiMesh *mesh) {
    GiBox box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < mesh->position_count; i++) {
        const float *p = scene->meshes.positions.data[mesh->first_position + i];
        double x = (double)p[0], y = (double)p[1], z = (double)p[2];
        box.low = gi_vec(fmin(box.low.x, x), fmin(box.low.y, y), fmin(box.low.z, z));
        box.high = gi_vec(fmax(box.high.x, x), fmax(box.high.y, y), fmax(box.high.z, z));
    }
    return box;
}

/* A mesh that stands in the tree as it is, by one of its triangles. */
static bool list_mesh(Listing *listing, uint32_t triangle) {
    const GiShapes *shapes = listing->check->world->trace.shapes;
    uint32_t mesh = gi_shape_mesh(shapes, triangle);
    if (listing->seen[mesh]) return true;
    listing->seen[mesh] = true;
    GiCheckItem item = {gi_shape_ref(GI_SHAPE_MESH, mesh), shapes->mesh_info[mesh].order,
        shapes->mesh_info[mesh].shader, mesh_bounds(listing->check->scene, &shapes->meshes[mesh])};
    return gi_array_push(listing->check->memory, listing->items, item);
}

static bool list_shape(void *user, GiShapeRef ref) {
    Listing *listing = user;
    const GiShapes *shapes = listing->check->world->trace.shapes;
    if (gi_shape_kind(ref) == GI_SHAPE_RECTANGLE) return true; /* a light */
    if (gi_shape_kind(ref) == GI_SHAPE_TRIANGLE) return list_mesh(listing, gi_shape_index(ref));
    GiCheckItem item = {.ref = ref, .bounds = gi_shape_bounds(shapes, ref, GI_SHAPE_NONE)};
    const GiShapeInfo *info = NULL;
    if (gi_shape_kind(ref) != GI_SHAPE_INSTANCE) {
        info = gi_shape_info(shapes, ref, GI_SHAPE_NONE);
    } else if (gi_census_is_mesh(shapes->instances[gi_shape_index(ref)].tree)) {
        info = &shapes->instances[gi_shape_index(ref)].info;
    }
    item.order = info != NULL ? info->order
                              : first_order(shapes, shapes->instances[gi_shape_index(ref)].tree);
    item.shader = info != NULL ? info->shader : GI_NONE;
    return gi_array_push(listing->check->memory, listing->items, item);
}

static bool list_ranges(Listing *listing, const GiTree *tree) {
    for (uint32_t i = 0; i <= tree->node_count; i++) {
        const uint32_t *children = i < tree->node_count ? tree->nodes[i].child : &tree->root;
        int count = i < tree->node_count ? GI_TREE_WIDTH : 1;
        for (int k = 0; k < count; k++) {
            bool range =
                children[k] != GI_CHILD_NONE && gi_child_kind(children[k]) == GI_CHILD_TRIANGLES;
            if (range && !list_mesh(listing, gi_child_first(children[k]))) return false;
        }
    }
    return true;
}

bool gi_census(const GiCheck *check, const GiTree *tree, GiCensus *items) {
    size_t meshes = check->scene->meshes.meshes.count;
    Listing listing = {check, items, NULL};
    if (meshes > 0) {
        listing.seen = gi_memory_allocate(check->memory, meshes * sizeof *listing.seen);
        if (listing.seen == NULL) return false;
        memset(listing.seen, 0, meshes * sizeof *listing.seen);
    }
    bool good = visit_leaves(tree, list_shape, &listing) && list_ranges(&listing, tree);
    gi_memory_free(check->memory, listing.seen, meshes * sizeof *listing.seen);
    if (items->count > 0) qsort(items->data, items->count, sizeof *items->data, compare_items);
    return good;
}

const char *gi_check_word(const GiCheck *check, GiShapeRef ref) {
    const GiShapes *shapes = check->world->trace.shapes;
    ref = gi_shape_unplaced(shapes, ref);
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE: return "sphere";
    case GI_SHAPE_BOX: return "box";
    case GI_SHAPE_CONE: return shapes->cones[gi_shape_index(ref)].slope == 0 ? "cylinder" : "cone";
    case GI_SHAPE_DISC: return "disc";
    case GI_SHAPE_PLANE: return "plane";
    case GI_SHAPE_INSTANCE:
        return gi_census_is_mesh(shapes->instances[gi_shape_index(ref)].tree) ? "mesh" : "group";
    default: return "mesh";
    }
}

/* ---------------------------------------------------------------- solids round a point */

typedef struct Search {
    const GiShapes *shapes;
    double slack;
    GiSolid *solids;
    int count;
} Search;

static bool between(double low, double x, double high, double slack) {
    double reach = slack * (high - low);
    return low - reach < x && x < high + reach;
}

static bool is_inside(const Search *search, GiShapeRef ref, GiVec p) {
    const GiShapes *shapes = search->shapes;
    uint32_t i = gi_shape_index(ref);
    double slack = search->slack;
    switch (gi_shape_kind(ref)) {
    case GI_SHAPE_SPHERE: {
        const GiSphere *sphere = &shapes->spheres[i];
        return gi_length(gi_sub(p, sphere->center)) < sphere->radius * (1 + slack);
    }
    case GI_SHAPE_BOX: {
        const GiBox *box = &shapes->boxes[i];
        return between(box->low.x, p.x, box->high.x, slack) &&
               between(box->low.y, p.y, box->high.y, slack) &&
               between(box->low.z, p.z, box->high.z, slack);
    }
    case GI_SHAPE_CONE: {
        const GiCone *cone = &shapes->cones[i];
        GiVec from = gi_sub(p, cone->center);
        double radius = fabs(cone->radius + cone->slope * from.z);
        return fabs(from.z) < cone->half_height * (1 + slack) &&
               hypot(from.x, from.y) < radius * (1 + slack);
    }
    default: return false;
    }
}

static void search_tree(Search *search, const GiTree *tree, GiVec p);

static void test(Search *search, GiShapeRef ref, GiVec p) {
    const GiShapes *shapes = search->shapes;
    uint32_t i = gi_shape_index(ref);
    if (gi_shape_kind(ref) == GI_SHAPE_INSTANCE) {
        const GiInstance *instance = &shapes->instances[i];
        const GiAffine *to_object = &shapes->transforms[instance->transform].to_object;
        search_tree(search, instance->tree, gi_affine_point(to_object, p));
        return;
    }
    if (gi_shape_kind(ref) == GI_SHAPE_PLACED) {
        p = gi_affine_point(&shapes->transforms[shapes->placements[i].transform].to_object, p);
    }
    if (search->count == GI_SOLID_LIMIT || !is_inside(search, gi_shape_unplaced(shapes, ref), p)) {
        return;
    }
    const GiShapeInfo *info = gi_shape_info(shapes, ref, GI_SHAPE_NONE);
    search->solids[search->count++] = (GiSolid){ref, info->order, info->shader};
}

static bool has(const float low[3][8], const float high[3][8], int k, const float p[3]) {
    for (int axis = 0; axis < 3; axis++) {
        if (!(low[axis][k] <= p[axis] && p[axis] <= high[axis][k])) return false;
    }
    return true;
}

static void search_leaf(Search *search, const GiTree *tree, uint32_t child, GiVec p) {
    bool spheres = gi_child_kind(child) == GI_CHILD_SPHERES;
    if (!spheres && gi_child_kind(child) != GI_CHILD_BOXES) return;
    uint32_t index = gi_child_index(child);
    for (int k = 0; k < GI_TREE_WIDTH; k++) {
        const GiSphereBlock *block = &tree->sphere_blocks[index];
        const GiBoxBlock *boxes = &tree->box_blocks[index];
        bool full = spheres ? block->radius[k] >= 0 : boxes->low[0][k] <= boxes->high[0][k];
        if (full) test(search, spheres ? block->shape[k] : boxes->shape[k], p);
    }
}

/* The boxes of the tree are larger by a two-millionth of their distance from its centre, which
 * covers the rounding of the point and the slack. */
static void search_tree(Search *search, const GiTree *tree, GiVec p) {
    uint32_t stack[GI_TREE_DEPTH_LIMIT * GI_TREE_WIDTH];
    int count = 0;
    GiVec inner = gi_scale(gi_sub(p, tree->center), tree->scale);
    const float at[3] = {(float)inner.x, (float)inner.y, (float)inner.z};
    if (tree->root != GI_CHILD_NONE) stack[count++] = tree->root;
    while (count > 0) {
        uint32_t child = stack[--count];
        if (gi_child_kind(child) != GI_CHILD_NODE) {
            search_leaf(search, tree, child, p);
            continue;
        }
        const GiNode *node = &tree->nodes[gi_child_index(child)];
        for (int k = 0; k < GI_TREE_WIDTH; k++) {
            if (node->child[k] != GI_CHILD_NONE && has(node->low, node->high, k, at)) {
                stack[count++] = node->child[k];
            }
        }
    }
}

/* A mesh is round a point when in every direction its back is met first. */
static bool find_mesh(const GiCheck *check, GiVec p, GiSolid *solid) {
    enum { REACH = 2 };
    const GiWorld *world = check->world;
    const GiShapes *shapes = world->trace.shapes;
    bool first = true;
    for (int i = 0; i < 125; i++) {
        GiVec d = gi_vec(i % 5 - REACH, i / 5 % 5 - REACH, i / 25 - REACH);
        GiTraceRay ray = {p, d, 0, INFINITY, GI_SHAPE_NONE, GI_SHAPE_NONE};
        GiTraceHit hit;
        if (gi_vec_is_zero(d)) continue;
        if (!world->kernel->closest(&world->trace, &ray, &hit)) return false;
        if (gi_shape_kind(hit.shape) != GI_SHAPE_TRIANGLE) return false;
        const GiShapeInfo *info = gi_shape_info(shapes, hit.shape, hit.instance);
        GiSurfacePoint at = gi_shape_point(shapes, hit.shape, hit.instance, p, d, hit.t, true);
        if (gi_dot(at.geometric, d) <= 0 || (!first && info->order != solid->order)) return false;
        uint32_t mesh = gi_shape_mesh(shapes, gi_shape_index(hit.shape));
        *solid = (GiSolid){gi_shape_ref(GI_SHAPE_MESH, mesh), info->order, info->shader};
        first = false;
    }
    return true;
}

int gi_check_solids(
    const GiCheck *check, GiVec point, double slack, GiSolid solids[GI_SOLID_LIMIT]) {
    Search search = {check->world->trace.shapes, slack, solids, 0};
    search_tree(&search, check->world->trace.tree, point);
    GiSolid mesh;
    if (check->scene->meshes.meshes.count > 0 && search.count < GI_SOLID_LIMIT &&
        find_mesh(check, point, &mesh)) {
        solids[search.count++] = mesh;
    }
    return search.count;
}
