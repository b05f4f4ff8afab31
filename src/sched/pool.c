/* SPDX-License-Identifier: MIT
 * Workers sleep on a condition until a loop is announced by a new generation number, claim blocks
 * from one atomic counter, and report back. The caller returns when every worker that entered the
 * loop has left it, so the loop's data may live on the caller's stack. */
#define _POSIX_C_SOURCE 200809L /* pthread_condattr_setclock */
#include "sched/pool.h"

#include "port/machine.h"

#include <pthread.h>
#include <string.h>
#include <time.h>

typedef struct Loop {
    size_t count, block;
    GiParallelFn function;
    void *context;
    _Atomic size_t next;
} Loop;

struct GiPool {
    GiMemory *memory;
    int worker_count; /* with the caller */
    int started;      /* threads */
    pthread_t *threads;
    size_t threads_size; /* bytes */
    pthread_mutex_t mutex;
    pthread_cond_t wake, done;
    Loop loop;
    unsigned generation;
    int active; /* workers inside the loop */
    bool quit;
};

enum { WORKER_LIMIT = 1024, STACK_LEAST = 1 << 20 };

static void work(Loop *loop, int worker) {
    for (;;) {
        size_t begin = atomic_fetch_add_explicit(&loop->next, loop->block, memory_order_relaxed);
        if (begin >= loop->count) return;
        size_t end = loop->count - begin < loop->block ? loop->count : begin + loop->block;
        loop->function(loop->context, begin, end, worker);
    }
}

static void *run_worker(void *argument) {
    GiPool *pool = argument;
    pthread_mutex_lock(&pool->mutex);
    int worker = ++pool->started;
    unsigned seen = 0;
    for (;;) {
        while (!pool->quit && pool->generation == seen)
            pthread_cond_wait(&pool->wake, &pool->mutex);
        if (pool->quit) break;
        seen = pool->generation;
        pool->active++;
        pthread_mutex_unlock(&pool->mutex);
        work(&pool->loop, worker);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->active == 0) pthread_cond_signal(&pool->done);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

static GlintStatus start(GiPool *pool, int count, const pthread_attr_t *attributes) {
    if (count <= 0) return GLINT_OK;
    pool->threads_size = (size_t)count * sizeof *pool->threads;
    pool->threads = gi_memory_allocate(pool->memory, pool->threads_size);
    if (pool->threads == NULL) return GLINT_ERROR_MEMORY;
    for (int i = 0; i < count; i++) {
        if (pthread_create(&pool->threads[i], attributes, run_worker, pool) != 0) {
            return GLINT_ERROR_THREAD;
        }
        pool->worker_count++;
    }
    return GLINT_OK;
}

int gi_pool_size(int thread_count) {
    if (thread_count <= 0) thread_count = gi_machine_core_count();
    return thread_count < WORKER_LIMIT ? thread_count : WORKER_LIMIT;
}

GlintStatus gi_pool_create(GiMemory *memory, int thread_count, GiPool **result) {
    thread_count = gi_pool_size(thread_count);
    GiPool *pool = gi_memory_allocate(memory, sizeof *pool);
    if (pool == NULL) return GLINT_ERROR_MEMORY;
    memset(pool, 0, sizeof *pool);
    pool->memory = memory;
    pool->worker_count = 1;
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_condattr_t clock;
    pthread_condattr_init(&clock);
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    pthread_cond_init(&pool->done, &clock);
    pthread_condattr_destroy(&clock);
    /* A kernel takes up to half a megabyte (kernel/inside.h); some C libraries give less.
     */
    pthread_attr_t attributes;
    size_t stack_size = 0;
    pthread_attr_init(&attributes);
    pthread_attr_getstacksize(&attributes, &stack_size);
    if (stack_size < STACK_LEAST) pthread_attr_setstacksize(&attributes, STACK_LEAST);
    GlintStatus status = start(pool, thread_count - 1, &attributes);
    pthread_attr_destroy(&attributes);
    if (status != GLINT_OK) {
        gi_pool_destroy(pool);
        return status;
    }
    *result = pool;
    return GLINT_OK;
}

void gi_pool_destroy(GiPool *pool) {
    if (pool == NULL) return;
    pthread_mutex_lock(&pool->mutex);
    pool->quit = true;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->mutex);
    for (int i = 0; i < pool->worker_count - 1; i++) pthread_join(pool->threads[i], NULL);
    gi_memory_free(pool->memory, pool->threads, pool->threads_size);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->mutex);
    gi_memory_free(pool->memory, pool, sizeof *pool);
}

int gi_pool_worker_count(const GiPool *pool) { return pool->worker_count; }

void gi_parallel_begin(
    GiPool *pool, size_t count, size_t min_range, GiParallelFn function, void *context) {
    if (min_range == 0) min_range = 1;
    size_t block = count / ((size_t)pool->worker_count * 4);
    if (block < min_range) block = min_range;
    pthread_mutex_lock(&pool->mutex);
    /* A worker that woke late for the last loop may still be looking at it; it finds nothing left
     * there and leaves at once. */
    while (pool->active > 0) pthread_cond_wait(&pool->done, &pool->mutex);
    pool->loop.count = count;
    pool->loop.block = block;
    pool->loop.function = function;
    pool->loop.context = context;
    atomic_store_explicit(&pool->loop.next, 0, memory_order_relaxed);
    pool->generation++;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->mutex);
}

void gi_parallel_end(GiPool *pool) {
    work(&pool->loop, 0);
    pthread_mutex_lock(&pool->mutex);
    while (pool->active > 0) pthread_cond_wait(&pool->done, &pool->mutex);
    pthread_mutex_unlock(&pool->mutex);
}

bool gi_parallel_wait(GiPool *pool, double seconds) {
    struct timespec end;
    clock_gettime(CLOCK_MONOTONIC, &end);
    int64_t nanoseconds = end.tv_nsec + (int64_t)(seconds * 1e9);
    end.tv_sec += (time_t)(nanoseconds / 1000000000);
    end.tv_nsec = (long)(nanoseconds % 1000000000);
    pthread_mutex_lock(&pool->mutex);
    int late = 0;
    while (pool->active > 0 && late == 0) {
        late = pthread_cond_timedwait(&pool->done, &pool->mutex, &end);
    }
    bool left = pool->active == 0;
    pthread_mutex_unlock(&pool->mutex);
    return left;
}

void gi_parallel_for(
    GiPool *pool, size_t count, size_t min_range, GiParallelFn function, void *context) {
    if (count == 0) return;
    if (pool->worker_count == 1 || count <= min_range || count == 1) {
        function(context, 0, count, 0);
        return;
    }
    gi_parallel_begin(pool, count, min_range, function, context);
    gi_parallel_end(pool);
}
