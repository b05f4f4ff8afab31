/* SPDX-License-Identifier: MIT
 * What a GlintScene is, for the files of the public functions. */
#pragma once

#include "base/error.h"
#include "reader/reader.h"
#include "render/render.h"
#include "sched/pool.h"

struct GlintScene {
    GiMemory memory;
    GiScene model;
    GiWorld world;
    GiPool *pool; /* from commit on */
    const GiKernel *kernel;
    GlintDialect dialect; /* asked for */
    int thread_count;
    GlintDiagnosticFn diagnostic;
    void *diagnostic_user;
    bool keeps_sources, reverses_transforms;
    GiSources sources;         /* of what a file has brought; all zero otherwise */
    GiFileNames missing_files; /* that the scene file names */
    bool committed, broken;    /* broken: a load or commit failed */
    GlintStats stats;
};

/* The camera that a desc describes. Errors: ARGUMENT. */
GlintStatus gi_glint_camera(const GlintCameraDesc *desc, GiCamera *camera, GlintError *error);

/* What desc asks for, and the workers for it; color and png are left to the caller. The target
 * points at *view. Errors: those of glint_render. */
GlintStatus gi_scene_plan_render(GlintScene *scene, const GlintRenderDesc *desc, GiRenderArea *area,
    GiRenderTarget *target, GiView *view, GlintError *error);

#define ARGUMENT(error, ...) gi_error_set((error), GLINT_ERROR_ARGUMENT, __VA_ARGS__)

static inline bool is_finite3(const double v[3]) {
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static inline bool is_zero3(const double v[3]) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }
