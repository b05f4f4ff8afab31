/* SPDX-License-Identifier: MIT
 * A picture is the same bits whatever it is drawn in: tiles of any side in any order, any number of
 * threads, any instruction set, whole or in part. */
#include "test.h"

#include "glint_scene.h"
#include "random.h"
#include "render/tile.h"
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What bundles find difficult: a light in the middle of the scene with things all around it, one
 * within a solid, one on a surface, one in the eye; the eye in a solid that reaches behind it, and
 * shapes at, behind and across its plane. */
static const char *const surrounded =
    "<scene dialect='glint'><camera type='PerspectiveCamera'><viewPoint>0 0 0</viewPoint>"
    "<viewDir>0 0 -1</viewDir><projDistance>%s</projDistance></camera><image>128 80</image>"
    "<light><position>0 0 -3</position></light><light><position>1.5 .5 -4</position></light>"
    "<light><position>0 -2 -5</position></light><light><position>0 0 0</position></light>"
    "<shader name='p' type='Phong'><exponent>20</exponent></shader>"
    "<surface type='Box'><minPt>-9 -2 -9</minPt><maxPt>9 6 9</maxPt></surface>"
    "<surface type='Box'><minPt>-1 -1 -1</minPt><maxPt>-.2 1 1</maxPt></surface>"
    "<surface type='Box'><minPt>.3 -1 0</minPt><maxPt>.5 1 2</maxPt></surface>"
    "<surface type='Sphere'><center>1.5 .5 -4</center><radius>.4</radius><shader ref='p'/>"
    "</surface><surface type='Sphere'><center>0 0 3</center></surface>"
    "<surface type='Sphere'><center>0 1.5 0</center><radius>1.2</radius><shader ref='p'/>"
    "</surface><surface type='Cylinder'><center>-2 0 -4</center><radius>.5</radius></surface>"
    "<surface type='Cone'><center>.5 -1 -3</center><radius>.4</radius><tipz>-2.7</tipz></surface>"
    "<surface type='Disc'><point>0 0 -4</point><normal>1 0 .2</normal><radius>.8</radius>"
    "<shader ref='p'/></surface>"
    "<surface type='Group'><translate>2 -1 -3</translate><rotate>20 30 40</rotate>"
    "<scale>.4 .7 -.5</scale><surface type='Sphere'/><surface type='Box'><maxPt>2 2 .1</maxPt>"
    "</surface></surface></scene>";

static const char *const names[] = {"near", "wide", "oblique-2013", "groups-2012", "parallel-2013",
    "glass-2012", "light-2017b", "facets-2018b", "paths-glint"};
enum { NAMES = sizeof names / sizeof *names };

static GlintScene *scene_of(int k, const char *isa, int threads) {
    static char text[8000];
    if (k < 2) {
        snprintf(text, sizeof text, surrounded, k == 0 ? "1.5" : ".2");
        return scene_from_text(text, isa, threads);
    }
    snprintf(text, sizeof text, "%s/tests/golden/%s.xml", test_source_dir(), names[k]);
    return scene_from_file(text, isa, threads);
}

static void expect_equal(int k, const Picture *a, const Picture *b, const char *what, int value) {
    if (picture_equal(a, b)) return;
    test_fail(__FILE__, __LINE__, "%s, %d x %d, %s %d: not the same picture", names[k], a->width,
        a->height, what, value);
}

/* With tiles of the given size, in an order by chance. */
static Picture draw_with_size(
    GlintScene *scene, int width, int height, GiTileSize size, Random *random) {
    Picture picture = {width, height, malloc((size_t)(width * height) * 3 * sizeof(float))};
    GiRenderArea area = {width, height, 0, 0, width, height};
    GiRenderTarget target = {.samples = 1, .color = picture.pixels};
    _Atomic bool stop = false;
    GiTileControl control = {&stop, NULL, 0};
    GiRenderCounts counts = {0};
    int columns = (width + size.width - 1) / size.width;
    int count = columns * ((height + size.height - 1) / size.height);
    int *order = malloc((size_t)count * sizeof *order);
    GiTileScratch *scratch = gi_tile_scratch_create(&scene->world, &target);
    CHECK(picture.pixels != NULL && order != NULL && scratch != NULL);
    for (int i = 0; i < count; i++) {
        int at = random_below(random, i + 1);
        order[i] = order[at];
        order[at] = i;
    }
    for (int i = 0; i < count; i++) {
        CHECK(gi_tile_draw(&scene->world, &area, order[i] % columns * size.width,
            order[i] / columns * size.height, size, &target, scratch, &counts, &control));
    }
    CHECK_INT(counts.camera_rays, width * height);
    gi_tile_scratch_destroy(&scene->memory, scratch);
    free(order);
    return picture;
}

static Picture draw_size(GlintScene *scene, int width, int height) {
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = width;
    desc.height = height;
    desc.samples = 1;
    return picture_of_scene(scene, &desc);
}

static void sides(void) {
    static const GiTileSize sizes[] = {
        {128, 128}, {100, 100}, {64, 64}, {64, 32}, {33, 33}, {32, 32}, {7, 31}, {5, 5}};
    Random random = {41};
    for (int k = 0; k < NAMES; k++) {
        GlintScene *scene = scene_of(k, NULL, 2);
        Picture whole = draw_size(scene, 157, 131);
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
            Picture tiled = draw_with_size(scene, 157, 131, sizes[i], &random);
            expect_equal(k, &whole, &tiled, "tiles of width", sizes[i].width);
            picture_free(&tiled);
        }
        picture_free(&whole);
        glint_scene_destroy(scene);
    }
}

/* Sizes that no tile divides, and pictures of one row or column. */
static void threads_and_kernels(void) {
    static const int picture_sizes[][2] = {{161, 97}, {1, 150}, {150, 1}, {33, 31}, {1, 1}};
    static const int threads[] = {1, 2, 3, 8};
    for (int k = 0; k < NAMES; k++) {
        for (size_t s = 0; s < sizeof picture_sizes / sizeof *picture_sizes; s++) {
            int width = picture_sizes[s][0], height = picture_sizes[s][1];
            GlintScene *scene = scene_of(k, "portable", 1);
            Picture first = draw_size(scene, width, height);
            glint_scene_destroy(scene);
            const char *isa;
            for (int i = 0; (isa = glint_isa_name(i)) != NULL; i++) {
                int count = threads[(i + (int)s + k) % 4];
                scene = scene_of(k, isa, count);
                Picture picture = draw_size(scene, width, height);
                expect_equal(k, &first, &picture, isa, count);
                picture_free(&picture);
                glint_scene_destroy(scene);
            }
            picture_free(&first);
        }
    }
}

static void parts_of_pictures(void) {
    enum { WIDTH = 300, HEIGHT = 210 };
    Random random = {42};
    for (int k = 0; k < NAMES; k++) {
        GlintScene *scene = scene_of(k, NULL, 2);
        Picture whole = draw_size(scene, WIDTH, HEIGHT);
        for (int i = 0; i < 12; i++) {
            GlintRenderDesc desc = glint_render_desc_default();
            desc.width = WIDTH, desc.height = HEIGHT, desc.samples = 1;
            desc.crop_x = random_below(&random, WIDTH);
            desc.crop_y = random_below(&random, HEIGHT);
            desc.crop_width = 1 + random_below(&random, WIDTH - desc.crop_x);
            desc.crop_height = 1 + random_below(&random, HEIGHT - desc.crop_y);
            if (i % 4 == 2) desc.crop_width = 1;
            if (i % 4 == 3) desc.crop_height = 1;
            Picture part = picture_of_scene(scene, &desc);
            Picture same = {part.width, part.height, NULL};
            size_t row = 3 * (size_t)part.width;
            same.pixels = malloc(row * (size_t)part.height * sizeof *same.pixels);
            CHECK(same.pixels != NULL && whole.pixels != NULL);
            for (int y = 0; y < part.height; y++) {
                const float *from = whole.pixels + 3 * ((desc.crop_y + y) * WIDTH + desc.crop_x);
                memcpy(same.pixels + (size_t)y * row, from, row * sizeof *from);
            }
            expect_equal(k, &part, &same, "part", i);
            picture_free(&part);
            picture_free(&same);
        }
        picture_free(&whole);
        glint_scene_destroy(scene);
    }
}

const GiTest tests_tiles[] = {
    TEST(sides), TEST(threads_and_kernels), TEST(parts_of_pictures), TEST_END};
