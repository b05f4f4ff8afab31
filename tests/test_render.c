/* SPDX-License-Identifier: MIT
 * Pictures with a known answer: radiance by hand, shadows where geometry puts them, cameras by the
 * formula of the scene format, and small pictures by hash. */
#include "test.h"

#include "base/array.h"
#include "random.h"
#include "scenes.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Section 3 of the scene format once more, for the rules that light obeys. */
typedef struct Year {
    const char *name;
    bool falloff, over_pi, highlight_cosine, highlight_needs_light, black_from_behind;
    bool sphere_shadows_itself, entering_only;
} Year;

static const Year years[] = {
    {"2011", false, false, false, false, false, false, true},
    {"2012", false, false, false, false, false, false, true},
    {"material", true, false, true, false, false, true, false},
    {"2013", false, false, false, false, false, false, false},
    {"2017", true, false, false, true, false, true, false},
    {"2017b", true, false, false, true, false, true, false},
    {"2018", true, true, false, true, true, true, false},
    {"2018b", true, true, false, true, true, true, false},
    {"2019", true, true, true, true, true, true, false},
    {"glint", false, false, false, true, false, true, false},
};
enum { YEARS = sizeof years / sizeof years[0] };

static const double over_pi = 0.31830988618379067;

/* ---------------------------------------------------------------- one ray, one colour */

/* The colour that a ray from eye along direction brings, in a scene of the given inside. */
static GiVec radiance(const char *year, GiVec eye, GiVec direction, const char *format, ...) {
    static char body[4096], xml[8192];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(body, sizeof body, format, arguments);
    va_end(arguments);
    snprintf(xml, sizeof xml,
        "<scene dialect=\"%s\"><image>1 1</image><camera><viewPoint>%.17g %.17g %.17g</viewPoint>"
        "<viewDir>%.17g %.17g %.17g</viewDir><viewUp>.3 1 .2</viewUp></camera>%s</scene>",
        year, eye.x, eye.y, eye.z, direction.x, direction.y, direction.z, body);
    Picture picture = picture_of_text(xml);
    GiVec color = picture_at(&picture, 0, 0);
    picture_free(&picture);
    return color;
}

/* To the precision of float. */
static void check_color(int line, const char *what, GiVec actual, double r, double g, double b) {
    double tolerance = 1e-6 * (1 + fabs(r) + fabs(g) + fabs(b));
    if (!(fabs(actual.x - r) <= tolerance && fabs(actual.y - g) <= tolerance &&
            fabs(actual.z - b) <= tolerance)) {
        test_fail(__FILE__, line, "%s: (%.9g %.9g %.9g), not (%.9g %.9g %.9g)", what, actual.x,
            actual.y, actual.z, r, g, b);
    }
}
#define CHECK_COLOR(what, actual, r, g, b) check_color(__LINE__, what, actual, r, g, b)

static const GiVec down = {0, 0, -1};

/* Surfaces, each with a point at the origin where the normal is +z. */
static const struct {
    const char *name, *start, *rest;
} tops[] = {
    {"Sphere", "<surface type='Sphere'>", "<center>0 0 -2</center><radius>2</radius></surface>"},
    {"Box", "<surface type='Box'>", "<minPt>-1 -1 -3</minPt><maxPt>1 1 0</maxPt></surface>"},
    {"Box, corners exchanged", "<surface type='Box'>",
        "<minPt>1 -1 0</minPt><maxPt>-1 1 -3</maxPt></surface>"},
    {"Cylinder", "<surface type='Cylinder'>",
        "<center>0 0 -1</center><height>2</height></surface>"},
    {"Cone", "<surface type='Cone'>",
        "<center>0 0 -1</center><height>2</height><tipz>3</tipz></surface>"},
    {"Plane", "<surface type='Plane'>", "<normal>0 0 7</normal></surface>"},
    {"Disc", "<surface type='Disc'>", "<normal>0 0 .1</normal></surface>"},
    {"Cylinder's wall", "<surface type='Group'><rotate>90 0 0</rotate><surface type='Cylinder'>",
        "<center>0 -1 0</center><height>2</height></surface></surface>"},
    {"sphere, mirrored and stretched",
        "<surface type='Group'><scale>3 -2 -.5</scale><surface type='Sphere'>",
        "<center>0 0 1</center></surface></surface>"},
};
enum { TOPS = sizeof tops / sizeof tops[0] };

static void lambertian(void) {
    for (int y = 0; y < YEARS; y++) {
        /* The light stands at distance 13, n.l = 12 / 13. */
        double e = (years[y].falloff ? 1 / 169.0 : 1) * (years[y].over_pi ? over_pi : 1) * 12 / 13;
        for (int i = 0; i < TOPS; i++) {
            GiVec color = radiance(years[y].name, gi_vec(0.5, 0.3, 6), gi_vec(-0.5, -0.3, -6),
                "%s<shader type='Lambertian'><diffuseColor>.5 .25 2</diffuseColor></shader>%s"
                "<light><position>3 4 12</position><intensity>10 20 30</intensity></light>",
                tops[i].start, tops[i].rest);
            char what[100];
            snprintf(what, sizeof what, "%s, %s", years[y].name, tops[i].name);
            CHECK_COLOR(what, color, 5 * e, 5 * e, 60 * e);
        }
        /* From behind, and the default colour: 1, in 2019 0.2. */
        GiVec color = radiance(years[y].name, gi_vec(0, 0, 6), down,
            "<surface type='Disc'/><light><position>3 4 -12</position></light>");
        CHECK_COLOR(years[y].name, color, 0, 0, 0);
        double kd = strcmp(years[y].name, "2019") == 0 ? 0.2 : 1;
        color = radiance(years[y].name, gi_vec(0, 0, 6), down,
            "<surface type='Disc'/><light><position>3 4 12</position></light>");
        CHECK_COLOR(years[y].name, color, kd * e, kd * e, kd * e);
        /* Light and normal behind the surface, as the viewer sees it. */
        double behind = years[y].black_from_behind ? 0 : kd * e;
        color = radiance(years[y].name, gi_vec(0, 0, 6), down,
            "<surface type='Disc'><normal>0 0 -1</normal></surface>"
            "<light><position>3 4 -12</position></light>");
        CHECK_COLOR(years[y].name, color, behind, behind, behind);
    }
}

static void phong(void) {
    static const double exponents[] = {0, 1, 2, 7, 2.5, 50, 1000, 0.5};
    for (int y = 0; y < YEARS; y++) {
        double e = 8 * (years[y].falloff ? 1 / 169.0 : 1), nl = 12 / 13.0;
        double kd = years[y].over_pi ? over_pi : 1;
        double nh = 25 / sqrt(650); /* l = (3 4 12) / 13, v = z, h along (3 4 25) */
        for (size_t i = 0; i < sizeof exponents / sizeof exponents[0]; i++) {
            GiVec color = radiance(years[y].name, gi_vec(0, 0, 6), down,
                "%s<shader type='Phong'><diffuseColor>.5 .25 0</diffuseColor><specularColor>.1 .2 3"
                "</specularColor><exponent>%g</exponent></shader>%s<light><position>3 4 12"
                "</position><intensity>8 8 8</intensity></light>",
                tops[i % TOPS].start, exponents[i], tops[i % TOPS].rest);
            double ks = pow(nh, exponents[i]) * (years[y].highlight_cosine ? nl : 1);
            CHECK_COLOR(years[y].name, color, e * (0.5 * kd * nl + 0.1 * ks),
                e * (0.25 * kd * nl + 0.2 * ks), e * 3 * ks);
        }
        /* n.l = -0.28 but n.h = 0.36 / ...: the light stands below the horizon of a disc. */
        GiVec eye = gi_vec(3, 0, 4); /* v = (.6 0 .8), l = (-.96 0 -.28), h along (-.36 0 .52) */
        GiVec color = radiance(years[y].name, eye, gi_negate(eye),
            "<surface type='Disc'><shader type='Phong'><exponent>3</exponent></shader></surface>"
            "<light><position>-9.6 0 -2.8</position></light>");
        bool dark = years[y].highlight_needs_light || years[y].highlight_cosine;
        double ks = dark ? 0 : pow(0.52 / sqrt(0.36 * 0.36 + 0.52 * 0.52), 3);
        if (years[y].falloff) ks /= 100;
        CHECK_COLOR(years[y].name, color, ks, ks, ks);
    }
}

static void falloff_by_light(void) {
    static const char *const names[] = {"none", "inverse-square"};
    for (int y = 0; y < YEARS; y++) {
        for (int i = 0; i < 2; i++) {
            GiVec color = radiance(years[y].name, gi_vec(0, 0, 6), down,
                "<surface type='Disc'><shader type='Lambertian'><diffuseColor>1 1 1</diffuseColor>"
                "</shader></surface><light type='PointLight'><position>0 0 10</position>"
                "<falloff>%s</falloff></light>",
                names[i]);
            double e = (i == 0 ? 1 : 0.01) * (years[y].over_pi ? over_pi : 1);
            CHECK_COLOR(years[y].name, color, e, e, e);
        }
    }
}

static void background_and_exposure(void) {
    GiVec eye = {0, 0, 6};
    const char *back = "<backColor>.1 .2 .3</backColor>";
    GiVec color = radiance("2013", eye, down, "%s", back);
    CHECK_COLOR("back", color, 0.1, 0.2, 0.3);
    color = radiance("2017", eye, down, "%s<exposure>2.5</exposure>", back);
    CHECK_COLOR("back and exposure", color, 0.25, 0.5, 0.75);
    color = radiance("2017", eye, down, "%s<exposure>-2</exposure>", back);
    CHECK_COLOR("no exposure", color, 0.1, 0.2, 0.3);
    color = radiance("2017", eye, down, "%s<exposure>0</exposure>", back);
    CHECK_COLOR("no exposure", color, 0.1, 0.2, 0.3);
    color = radiance("2013", eye, down, "%s<backColor>7 8 9</backColor>", back);
    CHECK_COLOR("the last one wins", color, 7, 8, 9);
    color = radiance("glint", eye, down, "");
    CHECK_COLOR("black", color, 0, 0, 0);
    /* What is behind the eye is not seen. */
    color = radiance(
        "2013", eye, down, "%s<surface type='Sphere'><center>0 0 9</center></surface>", back);
    CHECK_COLOR("behind", color, 0.1, 0.2, 0.3);
}

static void lights_without_a_place(void) {
    GiVec eye = {0, 0, 6};
    const char *surface = "<surface type='Disc'><normal>2 -1 2</normal><material type='Phong'>"
                          "<color>.5 .25 2</color></material></surface>";
    GiVec color = radiance("material", eye, down,
        "%s<light type='AmbientLight'><intensity>1 2 3</intensity></light>", surface);
    CHECK_COLOR("ambient", color, 0.5, 0.5, 6);
    color = radiance("material", eye, down, "%s<light type='ConstantLight'/>", surface);
    CHECK_COLOR("constant", color, 0.5, 0.25, 2);
    color = radiance("material", eye, down, "%s<light type='NormalLight'/>", surface);
    CHECK_COLOR("normal", color, 5 / 6.0, 1 / 3.0, 5 / 6.0);
    color = radiance("material", eye, down,
        "%s<light type='ConstantLight'/><light type='AmbientLight'/><light type='NormalLight'/>",
        surface);
    CHECK_COLOR("sum", color, 1 + 5 / 6.0, 0.5 + 1 / 3.0, 4 + 5 / 6.0);
    color = radiance("2017", eye, down,
        "<exposure>3</exposure><surface type='Disc'><normal>2 -1 2</normal>"
        "<shader type='RGBNormals'/></surface><light><position>1 2 3</position></light>");
    CHECK_COLOR("RGBNormals", color, 2.5, 1, 2.5);
}

/* ---------------------------------------------------------------- shadows */

/* The brightness at (x, y, 0) of a plane under what may shade it. */
static double brightness(const char *year, const char *shade, double x, double y) {
    GiVec eye = {x + 0.3, y - 0.2, 1};
    return radiance(year, eye, gi_sub(gi_vec(x, y, 0), eye),
        "<surface type='Plane'/>%s<light type='PointLight'><position>0 0 10</position>"
        "<falloff>none</falloff></light>",
        shade)
        .x;
}

static void shadow_edges(void) {
    /* From a light at height 10: how far from the axis the shadow reaches on the plane. */
    const struct {
        const char *xml;
        double reach;
    } shades[] = {
        {"<surface type='Box'><minPt>-1 -1 4</minPt><maxPt>1 1 5</maxPt></surface>", 2},
        {"<surface type='Disc'><point>0 0 5</point><normal>0 0 -1</normal></surface>", 2},
        {"<surface type='Sphere'><center>0 0 5</center></surface>", 10 / sqrt(24)},
        {"<surface type='Cylinder'><center>0 0 5</center></surface>", 10 / 4.5},
        {"<surface type='Cone'><center>0 0 5</center><tipz>6</tipz></surface>", 10 * 1.5 / 5.5},
        {"<surface type='Group'><scale>2 1 1</scale><surface type='Disc'>"
         "<point>0 0 5</point><radius>.5</radius></surface></surface>",
            2},
        {"<surface type='Sphere'><center>0 0 12</center></surface>", 0}, /* over the light */
        {"<surface type='Sphere'><center>0 0 -3</center></surface>", 0}, /* under the plane */
        {"<surface type='Disc'><point>0 0 10.00001</point><radius>50</radius></surface>", 0},
    };
    for (int y = 0; y < YEARS; y++) {
        double most = years[y].over_pi ? over_pi : 1;
        if (strcmp(years[y].name, "2019") == 0) most *= 0.2;
        for (size_t i = 0; i < sizeof shades / sizeof shades[0]; i++) {
            double in = shades[i].reach * 0.999, out = shades[i].reach * 1.001 + 0.001;
            if (shades[i].reach > 0) {
                CHECK_NEAR(brightness(years[y].name, shades[i].xml, in, 0), 0, 0);
                CHECK_NEAR(brightness(years[y].name, shades[i].xml, -in * 0.5, 0), 0, 0);
            }
            double lit = most * 10 / sqrt(100 + out * out);
            CHECK_NEAR(brightness(years[y].name, shades[i].xml, out, 0), lit, 1e-6);
            CHECK_NEAR(brightness(years[y].name, shades[i].xml, -out, 0), lit, 1e-6);
        }
    }
    /* A surface nearer than a thousandth does not block in 2017, 2018, 2019. */
    for (int y = 0; y < YEARS; y++) {
        const char *name = years[y].name;
        bool far =
            strcmp(name, "2017") == 0 || strcmp(name, "2018") == 0 || strcmp(name, "2019") == 0;
        GiVec color = radiance(name, gi_vec(0, 3, 0.0002), gi_vec(0, -3, -0.0002),
            "<surface type='Plane'/><surface type='Disc'><point>0 0 .0005</point></surface>"
            "<light><position>0 0 10</position></light>");
        CHECK((color.x > 0) == far);
    }
}

/* Highlights that only a shadow takes away show what a surface meets of itself. */
static void shadows_of_itself(void) {
    static const struct {
        const char *xml;
        bool interior_lit;
    } solids[] = {
        {"<surface type='Sphere'>%s</surface>", false},
        {"<surface type='Box'><minPt>-1 -1 -1</minPt><maxPt>1 1 1</maxPt>%s</surface>", true},
        {"<surface type='Cylinder'><height>2</height>%s</surface>", true},
        {"<surface type='Cone'><height>2</height><tipz>2</tipz>%s</surface>", false},
    };
    const char *shader = "<shader type='Phong'><diffuseColor>0 0 0</diffuseColor>"
                         "<exponent>2</exponent></shader>";
    for (int y = 0; y < YEARS; y++) {
        for (size_t i = 0; i < sizeof solids / sizeof solids[0]; i++) {
            /* At (0 0 1), seen from above; l = (.28 0 -.96), so h goes along (.28 0 .04). The way
             * to the light goes through the solid: out of the box and the cylinder at the bottom.
             */
            char surface[400];
            snprintf(surface, sizeof surface, solids[i].xml, shader);
            GiVec color = radiance(years[y].name, gi_vec(0, 0, 6), down,
                "%s<light><position>2.8 0 -8.6</position></light>", surface);
            bool lit = i == 0 ? !years[y].sphere_shadows_itself
                              : solids[i].interior_lit && years[y].entering_only;
            if (years[y].highlight_needs_light || years[y].highlight_cosine) lit = false;
            double expected = lit ? 0.04 * 0.04 / (0.28 * 0.28 + 0.04 * 0.04) : 0;
            CHECK_COLOR(years[y].name, color, expected, expected, expected);
        }
        /* "The very sphere": another one in the same place blocks. */
        GiVec color = radiance(years[y].name, gi_vec(0, 0, 6), down,
            "<surface type='Sphere'>%s</surface><surface type='Sphere'/>"
            "<light><position>2.8 0 -8.6</position></light>",
            shader);
        CHECK_COLOR(years[y].name, color, 0, 0, 0);
        /* Out through the wall of a cylinder: that one counts in every year. */
        color = radiance(years[y].name, gi_vec(0, 0, 6), down,
            "<surface type='Cylinder'><height>2</height>%s</surface>"
            "<light><position>9.6 0 -1.8</position></light>",
            shader);
        CHECK_COLOR(years[y].name, color, 0, 0, 0);
    }
}

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

static char *file_text(const char *name) {
    static char text[20000];
    char path[4096];
    snprintf(path, sizeof path, "%s/tests/golden/%s", test_source_dir(), name);
    FILE *file = fopen(path, "rb");
    size_t length = file != NULL ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file != NULL) fclose(file);
    text[length] = '\0';
    if (length == 0) test_fail(__FILE__, __LINE__, "cannot read %s", path);
    return text;
}

static void crops(void) {
    static const int parts[][4] = {{0, 0, 0, 0}, {1, 1, 1, 1}, {63, 60, 5, 9}, {64, 64, 0, 0},
        {17, 3, 80, 70}, {0, 79, 0, 1}, {127, 0, 1, 0}, {5, 0, 64, 64}};
    static const char *const names[] = {"oblique-2013.xml", "groups-2012.xml", "parallel-2013.xml"};
    for (int k = 0; k < 3; k++) {
        GlintScene *scene = scene_from_text(file_text(names[k]), NULL, 2);
        GlintRenderDesc desc = glint_render_desc_default();
        desc.width = 128;
        desc.height = 80;
        Picture whole = picture_of_scene(scene, &desc);
        for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
            desc.crop_x = parts[i][0], desc.crop_y = parts[i][1];
            desc.crop_width = parts[i][2], desc.crop_height = parts[i][3];
            Picture part = picture_of_scene(scene, &desc);
            for (int row = 0; part.pixels != NULL && row < part.height; row++) {
                const float *from = part.pixels + 3 * row * part.width;
                const float *of = whole.pixels + 3 * ((parts[i][1] + row) * 128 + parts[i][0]);
                size_t bytes = 3 * (size_t)part.width * sizeof *from;
                if (memcmp(from, of, bytes) != 0) {
                    test_fail(__FILE__, __LINE__, "%s: crop %zu, row %d", names[k], i, row);
                }
            }
            picture_free(&part);
        }
        picture_free(&whole);
        glint_scene_destroy(scene);
    }
}

static void sizes(void) {
    const char *text = file_text("oblique-2013.xml");
    GlintScene *scene = scene_from_text(text, NULL, 1);
    GlintRenderDesc desc = glint_render_desc_default();
    desc.width = 77;
    desc.height = 130;
    Picture picture = picture_of_scene(scene, &desc);
    glint_scene_destroy(scene);
    /* The same as a scene that says so itself. */
    static char other[20000];
    const char *image = strstr(text, "128 80");
    snprintf(other, sizeof other, "%.*s77 130%s", (int)(image - text), text, image + 6);
    Picture expected = picture_of_text(other);
    CHECK(picture.width == 77 && picture.height == 130);
    CHECK(picture_equal(&picture, &expected));
    picture_free(&picture);
    picture_free(&expected);
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

/* ---------------------------------------------------------------- golden pictures */

static const char *const goldens[] = {"spheres-2011", "solids-2012", "groups-2012",
    "lights-material", "constant-material", "oblique-2013", "parallel-2013", "exposure-2017",
    "groups-2017b", "lambert-2018", "phong-2019", "horizon-glint"};
enum { GOLDENS = sizeof goldens / sizeof goldens[0] };

typedef struct Hashes {
    uint64_t rgb, floats;
} Hashes;

static Hashes picture_hashes(const Picture *picture) {
    Hashes hashes = {0};
    if (picture->pixels == NULL) return hashes;
    size_t count = (size_t)picture->width * (size_t)picture->height * 3;
    uint8_t *rgb = malloc(count);
    if (rgb != NULL) {
        GlintImage image = {picture->width, picture->height, picture->pixels};
        glint_image_to_rgb8(&image, rgb);
        hashes.rgb = hash_bytes(rgb, count);
        free(rgb);
    }
    hashes.floats = hash_bytes(picture->pixels, count * sizeof *picture->pixels);
    return hashes;
}

static Picture draw_golden(const char *name, const char *isa, int threads) {
    char path[4096];
    snprintf(path, sizeof path, "%s/tests/golden/%s.xml", test_source_dir(), name);
    GlintScene *scene = scene_from_file(path, isa, threads);
    Picture picture = picture_of_scene(scene, NULL);
    glint_scene_destroy(scene);
    return picture;
}

static void print_differences(const Picture *picture, const Picture *expected) {
    int shown = 0;
    for (int i = 0; i < picture->width * picture->height && shown < 5; i++) {
        int x = i % picture->width, y = i / picture->width;
        GiVec a = picture_at(picture, x, y), b = picture_at(expected, x, y);
        if (a.x == b.x && a.y == b.y && a.z == b.z) continue;
        printf("    pixel %d %d: (%.9g %.9g %.9g), portable (%.9g %.9g %.9g)\n", x, y, a.x, a.y,
            a.z, b.x, b.y, b.z);
        shown++;
    }
    if (shown == 0)
        printf("    the portable kernel draws the same: the scene or a rule has changed\n");
}

static void check_golden(const char *name, Hashes expected) {
    static const int threads[] = {1, 2, 3, 8, 32};
    Picture portable = draw_golden(name, "portable", 1);
    const char *isa;
    for (int k = 0; (isa = glint_isa_name(k)) != NULL; k++) {
        for (int i = 0; i < 5; i++) {
            Picture picture = draw_golden(name, isa, threads[i]);
            Hashes hashes = picture_hashes(&picture);
            if (hashes.rgb != expected.rgb || hashes.floats != expected.floats) {
                test_fail(__FILE__, __LINE__, "%s, %s, %d threads: %016llx %016llx", name, isa,
                    threads[i], (unsigned long long)hashes.rgb, (unsigned long long)hashes.floats);
                if (picture.pixels != NULL && portable.pixels != NULL) {
                    print_differences(&picture, &portable);
                }
            }
            picture_free(&picture);
        }
    }
    picture_free(&portable);
}

static void update_golden(const char *path) {
    FILE *file = fopen(path, "w");
    CHECK(file != NULL);
    for (int i = 0; file != NULL && i < GOLDENS; i++) {
        Picture picture = draw_golden(goldens[i], "portable", 1);
        Hashes hashes = picture_hashes(&picture);
        fprintf(file, "%s %016llx %016llx\n", goldens[i], (unsigned long long)hashes.rgb,
            (unsigned long long)hashes.floats);
        picture_free(&picture);
    }
    if (file != NULL) CHECK(fclose(file) == 0);
}

static void golden(void) {
    char path[4096], name[100];
    snprintf(path, sizeof path, "%s/tests/golden/hashes.txt", test_source_dir());
    if (test_update_golden()) update_golden(path);
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        test_fail(__FILE__, __LINE__, "cannot read %s", path);
        return;
    }
    unsigned long long rgb, floats;
    int count = 0;
    while (fscanf(file, "%99s %llx %llx", name, &rgb, &floats) == 3) {
        if (count < GOLDENS) CHECK_TEXT(name, goldens[count]);
        check_golden(name, (Hashes){rgb, floats});
        count++;
    }
    fclose(file);
    CHECK_INT(count, GOLDENS);
}

const GiTest tests_render[] = {TEST(lambertian), TEST(phong), TEST(falloff_by_light),
    TEST(background_and_exposure), TEST(lights_without_a_place), TEST(shadow_edges),
    TEST(shadows_of_itself), TEST(cameras), TEST(crops), TEST(sizes), TEST(group_order),
    TEST(group_references), TEST(no_acne), TEST(sizes_far_apart), TEST(golden), TEST_END};
