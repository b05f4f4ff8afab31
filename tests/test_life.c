/* SPDX-License-Identifier: MIT
 * The whole life of a scene when memory is short, and of several scenes at once. */
#include "test.h"

#include "random.h"
#include "scenes.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- memory */

/* Refuses the requests from number `fail_at` on, or only that one; knows every block's size. */
typedef struct Ledger {
    _Atomic long requests, live, wrong;
    long fail_at; /* from 1; 0: never */
    bool fail_on; /* all further ones too */
} Ledger;

enum { HEAD = 32 };

static void *ledger_reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    Ledger *ledger = user;
    char *block = pointer != NULL ? (char *)pointer - HEAD : NULL;
    size_t known = 0;
    if (block != NULL) memcpy(&known, block, sizeof known);
    if (known != old_size) atomic_fetch_add(&ledger->wrong, 1);
    if (new_size == 0) {
        if (block != NULL) atomic_fetch_sub(&ledger->live, 1);
        free(block);
        return NULL;
    }
    long number = atomic_fetch_add(&ledger->requests, 1) + 1;
    if (ledger->fail_at > 0 && number >= ledger->fail_at &&
        (ledger->fail_on || number == ledger->fail_at)) {
        return NULL;
    }
    char *grown = realloc(block, new_size + HEAD);
    if (grown == NULL) return NULL;
    if (block == NULL) atomic_fetch_add(&ledger->live, 1);
    memcpy(grown, &new_size, sizeof new_size);
    return grown + HEAD;
}

static GlintStatus live(const char *text, const GlintSceneDesc *desc, uint64_t *peak) {
    static float pixels[200 * 200 * 3];
    GlintScene *scene = NULL;
    GlintError error = {0};
    GlintStatus status = glint_scene_create(desc, &scene, &error);
    if (status == GLINT_OK) status = load_text(scene, text, &error);
    if (status == GLINT_OK) status = glint_scene_commit(scene, NULL, &error);
    GlintRenderDesc render = glint_render_desc_default();
    if (status == GLINT_OK) status = glint_render(scene, &render, pixels, &error);
    CHECK_INT(error.status, status);
    if (status != GLINT_OK) CHECK(error.message[0] != '\0');
    if (scene != NULL && peak != NULL) {
        GlintStats stats;
        glint_scene_stats(scene, &stats);
        *peak = stats.memory_peak;
    }
    glint_scene_destroy(scene);
    return status;
}

/* Every request in turn is refused: the whole life ends with MEMORY or gets along without. */
static void fail_every_request(const char *text, const char *what) {
    for (int fail_on = 0; fail_on < 2; fail_on++) {
        long failed = 0;
        for (long n = 1;; n++) {
            Ledger ledger = {.fail_at = n, .fail_on = fail_on};
            GlintAllocator allocator = {ledger_reallocate, &ledger};
            GlintSceneDesc desc = glint_scene_desc_default();
            desc.allocator = &allocator;
            desc.thread_count = 3;
            GlintStatus status = live(text, &desc, NULL);
            bool reached = atomic_load(&ledger.requests) >= n;
            bool good =
                reached ? status == GLINT_OK || status == GLINT_ERROR_MEMORY : status == GLINT_OK;
            if (!good || atomic_load(&ledger.live) != 0 || atomic_load(&ledger.wrong) != 0) {
                test_fail(__FILE__, __LINE__,
                    "%s, request %ld: status %d, %ld blocks live, %ld sizes "
                    "wrong",
                    what, n, status, atomic_load(&ledger.live), atomic_load(&ledger.wrong));
            }
            failed += status == GLINT_ERROR_MEMORY;
            if (!reached || n > 3000) break;
        }
        CHECK(failed > 10);
    }
}

/* Glass, so that arrays of rays grow while the picture is drawn, and all that a world prepares. */
static const char *rays_scene(void) {
    static char text[2000];
    snprintf(text, sizeof text,
        "<scene dialect='glint'><camera><viewPoint>0 0 4</viewPoint></camera><image>40 40</image>"
        "<environment type='Cubemap'><filename>%s/tests/golden/sky.pfm</filename></environment>"
        "<light type='RectangleLight'><position>0 1.5 0</position><normalDir>0 -1 0</normalDir>"
        "<upDir>0 0 1</upDir></light><shader name='g' type='Glass'><refractiveIndex>1.5"
        "</refractiveIndex></shader><surface type='Sphere'><shader ref='g'/></surface>"
        "<surface type='Group'><scale>.5 .5 .5</scale><surface type='Mesh'><data>%s/tests/golden/"
        "gem.obj</data><shader ref='g'/></surface></surface></scene>",
        test_source_dir(), test_source_dir());
    return text;
}

static void failing_allocator(void) {
    fail_every_request(small_scene, "small scene");
    char *text = large_text(3000);
    CHECK(text != NULL);
    if (text != NULL) fail_every_request(text, "large scene");
    free(text);
    fail_every_request(rays_scene(), "scene of rays that go on");
}

static void *build_by_calls(void *user) {
    GlintAllocator allocator = {ledger_reallocate, user};
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.allocator = &allocator;
    desc.thread_count = 1;
    GlintScene *scene = NULL;
    GlintStatus status = glint_scene_create(&desc, &scene, NULL);
    GlintSurfaceId group = {0};
    for (int i = 0; i < 40 && status == GLINT_OK; i++) {
        GlintSurfaceDesc surface =
            glint_surface_desc_default((GlintSurfaceType)(i % (GLINT_SURFACE_GROUP + 1)));
        surface.tip_z = 3;
        surface.parent = group;
        GlintSurfaceId id;
        status = glint_scene_add_surface(scene, &surface, &id, NULL);
        if (status == GLINT_OK && surface.type == GLINT_SURFACE_GROUP) group = id;
        GlintShaderDesc shader = glint_shader_desc_default();
        if (status == GLINT_OK) status = glint_scene_add_shader(scene, &shader, NULL, NULL);
        GlintLightDesc light = glint_light_desc_default();
        if (status == GLINT_OK) status = glint_scene_add_light(scene, &light, NULL);
    }
    GlintImageDesc image = glint_image_desc_default();
    GlintCameraDesc camera = glint_camera_desc_default();
    if (status == GLINT_OK) status = glint_scene_set_image(scene, &image, NULL);
    if (status == GLINT_OK) status = glint_scene_set_camera(scene, &camera, NULL);
    if (status == GLINT_OK) status = glint_scene_commit(scene, NULL, NULL);
    CHECK(status == GLINT_OK || status == GLINT_ERROR_MEMORY);
    glint_scene_destroy(scene);
    return NULL;
}

static void failing_allocator_by_calls(void) {
    for (long n = 0; n < 1000; n++) {
        Ledger ledger = {.fail_at = n};
        build_by_calls(&ledger);
        CHECK_INT(atomic_load(&ledger.live), 0);
        CHECK_INT(atomic_load(&ledger.wrong), 0);
        if (n > 0 && atomic_load(&ledger.requests) < n) return;
    }
    test_fail(__FILE__, __LINE__, "there is no end of requests");
}

static void memory_limits(void) {
    char *text = large_text(3000);
    CHECK(text != NULL);
    int refused = 0;
    GlintStatus status = GLINT_ERROR_MEMORY;
    for (size_t limit = 100; text != NULL && limit < 1u << 30; limit += limit / 6) {
        GlintSceneDesc desc = glint_scene_desc_default();
        desc.thread_count = 2;
        desc.memory_limit = limit;
        uint64_t peak = 0;
        status = live(text, &desc, &peak);
        CHECK(status == GLINT_OK || status == GLINT_ERROR_MEMORY);
        CHECK(peak <= limit);
        if (status == GLINT_OK) break;
        refused++;
    }
    CHECK_INT(status, GLINT_OK);
    CHECK(refused > 20);
    free(text);
    status = GLINT_ERROR_MEMORY;
    for (size_t limit = 10000; status == GLINT_ERROR_MEMORY && limit < 1u << 30;
         limit += limit / 16) {
        GlintSceneDesc desc = glint_scene_desc_default();
        desc.thread_count = 1;
        desc.memory_limit = limit;
        uint64_t peak = 0;
        status = live(rays_scene(), &desc, &peak);
        CHECK(peak <= limit);
    }
    CHECK_INT(status, GLINT_OK);
}

/* ---------------------------------------------------------------- threads */

typedef struct Work {
    const char *text;
    Picture expected;
    const GlintScene *shared;
    int wrong;
} Work;

static void *draw_alone(void *user) {
    Work *work = user;
    for (int i = 0; i < 6; i++) {
        GlintScene *scene = scene_from_text(work->text, NULL, 2);
        Picture picture = picture_of_scene(scene, NULL);
        work->wrong += !picture_equal(&picture, &work->expected);
        picture_free(&picture);
        glint_scene_destroy(scene);
    }
    return NULL;
}

static void two_scenes_at_once(void) {
    char *large = large_text(500);
    Work work[2] = {{.text = small_scene}, {.text = large}};
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) work[i].expected = picture_of_text(work[i].text);
    for (int i = 0; i < 2; i++) CHECK(pthread_create(&threads[i], NULL, draw_alone, &work[i]) == 0);
    for (int i = 0; i < 2; i++) {
        pthread_join(threads[i], NULL);
        CHECK_INT(work[i].wrong, 0);
        picture_free(&work[i].expected);
    }
    free(large);
}

/* A number that depends on every hit. */
static uint64_t trace_all(const GlintScene *scene) {
    Random random = {77};
    uint64_t hash = 0;
    for (int i = 0; i < 4000; i++) {
        GiVec p = random_vec(&random, -6, 6), d = random_vec(&random, -1, 1);
        GlintRay ray = {{p.x, p.y, p.z}, {d.x, d.y, d.z}, 0, INFINITY};
        GlintHit hit = {0};
        bool any = glint_trace(scene, &ray, &hit);
        hash = hash * 31 + hash_bytes(&hit.t, sizeof hit.t) +
               hash_bytes(hit.normal, sizeof hit.normal);
        hash += hit.surface.index1 + (any == glint_occluded(scene, &ray));
    }
    return hash;
}

static void *trace_shared(void *user) {
    Work *work = user;
    uint64_t hash = trace_all(work->shared);
    for (int i = 0; i < 3; i++) work->wrong += trace_all(work->shared) != hash;
    work->expected.width = (int)(hash & 0x7fffffff);
    return NULL;
}

static void one_scene_from_many_threads(void) {
    char *text = large_text(500);
    GlintScene *scene = scene_from_text(text, NULL, 1);
    int expected = (int)(trace_all(scene) & 0x7fffffff);
    Work work[4];
    pthread_t threads[4];
    for (int i = 0; i < 4; i++) {
        work[i] = (Work){.shared = scene};
        CHECK(pthread_create(&threads[i], NULL, trace_shared, &work[i]) == 0);
    }
    for (int i = 0; i < 4; i++) {
        pthread_join(threads[i], NULL);
        CHECK(work[i].wrong == 0 && work[i].expected.width == expected);
    }
    glint_scene_destroy(scene);
    free(text);
}

const GiTest tests_life[] = {TEST(failing_allocator), TEST(failing_allocator_by_calls),
    TEST(memory_limits), TEST(two_scenes_at_once), TEST(one_scene_from_many_threads), TEST_END};
