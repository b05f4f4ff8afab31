/* SPDX-License-Identifier: MIT
 * Loading pictures and comparing them. */
#include "glint/glint.h"
#include "pictures.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *path_of(const char *name) {
    static char path[600];
    snprintf(path, sizeof path, "%s/compare-%s", test_scratch_dir(), name);
    return path;
}

static void write_bytes(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    CHECK(file != NULL && fwrite(bytes, 1, size, file) == size);
    if (file != NULL) fclose(file);
}

static void image_free(GlintImage *image) { free((void *)(uintptr_t)image->pixels); }

/* ---------------------------------------------------------------- loading */

#if defined(GI_BUILT_PNG) && defined(GI_BUILT_EXR)
/* What is saved comes back: as it was, and of a PNG with the same bytes. */
static void round_trip(void) {
    static const char *const names[] = {"a.png", "a.pfm", "a.exr"};
    GlintImage image = make_image(37, 23, 5), back;
    size_t count = 3 * 37 * 23;
    uint8_t bytes[3 * 37 * 23], again[3 * 37 * 23];
    GlintSaveDesc desc = glint_save_desc_default();
    glint_image_to_rgb8(&image, bytes);
    for (size_t i = 0; i < 3; i++) {
        const char *path = path_of(names[i]);
        CHECK_INT(glint_image_save(&image, path, &desc, NULL), GLINT_OK);
        CHECK_INT(glint_image_load(path, &back, NULL), GLINT_OK);
        CHECK(back.width == 37 && back.height == 23);
        if (back.pixels == NULL) continue;
        glint_image_to_rgb8(&back, again);
        CHECK(memcmp(bytes, again, count) == 0);
        if (i > 0) CHECK(memcmp(image.pixels, back.pixels, count * sizeof(float)) == 0);
        glint_image_free(&back);
        CHECK(back.pixels == NULL);
    }
    image_free(&image);
}
#else
static void round_trip(void) { test_skip("the modules for PNG and EXR are not built"); }
#endif

/* The sign of the third word tells the order of bytes; rows run up. */
static void pfm_order(void) {
    static const char little[] = "PF\n1 2\n-1.0\n\0\0\0\0\0\0\200\77\0\0\0\0"
                                 "\0\0\0\77\0\0\0\0\0\0\0\0";
    static const char big[] = "PF\n1 2\n1.0\n\0\0\0\0\77\200\0\0\0\0\0\0"
                              "\77\0\0\0\0\0\0\0\0\0\0\0";
    for (int i = 0; i < 2; i++) {
        GlintImage image;
        write_bytes(
            path_of("order.pfm"), i == 0 ? little : big, (i == 0 ? sizeof little : sizeof big) - 1);
        CHECK_INT(glint_image_load(path_of("order.pfm"), &image, NULL), GLINT_OK);
        if (image.pixels == NULL) continue;
        CHECK(image.pixels[0] == 0.5f && image.pixels[1] == 0);
        CHECK(image.pixels[3] == 0 && image.pixels[4] == 1);
        glint_image_free(&image);
    }
}

static void broken_files(void) {
    static const char *const texts[] = {"", "nothing", "PF\n1 1\n", "PF\n0 1\n-1\n",
        "\x76\x2f\x31\x01 and no more", "\x89PNG\r\n\x1a\n and no more"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        GlintImage image;
        GlintError error = {.status = GLINT_OK};
        write_bytes(path_of("broken"), texts[i], strlen(texts[i]));
        CHECK_INT(glint_image_load(path_of("broken"), &image, &error), GLINT_ERROR_FILE);
        CHECK(image.pixels == NULL && error.message[0] != '\0' && error.path[0] != '\0');
    }
    GlintImage image;
    CHECK_INT(glint_image_load(path_of("missing.png"), &image, NULL), GLINT_ERROR_FILE);
    CHECK_INT(glint_image_load(NULL, &image, NULL), GLINT_ERROR_ARGUMENT);
}

/* An EXR cut anywhere is refused or read, and nothing else. */
#ifdef GI_BUILT_EXR
static void cut_exr(void) {
    GlintImage image = make_image(20, 40, 9);
    GlintSaveDesc desc = glint_save_desc_default();
    CHECK_INT(glint_image_save(&image, path_of("cut.exr"), &desc, NULL), GLINT_OK);
    Bytes bytes = read_whole(path_of("cut.exr"));
    for (size_t size = 4; size < bytes.size; size += 1 + size / 7) {
        GlintImage back;
        write_bytes(path_of("part.exr"), bytes.data, size);
        CHECK_INT(glint_image_load(path_of("part.exr"), &back, NULL), GLINT_ERROR_FILE);
    }
    free(bytes.data);
    image_free(&image);
}
#else
static void cut_exr(void) { test_skip("the module for EXR is not built"); }
#endif

/* ---------------------------------------------------------------- numbers */

static float linear(int byte) { return (float)pow(byte / 255.0, 2.2); }

static void numbers(void) {
    float a[12], b[12], difference[12];
    for (int i = 0; i < 12; i++) a[i] = b[i] = linear(100);
    a[0] = linear(103), a[4] = linear(98), a[8] = linear(140);
    const GlintImage first = {2, 2, a}, second = {2, 2, b};
    GlintCompareDesc desc = glint_compare_desc_default();
    GlintComparison comparison;
    uint8_t bytes[12];
    desc.difference = difference;
    CHECK_INT(glint_image_compare(&first, &second, &desc, &comparison, NULL), GLINT_OK);
    CHECK_INT(comparison.max, 40);
    CHECK_NEAR(comparison.mean, (3 + 2 + 40) / 12.0, 1e-12);
    CHECK_NEAR(comparison.percent, 50, 1e-12);
    double apart = (double)(linear(103) - linear(100)) + (double)(linear(100) - linear(98)) +
                   (double)(linear(140) - linear(100));
    CHECK_NEAR(comparison.relative, apart / (12 * (double)linear(100)), 1e-6);
    const GlintImage shown = {2, 2, difference};
    glint_image_to_rgb8(&shown, bytes);
    CHECK(bytes[0] == 24 && bytes[1] == 0 && bytes[4] == 16 && bytes[8] == 255);
    desc.tolerance = 3;
    CHECK_INT(glint_image_compare(&first, &second, &desc, &comparison, NULL), GLINT_OK);
    CHECK_NEAR(comparison.percent, 25, 1e-12);
}

static void refused(void) {
    float pixels[12] = {0};
    const GlintImage image = {2, 2, pixels}, other = {4, 1, pixels}, none = {0};
    GlintComparison comparison;
    GlintCompareDesc desc = glint_compare_desc_default(), bad = {0};
    CHECK_INT(glint_image_compare(&image, &other, &desc, &comparison, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_compare(&none, &image, &desc, &comparison, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_compare(&image, &image, &bad, &comparison, NULL), GLINT_ERROR_ARGUMENT);
    bad = desc, bad.tolerance = 256;
    CHECK_INT(glint_image_compare(&image, &image, &bad, &comparison, NULL), GLINT_ERROR_ARGUMENT);
    bad = desc, bad.pixels_per_degree = NAN;
    CHECK_INT(glint_image_compare(&image, &image, &bad, &comparison, NULL), GLINT_ERROR_ARGUMENT);
}

/* ---------------------------------------------------------------- FLIP */

static double flip_of(const GlintImage *a, const GlintImage *b, float *map) {
    GlintCompareDesc desc = glint_compare_desc_default();
    GlintComparison comparison = {0};
    desc.flip_map = map;
    CHECK_INT(glint_image_compare(a, b, &desc, &comparison, NULL), GLINT_OK);
    return comparison.flip;
}

/* Two colours without edges: what the formula of the paper gives, worked out by hand. White on
 * black: HyAB 100, to the power 0.7 25.12; the largest, of green and blue, 41.28 and its 0.4-fold
 * 16.51; so 0.95 + 0.05 (25.12 - 16.51) / (41.28 - 16.51). */
static void flip_flat(void) {
    enum { SIDE = 8, COUNT = 3 * SIDE * SIDE };
    float black[COUNT] = {0}, white[COUNT], map[SIDE * SIDE];
    for (int i = 0; i < COUNT; i++) white[i] = 1;
    const GlintImage a = {SIDE, SIDE, black}, b = {SIDE, SIDE, white};
    CHECK_NEAR(flip_of(&a, &a, map), 0, 0);
    CHECK_NEAR(flip_of(&a, &b, map), 0.9674, 2e-4);
    CHECK_NEAR((double)map[17], 0.9674, 2e-4);
    CHECK_NEAR(flip_of(&b, &a, map), flip_of(&a, &b, NULL), 1e-12);
}

/* An edge that only one picture has counts for more than the same difference without an edge. */
static void flip_edge(void) {
    enum { SIDE = 64, COUNT = 3 * SIDE * SIDE };
    static float flat[COUNT], more[COUNT], edge[COUNT], map[SIDE * SIDE];
    for (int i = 0; i < COUNT; i++) {
        flat[i] = linear(100);
        more[i] = linear(120);
        edge[i] = linear(i / 3 % SIDE < SIDE / 2 ? 100 : 120);
    }
    const GlintImage a = {SIDE, SIDE, flat}, b = {SIDE, SIDE, more}, c = {SIDE, SIDE, edge};
    double all = flip_of(&b, &a, NULL);
    flip_of(&c, &a, map);
    int row = SIDE / 2 * SIDE;
    CHECK_NEAR((double)map[row + SIDE - 1], all, 1e-3);
    CHECK_NEAR((double)map[row], 0, 1e-6);
    CHECK((double)map[row + SIDE / 2 + 1] > all);
}

const GiTest tests_compare[] = {TEST(round_trip), TEST(pfm_order), TEST(broken_files),
    TEST(cut_exr), TEST(numbers), TEST(refused), TEST(flip_flat), TEST(flip_edge), TEST_END};
