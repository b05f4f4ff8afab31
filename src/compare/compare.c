/* SPDX-License-Identifier: MIT
 * The public functions that load and compare pictures. */
#include "compare/compare.h"

#include "base/cookie.h"
#include "base/error.h"
#include "compare/load.h"
#include "math/elementary.h"

#include <math.h>
#include <stdlib.h>

#define ARGUMENT(error, text) gi_error_set((error), GLINT_ERROR_ARGUMENT, "%s", (text))

/* ---------------------------------------------------------------- loading */

GlintStatus glint_image_load(const char *path, GlintImage *image, GlintError *error) {
    if (path == NULL || image == NULL) return ARGUMENT(error, "path or image is null");
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    int width, height;
    float *pixels;
    *image = (GlintImage){0};
    GlintStatus status = gi_compare_load(&memory, path, &width, &height, &pixels, error);
    if (status == GLINT_OK) *image = (GlintImage){width, height, pixels};
    return status;
}

void glint_image_free(GlintImage *image) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    size_t size = (size_t)image->width * (size_t)image->height * 3 * sizeof(float);
    gi_memory_free(&memory, (void *)image->pixels, size);
    *image = (GlintImage){0};
}

/* ---------------------------------------------------------------- comparing */

GlintCompareDesc glint_compare_desc_default(void) {
    return (GlintCompareDesc){
        .tolerance = 2, .pixels_per_degree = 67.02, .flip = true, .cookie = GI_COOKIE};
}

const char *gi_compare_check(const GlintCompareDesc *desc) {
    if (desc == NULL || desc->cookie != GI_COOKIE) {
        return "the compare desc was not made by glint_compare_desc_default";
    }
    if (desc->tolerance < 0 || desc->tolerance > 255) return "the tolerance must be from 0 to 255";
    if (!(desc->pixels_per_degree >= 1 && desc->pixels_per_degree <= 1000)) {
        return "pixels_per_degree must be from 1 to 1000";
    }
    return NULL;
}

static double finite(float value) { return value > -1e30f && value < 1e30f ? (double)value : 0; }

static void add_up(const GlintImage *image, const GlintImage *reference, const uint8_t *a,
    const uint8_t *b, int tolerance, GlintComparison *comparison) {
    size_t pixels = (size_t)image->width * (size_t)image->height, differ = 0;
    uint64_t sum = 0;
    double apart = 0, whole = 0;
    for (size_t i = 0; i < pixels; i++) {
        int most = 0;
        for (size_t k = 3 * i; k < 3 * i + 3; k++) {
            int difference = abs(a[k] - b[k]);
            if (difference > most) most = difference;
            sum += (uint64_t)difference;
            apart += fabs(finite(image->pixels[k]) - finite(reference->pixels[k]));
            whole += finite(reference->pixels[k]);
        }
        if (most > comparison->max) comparison->max = most;
        differ += most > tolerance;
    }
    comparison->mean = (double)sum / (3 * (double)pixels);
    comparison->percent = 100 * (double)differ / (double)pixels;
    double least = 1e-9 * 3 * (double)pixels;
    comparison->relative = apart / (whole > least ? whole : least);
}

static void fill_difference(const uint8_t *a, const uint8_t *b, size_t count, float *difference) {
    float linear[256];
    for (int i = 0; i < 256; i++) linear[i] = (float)gi_pow(i / 255.0, 2.2);
    for (size_t i = 0; i < count; i++) {
        int apart = 8 * abs(a[i] - b[i]);
        difference[i] = linear[apart < 255 ? apart : 255];
    }
}

static GlintStatus compare(const GlintImage *image, const GlintImage *reference,
    const GlintCompareDesc *desc, GlintComparison *comparison, GlintError *error) {
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    size_t pixels = (size_t)image->width * (size_t)image->height;
    bool flip = desc->flip || desc->flip_map != NULL;
    uint8_t *bytes = gi_memory_allocate(&memory, 6 * pixels);
    float *map = desc->flip_map;
    if (flip && map == NULL) map = gi_memory_allocate(&memory, pixels * sizeof *map);
    bool good = bytes != NULL && (!flip || map != NULL);
    if (good) {
        uint8_t *a = bytes, *b = bytes + 3 * pixels;
        glint_image_to_rgb8(image, a);
        glint_image_to_rgb8(reference, b);
        add_up(image, reference, a, b, desc->tolerance, comparison);
        if (desc->difference != NULL) fill_difference(a, b, 3 * pixels, desc->difference);
        if (flip) {
            good =
                gi_flip(&memory, image->width, image->height, b, a, desc->pixels_per_degree, map);
        }
    }
    if (good && flip) {
        double sum = 0;
        for (size_t i = 0; i < pixels; i++) sum += (double)map[i];
        comparison->flip = sum / (double)pixels;
    }
    if (map != desc->flip_map) gi_memory_free(&memory, map, pixels * sizeof *map);
    gi_memory_free(&memory, bytes, 6 * pixels);
    return good ? GLINT_OK : gi_error_memory(error);
}

GlintStatus glint_image_compare(const GlintImage *image, const GlintImage *reference,
    const GlintCompareDesc *desc, GlintComparison *comparison, GlintError *error) {
    const char *fault = gi_compare_check(desc);
    if (fault != NULL) return ARGUMENT(error, fault);
    if (!gi_compare_is_picture(image) || !gi_compare_is_picture(reference) || comparison == NULL) {
        return ARGUMENT(error, "there are no two pictures, or no comparison");
    }
    if (image->width != reference->width || image->height != reference->height) {
        return gi_error_set(error, GLINT_ERROR_ARGUMENT,
            "the sizes differ: %d x %d pixels, and %d x %d of the reference", image->width,
            image->height, reference->width, reference->height);
    }
    *comparison = (GlintComparison){0};
    return compare(image, reference, desc, comparison, error);
}
