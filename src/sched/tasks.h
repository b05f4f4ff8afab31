/* SPDX-License-Identifier: MIT
 * Work that begets work: a shared stack of small tasks, run by all workers of a pool until it is
 * empty and nobody is working on one. */
#pragma once

#include "sched/pool.h"

typedef struct GiTasks GiTasks;

/* Runs one task, a copy of what was added; may add more. */
typedef void (*GiTaskFn)(GiTasks *tasks, void *context, const void *task, int worker);

/* Runs *first and all that comes of it. Errors: MEMORY. */
GlintStatus gi_tasks_run(GiPool *pool, GiMemory *memory, const void *first, size_t task_size,
    GiTaskFn function, void *context);

/* False when memory is short; the caller must then do the work itself. */
bool gi_tasks_add(GiTasks *tasks, const void *task);
