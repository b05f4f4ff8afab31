/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* realpath, mkostemp */
#include "watch/save.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool cli_file_read(const char *path, CliBytes *bytes) {
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    char buffer[65536];
    ssize_t size;
    cli_bytes_clear(bytes);
    while ((size = read(file, buffer, sizeof buffer)) != 0) {
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) break;
        cli_bytes_add(bytes, buffer, (size_t)size);
    }
    int reason = bytes->failed ? ENOMEM : errno;
    close(file);
    errno = reason;
    return size == 0 && !bytes->failed;
}

static bool write_all(int file, const CliBytes *bytes) {
    for (size_t at = 0; at < bytes->size;) {
        ssize_t size = write(file, bytes->data + at, bytes->size - at);
        if (size < 0 && errno != EINTR) return false;
        if (size > 0) at += (size_t)size;
    }
    return fsync(file) == 0;
}

/* The permissions of a new file. */
static mode_t usual_mode(void) {
    mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

bool cli_file_replace(const char *path, const CliBytes *bytes, bool fresh) {
    char real[PATH_MAX], temporary[PATH_MAX + 16];
    struct stat info;
    bool exists = stat(path, &info) == 0;
    if (exists && fresh) {
        errno = EEXIST;
        return false;
    }
    if (realpath(path, real) == NULL) snprintf(real, sizeof real, "%s", path);
    snprintf(temporary, sizeof temporary, "%s.XXXXXX", real);
    int file = mkostemp(temporary, O_CLOEXEC);
    if (file < 0) return false;
    bool good = write_all(file, bytes) && fchmod(file, exists ? info.st_mode : usual_mode()) == 0;
    good = close(file) == 0 && good;
    if (good && fresh) {
        good = link(temporary, real) == 0; /* does not replace what has come meanwhile */
        int reason = errno;
        unlink(temporary);
        errno = reason;
        return good;
    }
    if (good && rename(temporary, real) == 0) return true;
    int reason = errno;
    unlink(temporary);
    errno = reason;
    return false;
}

static bool same_bytes(const char *path, const CliBytes *loaded) {
    CliBytes now = {0};
    bool same = cli_file_read(path, &now) && now.size == loaded->size &&
                (now.size == 0 || memcmp(now.data, loaded->data, now.size) == 0);
    cli_bytes_reset(&now);
    return same;
}

/* a.xml, 2: a.camera-2.xml */
static void copy_name(const char *path, int number, char *name, size_t size) {
    size_t length = strlen(path);
    bool xml = length > 4 && strcmp(path + length - 4, ".xml") == 0;
    char suffix[16] = "";
    if (number > 1) snprintf(suffix, sizeof suffix, "-%d", number);
    snprintf(name, size, "%.*s.camera%s.xml", (int)(xml ? length - 4 : length), path, suffix);
}

bool cli_scene_text_save(const char *path, const CliBytes *loaded, const CliBytes *changed,
    char *message, size_t message_size) {
    enum { COPY_LIMIT = 99 };
    if (same_bytes(path, loaded)) {
        bool good = cli_file_replace(path, changed, false);
        if (good) {
            snprintf(message, message_size, "camera written to %s", path);
        } else {
            snprintf(message, message_size, "%s cannot be written: %s", path, strerror(errno));
        }
        return good;
    }
    char copy[PATH_MAX];
    for (int number = 1; number <= COPY_LIMIT; number++) {
        copy_name(path, number, copy, sizeof copy);
        if (cli_file_replace(copy, changed, true)) {
            snprintf(message, message_size,
                "the scene file has changed meanwhile; what is shown was written to %s", copy);
            return true;
        }
        if (errno != EEXIST) break;
    }
    snprintf(message, message_size, "%s cannot be written: %s", copy, strerror(errno));
    return false;
}
