/* SPDX-License-Identifier: MIT
 * Whole pictures: cameras by the formula of the scene format, groups where they belong, and no dark
 * spots on what is lit. */
#include "test.h"

#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- cameras */

typedef struct Lens {
    bool parallel;
    GiVec eye, direction, up, normal; /* normal zero: not given */
    double distance, width, height;
} Lens;

/* Section 4.3, word for word. */
static void lens_ray(const Lens *lens, double a, double b, GiVec *origin, GiVec *direction) {
    GiVec d = gi_normalize(lens->direction);
    GiVec w = gi_normalize(gi_vec_is_zero(lens->normal) ? gi_negate(d) : lens->normal);
    if (gi_dot(w, d) > 0) w = gi_negate(w);
    GiVec u = gi_normalize(gi_cross(lens->up, w)), v = gi_cross(w, u);
    GiVec p = gi_add(gi_scale(u, (a - 0.5) * lens->width), gi_scale(v, (b - 0.5) * lens->height));
    *origin = lens->parallel ? gi_add(lens->eye, p) : lens->eye;
    *direction = lens->parallel ? d : gi_normalize(gi_add(gi_scale(d, lens->distance), p));
}

static const char *lens_text(const Lens *lens) {
    static char text[1000], normal[200];
    normal[0] = '\0';
    if (!gi_vec_is_zero(lens->normal)) {
        snprintf(normal, sizeof normal, "<projNormal>%.17g %.17g %.17g</projNormal>",
            lens->normal.x, lens->normal.y, lens->normal.z);
    }
    snprintf(text, sizeof text,
        "<camera type='%s'><viewPoint>%.17g %.17g %.17g</viewPoint><viewDir>%.17g %.17g %.17g"
        "</viewDir><viewUp>%.17g %.17g %.17g</viewUp>%s<projDistance>%.17g</projDistance>"
        "<viewWidth>%.17g</viewWidth><viewHeight>%.17g</viewHeight></camera>",
        lens->parallel ? "ParallelCamera" : "PerspectiveCamera", lens->eye.x, lens->eye.y,
        lens->eye.z, lens->direction.x, lens->direction.y, lens->direction.z, lens->up.x,
        lens->up.y, lens->up.z, normal, lens->distance, lens->width, lens->height);
    return text;
}

static const Lens lenses[] = {
    {false, {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 0, 0}, 1, 1, 1},
    {false, {1, 2, 3}, {-4, -3, 2}, {0, 0, 5}, {0, 0, 0}, 2, 1.5, 0.7},   /* lengths, aspect */
    {false, {1, 2, 3}, {-4, -3, 2}, {0, 1, 0}, {4, 3.5, -1}, 0.5, 1, 1},  /* oblique */
    {false, {1, 2, 3}, {-4, -3, 2}, {0, 1, 0}, {-4, -2, 2.5}, 0.5, 1, 1}, /* normal turned */
    {false, {0, 0, 0}, {1, 1, 1}, {1, 0, 0}, {-1, -1, -1}, 0.01, 9, 9},   /* very wide */
    {true, {0.5, -0.5, 0}, {0, 0, -1}, {0, 1, 0}, {0, 0, 0}, 1, 2, 1},
    {true, {0.2, 0.1, 0.3}, {3, -1, 2}, {0, 1, 0.5}, {-3, 1, -2}, 7, 1,
        2}, /* distance: no matter */
    {true, {0.2, 0.1, 0.3}, {3, -1, 2}, {0, 1, 0.5}, {-3, 2, -1}, 1, 2, 2}, /* oblique */
};

/* Inside of a sphere that shows its normals every pixel tells where its ray arrived. */
static void cameras(void) {
    enum { WIDTH = 9, HEIGHT = 7 };
    const double radius = 4;
    static const int samples[] = {1, 4, 8, 2, 9};
    for (size_t k = 0; k < sizeof lenses / sizeof lenses[0]; k++) {
        const Lens *lens = &lenses[k];
        for (int s = 0; s < 5; s++) {
            int n = (int)(sqrt(samples[s]) + 0.5);
            static char xml[4000];
            snprintf(xml, sizeof xml,
                "<scene dialect='2017'>%s<image>%d %d</image><samples>%d</samples><surface "
                "type='Sphere'><radius>%g</radius><shader type='RGBNormals'/></surface></scene>",
                lens_text(lens), WIDTH, HEIGHT, samples[s], radius);
            Picture picture = picture_of_text(xml);
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                int x = i % WIDTH, row = i / WIDTH, y = HEIGHT - 1 - row;
                GiVec sum = {0, 0, 0};
                for (int j = 0; j < n * n; j++) {
                    GiVec o, d;
                    lens_ray(lens, (x + (j % n + 0.5) / n) / WIDTH,
                        (y + (j / n + 0.5) / n) / HEIGHT, &o, &d);
                    double od = gi_dot(o, d);
                    double t = -od + sqrt(od * od - gi_dot(o, o) + radius * radius);
                    sum = gi_add(sum, gi_scale(gi_along(o, d, t), 1 / radius));
                }
                GiVec n2 = gi_scale(sum, 0.5 / (n * n)), color = picture_at(&picture, x, row);
                char what[60];
                snprintf(what, sizeof what, "camera %zu, pixel %d %d", k, x, row);
                CHECK_COLOR(what, color, 0.5 + n2.x, 0.5 + n2.y, 0.5 + n2.z);
            }
            picture_free(&picture);
        }
    }
}

/* ---------------------------------------------------------------- groups */

/* Whether there is something over (x, y), looking down. */
static bool is_there(GlintScene *scene, double x, double y) {
    GlintRay ray = {{x, y, 50}, {0, 0, -1}, 0, INFINITY};
    return glint_occluded(scene, &ray);
}

static void check_places(
    const char *year, const char *groups, int count, const double places[][2]) {
    static char xml[4000];
    snprintf(
        xml, sizeof xml, "<scene dialect='%s'><camera/><image>1 1</image>%s</scene>", year, groups);
    GlintScene *scene = scene_from_text(xml, NULL, 1);
    if (scene == NULL) return;
    int found = 0;
    for (int x = -40; x <= 40; x++) {
        for (int y = -40; y <= 40; y++) found += is_there(scene, x, y);
    }
    CHECK_INT(found, count);
    for (int i = 0; i < count; i++) {
        if (!is_there(scene, places[i][0], places[i][1])) {
            test_fail(__FILE__, __LINE__, "%s: nothing at %g %g", year, places[i][0], places[i][1]);
        }
    }
    glint_scene_destroy(scene);
}

#define BALL "<surface type='Sphere'><center>1 0 0</center><radius>.1</radius></surface>"

static void group_order(void) {
    const char *turned =
        "<surface type='Group'><translate>5 0 0</translate><rotate>0 0 90</rotate>" BALL
        "</surface>";
    static const char *const last[] = {
        "2011", "2012", "material", "2013", "2017", "2018", "2019", "glint"};
    for (int i = 0; i < 8; i++) check_places(last[i], turned, 1, (const double[][2]){{5, 1}});
    check_places("2017b", turned, 1, (const double[][2]){{0, 6}});
    check_places("2018b", turned, 1, (const double[][2]){{0, 6}});
    /* In groups the child acts first in every year; elements mix with surfaces in any order. */
    const char *nested = "<surface type='Group'>" BALL "<surface type='Group'>" BALL
                         "<translate>5 0 0</translate></surface><scale>1 -1 1</scale>"
                         "<rotate>0 0 90</rotate></surface>";
    check_places("2012", nested, 2, (const double[][2]){{0, -1}, {0, -6}});
    check_places("2017b", nested, 2, (const double[][2]){{0, 1}, {0, 6}});
    const char *angles = "<surface type='Group'><rotate>90 0 90</rotate><surface type='Sphere'>"
                         "<center>0 3 2</center><radius>.1</radius></surface></surface>";
    /* x first: (0 -2 3), then z: (2 0 3). */
    check_places("2012", angles, 1, (const double[][2]){{2, 0}});
}

static void group_references(void) {
    const char *shared =
        "<surface type='Group' name='pair'>" BALL "<surface type='Sphere' name='ball'><center>0 2 0"
        "</center><radius>.1</radius></surface><rotate name='r'>0 0 90</rotate></surface>"
        "<surface type='Group'><translate name='t'>10 0 0</translate><surface "
        "ref='pair'/></surface>"
        "<surface type='Group'><translate>0 10 0</translate><rotate ref='r'/><translate ref='t'/>"
        "<surface ref='pair'/><surface ref='ball'/></surface><surface ref='ball'/>";
    check_places("2012", shared, 8,
        (const double[][2]){{0, 1}, {-2, 0}, {10, 1}, {8, 0}, {-1, 20}, {0, 18}, {-2, 20}, {0, 2}});
}

/* ---------------------------------------------------------------- no acne */

/* A solid lit from a slant: no pixel with n.l > 0.01 may be dark. Solid and eye are moved and
 * enlarged together. */
static void check_acne(const char *year, const char *surface, GiVec at, double size) {
    Lens lens = {false, gi_add(at, gi_scale(gi_vec(1.5, -2.6, 1.9), 1.3 * size)), {-1.5, 2.6, -1.9},
        {0, 0, 1}, {0, 0, 0}, 1, 0.9, 0.9};
    GiVec light = gi_add(at, gi_scale(gi_vec(7, -3, 5), size));
    static char xml[4000];
    snprintf(xml, sizeof xml,
        "<scene dialect='%s'>%s<image>48 48</image><light type='PointLight'><position>%.17g %.17g "
        "%.17g</position><falloff>none</falloff></light><surface type='Group'><translate>%.17g "
        "%.17g %.17g</translate></surface>%s</scene>",
        year, lens_text(&lens), light.x, light.y, light.z, at.x, at.y, at.z, surface);
    GlintScene *scene = scene_from_text(xml, NULL, 1);
    Picture picture = picture_of_scene(scene, NULL);
    int dark = 0, lit = 0;
    for (int i = 0; i < 48 * 48 && picture.pixels != NULL; i++) {
        GiVec o, d;
        lens_ray(&lens, (i % 48 + 0.5) / 48, (47 - i / 48 + 0.5) / 48, &o, &d);
        GlintRay ray = {{o.x, o.y, o.z}, {d.x, d.y, d.z}, 0, INFINITY};
        GlintHit hit;
        if (!glint_trace(scene, &ray, &hit)) continue;
        GiVec l = gi_normalize(gi_sub(light, gi_vec_from(hit.point)));
        GiVec n = gi_vec_from(hit.normal);
        if (gi_dot(n, l) < 0.01) continue;
        if (fabs(picture_at(&picture, i % 48, i / 48).x - gi_dot(n, l)) > 1e-4) dark++;
        lit++;
    }
    if (dark > 0 || lit < 20) {
        test_fail(__FILE__, __LINE__, "%s at (%g %g %g), size %g: %d of %d pixels are wrong: %s",
            year, at.x, at.y, at.z, size, dark, lit, surface);
    }
    picture_free(&picture);
    glint_scene_destroy(scene);
}

/* The solids in numbers of their own, or as unit solids under a transform. */
static void no_acne(void) {
    static const double scales[] = {1, 1e5, 1e-4};
    static const char *const used[] = {"2012", "2017", "glint"};
    static const char *const inside =
        "<shader type='Lambertian'><diffuseColor>1 1 1</diffuseColor></shader>";
    for (int y = 0; y < 3; y++) {
        for (int k = 0; k < 6; k++) {
            double s = scales[k % 3];
            GiVec at = k < 3 ? gi_vec(0, 0, 0) : gi_vec(1e6, -2e6, 3e6);
            /* A thousandth is larger than the solid then, or numbers there are too coarse for it.
             */
            if (s < 1 && (y == 1 || k >= 3)) continue;
            char text[2000];
            snprintf(text, sizeof text,
                "<surface type='Sphere'><center>%.17g %.17g %.17g</center><radius>%g</radius>%s"
                "</surface>",
                at.x, at.y, at.z, s, inside);
            check_acne(used[y], text, at, s);
            snprintf(text, sizeof text,
                "<surface type='Box'><minPt>%.17g %.17g %.17g</minPt><maxPt>%.17g %.17g "
                "%.17g</maxPt>"
                "%s</surface>",
                at.x - s, at.y - s, at.z - s, at.x + s, at.y + s, at.z + s, inside);
            check_acne(used[y], text, at, s);
            snprintf(text, sizeof text,
                "<surface type='Cylinder'><center>%.17g %.17g %.17g</center><radius>%g</radius>"
                "<height>%g</height>%s</surface>",
                at.x, at.y, at.z, s, s, inside);
            check_acne(used[y], text, at, s);
            snprintf(text, sizeof text,
                "<surface type='Cone'><center>%.17g %.17g %.17g</center><radius>%g</radius>"
                "<height>%g</height><tipz>%.17g</tipz>%s</surface>",
                at.x, at.y, at.z, s, s, at.z + 0.5 * s, inside);
            check_acne(used[y], text, at, s);
            snprintf(text, sizeof text,
                "<surface type='Plane'><point>%.17g %.17g %.17g</point><normal>.1 -.2 1</normal>%s"
                "</surface>",
                at.x, at.y, at.z, inside);
            check_acne(used[y], text, at, s);
            snprintf(text, sizeof text,
                "<surface type='Disc'><point>%.17g %.17g %.17g</point><normal>.1 -.2 1</normal>"
                "<radius>%g</radius>%s</surface>",
                at.x, at.y, at.z, s, inside);
            check_acne(used[y], text, at, s);
            static const char *const placed[] = {"<surface type='Sphere'>%s</surface>",
                "<surface type='Box'><minPt>-1 -1 -1</minPt><maxPt>1 1 1</maxPt>%s</surface>",
                "<surface type='Cylinder'><height>2</height>%s</surface>",
                "<surface type='Cone'><tipz>1</tipz>%s</surface>"};
            for (int i = 0; i < 4; i++) {
                char shape[600];
                snprintf(shape, sizeof shape, placed[i], inside);
                snprintf(text, sizeof text,
                    "<surface type='Group'><translate>%.17g %.17g %.17g</translate><rotate>20 30 40"
                    "</rotate><scale>%g %g %g</scale>%s</surface>",
                    at.x, at.y, at.z, s, -0.7 * s, 0.4 * s, shape);
                check_acne(used[y], text, at, s);
            }
        }
    }
}

/* Unit spheres on a ground of radius 10^5, here and 3.7 million units away. */
static Picture draw_ground(GiVec at) {
    Lens lens = {false, gi_add(at, gi_vec(1, -9, 3)), {-1, 9, -3}, {0, 0, 1}, {0, 0, 0}, 1, 1, 0.7};
    static char xml[8000], *to;
    to = xml;
    to += snprintf(to, 1000,
        "<scene dialect='glint'>%s<image>100 70</image><light><position>%.17g %.17g "
        "%.17g</position>"
        "</light><surface type='Sphere'><center>%.17g %.17g %.17g</center><radius>100000</radius>"
        "</surface>",
        lens_text(&lens), at.x + 6, at.y - 8, at.z + 7, at.x, at.y, at.z - 100000);
    for (int i = 0; i < 12; i++) {
        to += snprintf(to, 500,
            "<surface type='Sphere'><center>%.17g %.17g %.17g</center><shader type='Phong'/>"
            "</surface>",
            at.x + 2.5 * (i % 4) - 4, at.y + 2.5 * (i / 4) - 2, at.z + 1);
    }
    snprintf(to, 50, "</scene>");
    return picture_of_text(xml);
}

static void sizes_far_apart(void) {
    Picture here = draw_ground(gi_vec(0, 0, 0)), there = draw_ground(gi_vec(1e6, -2e6, 3e6));
    int different = 0, dark = 0;
    for (int i = 0; i < 100 * 70; i++) {
        GiVec a = picture_at(&here, i % 100, i / 100), b = picture_at(&there, i % 100, i / 100);
        if (!(fabs(a.x - b.x) + fabs(a.y - b.y) + fabs(a.z - b.z) < 1e-4)) different++;
        /* The foreground is empty ground in the light. */
        if (i / 100 >= 62 && a.x < 0.3) dark++;
    }
    /* At most a few pixels on the edges. */
    CHECK(different <= 5);
    CHECK_INT(dark, 0);
    picture_free(&here);
    picture_free(&there);
}

const GiTest tests_render[] = {TEST(cameras), TEST(group_order), TEST(group_references),
    TEST(no_acne), TEST(sizes_far_apart), TEST_END};
