/* SPDX-License-Identifier: MIT */
#include "program.h"

#include "message.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *contest_program_name(Program program) {
    static const char *const names[PROGRAM_COUNT] = {
        [PROGRAM_GLINT] = "glint",
        [PROGRAM_OTHER_GLINT] = "other glint",
        [PROGRAM_TACHYON] = "tachyon",
        [PROGRAM_POVRAY_BM1] = "povray +BM1",
        [PROGRAM_POVRAY_BM2] = "povray +BM2",
    };
    return names[program];
}

SceneFormat program_format(Program program) {
    switch (program) {
    case PROGRAM_TACHYON: return FORMAT_TACHYON;
    case PROGRAM_POVRAY_BM1:
    case PROGRAM_POVRAY_BM2: return FORMAT_POVRAY;
    default: return FORMAT_XML;
    }
}

/* ---------------------------------------------------------------- commands */

/* {scene}, {picture}, {threads}, {width} and {height} are filled in. No argument holds a blank.
 * POV-Ray: no display, no antialiasing, none of its console streams, linear output. */
static const char *const templates[PROGRAM_COUNT] = {
    [PROGRAM_GLINT] = "-q --stats=json -t {threads} -o {picture} {scene}",
    [PROGRAM_OTHER_GLINT] = "-q --stats=json -t {threads} -o {picture} {scene}",
    [PROGRAM_TACHYON] = "{scene} -numthreads {threads} -format PNG -o {picture}",
    [PROGRAM_POVRAY_BM1] = "{scene} +O{picture} +W{width} +H{height} +WT{threads} +BM1 -D -A -V "
                           "-GA +FN8 File_Gamma=1.0",
    [PROGRAM_POVRAY_BM2] = "{scene} +O{picture} +W{width} +H{height} +WT{threads} +BM2 -D -A -V "
                           "-GA +FN8 File_Gamma=1.0",
};

typedef struct Value {
    const char *key, *text;
} Value;

/* One argument of a template, up to a blank, with the values in place of the keys. */
static void fill(const char *template, size_t length, const Value *values, char *text) {
    size_t used = 0;
    for (size_t i = 0; i < length;) {
        const Value *value = values;
        while (value->key != NULL && strncmp(template + i, value->key, strlen(value->key)) != 0) {
            value++;
        }
        if (value->key != NULL) {
            message_format(text + used, PATH_SIZE - used, "%s", value->text);
            i += strlen(value->key);
        } else {
            message_format(text + used, PATH_SIZE - used, "%c", template[i++]);
        }
        used += strlen(text + used);
    }
}

void program_command(const Field *field, const BenchScene *scene, Program program, int threads,
    bool exact, Command *command) {
    char path[PATH_SIZE], thread_text[16], width[16], height[16];
    scenes_file(scene, program_format(program), field->cache, path);
    message_format(command->picture, PATH_SIZE, "%s/picture-%d-%d.%s", field->cache, (int)program,
        threads, exact && program <= PROGRAM_OTHER_GLINT ? "pfm" : "png");
    message_format(command->output, PATH_SIZE, "%s/output", field->cache);
    message_format(command->error, PATH_SIZE, "%s/error", field->cache);
    message_format(thread_text, sizeof thread_text, "%d", threads);
    message_format(width, sizeof width, "%d", scene->sample.width);
    message_format(height, sizeof height, "%d", scene->sample.height);
    const Value values[] = {{"{scene}", path}, {"{picture}", command->picture},
        {"{threads}", thread_text}, {"{width}", width}, {"{height}", height}, {NULL, NULL}};

    int count = 0;
    message_format(command->texts[count++], PATH_SIZE, "%s", field->paths[program]);
    for (const char *rest = templates[program]; *rest != '\0' && count + 1 < ARGUMENT_MAX;) {
        size_t length = strcspn(rest, " ");
        fill(rest, length, values, command->texts[count++]);
        rest += length + (rest[length] == ' ');
    }
    for (int i = 0; i < count; i++) command->arguments[i] = command->texts[i];
    command->arguments[count] = NULL;
}

/* ---------------------------------------------------------------- phases */

/* The number after "key": behind "object"; 0 where an older Glint has none. The JSON is our own: a
 * line, keys in a known order. */
static double number(const char *json, const char *object, const char *key) {
    char quoted[32];
    message_format(quoted, sizeof quoted, "\"%s\": {", object);
    const char *place = strstr(json, quoted);
    message_format(quoted, sizeof quoted, "\"%s\": ", key);
    if (place != NULL) place = strstr(place, quoted);
    return place != NULL ? strtod(place + strlen(quoted), NULL) : 0;
}

static void phases_of_glint(const char *json, Entry *entry, int rep) {
    entry->values[MEASURE_READ][rep] = number(json, "seconds", "read");
    entry->values[MEASURE_BUILD][rep] = number(json, "seconds", "build");
    entry->values[MEASURE_TRACE][rep] = number(json, "seconds", "trace");
    entry->values[MEASURE_WRITE][rep] = number(json, "seconds", "write");
    entry->values[MEASURE_ALLOCATED][rep] = number(json, "memory", "allocated_peak");
    entry->read_size = number(json, "scene_counts", "bytes");
    entry->primitives = number(json, "tree", "primitives");
    entry->camera_rays = number(json, "rays", "camera");
    entry->shadow_rays = number(json, "rays", "shadow");
}

/* "  Ray Tracing Time:     0.8925 seconds" and the like. */
static void phases_of_tachyon(const char *text, Entry *entry, int rep) {
    static const struct {
        Measure measure;
        const char *before;
    } phases[] = {{MEASURE_READ, "Scene Parsing Time:"}, {MEASURE_BUILD, "Preprocessing Time:"},
        {MEASURE_TRACE, "Ray Tracing Time:"}, {MEASURE_WRITE, "Image I/O Time:"}};
    for (size_t i = 0; i < sizeof phases / sizeof phases[0]; i++) {
        const char *place = strstr(text, phases[i].before);
        if (place == NULL) continue;
        entry->values[phases[i].measure][rep] = strtod(place + strlen(phases[i].before), NULL);
    }
}

void program_phases(Program program, const char *output_path, Entry *entry, int rep) {
    char text[16384];
    FILE *file = fopen(output_path, "r");
    size_t length = file != NULL ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file != NULL) fclose(file);
    text[length] = '\0';
    if (program <= PROGRAM_OTHER_GLINT) phases_of_glint(text, entry, rep);
    if (program == PROGRAM_TACHYON) phases_of_tachyon(text, entry, rep);
}
