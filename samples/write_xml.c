/* SPDX-License-Identifier: MIT
 * Samples in Glint's own format. */
#include "samples/write.h"

static void write_vector(FILE *file, const char *name, const double v[3]) {
    fprintf(file, "<%s>%.9g %.9g %.9g</%s>", name, v[0], v[1], v[2], name);
}

static void write_real(FILE *file, const char *name, double value) {
    fprintf(file, "<%s>%.9g</%s>", name, value, name);
}

static void write_shader(int index, FILE *file) {
    static const char *const types[] = {
        [GLINT_SHADER_LAMBERTIAN] = "Lambertian",
        [GLINT_SHADER_PHONG] = "Phong",
        [GLINT_SHADER_GLAZED] = "Glazed",
        [GLINT_SHADER_GLASS] = "Glass",
    };
    GlintShaderDesc shader = sample_shader(index);
    fprintf(
        file, "<shader name=\"%s\" type=\"%s\">", sample_shader_name(index), types[shader.type]);
    switch (shader.type) {
    case GLINT_SHADER_GLAZED:
        fprintf(
            file, "<substrate ref=\"%s\"/>", sample_shader_name(sample_shader_substrate(index)));
        write_real(file, "refractiveIndex", shader.refractive_index);
        break;
    case GLINT_SHADER_GLASS: write_real(file, "refractiveIndex", shader.refractive_index); break;
    default: write_vector(file, "diffuseColor", shader.diffuse_color); break;
    }
    if (shader.type == GLINT_SHADER_PHONG) {
        write_vector(file, "specularColor", shader.specular_color);
        write_real(file, "exponent", shader.exponent);
    }
    fputs("</shader>\n", file);
}

static void write_head(const Sample *sample, const char *beside, FILE *file) {
    GlintDialect dialect = sample_dialect(sample);
    if (dialect == GLINT_DIALECT_GLINT) {
        fprintf(file, "<scene dialect=\"%s\">\n", glint_dialect_name(dialect));
    } else {
        fputs("<scene>\n", file); /* known by its content */
    }
    GlintCameraDesc camera = sample_camera(sample);
    fputs("<camera>\n", file);
    write_vector(file, "viewPoint", camera.view_point);
    write_vector(file, "viewDir", camera.view_direction);
    write_vector(file, "viewUp", camera.view_up);
    write_vector(file, "projNormal", camera.projection_normal);
    write_real(file, "projDistance", camera.projection_distance);
    write_real(file, "viewWidth", camera.view_width);
    write_real(file, "viewHeight", camera.view_height);
    GlintImageDesc image = sample_image(sample);
    fprintf(file, "\n</camera>\n<image>%d %d</image>\n", image.width, image.height);
    if (image.samples > 1) fprintf(file, "<samples>%d</samples>\n", image.samples);
    if (image.integrator == GLINT_INTEGRATOR_PATH) {
        fputs("<integrator type=\"PathIntegrator\"/>\n", file);
    }
    if (sample_has_sky(sample)) {
        fprintf(
            file, "<environment type=\"Cubemap\"><filename>%s</filename></environment>\n", beside);
    }
    for (int i = 0; i < sample_light_count(sample); i++) {
        GlintLightDesc light = sample_light(sample, i);
        bool rectangle = light.type == GLINT_LIGHT_RECTANGLE;
        fputs(rectangle ? "<light type=\"RectangleLight\">" : "<light>", file);
        write_vector(file, "position", light.position);
        write_vector(file, "intensity", light.intensity);
        if (rectangle) {
            write_vector(file, "normalDir", light.direction);
            write_vector(file, "upDir", light.up);
            write_real(file, "width", light.width);
            write_real(file, "height", light.height);
        }
        fputs("</light>\n", file);
    }
    for (int i = 0; i < sample_shader_count(sample); i++) write_shader(i, file);
}

static void write_surface(const SampleSurface *surface, const char *beside, FILE *file) {
    static const char *const types[] = {
        [GLINT_SURFACE_SPHERE] = "Sphere",
        [GLINT_SURFACE_BOX] = "Box",
        [GLINT_SURFACE_CYLINDER] = "Cylinder",
        [GLINT_SURFACE_CONE] = "Cone",
        [GLINT_SURFACE_MESH] = "Mesh",
    };
    const GlintSurfaceDesc *desc = &surface->desc;
    fprintf(file, "<surface type=\"%s\"><shader ref=\"%s\"/>", types[desc->type],
        sample_shader_name(surface->shader_index));
    if (desc->type == GLINT_SURFACE_MESH) {
        fprintf(file, "<data>%s</data>", beside);
    } else if (desc->type == GLINT_SURFACE_BOX) {
        write_vector(file, "minPt", desc->point_a);
        write_vector(file, "maxPt", desc->point_b);
    } else {
        write_vector(file, "center", desc->center);
        write_real(file, "radius", desc->radius);
        if (desc->type != GLINT_SURFACE_SPHERE) write_real(file, "height", desc->height);
        if (desc->type == GLINT_SURFACE_CONE) write_real(file, "tipz", desc->tip_z);
    }
    fputs("</surface>\n", file);
}

static void write_transform(const SampleGroup *group, FILE *file) {
    write_vector(file, "translate", group->translate);
    write_vector(file, "rotate", group->rotate);
    write_vector(file, "scale", group->scale);
}

void sample_write_xml(const Sample *sample, const char *beside, FILE *file) {
    write_head(sample, beside, file);
    int64_t group_index = -1;
    int64_t copied = sample_copy_count(sample) > 0 ? (int64_t)sample_group_count(sample) - 1 : -1;
    uint64_t count = sample_surface_count(sample);
    for (uint64_t i = 0; i < count; i++) {
        SampleSurface surface = sample_surface(sample, i);
        if (surface.group_index != group_index) {
            if (group_index >= 0) fputs("</surface>\n", file);
            group_index = surface.group_index;
            SampleGroup group = sample_group(sample, (uint64_t)group_index);
            fprintf(
                file, "<surface type=\"Group\"%s>", group_index == copied ? " name=\"tree\"" : "");
            write_transform(&group, file);
            fputs("\n", file);
        }
        write_surface(&surface, beside, file);
    }
    if (group_index >= 0) fputs("</surface>\n", file);
    count = sample_copy_count(sample);
    for (uint64_t i = 0; i < count; i++) {
        SampleGroup copy = sample_copy(sample, i);
        fputs("<surface type=\"Group\">", file);
        write_transform(&copy, file);
        fputs("<surface ref=\"tree\"/></surface>\n", file);
    }
    fputs("</scene>\n", file);
}
