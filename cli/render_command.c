/* SPDX-License-Identifier: MIT
 * One scene at a time: create, load, commit, render and save, destroy. A scene that fails is
 * reported, leaves no picture, and does not stop the others; an interrupt stops all. */
#define _XOPEN_SOURCE 700
#include "render_command.h"

#include "inputs.h"
#include "interrupt.h"
#include "layers.h"
#include "message.h"
#include "progress.h"
#include "stats.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* One scene on its way to a picture. */
typedef struct Drawing {
    const CliOptions *options;
    const CliJob *job;
    GlintScene *scene;
    float *pixels;
    CliLayers layers;
    GlintRenderDesc area;
    GlintMonitor monitor;
    CliProgress progress;
    CliStats stats;
    GlintError error; /* of the call that failed */
    int error_count, warning_count;
} Drawing;

/* ---------------------------------------------------------------- callbacks */

static void on_progress(void *user, GlintPhase phase, double fraction) {
    Drawing *drawing = user;
    cli_progress_update(&drawing->progress, phase, fraction);
}

static bool on_cancelled(void *user) {
    (void)user;
    return cli_interrupt_seen();
}

static void on_diagnostic(void *user, const GlintDiagnostic *diagnostic) {
    Drawing *drawing = user;
    if (diagnostic->severity == GLINT_SEVERITY_ERROR) {
        drawing->error_count++;
    } else {
        drawing->warning_count++;
    }
    cli_progress_clear(&drawing->progress);
    cli_message_diagnostic(diagnostic);
}

static int64_t on_read(void *user, void *buffer, size_t size) {
    Drawing *drawing = user;
    ssize_t count;
    do {
        count = read(STDIN_FILENO, buffer, size);
    } while (count < 0 && errno == EINTR && !cli_interrupt_seen());
    if (count > 0) drawing->progress.read_bytes += (uint64_t)count;
    return count;
}

/* ---------------------------------------------------------------- failures */

/* Reports the call that failed, unless its findings have been reported already. */
static void report(Drawing *drawing) {
    const GlintError *error = &drawing->error;
    cli_progress_clear(&drawing->progress);
    const char *name = cli_job_name(drawing->job);
    if (drawing->error_count == 0) {
        GlintDiagnostic diagnostic = {.severity = GLINT_SEVERITY_ERROR,
            .path = error->path[0] != '\0' ? error->path : name,
            .line = error->line,
            .column = error->column,
            .message =
                error->message[0] != '\0' ? error->message : glint_status_text(error->status),
            .caret_length = 1};
        cli_message_diagnostic(&diagnostic);
        return;
    }
    fprintf(stderr, "%s: %d %s", name, drawing->error_count,
        drawing->error_count == 1 ? "error" : "errors");
    if (drawing->warning_count > 0) {
        fprintf(stderr, ", %d %s", drawing->warning_count,
            drawing->warning_count == 1 ? "warning" : "warnings");
    }
    fputc('\n', stderr);
}

/* What the failed call means to the shell. file_status tells what GLINT_ERROR_FILE is: a scene that
 * cannot be read is the input's fault, a picture that cannot be written the machine's. */
static CliStatus fail(Drawing *drawing, GlintStatus status, CliStatus file_status) {
    /* An interrupt may also show itself as a failed read. */
    if (status == GLINT_CANCELLED || cli_interrupt_seen()) return CLI_OK;
    drawing->error.status = status;
    report(drawing);
    switch (status) {
    case GLINT_ERROR_FILE: return file_status;
    case GLINT_ERROR_MEMORY:
    case GLINT_ERROR_THREAD: return CLI_MACHINE;
    default: return CLI_INPUT;
    }
}

static CliStatus fail_machine(
    Drawing *drawing, GlintStatus status, const char *path, const char *text) {
    snprintf(drawing->error.path, sizeof drawing->error.path, "%s", path);
    snprintf(drawing->error.message, sizeof drawing->error.message, "%s", text);
    return fail(drawing, status, CLI_MACHINE);
}

/* ---------------------------------------------------------------- steps */

/* A picture that cannot be written is better known before the drawing than after it. */
static CliStatus check_picture(Drawing *drawing) {
    const char *picture = drawing->job->picture;
    struct stat info;
    bool exists = lstat(picture, &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) {
        return fail_machine(
            drawing, GLINT_ERROR_FILE, picture, "a folder stands in the picture's place");
    }
    /* A link leads elsewhere, and a pipe or device is written in place. */
    if (exists && !S_ISREG(info.st_mode)) return CLI_OK;
    const char *base = cli_path_base(picture);
    size_t length = (size_t)(base - picture);
    char *folder = malloc(length + 2);
    if (folder == NULL) return fail(drawing, GLINT_ERROR_MEMORY, CLI_MACHINE);
    snprintf(folder, length + 2, "%.*s", length > 0 ? (int)length : 1, length > 0 ? picture : ".");
    CliStatus status = CLI_OK;
    if (access(folder, W_OK) != 0) {
        char text[128];
        snprintf(text, sizeof text, "cannot write into the folder: %s", strerror(errno));
        status = fail_machine(drawing, GLINT_ERROR_FILE, picture, text);
    }
    free(folder);
    return status;
}

static GlintStatus load(Drawing *drawing) {
    if (!cli_job_reads_standard_input(drawing->job)) {
        return glint_scene_load_file(
            drawing->scene, drawing->job->scene, &drawing->monitor, &drawing->error);
    }
    return glint_scene_load_stream(drawing->scene, on_read, drawing, cli_job_name(drawing->job),
        &drawing->monitor, &drawing->error);
}

/* The part to draw, now that the scene's size is known. */
static CliStatus choose_area(Drawing *drawing) {
    const CliOptions *options = drawing->options;
    GlintSceneInfo info;
    glint_scene_info(drawing->scene, &info);
    CliStats *stats = &drawing->stats;
    stats->width = options->width > 0 ? options->width : info.width;
    stats->height = options->height > 0 ? options->height : info.height;
    bool crop = options->crop_width > 0;
    stats->crop_x = crop ? options->crop_x : 0;
    stats->crop_y = crop ? options->crop_y : 0;
    stats->crop_width = crop ? options->crop_width : stats->width;
    stats->crop_height = crop ? options->crop_height : stats->height;
    if ((int64_t)stats->crop_x + stats->crop_width > stats->width ||
        (int64_t)stats->crop_y + stats->crop_height > stats->height) {
        cli_progress_clear(&drawing->progress);
        return cli_message_usage("--crop %d,%d,%d,%d reaches outside of the %d x %d pixels of '%s'",
            stats->crop_x, stats->crop_y, stats->crop_width, stats->crop_height, stats->width,
            stats->height, cli_job_name(drawing->job));
    }
    drawing->area = glint_render_desc_default();
    drawing->area.width = options->width;
    drawing->area.height = options->height;
    drawing->area.samples = options->samples;
    drawing->area.crop_x = stats->crop_x;
    drawing->area.crop_y = stats->crop_y;
    drawing->area.crop_width = crop ? stats->crop_width : 0;
    drawing->area.crop_height = crop ? stats->crop_height : 0;
    drawing->area.monitor = &drawing->monitor;
    return CLI_OK;
}

/* Linux grants more memory than there is and kills the program later, so what cannot fit is
 * refused here. */
static bool allocate_pixels(Drawing *drawing) {
    uint64_t pixel_count =
        (uint64_t)drawing->stats.crop_width * (uint64_t)drawing->stats.crop_height;
    uint64_t size = pixel_count * 3 * sizeof(float);
    long page_count = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    bool known = page_count > 0 && page_size > 0;
    if (size > SIZE_MAX || (known && size / (uint64_t)page_size >= (uint64_t)page_count))
        return false;
    drawing->pixels = malloc((size_t)size);
    if (drawing->pixels == NULL) return false;
    GlintSceneInfo info;
    glint_scene_info(drawing->scene, &info);
    if (!cli_layers_init(&drawing->layers, drawing->options->layers, (size_t)pixel_count,
            (int)info.light_count)) {
        return false;
    }
    cli_layers_aim(&drawing->layers, &drawing->area);
    return true;
}

/* A picture with layers is drawn several times before it is written. */
static GlintStatus draw_layers(Drawing *drawing, const GlintSaveDesc *desc) {
    CliLayers *layers = &drawing->layers;
    GlintError *error = &drawing->error;
    if (!allocate_pixels(drawing)) {
        snprintf(error->message, sizeof error->message, "not enough memory for the picture");
        return GLINT_ERROR_MEMORY;
    }
    GlintStatus status = glint_render(drawing->scene, &drawing->area, drawing->pixels, error);
    if (status == GLINT_OK) {
        status = cli_layers_render(layers, drawing->scene, &drawing->area, error);
    }
    if (status != GLINT_OK) return status;
    GlintImage image = {.width = drawing->stats.crop_width,
        .height = drawing->stats.crop_height,
        .pixels = drawing->pixels};
    double began = cli_clock();
    status = cli_layers_save(layers, &image, drawing->job->picture, desc, error);
    drawing->stats.write_seconds = cli_clock() - began;
    return status;
}

static GlintStatus draw_plain(Drawing *drawing, const GlintSaveDesc *desc) {
    double began = cli_clock();
    GlintStatus status = glint_render_save(
        drawing->scene, &drawing->area, drawing->job->picture, desc, &drawing->error);
    GlintStats stats;
    glint_scene_stats(drawing->scene, &stats);
    drawing->stats.write_seconds = cli_clock() - began - stats.trace_seconds;
    return status;
}

static CliStatus draw(Drawing *drawing) {
    CliStatus refused = check_picture(drawing);
    if (refused != CLI_OK) return refused;

    GlintSceneDesc desc = glint_scene_desc_default();
    desc.dialect = drawing->options->dialect;
    desc.thread_count = drawing->options->thread_count;
    desc.isa = drawing->options->isa;
    desc.diagnostic = on_diagnostic;
    desc.diagnostic_user = drawing;
    GlintStatus status = glint_scene_create(&desc, &drawing->scene, &drawing->error);
    if (status != GLINT_OK) return fail(drawing, status, CLI_MACHINE);
    status = load(drawing);
    if (status != GLINT_OK) return fail(drawing, status, CLI_INPUT);
    refused = choose_area(drawing);
    if (refused != CLI_OK) return refused;
    status = glint_scene_commit(drawing->scene, &drawing->monitor, &drawing->error);
    if (status != GLINT_OK) return fail(drawing, status, CLI_INPUT);
    GlintSaveDesc save = glint_save_desc_default();
    save.title = cli_path_base(cli_job_name(drawing->job));
    save.thread_count = drawing->options->thread_count;
    save.monitor = &drawing->monitor;
    status =
        drawing->options->layers == 0 ? draw_plain(drawing, &save) : draw_layers(drawing, &save);
    if (status == GLINT_OK) return CLI_OK;
    if (status == GLINT_ERROR_FILE && drawing->error.path[0] == '\0') {
        snprintf(drawing->error.path, sizeof drawing->error.path, "%s", drawing->job->picture);
    }
    return fail(drawing, status, CLI_MACHINE);
}

/* ---------------------------------------------------------------- all scenes */

static CliStatus announce(Drawing *drawing) {
    CliStats *stats = &drawing->stats;
    stats->job = drawing->job;
    stats->total_seconds = cli_clock() - drawing->progress.began;
    stats->resident_peak = cli_stats_resident_peak();
    glint_scene_info(drawing->scene, &stats->scene);
    if (drawing->options->samples > 0) stats->scene.samples = drawing->options->samples;
    glint_scene_stats(drawing->scene, &stats->library);
    CliStatsFormat format = drawing->options->stats;
    if (format == CLI_STATS_JSON) {
        cli_stats_print_json(stats);
    } else if (!drawing->options->quiet) {
        puts(drawing->job->picture);
    }
    CliStatus status = cli_message_flush_output();
    if (format == CLI_STATS_TEXT) cli_stats_print_text(stats);
    return status;
}

CliStatus cli_render(const CliOptions *options) {
    CliJobs jobs;
    CliStatus status = cli_jobs_init(&jobs, options);
    bool progress = !options->quiet && cli_message_on_terminal();
    if (status < CLI_USAGE) {
        for (int i = 0; i < jobs.count && !cli_interrupt_seen(); i++) {
            Drawing drawing = {.options = options, .job = &jobs.items[i]};
            drawing.monitor = (GlintMonitor){on_progress, on_cancelled, &drawing};
            cli_progress_begin(
                &drawing.progress, progress, cli_job_name(drawing.job), i, jobs.count);
            CliStatus drawn = draw(&drawing);
            cli_progress_clear(&drawing.progress);
            if (drawn == CLI_OK && !cli_interrupt_seen()) drawn = announce(&drawing);
            status = cli_status_worse(status, drawn);
            free(drawing.pixels);
            cli_layers_reset(&drawing.layers);
            glint_scene_destroy(drawing.scene);
        }
    }
    cli_jobs_reset(&jobs);
    return status;
}
