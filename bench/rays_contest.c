/* SPDX-License-Identifier: MIT */
#include "rays_contest.h"

#include "glint_scene.h"
#include "message.h"
#include "rays_embree.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- scenes */

static bool is_file(const char *name) {
    size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".xml") == 0;
}

static GlintScene *scene_load(const RaysOptions *options, const char *name) {
    GlintScene *scene = NULL;
    GlintError error = {0};
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.thread_count = 1;
    desc.isa = options->isa;
    GlintStatus status = glint_scene_create(&desc, &scene, &error);
    if (status == GLINT_OK && is_file(name)) {
        status = glint_scene_load_file(scene, name, NULL, &error);
    } else if (status == GLINT_OK) {
        BenchScene scenes[SCENE_MAX];
        scenes_parse(name, options->edge, scenes);
        status = sample_build(&scenes[0].sample, scene, &error);
    }
    if (status != GLINT_OK) message_fail("%s: %s", name, error.message);
    return scene;
}

/* Small scenes are built several times; the median counts. */
static GlintScene *scene_build(const RaysOptions *options, const char *name, RaysResult *result) {
    enum { BUILD_MAX = 5 };
    GlintScene *scene = NULL;
    double seconds[BUILD_MAX], sum = 0;
    int count = 0;
    while (count < BUILD_MAX && sum < 1) {
        glint_scene_destroy(scene);
        scene = scene_load(options, name);
        GlintError error = {0};
        double start = rays_seconds();
        if (glint_scene_commit(scene, NULL, &error) != GLINT_OK) {
            message_fail("%s: %s", name, error.message);
        }
        sum += seconds[count++] = rays_seconds() - start;
    }
    result->build_seconds = statistics_spread(seconds, count).median;
    result->primitive_count = scene->world.primitive_count;
    result->tree_bytes = (double)(scene->world.tree_bytes +
                                  scene->world.original_count * sizeof *scene->world.original);
    return scene;
}

/* ---------------------------------------------------------------- Embree's ways */

/* A mode and a tree. All are tried once; the fastest go into the contest. */
enum { WAY_MAX = 32, FINALIST_COUNT = 3 };
typedef struct Way {
    int mode, tree;
    double least;
    size_t hit_count;
    double seconds[REP_MAX], harness[REP_MAX];
} Way;

static int compare_ways(const void *a, const void *b) {
    const Way *x = a, *y = b;
    return (x->least > y->least) - (x->least < y->least);
}

static int try_ways(Embree *embree, const RaySet *set, Way ways[WAY_MAX]) {
    int count = 0;
    for (int mode = 0; embree != NULL && mode < embree_mode_count(); mode++) {
        for (int tree = 0; tree < embree_tree_count(embree); tree++) {
            embree_load(embree, mode, set);
            RayPass pass = embree_trace(embree, tree, false);
            ways[count++] = (Way){.mode = mode, .tree = tree, .least = pass.seconds};
        }
    }
    qsort(ways, (size_t)count, sizeof ways[0], compare_ways);
    return count < FINALIST_COUNT ? count : FINALIST_COUNT;
}

static void trace_way(Embree *embree, const RaySet *set, Way *way, int rep) {
    embree_load(embree, way->mode, set);
    RayPass pass = embree_trace(embree, way->tree, false);
    way->seconds[rep] = pass.seconds;
    way->hit_count = pass.hit_count;
    way->harness[rep] = embree_trace(embree, way->tree, true).seconds;
}

/* The best is the one that is fastest without the harness. */
static void keep_best(
    const Embree *embree, Way *ways, int count, int reps, RaysKindResult *result) {
    double best = INFINITY;
    for (int i = 0; i < count; i++) {
        Spread all = statistics_spread(ways[i].seconds, reps);
        Spread harness = statistics_spread(ways[i].harness, reps);
        if (!(all.median - harness.median < best)) continue;
        best = all.median - harness.median;
        result->embree = all;
        result->harness = harness;
        result->embree_hit_count = ways[i].hit_count;
        message_format(result->way, sizeof result->way, "%s %s", embree_mode_name(ways[i].mode),
            embree_tree_name(embree, ways[i].tree));
    }
}

/* ---------------------------------------------------------------- the contest */

static void run_kind(GiWorld *world, GlintTracer *tracer, Embree *embree, const RaySet *set,
    int reps, RaysKindResult *result) {
    static Way ways[WAY_MAX];
    double together[REP_MAX], single[REP_MAX];
    result->ray_count = set->count;
    if (set->count == 0) return;
    int way_count = try_ways(embree, set, ways);
    glint_trace_together(tracer, set);
    for (int rep = 0; rep < reps; rep++) {
        RayPass pass = glint_trace_together(tracer, set);
        together[rep] = pass.seconds;
        result->hit_count = pass.hit_count;
        for (int i = 0; i < way_count; i++) trace_way(embree, set, &ways[i], rep);
        single[rep] = glint_trace_single(tracer, set).seconds;
    }
    result->together = statistics_spread(together, reps);
    result->single = statistics_spread(single, reps);
    if (embree != NULL) keep_best(embree, ways, way_count, reps, result);
    result->counts = rays_count(world, tracer, set);
}

static void keep_tree(const Embree *embree, RaysResult *result) {
    int fastest = 0;
    for (int i = 1; i < embree_tree_count(embree); i++) {
        if (embree_build_seconds(embree, i) < embree_build_seconds(embree, fastest)) fastest = i;
    }
    message_format(result->tree, sizeof result->tree, "%s", embree_tree_name(embree, fastest));
    result->embree_build_seconds = embree_build_seconds(embree, fastest);
    result->embree_tree_bytes = embree_tree_bytes(embree, fastest);
}

void rays_contest(const RaysOptions *options, const char *name, RaysResult *result) {
    memset(result, 0, sizeof *result);
    const char *slash = strrchr(name, '/');
    snprintf(result->name, sizeof result->name, "%s", slash != NULL ? slash + 1 : name);
    GlintScene *scene = scene_build(options, name, result);
    Embree *embree = embree_create(&scene->world, &result->no_embree);
    result->has_embree = embree != NULL;
    if (embree != NULL) keep_tree(embree, result);
    RaySet sets[RAY_KIND_COUNT];
    rays_make(&scene->world, sets);
    GlintTracer *tracer = glint_tracer_create(&scene->world);
    for (int kind = 0; kind < RAY_KIND_COUNT; kind++) {
        run_kind(
            &scene->world, tracer, embree, &sets[kind], options->rep_count, &result->kinds[kind]);
    }
    glint_tracer_destroy(tracer);
    rays_free(sets);
    embree_destroy(embree);
    glint_scene_destroy(scene);
}
