/* SPDX-License-Identifier: MIT
 * A scene on its way from a file, or from standard input, to a GlintScene; and what is said when
 * that fails. Every verb that reads scenes begins with it. */
#pragma once

#include "inputs.h"
#include "progress.h"
#include "unpack.h"

typedef struct CliSceneFile {
    const CliJob *job;
    GlintScene *scene;    /* null: not yet, or it could not be made */
    GlintMonitor monitor; /* of this scene: progress on a terminal, cancelled by an interrupt */
    CliProgress progress;
    GlintError error;               /* of the call that failed */
    int error_count, warning_count; /* findings shown so far */
    /* Of a job that is a picture: how it was drawn, and the scene that it contains. */
    GlintRecipe *recipe;
    CliUnpacked unpacked;
    /* Where findings go; null: shown on standard error. */
    GlintDiagnosticFn diagnostic;
    void *diagnostic_user;
} CliSceneFile;

/* Begins with a job: the index-th of count. The struct must not move afterwards. */
void cli_scene_file_begin(
    CliSceneFile *file, const CliJob *job, int index, int count, bool with_progress);

/* Whether these mistakes are to be made by a scene's desc.reverse_transforms. */
static inline bool cli_scene_file_reverses(const GlintMistakes *mistakes) {
    return (mistakes->set & GLINT_MISTAKE_BIT(GLINT_MISTAKE_TRANSFORMS_REVERSED)) != 0;
}

/* Creates the scene and loads it; of a picture, the scene inside, under the dialect of its recipe
 * if desc asks for none. desc: glint_scene_desc_default, with what the verb has changed; its
 * diagnostic is set here. Reports what is wrong. */
CliStatus cli_scene_file_load(CliSceneFile *file, const GlintSceneDesc *desc);

/* Commits it. */
CliStatus cli_scene_file_commit(CliSceneFile *file);

/* Reports a call that failed with file->error filled, unless its findings have been shown already.
 * Returns what it means to the shell: file_status for GLINT_ERROR_FILE, since a scene that cannot
 * be read is the input's fault, a picture that cannot be written the machine's; CLI_OK after an
 * interrupt, of which nothing is said. */
CliStatus cli_scene_file_fail(CliSceneFile *file, GlintStatus status, CliStatus file_status);

/* Clears the line of progress and frees the scene. */
void cli_scene_file_end(CliSceneFile *file);
