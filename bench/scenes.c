/* SPDX-License-Identifier: MIT
 * A file appears whole or not at all, so that an interrupted bench leaves nothing that a later one
 * would measure. */
#define _POSIX_C_SOURCE 200809L
#include "scenes.h"

#include "message.h"
#include "samples/write.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static uint64_t parse_count(const char *text) {
    char *end;
    double count = strtod(text, &end);
    if (*end == 'k') count *= 1e3, end++;
    if (*end == 'm') count *= 1e6, end++;
    return *end == '\0' && count >= 1 && count <= 1e8 ? (uint64_t)count : 0;
}

static BenchScene parse_name(const char *name, int edge) {
    BenchScene scene = {.sample = {.count = 6, .width = edge, .height = edge}};
    message_format(scene.name, sizeof scene.name, "%s", name);
    size_t length = strcspn(name, "-");
    for (int kind = 0; kind < SAMPLE_KIND_COUNT; kind++) {
        const char *known = sample_kind_name((SampleKind)kind);
        if (strlen(known) != length || strncmp(known, name, length) != 0) continue;
        scene.sample.kind = (SampleKind)kind;
        if (kind == SAMPLE_TINY && name[length] == '\0') {
            scene.sample.width = scene.sample.height = 300;
            return scene;
        }
        if (kind != SAMPLE_TINY && name[length] == '-') {
            scene.sample.count = parse_count(name + length + 1);
            bool few = kind == SAMPLE_LIGHTS || kind >= SAMPLE_SHADOW; /* lights or samples */
            if (scene.sample.count > 0 && !(few && scene.sample.count > 65536)) return scene;
        }
    }
    message_fail(
        "there is no scene '%s'; for example: tiny,spheres-100k,torus-1m,forest-10k,room-16", name);
}

int scenes_parse(const char *names, int edge, BenchScene scenes[SCENE_MAX]) {
    int count = 0;
    while (*names != '\0') {
        char name[32];
        size_t length = strcspn(names, ",");
        message_format(name, sizeof name, "%.*s", (int)length, names);
        if (count == SCENE_MAX) message_fail("more than %d scenes", SCENE_MAX);
        scenes[count++] = parse_name(name, edge);
        names += length + (names[length] == ',');
    }
    if (count == 0) message_fail("no scenes");
    return count;
}

bool scenes_has(const BenchScene *scene, SceneFormat format) {
    SampleKind kind = scene->sample.kind;
    bool basic = kind == SAMPLE_SPHERES || kind == SAMPLE_TORUS;
    switch (format) {
    case FORMAT_TACHYON: return basic;
    case FORMAT_POVRAY:
        /* Beyond, it would take longer than all the rest of the bench. */
        if (scene->sample.count > 2000000) return false;
        return basic || kind == SAMPLE_SOLIDS || kind == SAMPLE_TINY || kind == SAMPLE_LIGHTS;
    default: return true;
    }
}

/* ---------------------------------------------------------------- files */

typedef void (*WriteFn)(const Sample *sample, const char *beside, FILE *file);

static void write_obj(const Sample *sample, const char *beside, FILE *file) {
    (void)beside;
    sample_write_obj(sample, file);
}

static void write_sky(const Sample *sample, const char *beside, FILE *file) {
    (void)sample, (void)beside;
    sample_write_sky(file);
}

static void write_file(const Sample *sample, WriteFn write, const char *beside, const char *path) {
    if (access(path, R_OK) == 0) return;
    char temporary[PATH_SIZE];
    message_format(temporary, sizeof temporary, "%s.%ld", path, (long)getpid());
    FILE *file = fopen(temporary, "w");
    if (file == NULL) message_fail("%s cannot be written", temporary);
    write(sample, beside, file);
    bool good = !ferror(file);
    good = fclose(file) == 0 && good;
    if (!good || rename(temporary, path) != 0) {
        remove(temporary);
        message_fail("%s cannot be written", path);
    }
}

/* The name of the file that the XML file names; empty: there is none. */
static void beside_name(const Sample *sample, char name[PATH_SIZE]) {
    name[0] = '\0';
    if (sample_has_sky(sample)) message_format(name, PATH_SIZE, "sky-v%d.pfm", SAMPLE_VERSION);
    if (sample_triangle_count(sample) > 0) {
        message_format(name, PATH_SIZE, "%s-%" PRIu64 "-v%d.obj", sample_kind_name(sample->kind),
            sample->count, SAMPLE_VERSION);
    }
}

uint64_t scenes_mesh_size(const BenchScene *scene, const char *cache) {
    char name[PATH_SIZE], path[PATH_SIZE];
    struct stat status;
    beside_name(&scene->sample, name);
    if (sample_triangle_count(&scene->sample) == 0) return 0;
    message_format(path, sizeof path, "%s/%s", cache, name);
    return stat(path, &status) == 0 ? (uint64_t)status.st_size : 0;
}

void scenes_file(
    const BenchScene *scene, SceneFormat format, const char *cache, char path[PATH_SIZE]) {
    static const struct {
        const char *extension;
        WriteFn write;
    } formats[FORMAT_COUNT] = {
        [FORMAT_XML] = {"xml", sample_write_xml},
        [FORMAT_TACHYON] = {"tac", sample_write_tachyon},
        [FORMAT_POVRAY] = {"pov", sample_write_povray},
    };
    const Sample *sample = &scene->sample;
    char name[PATH_SIZE];
    beside_name(sample, name);
    if (format == FORMAT_XML && name[0] != '\0') {
        message_format(path, PATH_SIZE, "%s/%s", cache, name);
        write_file(sample, sample_has_sky(sample) ? write_sky : write_obj, NULL, path);
    }
    message_format(path, PATH_SIZE, "%s/%s-%" PRIu64 "-%dx%d-v%d.%s", cache,
        sample_kind_name(sample->kind), sample->count, sample->width, sample->height,
        SAMPLE_VERSION, formats[format].extension);
    write_file(sample, formats[format].write, name, path);
}
