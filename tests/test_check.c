/* SPDX-License-Identifier: MIT
 * What glint_scene_check says: an example of each rule in tests/check, word for word, and silence
 * about scenes that are as they should be. */
#define _XOPEN_SOURCE 700
#include "scenes.h"
#include "test.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 65536, RULES = 64 };

/* All that is said of a scene, as a terminal would show it, but for the folder. */
typedef struct Findings {
    char text[TEXT_SIZE];
    size_t size;
    int count, of_rule[RULES];
} Findings;

static int rule_index(const char *name) {
    GlintRule rule;
    for (int i = 0; glint_rule_at(i, &rule); i++) {
        if (name != NULL && strcmp(rule.name, name) == 0) return i;
    }
    return -1;
}

static void on_finding(void *user, const GlintDiagnostic *diagnostic) {
    Findings *findings = user;
    GlintDiagnostic own = *diagnostic;
    const char *slash = strrchr(own.path, '/');
    if (slash != NULL) own.path = slash + 1;
    int rule = rule_index(own.rule);
    GlintRule said;
    CHECK(rule >= 0 && glint_rule_at(rule, &said));
    if (rule < 0) return;
    CHECK_INT(own.severity, said.severity);
    findings->count++;
    findings->of_rule[rule]++;
    size_t room = sizeof findings->text - findings->size;
    size_t size = glint_diagnostic_format(&own, findings->text + findings->size, room);
    CHECK(size < room);
    if (size < room) findings->size += size;
}

static GlintScene *scene_for(Findings *findings, const GlintAllocator *allocator, bool places) {
    GlintSceneDesc desc = glint_scene_desc_default();
    GlintScene *scene = NULL;
    GlintError error;
    desc.thread_count = 2;
    desc.allocator = allocator;
    desc.diagnostic = on_finding;
    desc.diagnostic_user = findings;
    desc.keep_sources = places;
    glint_scene_create(&desc, &scene, &error);
    return scene;
}

static void check_file(const char *path, bool places, Findings *findings) {
    GlintError error;
    *findings = (Findings){.size = 0};
    GlintScene *scene = scene_for(findings, NULL, places);
    if (glint_scene_load_file(scene, path, NULL, &error) == GLINT_OK) {
        CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
        CHECK_INT(glint_scene_check(scene, NULL, &error), GLINT_OK);
    }
    glint_scene_destroy(scene);
}

/* Scenes with textures are errors without the modules that read these. */
static bool skips(void) {
#if defined(GI_BUILT_PNG) && defined(GI_BUILT_JPEG)
    return false;
#else
    test_skip("Glint was built without PNG or JPEG");
    return true;
#endif
}

/* ---------------------------------------------------------------- examples */

static bool read_text(const char *path, char *buffer, size_t size) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) return false;
    buffer[fread(buffer, 1, size - 1, file)] = '\0';
    fclose(file);
    return true;
}

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    CHECK(file != NULL && fputs(text, file) >= 0);
    if (file != NULL) fclose(file);
}

/* The .expected beside each scene; --update-golden writes it. */
static void examples(void) {
    static Findings findings;
    static char expected[TEXT_SIZE];
    int seen[RULES] = {0}, count = 0;
    char folder[1024], path[1400];
    if (skips()) return;
    snprintf(folder, sizeof folder, "%s/tests/check", test_source_dir());
    DIR *directory = opendir(folder);
    CHECK(directory != NULL);
    if (directory == NULL) return;
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        size_t length = strlen(entry->d_name);
        if (length < 5 || strcmp(entry->d_name + length - 4, ".xml") != 0) continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        check_file(path, true, &findings);
        for (int i = 0; i < RULES; i++) seen[i] += findings.of_rule[i];
        snprintf(path, sizeof path, "%s/%.*s.expected", folder, (int)length - 4, entry->d_name);
        if (test_update_golden()) write_text(path, findings.text);
        if (!read_text(path, expected, sizeof expected)) {
            test_fail(__FILE__, __LINE__, "%s is missing", path);
        } else if (strcmp(findings.text, expected) != 0) {
            test_fail(__FILE__, __LINE__, "%s: found\n%sexpected\n%s", entry->d_name, findings.text,
                expected);
        }
        count++;
    }
    closedir(directory);
    CHECK(count > 20);
    GlintRule rule;
    for (int i = 0; glint_rule_at(i, &rule); i++) {
        if (seen[i] == 0) test_fail(__FILE__, __LINE__, "no example of %s", rule.name);
    }
}

/* ---------------------------------------------------------------- no false alarms */

/* Adds up what is said of the scenes of a folder, its own folders included. */
static int walk(const char *folder, int of_rule[RULES]) {
    static Findings findings;
    DIR *directory = opendir(folder);
    int scenes = 0;
    if (directory == NULL) return 0;
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        char path[2048];
        size_t length = strlen(entry->d_name);
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] == '.') continue;
        if (length < 5 || strcmp(entry->d_name + length - 4, ".xml") != 0) {
            scenes += walk(path, of_rule);
            continue;
        }
        check_file(path, true, &findings);
        for (int i = 0; i < RULES; i++) of_rule[i] += findings.of_rule[i];
        scenes++;
    }
    closedir(directory);
    return scenes;
}

/* Notes are not counted: they may well be meant. */
static void check_counts(
    const char *root, const char *folder, int least, const char *const *names, const int *counts) {
    int of_rule[RULES] = {0};
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", root, folder);
    int scenes = walk(path, of_rule);
    if (scenes < least) test_fail(__FILE__, __LINE__, "%d scenes in %s", scenes, path);
    GlintRule rule;
    for (int i = 0; glint_rule_at(i, &rule); i++) {
        int expected = 0;
        for (int k = 0; names[k] != NULL; k++) {
            if (strcmp(names[k], rule.name) == 0) expected = counts[k];
        }
        bool note = rule.severity == GLINT_SEVERITY_NOTE;
        if (note || of_rule[i] == expected) continue;
        test_fail(
            __FILE__, __LINE__, "%s: %d times %s, not %d", folder, of_rule[i], rule.name, expected);
    }
}

static void own_scenes(void) {
    static const char *const none[] = {NULL}, *const window[] = {"stretched-window", NULL};
    static const int once[] = {1};
    if (skips()) return;
    check_counts(test_source_dir(), "scenes", 10, none, NULL);
    check_counts(test_source_dir(), "tests/golden", 10, window, once);
}

/* Each of these warnings has been looked at, and is true. */
static void course_scenes(void) {
    static const char *const names[] = {
        "ambiguous-dialect", "unused-shader", "stretched-window", NULL};
    static const int counts[] = {14, 8, 1};
    if (skips()) return;
    if (test_shared_dir() == NULL) {
        test_skip("there is no ../shared");
        return;
    }
    check_counts(test_shared_dir(), "reference", 70, names, counts);
}

/* ---------------------------------------------------------------- the call */

static void without_places(void) {
    static Findings findings;
    char path[1024];
    snprintf(path, sizeof path, "%s/tests/check/duplicate-surface.xml", test_source_dir());
    check_file(path, false, &findings);
    CHECK_INT(findings.count, 3);
    CHECK(strstr(findings.text, "the sphere number 1 is the same") != NULL);
    CHECK(strstr(findings.text, "^") == NULL);
}

/* Of many findings the first are told and the others counted. */
static void many_of_a_kind(void) {
    enum { COUNT = 50 };
    static Findings findings;
    static char text[16384];
    int length = snprintf(text, sizeof text,
        "<scene dialect='glint'><camera/><image>9 9</image><light><position>1 1 1</position>"
        "</light>");
    for (int i = 0; i < COUNT; i++) {
        length += snprintf(text + length, sizeof text - (size_t)length,
            "<surface type='Sphere'><center>0 0 -5</center></surface>\n");
    }
    snprintf(text + length, sizeof text - (size_t)length, "</scene>");
    findings = (Findings){.size = 0};
    GlintScene *scene = scene_for(&findings, NULL, true);
    GlintError error;
    CHECK_INT(load_text(scene, text, &error), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
    CHECK_INT(glint_scene_check(scene, NULL, &error), GLINT_OK);
    CHECK_INT(findings.count, 11);
    CHECK(strstr(findings.text, "39 more of the kind") != NULL);
    glint_scene_destroy(scene);
}

static bool always(void *user) {
    (void)user;
    return true;
}

static void refused_and_cancelled(void) {
    static Findings findings;
    findings = (Findings){.size = 0};
    GlintScene *scene = scene_for(&findings, NULL, true);
    GlintError error;
    const GlintMonitor monitor = {.cancelled = always};
    CHECK_INT(glint_scene_check(NULL, NULL, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_scene_check(scene, NULL, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(load_text(scene, small_scene, &error), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
    CHECK_INT(glint_scene_check(scene, &monitor, &error), GLINT_CANCELLED);
    CHECK_INT(findings.count, 0);
    glint_scene_destroy(scene);
}

/* An allocator that refuses from the Nth request on. */
typedef struct Miser {
    _Atomic long left, used;
} Miser;

static void *refuse_late(void *user, void *pointer, size_t old_size, size_t new_size) {
    Miser *miser = user;
    if (new_size > 0 && miser->left-- <= 0) return NULL;
    miser->used += (long)new_size - (long)old_size;
    if (new_size > 0) return realloc(pointer, new_size);
    free(pointer);
    return NULL;
}

static void memory_runs_out(void) {
    static Findings findings;
    char path[1024];
    snprintf(path, sizeof path, "%s/tests/check/duplicate-surface.xml", test_source_dir());
    bool done = false;
    for (long limit = 0; !done && limit < 10000; limit++) {
        Miser miser = {10000, 0};
        GlintAllocator allocator = {refuse_late, &miser};
        GlintError error;
        findings = (Findings){.size = 0};
        GlintScene *scene = scene_for(&findings, &allocator, true);
        CHECK_INT(glint_scene_load_file(scene, path, NULL, &error), GLINT_OK);
        CHECK_INT(glint_scene_commit(scene, NULL, &error), GLINT_OK);
        miser.left = limit;
        GlintStatus status = glint_scene_check(scene, NULL, &error);
        done = status == GLINT_OK;
        if (!done) CHECK_INT(status, GLINT_ERROR_MEMORY);
        CHECK_INT(findings.count, done ? 3 : 0);
        glint_scene_destroy(scene);
        CHECK_INT(miser.used, 0);
    }
    CHECK(done);
}

const GiTest tests_check[] = {TEST(examples), TEST(own_scenes), TEST(course_scenes),
    TEST(without_places), TEST(many_of_a_kind), TEST(refused_and_cancelled), TEST(memory_runs_out),
    TEST_END};
