/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "content.h"

#include "interrupt.h"
#include "message.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CHUNK_SIZE = 1 << 16 };

static bool reserve(CliContent *bytes, size_t more) {
    if (more <= bytes->capacity - bytes->size) return true;
    size_t capacity = bytes->capacity > more ? 2 * bytes->capacity : bytes->capacity + more;
    char *data = realloc(bytes->data, capacity);
    if (data == NULL) return false;
    bytes->data = data;
    bytes->capacity = capacity;
    return true;
}

bool cli_content_append(void *user, const void *more, size_t size) {
    CliContent *bytes = user;
    if (!reserve(bytes, size)) return false;
    if (size > 0) memcpy(bytes->data + bytes->size, more, size);
    bytes->size += size;
    return true;
}

static CliStatus read_all(CliContent *bytes, int fd, const char *name) {
    for (;;) {
        if (!reserve(bytes, CHUNK_SIZE)) {
            cli_message_error("%s", glint_status_text(GLINT_ERROR_MEMORY));
            return CLI_MACHINE;
        }
        ssize_t count = read(fd, bytes->data + bytes->size, CHUNK_SIZE);
        if (count == 0) return CLI_OK;
        if (count > 0) bytes->size += (size_t)count;
        if (cli_interrupt_seen()) return CLI_OK;
        if (count < 0 && errno != EINTR) {
            cli_message_error("cannot read '%s': %s", name, strerror(errno));
            return CLI_INPUT;
        }
    }
}

CliStatus cli_content_load(CliContent *bytes, const CliJob *job) {
    *bytes = (CliContent){0};
    if (cli_job_reads_standard_input(job)) return read_all(bytes, STDIN_FILENO, "stdin");
    int fd = open(job->scene, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        cli_message_error("cannot read '%s': %s", job->scene, strerror(errno));
        return CLI_INPUT;
    }
    CliStatus status = read_all(bytes, fd, job->scene);
    close(fd);
    return status;
}

bool cli_content_equal(const CliContent *a, const CliContent *b) {
    return a->size == b->size && (a->size == 0 || memcmp(a->data, b->data, a->size) == 0);
}

void cli_content_reset(CliContent *bytes) {
    free(bytes->data);
    *bytes = (CliContent){0};
}
