/* SPDX-License-Identifier: MIT
 * Loading as a stranger sees it: the three ways, errors as data, progress, cancelling, numbers. */
#include "test.h"

#include "scenes.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- loading */

static void load_three_ways(void) {
    Picture expected = picture_of_text(small_scene);
    char path[500];
    snprintf(path, sizeof path, "%s/small.xml", test_scratch_dir());
    FILE *file = fopen(path, "wb");
    CHECK(file != NULL && fputs(small_scene, file) >= 0 && fclose(file) == 0);
    for (int way = 0; way < 4; way++) {
        GlintScene *scene = new_scene();
        GlintError error = {0};
        GlintStatus status;
        Stream stream = {small_scene, 0, strlen(small_scene), way == 2 ? 1 : 0, SIZE_MAX};
        if (way == 0) {
            status = glint_scene_load_file(scene, path, NULL, &error);
        } else if (way == 1) {
            status = load_text(scene, small_scene, &error);
        } else {
            status = glint_scene_load_stream(scene, read_stream, &stream, "s", NULL, &error);
        }
        CHECK_INT(status, GLINT_OK);
        CHECK_INT(load_text(scene, small_scene, &error), GLINT_ERROR_ARGUMENT); /* not empty */
        CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
        GlintStats stats;
        glint_scene_stats(scene, &stats);
        CHECK_INT(stats.read_bytes, strlen(small_scene));
        Picture picture = picture_of_scene(scene, NULL);
        CHECK(picture_equal(&picture, &expected));
        picture_free(&picture);
        glint_scene_destroy(scene);
    }
    picture_free(&expected);
}

typedef struct Findings {
    int errors;
    int64_t line, column;
    char text[1000];
} Findings;

static void keep_finding(void *user, const GlintDiagnostic *diagnostic) {
    Findings *findings = user;
    if (diagnostic->severity != GLINT_SEVERITY_ERROR) return;
    if (findings->errors++ > 0) return;
    findings->line = diagnostic->line;
    findings->column = diagnostic->column;
    size_t length = glint_diagnostic_format(diagnostic, findings->text, sizeof findings->text);
    CHECK_INT(length, strlen(findings->text));
    char cut[20];
    CHECK_INT(glint_diagnostic_format(diagnostic, cut, sizeof cut), length);
    CHECK(strlen(cut) == 19 && strncmp(cut, findings->text, 19) == 0);
    CHECK_INT(glint_diagnostic_format(diagnostic, NULL, 0), length);
}

static void errors_as_data(void) {
    const char *text =
        "<scene>\n<camera/>\n  <image>0 5</image>\n<surface type='Spere'/>\n</scene>\n";
    Findings findings = {0};
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.diagnostic = keep_finding;
    desc.diagnostic_user = &findings;
    GlintScene *scene = NULL;
    CHECK_INT(glint_scene_create(&desc, &scene, NULL), GLINT_OK);
    GlintError error = {0};
    CHECK_INT(load_text(scene, text, &error), GLINT_ERROR_SCENE);
    CHECK_INT(error.status, GLINT_ERROR_SCENE);
    CHECK_INT(error.line, 3);
    CHECK_TEXT(error.path, "x.xml");
    CHECK_INT(findings.errors, 2); /* all of them */
    CHECK(findings.line == error.line && findings.column == error.column && error.column > 0);
    CHECK(strncmp(findings.text, "x.xml:3:", 8) == 0 && strstr(findings.text, ": error: ") != NULL);
    CHECK(strstr(findings.text, error.message) != NULL && strchr(findings.text, '^') != NULL);
    /* Such a scene can only be destroyed. */
    GlintSurfaceDesc sphere = glint_surface_desc_default(GLINT_SURFACE_SPHERE);
    CHECK_INT(glint_scene_add_surface(scene, &sphere, NULL, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(load_text(scene, small_scene, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_ERROR_ARGUMENT);
    glint_scene_destroy(scene);
    scene = new_scene();
    CHECK_INT(glint_scene_load_file(scene, "/nowhere/a.xml", NULL, &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.path, "/nowhere/a.xml");
    glint_scene_destroy(scene);
    scene = new_scene();
    Stream broken = {small_scene, 0, strlen(small_scene), 10, 50};
    CHECK_INT(
        glint_scene_load_stream(scene, read_stream, &broken, "s", NULL, &error), GLINT_ERROR_FILE);
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- progress and cancel */

typedef struct Watch {
    pthread_t owner;
    int phases[4]; /* calls of progress */
    double last[4];
    int asked, cancel_at; /* cancel_at 0: never */
    bool wrong;
} Watch;

static void watch_progress(void *user, GlintPhase phase, double fraction) {
    Watch *watch = user;
    if (!pthread_equal(watch->owner, pthread_self()) || (unsigned)phase > GLINT_PHASE_WRITE) {
        watch->wrong = true;
        return;
    }
    if (!(fraction >= watch->last[phase] && fraction <= 1)) watch->wrong = true;
    watch->phases[phase]++;
    watch->last[phase] = fraction;
}

static bool watch_cancelled(void *user) {
    Watch *watch = user;
    if (!pthread_equal(watch->owner, pthread_self())) watch->wrong = true;
    return ++watch->asked == watch->cancel_at;
}

static bool take_bytes(void *user, const void *bytes, size_t size) {
    (void)bytes;
    *(size_t *)user += size;
    return true;
}

/* The whole life; of the phases only `cancel` is ever told to stop, at its first question. */
static void watch_life(const char *text, bool stream, int cancel) {
    static float pixels[200 * 200 * 3];
    GlintMonitor monitors[4];
    Watch watches[4];
    for (int i = 0; i < 4; i++) {
        watches[i] = (Watch){.owner = pthread_self(), .last = {-1, -1, -1, -1}};
        watches[i].cancel_at = i == cancel ? 1 : 0;
        monitors[i] = (GlintMonitor){watch_progress, watch_cancelled, &watches[i]};
    }
    GlintScene *scene = new_scene();
    GlintError error = {0};
    Stream source = {text, 0, strlen(text), 0, SIZE_MAX};
    GlintStatus status =
        stream ? glint_scene_load_stream(scene, read_stream, &source, "s", &monitors[0], &error)
               : glint_scene_load_memory(scene, text, strlen(text), "m", &monitors[0], &error);
    int phase = 0;
    if (status == GLINT_OK) phase = 1, status = glint_scene_commit(scene, &monitors[1], &error);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.monitor = &monitors[2];
    if (status == GLINT_OK) phase = 2, status = glint_render(scene, &desc, pixels, &error);
    GlintSaveDesc save = glint_save_desc_default();
    save.monitor = &monitors[3];
    GlintImage image = {200, 200, pixels};
    size_t size = 0;
    if (status == GLINT_OK) {
        phase = 3;
        status = glint_image_encode_png(&image, &save, take_bytes, &size, &error);
    }
    CHECK_INT(status, cancel >= 0 ? GLINT_CANCELLED : GLINT_OK);
    CHECK_INT(phase, cancel >= 0 ? cancel : 3);
    if (status == GLINT_CANCELLED) CHECK_INT(error.status, GLINT_CANCELLED);
    for (int i = 0; i <= phase; i++) {
        CHECK(!watches[i].wrong && watches[i].asked > 0);
        if (i == cancel) continue;
        for (int k = 0; k < 4; k++) CHECK((watches[i].phases[k] > 0) == (i == k));
        if (i > 0 || !stream) CHECK(watches[i].last[i] > 0.5);
        if (i == 0 && stream) CHECK(watches[i].last[0] < 0);
    }
    /* What was cancelled while it was drawn can be drawn again. */
    if (cancel == 2) {
        desc.monitor = NULL;
        CHECK_INT(glint_render(scene, &desc, pixels, &error), GLINT_OK);
    }
    glint_scene_destroy(scene);
}

static void progress_and_cancel(void) {
    char *text = large_text(30000);
    CHECK(text != NULL);
    for (int cancel = -1; text != NULL && cancel < 4; cancel++) {
        watch_life(text, false, cancel);
        watch_life(text, true, cancel);
    }
    free(text);
}

/* Where objects stand, from streams that arrive in pieces too. */
static void sources(void) {
    static const char text[] =
        "<scene>\n"
        "  <camera/><image>8 8</image>\n"
        "  <shader name='red' type='Lambertian'/>\n"
        "  <surface type='Group'><surface type='Sphere' name='b\xc3\xa4ll'>\n"
        "    <shader ref='red'/></surface>\n"
        "  </surface>  <surface type='Box'><shader type='Phong'/></surface>\n"
        "  <light/><light name='key'><position>1 2 3</position></light>\n"
        "</scene>\n";
    for (size_t piece = 0; piece < 3; piece++) {
        GlintSceneDesc desc = glint_scene_desc_default();
        desc.keep_sources = true;
        GlintScene *scene;
        CHECK_INT(glint_scene_create(&desc, &scene, NULL), GLINT_OK);
        Stream stream = {text, 0, strlen(text), piece, SIZE_MAX};
        CHECK_INT(
            glint_scene_load_stream(scene, read_stream, &stream, "s.xml", NULL, NULL), GLINT_OK);
        static const struct {
            GlintObjectKind kind;
            uint32_t index1;
            int line, column;
            const char *name;
        } places[] = {{GLINT_OBJECT_CAMERA, 1, 2, 3, ""}, {GLINT_OBJECT_SHADER, 1, 3, 3, "red"},
            {GLINT_OBJECT_SURFACE, 1, 4, 25, "b\xc3\xa4ll"}, {GLINT_OBJECT_SHADER, 2, 6, 35, ""},
            {GLINT_OBJECT_SURFACE, 2, 6, 15, ""}, {GLINT_OBJECT_LIGHT, 1, 7, 3, ""},
            {GLINT_OBJECT_LIGHT, 2, 7, 11, "key"}};
        GlintSource source;
        for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
            CHECK(glint_scene_source(scene, places[i].kind, places[i].index1, &source));
            CHECK_INT(source.line, places[i].line);
            CHECK_INT(source.column, places[i].column);
            CHECK_TEXT(source.name, places[i].name);
            CHECK_TEXT(source.path, "s.xml");
        }
        CHECK(!glint_scene_source(scene, GLINT_OBJECT_SURFACE, 3, &source));
        CHECK(!glint_scene_source(scene, GLINT_OBJECT_SHADER, 0, &source));
        glint_scene_destroy(scene);
    }
    GlintScene *scene = new_scene();
    CHECK_INT(load_text(scene, small_scene, NULL), GLINT_OK);
    GlintSource source;
    CHECK(!glint_scene_source(scene, GLINT_OBJECT_SURFACE, 1, &source));
    glint_scene_destroy(scene);
}

static void statistics(void) {
    GlintScene *scene = new_scene();
    CHECK_INT(load_text(scene, small_scene, NULL), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    CHECK(info.surface_count == 3 && info.light_count == 2 && info.shader_count == 1);
    Picture picture = picture_of_scene(scene, NULL);
    GlintStats stats;
    glint_scene_stats(scene, &stats);
    CHECK_INT(stats.camera_rays, 70 * 66);
    int lit = 0;
    for (int i = 0; i < 70 * 66; i++) lit += picture_at(&picture, i % 70, i / 70).x > 0;
    CHECK(stats.shadow_rays > 0 && stats.shadow_rays <= (uint64_t)lit);
    CHECK_INT(stats.primitive_count, 3);
    CHECK(stats.leaf_count >= 1 && stats.tree_bytes >= 3 * 6 * sizeof(float));
    CHECK(isfinite(stats.sah_cost) && stats.sah_cost > 0);
    CHECK(stats.memory_peak > stats.tree_bytes && stats.memory_peak < 1u << 28);
    CHECK_INT(stats.thread_count, 2);
    CHECK_TEXT(stats.isa, glint_isa_name(0));
    CHECK(stats.read_seconds >= 0 && stats.build_seconds >= 0 && stats.trace_seconds > 0);
    CHECK_INT(stats.read_bytes, strlen(small_scene));
    picture_free(&picture);
    glint_scene_destroy(scene);
}

const GiTest tests_load[] = {TEST(load_three_ways), TEST(errors_as_data), TEST(progress_and_cancel),
    TEST(sources), TEST(statistics), TEST_END};
