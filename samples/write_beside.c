/* SPDX-License-Identifier: MIT
 * The files that scenes name: meshes and skies. */
#include "samples/write.h"

#include <inttypes.h>
#include <math.h>

/* As many programs write it: six digits, and every corner names a normal. */
void sample_write_obj(const Sample *sample, FILE *file) {
    uint64_t count = sample_vertex_count(sample);
    double position[3], normal[3];
    for (int pass = 0; pass < 2; pass++) {
        for (uint64_t i = 0; i < count; i++) {
            sample_vertex(sample, i, position, normal);
            const double *p = pass == 0 ? position : normal;
            fprintf(file, "%s %.6f %.6f %.6f\n", pass == 0 ? "v" : "vn", p[0], p[1], p[2]);
        }
    }
    count = sample_triangle_count(sample);
    for (uint64_t i = 0; i < count; i++) {
        uint32_t corners[3];
        sample_triangle(sample, i, corners);
        fputc('f', file);
        for (int k = 0; k < 3; k++)
            fprintf(file, " %" PRIu32 "//%" PRIu32, corners[k] + 1, corners[k] + 1);
        fputc('\n', file);
    }
}

/* ---------------------------------------------------------------- sky */

enum { FACE = 64 };

/* Bluish above, brown below, and a sun of half a degree squared times some. */
static void sky_radiance(const double direction[3], float rgb[3]) {
    static const double sun[3] = {-0.48, -0.64, 0.6};
    double length = sqrt(
        direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    double height = direction[2] / length, toward = 0;
    for (int i = 0; i < 3; i++) toward += direction[i] * sun[i] / length;
    double up = height > 0 ? height : 0;
    rgb[0] = (float)(height > 0 ? 0.5 - 0.35 * up : 0.16);
    rgb[1] = (float)(height > 0 ? 0.55 - 0.25 * up : 0.13);
    rgb[2] = (float)(height > 0 ? 0.6 : 0.1);
    double glow = toward > 0.9985 ? 120 : toward > 0.97 ? 1.5 : 0;
    for (int i = 0; i < 3; i++) rgb[i] += (float)glow;
}

/* Where a place of the cross looks (docs/scene-format.md, cube maps). False: an unused square. */
static bool sky_direction(int column, int row, double direction[3]) {
    static const signed char faces[4][3] = {{0, 6, 0}, {0, 4, 0}, {2, 5, 1}, {0, 3, 0}};
    double u = (column % FACE + 0.5) / FACE * 2 - 1, v = (row % FACE + 0.5) / FACE * 2 - 1;
    const double directions[7][3] = {
        {0, 0, 0}, {1, v, u}, {-1, v, -u}, {u, 1, v}, {u, -1, -v}, {u, v, -1}, {u, -v, 1}};
    int face = faces[row / FACE][column / FACE];
    for (int i = 0; i < 3; i++) direction[i] = directions[face][i];
    return face > 0;
}

void sample_write_sky(FILE *file) {
    fprintf(file, "PF\n%d %d\n-1.0\n", 3 * FACE, 4 * FACE);
    for (int row = 0; row < 4 * FACE; row++) {
        for (int column = 0; column < 3 * FACE; column++) {
            float rgb[3] = {0, 0, 0};
            double direction[3];
            if (sky_direction(column, row, direction)) sky_radiance(direction, rgb);
            for (int i = 0; i < 3; i++) {
                union {
                    float value;
                    uint32_t bits;
                } number = {.value = rgb[i]};
                for (int byte = 0; byte < 4; byte++)
                    fputc((int)(number.bits >> 8 * byte & 0xff), file);
            }
        }
    }
}
