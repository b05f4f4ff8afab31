/* SPDX-License-Identifier: MIT
 * The nameless file is O_TMPFILE's, named by linkat through /proc when it is complete. Where the
 * file system or the machine cannot do that, the file has a temporary name from the beginning.
 * All names are relative to a descriptor of the folder, so a change of the current folder in
 * between does no harm and no path is ever put together. */
#define _GNU_SOURCE /* O_TMPFILE, O_PATH, madvise */
#include "port/file.h"

#include "base/error.h"
#include "port/machine.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef O_PATH
#define FOLDER_FLAGS (O_PATH | O_DIRECTORY | O_CLOEXEC)
#else
#define FOLDER_FLAGS (O_RDONLY | O_DIRECTORY | O_CLOEXEC)
#endif

enum { LINK_LIMIT = 40, NAME_ATTEMPTS = 100 };

static GlintStatus report(const char *verb, const char *path, int code, GlintError *error) {
    /* The path stands beside the message. */
    return gi_error_set_path(
        error, GLINT_ERROR_FILE, path, "cannot %s the file: %s", verb, strerror(code));
}

/* ---------------------------------------------------------------- writing */

/* Opens the folder that path lies in, path being relative to the folder `from`, and copies the
 * last part of path to name. The descriptor, or -1 with errno. */
static int open_folder(int from, const char *path, char *name, size_t size) {
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    const char *last = slash != NULL ? slash + 1 : path;
    size_t folder_length = slash == NULL ? 0 : slash == path ? 1 : (size_t)(slash - path);
    if (*last == '\0') {
        errno = *path == '\0' ? ENOENT : EISDIR;
        return -1;
    }
    if (strlen(last) >= size || folder_length >= sizeof folder) {
        errno = ENAMETOOLONG;
        return -1;
    }
    memcpy(name, last, strlen(last) + 1);
    memcpy(folder, path, folder_length);
    folder[folder_length] = '\0';
    return openat(from, folder_length > 0 ? folder : ".", FOLDER_FLAGS);
}

/* The links of /proc and /dev/fd stand for open files, not for names that a rename could reach. */
static bool stands_for_descriptor(const char *path) {
    return strncmp(path, "/proc/", 6) == 0 || strncmp(path, "/dev/fd/", 8) == 0;
}

/* Finds folder and name of what path leads to, following links, also to what does not exist yet.
 * *direct is set when a link stands for a descriptor. False with errno on failure. */
static bool resolve(GiFileWriter *writer, bool *direct) {
    char link[PATH_MAX];
    const char *path = writer->path;
    int from = AT_FDCWD;
    for (int i = 0; i < LINK_LIMIT; i++) {
        *direct = stands_for_descriptor(path);
        int folder = *direct ? -1 : open_folder(from, path, writer->name, sizeof writer->name);
        int code = errno;
        if (from != AT_FDCWD) close(from);
        errno = code;
        if (folder < 0) return *direct;
        from = folder;
        ssize_t length = readlinkat(folder, writer->name, link, sizeof link - 1);
        if (length < 0) { /* no link, or nothing there: this is the place */
            writer->folder = folder;
            return true;
        }
        link[length] = '\0';
        path = link;
    }
    close(from);
    errno = ELOOP;
    return false;
}

static void make_name(GiFileWriter *writer, int attempt) {
    /* Differs between processes, writers and moments; a clash is noticed and tried again. */
    unsigned long long moment = (unsigned long long)(gi_machine_seconds() * 1e9);
    unsigned long long mix = (moment ^ (unsigned long long)(uintptr_t)writer) + (unsigned)attempt;
    snprintf(writer->temporary, sizeof writer->temporary, ".glint-%ld-%llx", (long)getpid(), mix);
}

static int open_nameless(GiFileWriter *writer) {
#ifdef O_TMPFILE
    if (access("/proc/self/fd", X_OK) == 0) {
        return openat(writer->folder, ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    }
#endif
    (void)writer;
    return -1;
}

static int open_named(GiFileWriter *writer) {
    for (int i = 0; i < NAME_ATTEMPTS; i++) {
        make_name(writer, i);
        int fd = openat(
            writer->folder, writer->temporary, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST) {
            if (fd < 0) writer->temporary[0] = '\0';
            return fd;
        }
    }
    writer->temporary[0] = '\0';
    return -1;
}

/* Gives the nameless file a temporary name. */
static bool link_name(GiFileWriter *writer) {
#ifdef O_TMPFILE
    char from[64];
    snprintf(from, sizeof from, "/proc/self/fd/%d", writer->fd);
    for (int i = 0; i < NAME_ATTEMPTS; i++) {
        make_name(writer, i);
        if (linkat(AT_FDCWD, from, writer->folder, writer->temporary, AT_SYMLINK_FOLLOW) == 0) {
            return true;
        }
        if (errno != EEXIST) break;
    }
#endif
    writer->temporary[0] = '\0';
    return false;
}

/* errno, or 0 when the writer is ready. hidden: only with a nameless file. */
static int begin(GiFileWriter *writer, bool hidden) {
    struct stat old;
    bool exists = stat(writer->path, &old) == 0, direct;
    if (exists && S_ISDIR(old.st_mode)) return EISDIR;
    if (exists && !S_ISREG(old.st_mode)) {
        direct = true;
    } else if (!resolve(writer, &direct)) {
        return errno;
    }
    if (direct) {
        if (hidden) return ENOTSUP;
        /* Appending, as the shell's `>>` into a descriptor would. */
        writer->fd = open(writer->path, O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY);
        return writer->fd < 0 ? errno : 0;
    }
    /* A rename would replace a write-protected file without asking. */
    if (exists && faccessat(writer->folder, writer->name, W_OK, AT_EACCESS) != 0) return errno;
    writer->fd = open_nameless(writer);
    if (writer->fd < 0 && !hidden) writer->fd = open_named(writer);
    if (writer->fd < 0) return errno;
    /* Best effort: some file systems have no permissions. */
    if (exists && fchmod(writer->fd, old.st_mode & 0777) != 0) errno = 0;
    return 0;
}

static void end(GiFileWriter *writer) {
    if (writer->fd >= 0) close(writer->fd);
    if (writer->temporary[0] != '\0') unlinkat(writer->folder, writer->temporary, 0);
    if (writer->folder >= 0) close(writer->folder);
    writer->fd = writer->folder = -1;
    writer->temporary[0] = '\0';
}

GlintStatus gi_file_write_begin(GiFileWriter *writer, const char *path, GlintError *error) {
    *writer = (GiFileWriter){.path = path, .fd = -1, .folder = -1};
    int code = begin(writer, false);
    if (code == 0) return GLINT_OK;
    end(writer);
    return report("write", path, code, error);
}

bool gi_file_write_begin_hidden(GiFileWriter *writer, const char *path) {
    *writer = (GiFileWriter){.path = path, .fd = -1, .folder = -1};
    if (begin(writer, true) == 0) return true;
    end(writer);
    return false;
}

bool gi_file_write(void *user, const void *bytes, size_t size) {
    GiFileWriter *writer = user;
    const char *from = bytes;
    while (size > 0 && writer->error == 0) {
        size_t part = size < (1u << 30) ? size : 1u << 30;
        ssize_t written = write(writer->fd, from, part);
        if (written > 0) {
            from += written;
            size -= (size_t)written;
        } else if (written == 0) {
            writer->error = ENOSPC;
        } else if (errno != EINTR) {
            writer->error = errno;
        }
    }
    return writer->error == 0;
}

bool gi_file_write_at(GiFileWriter *writer, const void *bytes, size_t size, uint64_t offset) {
    const char *from = bytes;
    /* What is written directly is appended to, wherever a write is meant to go. */
    if (writer->folder < 0 && writer->error == 0) writer->error = ESPIPE;
    while (size > 0 && writer->error == 0) {
        size_t part = size < (1u << 30) ? size : 1u << 30;
        ssize_t written = pwrite(writer->fd, from, part, (off_t)offset);
        if (written > 0) {
            from += written;
            offset += (uint64_t)written;
            size -= (size_t)written;
        } else if (written == 0) {
            writer->error = ENOSPC;
        } else if (errno != EINTR) {
            writer->error = errno;
        }
    }
    return writer->error == 0;
}

GlintStatus gi_file_write_commit(GiFileWriter *writer, GlintError *error) {
    int code = writer->error;
    if (code == 0 && writer->folder >= 0 && writer->temporary[0] == '\0' && !link_name(writer)) {
        code = errno;
    }
    /* Network file systems tell of failed writes only now, which is why the rename comes last. */
    if (code == 0) {
        if (close(writer->fd) != 0 && errno != EINTR) code = errno;
        writer->fd = -1;
    }
    if (code == 0 && writer->folder >= 0) {
        if (renameat(writer->folder, writer->temporary, writer->folder, writer->name) == 0) {
            writer->temporary[0] = '\0';
        } else {
            code = errno;
        }
    }
    end(writer);
    return code == 0 ? GLINT_OK : report("write", writer->path, code, error);
}

void gi_file_write_abandon(GiFileWriter *writer) { end(writer); }

/* ---------------------------------------------------------------- reading */

GlintStatus gi_file_read_open(GiFileReader *reader, const char *path, GlintError *error) {
    *reader = (GiFileReader){.path = path, .fd = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY)};
    int code = reader->fd < 0 ? errno : 0;
    struct stat info;
    if (code == 0 && fstat(reader->fd, &info) != 0) code = errno;
    if (code == 0 && S_ISDIR(info.st_mode)) code = EISDIR;
    if (code != 0) {
        gi_file_read_close(reader);
        return report("read", path, code, error);
    }
    reader->size = S_ISREG(info.st_mode) ? (int64_t)info.st_size : -1;
#ifdef POSIX_FADV_SEQUENTIAL
    if (reader->size > 0) posix_fadvise(reader->fd, 0, 0, POSIX_FADV_SEQUENTIAL);
#endif
    return GLINT_OK;
}

static bool is_cancelled(const GlintMonitor *monitor) {
    return monitor != NULL && monitor->cancelled != NULL && monitor->cancelled(monitor->user);
}

int64_t gi_file_read(void *user, void *buffer, size_t size) {
    GiFileReader *reader = user;
    size_t part = size < (1u << 30) ? size : 1u << 30;
    ssize_t count;
    do {
        count = read(reader->fd, buffer, part);
        if (count >= 0) return count;
        if (errno != EINTR) {
            if (reader->error == 0) reader->error = errno;
            return count;
        }
    } while (!is_cancelled(reader->monitor));
    return -1;
}

GlintStatus gi_file_read_status(const GiFileReader *reader, GlintError *error) {
    return reader->error == 0 ? GLINT_OK : report("read", reader->path, reader->error, error);
}

void gi_file_read_close(GiFileReader *reader) {
    if (reader->fd >= 0) close(reader->fd);
    reader->fd = -1;
}

/* ---------------------------------------------------------------- whole files */

static GlintStatus read_all(
    GiFileBytes *file, GiMemory *memory, GiFileReader *reader, GlintError *error) {
    char *bytes = NULL;
    GlintStatus status = GLINT_OK;
    for (;;) {
        if (is_cancelled(reader->monitor)) status = GLINT_CANCELLED;
        size_t wanted = file->capacity;
        if (file->size == wanted) wanted = wanted < 65536 ? 65536 : wanted * 2;
        char *grown = wanted > file->capacity
                          ? gi_memory_resize(memory, bytes, file->capacity, wanted)
                          : bytes;
        if (grown == NULL && status == GLINT_OK) status = gi_error_memory(error);
        if (grown != NULL) {
            bytes = grown;
            file->capacity = wanted;
        }
        if (status != GLINT_OK) break;
        int64_t count = gi_file_read(reader, bytes + file->size, file->capacity - file->size);
        if (count < 0) status = gi_file_read_status(reader, error);
        if (count < 0 && status == GLINT_OK) status = GLINT_CANCELLED;
        if (count <= 0) break;
        file->size += (size_t)count;
    }
    file->bytes = bytes;
    if (status != GLINT_OK) gi_file_bytes_free(file, memory);
    return status;
}

GlintStatus gi_file_bytes_load(GiFileBytes *file, GiMemory *memory, const char *path,
    const GlintMonitor *monitor, GlintError *error) {
    *file = (GiFileBytes){.bytes = NULL};
    GiFileReader reader;
    GlintStatus status = gi_file_read_open(&reader, path, error);
    if (status != GLINT_OK) return status;
    reader.monitor = monitor;
    /* Some files of the system say that they have no bytes, and have. */
    if (reader.size > 0 && (uint64_t)reader.size <= SIZE_MAX) {
        void *mapped = mmap(NULL, (size_t)reader.size, PROT_READ, MAP_PRIVATE, reader.fd, 0);
        if (mapped != MAP_FAILED) {
            file->bytes = mapped;
            file->size = file->mapped = (size_t)reader.size;
        }
    }
    if (file->bytes == NULL) status = read_all(file, memory, &reader, error);
    gi_file_read_close(&reader);
    return status;
}

bool gi_file_bytes_map(GiFileBytes *file, const GiFileReader *reader) {
    *file = (GiFileBytes){.bytes = NULL};
#ifdef MAP_ANONYMOUS
    if (reader->size <= 0 || (uint64_t)reader->size >= SIZE_MAX) return false;
    /* The zero is in a page behind the file, or in its last page, a private copy of it then, so
     * that it stays if the file grows. */
    size_t size = (size_t)reader->size;
    int access = PROT_READ | PROT_WRITE;
    char *bytes = mmap(NULL, size + 1, access, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (bytes == MAP_FAILED) return false;
    if (mmap(bytes, size, access, MAP_PRIVATE | MAP_FIXED, reader->fd, 0) == MAP_FAILED) {
        munmap(bytes, size + 1);
        return false;
    }
    bytes[size] = '\0';
    *file = (GiFileBytes){.bytes = bytes, .size = size, .mapped = size + 1};
    return true;
#else
    (void)reader;
    return false;
#endif
}

void gi_file_bytes_forget(const GiFileBytes *file, size_t begin, size_t end) {
#ifdef MADV_DONTNEED
    if (file->bytes == NULL || file->capacity > 0) return;
    size_t page = (size_t)sysconf(_SC_PAGESIZE);
    begin = (begin + page - 1) / page * page;
    end = end / page * page;
    if (begin < end) madvise((void *)(uintptr_t)(file->bytes + begin), end - begin, MADV_DONTNEED);
#else
    (void)file, (void)begin, (void)end;
#endif
}

void gi_file_bytes_free(GiFileBytes *file, GiMemory *memory) {
    void *bytes = (void *)(uintptr_t)file->bytes;
    if (file->capacity > 0) {
        gi_memory_free(memory, bytes, file->capacity);
    } else if (bytes != NULL) {
        munmap(bytes, file->mapped);
    }
    *file = (GiFileBytes){.bytes = NULL};
}
