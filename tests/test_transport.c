/* SPDX-License-Identifier: MIT
 * Light that is drawn by chance has the mean that it should: by hand, by other ways to find it, and
 * in all years. Most pictures here are one point seen by all pixels, so that pixels are independent
 * estimates of one number. */
#include "test.h"

#include "glint_scene.h"
#include "scenes.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* ---------------------------------------------------------------- estimates */

enum { SIDE = 16, PIXELS = SIDE * SIDE };

/* Of the pixels' colours: the mean, and the variance of a pixel, both of the sum of channels. */
typedef struct Estimate {
    double mean, variance;
} Estimate;

static Estimate estimate_of(const Picture *picture) {
    Estimate estimate = {0, 0};
    int count = picture->width * picture->height;
    double squares = 0;
    for (int i = 0; i < count; i++) {
        GiVec color = picture_at(picture, i % picture->width, i / picture->width);
        double value = color.x + color.y + color.z;
        estimate.mean += value / count;
        squares += value * value / count;
    }
    estimate.variance = fmax(squares - estimate.mean * estimate.mean, 0);
    return estimate;
}

static Estimate estimate_by(GlintScene *scene, GlintSampling sampling, GiTechnique technique) {
    Estimate estimate = {0, 0};
    if (scene == NULL) return estimate;
    Picture picture = {SIDE, SIDE, malloc(PIXELS * 3 * sizeof *picture.pixels)};
    const GiRenderArea area = {SIDE, SIDE, 0, 0, SIDE, SIDE};
    const GiRenderTarget target = {.samples = scene->model.samples,
        .color = picture.pixels,
        .sampling = sampling,
        .technique = technique};
    GiRenderCounts counts;
    CHECK_INT(gi_render(&scene->world, scene->pool, &area, NULL, &target, &counts), GLINT_OK);
    estimate = estimate_of(&picture);
    picture_free(&picture);
    return estimate;
}

/* All pixels look at the origin from (1, -2, 3). */
static GlintScene *point_scene(const char *dialect, int samples, const char *format, ...) {
    static char body[8000], text[12000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(body, sizeof body, format, arguments);
    va_end(arguments);
    snprintf(text, sizeof text,
        "<scene dialect='%s'><camera type='PerspectiveCamera'><viewPoint>1 -2 3</viewPoint>"
        "<viewDir>-1 2 -3</viewDir><viewWidth>1e-7</viewWidth><viewHeight>1e-7</viewHeight>"
        "</camera><image>%d %d</image><samples>%d</samples>%s</scene>",
        dialect, SIDE, SIDE, samples, body);
    return scene_from_text(text, NULL, 1);
}

static Estimate estimate(GlintScene *scene) {
    Estimate found = estimate_by(scene, GLINT_SAMPLING_SOBOL, GI_TECHNIQUE_BOTH);
    glint_scene_destroy(scene);
    return found;
}

/* Five deviations of the difference: chance alone gets there once in a million tests. */
static void check_same(const char *what, const Estimate *a, const Estimate *b) {
    double deviation = sqrt((a->variance + b->variance) / PIXELS);
    if (!(fabs(a->mean - b->mean) <= 5 * deviation + 1e-5 * fabs(a->mean))) {
        test_fail(
            __FILE__, __LINE__, "%s: %g and %g, deviation %g", what, a->mean, b->mean, deviation);
    }
}

static void check_mean(const char *what, const Estimate *a, double mean) {
    check_same(what, a, &(Estimate){mean, 0});
}

static const char *const all_years[] = {
    "2011", "2012", "material", "2013", "2017", "2017b", "2018", "2018b", "2019", "glint"};
enum { YEARS = sizeof all_years / sizeof all_years[0] };

#define PATH(depth) "<integrator type='PathIntegrator'><maxDepth>" depth "</maxDepth></integrator>"

/* ---------------------------------------------------------------- rooms */

/* Six planes that look at the origin, which lies on the one below. */
static void room_text(char *to, size_t size) {
    for (int i = 0; i < 6; i++) {
        int axis = i / 2, side = i % 2 ? 1 : -1;
        double place[3] = {0, 0, 0}, normal[3] = {0, 0, 0};
        place[axis] = i == 4 ? 0 : 5 * side;
        normal[axis] = -side;
        int length = snprintf(to, size,
            "<surface type='Plane'><point>%g %g %g</point><normal>%g %g %g</normal>"
            "<shader ref='s'/></surface>",
            place[0], place[1], place[2], normal[0], normal[1], normal[2]);
        to += length;
        size -= (size_t)length;
    }
}

/* A closed room of one albedo, whose walls shine by an ambient light: the surfaces that a path may
 * meet are the terms of a geometric series. Up to four of them there is no chance in it. */
static void series(void) {
    const double a = 0.7;
    static char room[4000];
    room_text(room, sizeof room);
    for (int y = 0; y < YEARS; y++) {
        for (int depth = 1; depth <= 40; depth = depth < 5 ? depth + 1 : 8 * depth) {
            char what[60];
            snprintf(what, sizeof what, "%s, depth %d", all_years[y], depth);
            Estimate found = estimate(point_scene(all_years[y], 1,
                "<integrator type='PathIntegrator'><maxDepth>%d</maxDepth></integrator>"
                "<shader name='s' type='Lambertian'><diffuseColor>%g %g %g</diffuseColor></shader>"
                "<light type='AmbientLight'/>%s",
                depth, a, a, a, room));
            check_mean(what, &found, 3 * a * (1 - pow(a, depth)) / (1 - a));
            if (depth <= 4) CHECK(found.variance < 1e-9);
        }
    }
}

/* ---------------------------------------------------------------- furnaces */

/* A map of six faces of side x side texels. One of them, high up, has the brightness `sun`. */
static const char *write_map(const char *name, int side, float rest, float sun) {
    static char path[600];
    snprintf(path, sizeof path, "%s/%s", test_scratch_dir(), name);
    FILE *file = fopen(path, "wb");
    CHECK(file != NULL);
    if (file == NULL) return path;
    fprintf(file, "PF\n%d %d\n-1\n", 3 * side, 4 * side);
    for (int row = 0; row < 4 * side; row++) {
        for (int column = 0; column < 3 * side; column++) {
            float value = row == 1 && column == side + 1 ? sun : rest;
            for (int c = 0; c < 3; c++) fwrite(&value, sizeof value, 1, file);
        }
    }
    CHECK(fclose(file) == 0);
    return path;
}

#define MAP "<environment type='Cubemap'><filename>%s</filename></environment>"

/* Shaders that send back all that they get, or less. */
static const struct {
    const char *xml;
    double albedo; /* 0: less than 1 */
} honest[] = {
    {"<shader type='Lambertian'><diffuseColor>1 1 1</diffuseColor></shader>", 1},
    {"<shader type='Lambertian'><diffuseColor>.6 .6 .6</diffuseColor></shader>", 0.6},
    {"<shader type='Glass'><refractiveIndex>1.5</refractiveIndex></shader>", 1},
    {"<shader type='Glass'><refractiveIndex>.7</refractiveIndex></shader>", 1},
    {"<shader type='Glazed'><refractiveIndex>1.5</refractiveIndex><substrate type='Lambertian'/>"
     "</shader>",
        1},
    {"<shader type='Phong'><diffuseColor>.5 .5 .5</diffuseColor><specularColor>.5 .5 .5"
     "</specularColor><exponent>6</exponent></shader>",
        0},
    {"<shader type='Phong'><diffuseColor>0 0 0</diffuseColor><exponent>100</exponent></shader>", 0},
    {"<shader type='MicrofacetGGX'><alpha>.3</alpha><nt>1e9</nt></shader>", 0},
    {"<shader type='MicrofacetGGX'><alpha>.001</alpha><nt>1e9</nt></shader>", 0},
    {"<shader type='MicrofacetBeckmann'><alpha>.5</alpha><nt>1e9</nt></shader>", 0},
    {"<shader type='Glazed'><refractiveIndex>1.5</refractiveIndex><substrate "
     "type='MicrofacetGGX'><alpha>.3</alpha><nt>1e9</nt></substrate></shader>",
        0},
};

static void check_furnace(size_t i, const char *light, bool by_chance) {
    static char text[4000];
    snprintf(text, sizeof text,
        "<scene dialect='glint'><camera type='PerspectiveCamera'><viewPoint>0 0 5</viewPoint>"
        "<viewWidth>.28</viewWidth><viewHeight>.28</viewHeight></camera><image>16 16</image>"
        "<samples>16</samples>%s" PATH("4096") "<surface type='Sphere'>%s</surface></scene>",
        light, honest[i].xml);
    Picture picture = picture_of_text(text);
    char what[60];
    snprintf(what, sizeof what, "shader %zu, by chance %d", i, by_chance);
    Estimate found = estimate_of(&picture);
    picture_free(&picture);
    if (honest[i].albedo > 0) {
        check_mean(what, &found, 3 * honest[i].albedo);
        if (!by_chance) CHECK(found.variance < 1e-6);
        return;
    }
    double most = 3 + 5 * sqrt(found.variance / PIXELS) + 1e-5;
    if (!(found.mean <= most && found.mean > 0.1)) {
        test_fail(__FILE__, __LINE__, "%s: %g", what, found.mean);
    }
}

/* Under light that comes alike from everywhere nothing is brighter than that light, at any angle:
 * from a colour around the scene, and from a map, which is drawn as light too. */
static void furnace(void) {
    char map[700];
    snprintf(map, sizeof map, MAP, write_map("white.pfm", 2, 1, 1));
    for (size_t i = 0; i < sizeof honest / sizeof honest[0]; i++) {
        check_furnace(i, "<backColor>1 1 1</backColor>", false);
        check_furnace(i, map, true);
    }
}

static int visible_pixels(const char *solid, double s, double p) {
    static char text[4000];
    snprintf(text, sizeof text,
        "<scene dialect='glint'><camera type='PerspectiveCamera'><viewPoint>%.17g %.17g %.17g"
        "</viewPoint><viewDir>-1 -2 -5</viewDir><viewWidth>.45</viewWidth><viewHeight>.45"
        "</viewHeight></camera><image>48 48</image><backColor>1 1 1</backColor>" PATH(
            "4096") "<surface type='Group'><translate>%.17g %.17g %.17g</translate><rotate>20 30 "
                    "40</rotate>"
                    "<scale>%g %g %g</scale>%s</surface></scene>",
        p + s, -2 * p + 2 * s, 3 * p + 5 * s, p, -2 * p, 3 * p, s, s, s, solid);
    Picture picture = picture_of_text(text);
    int seen = 0;
    for (int i = 0; i < 48 * 48; i++) {
        seen += !(fabs(picture_at(&picture, i % 48, i / 48).x - 1) < 1e-5);
    }
    picture_free(&picture);
    return seen;
}

/* Solids of glass in such light cannot be seen: rays that go through a surface neither meet it
 * again nor miss the other side, whatever the size and the place. In a smooth mesh a few are
 * caught: by the blended normals they are inside where by the triangles they are outside. */
static void glass_is_invisible(void) {
    static const char *const solids[] = {"<surface type='Sphere'>",
        "<surface type='Box'><minPt>-1 -.8 -.9</minPt><maxPt>.7 1 .6</maxPt>",
        "<surface type='Cylinder'><height>1.5</height>", "<surface type='Cone'><tipz>1</tipz>",
        "<surface type='Mesh'><data>%s/tests/golden/gem.obj</data>"};
    static const double sizes[] = {1, 1e5, 1e-4, 1e30, 1}, places[] = {0, 0, 0, 0, 1e6};
    for (int i = 0; i < 5; i++) {
        char start[1000], solid[1200];
        snprintf(
            start, sizeof start, i == 4 ? solids[4] : "%s", i == 4 ? test_source_dir() : solids[i]);
        snprintf(solid, sizeof solid,
            "%s<shader type='Glass'><refractiveIndex>1.5</refractiveIndex></shader></surface>",
            start);
        for (int k = 0; k < 5; k++) {
            int seen = visible_pixels(solid, sizes[k], places[k]);
            if (seen > (i == 4 ? 2 : 0)) {
                test_fail(__FILE__, __LINE__, "solid %d, size %g, at %g: %d pixels", i, sizes[k],
                    places[k], seen);
            }
        }
    }
}

/* ---------------------------------------------------------------- rectangles of light */

/* The part of the hemisphere's cosine-weighted light that a rectangle covers which is parallel to
 * the surface, with a corner at height 1 over the point and sides x and y. */
static double corner_part(double x, double y) {
    double a = sqrt(1 + x * x), b = sqrt(1 + y * y);
    return (x / a * atan(y / a) + y / b * atan(x / b)) / (2 * pi);
}

static double rectangle_part(const double s[4]) {
    return corner_part(s[1], s[3]) - corner_part(s[0], s[3]) - corner_part(s[1], s[2]) +
           corner_part(s[0], s[2]);
}

/* A plane under a rectangle of radiance 2. Years that write kd where radiometry has kd / pi make it
 * brighter by pi; on paths no year does. */
static void rectangle_over_plane(void) {
    static const double sides[][4] = {
        {-1, 1, -0.5, 1}, {-0.2, 0.1, 0.3, 0.9}, {0.5, 4, -3, 5}, {2, 2.01, 0, 0.01}};
    static const char *const years[] = {"glint", "2018b", "2017b"};
    for (int i = 0; i < 3 * 4 * 2; i++) {
        int year = i % 3, path = i / 3 % 2;
        const double *s = sides[i / 6];
        char what[60];
        snprintf(what, sizeof what, "%s, rectangle %d, path %d", years[year], i / 6, path);
        Estimate found = estimate(point_scene(years[year], 64,
            "%s<surface type='Plane'><shader type='Lambertian'><diffuseColor>.5 .5 .5"
            "</diffuseColor></shader></surface><light type='RectangleLight'><position>%g %g 1"
            "</position><intensity>2 2 2</intensity><upDir>0 1 0</upDir><width>%g</width>"
            "<height>%g</height></light>",
            path ? PATH("1") : "", (s[0] + s[1]) / 2, (s[2] + s[3]) / 2, s[1] - s[0], s[3] - s[2]));
        check_mean(what, &found, 3 * rectangle_part(s) * (year == 2 && !path ? pi : 1));
    }
}

/* A light without extent, as good as, must not make numbers that are none. */
static void tiny_rectangle(void) {
    for (int path = 0; path < 2; path++) {
        Estimate found = estimate(point_scene("glint", 1,
            "%s<surface type='Plane'><shader type='MicrofacetGGX'><alpha>.3</alpha><nt>1.5</nt>"
            "<diffuseColor>.5 .5 .5</diffuseColor></shader></surface><light type='RectangleLight'>"
            "<position>1 1 1</position><width>1e-90</width><height>1e-90</height></light>",
            path ? PATH("3") : ""));
        CHECK(isfinite(found.mean) && found.mean < 1e-100);
    }
}

/* ---------------------------------------------------------------- ways to the same light */

static const struct {
    const char *type, *values;
} surfaces[] = {
    {"Lambertian", "<diffuseColor>.5 .7 .3</diffuseColor>"},
    {"Phong", "<diffuseColor>.2 .2 .2</diffuseColor><exponent>20</exponent>"},
    {"MicrofacetGGX", "<alpha>.3</alpha><nt>2.5</nt><diffuseColor>.1 .2 .3</diffuseColor>"},
    {"MicrofacetBeckmann", "<alpha>.4</alpha><nt>1.5</nt><diffuseColor>.1 .2 .3</diffuseColor>"},
    {"CookTorrance", "<roughness>.4</roughness><refractiveIndex>1.5</refractiveIndex>"},
    {"Lambertian", "<diffuseColor>.1 .1 .1</diffuseColor><mirrorCoefficient>.5 .5 .5"
                   "</mirrorCoefficient>"},
};
enum { SURFACES = 5, MIRROR = SURFACES };

/* A plane of that surface, partly shaded. */
static const char *stage_text(int surface) {
    static char text[1000];
    snprintf(text, sizeof text,
        "<surface type='Plane'><shader type='%s'>%s</shader></surface><surface type='Box'>"
        "<minPt>.3 .4 .5</minPt><maxPt>.8 1.5 .9</maxPt></surface>",
        surfaces[surface].type, surfaces[surface].values);
    return text;
}

/* Under a rectangle, or a sky with a sun. */
static GlintScene *lit_scene(int surface, bool sky, const char *integrator, int samples) {
    char light[1000];
    if (sky) {
        snprintf(light, sizeof light, MAP, write_map("sun.pfm", 4, 0.2f, 40));
    } else {
        snprintf(light, sizeof light,
            "<light type='RectangleLight'><position>.5 .8 1.5</position><intensity>3 4 5"
            "</intensity><normalDir>-.2 -.3 -1</normalDir><upDir>0 1 0</upDir><width>1.2</width>"
            "<height>1</height></light>");
    }
    return point_scene("glint", samples, "%s%s%s", integrator, stage_text(surface), light);
}

static void check_techniques(const char *what, GlintScene *scene) {
    Estimate found[3];
    for (int i = 0; i < 3; i++) {
        found[i] = estimate_by(scene, GLINT_SAMPLING_RANDOM, (GiTechnique)i);
    }
    glint_scene_destroy(scene);
    check_same(what, &found[GI_TECHNIQUE_LIGHT], &found[GI_TECHNIQUE_BSDF]);
    check_same(what, &found[GI_TECHNIQUE_LIGHT], &found[GI_TECHNIQUE_BOTH]);
    double least = fmin(found[GI_TECHNIQUE_LIGHT].variance, found[GI_TECHNIQUE_BSDF].variance);
    double both = found[GI_TECHNIQUE_BOTH].variance;
    if (!(both <= 4 * least)) {
        test_fail(__FILE__, __LINE__, "%s: variance %g, of the better one %g", what, both, least);
    }
}

/* Points of the lights, directions of the surface, and both together have one mean, and both
 * together are not much worse than the better one. */
static void techniques(void) {
    static const char *const integrators[] = {"", PATH("1"), PATH("3")};
    for (int i = 0; i < SURFACES * 2 * 3; i++) {
        int surface = i / 6, sky = i % 2, integrator = i / 2 % 3;
        char what[100];
        snprintf(what, sizeof what, "%s, light %d, integrator %d", surfaces[surface].type, sky,
            integrator);
        check_techniques(what, lit_scene(surface, sky, integrators[integrator], 64));
    }
}

/* A lamp that lies in the ceiling is there for both ways to find it. */
static void lamp_in_the_ceiling(void) {
    static const char *const ceilings[] = {
        "<surface type='Plane'><point>0 0 4</point><normal>0 0 -1</normal></surface>",
        "<surface type='Box'><minPt>-9 -9 4</minPt><maxPt>9 9 5</maxPt></surface>",
        "<surface type='Disc'><point>0 0 4</point><radius>9</radius></surface>"};
    for (int i = 0; i < 3; i++) {
        check_techniques(ceilings[i],
            point_scene("glint", 64,
                PATH("1") "<surface type='Plane'/>%s<light type='RectangleLight'>"
                          "<position>.5 0 4</position><upDir>0 1 0</upDir><width>4</width>"
                          "<height>3</height></light>",
                ceilings[i]));
    }
}

/* Paths that meet one surface see what direct light is. */
static void direct_light(void) {
    for (int surface = 0; surface < SURFACES; surface++) {
        for (int sky = 0; sky < 2; sky++) {
            Estimate direct = estimate(lit_scene(surface, sky, "", 64));
            Estimate path = estimate(lit_scene(surface, sky, PATH("1"), 64));
            check_same(surfaces[surface].type, &direct, &path);
        }
        /* Without chance it is the same to the last bit. */
        Picture pictures[2];
        for (int k = 0; k < 2; k++) {
            GlintScene *scene = point_scene("glint", 1,
                "%s%s<light><position>1 2 3</position></light><light type='DirectionalLight'>"
                "<direction>-1 0 1</direction></light><light type='AmbientLight'/>",
                k == 0 ? "" : PATH("1"), stage_text(surface));
            pictures[k] = picture_of_scene(scene, NULL);
            glint_scene_destroy(scene);
        }
        CHECK(picture_equal(&pictures[0], &pictures[1]));
        for (int k = 0; k < 2; k++) picture_free(&pictures[k]);
    }
}

/* A map of one colour is that colour around the scene, for paths of any depth. */
static void constant_sky(void) {
    char map[700];
    snprintf(map, sizeof map, MAP, write_map("white.pfm", 2, 1, 1));
    for (int surface = 0; surface <= MIRROR; surface++) {
        const char *stage = stage_text(surface);
        Estimate color =
            estimate(point_scene("glint", 64, PATH("4") "<backColor>1 1 1</backColor>%s", stage));
        Estimate mapped = estimate(point_scene("glint", 64, PATH("4") "%s%s", map, stage));
        check_same(surfaces[surface].type, &color, &mapped);
    }
}

/* A path that has to choose goes each way as often as makes up for what it leaves out, also where a
 * colour is negative. */
static void choices(void) {
    static const char *const shaders[] = {
        "<shader type='Lambertian'><diffuseColor>0 0 0</diffuseColor><mirrorCoefficient>-1 .3 -1"
        "</mirrorCoefficient></shader>",
        "<shader type='Glazed'><refractiveIndex>1.5</refractiveIndex><substrate type='Glazed'>"
        "<refractiveIndex>2</refractiveIndex><substrate type='Lambertian'><diffuseColor>0 0 0"
        "</diffuseColor></substrate></substrate></shader>",
        "<shader type='Glass'><refractiveIndex>2.4</refractiveIndex></shader>",
    };
    for (int i = 0; i < 3; i++) {
        Estimate found[2];
        for (int k = 0; k < 2; k++) {
            found[k] = estimate(point_scene("glint", k == 0 ? 1 : 64,
                "%s<backColor>.3 .7 .5</backColor><surface type='Plane'>%s</surface><surface "
                "type='Plane'><point>0 0 -1</point><shader type='RGBNormals'/></surface>",
                k == 0 ? "" : PATH("12"), shaders[i]));
        }
        check_same(shaders[i], &found[0], &found[1]);
    }
}

/* ---------------------------------------------------------------- samples */

/* Points of a low-discrepancy sequence have the same mean as random ones and less noise. */
static void sampling(void) {
    for (int surface = 0; surface < SURFACES; surface++) {
        for (int samples = 16; samples <= 64; samples *= 4) {
            GlintScene *scene = lit_scene(surface, false, "", samples);
            Estimate sobol = estimate_by(scene, GLINT_SAMPLING_SOBOL, GI_TECHNIQUE_BOTH);
            Estimate random = estimate_by(scene, GLINT_SAMPLING_RANDOM, GI_TECHNIQUE_BOTH);
            glint_scene_destroy(scene);
            check_same(surfaces[surface].type, &sobol, &random);
            if (!(random.variance > 1.5 * sobol.variance)) {
                test_fail(__FILE__, __LINE__, "%s, %d samples: variance %g, of random ones %g",
                    surfaces[surface].type, samples, sobol.variance, random.variance);
            }
        }
    }
}

const GiTest tests_transport[] = {TEST(series), TEST(furnace), TEST(glass_is_invisible),
    TEST(rectangle_over_plane), TEST(tiny_rectangle), TEST(techniques), TEST(lamp_in_the_ceiling),
    TEST(direct_light), TEST(constant_sky), TEST(choices), TEST(sampling), TEST_END};
