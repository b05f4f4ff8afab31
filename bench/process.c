/* SPDX-License-Identifier: MIT
 * Linux counts the memory of the parent at the moment of the fork as the child's. This program
 * therefore keeps nothing large while it measures others. */
#define _DEFAULT_SOURCE /* wait4 */
#define _POSIX_C_SOURCE 200809L
#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

double process_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double seconds(struct timeval time) {
    return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

static bool spawn(
    char *const arguments[], const char *output_path, const char *error_path, pid_t *process) {
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions) != 0) return false;
    bool good = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0) == 0 &&
                posix_spawn_file_actions_addopen(&actions, 1, output_path, flags, 0666) == 0 &&
                posix_spawn_file_actions_addopen(&actions, 2, error_path, flags, 0666) == 0 &&
                posix_spawn(process, arguments[0], &actions, NULL, arguments, environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    return good;
}

ProcessResult process_run(
    char *const arguments[], const char *output_path, const char *error_path) {
    ProcessResult result = {0};
    pid_t process;
    double start = process_seconds();
    if (!spawn(arguments, output_path, error_path, &process)) return result;
    int status = 0;
    struct rusage usage;
    pid_t ended;
    do {
        ended = wait4(process, &status, 0, &usage);
    } while (ended < 0 && errno == EINTR);
    result.wall_seconds = process_seconds() - start;
    if (ended < 0) return result;
    result.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
#ifdef __APPLE__
    result.peak_size = (uint64_t)usage.ru_maxrss;
#else
    result.peak_size = (uint64_t)usage.ru_maxrss * 1024;
#endif
    result.good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    return result;
}

static bool read_all(int file, char *bytes, size_t size) {
    while (size > 0) {
        ssize_t length = read(file, bytes, size);
        if (length < 0 && errno == EINTR) continue;
        if (length <= 0) return false;
        bytes += length;
        size -= (size_t)length;
    }
    return true;
}

static bool write_all(int file, const char *bytes, size_t size) {
    while (size > 0) {
        ssize_t length = write(file, bytes, size);
        if (length < 0 && errno == EINTR) continue;
        if (length <= 0) return false;
        bytes += length;
        size -= (size_t)length;
    }
    return true;
}

bool process_call(ProcessFn function, const void *context, void *result, size_t size) {
    int ends[2];
    if (pipe(ends) != 0) return false;
    fflush(NULL);
    pid_t process = fork();
    if (process == 0) {
        close(ends[0]);
        function(context, result);
        bool good = write_all(ends[1], result, size);
        fflush(NULL);
        _exit(good ? 0 : 1);
    }
    close(ends[1]);
    bool good = process > 0 && read_all(ends[0], result, size);
    close(ends[0]);
    int status = 0;
    pid_t ended = -1;
    while (process > 0 && (ended = waitpid(process, &status, 0)) < 0 && errno == EINTR) {}
    return good && ended == process && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool process_find(const char *name, char *path, size_t size) {
    const char *folder = getenv("PATH");
    while (folder != NULL && *folder != '\0') {
        size_t length = strcspn(folder, ":");
        int written = snprintf(path, size, "%.*s/%s", (int)length, folder, name);
        if (written > 0 && (size_t)written < size && access(path, X_OK) == 0) return true;
        folder += length + (folder[length] == ':');
    }
    return false;
}
