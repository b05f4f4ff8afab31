/* SPDX-License-Identifier: MIT
 * Mistakes on purpose: their names, that each does what it says, and that pictures with them are as
 * exact as others. */
#include "glint/glint.h"
#include "scenes.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static GlintMistakes one(GlintMistake mistake) {
    return (GlintMistakes){.set = GLINT_MISTAKE_BIT(mistake)};
}

/* ---------------------------------------------------------------- words */

static void names(void) {
    for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
        GlintMistake found = GLINT_MISTAKE_COUNT;
        const char *name = glint_mistake_name((GlintMistake)i);
        CHECK(glint_mistake_from_name(name, &found));
        CHECK_INT(found, i);
        CHECK(strlen(name) <= 20 && strlen(glint_mistake_text((GlintMistake)i)) > 5);
    }
    GlintMistake untouched = GLINT_MISTAKE_BGR;
    CHECK(!glint_mistake_from_name("list", &untouched) && untouched == GLINT_MISTAKE_BGR);
    CHECK(glint_mistake_name(GLINT_MISTAKE_COUNT) == NULL);
    CHECK(glint_mistake_text((GlintMistake)-1) == NULL);
}

static void text(void) {
    static const char *const good[] = {"no-shadows", "shifted", "shifted=1:1", "shifted=-2:0",
        "light-missing", "light-missing=7", "brightness", "brightness=0.318309886",
        "brightness=3.000000001", "shifted=0:1,no-shadows,light-missing=2,brightness=2.000000000"};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        GlintMistakes mistakes = {0};
        const char *wrong;
        char again[256];
        CHECK(glint_mistakes_parse(good[i], &mistakes, &wrong));
        size_t length = glint_mistakes_format(&mistakes, again, sizeof again);
        CHECK_TEXT(again, good[i]);
        CHECK_INT(length, strlen(good[i]));
    }
    static const char *const bad[] = {"", "no-shadow", "no-shadows,", ",bgr", "bgr=1", "bgr bgr",
        "light-missing=", "light-missing=0", "light-missing=-1", "shifted=1",
        "shifted=1:", "shifted=1:x", "brightness=-1", "brightness=0", "brightness=1.",
        "brightness=.5", "brightness=99999999999", "a-name-that-is-longer-than-any-mistake-has"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        GlintMistakes mistakes = {0};
        const char *wrong = NULL;
        if (glint_mistakes_parse(bad[i], &mistakes, &wrong)) {
            test_fail(__FILE__, __LINE__, "\"%s\" was understood", bad[i]);
        }
        CHECK(wrong >= bad[i] && wrong <= bad[i] + strlen(bad[i]));
    }
    const GlintMistakes all = {.set = GLINT_MISTAKE_BIT(GLINT_MISTAKE_COUNT) - 1};
    char cut[8] = "xxxxxxx";
    CHECK(glint_mistakes_format(&all, cut, sizeof cut) > 400);
    CHECK_TEXT(cut, "shifted");
}

/* ---------------------------------------------------------------- pictures */

static const char *scene_path(void) {
    static char path[4096];
    snprintf(path, sizeof path, "%s/tests/mistakes.xml", test_source_dir());
    return path;
}

static GlintRenderDesc small_desc(GlintMistakes mistakes) {
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = 48;
    desc.height = 36;
    desc.mistakes = mistakes;
    return desc;
}

static Picture broken(GlintScene *scene, GlintMistakes mistakes) {
    GlintRenderDesc desc = small_desc(mistakes);
    return picture_of_scene(scene, &desc);
}

/* The scene has something for all of them but two, and drawing it wrongly leaves it as it was. */
static void each_differs(void) {
    GlintScene *scene = scene_from_file(scene_path(), NULL, 1);
    const GlintMistakes none = {0};
    Picture right = broken(scene, none);
    for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
        if (i == GLINT_MISTAKE_TRANSFORMS_REVERSED) continue; /* the scene's desc asks for it */
        if (i == GLINT_MISTAKE_TRANSPOSED) continue;          /* of squares */
        Picture wrong = broken(scene, one((GlintMistake)i));
        if (picture_equal(&right, &wrong)) {
            test_fail(
                __FILE__, __LINE__, "%s changes nothing", glint_mistake_name((GlintMistake)i));
        }
        picture_free(&wrong);
    }
    Picture again = broken(scene, none);
    CHECK(picture_equal(&right, &again));
    picture_free(&again);
    picture_free(&right);
    glint_scene_destroy(scene);
}

/* The same bits for any number of threads, on all instruction sets, in any part of a picture. */
static void exact(void) {
    GlintScene *first = scene_from_file(scene_path(), "portable", 1);
    GlintScene *second = scene_from_file(scene_path(), NULL, 3);
    for (int i = 0; i < GLINT_MISTAKE_FLIPPED; i++) {
        Picture a = broken(first, one((GlintMistake)i)), b = broken(second, one((GlintMistake)i));
        if (!picture_equal(&a, &b)) {
            test_fail(__FILE__, __LINE__, "%s differs", glint_mistake_name((GlintMistake)i));
        }
        GlintRenderDesc desc = small_desc(one((GlintMistake)i));
        desc.crop_x = 30, desc.crop_y = 20;
        Picture part = picture_of_scene(second, &desc);
        for (int y = 0; part.pixels != NULL && y < part.height; y++) {
            const float *whole = a.pixels + 3 * ((20 + y) * a.width + 30);
            size_t size = 3 * sizeof(float) * (size_t)part.width;
            CHECK(memcmp(part.pixels + 3 * y * part.width, whole, size) == 0);
        }
        picture_free(&part);
        picture_free(&a);
        picture_free(&b);
    }
    glint_scene_destroy(first);
    glint_scene_destroy(second);
}

static uint8_t byte_of(GlintMistakes mistakes, float value) {
    /* A picture of the background alone is that value. */
    char xml[256];
    snprintf(xml, sizeof xml,
        "<scene dialect='glint'><image>1 1</image><camera/>"
        "<backColor>%.9g 0 0</backColor></scene>",
        (double)value);
    GlintScene *scene = scene_from_text(xml, NULL, 1);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.mistakes = mistakes;
    Picture picture = picture_of_scene(scene, &desc);
    const GlintImage image = {1, 1, picture.pixels};
    uint8_t bytes[3];
    glint_image_to_rgb8(&image, bytes);
    picture_free(&picture);
    glint_scene_destroy(scene);
    return bytes[0];
}

static void curves(void) {
    for (int i = 1; i < 60; i++) {
        float value = (float)(i / 50.0 + 0.00123);
        double v = (double)value < 1 ? (double)value : 1, c = pow(v, 1 / 2.2);
        double unclamped = floor(255 * pow((double)value, 1 / 2.2) + 0.5);
        double srgb = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
        CHECK_INT(byte_of(one(GLINT_MISTAKE_GAMMA_MISSING), value), floor(255 * v + 0.5));
        CHECK_INT(
            byte_of(one(GLINT_MISTAKE_GAMMA_TWICE), value), floor(255 * pow(c, 1 / 2.2) + 0.5));
        CHECK_INT(byte_of(one(GLINT_MISTAKE_SRGB), value), floor(255 * srgb + 0.5));
        CHECK_INT(byte_of(one(GLINT_MISTAKE_TRUNCATED), value), floor(255 * c));
        CHECK_INT(byte_of(one(GLINT_MISTAKE_WRAPPED), value), fmod(unclamped, 256));
    }
}

static void refused(void) {
    GlintScene *scene = scene_from_file(scene_path(), NULL, 1);
    float pixels[3 * 48 * 36];
    const GlintMistakes bad[] = {{.set = GLINT_MISTAKE_BIT(GLINT_MISTAKE_COUNT)}, {.light = -1},
        {.light = 5}, {.shift_x = 5}, {.shift_y = -5}, {.factor = -1}, {.factor = NAN}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        GlintRenderDesc desc = small_desc(bad[i]);
        CHECK_INT(glint_render(scene, &desc, pixels, NULL), GLINT_ERROR_ARGUMENT);
    }
    glint_scene_destroy(scene);
}

const GiTest tests_mistake[] = {TEST(names), TEST(text), TEST(each_differs), TEST(exact),
    TEST(curves), TEST(refused), TEST_END};
