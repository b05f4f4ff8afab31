/* SPDX-License-Identifier: MIT
 * Samples for Tachyon.
 *
 * Its camera is left-handed: the axis to the right is up x direction. A frustum whose left side is
 * greater than its right one turns the picture back. The columns 1 to width are sampled at
 * left + column * step, which is the far edge of each pixel; so the frustum is moved back by half
 * a step to meet the pixels' centres, and the same upward.
 *
 * Held against Glint's picture, 10,000 spheres, 1024 x 1024, 8 bits linear: 0.45 of a step apart in
 * the mean (it rounds down), 2 pixels in a million by more than 2 steps;
 * a torus of 10,000 triangles: none. */
#include "samples/write.h"

static void write_head(const Sample *sample, FILE *file) {
    GlintCameraDesc camera = sample_camera(sample);
    double x = camera.view_width / 2, y = camera.view_height / 2;
    double half_x = x / sample->width, half_y = y / sample->height;
    fprintf(file,
        "BEGIN_SCENE\nRESOLUTION %d %d\nSHADER_MODE FULL END_SHADER_MODE\n"
        "CAMERA\nZOOM 1\nASPECTRATIO 1\nANTIALIASING 0\nRAYDEPTH 1\n",
        sample->width, sample->height);
    const double *p = camera.view_point, *d = camera.view_direction, *u = camera.view_up;
    fprintf(file, "CENTER %.9g %.9g %.9g\nVIEWDIR %.9g %.9g %.9g\nUPDIR %.9g %.9g %.9g\n", p[0],
        p[1], p[2], d[0], d[1], d[2], u[0], u[1], u[2]);
    fprintf(file, "FRUSTUM %.12g %.12g %.12g %.12g\nEND_CAMERA\nBACKGROUND 0 0 0\n", x + half_x,
        -x + half_x, -y - half_y, y - half_y);
    for (int i = 0; i < sample_light_count(sample); i++) {
        GlintLightDesc light = sample_light(sample, i);
        p = light.position;
        d = light.intensity;
        fprintf(file, "LIGHT CENTER %.9g %.9g %.9g RAD 0.001 COLOR %.9g %.9g %.9g\n", p[0], p[1],
            p[2], d[0], d[1], d[2]);
    }
    for (int i = 0; i < sample_shader_count(sample); i++) {
        GlintShaderDesc shader = sample_shader(i);
        d = shader.diffuse_color;
        fprintf(file,
            "TEXDEF %s AMBIENT 0 DIFFUSE 1 SPECULAR 0 OPACITY 1 PHONG PLASTIC %.9g "
            "PHONG_SIZE %.9g COLOR %.9g %.9g %.9g TEXFUNC 0\n",
            sample_shader_name(i), shader.type == GLINT_SHADER_PHONG ? shader.specular_color[0] : 0,
            shader.exponent, d[0], d[1], d[2]);
    }
}

/* The normals of Tachyon's own box are wrong, so a box is twelve triangles. A corner's number has
 * a bit for each axis: set when the coordinate is point_b's. */
static void write_box(const SampleSurface *surface, FILE *file) {
    static const char sides[6][4] = {
        {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const GlintSurfaceDesc *desc = &surface->desc;
    for (int i = 0; i < 12; i++) {
        fputs("TRI", file);
        for (int vertex = 0; vertex < 3; vertex++) {
            int corner = sides[i / 2][vertex == 0 ? 0 : vertex + i % 2];
            fprintf(file, " V%d", vertex);
            for (int axis = 0; axis < 3; axis++) {
                bool high = corner >> axis & 1;
                fprintf(file, " %.9g", high ? desc->point_b[axis] : desc->point_a[axis]);
            }
        }
        fprintf(file, " %s\n", sample_shader_name(surface->shader_index));
    }
}

static void write_mesh(const Sample *sample, int shader_index, FILE *file) {
    uint64_t count = sample_triangle_count(sample);
    for (uint64_t i = 0; i < count; i++) {
        uint32_t corners[3];
        double positions[3][3], normals[3][3];
        sample_triangle(sample, i, corners);
        fputs("STRI", file);
        for (int k = 0; k < 3; k++) sample_vertex(sample, corners[k], positions[k], normals[k]);
        for (int k = 0; k < 6; k++) {
            const double *p = k < 3 ? positions[k] : normals[k - 3];
            fprintf(file, " %c%d %.9g %.9g %.9g", k < 3 ? 'V' : 'N', k % 3, p[0], p[1], p[2]);
        }
        fprintf(file, " %s\n", sample_shader_name(shader_index));
    }
}

void sample_write_tachyon(const Sample *sample, const char *beside, FILE *file) {
    (void)beside;
    write_head(sample, file);
    uint64_t count = sample_surface_count(sample);
    for (uint64_t i = 0; i < count; i++) {
        SampleSurface surface = sample_surface(sample, i);
        if (surface.desc.type == GLINT_SURFACE_MESH) {
            write_mesh(sample, surface.shader_index, file);
        } else if (surface.desc.type == GLINT_SURFACE_BOX) {
            write_box(&surface, file);
        } else {
            const double *p = surface.desc.center;
            fprintf(file, "SPHERE CENTER %.9g %.9g %.9g RAD %.9g %s\n", p[0], p[1], p[2],
                surface.desc.radius, sample_shader_name(surface.shader_index));
        }
    }
    fputs("END_SCENE\n", file);
}
