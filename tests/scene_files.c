/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700
#include "scene_files.h"

#include "test.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool load(SceneFile *file) {
    FILE *stream = fopen(file->path, "rb");
    if (stream == NULL) return false;
    fseek(stream, 0, SEEK_END);
    long size = ftell(stream);
    rewind(stream);
    file->bytes = malloc((size_t)size + 1);
    file->size = fread(file->bytes, 1, (size_t)size, stream);
    file->bytes[file->size] = '\0';
    fclose(stream);
    return file->size == (size_t)size;
}

static int walk(const char *folder, void (*visit)(const SceneFile *file, void *user), void *user) {
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, alphasort), visited = 0;
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        size_t length = strlen(name);
        SceneFile file = {.bytes = NULL};
        snprintf(file.path, sizeof file.path, "%s/%s", folder, name);
        if (length > 4 && strcmp(name + length - 4, ".xml") == 0) {
            CHECK(load(&file));
            visit(&file, user);
            visited++;
        } else if (name[0] != '.') {
            visited += walk(file.path, visit, user);
        }
        free(file.bytes);
        free(entries[i]);
    }
    if (count >= 0) free(entries);
    return visited;
}

int each_scene_file(
    const char *folder, bool shared, void (*visit)(const SceneFile *file, void *user), void *user) {
    char path[1100];
    const char *root = shared ? test_shared_dir() : test_source_dir();
    if (root == NULL) return 0;
    snprintf(path, sizeof path, "%s/%s", root, folder);
    return walk(path, visit, user);
}

Picture small_picture(
    const char *text, size_t size, const char *path, GlintDialect dialect, GlintDialect *in_force) {
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.dialect = dialect;
    desc.thread_count = 1;
    GlintScene *scene = NULL;
    Picture picture = {0};
    if (glint_scene_create(&desc, &scene, NULL) == GLINT_OK &&
        glint_scene_load_memory(scene, text, size, path, NULL, NULL) == GLINT_OK &&
        glint_scene_commit(scene, NULL, NULL) == GLINT_OK) {
        GlintSceneInfo info;
        glint_scene_info(scene, &info);
        if (in_force != NULL) *in_force = info.dialect;
        GlintRenderDesc area = glint_render_desc_default();
        area.width = 32;
        area.height = 24;
        area.samples = 1;
        picture = picture_of_scene(scene, &area);
    }
    glint_scene_destroy(scene);
    return picture;
}

bool collect_text(void *user, const void *bytes, size_t size) {
    Text *text = user;
    char *longer = realloc(text->bytes, text->size + size + 1);
    if (longer == NULL) return false;
    memcpy(longer + text->size, bytes, size);
    text->bytes = longer;
    text->size += size;
    longer[text->size] = '\0';
    return true;
}
