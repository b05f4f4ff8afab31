/* SPDX-License-Identifier: MIT
 * Samples for POV-Ray.
 *
 * Its camera is left-handed by default, but has the handedness of the vectors that it is given:
 * right and up are spelled out here. Colours are linear with assumed_gamma 1 in the scene and
 * File_Gamma=1.0 on the command line. specular with roughness 1 / e is Blinn's highlight with the
 * exponent e.
 *
 * Held against Glint's picture, 1024 x 1024, 8 bits linear: 0.22 of a step apart in the mean, which
 * is the rounding; 10,000 spheres: no pixel by more than 1 step; 10,000 solids: one pixel;
 * a torus of 10,000 triangles: 3,259 pixels by more than 2 steps. */
#include "samples/write.h"

#include <inttypes.h>
#include <math.h>

static void cross(const double a[3], const double b[3], double unit[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        unit[i] = a[j] * b[k] - a[k] * b[j];
    }
    double length = sqrt(unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2]);
    for (int i = 0; i < 3; i++) unit[i] /= length;
}

static void write_scaled(FILE *file, const char *before, const double v[3], double factor) {
    fprintf(file, "%s<%.12g,%.12g,%.12g>", before, v[0] * factor, v[1] * factor, v[2] * factor);
}

static void write_camera(const Sample *sample, FILE *file) {
    GlintCameraDesc camera = sample_camera(sample);
    const double *d = camera.view_direction;
    double right[3], up[3], length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    cross(d, camera.view_up, right);
    cross(right, d, up);
    write_scaled(file, "camera { perspective location ", camera.view_point, 1);
    write_scaled(file, " direction ", d, camera.projection_distance / length);
    write_scaled(file, " right ", right, camera.view_width);
    write_scaled(file, " up ", up, camera.view_height);
    fputs(" }\n", file);
}

static void write_head(const Sample *sample, FILE *file) {
    fputs("#version 3.7;\n"
          "global_settings { assumed_gamma 1.0 max_trace_level 1 }\n"
          "background { color rgb 0 }\n",
        file);
    write_camera(sample, file);
    for (int i = 0; i < sample_light_count(sample); i++) {
        GlintLightDesc light = sample_light(sample, i);
        write_scaled(file, "light_source { ", light.position, 1);
        write_scaled(file, " color rgb ", light.intensity, 1);
        fputs(" }\n", file);
    }
    for (int i = 0; i < sample_shader_count(sample); i++) {
        GlintShaderDesc shader = sample_shader(i);
        fprintf(file, "#declare %s = texture { pigment { color rgb ", sample_shader_name(i));
        write_scaled(file, "", shader.diffuse_color, 1);
        fputs(" } finish { ambient 0 diffuse 1", file);
        if (shader.type == GLINT_SHADER_PHONG) {
            fprintf(file, " specular %.9g roughness %.12g", shader.specular_color[0],
                1 / shader.exponent);
        }
        fputs(" } }\n", file);
    }
}

/* The radius of a cone at height z. The end at the apex must not get below zero by rounding. */
static double cone_radius(const GlintSurfaceDesc *cone, double z) {
    double apex = cone->tip_z - cone->center[2];
    return fmax(0, cone->radius * (cone->tip_z - z) / apex);
}

static void write_surface(const SampleSurface *surface, FILE *file) {
    const GlintSurfaceDesc *desc = &surface->desc;
    const double *c = desc->center;
    double low = c[2] - desc->height / 2, high = c[2] + desc->height / 2;
    switch (desc->type) {
    case GLINT_SURFACE_BOX:
        fprintf(file, "box { <%.9g,%.9g,%.9g>,<%.9g,%.9g,%.9g>", desc->point_a[0], desc->point_a[1],
            desc->point_a[2], desc->point_b[0], desc->point_b[1], desc->point_b[2]);
        break;
    case GLINT_SURFACE_CYLINDER:
        fprintf(file, "cylinder { <%.9g,%.9g,%.9g>,<%.9g,%.9g,%.9g>,%.9g", c[0], c[1], low, c[0],
            c[1], high, desc->radius);
        break;
    case GLINT_SURFACE_CONE:
        fprintf(file, "cone { <%.9g,%.9g,%.9g>,%.12g,<%.9g,%.9g,%.9g>,%.12g", c[0], c[1], low,
            cone_radius(desc, low), c[0], c[1], high, cone_radius(desc, high));
        break;
    default: fprintf(file, "sphere { <%.9g,%.9g,%.9g>,%.9g", c[0], c[1], c[2], desc->radius); break;
    }
    fprintf(file, " texture { %s } }\n", sample_shader_name(surface->shader_index));
}

static void write_vectors(const Sample *sample, bool normals, FILE *file) {
    uint64_t count = sample_vertex_count(sample);
    fprintf(file, "%s_vectors { %" PRIu64, normals ? "normal" : "vertex", count);
    for (uint64_t i = 0; i < count; i++) {
        double position[3], normal[3];
        sample_vertex(sample, i, position, normal);
        const double *p = normals ? normal : position;
        fprintf(file, ",\n<%.9g,%.9g,%.9g>", p[0], p[1], p[2]);
    }
    fputs(" }\n", file);
}

/* Faces without normal indices take those of their vertices. */
static void write_mesh(const Sample *sample, int shader_index, FILE *file) {
    fputs("mesh2 {\n", file);
    write_vectors(sample, false, file);
    write_vectors(sample, true, file);
    uint64_t count = sample_triangle_count(sample);
    fprintf(file, "face_indices { %" PRIu64, count);
    for (uint64_t i = 0; i < count; i++) {
        uint32_t corners[3];
        sample_triangle(sample, i, corners);
        fprintf(
            file, ",\n<%" PRIu32 ",%" PRIu32 ",%" PRIu32 ">", corners[0], corners[1], corners[2]);
    }
    fprintf(file, " }\ntexture { %s } }\n", sample_shader_name(shader_index));
}

void sample_write_povray(const Sample *sample, const char *beside, FILE *file) {
    (void)beside;
    write_head(sample, file);
    uint64_t count = sample_surface_count(sample);
    for (uint64_t i = 0; i < count; i++) {
        SampleSurface surface = sample_surface(sample, i);
        if (surface.desc.type == GLINT_SURFACE_MESH) {
            write_mesh(sample, surface.shader_index, file);
        } else {
            write_surface(&surface, file);
        }
    }
}
