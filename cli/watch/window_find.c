/* SPDX-License-Identifier: MIT
 * Finding the module of windows: beside the program, as it is built and as it is installed, like
 * the library's own modules (docs/architecture.md, modules). */
#define _GNU_SOURCE /* RTLD_LOCAL, readlink */
#include "watch/window.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* The build says where modules are installed: from the folder of the program, and from the root. */
#ifndef GI_MODULE_FOLDER
#define GI_MODULE_FOLDER "../lib/glint"
#endif
#ifndef GI_MODULE_PREFIX
#define GI_MODULE_PREFIX "/usr/local/lib/glint"
#endif

static const char file_name[] = "glint-window.so";

static bool own_folder(char folder[PATH_MAX]) {
    ssize_t size = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    if (size <= 0) return false;
    folder[size] = '\0';
    char *slash = strrchr(folder, '/');
    if (slash == NULL) return false;
    *slash = '\0';
    return true;
}

static bool find(char path[PATH_MAX]) {
    static const char *const folders[] = {"modules", GI_MODULE_FOLDER, GI_MODULE_PREFIX};
    char own[PATH_MAX];
    bool known = own_folder(own);
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++) {
        bool absolute = folders[i][0] == '/';
        if (!absolute && !known) continue;
        int length = snprintf(path, PATH_MAX, "%s%s%s/%s", absolute ? "" : own, absolute ? "" : "/",
            folders[i], file_name);
        if (length < PATH_MAX && access(path, R_OK) == 0) return true;
    }
    return false;
}

const CliWindowModule *cli_window_find_module(char *message, size_t size) {
    char path[PATH_MAX];
    if (!find(path)) {
        snprintf(message, size,
            "a window needs the module %s, which is missing (docs/watch.md, the window)",
            file_name);
        return NULL;
    }
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const CliWindowModule *module = handle != NULL ? dlsym(handle, CLI_WINDOW_SYMBOL) : NULL;
    if (module == NULL) {
        const char *reason = dlerror();
        snprintf(message, size, "%s cannot be loaded: %s", file_name,
            reason != NULL ? reason : "it is broken");
    } else if (module->version != CLI_WINDOW_VERSION) {
        snprintf(message, size, "%s is of another version of Glint", file_name);
        module = NULL;
    }
    return module;
}
