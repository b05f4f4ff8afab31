/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* st_mtim, pipe2, CLOCK_REALTIME_COARSE */
#include "watch/files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum {
    SETTLE_MS = 3,         /* nothing has moved for this long: the save is over */
    LOOKED_SETTLE_MS = 30, /* the same where the system has not said that a file is whole */
    SETTLE_LIMIT = 2000,   /* it has taken longer than anybody waits */
    GRACE_MS = 100,        /* a file that is gone or empty may be about to be written */
    LOOK_MS = 500,         /* between looks where the system tells, in case it does not */
    POLL_MS = 100          /* and where it does not */
};

#define NANOSECONDS 1000000000

typedef struct Entry {
    char *path;
    CliFileMark mark;
    bool had_none; /* it was missing or empty before the save that is under way */
} Entry;

struct CliFileWatch {
    pthread_mutex_t lock; /* of what follows but the descriptors */
    Entry *entries;
    int count;
    int *folders; /* watch descriptors */
    int folder_count;
    int inotify; /* -1: none */
    int wake[2];
};

/* ---------------------------------------------------------------- marks */

CliFileMark cli_file_mark(const char *path) {
    struct stat info;
    if (stat(path, &info) != 0) return (CliFileMark){0};
    return (CliFileMark){.device = (uint64_t)info.st_dev,
        .number = (uint64_t)info.st_ino,
        .size = (int64_t)info.st_size,
        .seconds = (int64_t)info.st_mtim.tv_sec,
        .nanoseconds = (int64_t)info.st_mtim.tv_nsec};
}

bool cli_file_mark_equal(const CliFileMark *a, const CliFileMark *b) {
    return a->device == b->device && a->number == b->number && a->size == b->size &&
           a->seconds == b->seconds && a->nanoseconds == b->nanoseconds;
}

/* In the clock of files, which stands still between ticks. */
int64_t cli_file_watch_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME_COARSE, &now);
    return (int64_t)now.tv_sec * NANOSECONDS + now.tv_nsec;
}

static int64_t milliseconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* ---------------------------------------------------------------- create, destroy */

CliFileWatch *cli_file_watch_create(bool poll_only) {
    CliFileWatch *watch = calloc(1, sizeof *watch);
    if (watch == NULL) return NULL;
    if (pipe2(watch->wake, O_CLOEXEC | O_NONBLOCK) != 0) {
        free(watch);
        return NULL;
    }
    pthread_mutex_init(&watch->lock, NULL);
    watch->inotify = poll_only ? -1 : inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    return watch;
}

static void free_entries(Entry *entries, int count) {
    for (int i = 0; i < count; i++) free(entries[i].path);
    free(entries);
}

void cli_file_watch_destroy(CliFileWatch *watch) {
    if (watch == NULL) return;
    free_entries(watch->entries, watch->count);
    free(watch->folders);
    if (watch->inotify >= 0) close(watch->inotify);
    close(watch->wake[0]);
    close(watch->wake[1]);
    pthread_mutex_destroy(&watch->lock);
    free(watch);
}

/* ---------------------------------------------------------------- what is watched */

static const Entry *find(const CliFileWatch *watch, const char *path) {
    for (int i = 0; i < watch->count; i++) {
        if (strcmp(watch->entries[i].path, path) == 0) return &watch->entries[i];
    }
    return NULL;
}

/* The mark that a file is compared with from now on. */
static CliFileMark first_mark(const CliFileWatch *watch, const char *path, int64_t since) {
    const Entry *known = find(watch, path);
    if (known != NULL) return known->mark;
    CliFileMark mark = cli_file_mark(path);
    /* No file looks like this, so it counts as changed. */
    if (mark.seconds * NANOSECONDS + mark.nanoseconds > since) mark.size = -1;
    return mark;
}

static void add_folder(const CliFileWatch *watch, const char *path, int *folders, int *count) {
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    size_t length = slash == NULL ? 0 : slash == path ? 1 : (size_t)(slash - path);
    if (length >= sizeof folder) return;
    memcpy(folder, path, length);
    folder[length] = '\0';
    int descriptor = inotify_add_watch(watch->inotify, length > 0 ? folder : ".",
        IN_CLOSE_WRITE | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO | IN_ONLYDIR);
    for (int i = 0; i < *count; i++) {
        if (folders[i] == descriptor) return;
    }
    if (descriptor >= 0) folders[(*count)++] = descriptor;
}

/* Asks for messages about the folders of the entries: the one that has the name, and where links
 * lead. */
static void watch_folders(CliFileWatch *watch) {
    if (watch->inotify < 0) return;
    int *folders = malloc((size_t)watch->count * 2 * sizeof *folders), count = 0;
    if (folders == NULL) return; /* the looks remain */
    for (int i = 0; i < watch->count; i++) {
        char real[PATH_MAX];
        const char *path = watch->entries[i].path;
        add_folder(watch, path, folders, &count);
        if (realpath(path, real) != NULL) add_folder(watch, real, folders, &count);
    }
    for (int i = 0; i < watch->folder_count; i++) {
        bool used = false;
        for (int k = 0; k < count; k++) used = used || folders[k] == watch->folders[i];
        if (!used) inotify_rm_watch(watch->inotify, watch->folders[i]);
    }
    free(watch->folders);
    watch->folders = folders;
    watch->folder_count = count;
}

bool cli_file_watch_set(CliFileWatch *watch, const char *const *paths, int count, int64_t since) {
    Entry *entries = calloc((size_t)count + 1, sizeof *entries);
    if (entries == NULL) return false;
    pthread_mutex_lock(&watch->lock);
    bool good = true;
    for (int i = 0; i < count; i++) {
        entries[i].path = strdup(paths[i]);
        good = good && entries[i].path != NULL;
        if (good) entries[i].mark = first_mark(watch, paths[i], since);
    }
    if (good) {
        free_entries(watch->entries, watch->count);
        watch->entries = entries;
        watch->count = count;
        watch_folders(watch);
    }
    pthread_mutex_unlock(&watch->lock);
    if (!good) free_entries(entries, count);
    return good;
}

/* ---------------------------------------------------------------- waiting */

static bool is_watched_name(const CliFileWatch *watch, const char *name) {
    for (int i = 0; i < watch->count; i++) {
        const char *slash = strrchr(watch->entries[i].path, '/');
        if (strcmp(slash != NULL ? slash + 1 : watch->entries[i].path, name) == 0) return true;
    }
    return false;
}

/* Takes the messages that have come. Whether one says that a file of a watched name is written. */
static bool drain(const CliFileWatch *watch) {
    union {
        struct inotify_event event; /* for its alignment */
        char bytes[4096];
    } buffer;
    bool written = false;
    ssize_t size;
    while (watch->inotify >= 0 &&
           (size = read(watch->inotify, buffer.bytes, sizeof buffer.bytes)) > 0) {
        for (ssize_t at = 0; at < size;) {
            struct inotify_event event;
            memcpy(&event, buffer.bytes + at, sizeof event);
            const char *name = buffer.bytes + at + sizeof event;
            bool whole = (event.mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0 && event.len > 0;
            written = written || (whole && is_watched_name(watch, name));
            at += (ssize_t)(sizeof event + event.len);
        }
    }
    return written;
}

/* Whether a file is not as it was, or, with adopt, has become so; what is new is then kept. */
static bool differs(CliFileWatch *watch, bool adopt) {
    bool different = false;
    for (int i = 0; i < watch->count; i++) {
        Entry *entry = &watch->entries[i];
        CliFileMark mark = cli_file_mark(entry->path);
        if (cli_file_mark_equal(&mark, &entry->mark)) continue;
        different = true;
        if (adopt) entry->mark = mark;
    }
    return different;
}

static void remember_gaps(CliFileWatch *watch) {
    for (int i = 0; i < watch->count; i++) {
        watch->entries[i].had_none = watch->entries[i].mark.size <= 0;
    }
}

/* Whether a file has gone or become empty: then it is probably being written. */
static bool has_gap(const CliFileWatch *watch) {
    for (int i = 0; i < watch->count; i++) {
        if (watch->entries[i].mark.size <= 0 && !watch->entries[i].had_none) return true;
    }
    return false;
}

static bool wait_for(const CliFileWatch *watch, int timeout) {
    struct pollfd ends[] = {{watch->wake[0], POLLIN, 0}, {watch->inotify, POLLIN, 0}};
    poll(ends, watch->inotify >= 0 ? 2 : 1, timeout);
    return (ends[0].revents & POLLIN) == 0;
}

/* Waits for the end of a save. told: the system says that a file is whole; a file that only looks
 * another may be under way for longer. */
static void settle(CliFileWatch *watch, bool told) {
    int64_t begin = milliseconds(), moved_at = begin;
    for (bool first = true;; first = false) {
        pthread_mutex_lock(&watch->lock);
        if (first) remember_gaps(watch);
        bool written = drain(watch), moved = differs(watch, true) || written;
        bool gap = has_gap(watch);
        pthread_mutex_unlock(&watch->lock);
        told = told || written;
        int64_t now = milliseconds();
        if (moved) moved_at = now;
        bool quiet = !first && now - moved_at >= (told ? SETTLE_MS : LOOKED_SETTLE_MS);
        if (now - begin >= SETTLE_LIMIT || (quiet && !(gap && now - begin < GRACE_MS))) return;
        struct timespec pause = {0, SETTLE_MS * 1000000};
        nanosleep(&pause, NULL);
    }
}

bool cli_file_watch_wait(CliFileWatch *watch) {
    for (;;) {
        pthread_mutex_lock(&watch->lock);
        bool written = drain(watch);
        bool changed = differs(watch, false) || written;
        pthread_mutex_unlock(&watch->lock);
        if (changed) {
            settle(watch, written);
            return true;
        }
        if (!wait_for(watch, watch->inotify >= 0 ? LOOK_MS : POLL_MS)) break;
    }
    char bytes[64];
    while (read(watch->wake[0], bytes, sizeof bytes) > 0) continue;
    return false;
}

void cli_file_watch_wake(CliFileWatch *watch) {
    /* A pipe that is full wakes as well. */
    while (write(watch->wake[1], "", 1) < 0 && errno == EINTR) continue;
}
