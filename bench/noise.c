/* SPDX-License-Identifier: MIT
 * The mean square error of linear values, red, green and blue alike, against a picture of
 * CONVERGED samples. All pictures sample a pixel on a regular grid, so on outlines they differ by
 * the grid, which is no noise: pixels whose neighbours show another surface or another normal are
 * left out, and so are those that show nothing. */
#include "noise.h"

#include "glint/glint.h"
#include "message.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { EDGE = 96, PIXEL_COUNT = EDGE * EDGE, CONVERGED = 4096, SHOWN_EDGE = 160, SHOWN = 16 };
enum { KIND_COUNT = 3, STEP_COUNT = 5 };

static const SampleKind kinds[KIND_COUNT] = {SAMPLE_SHADOW, SAMPLE_SKY, SAMPLE_ROOM};
static const uint64_t steps[STEP_COUNT] = {1, 4, 16, 64, 256};

typedef struct Picture {
    float pixels[SHOWN_EDGE * SHOWN_EDGE * 3];
    float normals[SHOWN_EDGE * SHOWN_EDGE * 3];
    uint32_t surfaces[SHOWN_EDGE * SHOWN_EDGE];
} Picture;

static void draw(const char *cache, SampleKind kind, uint64_t samples, int edge,
    GlintSampling sampling, Picture *picture) {
    BenchScene scene = {.sample = {kind, samples, edge, edge}};
    char path[PATH_SIZE];
    scenes_file(&scene, FORMAT_XML, cache, path);
    GlintScene *drawn = NULL;
    GlintError error = {0};
    GlintSceneDesc desc = glint_scene_desc_default();
    GlintRenderDesc render = glint_render_desc_default();
    render.sampling = sampling;
    render.normal = picture->normals;
    render.surface = picture->surfaces;
    GlintStatus status = glint_scene_create(&desc, &drawn, &error);
    if (status == GLINT_OK) status = glint_scene_load_file(drawn, path, NULL, &error);
    if (status == GLINT_OK) status = glint_scene_commit(drawn, NULL, &error);
    if (status == GLINT_OK) status = glint_render(drawn, &render, picture->pixels, &error);
    if (status != GLINT_OK) message_fail("%s: %s", path, error.message);
    glint_scene_destroy(drawn);
}

static bool is_alike(const Picture *picture, int a, int b) {
    const float *n = &picture->normals[a * 3], *m = &picture->normals[b * 3];
    return picture->surfaces[a] == picture->surfaces[b] &&
           n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.8f;
}

/* Which pixels count. one: of one sample a pixel. */
static void choose_pixels(const Picture *one, bool chosen[PIXEL_COUNT]) {
    for (int y = 0; y < EDGE; y++) {
        for (int x = 0; x < EDGE; x++) {
            int at = y * EDGE + x;
            chosen[at] = x > 0 && y > 0 && x < EDGE - 1 && y < EDGE - 1 && one->surfaces[at] != 0;
            if (!chosen[at]) continue;
            chosen[at] = is_alike(one, at, at - 1) && is_alike(one, at, at + 1) &&
                         is_alike(one, at, at - EDGE) && is_alike(one, at, at + EDGE);
        }
    }
}

static double square_error(const Picture *a, const Picture *b, const bool chosen[PIXEL_COUNT]) {
    double sum = 0, count = 0;
    for (int i = 0; i < PIXEL_COUNT; i++) {
        if (!chosen[i]) continue;
        for (int k = 0; k < 3; k++) {
            double difference = (double)a->pixels[i * 3 + k] - (double)b->pixels[i * 3 + k];
            sum += difference * difference;
        }
        count += 3;
    }
    return count > 0 ? sum / count : 0;
}

static void save_pictures(const char *cache, const char *folder, Picture *picture) {
    static const char *const names[] = {
        [GLINT_SAMPLING_SOBOL] = "sobol", [GLINT_SAMPLING_RANDOM] = "random"};
    for (int sampling = 0; sampling < 2; sampling++) {
        char path[PATH_SIZE];
        GlintError error = {0};
        draw(cache, SAMPLE_SHADOW, SHOWN, SHOWN_EDGE, (GlintSampling)sampling, picture);
        GlintImage image = {SHOWN_EDGE, SHOWN_EDGE, picture->pixels};
        GlintSaveDesc desc = glint_save_desc_default();
        message_format(path, sizeof path, "%s/%s.png", folder, names[sampling]);
        if (glint_image_save(&image, path, &desc, &error) != GLINT_OK) {
            message_fail("%s: %s", path, error.message);
        }
        printf("%s\n", path);
    }
}

void noise_run(const char *cache, const char *results, const char *pictures) {
    Picture *converged = calloc(2, sizeof *converged), *picture = converged + 1;
    if (converged == NULL) message_fail("not enough memory");
    FILE *file = NULL;
    char path[PATH_SIZE];
    if (results != NULL) {
        message_format(path, sizeof path, "%s/noise.csv", results);
        file = fopen(path, "w");
        if (file == NULL) message_fail("%s cannot be written", path);
        fputs("scene,samples,mse_sobol,mse_random\n", file);
    }
    printf("mean square error against %d samples a pixel\n\n", CONVERGED);
    puts("| scene | samples | Sobol | random | random / Sobol |\n| --- | --- | --- | --- | --- |");
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        static bool chosen[PIXEL_COUNT];
        draw(cache, kinds[kind], CONVERGED, EDGE, GLINT_SAMPLING_SOBOL, converged);
        draw(cache, kinds[kind], 1, EDGE, GLINT_SAMPLING_SOBOL, picture);
        choose_pixels(picture, chosen);
        for (int step = 0; step < STEP_COUNT; step++) {
            double errors[2];
            for (int sampling = 0; sampling < 2; sampling++) {
                draw(cache, kinds[kind], steps[step], EDGE, (GlintSampling)sampling, picture);
                errors[sampling] = square_error(picture, converged, chosen);
            }
            double sobol = errors[GLINT_SAMPLING_SOBOL], random = errors[GLINT_SAMPLING_RANDOM];
            const char *name = sample_kind_name(kinds[kind]);
            int samples = (int)steps[step];
            printf("| %s | %d | %.3g | %.3g | %.2f |\n", name, samples, sobol, random,
                sobol > 0 ? random / sobol : 0);
            fflush(stdout);
            if (file != NULL) fprintf(file, "%s,%d,%.6g,%.6g\n", name, samples, sobol, random);
        }
    }
    if (file != NULL && (fclose(file) != 0)) message_fail("%s cannot be written", path);
    if (pictures != NULL) save_pictures(cache, pictures, picture);
    free(converged);
}
