/* SPDX-License-Identifier: MIT
 * Finds in a committed scene what is legal but surely a mistake. What a rule says must be true: it
 * is measured on the scene as it is drawn, by the same rays, and where that cannot be done at a
 * reasonable price, nothing is said. */
#pragma once

#include "reader/source.h"
#include "render/world.h"
#include "sched/pool.h"

typedef struct GiCheckInput {
    const GiWorld *world;
    GiPool *pool;
    GiSources *sources; /* all zero: findings have no place */
    const GlintMonitor *monitor;
    GlintDiagnosticFn diagnostic; /* null: nobody listens */
    void *diagnostic_user;
} GiCheckInput;

/* Reports all findings, in the order of the file. Errors: MEMORY, CANCELLED. */
GlintStatus gi_check(const GiCheckInput *input, GlintError *error);
