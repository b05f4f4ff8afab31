/* SPDX-License-Identifier: MIT */
#include "sched/tasks.h"

#include "base/array.h"

#include <pthread.h>
#include <string.h>

enum { TASK_LIMIT = 128 }; /* bytes */

struct GiTasks {
    GiMemory *memory;
    size_t size;
    GiTaskFn function;
    void *context;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    GI_ARRAY(char) stack;
    size_t open; /* added and not finished */
};

bool gi_tasks_add(GiTasks *tasks, const void *task) {
    pthread_mutex_lock(&tasks->mutex);
    bool done = gi_array_reserve(tasks->memory, &tasks->stack, tasks->size);
    if (done) {
        memcpy(tasks->stack.data + tasks->stack.count, task, tasks->size);
        tasks->stack.count += tasks->size;
        tasks->open++;
        pthread_cond_signal(&tasks->changed);
    }
    pthread_mutex_unlock(&tasks->mutex);
    return done;
}

static void run(void *context, size_t begin, size_t end, int worker) {
    (void)begin;
    (void)end;
    GiTasks *tasks = context;
    _Alignas(16) char task[TASK_LIMIT];
    pthread_mutex_lock(&tasks->mutex);
    for (;;) {
        while (tasks->stack.count == 0 && tasks->open > 0) {
            pthread_cond_wait(&tasks->changed, &tasks->mutex);
        }
        if (tasks->open == 0) break;
        tasks->stack.count -= tasks->size;
        memcpy(task, tasks->stack.data + tasks->stack.count, tasks->size);
        pthread_mutex_unlock(&tasks->mutex);
        tasks->function(tasks, tasks->context, task, worker);
        pthread_mutex_lock(&tasks->mutex);
        if (--tasks->open == 0) pthread_cond_broadcast(&tasks->changed);
    }
    pthread_mutex_unlock(&tasks->mutex);
}

GlintStatus gi_tasks_run(GiPool *pool, GiMemory *memory, const void *first, size_t task_size,
    GiTaskFn function, void *context) {
    if (task_size > TASK_LIMIT) return GLINT_ERROR_ARGUMENT;
    GiTasks tasks = {.memory = memory, .size = task_size, .function = function, .context = context};
    pthread_mutex_init(&tasks.mutex, NULL);
    pthread_cond_init(&tasks.changed, NULL);
    GlintStatus status = GLINT_ERROR_MEMORY;
    if (gi_tasks_add(&tasks, first)) {
        gi_parallel_for(pool, (size_t)gi_pool_worker_count(pool), 1, run, &tasks);
        status = GLINT_OK;
    }
    gi_array_free(memory, &tasks.stack);
    pthread_cond_destroy(&tasks.changed);
    pthread_mutex_destroy(&tasks.mutex);
    return status;
}
