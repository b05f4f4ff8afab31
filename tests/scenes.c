/* SPDX-License-Identifier: MIT */
#include "scenes.h"

#include "random.h"
#include "test.h"

#include <stdio.h>
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

const char *const small_scene =
    "<scene dialect='glint'><camera><viewPoint>0 0 6</viewPoint></camera><image>70 66</image>\n"
    "<light><position>3 4 5</position></light><light type='AmbientLight'/>\n"
    "<shader name='s' type='Phong'><exponent>5</exponent></shader>\n"
    "<surface type='Sphere'><shader ref='s'/></surface>\n"
    "<surface type='Group'><translate>1 1 0</translate><rotate>1 2 3</rotate>\n"
    "<surface type='Box'><maxPt>1 1 1</maxPt></surface>\n"
    "<surface type='Cone'><tipz>1</tipz></surface></surface></scene>\n";

GlintScene *new_scene(void) {
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.thread_count = 2;
    GlintScene *scene = NULL;
    CHECK_INT(glint_scene_create(&desc, &scene, NULL), GLINT_OK);
    return scene;
}

GlintStatus load_text(GlintScene *scene, const char *xml, GlintError *error) {
    return glint_scene_load_memory(scene, xml, strlen(xml), "x.xml", NULL, error);
}

char *large_text(int count) {
    char *text = malloc((size_t)count * 120 + 500), *to = text;
    if (text == NULL) return NULL;
    to += sprintf(to, "<scene dialect='glint'><camera><viewPoint>0 0 9</viewPoint></camera>"
                      "<image>200 200</image><light><position>5 6 7</position></light>\n");
    Random random = {8};
    for (int i = 0; i < count; i++) {
        GiVec p = random_vec(&random, -4, 4);
        to += sprintf(to,
            "<surface type='Sphere'><center>%.3f %.3f %.3f</center><radius>.05</radius>"
            "</surface>\n",
            p.x, p.y, p.z);
    }
    sprintf(to, "</scene>");
    return text;
}

int64_t read_stream(void *user, void *buffer, size_t size) {
    Stream *stream = user;
    if (stream->at >= stream->fail_at) return -1;
    size_t left = stream->size - stream->at;
    if (size > left) size = left;
    if (stream->step > 0 && size > stream->step) size = stream->step;
    memcpy(buffer, stream->text + stream->at, size);
    stream->at += size;
    return (int64_t)size;
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

void check_color(
    const char *file, int line, const char *what, GiVec actual, double r, double g, double b) {
    double tolerance = 1e-6 * (1 + fabs(r) + fabs(g) + fabs(b));
    if (!(fabs(actual.x - r) <= tolerance && fabs(actual.y - g) <= tolerance &&
            fabs(actual.z - b) <= tolerance)) {
        test_fail(file, line, "%s: (%.9g %.9g %.9g), not (%.9g %.9g %.9g)", what, actual.x,
            actual.y, actual.z, r, g, b);
    }
}

uint64_t hash_bytes(const void *bytes, size_t size) {
    const unsigned char *at = bytes;
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++) hash = (hash ^ at[i]) * 0x100000001b3u;
    return hash;
}
