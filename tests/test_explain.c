/* SPDX-License-Identifier: MIT
 * Explanations of pixels: they add up, bit for bit, to what glint_render draws; every part of a
 * term is what the term is made of; what blocks a light is what a ray of one's own meets there. */
#include "test.h"

#include "glint/glint.h"
#include "math/vec.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What an explanation is held against, and how much of everything was seen. */
typedef struct Audit {
    GlintScene *scene;
    const Picture *picture;
    const char *name;
    GlintSceneInfo info;
    double sum[3];
    int samples, pixels, faults;
    size_t fates[GLINT_LIGHT_ABSORBED + 1], kinds[GLINT_RAY_PROBE + 1];
    size_t branches[GLINT_BRANCH_NO_TREE + 1];
} Audit;

static bool same(GiVec a, const double b[3]) { return a.x == b[0] && a.y == b[1] && a.z == b[2]; }

static void expect(Audit *audit, bool holds, const GlintExplainSample *s, const char *what) {
    if (holds || audit->faults++ > 3) return;
    test_fail(__FILE__, __LINE__, "%s, pixel %d,%d, sample %d: %s", audit->name, s->x, s->y,
        s->sample, what);
}

/* ---------------------------------------------------------------- a sample */

static void check_additions(Audit *audit, const GlintExplainSample *s) {
    GiVec sum = {0, 0, 0};
    for (size_t i = 0; i < s->addition_count; i++) {
        const GlintExplainAddition *a = &s->additions[i];
        sum = i == 0 ? gi_vec_from(a->amount) : gi_add(sum, gi_vec_from(a->amount));
        expect(audit, same(sum, a->sum), s, "a sum is not that of what was added");
        expect(audit, a->ray < s->ray_count, s, "an addition without a ray");
        if (a->light == GLINT_NONE) continue;
        const GlintExplainLight *light = &s->lights[a->light];
        expect(audit, light->addition == i && light->ray == a->ray, s, "a light's addition");
        GiVec factor = gi_vec_from(s->rays[a->ray].local_factor);
        expect(audit, same(gi_multiply(factor, gi_vec_from(light->term)), a->amount), s,
            "what was added is not factor times term");
    }
    expect(audit, same(sum, s->color), s, "the colour is not the sum");
}

static void check_rays(Audit *audit, const GlintExplainSample *s) {
    expect(audit, s->ray_count > 0 && s->rays[0].kind == GLINT_RAY_CAMERA, s, "the camera's ray");
    for (size_t i = 0; i < s->ray_count; i++) {
        const GlintExplainRay *ray = &s->rays[i];
        audit->kinds[ray->kind]++;
        GlintRay again = {.t_min = ray->t_min, .t_max = INFINITY};
        memcpy(again.origin, ray->origin, sizeof again.origin);
        memcpy(again.direction, ray->direction, sizeof again.direction);
        GlintHit hit = {.t = 0};
        bool met = glint_trace(audit->scene, &again, &hit);
        expect(audit, met == (ray->end != GLINT_RAY_END_NOTHING), s, "what a ray meets");
        if (met) {
            expect(audit,
                hit.t == ray->t && same(gi_vec_from(hit.point), ray->point) &&
                    same(gi_vec_from(hit.normal), ray->normal) &&
                    hit.surface.index1 == ray->surface.index1,
                s, "a ray meets something else");
        }
        if (i == 0) continue;
        expect(audit, ray->parent < i, s, "a parent stands behind its child");
        if (ray->parent >= i) return;
        expect(audit,
            same(gi_vec_from(s->rays[ray->parent].point), ray->origin) &&
                s->rays[ray->parent].level + 1 == ray->level,
            s, "a ray does not begin where its parent ends");
    }
}

static void check_branches(Audit *audit, const GlintExplainSample *s) {
    size_t followed = 0;
    for (size_t i = 0; i < s->branch_count; i++) {
        const GlintExplainBranch *branch = &s->branches[i];
        audit->branches[branch->fate]++;
        expect(audit, (branch->fate == GLINT_BRANCH_FOLLOWED) == (branch->child != GLINT_NONE), s,
            "a branch's child");
        if (branch->child == GLINT_NONE) continue;
        followed++;
        const GlintExplainRay *ray = &s->rays[branch->ray], *child = &s->rays[branch->child];
        expect(audit, child->parent == branch->ray && child->kind == branch->kind, s, "a child");
        if (branch->layer == GLINT_NONE || branch->chance < 1 || branch->survival < 1) continue;
        GiVec factor = gi_multiply(gi_vec_from(ray->factor), gi_vec_from(branch->factor));
        expect(audit, same(factor, child->factor), s, "a branch's factor");
    }
    expect(audit, followed + 1 == s->ray_count, s, "rays that no branch sent");
}

/* The nearest surface between the point and the light, by tracing on from hit to hit. */
static void check_blocker(
    Audit *audit, const GlintExplainSample *s, const GlintExplainLight *light) {
    const GlintExplainRay *at = &s->rays[light->ray];
    GlintRay ray = {.t_min = light->shadow_begin, .t_max = light->shadow_end};
    memcpy(ray.origin, at->point, sizeof ray.origin);
    memcpy(ray.direction, light->direction, sizeof ray.direction);
    GlintHit hit = {.t = 0};
    bool met = glint_trace(audit->scene, &ray, &hit);
    /* Spheres of some years do not shadow themselves. */
    GlintDialect year = audit->info.dialect;
    bool spared =
        year == GLINT_DIALECT_2011 || year == GLINT_DIALECT_2012 || year == GLINT_DIALECT_2013;
    while (met && spared && at->surface_type == GLINT_SURFACE_SPHERE &&
           hit.surface.index1 == at->surface.index1) {
        ray.t_min = hit.t;
        met = glint_trace(audit->scene, &ray, &hit);
    }
    bool blocked = light->fate == GLINT_LIGHT_BLOCKED;
    expect(audit, met == blocked, s, "whether a light is blocked");
    if (!met || !blocked) return;
    expect(audit, hit.surface.index1 == light->blocker.index1, s, "what blocks a light");
    expect(audit, fabs(hit.t - light->blocker_distance) <= 1e-9 * (1 + light->distance), s,
        "how far away a blocker is");
}

static void check_lights(Audit *audit, const GlintExplainSample *s) {
    for (size_t i = 0; i < s->light_count; i++) {
        const GlintExplainLight *light = &s->lights[i];
        audit->fates[light->fate]++;
        if (light->ray >= s->ray_count) {
            expect(audit, false, s, "a light without a ray");
            continue;
        }
        bool arrives = light->fate == GLINT_LIGHT_ARRIVES;
        expect(audit,
            arrives || light->fate == GLINT_LIGHT_EVERYWHERE || light->addition == GLINT_NONE, s,
            "a light adds without arriving");
        if (light->fate == GLINT_LIGHT_EVERYWHERE) continue;
        GiVec reflected = gi_add(gi_vec_from(light->diffuse), gi_vec_from(light->highlight));
        expect(audit, same(reflected, light->reflected), s, "the parts of what is reflected");
        GiVec term = gi_multiply(gi_vec_from(light->strength), reflected);
        if (light->share != 1) term = gi_scale(term, light->share);
        expect(audit, same(term, light->term) || !arrives, s, "the parts of a light's term");
        if (arrives || light->fate == GLINT_LIGHT_BLOCKED) {
            expect(audit, same(term, light->term), s, "the parts of a blocked light's term");
            check_blocker(audit, s, light);
        } else {
            expect(audit, gi_vec_is_zero(term), s, "a light that is dark would add something");
        }
    }
}

/* ---------------------------------------------------------------- a pixel */

static void on_sample(void *user, const GlintExplainSample *s) {
    Audit *audit = user;
    expect(audit, s->sample == audit->samples, s, "the order of samples");
    audit->samples++;
    check_additions(audit, s);
    check_rays(audit, s);
    check_branches(audit, s);
    check_lights(audit, s);
    GiVec sum = s->sample == 0 ? gi_vec_from(s->color)
                               : gi_add(gi_vec_from(audit->sum), gi_vec_from(s->color));
    expect(audit, same(sum, s->sum), s, "the sum of samples");
    memcpy(audit->sum, s->sum, sizeof audit->sum);
}

static void on_pixel(void *user, const GlintExplainPixel *pixel) {
    Audit *audit = user;
    const GlintExplainSample place = {.x = pixel->x, .y = pixel->y};
    expect(audit, audit->samples == pixel->samples, &place, "the number of samples");
    expect(audit, memcmp(audit->sum, pixel->sum, sizeof audit->sum) == 0, &place, "the sum");
    const float *drawn = audit->picture->pixels + 3 * (pixel->y * audit->picture->width + pixel->x);
    expect(audit, memcmp(drawn, pixel->color, sizeof pixel->color) == 0, &place, "the picture");
    for (int i = 0; i < 3; i++) {
        float color = (float)(pixel->sum[i] / pixel->samples * pixel->exposure + 0.0);
        expect(audit, memcmp(&color, &drawn[i], sizeof color) == 0, &place,
            "sum / samples * exposure is not the linear colour");
    }
    const GlintImage one = {1, 1, pixel->color};
    uint8_t rgb[3];
    glint_image_to_rgb8(&one, rgb);
    expect(audit, memcmp(rgb, pixel->rgb, sizeof rgb) == 0, &place, "the 8-bit value");
    audit->samples = 0;
    audit->pixels++;
}

/* Explains every pixel that desc asks for. */
static void audit_scene(
    GlintScene *scene, const char *name, const GlintRenderDesc *desc, Audit *audit) {
    if (scene == NULL) return;
    Picture picture = picture_of_scene(scene, desc);
    audit->scene = scene;
    audit->picture = &picture;
    audit->name = name;
    audit->samples = audit->pixels = audit->faults = 0;
    glint_scene_info(scene, &audit->info);
    const GlintExplainSink sink = {on_sample, on_pixel, audit, 0};
    GlintError error = {.status = GLINT_OK};
    if (picture.pixels != NULL) {
        CHECK_INT(glint_explain(scene, desc, &sink, &error), GLINT_OK);
        CHECK_INT(audit->pixels, picture.width * picture.height);
    }
    picture_free(&picture);
}

static const char *golden_path(const char *name) {
    static char path[4096];
    snprintf(path, sizeof path, "%s/tests/golden/%s.xml", test_source_dir(), name);
    return path;
}

static void audit_file(const char *path, int width, int height, Audit *audit) {
    GlintScene *scene = scene_from_file(path, NULL, 2);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = width, desc.height = height;
    audit_scene(scene, path, &desc, audit);
    glint_scene_destroy(scene);
}

static void adds_up(void) {
    static const char *const goldens[] = {
        "spheres-2011",
        "solids-2012",
        "groups-2012",
        "lights-material",
        "constant-material",
        "oblique-2013",
        "parallel-2013",
        "exposure-2017",
        "groups-2017b",
        "lambert-2018",
        "phong-2019",
        "horizon-glint",
        "glass-2012",
        "light-2017b",
        "facets-2018b",
        "paths-glint",
#ifdef GI_BUILT_PNG
        "mirrors-2019",
#endif
    };
    Audit audit = {.scene = NULL};
    for (size_t i = 0; i < sizeof goldens / sizeof goldens[0]; i++) {
        bool slow = test_slowness() > 1;
        audit_file(golden_path(goldens[i]), slow ? 20 : 0, slow ? 15 : 0, &audit);
    }
    /* Else the test would not have seen what it is about. */
    for (int i = 0; i <= GLINT_RAY_PROBE; i++) CHECK(audit.kinds[i] > 0);
    for (int i = 0; i <= GLINT_LIGHT_TURNED_AWAY; i++) CHECK(audit.fates[i] > 0 || i == 5);
    CHECK(audit.branches[GLINT_BRANCH_TOO_LIGHT] > 0 && audit.branches[GLINT_BRANCH_TOO_DEEP] > 0);
    CHECK(audit.branches[GLINT_BRANCH_NOT_CHOSEN] > 0);
}

static void gallery(void) {
    static const char *const scenes[] = {"solids", "lights", "cornell-box", "glass", "oblique",
        "roughness", "room", "spiral", "tree"};
    Audit audit = {.scene = NULL};
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/scenes/%s.xml", test_source_dir(), scenes[i]);
        audit_file(path, 12, 9, &audit);
    }
}

/* What a desc can say beside the size. */
static void descs(void) {
    Audit audit = {.scene = NULL};
    GlintScene *scene = scene_from_file(golden_path("light-2017b"), NULL, 1);
    GlintSceneInfo info;
    glint_scene_info(scene, &info);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = 24, desc.height = 18;
    for (desc.light = -1; desc.light <= (int)info.light_count; desc.light++) {
        audit_scene(scene, "one light alone", &desc, &audit);
    }
    desc.light = 0;
    desc.samples = 9;
    desc.sampling = GLINT_SAMPLING_RANDOM;
    audit_scene(scene, "random samples", &desc, &audit);
    GlintCameraDesc camera;
    CHECK(glint_scene_camera(scene, &camera));
    camera.view_point[0] += 0.5;
    desc.camera = &camera;
    audit_scene(scene, "another camera", &desc, &audit);
    glint_scene_destroy(scene);
}

typedef struct Colors {
    int count, sample;
    double color[16][3];
    size_t additions[16];
} Colors;

static void keep_color(void *user, const GlintExplainSample *sample) {
    Colors *colors = user;
    colors->sample = sample->sample;
    memcpy(colors->color[colors->count], sample->color, sizeof sample->color);
    colors->additions[colors->count++] = sample->addition_count;
}

static void only_one_sample(void) {
    GlintScene *scene = scene_from_file(golden_path("paths-glint"), NULL, 1);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.samples = 4;
    desc.crop_x = 20, desc.crop_y = 30, desc.crop_width = desc.crop_height = 1;
    Colors all = {0};
    GlintExplainSink sink = {.sample = keep_color, .user = &all};
    CHECK_INT(glint_explain(scene, &desc, &sink, NULL), GLINT_OK);
    CHECK_INT(all.count, 4);
    for (int k = 0; k < 4; k++) {
        Colors one = {0};
        sink.user = &one;
        sink.only_sample = k + 1;
        CHECK_INT(glint_explain(scene, &desc, &sink, NULL), GLINT_OK);
        CHECK(one.count == 1 && one.sample == k && one.additions[0] == all.additions[k]);
        CHECK(memcmp(one.color[0], all.color[k], sizeof one.color[0]) == 0);
    }
    Colors none = {0};
    sink.user = &none;
    sink.only_sample = 5;
    CHECK_INT(glint_explain(scene, &desc, &sink, NULL), GLINT_OK);
    CHECK_INT(none.count, 0);
    glint_scene_destroy(scene);
}

static bool always(void *user) {
    (void)user;
    return true;
}

static void arguments(void) {
    GlintScene *scene = scene_from_text(small_scene, NULL, 1);
    GlintRenderDesc desc = glint_render_desc_default();
    GlintExplainSink sink = {NULL, NULL, NULL, 0};
    GlintError error;
    CHECK_INT(glint_explain(scene, &desc, NULL, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_explain(scene, NULL, &sink, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_explain(scene, &desc, &sink, &error), GLINT_OK);
    const GlintMonitor monitor = {.cancelled = always};
    desc.monitor = &monitor;
    CHECK_INT(glint_explain(scene, &desc, &sink, &error), GLINT_CANCELLED);
    desc.monitor = NULL;
    desc.crop_x = 1 << 20;
    CHECK_INT(glint_explain(scene, &desc, &sink, &error), GLINT_ERROR_ARGUMENT);
    desc.crop_x = 0;
    sink.only_sample = -1;
    CHECK_INT(glint_explain(scene, &desc, &sink, &error), GLINT_ERROR_ARGUMENT);
    glint_scene_destroy(scene);
}

/* What explanations refer to can be asked for. */
static void shaders_and_lights(void) {
    GlintScene *scene = scene_from_text("<scene dialect='2019'><image>4 4</image>"
                                        "<camera type='PerspectiveCamera'/>"
                                        "<shader name='a' type='Phong'><exponent>7</exponent>"
                                        "<mirrorCoefficient>.1 .2 .3</mirrorCoefficient></shader>"
                                        "<light><position>1 2 3</position></light>"
                                        "<backColor>.1 .2 .3</backColor></scene>",
        NULL, 1);
    GlintShaderDesc shader;
    GlintLightDesc light;
    double color[3];
    CHECK(glint_scene_shader(scene, (GlintShaderId){0}, &shader));
    CHECK(shader.type == GLINT_SHADER_LAMBERTIAN && shader.diffuse_color[0] == 0.2);
    CHECK(glint_scene_shader(scene, (GlintShaderId){1}, &shader));
    CHECK(shader.type == GLINT_SHADER_PHONG && shader.exponent == 7);
    CHECK(shader.mirror_color[1] == 0.2 && shader.texture.index1 == 0);
    CHECK(!glint_scene_shader(scene, (GlintShaderId){2}, &shader));
    CHECK(glint_scene_light(scene, 1, &light) && light.position[2] == 3);
    CHECK(!glint_scene_light(scene, 0, &light) && !glint_scene_light(scene, 2, &light));
    CHECK(!glint_scene_background(scene, color) && color[2] == 0.3);
    glint_scene_destroy(scene);
}

/* Refuses one request, once it is armed. */
typedef struct Meagre {
    long left; /* requests until then; negative: all are granted */
} Meagre;

static void *meagre(void *user, void *pointer, size_t old_size, size_t new_size) {
    Meagre *self = user;
    (void)old_size;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    if (self->left >= 0 && self->left-- == 0) return NULL;
    return realloc(pointer, new_size);
}

static void short_of_memory(void) {
    Meagre self = {-1};
    const GlintAllocator allocator = {meagre, &self};
    GlintSceneDesc scene_desc = glint_scene_desc_default();
    scene_desc.allocator = &allocator;
    scene_desc.thread_count = 1;
    GlintScene *scene = NULL;
    CHECK_INT(glint_scene_create(&scene_desc, &scene, NULL), GLINT_OK);
    CHECK_INT(glint_scene_load_file(scene, golden_path("glass-2012"), NULL, NULL), GLINT_OK);
    CHECK_INT(glint_scene_commit(scene, NULL, NULL), GLINT_OK);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.crop_x = 48, desc.crop_y = 40, desc.crop_width = desc.crop_height = 2;
    const GlintExplainSink sink = {NULL, NULL, NULL, 0};
    int failed = 0;
    for (long n = 0; n < 200; n++) {
        self.left = n;
        GlintStatus status = glint_explain(scene, &desc, &sink, NULL);
        if (status == GLINT_OK && self.left >= 0) break;
        CHECK_INT(status, GLINT_ERROR_MEMORY);
        failed++;
    }
    CHECK(failed > 8);
    self.left = -1;
    CHECK_INT(glint_explain(scene, &desc, &sink, NULL), GLINT_OK);
    glint_scene_destroy(scene);
}

const GiTest tests_explain[] = {TEST(adds_up), TEST(gallery), TEST(descs), TEST(only_one_sample),
    TEST(arguments), TEST(shaders_and_lights), TEST(short_of_memory), TEST_END};
