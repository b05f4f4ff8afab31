/* SPDX-License-Identifier: MIT */
#include "shadings.h"

#include "math/elementary.h"

static const double pi = 3.1415926535897931;

GiVec shading_direction(Random *random) {
    double z = random_real(random, -1, 1), angle = random_real(random, -pi, pi);
    double r = sqrt(1 - z * z);
    return gi_normalize(gi_vec(r * cos(angle), r * sin(angle), z));
}

GiVec shading_slant(double degrees) {
    double sine, cosine;
    gi_sincos_degrees(degrees, &sine, &cosine);
    return gi_vec(sine, 0, cosine);
}

GiShader shading_random_shader(Random *random, GlintShaderType type) {
    GiShader shader = {.type = type, .texture = GI_NONE, .substrate = GI_NONE};
    shader.diffuse = random_vec(random, 0, 1);
    shader.specular = random_vec(random, 0, 1);
    shader.exponent =
        random_below(random, 2) ? random_below(random, 100) : exp2(random_real(random, -3, 10));
    shader.roughness = exp2(random_real(random, -5, 1));
    shader.index = exp2(random_real(random, -1.5, 2));
    return shader;
}

GiShading shading_of(const GiShader *shader, GlintDialect year, GiVec toward_viewer) {
    return (GiShading){.rules = gi_dialect_rules(year),
        .shader = shader,
        .normal = {0, 0, 1},
        .toward_viewer = toward_viewer,
        .diffuse = shader->diffuse};
}

double shading_integral_part(const GiShading *at, ShadingFunction *function, const double row[2],
    const double column[2], int steps) {
    double sum = 0, height = pi * (row[1] - row[0]) / steps;
    double width = 2 * pi * (column[1] - column[0]) / steps;
    for (int i = 0; i < steps; i++) {
        double theta = pi * row[0] + (i + 0.5) * height;
        /* The exact area of the row: 2 sin(theta) sin(height / 2) times the width. */
        double area = 2 * sin(theta) * sin(height / 2) * width;
        for (int j = 0; j < steps; j++) {
            double phi = 2 * pi * column[0] + (j + 0.5) * width;
            GiVec l = gi_vec(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
            sum += area * function(at, l);
        }
    }
    return sum;
}

double shading_integral(const GiShading *at, ShadingFunction *function, int rows) {
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        double row[2] = {i / 2 * 0.5, i / 2 * 0.5 + 0.5};
        double column[2] = {i % 2 * 0.5, i % 2 * 0.5 + 0.5};
        sum += shading_integral_part(at, function, row, column, rows);
    }
    return sum;
}

double shading_evaluate_red(const GiShading *at, GiVec l) { return gi_bsdf_evaluate(at, l).x; }

double shading_density(const GiShading *at, GiVec l) { return gi_bsdf_density(at, l); }
