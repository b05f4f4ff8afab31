/* SPDX-License-Identifier: MIT
 * How well a picture fits. */
#include "grade/grade.h"

#include "base/error.h"
#include "math/elementary.h"
#include "math/gamma.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The largest difference of a channel. */
static int apart(const uint8_t *a, const uint8_t *b) {
    int red = abs(a[0] - b[0]), green = abs(a[1] - b[1]), blue = abs(a[2] - b[2]);
    int most = red > green ? red : green;
    return most > blue ? most : blue;
}

double gi_grade_left(const GiGradeTask *task, const uint8_t *mine, const float *pixels,
    const GlintMistakes *mistakes, int tolerance, int step) {
    int64_t sum = 0;
    bool plain = (mistakes->set & GI_MISTAKES_OF_PICTURE) == 0;
    const GlintMistakes none = {0};
    if (plain) mistakes = &none;
    for (int y = step / 2; y < task->height; y += step) {
        for (int x = step / 2; x < task->width; x += step) {
            int from_x = x, from_y = y;
            uint8_t bytes[3];
            gi_mistake_place(mistakes, task->width, task->height, &from_x, &from_y);
            size_t from = (size_t)from_y * (size_t)task->width + (size_t)from_x;
            size_t at = (size_t)y * (size_t)task->width + (size_t)x;
            gi_mistake_bytes(mistakes, pixels + 3 * from, bytes);
            int difference = apart(bytes, mine + 3 * at);
            if (difference > tolerance) sum += difference - tolerance;
        }
    }
    return (double)sum;
}

double gi_grade_left_in(const GiGradeTask *task, const uint8_t *mine, const float *pixels,
    const GiGradeWindow *window, int tolerance) {
    int64_t sum = 0;
    for (int y = 0; y < window->height; y++) {
        size_t row = (size_t)(window->y + y) * (size_t)task->width + (size_t)window->x;
        for (int x = 0; x < window->width; x++, pixels += 3) {
            uint8_t bytes[3];
            gi_gamma_encode(pixels, 3, bytes);
            int difference = apart(bytes, mine + 3 * (row + (size_t)x));
            if (difference > tolerance) sum += difference - tolerance;
        }
    }
    return (double)sum;
}

double gi_grade_factor(
    const GiGradeTask *task, const uint8_t *mine, const float *pixels, int step) {
    enum { DARK = 8, BRIGHT = 247 }; /* beyond, bytes tell little or nothing of the value */
    double linear[256], product = 0, square = 0;
    for (int i = 0; i < 256; i++) linear[i] = gi_pow(i / 255.0, 2.2);
    for (int y = step / 2; y < task->height; y += step) {
        for (int x = step / 2; x < task->width; x += step) {
            size_t at = 3 * ((size_t)y * (size_t)task->width + (size_t)x);
            for (size_t k = at; k < at + 3; k++) {
                double right = (double)pixels[k];
                bool known = mine[k] >= DARK && mine[k] <= BRIGHT;
                if (!known || !(right > 1e-4 && right < 1e4)) continue;
                product += linear[mine[k]] * right;
                square += right * right;
            }
        }
    }
    if (!(square > 0)) return 1;
    double factor = product / square;
    static const double usual[] = {0.31830988618379067, 3.1415926535897931, 0.5, 2, 0.25, 4};
    for (size_t i = 0; i < sizeof usual / sizeof usual[0]; i++) {
        if (fabs(factor / usual[i] - 1) < 0.01) return usual[i];
    }
    return factor;
}

/* ---------------------------------------------------------------- acne */

enum { ACNE_LIGHT_LIMIT = 6 };

/* The smallest difference beyond the tolerance that is left when the light of some of the lights is
 * taken away. *taken: whether any is. */
static int best_subset(const GiGradeTask *task, const uint8_t *mine, const float *const *lights,
    int light_count, size_t pixel, bool *taken) {
    int best = 255;
    *taken = false;
    for (unsigned subset = 0; subset < 1u << light_count && best > task->tolerance; subset++) {
        float color[3];
        uint8_t bytes[3];
        memcpy(color, task->right + 3 * pixel, sizeof color);
        for (int k = 0; k < light_count; k++) {
            if (!(subset >> k & 1)) continue;
            for (int i = 0; i < 3; i++) color[i] -= lights[k][3 * pixel + (size_t)i];
        }
        gi_gamma_encode(color, 3, bytes);
        int difference = apart(bytes, mine + 3 * pixel);
        if (difference >= best) continue;
        best = difference;
        *taken = subset != 0;
    }
    return best > task->tolerance ? best - task->tolerance : 0;
}

/* What is left; *scattered: of the pixels without some light, how many end or begin a run. */
static double weigh_subsets(const GiGradeTask *task, const uint8_t *mine,
    const float *const *lights, int light_count, double *scattered) {
    int64_t left = 0, dark = 0, ends = 0;
    for (int y = 0; y < task->height; y++) {
        bool before = false;
        for (int x = 0; x < task->width; x++) {
            size_t pixel = (size_t)y * (size_t)task->width + (size_t)x;
            bool taken;
            left += best_subset(task, mine, lights, light_count, pixel, &taken);
            dark += taken;
            ends += x > 0 && taken != before;
            before = taken;
        }
    }
    *scattered = dark > 0 ? (double)ends / (double)dark : 0;
    return (double)left;
}

GlintStatus gi_grade_acne(
    const GiGradeTask *task, const uint8_t *mine, double *left, GlintError *error) {
    const double least_scatter = 0.25;
    const float *lights[ACNE_LIGHT_LIMIT];
    int light_count = 0;
    size_t size = (size_t)task->width * (size_t)task->height * 3 * sizeof(float);
    GlintStatus status = GLINT_OK;
    *left = -1;
    for (int k = 0; k < task->light_count && k < GI_GRADE_LIGHT_LIMIT && status == GLINT_OK; k++) {
        if (!task->placed[k]) continue;
        if (light_count == ACNE_LIGHT_LIMIT) goto done; /* too many subsets */
        float *pixels = gi_memory_allocate(task->memory, size);
        if (pixels == NULL) {
            status = gi_error_memory(error);
            break;
        }
        lights[light_count++] = pixels;
        status = task->draw_light(task->user, k + 1, pixels, error);
    }
    if (status == GLINT_OK && light_count > 0) {
        double scattered, weight = weigh_subsets(task, mine, lights, light_count, &scattered);
        if (scattered >= least_scatter) *left = weight;
    }
done:
    for (int k = 0; k < light_count; k++) gi_memory_free(task->memory, (void *)lights[k], size);
    return status;
}
