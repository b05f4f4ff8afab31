/* SPDX-License-Identifier: MIT
 * Grading: scenes are drawn with every mistake, and each picture is graded. What comes of it stands
 * as a table in docs/grade.md, and is compared with that; --update-golden writes it. */
#include "glint/glint.h"
#include "scenes.h"
#include "test.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- drawing and grading */

typedef struct Place {
    const char *name;           /* below the sources */
    int width, height, samples; /* 0: the scene's */
} Place;

static const Place places[] = {
    {"tests/mistakes.xml", 96, 72, 4},
    {"tests/golden/solids-2012.xml", 0, 0, 0},
    {"tests/golden/groups-2012.xml", 64, 64, 0},
    {"tests/golden/lights-material.xml", 0, 0, 0},
    {"tests/golden/oblique-2013.xml", 0, 0, 0},
    {"tests/golden/parallel-2013.xml", 0, 0, 0},
    {"tests/golden/exposure-2017.xml", 72, 72, 0},
    {"tests/golden/groups-2017b.xml", 64, 64, 0},
    {"tests/golden/lambert-2018.xml", 0, 0, 0},
    {"tests/golden/phong-2019.xml", 0, 0, 0},
    {"scenes/caffeine.xml", 96, 72, 1},
    {"scenes/solids.xml", 96, 54, 4},
};
enum { PLACE_COUNT = sizeof places / sizeof places[0] };

static const char *path_of(const Place *place) {
    static char path[4096];
    snprintf(path, sizeof path, "%s/%s", test_source_dir(), place->name);
    return path;
}

/* The scene right, and with its transforms reversed. */
typedef struct Stage {
    const Place *place;
    GlintScene *scene[2];
    GlintImage right; /* with the values that 8 bits hold */
} Stage;

static GlintScene *open_scene(const Place *place, bool reversed) {
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.thread_count = 1;
    desc.reverse_transforms = reversed;
    GlintScene *scene = NULL;
    CHECK_INT(glint_scene_create(&desc, &scene, NULL), GLINT_OK);
    CHECK_INT(glint_scene_load_file(scene, path_of(place), NULL, NULL), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    return scene;
}

/* As a PNG would bring it back. */
static void through_bytes(GlintImage *image) {
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    uint8_t *bytes = malloc(count);
    float *pixels = malloc(count * sizeof *pixels);
    float linear[256];
    glint_image_to_rgb8(image, bytes);
    for (int i = 0; i < 256; i++) linear[i] = (float)pow(i / 255.0, 2.2);
    for (size_t i = 0; i < count; i++) pixels[i] = linear[bytes[i]];
    free((void *)(uintptr_t)image->pixels);
    free(bytes);
    image->pixels = pixels;
}

static GlintImage draw(const Stage *stage, const GlintMistakes *mistakes) {
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = stage->place->width;
    desc.height = stage->place->height;
    desc.samples = stage->place->samples;
    desc.mistakes = *mistakes;
    bool reversed = mistakes->set >> GLINT_MISTAKE_TRANSFORMS_REVERSED & 1;
    Picture picture = picture_of_scene(stage->scene[reversed], &desc);
    GlintImage image = {picture.width, picture.height, picture.pixels};
    through_bytes(&image);
    return image;
}

static void image_free(GlintImage *image) {
    free((void *)(uintptr_t)image->pixels);
    *image = (GlintImage){0};
}

static void stage_open(Stage *stage, const Place *place) {
    const GlintMistakes none = {0};
    *stage = (Stage){.place = place};
    for (int i = 0; i < 2; i++) stage->scene[i] = open_scene(place, i == 1);
    stage->right = draw(stage, &none);
}

static void stage_close(Stage *stage) {
    for (int i = 0; i < 2; i++) glint_scene_destroy(stage->scene[i]);
    image_free(&stage->right);
}

static bool is_same(const GlintImage *a, const GlintImage *b) {
    size_t size = 3 * sizeof(float) * (size_t)a->width * (size_t)a->height;
    return memcmp(a->pixels, b->pixels, size) == 0;
}

static GlintGrade grade_of(const Place *place, const GlintImage *image, bool pairs) {
    GlintGradeDesc desc = glint_grade_desc_default();
    desc.scene.thread_count = 1;
    desc.compare.flip = false;
    desc.width = place->width;
    desc.height = place->height;
    desc.samples = place->samples;
    desc.pairs = pairs;
    GlintGrade grade;
    CHECK_INT(glint_grade(image, path_of(place), &desc, &grade, NULL), GLINT_OK);
    glint_image_free(&grade.reference);
    return grade;
}

/* ---------------------------------------------------------------- outcomes */

enum { OTHER_LIMIT = 6 };

/* What came of the pictures with one mistake, or with some pairs. */
typedef struct Outcome {
    int drawn, named, among, half, unclear, rounding, wrong;
    uint64_t others[OTHER_LIMIT]; /* that were named wrongly */
} Outcome;

static void count_outcome(Outcome *outcome, const GlintGrade *grade, uint64_t made) {
    uint64_t first = grade->hypothesis_count > 0 ? grade->hypotheses[0].mistakes.set : 0;
    outcome->drawn++;
    if (grade->verdict == GLINT_VERDICT_UNCLEAR) {
        bool among = false;
        for (int i = 0; i < grade->rivals; i++) {
            among |= grade->hypotheses[i].mistakes.set == made;
        }
        outcome->among += among;
        outcome->unclear += !among;
    } else if (first == made) {
        outcome->named++;
    } else if (grade->verdict != GLINT_VERDICT_EXPLAINED) {
        outcome->rounding++;
    } else if ((first & ~made) == 0) {
        outcome->half++;
    } else {
        outcome->others[outcome->wrong % OTHER_LIMIT] = first;
        outcome->wrong++;
    }
}

/* ---------------------------------------------------------------- tables */

enum { PAGE_LIMIT = 1 << 17 };

typedef struct Page {
    char text[PAGE_LIMIT];
    size_t length;
} Page;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
say(Page *page, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int count = vsnprintf(page->text + page->length, PAGE_LIMIT - page->length, format, arguments);
    va_end(arguments);
    if (count > 0 && page->length + (size_t)count < PAGE_LIMIT) page->length += (size_t)count;
}

static void say_count(Page *page, int count) {
    if (count > 0) {
        say(page, " %d |", count);
    } else {
        say(page, " |");
    }
}

static void say_others(Page *page, const Outcome *outcome) {
    for (int i = 0; i < outcome->wrong && i < OTHER_LIMIT; i++) {
        const GlintMistakes mistakes = {.set = outcome->others[i]};
        char text[256];
        glint_mistakes_format(&mistakes, text, sizeof text);
        say(page, "%s%s", i > 0 ? ", " : " ", text);
    }
    say(page, " |\n");
}

/* Replaces, or compares, what stands between the lines <!-- NAME --> and <!-- end of NAME -->. */
static void check_page(const char *name, const Page *page) {
    static char text[2 * PAGE_LIMIT], begin[64], end[64], path[4096];
    snprintf(path, sizeof path, "%s/docs/grade.md", test_source_dir());
    snprintf(begin, sizeof begin, "<!-- %s -->\n", name);
    snprintf(end, sizeof end, "<!-- end of %s -->\n", name);
    FILE *file = fopen(path, "rb");
    size_t length = file != NULL ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file != NULL) fclose(file);
    text[length] = '\0';
    char *from = strstr(text, begin), *to = strstr(text, end);
    CHECK(from != NULL && to != NULL);
    if (from == NULL || to == NULL) return;
    from += strlen(begin);
    size_t old = (size_t)(to - from);
    bool same = old == page->length && memcmp(from, page->text, old) == 0;
    if (same) return;
    if (!test_update_golden()) {
        test_fail(__FILE__, __LINE__, "the table \"%s\" of docs/grade.md is another now:\n%s", name,
            page->text);
        return;
    }
    file = fopen(path, "wb");
    fwrite(text, 1, (size_t)(from - text), file);
    fwrite(page->text, 1, page->length, file);
    fwrite(to, 1, strlen(to), file);
    fclose(file);
}

/* ---------------------------------------------------------------- one mistake */

static bool is_slow(void) {
    if (test_slowness() == 1) return false;
    test_skip("a thousand pictures are too many for a slow build");
    return true;
}

/* Of two lights the last alone is what is left when the first is missing. */
static bool is_last_light_alone(const Stage *stage, const GlintImage *image) {
    const GlintMistakes first = {.set = GLINT_MISTAKE_BIT(GLINT_MISTAKE_LIGHT_MISSING)};
    GlintImage other = draw(stage, &first);
    bool same = is_same(&other, image);
    image_free(&other);
    return !same;
}

static void matrix(void) {
    static Outcome outcomes[GLINT_MISTAKE_COUNT];
    static Page page;
    if (is_slow()) return;
    for (int k = 0; k < PLACE_COUNT; k++) {
        Stage stage;
        stage_open(&stage, &places[k]);
        for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
            GlintMistakes mistakes = {.set = GLINT_MISTAKE_BIT(i)};
            GlintImage image = draw(&stage, &mistakes);
            bool other = !is_same(&image, &stage.right);
            if (i == GLINT_MISTAKE_LAST_LIGHT) other &= is_last_light_alone(&stage, &image);
            if (other) {
                GlintGrade grade = grade_of(&places[k], &image, false);
                count_outcome(&outcomes[i], &grade, mistakes.set);
            }
            image_free(&image);
        }
        stage_close(&stage);
    }
    say(&page, "| mistake | pictures | named | unclear, among others | unclear | too small | taken "
               "for |\n| --- | --: | --: | --: | --: | --: | --- |\n");
    Outcome sum = {0};
    for (int i = 0; i < GLINT_MISTAKE_COUNT; i++) {
        const Outcome *outcome = &outcomes[i];
        CHECK(outcome->drawn > 0);
        say(&page, "| `%s` | %d |", glint_mistake_name((GlintMistake)i), outcome->drawn);
        say_count(&page, outcome->named);
        say_count(&page, outcome->among);
        say_count(&page, outcome->unclear);
        say_count(&page, outcome->rounding);
        say_others(&page, outcome);
        sum.drawn += outcome->drawn, sum.named += outcome->named, sum.among += outcome->among;
        sum.unclear += outcome->unclear, sum.rounding += outcome->rounding;
        sum.wrong += outcome->wrong;
    }
    say(&page, "| all | %d | %d | %d | %d | %d | %d |\n", sum.drawn, sum.named, sum.among,
        sum.unclear, sum.rounding, sum.wrong);
    check_page("one mistake", &page);
}

/* ---------------------------------------------------------------- two mistakes */

static void pairs(void) {
    static const GlintMistake often[] = {GLINT_MISTAKE_SHIFTED, GLINT_MISTAKE_WINDOW_SWAPPED,
        GLINT_MISTAKE_NORMALS_INWARD, GLINT_MISTAKE_NO_SHADOWS, GLINT_MISTAKE_NO_SPECULAR,
        GLINT_MISTAKE_GAMMA_MISSING};
    enum { OFTEN_COUNT = sizeof often / sizeof often[0] };
    static const int used[] = {1, 3};
    static Page page;
    if (is_slow()) return;
    say(&page, "| scene | pairs | both named | unclear, among others | unclear | one named | taken "
               "for |\n| --- | --: | --: | --: | --: | --: | --- |\n");
    for (size_t k = 0; k < sizeof used / sizeof used[0]; k++) {
        const Place *place = &places[used[k]];
        Outcome outcome = {0};
        Stage stage;
        stage_open(&stage, place);
        for (int i = 0; i < OFTEN_COUNT; i++) {
            for (int j = i + 1; j < OFTEN_COUNT; j++) {
                GlintMistakes mistakes = {
                    .set = GLINT_MISTAKE_BIT(often[i]) | GLINT_MISTAKE_BIT(often[j])};
                GlintImage image = draw(&stage, &mistakes);
                GlintGrade grade = grade_of(place, &image, true);
                count_outcome(&outcome, &grade, mistakes.set);
                image_free(&image);
            }
        }
        stage_close(&stage);
        say(&page, "| `%s` | %d |", place->name, outcome.drawn);
        say_count(&page, outcome.named);
        say_count(&page, outcome.among);
        say_count(&page, outcome.unclear);
        say_count(&page, outcome.half + outcome.rounding);
        say_others(&page, &outcome);
    }
    check_page("two mistakes", &page);
}

const GiTest tests_grade[] = {TEST(matrix), TEST(pairs), TEST_END};
