/* SPDX-License-Identifier: MIT
 * One ray, one colour: radiance by hand for every year, and shadows where geometry puts them. */
#include "test.h"

#include "scenes.h"

#include <stdarg.h>
#include <stdio.h>
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

/* Distances beyond the range of float, in numbers of rays that are sorted before they are traced: a
 * light so near to a plane, and a plane so far from spheres, that the differences of coordinates
 * are nothing or infinite in single precision. */
static void lights_beyond_float(void) {
    static char xml[200000];
    Picture near =
        picture_of_text("<scene dialect='glint'><image>101 101</image>"
                        "<camera type='PerspectiveCamera'><viewPoint>0 0 5</viewPoint></camera>"
                        "<surface type='Plane'><normal>0 0 1</normal></surface>"
                        "<light><position>0 0 1e-50</position></light></scene>");
    CHECK(near.pixels != NULL);
    size_t length = (size_t)snprintf(xml, sizeof xml,
        "<scene dialect='glint'><image>320 240</image><camera type='PerspectiveCamera'>"
        "<viewPoint>0 0 30</viewPoint></camera>"
        "<surface type='Plane'><point>0 0 -1e39</point><normal>0 0 1</normal></surface>"
        "<light><position>3 4 50</position></light>");
    for (int i = 0; i < 1000; i++) {
        length += (size_t)snprintf(xml + length, sizeof xml - length,
            "<surface type='Sphere'><center>%d %d 0</center><radius>0.4</radius></surface>",
            i % 32 - 16, i / 32 - 16);
    }
    snprintf(xml + length, sizeof xml - length, "</scene>");
    Picture far = picture_of_text(xml);
    CHECK(far.pixels != NULL);
    picture_free(&near);
    picture_free(&far);
}

const GiTest tests_radiance[] = {TEST(lambertian), TEST(phong), TEST(falloff_by_light),
    TEST(background_and_exposure), TEST(lights_without_a_place), TEST(shadow_edges),
    TEST(shadows_of_itself), TEST(lights_beyond_float), TEST_END};
