/* SPDX-License-Identifier: MIT
 * A pool of workers and the one parallel loop. The thread that calls is worker 0 and works too, so
 * a pool of one starts no thread. The pool belongs to one caller at a time. */
#pragma once

#include "base/memory.h"

typedef struct GiPool GiPool;

/* The workers of a pool for so many threads; 0: one per core. */
int gi_pool_size(int thread_count);

/* thread_count as above. Errors: MEMORY, THREAD. */
GlintStatus gi_pool_create(GiMemory *memory, int thread_count, GiPool **pool);

/* Waits for the workers to end. Null is allowed. */
void gi_pool_destroy(GiPool *pool);

int gi_pool_worker_count(const GiPool *pool);

/* function works on [begin, end); worker, in 0 .. worker_count - 1, says whose scratch to use. */
typedef void (*GiParallelFn)(void *context, size_t begin, size_t end, int worker);

/* Runs function on disjoint blocks that cover [0, count), about four a worker and none smaller
 * than min_range, and returns when all are done. Which worker gets which block differs from run to
 * run, so results must not depend on it. */
void gi_parallel_for(
    GiPool *pool, size_t count, size_t min_range, GiParallelFn function, void *context);

/* The same in two halves, between which the caller does something else while the other workers
 * begin. What they have not taken by then the caller does in gi_parallel_end: without other
 * workers all of it. Every begin has its end before the pool is used again. */
void gi_parallel_begin(
    GiPool *pool, size_t count, size_t min_range, GiParallelFn function, void *context);
void gi_parallel_end(GiPool *pool);

/* For worker 0 inside a loop's function, when nothing is left for it: waits until the other workers
 * have left the loop, or so many seconds. Returns whether they have. */
bool gi_parallel_wait(GiPool *pool, double seconds);
