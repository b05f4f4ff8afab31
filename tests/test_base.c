/* SPDX-License-Identifier: MIT
 * What everything stands on: counted memory, arrays, errors, the pool of workers and its tasks. */
#include "test.h"

#include "base/array.h"
#include "base/digest.h"
#include "base/error.h"
#include "random.h"
#include "sched/pool.h"
#include "sched/tasks.h"

#include <sched.h>
#include <stdlib.h>
#include <string.h>

static const int worker_counts[] = {1, 2, 3, 8, 32};
enum { WORKER_COUNTS = sizeof worker_counts / sizeof worker_counts[0], MOST_WORKERS = 32 };

/* ---------------------------------------------------------------- memory */

static void memory_is_counted(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    void *a = gi_memory_allocate(&memory, 100), *b = gi_memory_allocate(&memory, 50);
    CHECK(a != NULL && b != NULL);
    CHECK_INT(atomic_load(&memory.used), 150);
    memset(a, 7, 100);
    a = gi_memory_resize(&memory, a, 100, 1000);
    CHECK(a != NULL && ((char *)a)[99] == 7);
    CHECK_INT(atomic_load(&memory.used), 1050);
    a = gi_memory_resize(&memory, a, 1000, 10);
    CHECK(a != NULL && ((char *)a)[9] == 7);
    CHECK_INT(atomic_load(&memory.used), 60);
    CHECK_INT(atomic_load(&memory.peak), 1050);
    gi_memory_free(&memory, a, 10);
    gi_memory_free(&memory, b, 50);
    gi_memory_free(&memory, NULL, 50);
    CHECK_INT(atomic_load(&memory.used), 0);
}

static void memory_limit(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 1000);
    char *a = gi_memory_allocate(&memory, 900);
    CHECK(a != NULL);
    a[899] = 'x';
    CHECK(gi_memory_allocate(&memory, 101) == NULL);
    CHECK(gi_memory_allocate(&memory, SIZE_MAX) == NULL);
    CHECK(gi_memory_allocate(&memory, SIZE_MAX - 500) == NULL);
    CHECK(gi_memory_resize(&memory, a, 900, 1001) == NULL);
    CHECK(a[899] == 'x');
    CHECK_INT(atomic_load(&memory.used), 900);
    void *b = gi_memory_allocate(&memory, 100);
    CHECK(b != NULL);
    CHECK(gi_memory_allocate(&memory, 1) == NULL);
    CHECK_INT(atomic_load(&memory.peak), 1000);
    gi_memory_free(&memory, a, 900);
    gi_memory_free(&memory, b, 100);
    CHECK_INT(atomic_load(&memory.used), 0);
}

static void *refuse(void *user, void *pointer, size_t old_size, size_t new_size) {
    (void)old_size;
    bool *refuses = user;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    return *refuses ? NULL : realloc(pointer, new_size);
}

static void memory_refused(void) {
    bool refuses = false;
    GlintAllocator allocator = {refuse, &refuses};
    GiMemory memory;
    gi_memory_init(&memory, &allocator, 0);
    char *a = gi_memory_allocate(&memory, 64);
    refuses = true;
    CHECK(gi_memory_allocate(&memory, 10) == NULL);
    CHECK(gi_memory_resize(&memory, a, 64, 128) == NULL);
    CHECK(gi_memory_resize(&memory, a, 64, 32) == NULL);
    CHECK(gi_memory_allocate_lines(&memory, 10, 10) == NULL);
    CHECK_INT(atomic_load(&memory.used), 64);
    gi_memory_free(&memory, a, 64);
    CHECK_INT(atomic_load(&memory.used), 0);
}

static void memory_lines(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    char *blocks[200];
    for (size_t i = 0; i < 200; i++) {
        blocks[i] = gi_memory_allocate_lines(&memory, i, 1 + i % 7);
        CHECK(blocks[i] != NULL && (uintptr_t)blocks[i] % 64 == 0);
        memset(blocks[i], (int)i, i * (1 + i % 7));
    }
    for (size_t i = 0; i < 200; i++) {
        for (size_t k = 0; k < i * (1 + i % 7); k++) {
            if (blocks[i][k] != (char)i) test_fail(__FILE__, __LINE__, "block %zu was changed", i);
        }
        gi_memory_free_lines(&memory, blocks[i], i, 1 + i % 7);
    }
    gi_memory_free_lines(&memory, NULL, 3, 4);
    CHECK_INT(atomic_load(&memory.used), 0);
    CHECK(gi_memory_allocate_lines(&memory, SIZE_MAX, 2) == NULL);
    CHECK(gi_memory_allocate_lines(&memory, SIZE_MAX / 2 + 1, 2) == NULL);
    CHECK(gi_memory_allocate_lines(&memory, SIZE_MAX, 1) == NULL);
    CHECK(gi_memory_allocate_lines(&memory, SIZE_MAX - 71, 1) == NULL);
    CHECK_INT(atomic_load(&memory.used), 0);
}

static void sizes(void) {
    size_t product = 5;
    CHECK(gi_size_multiply(0, SIZE_MAX, &product) && product == 0);
    CHECK(gi_size_multiply(SIZE_MAX, 0, &product) && product == 0);
    CHECK(gi_size_multiply(SIZE_MAX, 1, &product) && product == SIZE_MAX);
    CHECK(gi_size_multiply(1, SIZE_MAX, &product) && product == SIZE_MAX);
    CHECK(gi_size_multiply(SIZE_MAX / 2, 2, &product) && product == SIZE_MAX - 1);
    CHECK(!gi_size_multiply(SIZE_MAX / 2 + 1, 2, &product));
    CHECK(!gi_size_multiply(2, SIZE_MAX / 2 + 1, &product));
    CHECK(!gi_size_multiply(SIZE_MAX, SIZE_MAX, &product));
    CHECK(product == SIZE_MAX - 1); /* untouched by failures */
}

typedef struct Churn {
    GiMemory *memory;
    _Atomic int wrong;
} Churn;

static void churn(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    Churn *shared = context;
    for (size_t i = begin; i < end; i++) {
        size_t size = 1 + i % 300;
        char *block = gi_memory_allocate(shared->memory, size);
        if (atomic_load(&shared->memory->used) > 2000) atomic_fetch_add(&shared->wrong, 1);
        if (block == NULL) continue; /* the limit: somebody else has it */
        memset(block, 1, size);
        gi_memory_free(shared->memory, block, size);
    }
}

/* A request that will be refused may be counted for a moment, hence the room above. */
static void memory_from_threads(void) {
    GiMemory own, memory;
    gi_memory_init(&own, NULL, 0);
    gi_memory_init(&memory, NULL, 800);
    GiPool *pool;
    CHECK_INT(gi_pool_create(&own, 4, &pool), GLINT_OK);
    Churn shared = {.memory = &memory};
    gi_parallel_for(pool, 100000, 1, churn, &shared);
    gi_pool_destroy(pool);
    CHECK_INT(atomic_load(&shared.wrong), 0);
    CHECK_INT(atomic_load(&memory.used), 0);
    CHECK(atomic_load(&memory.peak) <= 800);
}

/* ---------------------------------------------------------------- arrays and errors */

static void arrays(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 100 * sizeof(int));
    GI_ARRAY(int) numbers = {0};
    int pushed = 0;
    while (gi_array_push(&memory, &numbers, pushed * 3)) pushed++;
    CHECK(pushed >= 32 && pushed <= 100);
    CHECK_INT(numbers.count, pushed);
    for (int i = 0; i < pushed; i++) CHECK_INT(numbers.data[i], i * 3);
    CHECK(!gi_array_reserve(&memory, &numbers, SIZE_MAX));
    CHECK(!gi_array_reserve(&memory, &numbers, SIZE_MAX - (size_t)pushed));
    CHECK(!gi_array_reserve(&memory, &numbers, SIZE_MAX / 4));
    CHECK_INT(numbers.count, pushed);
    CHECK_INT(atomic_load(&memory.used), numbers.capacity * sizeof(int));
    CHECK(gi_array_reserve(&memory, &numbers, numbers.capacity - numbers.count));
    gi_array_free(&memory, &numbers);
    CHECK(numbers.data == NULL && numbers.count == 0 && numbers.capacity == 0);
    CHECK(gi_array_reserve(&memory, &numbers, 100));
    CHECK_INT(numbers.capacity, 100);
    gi_array_free(&memory, &numbers);
    gi_array_free(&memory, &numbers);
    CHECK_INT(atomic_load(&memory.used), 0);
    /* Also where no limit helps. */
    gi_memory_init(&memory, NULL, 0);
    CHECK(gi_array_push(&memory, &numbers, 1));
    CHECK(!gi_array_reserve(&memory, &numbers, SIZE_MAX));
    CHECK(!gi_array_reserve(&memory, &numbers, SIZE_MAX / 2));
    CHECK_INT(numbers.capacity, 8);
    gi_array_free(&memory, &numbers);
}

static void errors(void) {
    GlintError error;
    memset(&error, 'x', sizeof error);
    CHECK_INT(gi_error_set(&error, GLINT_ERROR_FILE, "%s %d", "seven", 7), GLINT_ERROR_FILE);
    CHECK_INT(error.status, GLINT_ERROR_FILE);
    CHECK_INT(error.line, 0);
    CHECK_INT(error.column, 0);
    CHECK_TEXT(error.path, "");
    CHECK_TEXT(error.message, "seven 7");
    char path[1000];
    for (size_t i = 0; i < sizeof path; i++) path[i] = (char)('a' + i % 26);
    path[sizeof path - 1] = '\0';
    gi_error_set_path(&error, GLINT_ERROR_SCENE, path, "%s", path);
    /* Of a path the end stays, of a message the beginning. */
    CHECK_INT(strlen(error.path), sizeof error.path - 1);
    CHECK_TEXT(error.path, path + sizeof path - sizeof error.path);
    CHECK_INT(strlen(error.message), sizeof error.message - 1);
    CHECK(strncmp(error.message, path, sizeof error.message - 1) == 0);
    /* A path that just fits. */
    path[sizeof error.path - 1] = '\0';
    gi_error_set_path(&error, GLINT_ERROR_SCENE, path, "m");
    CHECK_TEXT(error.path, path);
    CHECK_INT(gi_error_set(NULL, GLINT_CANCELLED, "%d", 1), GLINT_CANCELLED);
    CHECK_INT(gi_error_set_path(NULL, GLINT_ERROR_FILE, "p", "%d", 1), GLINT_ERROR_FILE);
    CHECK_INT(gi_error_memory(&error), GLINT_ERROR_MEMORY);
    CHECK_INT(error.status, GLINT_ERROR_MEMORY);
    CHECK_TEXT(error.path, "");
    CHECK_INT(gi_error_memory(NULL), GLINT_ERROR_MEMORY);
}

/* ---------------------------------------------------------------- pool */

typedef struct Cover {
    _Atomic unsigned char *seen;
    size_t count, min_range;
    int worker_count;
    _Atomic int busy[MOST_WORKERS];
    _Atomic int wrong;
} Cover;

static void cover(void *context, size_t begin, size_t end, int worker) {
    Cover *loop = context;
    bool good = begin < end && end <= loop->count && worker >= 0 && worker < loop->worker_count;
    good = good && (end - begin >= loop->min_range || end == loop->count);
    if (!good) {
        atomic_fetch_add(&loop->wrong, 1);
        return;
    }
    /* No two blocks at once with the scratch of one worker. */
    if (atomic_fetch_add(&loop->busy[worker], 1) != 0) atomic_fetch_add(&loop->wrong, 1);
    for (size_t i = begin; i < end; i++) atomic_fetch_add(&loop->seen[i], 1);
    atomic_fetch_sub(&loop->busy[worker], 1);
}

static void pool_covers(void) {
    static const size_t counts[] = {0, 1, 2, 3, 7, 33, 100, 1000, 10007};
    static const size_t ranges[] = {0, 1, 2, 64, 20000};
    static _Atomic unsigned char seen[10007];
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    for (int w = 0; w < WORKER_COUNTS; w++) {
        GiPool *pool;
        CHECK_INT(gi_pool_create(&memory, worker_counts[w], &pool), GLINT_OK);
        CHECK_INT(gi_pool_worker_count(pool), worker_counts[w]);
        for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
            for (size_t r = 0; r < sizeof ranges / sizeof ranges[0]; r++) {
                memset((void *)seen, 0, sizeof seen);
                Cover loop = {.seen = seen, .count = counts[c], .min_range = ranges[r]};
                loop.worker_count = worker_counts[w];
                gi_parallel_for(pool, counts[c], ranges[r], cover, &loop);
                size_t once = 0;
                for (size_t i = 0; i < counts[c]; i++) once += atomic_load(&seen[i]) == 1;
                CHECK_INT(once, counts[c]);
                CHECK_INT(atomic_load(&loop.wrong), 0);
            }
        }
        gi_pool_destroy(pool);
        CHECK_INT(atomic_load(&memory.used), 0);
    }
    gi_pool_destroy(NULL);
}

static void add_range(void *context, size_t begin, size_t end, int worker) {
    (void)worker;
    _Atomic size_t *sum = context;
    for (size_t i = begin; i < end; i++) atomic_fetch_add_explicit(sum, i, memory_order_relaxed);
}

/* Loops that follow one another at once find workers that have not yet left the last one. */
static void pool_many_loops(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    for (int w = 0; w < WORKER_COUNTS; w++) {
        GiPool *pool;
        CHECK_INT(gi_pool_create(&memory, worker_counts[w], &pool), GLINT_OK);
        int loops = 6000 / worker_counts[w];
        for (int i = 0; i < loops; i++) {
            _Atomic size_t sum = 0; /* on the stack: nobody may touch it after the loop */
            size_t count = (size_t)(i % 97);
            gi_parallel_for(pool, count, 1, add_range, &sum);
            size_t expected = count > 0 ? count * (count - 1) / 2 : 0;
            if (atomic_load(&sum) != expected) test_fail(__FILE__, __LINE__, "loop %d", i);
        }
        gi_pool_destroy(pool);
    }
    CHECK_INT(atomic_load(&memory.used), 0);
}

/* Loops in two halves: all is done after the second, whoever did it. */
static void pool_halves(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    for (int w = 0; w < WORKER_COUNTS; w++) {
        GiPool *pool;
        CHECK_INT(gi_pool_create(&memory, worker_counts[w], &pool), GLINT_OK);
        for (int i = 0; i < 2000 / worker_counts[w]; i++) {
            _Atomic size_t sum = 0;
            size_t count = (size_t)(i % 7);
            gi_parallel_begin(pool, count, 1, add_range, &sum);
            if (worker_counts[w] == 1) CHECK_INT(atomic_load(&sum), 0);
            gi_parallel_end(pool);
            size_t expected = count > 0 ? count * (count - 1) / 2 : 0;
            if (atomic_load(&sum) != expected) test_fail(__FILE__, __LINE__, "loop %d", i);
        }
        gi_pool_destroy(pool);
    }
    CHECK_INT(atomic_load(&memory.used), 0);
}

typedef struct Lull {
    GiPool *pool;
    _Atomic bool inside, go;
    bool early, late; /* what worker 0 was told: while the other works, and then */
} Lull;

static void wait_or_work(void *context, size_t begin, size_t end, int worker) {
    (void)begin, (void)end;
    Lull *lull = context;
    if (worker != 0) {
        atomic_store(&lull->inside, true);
        while (!atomic_load(&lull->go)) sched_yield();
        return;
    }
    while (!atomic_load(&lull->inside)) sched_yield();
    lull->early = gi_parallel_wait(lull->pool, 0.002);
    atomic_store(&lull->go, true);
    lull->late = gi_parallel_wait(lull->pool, 60);
}

/* Worker 0 is told whether the others have left. */
static void pool_waits(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    Lull lull = {0};
    CHECK_INT(gi_pool_create(&memory, 2, &lull.pool), GLINT_OK);
    gi_parallel_for(lull.pool, 2, 1, wait_or_work, &lull);
    CHECK(!lull.early);
    CHECK(lull.late);
    CHECK(gi_parallel_wait(lull.pool, 0));
    gi_pool_destroy(lull.pool);
    CHECK_INT(atomic_load(&memory.used), 0);
}

typedef struct Nest {
    GiPool *inner[MOST_WORKERS];
    _Atomic int wrong;
} Nest;

static void run_inner(void *context, size_t begin, size_t end, int worker) {
    Nest *nest = context;
    for (size_t i = begin; i < end; i++) {
        _Atomic size_t sum = 0;
        gi_parallel_for(nest->inner[worker], i, 1, add_range, &sum);
        if (i > 0 && atomic_load(&sum) != i * (i - 1) / 2) atomic_fetch_add(&nest->wrong, 1);
    }
}

/* A loop whose workers have pools of their own. */
static void pool_nested(void) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiPool *outer;
    CHECK_INT(gi_pool_create(&memory, 3, &outer), GLINT_OK);
    Nest nest = {0};
    for (int i = 0; i < 3; i++) {
        CHECK_INT(gi_pool_create(&memory, 1 + i, &nest.inner[i]), GLINT_OK);
    }
    for (int i = 0; i < 20; i++) gi_parallel_for(outer, 60, 1, run_inner, &nest);
    CHECK_INT(atomic_load(&nest.wrong), 0);
    for (int i = 0; i < 3; i++) gi_pool_destroy(nest.inner[i]);
    gi_pool_destroy(outer);
    CHECK_INT(atomic_load(&memory.used), 0);
}

static void pool_of_little_memory(void) {
    for (size_t limit = 1; limit < 2000; limit += 7) {
        GiMemory memory;
        gi_memory_init(&memory, NULL, limit);
        GiPool *pool = NULL;
        GlintStatus status = gi_pool_create(&memory, 4, &pool);
        CHECK(status == GLINT_OK || status == GLINT_ERROR_MEMORY);
        if (status == GLINT_OK) gi_pool_destroy(pool);
        CHECK_INT(atomic_load(&memory.used), 0);
    }
}

/* ---------------------------------------------------------------- tasks */

typedef struct Branch {
    uint32_t depth, path;
    char padding[88]; /* 96 bytes: nearly as large as tasks may be */
} Branch;

typedef struct Forest {
    _Atomic unsigned char seen[1 << 14];
    _Atomic int refused, wrong;
} Forest;

static void grow(GiTasks *tasks, void *context, const void *task, int worker) {
    Forest *forest = context;
    Branch branch;
    memcpy(&branch, task, sizeof branch);
    if (worker < 0 || worker >= MOST_WORKERS || branch.padding[87] != 'p') {
        atomic_fetch_add(&forest->wrong, 1);
    }
    if (branch.depth == 0) {
        atomic_fetch_add(&forest->seen[branch.path], 1);
        return;
    }
    branch.depth--;
    for (uint32_t side = 0; side < 2; side++) {
        Branch next = branch;
        next.path = branch.path << 1 | side;
        if (gi_tasks_add(tasks, &next)) continue;
        atomic_fetch_add(&forest->refused, 1);
        grow(tasks, context, &next, worker);
    }
}

static void run_tasks(int workers, uint32_t depth, size_t limit, bool expect_refusal) {
    static Forest forest;
    GiMemory own, memory;
    gi_memory_init(&own, NULL, 0);
    gi_memory_init(&memory, NULL, limit);
    GiPool *pool;
    CHECK_INT(gi_pool_create(&own, workers, &pool), GLINT_OK);
    memset((void *)&forest, 0, sizeof forest);
    Branch first = {.depth = depth};
    first.padding[87] = 'p';
    CHECK_INT(gi_tasks_run(pool, &memory, &first, sizeof first, grow, &forest), GLINT_OK);
    int once = 0;
    for (int i = 0; i < 1 << depth; i++) once += atomic_load(&forest.seen[i]) == 1;
    CHECK_INT(once, 1 << depth);
    CHECK_INT(atomic_load(&forest.wrong), 0);
    CHECK((atomic_load(&forest.refused) > 0) == expect_refusal);
    gi_pool_destroy(pool);
    CHECK_INT(atomic_load(&memory.used), 0);
}

static void tasks_beget_tasks(void) {
    for (int w = 0; w < WORKER_COUNTS; w++) {
        run_tasks(worker_counts[w], 0, 0, false);
        run_tasks(worker_counts[w], 1, 0, false);
        run_tasks(worker_counts[w], 14, 0, false);
        for (int i = 0; i < 50; i++) run_tasks(worker_counts[w], 3, 0, false);
    }
}

static void tasks_of_little_memory(void) {
    GiMemory own, memory;
    gi_memory_init(&own, NULL, 0);
    gi_memory_init(&memory, NULL, 50);
    GiPool *pool;
    CHECK_INT(gi_pool_create(&own, 3, &pool), GLINT_OK);
    static Forest forest;
    Branch first = {.depth = 3};
    CHECK_INT(gi_tasks_run(pool, &memory, &first, sizeof first, grow, &forest), GLINT_ERROR_MEMORY);
    char large[4096] = {0};
    CHECK_INT(gi_tasks_run(pool, &own, large, sizeof large, grow, &forest), GLINT_ERROR_ARGUMENT);
    gi_pool_destroy(pool);
    CHECK_INT(atomic_load(&memory.used), 0);
    /* Room for a few tasks only: a worker that is refused does the work itself. */
    for (int w = 0; w < WORKER_COUNTS; w++) run_tasks(worker_counts[w], 12, 800, true);
}

/* The check value of CRC-64/XZ; any way of cutting the bytes; both ways of computing it. */
static void digests(void) {
    CHECK(gi_digest(0, "123456789", 9) == UINT64_C(0x995dc9bbdf1939fa));
    static uint8_t bytes[5000];
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = (uint8_t)(i * i >> 3);
    uint64_t whole = gi_digest_plain(0, bytes, sizeof bytes);
    for (size_t cut = 0; cut <= sizeof bytes; cut += 97) {
        uint64_t first = gi_digest(0, bytes, cut);
        CHECK(gi_digest(first, bytes + cut, sizeof bytes - cut) == whole);
    }
}

const GiTest tests_base[] = {TEST(memory_is_counted), TEST(memory_limit), TEST(memory_refused),
    TEST(memory_lines), TEST(sizes), TEST(memory_from_threads), TEST(arrays), TEST(errors),
    TEST(pool_covers), TEST(pool_many_loops), TEST(pool_halves), TEST(pool_waits),
    TEST(pool_nested), TEST(pool_of_little_memory), TEST(tasks_beget_tasks),
    TEST(tasks_of_little_memory), TEST(digests), TEST_END};
