/* SPDX-License-Identifier: MIT
 * Files that are written whole or not at all, and what happens when something goes wrong. */
#define _GNU_SOURCE /* RLIMIT_FSIZE, fork, symlink */
#include "pictures.h"
#include "port/file.h"
#include "test.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    CHECK(file != NULL);
    if (file == NULL) return;
    fputs(text, file);
    fclose(file);
}

static void check_text_file(const char *path, const char *expected) {
    Bytes bytes = read_whole(path);
    collect(&bytes, "", 1);
    CHECK_TEXT((const char *)bytes.data, expected);
    free(bytes.data);
}

static GlintStatus save_text(const char *path, const char *text, GlintError *error) {
    GiFileWriter writer;
    GlintStatus status = gi_file_write_begin(&writer, path, error);
    if (status != GLINT_OK) return status;
    gi_file_write(&writer, text, strlen(text));
    return gi_file_write_commit(&writer, error);
}

static void replaces_whole(void) {
    const char *folder = make_folder("replace");
    char path[600], link[600], dangling[600];
    struct stat info;
    GlintError error;
    GiFileWriter writer;
    snprintf(path, sizeof path, "%s/file", folder);
    snprintf(link, sizeof link, "%s/link", folder);
    snprintf(dangling, sizeof dangling, "%s/dangling", folder);
    mode_t mask = umask(027);
    CHECK_INT(save_text(path, "first", &error), GLINT_OK);
    CHECK(stat(path, &info) == 0 && (info.st_mode & 0777) == 0640);
    umask(mask);
    CHECK_INT(chmod(path, 0604), 0);
    CHECK_INT(gi_file_write_begin(&writer, path, &error), GLINT_OK);
    CHECK(gi_file_write(&writer, "sec", 3) && gi_file_write(&writer, "ond", 3));
    check_text_file(path, "first");
    CHECK_INT(gi_file_write_commit(&writer, &error), GLINT_OK);
    check_text_file(path, "second");
    CHECK(stat(path, &info) == 0 && (info.st_mode & 0777) == 0604);
    CHECK_INT(gi_file_write_begin(&writer, path, &error), GLINT_OK);
    CHECK(gi_file_write(&writer, "third", 5));
    gi_file_write_abandon(&writer);
    check_text_file(path, "second");
    CHECK_INT(count_entries(folder), 1);

    /* Through links: relative, and to what does not exist yet. */
    CHECK(symlink("file", link) == 0 && symlink("new", dangling) == 0);
    CHECK_INT(save_text(link, "linked", &error), GLINT_OK);
    CHECK(lstat(link, &info) == 0 && S_ISLNK(info.st_mode));
    check_text_file(path, "linked");
    CHECK_INT(save_text(dangling, "fresh", &error), GLINT_OK);
    CHECK(lstat(dangling, &info) == 0 && S_ISLNK(info.st_mode));
    check_text_file(dangling, "fresh");
    CHECK_INT(count_entries(folder), 4);
    snprintf(link, sizeof link, "%s/loop", folder);
    CHECK_INT(symlink("loop", link), 0);
    CHECK_INT(save_text(link, "x", &error), GLINT_ERROR_FILE);
    CHECK_INT(count_entries(folder), 5);
}

static void refusals(void) {
    const char *folder = make_folder("refuse");
    char path[600];
    GlintError error;
    CHECK_INT(save_text(folder, "x", &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.message, "cannot write the file: Is a directory");
    CHECK_TEXT(error.path, folder);
    snprintf(path, sizeof path, "%s/none/x", folder);
    CHECK_INT(save_text(path, "x", &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.message, "cannot write the file: No such file or directory");
    CHECK_TEXT(error.path, path);
    CHECK_INT(save_text("", "x", &error), GLINT_ERROR_FILE);
    CHECK_INT(save_text(path, "x", NULL), GLINT_ERROR_FILE);

    GiFileReader reader;
    CHECK_INT(gi_file_read_open(&reader, path, &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.message, "cannot read the file: No such file or directory");
    CHECK_TEXT(error.path, path);
    CHECK_INT(gi_file_read_open(&reader, folder, &error), GLINT_ERROR_FILE);
    CHECK(strstr(error.message, "Is a directory") != NULL);
    CHECK_INT(gi_file_read_open(&reader, "/dev/null", &error), GLINT_OK);
    CHECK_INT(reader.size, -1);
    gi_file_read_close(&reader);
    CHECK_INT(count_entries(folder), 0);

    char *long_path = malloc(10001);
    memset(long_path, 'a', 10000);
    memcpy(long_path, "/tmp/", 5);
    long_path[10000] = '\0';
    CHECK_INT(save_text(long_path, "x", &error), GLINT_ERROR_FILE);
    CHECK(strstr(error.message, "File name too long") != NULL);
    free(long_path);
}

static void without_permission(void) {
    if (geteuid() == 0) {
        test_skip("permissions do not bind the superuser");
        return;
    }
    const char *folder = make_folder("permission");
    char path[600];
    GlintError error;
    snprintf(path, sizeof path, "%s/file", folder);
    write_text(path, "old");
    CHECK_INT(chmod(path, 0444), 0);
    CHECK_INT(save_text(path, "new", &error), GLINT_ERROR_FILE);
    CHECK(strstr(error.message, "Permission denied") != NULL);
    CHECK_INT(chmod(path, 0644), 0);
    CHECK_INT(chmod(folder, 0555), 0);
    CHECK_INT(save_text(path, "new", &error), GLINT_ERROR_FILE);
    CHECK(strstr(error.message, "Permission denied") != NULL);
    CHECK_INT(chmod(folder, 0755), 0);
    check_text_file(path, "old");
    CHECK_INT(count_entries(folder), 1);
}

static void direct(void) {
    GlintError error;
    CHECK_INT(save_text("/dev/null", "x", &error), GLINT_OK);
    struct stat info;
    CHECK(stat("/dev/null", &info) == 0 && S_ISCHR(info.st_mode));
    CHECK_INT(save_text("/dev/full", "x", &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.message, "cannot write the file: No space left on device");
    int ends[2];
    char name[64], got[16] = "";
    CHECK_INT(pipe(ends), 0);
    snprintf(name, sizeof name, "/dev/fd/%d", ends[1]);
    CHECK_INT(save_text(name, "piped", &error), GLINT_OK);
    CHECK_INT(read(ends[0], got, sizeof got), 5);
    CHECK_TEXT(got, "piped");
    close(ends[0]);
    close(ends[1]);
    /* A descriptor of a regular file: what was written before stays. */
    char path[600];
    snprintf(path, sizeof path, "%s/stream", make_folder("direct"));
    FILE *file = fopen(path, "w");
    fputs("before ", file);
    fflush(file);
    snprintf(name, sizeof name, "/proc/self/fd/%d", fileno(file));
    CHECK_INT(save_text(name, "after", &error), GLINT_OK);
    fclose(file);
    check_text_file(path, "before after");
}

/* A full disk, played by a limit on the size of files in a process of its own. */
static void disk_full(void) {
    static const char *const names[] = {"picture.png", "picture.pfm"};
    const char *folder = make_folder("full");
    GlintImage image = make_image(400, 400, 8);
    for (int i = 0; i < 2; i++) {
        char path[600];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        write_text(path, "old");
        pid_t child = fork();
        if (child == 0) {
            struct rlimit limit = {20000, 20000};
            GlintSaveDesc desc = glint_save_desc_default();
            desc.thread_count = 1;
            GlintError error;
            signal(SIGXFSZ, SIG_IGN);
            bool good = setrlimit(RLIMIT_FSIZE, &limit) == 0 &&
                        glint_image_save(&image, path, &desc, &error) == GLINT_ERROR_FILE &&
                        strstr(error.message, "File too large") != NULL &&
                        strstr(error.path, names[i]) != NULL;
            _exit(good ? 0 : 1);
        }
        int result = -1;
        CHECK(child > 0 && waitpid(child, &result, 0) == child && result == 0);
        check_text_file(path, "old");
    }
    CHECK_INT(count_entries(folder), 2);
    free((void *)(uintptr_t)image.pixels);
}

/* Killed in the middle of writing. */
static void killed(void) {
    const char *folder = make_folder("killed");
    char path[600];
    snprintf(path, sizeof path, "%s/file", folder);
    write_text(path, "old");
    pid_t child = fork();
    if (child == 0) {
        GiFileWriter writer;
        if (gi_file_write_begin(&writer, path, NULL) == GLINT_OK) {
            gi_file_write(&writer, "half", 4);
            /* Only where nameless files exist nothing is left; else the test is told so. */
            if (writer.temporary[0] == '\0') raise(SIGKILL);
            gi_file_write_abandon(&writer);
        }
        _exit(1);
    }
    int result = -1;
    CHECK(child > 0 && waitpid(child, &result, 0) == child);
    check_text_file(path, "old");
    CHECK_INT(count_entries(folder), 1);
    if (!WIFSIGNALED(result)) test_skip("this file system has no nameless files");
}

const GiTest tests_file[] = {
    TEST(replaces_whole),
    TEST(refusals),
    TEST(without_permission),
    TEST(direct),
    TEST(disk_full),
    TEST(killed),
    TEST_END,
};
