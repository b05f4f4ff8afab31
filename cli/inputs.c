/* SPDX-License-Identifier: MIT
 * From arguments to jobs. All that can be known to be wrong before the first ray is checked here,
 * so that nobody waits an hour for a picture that has nowhere to go. */
#define _POSIX_C_SOURCE 200809L
#include "inputs.h"

#include "message.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

bool cli_job_reads_standard_input(const CliJob *job) { return strcmp(job->scene, "-") == 0; }

const char *cli_job_name(const CliJob *job) {
    return cli_job_reads_standard_input(job) ? "stdin" : job->scene;
}

const char *cli_path_base(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static bool is_folder(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

static bool has_ending(const char *text, const char *ending) {
    size_t length = strlen(text), ending_length = strlen(ending);
    return length >= ending_length && strcasecmp(text + length - ending_length, ending) == 0;
}

static bool names_picture(const char *path) {
    return has_ending(path, ".png") || has_ending(path, ".pfm") || has_ending(path, ".exr");
}

/* folder + "/" + name + ending; a null folder is left out. Null: no memory. */
static char *join(const char *folder, const char *name, const char *ending) {
    const char *between = folder == NULL || has_ending(folder, "/") ? "" : "/";
    if (folder == NULL) folder = "";
    size_t size = strlen(folder) + strlen(between) + strlen(name) + strlen(ending) + 1;
    char *path = malloc(size);
    if (path != NULL) snprintf(path, size, "%s%s%s%s", folder, between, name, ending);
    return path;
}

static CliStatus out_of_memory(void) {
    cli_message_error("%s", glint_status_text(GLINT_ERROR_MEMORY));
    return CLI_MACHINE;
}

/* Takes scene over, also when it fails. The picture's name comes later. */
static CliStatus add(CliJobs *jobs, char *scene) {
    if (scene == NULL) return out_of_memory();
    if (jobs->count == jobs->capacity) {
        int capacity = jobs->capacity > 0 ? 2 * jobs->capacity : 16;
        CliJob *items = realloc(jobs->items, (size_t)capacity * sizeof *items);
        if (items == NULL) {
            free(scene);
            return out_of_memory();
        }
        jobs->items = items;
        jobs->capacity = capacity;
    }
    jobs->items[jobs->count++] = (CliJob){.scene = scene};
    return CLI_OK;
}

/* Byte order, so that it is the same in every locale. */
static int compare_scenes(const void *a, const void *b) {
    return strcmp(((const CliJob *)a)->scene, ((const CliJob *)b)->scene);
}

static CliStatus add_folder(CliJobs *jobs, const char *path) {
    DIR *folder = opendir(path);
    if (folder == NULL) {
        cli_message_error("cannot read the folder '%s': %s", path, strerror(errno));
        return CLI_INPUT;
    }
    int first = jobs->count;
    CliStatus status = CLI_OK;
    const struct dirent *entry;
    while (status == CLI_OK && (entry = readdir(folder)) != NULL) {
        size_t length = strlen(entry->d_name);
        bool hidden = entry->d_name[0] == '.';
        if (hidden || length < 4 || strcmp(entry->d_name + length - 4, ".xml") != 0) continue;
        status = add(jobs, join(path, entry->d_name, ""));
        if (status == CLI_OK && is_folder(jobs->items[jobs->count - 1].scene)) {
            free(jobs->items[--jobs->count].scene);
        }
    }
    closedir(folder);
    if (status != CLI_OK) return status;
    if (jobs->count == first) {
        cli_message_error("no *.xml in the folder '%s'", path);
        return CLI_INPUT;
    }
    qsort(jobs->items + first, (size_t)(jobs->count - first), sizeof *jobs->items, compare_scenes);
    return CLI_OK;
}

/* One scene and -o FILE: that file. Otherwise FILE must be a folder. */
static CliStatus name_pictures(CliJobs *jobs, const char *output, const char *ending) {
    bool into_folder = output != NULL && is_folder(output);
    if (output != NULL && !into_folder) {
        if (has_ending(output, "/")) return cli_message_usage("there is no folder '%s'", output);
        if (jobs->count > 1) {
            return cli_message_usage(
                "%d scenes do not fit into one picture: --output must name a folder that exists, "
                "and '%s' does not",
                jobs->count, output);
        }
        if (!names_picture(output)) {
            return cli_message_usage(
                "--output takes a name that ends in .png, .pfm or .exr, not '%s'", output);
        }
        /* Better now than after an hour of drawing. */
        GlintError error;
        if (glint_image_check_path(output, &error) != GLINT_OK) {
            cli_message_error("%s", error.message);
            return CLI_MACHINE;
        }
    }
    for (int i = 0; i < jobs->count; i++) {
        CliJob *job = &jobs->items[i];
        if (output != NULL && !into_folder) {
            job->picture = join(NULL, output, "");
        } else {
            const char *name = cli_job_name(job);
            job->picture =
                into_folder ? join(output, cli_path_base(name), ending) : join(NULL, name, ending);
        }
        if (job->picture == NULL) return out_of_memory();
    }
    return CLI_OK;
}

static int compare_pictures(const void *a, const void *b) {
    const CliJob *const *first = a, *const *second = b;
    return strcmp((*first)->picture, (*second)->picture);
}

/* Two scenes of the same name and one folder for both: the second would destroy the first. */
static CliStatus check_collisions(const CliJobs *jobs) {
    const CliJob **sorted = malloc((size_t)jobs->count * sizeof *sorted);
    if (sorted == NULL) return out_of_memory();
    for (int i = 0; i < jobs->count; i++) sorted[i] = &jobs->items[i];
    qsort(sorted, (size_t)jobs->count, sizeof *sorted, compare_pictures);
    CliStatus status = CLI_OK;
    for (int i = 1; i < jobs->count && status == CLI_OK; i++) {
        const CliJob *a = sorted[i - 1], *b = sorted[i];
        if (strcmp(a->picture, b->picture) == 0 && strcmp(a->scene, b->scene) != 0) {
            status = cli_message_usage(
                "'%s' and '%s' would both be drawn to '%s'", a->scene, b->scene, a->picture);
        }
    }
    free(sorted);
    return status;
}

static CliStatus check_operands(const CliOperands *scenes) {
    if (scenes->count == 0) return cli_message_usage("no scene given");
    int standard_inputs = 0;
    for (int i = 0; i < scenes->count; i++) {
        if (scenes->items[i][0] == '\0') return cli_message_usage("a scene has an empty name");
        standard_inputs += strcmp(scenes->items[i], "-") == 0;
    }
    if (standard_inputs > 1) return cli_message_usage("standard input can be read only once");
    return CLI_OK;
}

CliStatus cli_jobs_init_plain(CliJobs *jobs, const CliOperands *scenes) {
    *jobs = (CliJobs){0};
    CliStatus status = check_operands(scenes);
    for (int i = 0; i < scenes->count && status < CLI_USAGE; i++) {
        const char *path = scenes->items[i];
        CliStatus added = strcmp(path, "-") != 0 && is_folder(path)
                              ? add_folder(jobs, path)
                              : add(jobs, join(NULL, path, ""));
        status = cli_status_worse(status, added);
    }
    return status;
}

CliStatus cli_jobs_init(
    CliJobs *jobs, const CliOperands *scenes, const char *output, const char *ending) {
    CliStatus status = cli_jobs_init_plain(jobs, scenes);
    if (status < CLI_USAGE && jobs->count > 0) {
        status = cli_status_worse(status, name_pictures(jobs, output, ending));
    }
    if (status < CLI_USAGE && jobs->count > 1) {
        status = cli_status_worse(status, check_collisions(jobs));
    }
    return status;
}

void cli_jobs_reset(CliJobs *jobs) {
    for (int i = 0; i < jobs->count; i++) {
        free(jobs->items[i].scene);
        free(jobs->items[i].picture);
    }
    free(jobs->items);
    *jobs = (CliJobs){0};
}
