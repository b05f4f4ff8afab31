/* SPDX-License-Identifier: MIT
 * The mesh of a torus that is covered with waves. In u round the axis and v round the tube
 *
 *     x = (R + r cos v) cos u,  y = (R + r cos v) sin u,  z = h + r sin v,  r = r(u, v)
 *
 * and the normal is the cross product of the derivatives, so that a mesh of few triangles is shaded
 * as one of many. */
#include "samples/sample.h"

#include <math.h>

static const double torus_radius = 6.2, tube_radius = 2.0, middle_height = 2.5;
static const double full_turn = 6.28318530717958647692;

static double millionth(double value) { return floor(value * 1e6 + 0.5) / 1e6; }

/* Quads round the tube; three times as many go round the axis. */
static uint64_t quads_round(const Sample *sample) {
    uint64_t triangles = sample->kind == SAMPLE_MIXED ? sample->count / 4 : sample->count;
    uint64_t count = (uint64_t)(sqrt((double)triangles / 6) + 0.5);
    return count > 3 ? count : 3;
}

static bool has_mesh(const Sample *sample) {
    return sample->kind == SAMPLE_TORUS || sample->kind == SAMPLE_MIXED;
}

uint64_t sample_vertex_count(const Sample *sample) {
    return has_mesh(sample) ? 3 * quads_round(sample) * quads_round(sample) : 0;
}

uint64_t sample_triangle_count(const Sample *sample) { return 2 * sample_vertex_count(sample); }

void sample_vertex(const Sample *sample, uint64_t index, double position[3], double normal[3]) {
    static const struct {
        double u, v, height; /* whole waves round the axis and the tube */
    } waves[] = {{9, 2, 0.22}, {23, -7, 0.1}, {71, 19, 0.03}};
    uint64_t round = quads_round(sample);
    double u = full_turn * (double)(index / round) / (double)(3 * round);
    double v = full_turn * (double)(index % round) / (double)round;
    double r = tube_radius, by_u = 0, by_v = 0; /* and its derivatives */
    for (int i = 0; i < 3; i++) {
        double at = waves[i].u * u + waves[i].v * v, slope = waves[i].height * cos(at);
        r += waves[i].height * sin(at);
        by_u += waves[i].u * slope;
        by_v += waves[i].v * slope;
    }
    double cos_u = cos(u), sin_u = sin(u), cos_v = cos(v), sin_v = sin(v);
    double reach = torus_radius + r * cos_v;
    position[0] = millionth(reach * cos_u);
    position[1] = millionth(reach * sin_u);
    position[2] = millionth(middle_height + r * sin_v);
    /* In the plane of u: outward, along u, up. */
    double along_u[3] = {by_u * cos_v, reach, by_u * sin_v};
    double along_v[3] = {by_v * cos_v - r * sin_v, 0, by_v * sin_v + r * cos_v};
    double n[3] = {along_u[1] * along_v[2] - along_u[2] * along_v[1],
        along_u[2] * along_v[0] - along_u[0] * along_v[2],
        along_u[0] * along_v[1] - along_u[1] * along_v[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    normal[0] = millionth((n[0] * cos_u - n[1] * sin_u) / length);
    normal[1] = millionth((n[0] * sin_u + n[1] * cos_u) / length);
    normal[2] = millionth(n[2] / length);
}

void sample_triangle(const Sample *sample, uint64_t index, uint32_t corners[3]) {
    uint64_t round = quads_round(sample), quad = index / 2;
    uint64_t i = quad / round, j = quad % round;
    uint64_t next_i = (i + 1) % (3 * round), next_j = (j + 1) % round;
    corners[0] = (uint32_t)(i * round + j);
    corners[1] = (uint32_t)(index % 2 ? next_i * round + next_j : next_i * round + j);
    corners[2] = (uint32_t)(index % 2 ? i * round + next_j : next_i * round + next_j);
}
