/* SPDX-License-Identifier: MIT
 * The shaders against their formulas in docs/scene-format.md, written out here once more in long
 * double, and against physics: reciprocity, energy, and nothing but numbers at grazing angles. */
#include "render/stage.h"
#include "shadings.h"
#include "test.h"

#include "shade/shade.h"

#include <string.h>

/* ---------------------------------------------------------------- the rules of the years */

static void rules_of_years(void) {
    /* name, and a letter for each that holds: Schlick, glass by Flag, glass Ends, glazed Behind,
     * glazed Adds, weights (W), visible areas (V), environment lights (L), kd over Pi, black from
     * the bacK, highlight Times n.l, highlight needs ligHt, light faLls off (D) */
    static const char *const expected[][2] = {{"2011", "SFEW"}, {"2012", "SFEW"},
        {"material", "BTD"}, {"2013", "B"}, {"2017", "BHD"}, {"2017b", "BHD"}, {"2018", "BPKHD"},
        {"2018b", "BAVLPKHD"}, {"2019", "BPKTHD"}, {"glint", "BVLH"}};
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        GlintDialect year;
        CHECK(glint_dialect_from_name(expected[i][0], &year));
        const GiRules *r = gi_dialect_rules(year);
        char text[16], *end = text;
        if (r->schlick) *end++ = 'S';
        if (r->glass_by_flag) *end++ = 'F';
        if (r->glass_ends) *end++ = 'E';
        if (r->glazed_behind) *end++ = 'B';
        if (r->glazed_adds) *end++ = 'A';
        if (r->least_weight == 0.01) *end++ = 'W';
        if (r->area_light_visible) *end++ = 'V';
        if (r->environment_lights) *end++ = 'L';
        if (r->diffuse_over_pi) *end++ = 'P';
        if (r->black_from_behind) *end++ = 'K';
        if (r->phong_cosine) *end++ = 'T';
        if (r->highlight_needs_light) *end++ = 'H';
        if (r->falloff) *end++ = 'D';
        *end = 0;
        CHECK_TEXT(text, expected[i][1]);
        CHECK(r->last_level == 12);
        CHECK(r->least_weight == 0.01 || r->least_weight == 0);
    }
}

/* ---------------------------------------------------------------- the formulas once more */

typedef struct Long {
    long double x, y, z;
} Long;

static const long double pi = 3.14159265358979323846264338327950288L;

static long double dot(Long a, Long b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static Long unit(long double x, long double y, long double z) {
    long double length = sqrtl(x * x + y * y + z * z);
    return (Long){x / length, y / length, z / length};
}

static Long long_of(GiVec v) { return unit(v.x, v.y, v.z); }

static long double positive(long double x) { return x > 0 ? x : 0; }

/* The form with g of the course's text. */
static long double fresnel(long double c, long double m) {
    long double square = m * m - 1 + c * c;
    if (square < 0) return 1;
    long double g = sqrtl(square), a = (g - c) / (g + c);
    long double b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return a * a * (1 + b * b) / 2;
}

static bool is_one_of(GlintDialect year, const char *years) {
    char name[16] = " ";
    strcat(strcat(name, glint_dialect_name(year)), " ");
    return strstr(years, name) != NULL;
}

static const char over_pi[] = " 2018 2018b 2019 ", black_behind[] = " 2018 2018b 2019 ";
static const char times_cosine[] = " material 2019 ", open_highlight[] = " 2011 2012 2013 ";

/* The angles of the formulas. */
typedef struct Angles {
    long double nl, nv, nh, vh;
} Angles;

/* L for E = 1 as kd times `diffuse` plus ks times `specular`. */
typedef struct Parts {
    long double diffuse, specular;
} Parts;

static Parts lambertian(GlintDialect year, Angles a) {
    return (Parts){positive(a.nl) / (is_one_of(year, over_pi) ? pi : 1), 0};
}

static Parts phong(const GiShader *shader, GlintDialect year, Angles a) {
    long double power = powl(positive(a.nh), shader->exponent);
    if (shader->exponent == 0) power = 1;
    Parts parts = {lambertian(year, a).diffuse, power};
    if (is_one_of(year, times_cosine)) parts.specular *= positive(a.nl);
    if (!is_one_of(year, open_highlight) && a.nl <= 0) parts.specular = 0;
    return parts;
}

static long double tangent(long double cosine) { return sqrtl(1 - cosine * cosine) / cosine; }

static long double beckmann_g1(long double cosine, long double alpha) {
    long double a = 1 / (alpha * tangent(cosine));
    return a < 1.6L ? (3.535L * a + 2.181L * a * a) / (1 + 2.276L * a + 2.577L * a * a) : 1;
}

static long double ggx_g1(long double cosine, long double alpha) {
    long double t = alpha * tangent(cosine);
    return 2 / (1 + sqrtl(1 + t * t));
}

static Parts microfacet(const GiShader *shader, Angles a) {
    if (a.nl <= 0 || a.nv <= 0) return (Parts){0, 0};
    long double alpha = shader->roughness, alpha2 = alpha * alpha, d, g;
    long double cm2 = a.nh * a.nh, t2 = (1 - cm2) / cm2;
    if (shader->type == GLINT_SHADER_BECKMANN) {
        d = expl(-t2 / alpha2) / (pi * alpha2 * cm2 * cm2);
        g = beckmann_g1(a.nl, alpha) * beckmann_g1(a.nv, alpha);
    } else {
        d = alpha2 / (pi * cm2 * cm2 * (alpha2 + t2) * (alpha2 + t2));
        g = ggx_g1(a.nl, alpha) * ggx_g1(a.nv, alpha);
    }
    long double f = fresnel(a.vh, shader->index);
    return (Parts){a.nl / pi, f * d * g / (4 * a.nl * a.nv) * a.nl};
}

static Parts cook_torrance(const GiShader *shader, Angles a) {
    if (a.nl <= 0) return (Parts){0, 0};
    if (a.nv < 0) return (Parts){a.nl, 0};
    long double s2 = (long double)shader->roughness * shader->roughness, nh2 = a.nh * a.nh;
    long double f = fresnel(a.nv, shader->index);
    long double d = expl((nh2 - 1) / (s2 * nh2)) / (s2 * nh2 * nh2);
    long double g = fminl(1, fminl(2 * a.nh * a.nv / a.vh, 2 * a.nh * a.nl / a.vh));
    return (Parts){a.nl, f * d * g / (pi * a.nv * a.nl) * a.nl};
}

static Parts expected_parts(const GiShader *shader, GlintDialect year, Angles a) {
    if (is_one_of(year, black_behind) && a.nv < 0) return (Parts){0, 0};
    switch (shader->type) {
    case GLINT_SHADER_LAMBERTIAN: return lambertian(year, a);
    case GLINT_SHADER_PHONG: return phong(shader, year, a);
    case GLINT_SHADER_BECKMANN:
    case GLINT_SHADER_GGX: return microfacet(shader, a);
    case GLINT_SHADER_COOK_TORRANCE: return cook_torrance(shader, a);
    default: return (Parts){0, 0};
    }
}

static const GlintShaderType local_types[] = {GLINT_SHADER_LAMBERTIAN, GLINT_SHADER_PHONG,
    GLINT_SHADER_BECKMANN, GLINT_SHADER_GGX, GLINT_SHADER_COOK_TORRANCE};
enum { LOCAL_TYPES = sizeof local_types / sizeof local_types[0] };

static void check_formula(Random *random, GlintShaderType type, GlintDialect year) {
    GiShader shader = shading_random_shader(random, type);
    GiVec v = shading_direction(random), l = shading_direction(random);
    GiShading at = shading_of(&shader, year, v);
    at.normal = shading_direction(random);
    at.diffuse = random_vec(random, 0, 1); /* a texture's */
    if (random_below(random, 3)) {         /* most of what shows is on the front */
        if (gi_dot(at.normal, v) < 0) at.toward_viewer = v = gi_negate(v);
        if (gi_dot(at.normal, l) < 0) l = gi_negate(l);
    }
    Long ln = long_of(at.normal), lv = long_of(v), ll = long_of(l);
    Long h = unit(ll.x + lv.x, ll.y + lv.y, ll.z + lv.z);
    Angles a = {dot(ln, ll), dot(ln, lv), dot(ln, h), dot(lv, h)};
    if (fabsl(a.nl) < 1e-3L || fabsl(a.nv) < 1e-3L || a.vh < 1e-2L) return;
    Parts parts = expected_parts(&shader, year, a);
    GiVec actual = gi_bsdf_evaluate(&at, l);
    const double *ks = &shader.specular.x, *kd = &at.diffuse.x, *color = &actual.x;
    for (int i = 0; i < 3; i++) {
        long double expected = kd[i] * parts.diffuse + ks[i] * parts.specular;
        if (!(fabsl(color[i] - expected) <= 1e-11L * expected + 1e-300L)) {
            test_fail(__FILE__, __LINE__, "shader %d of %s: %.17g, not %.17Lg (n.l %Lg, n.v %Lg)",
                (int)type, glint_dialect_name(year), color[i], expected, a.nl, a.nv);
        }
    }
}

static void formulas(void) {
    Random random = {21};
    for (int year = SHADING_FIRST_YEAR; year <= SHADING_LAST_YEAR; year++) {
        for (int i = 0; i < LOCAL_TYPES * 2000; i++) {
            check_formula(&random, local_types[i % LOCAL_TYPES], (GlintDialect)year);
        }
    }
}

/* The kernels have the formulas of Lambert and Phong once more: what they say of many points is
 * what gi_bsdf_evaluate says of each, to the bit. */
typedef struct Shone {
    GiPoints points;
    GiLit lit;
} Shone;

static void check_point(const Shone *shone, const GiPointLight *light, const GiShading *seen, int i,
    double away, int *next) {
    const GiPoints *p = &shone->points;
    const GiLit *lit = &shone->lit;
    GiShading at = *seen;
    at.normal = gi_vec(p->nx[i], p->ny[i], p->nz[i]);
    at.toward_viewer = gi_vec(p->vx[i], p->vy[i], p->vz[i]);
    GiVec d = gi_sub(light->position, gi_vec(p->px[i], p->py[i], p->pz[i]));
    if (light->parallel) d = light->position;
    double square = light->parallel ? 1 : gi_dot(d, d), inverse = 1 / sqrt(square);
    GiVec e = light->falls ? gi_scale(light->intensity, 1 / square) : light->intensity;
    GiVec adds = gi_multiply(e, gi_bsdf_evaluate(&at, gi_scale(d, inverse)));
    if (!(square > 0) || gi_vec_is_zero(adds)) return;
    int k = (*next)++;
    CHECK(k < lit->count && lit->point[k] == (uint32_t)i);
    CHECK_INT(lit->arrives[i], 0);
    const double got[4] = {lit->red[i], lit->green[i], lit->blue[i], lit->t_min[i]};
    const double due[4] = {adds.x, adds.y, adds.z, (away > 0 ? away : p->error[i]) * inverse};
    CHECK(memcmp(got, due, sizeof got) == 0);
}

static void check_kernel(Shone *shone, Random *random, const GiKernel *kernel) {
    GiShader shader = shading_random_shader(random, local_types[random_below(random, 2)]);
    if (shader.type == GLINT_SHADER_PHONG) shader.exponent = random_below(random, 1025);
    GlintDialect year = (GlintDialect)(SHADING_FIRST_YEAR + random_below(random, 10));
    GiShading at = shading_of(&shader, year, gi_vec(0, 0, 1));
    GiGloss gloss;
    CHECK(gi_lights_gloss(at.rules, &shader, &gloss));
    GiPointLight light = {.position = random_vec(random, -1, 1),
        .intensity = random_vec(random, 0, 2),
        .falls = random_below(random, 2) != 0};
    if (random_below(random, 3) == 0) {
        light.position = gi_normalize(light.position);
        light.falls = false;
        light.parallel = true;
        light.part = 0.01;
    }
    enum { COUNT = 100 };
    GiPoints *p = &shone->points;
    for (int i = 0; i < COUNT; i++) {
        GiVec place = random_below(random, 20) ? random_vec(random, -2, 2) : light.position;
        GiVec n = shading_direction(random), v = shading_direction(random);
        /* Viewer and light on opposite sides: no half vector. */
        if (random_below(random, 10) == 0) v = gi_normalize(gi_sub(place, light.position));
        p->px[i] = place.x, p->py[i] = place.y, p->pz[i] = place.z;
        p->nx[i] = n.x, p->ny[i] = n.y, p->nz[i] = n.z;
        p->vx[i] = v.x, p->vy[i] = v.y, p->vz[i] = v.z;
        p->error[i] = random_real(random, 0, 1e-9);
    }
    int begin = random_below(random, 20), end = begin + random_below(random, COUNT - begin);
    shone->lit.count = 0;
    memset(shone->lit.arrives, 1, sizeof shone->lit.arrives);
    kernel->light(p, begin, end, &light, &gloss, &shone->lit);
    int next = 0;
    for (int i = begin; i < end; i++) check_point(shone, &light, &at, i, gloss.away, &next);
    CHECK_INT(next, shone->lit.count);
}

static void kernels_agree(void) {
    static Shone shone;
    const GiKernel *kernel;
    for (int k = 0; (kernel = gi_kernel_at(k)) != NULL; k++) {
        Random random = {22};
        for (int i = 0; i < 1000; i++) check_kernel(&shone, &random, kernel);
    }
}

static void types_without_light(void) {
    static const GlintShaderType types[] = {
        GLINT_SHADER_RGB_NORMALS, GLINT_SHADER_GLAZED, GLINT_SHADER_GLASS};
    Random random = {23};
    for (int i = 0; i < 3; i++) {
        GiShader shader = shading_random_shader(&random, types[i]);
        GiShading at = shading_of(&shader, GLINT_DIALECT_GLINT, shading_slant(30));
        const double u[3] = {0.5, 0.5, 0.5};
        GiVec l;
        CHECK(gi_vec_is_zero(gi_bsdf_evaluate(&at, shading_slant(20))));
        CHECK(gi_bsdf_density(&at, shading_slant(20)) == 0 && gi_bsdf_sample(&at, u, &l) == 0);
    }
}

/* ---------------------------------------------------------------- physics */

/* Light and viewer may change places (Helmholtz), but for Cook and Torrance's F at n.v. */
static void reciprocity(void) {
    static const GlintShaderType types[] = {
        GLINT_SHADER_LAMBERTIAN, GLINT_SHADER_BECKMANN, GLINT_SHADER_GGX};
    Random random = {24};
    for (int i = 0; i < 30000; i++) {
        GiShader shader = shading_random_shader(&random, types[i % 3]);
        GiVec l = shading_direction(&random), v = shading_direction(&random);
        l.z = fabs(l.z) + 1e-3;
        v.z = fabs(v.z) + 1e-3;
        l = gi_normalize(l);
        v = gi_normalize(v);
        GiShading there = shading_of(&shader, GLINT_DIALECT_GLINT, v), back = there;
        back.toward_viewer = l;
        double a = gi_bsdf_evaluate(&there, l).y / l.z, b = gi_bsdf_evaluate(&back, v).y / v.z;
        CHECK_NEAR(a, b, 1e-12 * b);
    }
}

/* What a shader sends toward v of light that comes alike from everywhere. */
static double albedo(const GiShader *shader, GlintDialect year, GiVec v, int rows) {
    GiShading at = shading_of(shader, year, v);
    return shading_integral(&at, shading_evaluate_red, rows) * gi_bsdf_radiometric(&at);
}

static GiShader one_lobe(GlintShaderType type, double diffuse, double specular) {
    return (GiShader){.type = type,
        .diffuse = {diffuse, diffuse, diffuse},
        .specular = {specular, specular, specular},
        .exponent = 10,
        .roughness = 0.5,
        .index = 1.5,
        .texture = GI_NONE,
        .substrate = GI_NONE};
}

static void furnace_lambertian(void) {
    GiShader white = one_lobe(GLINT_SHADER_LAMBERTIAN, 1, 1);
    for (int year = SHADING_FIRST_YEAR; year <= SHADING_LAST_YEAR; year++) {
        CHECK_NEAR(albedo(&white, (GlintDialect)year, shading_slant(40), 64), 1, 1e-3);
    }
}

/* A layer of microfacets that mirrors all loses what it shadows, and never gains. */
static void furnace_microfacets(void) {
    static const double alphas[] = {0.1, 0.3, 0.5, 1, 2}, degrees[] = {0, 30, 60, 80, 88};
    for (int i = 0; i < 25; i++) {
        for (int type = GLINT_SHADER_BECKMANN; type <= GLINT_SHADER_GGX; type++) {
            GiShader mirror = one_lobe((GlintShaderType)type, 0, 1);
            mirror.roughness = alphas[i % 5];
            mirror.index = 1e6; /* F = 1 */
            double sent = albedo(&mirror, GLINT_DIALECT_GLINT, shading_slant(degrees[i / 5]), 200);
            if (!(sent <= 1.001 && sent > 0.05)) {
                test_fail(__FILE__, __LINE__, "type %d, alpha %g, %g degrees: %g", type,
                    mirror.roughness, degrees[i / 5], sent);
            }
            if (mirror.roughness == 0.1 && degrees[i / 5] == 0) CHECK_NEAR(sent, 1, 0.02);
        }
    }
}

/* Seen from above, a lone highlight of Phong's sends back 8 (1 - 2^-(1+e/2)) / (e + 2) times what a
 * white surface does: too much for small exponents. Cook and Torrance's 1/pi in the place of 1/4
 * sends back up to 4/pi. docs/accuracy.md has these numbers. */
static void furnace_of_history(void) {
    static const double exponents[] = {1, 5, 6, 10, 50};
    for (int i = 0; i < 5; i++) {
        GiShader phong = one_lobe(GLINT_SHADER_PHONG, 0, 1);
        double e = phong.exponent = exponents[i];
        double expected = 8 * (1 - exp2(-1 - e / 2)) / (e + 2);
        CHECK_NEAR(albedo(&phong, GLINT_DIALECT_GLINT, shading_slant(0), 200), expected, 1e-3);
        CHECK((expected > 1) == (e < 6));
        for (int degrees = 15; degrees < 90; degrees += 15) {
            CHECK(albedo(&phong, GLINT_DIALECT_GLINT, shading_slant(degrees), 100) < expected);
        }
    }
    GiShader cook = one_lobe(GLINT_SHADER_COOK_TORRANCE, 0, 1);
    cook.index = 1e6;
    cook.roughness = 0.05;
    CHECK_NEAR(albedo(&cook, GLINT_DIALECT_2017B, shading_slant(0), 400), 1.27, 0.01);
    cook.index = 1.5;
    CHECK_NEAR(albedo(&cook, GLINT_DIALECT_2017B, shading_slant(0), 400), 0.051, 0.001);
}

/* ---------------------------------------------------------------- grazing and extreme values */

static GiVec nasty_direction(Random *random) {
    switch (random_below(random, 5)) {
    case 0: return gi_vec(0, 0, 1);
    case 1: return gi_vec(1, 0, 0);
    case 2: return gi_vec(random_below(random, 2) ? 1 : -1, 0, exp2(-random_below(random, 1074)));
    case 3: return gi_vec(0, exp2(-random_below(random, 1074)), random_below(random, 2) ? 1 : -1);
    default: return shading_direction(random);
    }
}

static double nasty_number(Random *random) {
    static const double numbers[] = {1, 0x1p-1074, 1e-300, 1e-20, 1e-9, 1e-3, 0.9999999999999999,
        1.0000000000000002, 3, 1e9, 1e20, 1e300};
    return numbers[random_below(random, 12)];
}

static void tell_nasty(const GiShading *at, GiVec l, const char *what, double value) {
    const GiShader *shader = at->shader;
    GiVec v = at->toward_viewer;
    test_fail(__FILE__, __LINE__,
        "shader %d, roughness %g, index %g, exponent %g, v %g %g %g, l %g %g %g: %s %g",
        (int)shader->type, shader->roughness, shader->index, shader->exponent, v.x, v.y, v.z, l.x,
        l.y, l.z, what, value);
}

static bool is_number(double x) { return x >= 0 && x < INFINITY; }

static void check_nasty_direction(const GiShading *at, GiVec l) {
    GiVec light = gi_bsdf_evaluate(at, l);
    double density = gi_bsdf_density(at, l);
    if (!is_number(light.x)) tell_nasty(at, l, "light", light.x);
    if (!is_number(density)) tell_nasty(at, l, "density", density);
}

static void check_nasty_draw(Random *random, const GiShading *at) {
    double u[3];
    GiVec l;
    for (int i = 0; i < 3; i++) {
        int edge = random_below(random, 4);
        u[i] = edge == 0 ? 0 : edge == 1 ? 1 - 0x1p-53 : random_real(random, 0, 1);
    }
    double density = gi_bsdf_sample(at, u, &l);
    if (!is_number(density)) tell_nasty(at, l, "drawn with density", density);
    if (density == 0) return;
    double light = gi_bsdf_evaluate(at, l).x / density;
    if (!is_number(light)) tell_nasty(at, l, "drawn light", light);
    CHECK_NEAR(gi_length(l), 1, 1e-15);
}

static void always_finite(void) {
    Random random = {25};
    for (int i = 0; i < 400000; i++) {
        GiShader shader = shading_random_shader(&random, local_types[i % LOCAL_TYPES]);
        if (random_below(&random, 2)) shader.roughness = nasty_number(&random);
        if (random_below(&random, 2)) shader.index = nasty_number(&random);
        if (random_below(&random, 2)) shader.exponent = nasty_number(&random);
        if (random_below(&random, 8) == 0) shader.specular = gi_vec(0, 0, 0);
        if (random_below(&random, 8) == 0) shader.diffuse = gi_vec(0, 0, 0);
        GlintDialect year = (GlintDialect)(SHADING_FIRST_YEAR + random_below(&random, 10));
        GiShading at = shading_of(&shader, year, nasty_direction(&random));
        check_nasty_direction(&at, nasty_direction(&random));
        check_nasty_direction(&at, at.toward_viewer);
        check_nasty_direction(&at, gi_negate(at.toward_viewer));
        check_nasty_draw(&random, &at);
    }
}

const GiTest tests_bsdf[] = {TEST(rules_of_years), TEST(formulas), TEST(kernels_agree),
    TEST(types_without_light), TEST(reciprocity), TEST(furnace_lambertian),
    TEST(furnace_microfacets), TEST(furnace_of_history), TEST(always_finite), TEST_END};
