/* SPDX-License-Identifier: MIT
 * Glint inside of another program: a scene that is a text in memory, mistakes told as a compiler
 * tells them, drawing that may not last longer than the caller wants, and a PNG that never is a
 * file.
 *
 *     cc docs/embed.c -o embed $(pkg-config --cflags --libs glint) && ./embed 5 >embed.png */
#include <glint/glint.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char scene_text[] = "<scene dialect=\"glint\">\n"
                                 "  <image>320 200</image>\n"
                                 "  <camera type=\"PerspectiveCamera\">\n"
                                 "    <viewPoint>0 0 4</viewPoint>\n"
                                 "    <viewWidth>1.6</viewWidth>\n"
                                 "  </camera>\n"
                                 "  <surface type=\"Sphere\"/>\n"
                                 "  <light><position>4 5 6</position></light>\n"
                                 "</scene>\n";

/* All findings come here, errors and warnings, while the scene is loaded. */
static void show_diagnostic(void *user, const GlintDiagnostic *diagnostic) {
    char text[1024];
    glint_diagnostic_format(diagnostic, text, sizeof text);
    fputs(text, user);
}

/* Asked on this thread, many times a second. */
static bool is_late(void *user) {
    const time_t *end = user;
    return time(NULL) >= *end;
}

static bool write_bytes(void *user, const void *bytes, size_t size) {
    return fwrite(bytes, 1, size, user) == size;
}

static GlintStatus draw(GlintScene *scene, const GlintMonitor *monitor, GlintError *error) {
    GlintSceneInfo info;
    GlintStatus status = glint_scene_load_memory(
        scene, scene_text, strlen(scene_text), "embedded.xml", monitor, error);
    if (status == GLINT_OK) status = glint_scene_commit(scene, monitor, error);
    if (status != GLINT_OK) return status;

    /* The pixels are the caller's, linear RGB, and could as well go into a texture or a window. */
    glint_scene_info(scene, &info);
    float *pixels = malloc(sizeof(float) * 3 * (size_t)info.width * (size_t)info.height);
    if (pixels == NULL) {
        snprintf(error->message, sizeof error->message, "no memory for the pixels");
        return GLINT_ERROR_MEMORY;
    }
    GlintRenderDesc render = glint_render_desc_default();
    render.samples = 16;
    render.monitor = monitor;
    status = glint_render(scene, &render, pixels, error);
    if (status == GLINT_OK) {
        GlintImage image = {info.width, info.height, pixels};
        GlintSaveDesc save = glint_save_desc_default();
        status = glint_image_encode_png(&image, &save, write_bytes, stdout, error);
    }
    free(pixels);
    return status;
}

int main(int count, char **arguments) {
    time_t end = time(NULL) + (count > 1 ? atoi(arguments[1]) : 60);
    GlintMonitor monitor = {NULL, is_late, &end};
    GlintError error = {0};
    GlintScene *scene = NULL;
    GlintSceneDesc desc = glint_scene_desc_default();
    desc.thread_count = 1; /* the caller's thread alone */
    desc.memory_limit = 64 << 20;
    desc.diagnostic = show_diagnostic;
    desc.diagnostic_user = stderr;
    GlintStatus status = glint_scene_create(&desc, &scene, &error);
    if (status == GLINT_OK) status = draw(scene, &monitor, &error);
    if (status != GLINT_OK && status != GLINT_ERROR_SCENE) {
        fprintf(stderr, "embed: %s\n", error.message);
    }
    glint_scene_destroy(scene);
    return status == GLINT_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
