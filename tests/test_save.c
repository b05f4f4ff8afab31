/* SPDX-License-Identifier: MIT
 * A PNG that is encoded while the picture is made: the same bytes as afterwards, in any order of
 * pixels, and nothing where it did not come to its end. */
#include "image/png.h"
#include "pictures.h"
#include "scenes.h"
#include "sched/pool.h"
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- any order */

/* Rectangles of a picture, in an order that is shuffled. */
typedef struct Puzzle {
    GiPng *png;
    const GlintImage *image;
    int side, columns;
    size_t *order;
} Puzzle;

static void put_pieces(void *context, size_t begin, size_t end, int worker) {
    const Puzzle *puzzle = context;
    const GlintImage *image = puzzle->image;
    for (size_t i = begin; i < end; i++) {
        int x = (int)puzzle->order[i] % puzzle->columns * puzzle->side;
        int y = (int)puzzle->order[i] / puzzle->columns * puzzle->side;
        int width = image->width - x < puzzle->side ? image->width - x : puzzle->side;
        int rows = image->height - y < puzzle->side ? image->height - y : puzzle->side;
        for (int row = y; row < y + rows; row++) {
            const float *from =
                image->pixels + 3 * ((size_t)row * (size_t)image->width + (size_t)x);
            CHECK(gi_png_put(puzzle->png, x, row, width, from));
        }
        CHECK(gi_png_account(puzzle->png, y, rows, width, worker));
        if (worker == 0) CHECK(gi_png_send(puzzle->png));
    }
}

static Bytes encode_in_pieces(const GlintImage *image, int side, int workers, uint32_t seed) {
    GiMemory memory, own;
    gi_memory_init(&memory, NULL, 0);
    gi_memory_init(&own, NULL, 0);
    GiPool *pool = NULL;
    CHECK_INT(gi_pool_create(&own, workers, &pool), GLINT_OK);
    Bytes bytes = {0};
    GiPngDesc desc = {.width = image->width,
        .height = image->height,
        .worker_count = workers,
        .extras.title = "pieces",
        .sink = collect,
        .user = &bytes};
    Puzzle puzzle = {.image = image, .side = side, .columns = (image->width - 1) / side + 1};
    size_t count = (size_t)puzzle.columns * (size_t)((image->height - 1) / side + 1);
    puzzle.order = malloc(count * sizeof *puzzle.order);
    for (size_t i = 0; i < count; i++) {
        size_t other = next_random(&seed) % (i + 1);
        puzzle.order[i] = puzzle.order[other];
        puzzle.order[other] = i;
    }
    CHECK_INT(gi_png_create(&memory, &desc, &puzzle.png, NULL), GLINT_OK);
    gi_parallel_for(pool, count, 1, put_pieces, &puzzle);
    CHECK_INT(gi_png_finish(puzzle.png, NULL), GLINT_OK);
    gi_png_destroy(puzzle.png);
    gi_pool_destroy(pool);
    CHECK_INT(memory.used, 0);
    free(puzzle.order);
    return bytes;
}

static void pieces_in_any_order(void) {
    static const int cases[][4] = {/* width, height, side, workers */
        {1, 1, 1, 1}, {500, 400, 32, 1}, {500, 400, 128, 3}, {513, 700, 64, 8}, {300, 900, 900, 2},
        {66000, 5, 5000, 4}, {70000, 3, 1 << 17, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const int *now = cases[i];
        GlintImage image = make_image(now[0], now[1], (uint32_t)i);
        GlintSaveDesc desc = glint_save_desc_default();
        desc.title = "pieces";
        Bytes whole = {0};
        CHECK_INT(glint_image_encode_png(&image, &desc, collect, &whole, NULL), GLINT_OK);
        for (uint32_t seed = 1; seed < 4; seed++) {
            Bytes bytes = encode_in_pieces(&image, now[2], now[3], seed);
            CHECK(bytes.size == whole.size && memcmp(bytes.data, whole.data, whole.size) == 0);
            free(bytes.data);
        }
        free(whole.data);
        free((void *)(uintptr_t)image.pixels);
    }
}

/* ---------------------------------------------------------------- scenes */

static void same_as_afterwards(void) {
    char *text = large_text(300);
    const char *folder = make_folder("meanwhile");
    for (int threads = 1; threads <= 3; threads++) {
        GlintScene *scene = scene_from_text(text, NULL, threads);
        GlintRenderDesc desc = glint_render_desc_default();
        desc.width = 700;
        desc.height = 600;
        desc.crop_x = 13;
        desc.crop_y = 17;
        desc.samples = threads == 2 ? 4 : 1;
        GlintSaveDesc save = glint_save_desc_default();
        save.title = "both";
        Picture picture = picture_of_scene(scene, &desc);
        GlintImage image = {picture.width, picture.height, picture.pixels};
        static const char *const extensions[] = {"png", "pfm"};
        GlintRecipe *recipe = NULL;
        CHECK_INT(glint_scene_recipe(scene, &desc, false, &recipe, NULL), GLINT_OK);
        for (int i = 0; i < 2; i++) {
            char meanwhile[600], afterwards[600];
            snprintf(meanwhile, sizeof meanwhile, "%s/meanwhile.%s", folder, extensions[i]);
            snprintf(afterwards, sizeof afterwards, "%s/afterwards.%s", folder, extensions[i]);
            save.recipe = recipe;
            CHECK_INT(glint_image_save(&image, afterwards, &save, NULL), GLINT_OK);
            save.recipe = NULL; /* it makes the same one */
            CHECK_INT(glint_render_save(scene, &desc, meanwhile, &save, NULL), GLINT_OK);
            Bytes a = read_whole(meanwhile), b = read_whole(afterwards);
            CHECK(a.size > 0 && a.size == b.size && memcmp(a.data, b.data, a.size) == 0);
            free(a.data);
            free(b.data);
        }
        glint_recipe_destroy(recipe);
        picture_free(&picture);
        glint_scene_destroy(scene);
    }
    CHECK_INT(count_entries(folder), 4);
    free(text);
}

typedef struct Stop {
    double at; /* this share of the drawing */
    bool now;
} Stop;

static void stop_progress(void *user, GlintPhase phase, double fraction) {
    Stop *stop = user;
    stop->now |= phase == GLINT_PHASE_TRACE && fraction >= stop->at;
}

static bool stop_cancelled(void *user) { return ((Stop *)user)->now; }

static void cancelled_leaves_nothing(void) {
    char *text = large_text(300);
    const char *folder = make_folder("cancelled");
    char path[600];
    snprintf(path, sizeof path, "%s/picture.png", folder);
    for (int threads = 1; threads <= 2; threads++) {
        GlintScene *scene = scene_from_text(text, NULL, threads);
        GlintSaveDesc save = glint_save_desc_default();
        for (int i = 0; i < 3; i++) {
            Stop stop = {.at = 0.3 * i};
            GlintMonitor monitor = {stop_progress, stop_cancelled, &stop};
            GlintRenderDesc desc = glint_render_desc_default();
            desc.width = desc.height = 600;
            desc.monitor = &monitor;
            GlintError error;
            GlintStatus status = glint_render_save(scene, &desc, path, &save, &error);
            /* The other thread may be done before the caller's is asked. */
            bool done = threads > 1 && status == GLINT_OK;
            CHECK(done || status == GLINT_CANCELLED);
            CHECK_INT(count_entries(folder), done ? 1 : 0);
            if (done) remove(path);
        }
        glint_scene_destroy(scene);
    }
    free(text);
}

static void render_save_arguments(void) {
    GlintScene *scene = scene_from_text(small_scene, NULL, 1);
    GlintRenderDesc desc = glint_render_desc_default(), raw_desc = {0};
    GlintSaveDesc save = glint_save_desc_default(), raw_save = {0};
    GlintError error;
    const char *folder = make_folder("arguments");
    char path[600], missing[700];
    snprintf(path, sizeof path, "%s/picture.png", folder);
    snprintf(missing, sizeof missing, "%s/no/picture.png", folder);
    CHECK_INT(glint_render_save(NULL, &desc, path, &save, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_render_save(scene, &raw_desc, path, &save, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_render_save(scene, &desc, path, &raw_save, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_render_save(scene, &desc, path, NULL, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_render_save(scene, &desc, NULL, &save, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_render_save(scene, &desc, "x.jpg", &save, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_render_save(scene, &desc, missing, &save, &error), GLINT_ERROR_FILE);
    save.layer_count = 1;
    CHECK_INT(glint_render_save(scene, &desc, path, &save, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(count_entries(folder), 0);
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- no memory */

typedef struct Ration {
    _Atomic int left;
} Ration;

static void *rationed(void *user, void *pointer, size_t old_size, size_t new_size) {
    Ration *ration = user;
    (void)old_size;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    return ration->left-- > 0 ? realloc(pointer, new_size) : NULL;
}

static void no_memory_leaves_nothing(void) {
    const char *folder = make_folder("no-memory");
    char path[600];
    snprintf(path, sizeof path, "%s/picture.png", folder);
    for (int threads = 1; threads <= 2; threads++) {
        Ration ration = {1 << 30};
        GlintAllocator allocator = {rationed, &ration};
        GlintSceneDesc scene_desc = glint_scene_desc_default();
        scene_desc.thread_count = threads;
        scene_desc.allocator = &allocator;
        GlintScene *scene = NULL;
        GlintError error;
        CHECK_INT(glint_scene_create(&scene_desc, &scene, &error), GLINT_OK);
        CHECK_INT(load_text(scene, small_scene, &error), GLINT_OK);
        CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
        GlintRenderDesc desc = glint_render_desc_default();
        desc.width = desc.height = 500;
        GlintSaveDesc save = glint_save_desc_default();
        bool done = false;
        for (int allowed = 0; !done && allowed < 100; allowed++) {
            ration.left = allowed;
            GlintStatus status = glint_render_save(scene, &desc, path, &save, &error);
            done = status == GLINT_OK;
            CHECK(done || status == GLINT_ERROR_MEMORY);
            CHECK_INT(count_entries(folder), done ? 1 : 0);
        }
        CHECK(done);
        remove(path);
        ration.left = 1 << 30;
        glint_scene_destroy(scene);
    }
}

const GiTest tests_save[] = {TEST(pieces_in_any_order), TEST(same_as_afterwards),
    TEST(cancelled_leaves_nothing), TEST(render_save_arguments), TEST(no_memory_leaves_nothing),
    TEST_END};
