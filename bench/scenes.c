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
            if (scene.sample.count > 0) return scene;
        }
    }
    message_fail(
        "there is no scene '%s'; for example: tiny,spheres-100k,solids-1m,helices-10k", name);
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
    switch (format) {
    case FORMAT_TACHYON: return scene->sample.kind == SAMPLE_SPHERES;
    case FORMAT_POVRAY: return scene->sample.kind != SAMPLE_HELICES;
    default: return true;
    }
}

void scenes_file(
    const BenchScene *scene, SceneFormat format, const char *cache, char path[PATH_SIZE]) {
    static const struct {
        const char *extension;
        void (*write)(const Sample *sample, FILE *file);
    } formats[FORMAT_COUNT] = {
        [FORMAT_XML] = {"xml", sample_write_xml},
        [FORMAT_TACHYON] = {"tac", sample_write_tachyon},
        [FORMAT_POVRAY] = {"pov", sample_write_povray},
    };
    const Sample *sample = &scene->sample;
    message_format(path, PATH_SIZE, "%s/%s-%" PRIu64 "-%dx%d-v%d.%s", cache,
        sample_kind_name(sample->kind), sample->count, sample->width, sample->height,
        SAMPLE_VERSION, formats[format].extension);
    if (access(path, R_OK) == 0) return;

    char temporary[PATH_SIZE];
    message_format(temporary, sizeof temporary, "%s.%ld", path, (long)getpid());
    FILE *file = fopen(temporary, "w");
    if (file == NULL) message_fail("%s cannot be written", temporary);
    formats[format].write(sample, file);
    bool good = !ferror(file);
    good = fclose(file) == 0 && good;
    if (!good || rename(temporary, path) != 0) {
        remove(temporary);
        message_fail("%s cannot be written", path);
    }
}
