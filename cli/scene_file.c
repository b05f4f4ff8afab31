/* SPDX-License-Identifier: MIT
 * Create, load, commit; an interrupt cancels each of them. */
#define _POSIX_C_SOURCE 200809L
#include "scene_file.h"

#include "interrupt.h"
#include "message.h"

#include <errno.h>
#include <stdio.h>
#include <unistd.h>

/* ---------------------------------------------------------------- callbacks */

static void on_progress(void *user, GlintPhase phase, double fraction) {
    CliSceneFile *file = user;
    cli_progress_update(&file->progress, phase, fraction);
}

static bool on_cancelled(void *user) {
    (void)user;
    return cli_interrupt_seen();
}

static void on_diagnostic(void *user, const GlintDiagnostic *diagnostic) {
    CliSceneFile *file = user;
    file->error_count += diagnostic->severity == GLINT_SEVERITY_ERROR;
    file->warning_count += diagnostic->severity == GLINT_SEVERITY_WARNING;
    cli_progress_clear(&file->progress);
    if (file->diagnostic != NULL) {
        file->diagnostic(file->diagnostic_user, diagnostic);
    } else {
        cli_message_diagnostic(diagnostic);
    }
}

static int64_t on_read(void *user, void *buffer, size_t size) {
    CliSceneFile *file = user;
    ssize_t count;
    do {
        count = read(STDIN_FILENO, buffer, size);
    } while (count < 0 && errno == EINTR && !cli_interrupt_seen());
    if (count > 0) file->progress.read_bytes += (uint64_t)count;
    return count;
}

/* ---------------------------------------------------------------- failures */

static void report(CliSceneFile *file) {
    const GlintError *error = &file->error;
    cli_progress_clear(&file->progress);
    const char *name = cli_job_name(file->job);
    if (file->error_count == 0) {
        GlintDiagnostic diagnostic = {.severity = GLINT_SEVERITY_ERROR,
            .path = error->path[0] != '\0' ? error->path : name,
            .line = error->line,
            .column = error->column,
            .message =
                error->message[0] != '\0' ? error->message : glint_status_text(error->status),
            .caret_length = 1,
            .rule = error->status == GLINT_ERROR_FILE ? "file" : "scene"};
        on_diagnostic(file, &diagnostic);
        return;
    }
    if (file->diagnostic != NULL) return;
    fprintf(
        stderr, "%s: %d %s", name, file->error_count, file->error_count == 1 ? "error" : "errors");
    if (file->warning_count > 0) {
        fprintf(stderr, ", %d %s", file->warning_count,
            file->warning_count == 1 ? "warning" : "warnings");
    }
    fputc('\n', stderr);
}

CliStatus cli_scene_file_fail(CliSceneFile *file, GlintStatus status, CliStatus file_status) {
    /* An interrupt may also show itself as a failed read. */
    if (status == GLINT_CANCELLED || cli_interrupt_seen()) return CLI_OK;
    file->error.status = status;
    report(file);
    switch (status) {
    case GLINT_ERROR_FILE: return file_status;
    case GLINT_ERROR_MEMORY:
    case GLINT_ERROR_THREAD: return CLI_MACHINE;
    default: return CLI_INPUT;
    }
}

/* ---------------------------------------------------------------- steps */

void cli_scene_file_begin(
    CliSceneFile *file, const CliJob *job, int index, int count, bool with_progress) {
    *file = (CliSceneFile){.job = job};
    file->monitor = (GlintMonitor){on_progress, on_cancelled, file};
    cli_progress_begin(&file->progress, with_progress, cli_job_name(job), index, count);
}

/* Finds the scene inside of a picture. */
static CliStatus open_picture(CliSceneFile *file) {
    const char *path = file->job->scene;
    GlintStatus status = glint_recipe_load(path, &file->recipe, &file->error);
    if (status != GLINT_OK) return cli_scene_file_fail(file, status, CLI_INPUT);
    if (cli_unpack_is_embedded(file->recipe)) {
        return cli_unpack(&file->unpacked, file->recipe, path);
    }
    snprintf(file->error.path, sizeof file->error.path, "%s", path);
    snprintf(file->error.message, sizeof file->error.message,
        "this picture has no scene inside: it was drawn without --embed");
    return cli_scene_file_fail(file, GLINT_ERROR_FILE, CLI_INPUT);
}

CliStatus cli_scene_file_load(CliSceneFile *file, const GlintSceneDesc *desc) {
    GlintSceneDesc own = *desc;
    const char *path = file->job->scene;
    if (!cli_job_reads_standard_input(file->job) && cli_unpack_is_picture(path)) {
        CliStatus opened = open_picture(file);
        if (opened != CLI_OK) return opened;
        path = file->unpacked.scene;
        if (own.dialect == GLINT_DIALECT_AUTO) own.dialect = file->recipe->dialect;
        if (cli_scene_file_reverses(&file->recipe->mistakes)) own.reverse_transforms = true;
    }
    own.diagnostic = on_diagnostic;
    own.diagnostic_user = file;
    GlintStatus status = glint_scene_create(&own, &file->scene, &file->error);
    if (status != GLINT_OK) return cli_scene_file_fail(file, status, CLI_MACHINE);
    if (cli_job_reads_standard_input(file->job)) {
        status = glint_scene_load_stream(
            file->scene, on_read, file, cli_job_name(file->job), &file->monitor, &file->error);
    } else {
        status = glint_scene_load_file(file->scene, path, &file->monitor, &file->error);
    }
    return status == GLINT_OK ? CLI_OK : cli_scene_file_fail(file, status, CLI_INPUT);
}

CliStatus cli_scene_file_commit(CliSceneFile *file) {
    GlintStatus status = glint_scene_commit(file->scene, &file->monitor, &file->error);
    return status == GLINT_OK ? CLI_OK : cli_scene_file_fail(file, status, CLI_INPUT);
}

void cli_scene_file_end(CliSceneFile *file) {
    cli_progress_clear(&file->progress);
    glint_scene_destroy(file->scene);
    file->scene = NULL;
    glint_recipe_destroy(file->recipe);
    file->recipe = NULL;
    cli_unpack_remove(&file->unpacked);
}
