/* SPDX-License-Identifier: MIT
 * Small pictures by hash, tolerantly compared when the hash differs; and that crops and other sizes
 * of them are what they should be. */
#include "test.h"

#include "base/array.h"
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *golden_path(const char *name) {
    static char path[4096];
    snprintf(path, sizeof path, "%s/tests/golden/%s.xml", test_source_dir(), name);
    return path;
}

static char *file_text(const char *name) {
    static char text[20000];
    FILE *file = fopen(golden_path(name), "rb");
    size_t length = file != NULL ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file != NULL) fclose(file);
    text[length] = '\0';
    if (length == 0) test_fail(__FILE__, __LINE__, "cannot read %s", golden_path(name));
    return text;
}

static void crops(void) {
    static const int parts[][4] = {{0, 0, 0, 0}, {1, 1, 1, 1}, {63, 60, 5, 9}, {64, 64, 0, 0},
        {17, 3, 80, 70}, {0, 79, 0, 1}, {127, 0, 1, 0}, {5, 0, 64, 64}};
    static const char *const names[] = {"oblique-2013", "groups-2012", "parallel-2013",
        "glass-2012", "light-2017b", "facets-2018b", "paths-glint"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        GlintScene *scene = scene_from_file(golden_path(names[k]), NULL, 2);
        GlintRenderDesc desc = glint_render_desc_default();
        desc.width = 128;
        desc.height = 80;
        Picture whole = picture_of_scene(scene, &desc);
        for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
            desc.crop_x = parts[i][0], desc.crop_y = parts[i][1];
            desc.crop_width = parts[i][2], desc.crop_height = parts[i][3];
            Picture part = picture_of_scene(scene, &desc);
            for (int row = 0; part.pixels != NULL && row < part.height; row++) {
                const float *from = part.pixels + 3 * row * part.width;
                const float *of = whole.pixels + 3 * ((parts[i][1] + row) * 128 + parts[i][0]);
                size_t bytes = 3 * (size_t)part.width * sizeof *from;
                if (memcmp(from, of, bytes) != 0) {
                    test_fail(__FILE__, __LINE__, "%s: crop %zu, row %d", names[k], i, row);
                }
            }
            picture_free(&part);
        }
        picture_free(&whole);
        glint_scene_destroy(scene);
    }
}

static void sizes(void) {
    const char *text = file_text("oblique-2013");
    GlintScene *scene = scene_from_text(text, NULL, 1);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = 77;
    desc.height = 130;
    Picture picture = picture_of_scene(scene, &desc);
    glint_scene_destroy(scene);
    /* The same as a scene that says so itself. */
    static char other[20000];
    const char *image = strstr(text, "128 80");
    snprintf(other, sizeof other, "%.*s77 130%s", (int)(image - text), text, image + 6);
    Picture expected = picture_of_text(other);
    CHECK(picture.width == 77 && picture.height == 130);
    CHECK(picture_equal(&picture, &expected));
    picture_free(&picture);
    picture_free(&expected);
}

/* ---------------------------------------------------------------- golden pictures */

static const char *const goldens[] = {
    "spheres-2011",
    "solids-2012",
    "groups-2012",
    "lights-material",
    "constant-material",
    "oblique-2013",
    "parallel-2013",
    "exposure-2017",
    "groups-2017b",
    "lambert-2018",
    "phong-2019",
    "horizon-glint",
    "glass-2012",
    "light-2017b",
    "facets-2018b",
    "paths-glint",
#ifdef GI_BUILT_PNG /* last, so that builds that read no PNG can do without it */
    "mirrors-2019",
#endif
};
enum { GOLDENS = sizeof goldens / sizeof goldens[0] };

typedef struct Hashes {
    uint64_t rgb, floats;
} Hashes;

static Hashes picture_hashes(const Picture *picture) {
    Hashes hashes = {0};
    if (picture->pixels == NULL) return hashes;
    size_t count = (size_t)picture->width * (size_t)picture->height * 3;
    uint8_t *rgb = malloc(count);
    if (rgb != NULL) {
        GlintImage image = {picture->width, picture->height, picture->pixels};
        glint_image_to_rgb8(&image, rgb);
        hashes.rgb = hash_bytes(rgb, count);
        free(rgb);
    }
    hashes.floats = hash_bytes(picture->pixels, count * sizeof *picture->pixels);
    return hashes;
}

static Picture draw_golden(const char *name, const char *isa, int threads) {
    GlintScene *scene = scene_from_file(golden_path(name), isa, threads);
    Picture picture = picture_of_scene(scene, NULL);
    glint_scene_destroy(scene);
    return picture;
}

static void print_differences(const Picture *picture, const Picture *expected) {
    int shown = 0;
    for (int i = 0; i < picture->width * picture->height && shown < 5; i++) {
        int x = i % picture->width, y = i / picture->width;
        GiVec a = picture_at(picture, x, y), b = picture_at(expected, x, y);
        if (a.x == b.x && a.y == b.y && a.z == b.z) continue;
        printf("    pixel %d %d: (%.9g %.9g %.9g), portable (%.9g %.9g %.9g)\n", x, y, a.x, a.y,
            a.z, b.x, b.y, b.z);
        shown++;
    }
    if (shown == 0)
        printf("    the portable kernel draws the same: the scene or a rule has changed\n");
}

static void check_golden(const char *name, Hashes expected) {
    static const int threads[] = {1, 2, 3, 8, 32};
    Picture portable = draw_golden(name, "portable", 1);
    const char *isa;
    for (int k = 0; (isa = glint_isa_name(k)) != NULL; k++) {
        for (int i = 0; i < 5; i++) {
            Picture picture = draw_golden(name, isa, threads[i]);
            Hashes hashes = picture_hashes(&picture);
            if (hashes.rgb != expected.rgb || hashes.floats != expected.floats) {
                test_fail(__FILE__, __LINE__, "%s, %s, %d threads: %016llx %016llx", name, isa,
                    threads[i], (unsigned long long)hashes.rgb, (unsigned long long)hashes.floats);
                if (picture.pixels != NULL && portable.pixels != NULL) {
                    print_differences(&picture, &portable);
                }
            }
            picture_free(&picture);
        }
    }
    picture_free(&portable);
}

static void update_golden(const char *path) {
    FILE *file = fopen(path, "w");
    CHECK(file != NULL);
    for (int i = 0; file != NULL && i < GOLDENS; i++) {
        Picture picture = draw_golden(goldens[i], "portable", 1);
        Hashes hashes = picture_hashes(&picture);
        fprintf(file, "%s %016llx %016llx\n", goldens[i], (unsigned long long)hashes.rgb,
            (unsigned long long)hashes.floats);
        picture_free(&picture);
    }
    if (file != NULL) CHECK(fclose(file) == 0);
}

static void golden(void) {
    char path[4096], name[100];
    snprintf(path, sizeof path, "%s/tests/golden/hashes.txt", test_source_dir());
    if (test_update_golden()) update_golden(path);
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        test_fail(__FILE__, __LINE__, "cannot read %s", path);
        return;
    }
    unsigned long long rgb, floats;
    int count = 0;
    while (count < GOLDENS && fscanf(file, "%99s %llx %llx", name, &rgb, &floats) == 3) {
        CHECK_TEXT(name, goldens[count]);
        check_golden(name, (Hashes){rgb, floats});
        count++;
    }
    fclose(file);
    CHECK_INT(count, GOLDENS);
}

const GiTest tests_golden[] = {TEST(crops), TEST(sizes), TEST(golden), TEST_END};
