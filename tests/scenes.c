/* SPDX-License-Identifier: MIT */
#include "scenes.h"

#include "test.h"

#include <stdlib.h>
#include <string.h>

static GlintScene *create(const char *isa, int thread_count) {
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.isa = isa;
    desc.thread_count = thread_count;
    GlintScene *scene = NULL;
    GlintError error = {0};
    if (glint_scene_create(&desc, &scene, &error) != GLINT_OK) {
        test_fail(__FILE__, __LINE__, "create: %s", error.message);
    }
    return scene;
}

static GlintScene *commit(GlintScene *scene, GlintStatus status, GlintError *error) {
    if (status == GLINT_OK) status = glint_scene_commit(scene, NULL, error);
    if (status == GLINT_OK) return scene;
    test_fail(__FILE__, __LINE__, "%s:%d:%d: %s", error->path, error->line, error->column,
        error->message);
    glint_scene_destroy(scene);
    return NULL;
}

GlintScene *scene_from_text(const char *xml, const char *isa, int thread_count) {
    GlintScene *scene = create(isa, thread_count);
    if (scene == NULL) return NULL;
    GlintError error = {0};
    GlintStatus status = glint_scene_load_memory(scene, xml, strlen(xml), "test.xml", NULL, &error);
    return commit(scene, status, &error);
}

GlintScene *scene_from_file(const char *path, const char *isa, int thread_count) {
    GlintScene *scene = create(isa, thread_count);
    if (scene == NULL) return NULL;
    GlintError error = {0};
    GlintStatus status = glint_scene_load_file(scene, path, NULL, &error);
    return commit(scene, status, &error);
}

Picture picture_of_scene(GlintScene *scene, const GlintRenderDesc *desc) {
    Picture picture = {0};
    if (scene == NULL) return picture;
    GlintRenderDesc whole = glint_render_desc_default();
    if (desc == NULL) desc = &whole;
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    int width = desc->width != 0 ? desc->width : info.width;
    int height = desc->height != 0 ? desc->height : info.height;
    picture.width = desc->crop_width != 0 ? desc->crop_width : width - desc->crop_x;
    picture.height = desc->crop_height != 0 ? desc->crop_height : height - desc->crop_y;
    size_t count = (size_t)picture.width * (size_t)picture.height * 3;
    picture.pixels = malloc(count * sizeof *picture.pixels);
    GlintError error = {0};
    if (picture.pixels == NULL) {
        test_fail(__FILE__, __LINE__, "no memory for the picture");
    } else if (glint_render(scene, desc, picture.pixels, &error) != GLINT_OK) {
        test_fail(__FILE__, __LINE__, "render: %s", error.message);
        picture_free(&picture);
    }
    return picture;
}

Picture picture_of_text(const char *xml) {
    GlintScene *scene = scene_from_text(xml, NULL, 1);
    Picture picture = picture_of_scene(scene, NULL);
    glint_scene_destroy(scene);
    return picture;
}

void picture_free(Picture *picture) {
    free(picture->pixels);
    picture->pixels = NULL;
}

GiVec picture_at(const Picture *picture, int x, int y) {
    if (picture->pixels == NULL) return gi_vec(NAN, NAN, NAN);
    const float *pixel = picture->pixels + 3 * ((size_t)y * (size_t)picture->width + (size_t)x);
    return gi_vec(pixel[0], pixel[1], pixel[2]);
}

bool picture_equal(const Picture *a, const Picture *b) {
    if (a->pixels == NULL || b->pixels == NULL) return false;
    if (a->width != b->width || a->height != b->height) return false;
    size_t count = (size_t)a->width * (size_t)a->height * 3;
    return memcmp(a->pixels, b->pixels, count * sizeof *a->pixels) == 0;
}

uint64_t hash_bytes(const void *bytes, size_t size) {
    const unsigned char *at = bytes;
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++) hash = (hash ^ at[i]) * 0x100000001b3u;
    return hash;
}
