/* SPDX-License-Identifier: MIT
 * What a picture can be asked for beside its colours: depth, normals and the rest of what camera
 * rays met, and the light of one source alone. */
#include "test.h"

#include "base/array.h"
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 40, HEIGHT = 30, COUNT = WIDTH * HEIGHT };

typedef struct Outputs {
    float color[3 * COUNT], depth[COUNT], normal[3 * COUNT], albedo[3 * COUNT];
    uint32_t surface[COUNT];
} Outputs;

static GlintRenderDesc desc_of(Outputs *outputs) {
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.depth = outputs->depth;
    desc.normal = outputs->normal;
    desc.albedo = outputs->albedo;
    desc.surface = outputs->surface;
    return desc;
}

/* ---------------------------------------------------------------- what is met */

/* Shapes whose albedo is a tenth of their number, a light among them, and emptiness. */
static GlintScene *shapes_scene(int samples) {
    static char text[4000];
#define SHADER(number)                                                                             \
    "<shader type='Lambertian'><diffuseColor>." #number " 0 0</diffuseColor></shader>"
    snprintf(text, sizeof text,
        "<scene dialect='glint'><camera type='PerspectiveCamera'><viewPoint>0 0 5</viewPoint>"
        "<viewWidth>1</viewWidth><viewHeight>.75</viewHeight></camera><image>8 8</image>"
        "<samples>%d</samples><light type='RectangleLight'><position>-1.5 1.2 0</position>"
        "<normalDir>0 0 1</normalDir></light><surface type='Sphere'><center>-1 -.5 0</center>"
        "<radius>.8</radius>" SHADER(
            1) "</surface><surface type='Group'><rotate>30 40 0</rotate>"
               "<surface type='Box'><minPt>.2 .2 .2</minPt><maxPt>1 1 1</maxPt>" SHADER(
                   2) "</surface></surface><surface type='Group'><translate>1.6 -.8 "
                      "0</translate><scale>"
                      ".7 .5 .6</scale><surface "
                      "type='Mesh'><data>%s/tests/golden/gem.obj</data>" SHADER(
                          3) "</surface></surface><surface type='Disc'><point>1.5 1.2 "
                             "-1</point><radius>.7"
                             "</radius>" SHADER(4) "</surface></scene>",
        samples, test_source_dir());
    return scene_from_text(text, NULL, 2);
}

/* The ray of sample k of n x n. */
static GlintRay camera_ray(int pixel, int k, int n) {
    double a = (pixel % WIDTH + (k % n + 0.5) / n) / WIDTH - 0.5;
    double b = (HEIGHT - 1 - pixel / WIDTH + (k / n + 0.5) / n) / HEIGHT - 0.5;
    GiVec d = gi_normalize(gi_vec(a, 0.75 * b, -1));
    return (GlintRay){{0, 0, 5}, {d.x, d.y, d.z}, 0, INFINITY};
}

static void check_pixel(const GlintScene *scene, const Outputs *outputs, int pixel, int n) {
    double depth = 0, albedo = 0, normal[3] = {0, 0, 0};
    int hits = 0;
    uint32_t first = 0;
    for (int k = 0; k < n * n; k++) {
        GlintRay ray = camera_ray(pixel, k, n);
        GlintHit hit;
        if (!glint_trace(scene, &ray, &hit) || hit.surface.index1 == 0) continue;
        hits++;
        depth += hit.t;
        albedo += 0.1 * hit.surface.index1;
        for (int i = 0; i < 3; i++) normal[i] += hit.normal[i];
        if (k == 0) first = hit.surface.index1;
    }
    CHECK_NEAR((double)outputs->depth[pixel], hits > 0 ? depth / hits : 0, 1e-6);
    CHECK_NEAR((double)outputs->albedo[3 * pixel], albedo / (n * n), 1e-6);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR((double)outputs->normal[3 * pixel + i], normal[i] / (n * n), 1e-6);
    }
    CHECK_INT(outputs->surface[pixel], first);
}

static void what_is_met(void) {
    static Outputs outputs;
    for (int n = 1; n <= 2; n++) {
        GlintScene *scene = shapes_scene(n * n);
        GlintRenderDesc desc = desc_of(&outputs);
        memset(&outputs, 77, sizeof outputs);
        CHECK_INT(glint_render(scene, &desc, outputs.color, NULL), GLINT_OK);
        int counts[5] = {0};
        for (int i = 0; i < COUNT; i++) {
            check_pixel(scene, &outputs, i, n);
            if (outputs.surface[i] <= 4) counts[outputs.surface[i]]++;
        }
        for (int i = 0; i < 5; i++) CHECK(counts[i] > 20);
        /* Asking does not change the picture. */
        desc = glint_render_desc_default();
        desc.width = WIDTH;
        desc.height = HEIGHT;
        Picture picture = picture_of_scene(scene, &desc);
        CHECK(memcmp(picture.pixels, outputs.color, sizeof outputs.color) == 0);
        picture_free(&picture);
        glint_scene_destroy(scene);
    }
}

static void parts_of_outputs(void) {
    static Outputs whole, part;
    GlintScene *scene = shapes_scene(4);
    GlintRenderDesc desc = desc_of(&whole);
    CHECK_INT(glint_render(scene, &desc, whole.color, NULL), GLINT_OK);
    desc = desc_of(&part);
    desc.crop_x = 7, desc.crop_y = 11, desc.crop_width = 20, desc.crop_height = 9;
    CHECK_INT(glint_render(scene, &desc, part.color, NULL), GLINT_OK);
    for (int i = 0; i < 20 * 9; i++) {
        int of = (11 + i / 20) * WIDTH + 7 + i % 20;
        CHECK(memcmp(part.normal + 3 * i, whole.normal + 3 * of, 3 * sizeof(float)) == 0);
        CHECK(memcmp(part.albedo + 3 * i, whole.albedo + 3 * of, 3 * sizeof(float)) == 0);
        CHECK(part.depth[i] == whole.depth[of] && part.surface[i] == whole.surface[of]);
    }
    glint_scene_destroy(scene);
}

/* The light that can be seen is hit, but is no surface of the scene. */
static void lights_are_no_surfaces(void) {
    GlintScene *scene = shapes_scene(1);
    GlintRay ray = {{-1.5, 1.2, 5}, {0, 0, -1}, 0, INFINITY};
    GlintHit hit = {.surface = {99}, .shader = {99}};
    CHECK(glint_trace(scene, &ray, &hit));
    CHECK_NEAR(hit.t, 5, 1e-12);
    CHECK_NEAR(hit.normal[2], 1, 1e-12);
    CHECK(hit.surface.index1 == 0 && hit.shader.index1 == 0);
    glint_scene_destroy(scene);
}

/* ---------------------------------------------------------------- light by light */

/* All kinds of light; mirrors, glass, glazing, facets, and what shines by itself. */
static GlintScene *lights_scene(const char *dialect, const char *integrator, const char *around) {
    static char text[8000], sky[1000];
    snprintf(sky, sizeof sky,
        "<environment type='Cubemap'><filename>%s/tests/golden/sky.pfm</filename></environment>",
        test_source_dir());
    snprintf(text, sizeof text,
        "<scene dialect='%s'><camera type='PerspectiveCamera'><viewPoint>0 1 6</viewPoint>"
        "<viewDir>0 -.7 -6</viewDir></camera><image>8 8</image>%s<samples>4</samples>%s"
        "<light><position>3 4 5</position></light>"
        "<light type='DirectionalLight'><direction>-1 2 1</direction><intensity>.3 .2 .1"
        "</intensity></light><light type='RectangleLight'><position>.5 1.5 -1.5</position>"
        "<normalDir>0 -.3 1</normalDir><intensity>2 3 4</intensity></light>"
        "<light type='AmbientLight'><intensity>.1 .1 .2</intensity></light>"
        "<light type='RectangleLight'><position>-3 2 2</position><normalDir>3 -2 -2</normalDir>"
        "<intensity>5 1 1</intensity></light><light type='NormalLight'/>"
        "<surface type='Sphere'><center>-1.3 0 0</center><radius>.7</radius><shader type='Glass'>"
        "<refractiveIndex>1.5</refractiveIndex></shader></surface>"
        "<surface type='Sphere'><center>0 0 0</center><radius>.6</radius><shader type='Glazed'>"
        "<refractiveIndex>1.5</refractiveIndex><substrate type='MicrofacetGGX'><alpha>.3</alpha>"
        "<nt>2</nt><diffuseColor>.2 .3 .4</diffuseColor></substrate></shader></surface>"
        "<surface type='Sphere'><center>1.3 0 0</center><radius>.6</radius><shader type='Phong'>"
        "<diffuseColor>.5 .2 .2</diffuseColor><exponent>9</exponent><mirrorCoefficient>.3 .3 .4"
        "</mirrorCoefficient></shader></surface>"
        "<surface type='Box'><minPt>.5 -.7 1</minPt><maxPt>.9 -.3 1.4</maxPt>"
        "<shader type='RGBNormals'/></surface>"
        "<surface type='Plane'><point>0 -.7 0</point><normal>0 1 0</normal></surface></scene>",
        dialect, integrator, around != NULL ? around : sky);
    return scene_from_text(text, NULL, 2);
}

static bool draw_light(GlintScene *scene, int light, float *pixels) {
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.light = light;
    return glint_render(scene, &desc, pixels, NULL) == GLINT_OK;
}

/* The parts are the whole, and each has something in it. */
static void check_sum(const char *dialect, const char *integrator, const char *around) {
    enum { LIGHTS = 6 };
    static float whole[3 * COUNT], part[3 * COUNT], sum[3 * COUNT];
    GlintScene *scene = lights_scene(dialect, integrator, around);
    if (scene == NULL || !draw_light(scene, 0, whole)) return;
    memset(sum, 0, sizeof sum);
    for (int light = -1; light <= LIGHTS; light++) {
        if (light == 0) continue;
        CHECK(draw_light(scene, light, part));
        double all = 0;
        for (int i = 0; i < 3 * COUNT; i++) {
            sum[i] += part[i];
            all += (double)part[i];
        }
        CHECK(all > 1);
    }
    int wrong = 0;
    for (int i = 0; i < 3 * COUNT; i++) wrong += !(fabsf(sum[i] - whole[i]) <= 1e-5f * whole[i]);
    if (wrong > 0) {
        test_fail(__FILE__, __LINE__, "%s %s: %d sums are wrong", dialect, integrator, wrong);
    }
    CHECK(!draw_light(scene, LIGHTS + 1, part) && !draw_light(scene, -2, part));
    glint_scene_destroy(scene);
}

static void light_by_light(void) {
    static const char *const dialects[] = {"2012", "2017b", "2018b", "2019", "glint"};
    const char *path = "<integrator type='PathIntegrator'><maxDepth>6</maxDepth></integrator>";
    for (int i = 0; i < 5; i++) {
        check_sum(dialects[i], "", NULL);
        check_sum(dialects[i], "", "<backColor>.3 .4 .5</backColor>");
        check_sum(dialects[i], path, NULL);
        check_sum(dialects[i], path, "<backColor>.3 .4 .5</backColor>");
    }
}

const GiTest tests_outputs[] = {TEST(what_is_met), TEST(parts_of_outputs),
    TEST(lights_are_no_surfaces), TEST(light_by_light), TEST_END};
