/* SPDX-License-Identifier: MIT
 * A scene may call a file "../meshes/a.obj". So it is put as many folders deep as the names lead
 * upward, and no name leads out of the temporary folder. */
#define _XOPEN_SOURCE 700
#include "unpack.h"

#include "inputs.h"
#include "message.h"

#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool cli_unpack_is_picture(const char *path) {
    /* A pipe must not lose its first bytes. */
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode)) return false;
    FILE *file = fopen(path, "rb");
    if (file == NULL) return false;
    char first[8];
    bool is = fread(first, 1, sizeof first, file) == sizeof first &&
              memcmp(first, "\x89PNG\r\n\x1a\n", sizeof first) == 0;
    fclose(file);
    return is;
}

bool cli_unpack_is_embedded(const GlintRecipe *recipe) {
    return recipe->file_count > 0 && recipe->files[0].bytes != NULL;
}

const char *cli_unpack_bad_name(const GlintRecipe *recipe) {
    for (int i = 1; i < recipe->file_count; i++) {
        if (recipe->files[i].name[0] == '/') return recipe->files[i].name;
    }
    return NULL;
}

/* ---------------------------------------------------------------- places */

static size_t component(const char *name) { return strcspn(name, "/"); }

static bool is_dots(const char *name, size_t length, size_t dots) {
    return length == dots && strncmp(name, "..", dots) == 0;
}

/* How many folders a name leads up, at its highest point. */
static int climb(const char *name) {
    int depth = 0, highest = 0;
    while (*name != '\0') {
        size_t length = component(name);
        if (is_dots(name, length, 2)) {
            depth--;
        } else if (length > 0 && !is_dots(name, length, 1)) {
            depth++;
        }
        if (depth < highest) highest = depth;
        name += length + (name[length] == '/');
    }
    return -highest;
}

/* Appends a name to a path component by component, ".." taking one away, and makes the folders on
 * the way. False with errno: a folder cannot be made, or the path is too long. */
static bool walk(char *path, size_t size, const char *name) {
    for (;;) {
        size_t length = component(name), used = strlen(path);
        bool last = name[length] == '\0';
        if (is_dots(name, length, 2)) {
            *strrchr(path, '/') = '\0';
        } else if (length > 0 && !is_dots(name, length, 1)) {
            if (used + length + 2 > size) {
                errno = ENAMETOOLONG;
                return false;
            }
            path[used] = '/';
            memcpy(path + used + 1, name, length);
            path[used + 1 + length] = '\0';
            if (!last && mkdir(path, 0700) != 0 && errno != EEXIST) return false;
        }
        if (last) return true;
        name += length + 1;
    }
}

static bool write_file(const char *path, const GlintRecipeFile *content) {
    FILE *file = fopen(path, "wb");
    if (file == NULL) return false;
    size_t size = (size_t)content->size;
    bool good = fwrite(content->bytes, 1, size, file) == size;
    return fclose(file) == 0 && good;
}

/* ---------------------------------------------------------------- the whole */

static bool unpack_all(CliUnpacked *unpacked, const GlintRecipe *recipe) {
    char home[4096], path[4096];
    snprintf(home, sizeof home, "%s", unpacked->folder);
    int depth = 0;
    for (int i = 1; i < recipe->file_count; i++) {
        int up = climb(recipe->files[i].name);
        if (up > depth) depth = up;
    }
    for (int i = 0; i < depth; i++) {
        if (!walk(home, sizeof home, "in/")) return false;
    }
    for (int i = 0; i < recipe->file_count; i++) {
        const GlintRecipeFile *file = &recipe->files[i];
        if (file->bytes == NULL) continue;
        snprintf(path, sizeof path, "%s", home);
        const char *name = i == 0 ? cli_path_base(file->name) : file->name;
        if (!walk(path, sizeof path, name[0] != '\0' ? name : "scene.xml")) return false;
        if (!write_file(path, file)) return false;
        if (i > 0) continue;
        unpacked->scene = strdup(path);
        if (unpacked->scene == NULL) return false;
    }
    return true;
}

CliStatus cli_unpack(CliUnpacked *unpacked, const GlintRecipe *recipe, const char *picture) {
    *unpacked = (CliUnpacked){0};
    const char *bad = cli_unpack_bad_name(recipe);
    if (bad != NULL) {
        cli_message_error("%s: the scene inside names '%s', which cannot be unpacked: the name is "
                          "absolute",
            picture, bad);
        return CLI_INPUT;
    }
    const char *folder = getenv("TMPDIR");
    char template[4096];
    snprintf(template, sizeof template, "%s/glint-XXXXXX",
        folder != NULL && folder[0] != '\0' ? folder : "/tmp");
    bool made = mkdtemp(template) != NULL;
    if (made) unpacked->folder = strdup(template);
    if (unpacked->folder != NULL && unpack_all(unpacked, recipe)) return CLI_OK;
    cli_message_error("%s: cannot unpack the scene inside: %s", picture, strerror(errno));
    cli_unpack_remove(unpacked);
    return CLI_MACHINE;
}

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *place) {
    (void)info;
    (void)type;
    (void)place;
    remove(path);
    return 0;
}

void cli_unpack_remove(CliUnpacked *unpacked) {
    if (unpacked->folder != NULL) nftw(unpacked->folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
    free(unpacked->folder);
    free(unpacked->scene);
    *unpacked = (CliUnpacked){0};
}
