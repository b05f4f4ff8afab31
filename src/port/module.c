/* SPDX-License-Identifier: MIT
 * The loader knows which file a function of ours was loaded from; for the program itself it knows
 * only what the caller said, so that is asked of the system. */
#define _GNU_SOURCE /* dladdr1, realpath */
#include "port/module.h"

#include "base/error.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifdef __GLIBC__
#include <link.h>
#endif

/* The build says where modules are installed: from the folder of the program, and from the root. */
#ifndef GI_MODULE_FOLDER
#define GI_MODULE_FOLDER "../lib/glint"
#endif
#ifndef GI_MODULE_PREFIX
#define GI_MODULE_PREFIX "/usr/local/lib/glint"
#endif

/* Relative to the folder of our own file; the first two in a build, the others installed. */
static const char *const folders[] = {
    "modules", "../modules", "glint", GI_MODULE_FOLDER, "../lib/glint", GI_MODULE_PREFIX};

/* The path that the loader has for our own file; empty for the program. */
static bool loaded_path(char path[PATH_MAX]) {
    static const char here = 0; /* an address in our file */
#ifdef __GLIBC__
    Dl_info info;
    struct link_map *map = NULL;
    if (dladdr1(&here, &info, (void **)&map, RTLD_DL_LINKMAP) == 0 || map == NULL) return false;
    const char *name = map->l_name;
#else
    Dl_info info;
    if (dladdr((void *)(uintptr_t)&here, &info) == 0 || info.dli_fname == NULL) return false;
    const char *name = strstr(info.dli_fname, ".so") != NULL ? info.dli_fname : "";
#endif
    return snprintf(path, PATH_MAX, "%s", name) < PATH_MAX;
}

/* The folder of our own file, with no slash at its end. False when it cannot be found out. */
static bool own_folder(char folder[PATH_MAX]) {
    char path[PATH_MAX];
    if (!loaded_path(path)) return false;
    if (realpath(path[0] != '\0' ? path : "/proc/self/exe", folder) == NULL) return false;
    char *slash = strrchr(folder, '/');
    if (slash == NULL) return false;
    *slash = '\0';
    return true;
}

/* The first place that has the file. */
static bool find(const char *name, char path[PATH_MAX]) {
    char folder[PATH_MAX];
    bool known = own_folder(folder);
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++) {
        bool absolute = folders[i][0] == '/';
        if (!absolute && !known) continue;
        int length = snprintf(path, PATH_MAX, "%s%s%s/glint-%s.so", absolute ? "" : folder,
            absolute ? "" : "/", folders[i], name);
        if (length < PATH_MAX && access(path, R_OK) == 0) return true;
    }
    return false;
}

GlintStatus gi_module_open(GiModule *module, const char *name, const char *symbol,
    const char *purpose, GlintError *error) {
    char path[PATH_MAX];
    *module = (GiModule){0};
    if (!find(name, path)) {
        return gi_error_set(error, GLINT_ERROR_FILE,
            "Glint cannot %s: its module glint-%s.so is missing (docs/architecture.md, modules)",
            purpose, name);
    }
    module->handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (module->handle != NULL) module->interface = dlsym(module->handle, symbol);
    if (module->interface != NULL) return GLINT_OK;
    const char *reason = dlerror();
    GlintStatus status = gi_error_set(error, GLINT_ERROR_FILE, "Glint cannot %s: %s", purpose,
        reason != NULL ? reason : "its module is broken");
    gi_module_close(module);
    return status;
}

void gi_module_close(GiModule *module) {
    if (module->handle != NULL) dlclose(module->handle);
    *module = (GiModule){0};
}
