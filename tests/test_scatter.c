/* SPDX-License-Identifier: MIT
 * Which rays go on from glass, glazing and mirrors: Fresnel's and Snell's laws, and the rules of
 * the years for sides, levels and weights. */
#include "shadings.h"
#include "test.h"

#include "shade/dielectric.h"

static const double index_of_glass = 1.5;

static GiShader glass_of(double index) {
    return (GiShader){.type = GLINT_SHADER_GLASS, .index = index, .substrate = GI_NONE};
}

static const GiArrival from_camera = {.level = 1, .weight = 1};

static GiScatter scatter_of(
    const GiShader *shader, GlintDialect year, GiVec v, const GiArrival *arrival) {
    GiShading at = shading_of(shader, year, v);
    GiScatter scatter;
    gi_bsdf_scatter(&at, arrival, &scatter, NULL);
    return scatter;
}

static double gray_of(GiVec factor) {
    CHECK(factor.x == factor.y && factor.y == factor.z);
    return factor.x;
}

/* ---------------------------------------------------------------- the laws */

static void fresnel_and_schlick(void) {
    Random random = {41};
    for (int i = 0; i < 20000; i++) {
        double c = random_real(&random, 0.001, 1), m = exp2(random_real(&random, -2, 3));
        if (i % 16 == 0) c = 1;
        long double square = (long double)m * m - 1 + (long double)c * c, expected = 1;
        if (square >= 0) {
            long double g = sqrtl(square), a = (g - c) / (g + c);
            long double b = (c * (g + c) - 1) / (c * (g - c) + 1);
            expected = a * a * (1 + b * b) / 2;
        }
        if (fabsl(square) > 1e-6L) CHECK_NEAR(gi_dielectric_fresnel(c, m), (double)expected, 1e-12);
        long double r0 = (m - 1.0L) / (m + 1.0L);
        r0 *= r0;
        expected = r0 + (1 - r0) * powl(1.0L - c, 5);
        CHECK_NEAR(gi_dielectric_schlick(c, m), (double)expected, 1e-15);
    }
    CHECK_NEAR(gi_dielectric_fresnel(1, 1.5), 0.04, 1e-16);
    CHECK(gi_dielectric_fresnel(0, 1.5) == 1);
    CHECK(gi_dielectric_fresnel(0.1, 1 / 1.5) == 1);
    CHECK(gi_dielectric_fresnel(0.5, 1) == 0);
    /* At Brewster's angle only light of one polarisation is mirrored. */
    double brewster = 1 / sqrt(1 + 1.5 * 1.5), s = (1 - 1.5 * 1.5) / (1 + 1.5 * 1.5);
    CHECK_NEAR(gi_dielectric_fresnel(brewster, 1.5), s * s / 2, 1e-15);
}

/* The sine of refraction, the plane of incidence, energy, and the way back. */
static void glass_obeys_the_laws(void) {
    Random random = {42};
    for (int i = 0; i < 20000; i++) {
        GlintDialect year = i % 2 ? GLINT_DIALECT_2012 : GLINT_DIALECT_GLINT;
        GiShader glass = glass_of(exp2(random_real(&random, -1, 1.5)));
        GiVec v = shading_direction(&random);
        /* A weight from which no branch falls below the least. */
        GiArrival arrival = {.level = 1, .weight = 1e9, .inside = v.z < 0};
        GiScatter scatter = scatter_of(&glass, year, v, &arrival);
        double e = arrival.inside ? glass.index : 1 / glass.index;
        double sine = e * sqrt(v.x * v.x + v.y * v.y);
        CHECK(scatter.local.shader == NULL);
        if (sine > 1) {
            CHECK(scatter.count == 1 && gray_of(scatter.branch[0].factor) == 1);
            CHECK(scatter.branch[0].inside == arrival.inside);
            continue;
        }
        GiVec t = scatter.branch[0].direction;
        CHECK(t.z * v.z < 0 && scatter.branch[0].inside == !arrival.inside);
        CHECK_NEAR(gi_length(t), 1, 1e-14);
        CHECK_NEAR(sqrt(t.x * t.x + t.y * t.y), sine, 1e-14);
        CHECK_NEAR(t.x * v.y - t.y * v.x, 0, 1e-14);
        CHECK(t.x * v.x + t.y * v.y <= 0);
        CHECK_INT(scatter.count, 2);
        GiVec r = scatter.branch[1].direction;
        CHECK_NEAR(gi_length(gi_sub(r, gi_vec(-v.x, -v.y, v.z))), 0, 1e-15);
        CHECK(scatter.branch[1].inside == arrival.inside);
        CHECK_NEAR(gray_of(scatter.branch[0].factor) + gray_of(scatter.branch[1].factor), 1, 1e-15);
        /* Light that comes back along t leaves along v, in the same parts. */
        if (sine > 0.999 || fabs(v.z) < 0.05) continue;
        GiArrival back = {.level = 1, .weight = 1e9, .inside = !arrival.inside};
        GiScatter again = scatter_of(&glass, year, t, &back);
        GiVec home = again.branch[0].direction;
        CHECK_NEAR(gi_length(gi_sub(home, v)), 0, 1e-12);
        CHECK_NEAR(gray_of(again.branch[0].factor), gray_of(scatter.branch[0].factor), 1e-11);
    }
}

/* ---------------------------------------------------------------- glass by years */

static void glass_sides(void) {
    GiShader glass = glass_of(index_of_glass);
    GiArrival inside = {.level = 2, .weight = 0.5, .inside = true};
    /* 2012 goes by the flag: from behind without it, or from the front with it, all is black. */
    CHECK(scatter_of(&glass, GLINT_DIALECT_2012, shading_slant(120), &from_camera).count == 0);
    CHECK(scatter_of(&glass, GLINT_DIALECT_2012, shading_slant(60), &inside).count == 0);
    CHECK(scatter_of(&glass, GLINT_DIALECT_2012, shading_slant(160), &inside).count == 2);
    /* Others go by the normal. */
    GiScatter scatter = scatter_of(&glass, GLINT_DIALECT_2017B, shading_slant(160), &from_camera);
    CHECK(scatter.count == 2 && !scatter.branch[0].inside && scatter.branch[1].inside);
    scatter = scatter_of(&glass, GLINT_DIALECT_2017B, shading_slant(20), &inside);
    CHECK(scatter.count == 2 && scatter.branch[0].inside && !scatter.branch[1].inside);
    /* Schlick's formula takes the cosine in the air. */
    scatter = scatter_of(&glass, GLINT_DIALECT_2012, shading_slant(160), &inside);
    double sine = index_of_glass * shading_slant(160).x;
    CHECK_NEAR(gray_of(scatter.branch[1].factor),
        gi_dielectric_schlick(sqrt(1 - sine * sine), index_of_glass), 1e-15);
    CHECK_NEAR(scatter.branch[1].weight, 0.5 * gray_of(scatter.branch[1].factor), 1e-16);
    /* Total reflection keeps weight and flag. */
    scatter = scatter_of(&glass, GLINT_DIALECT_2012, shading_slant(110), &inside);
    CHECK(scatter.count == 1 && scatter.branch[0].weight == 0.5 && scatter.branch[0].inside);
}

static void levels_and_weights(void) {
    GiShader glass = glass_of(index_of_glass);
    GiVec v = shading_slant(30); /* R is about 0.04 */
    GiArrival last = {.level = 12, .weight = 1}, before = {.level = 11, .weight = 1};
    GiArrival weak = {.level = 2, .weight = 0.2}, weakest = {.level = 2, .weight = 0.0101};
    CHECK(scatter_of(&glass, GLINT_DIALECT_2012, v, &last).count == 0);
    CHECK(scatter_of(&glass, GLINT_DIALECT_2012, v, &before).count == 2);
    CHECK(scatter_of(&glass, GLINT_DIALECT_2017B, v, &last).count == 2);
    CHECK(scatter_of(&glass, GLINT_DIALECT_2012, v, &weak).count == 1);
    CHECK(scatter_of(&glass, GLINT_DIALECT_2012, v, &weakest).count == 0);
    CHECK(scatter_of(&glass, GLINT_DIALECT_2017B, v, &weakest).count == 2);
    CHECK(scatter_of(&glass, GLINT_DIALECT_GLINT, v, &weakest).count == 2);
}

/* ---------------------------------------------------------------- glazing */

enum { LAYERS = GI_SUBSTRATE_LIMIT };

/* shaders[0] is Lambertian, shaders[i] glazes shaders[i - 1]. */
typedef struct Stack {
    GiShader shaders[LAYERS + 1];
    GiScene scene;
} Stack;

static void stack_init(Stack *stack) {
    *stack = (Stack){.scene = {.memory = NULL}};
    stack->shaders[0] = (GiShader){
        .type = GLINT_SHADER_LAMBERTIAN, .diffuse = {0.5, 0.25, 0.125}, .substrate = GI_NONE};
    for (uint32_t i = 1; i <= LAYERS; i++) {
        stack->shaders[i] = (GiShader){.type = GLINT_SHADER_GLAZED,
            .diffuse = {9, 9, 9},
            .index = index_of_glass,
            .substrate = i - 1};
    }
    stack->scene.shaders.data = stack->shaders;
    stack->scene.shaders.count = LAYERS + 1;
}

static GiScatter scatter_of_stack(
    const Stack *stack, int layer, GlintDialect year, GiVec v, const GiArrival *arrival) {
    GiShading at = shading_of(&stack->shaders[layer], year, v);
    GiScatter scatter;
    at.scene = &stack->scene;
    gi_bsdf_scatter(&at, arrival, &scatter, NULL);
    return scatter;
}

static void glazed_layers(void) {
    Stack stack;
    stack_init(&stack);
    GiVec v = shading_slant(70);
    double r = gi_dielectric_fresnel(v.z, index_of_glass), left = 1;
    GiScatter scatter = scatter_of_stack(&stack, LAYERS, GLINT_DIALECT_GLINT, v, &from_camera);
    CHECK_INT(scatter.count, LAYERS);
    for (int i = 0; i < scatter.count; i++) {
        CHECK_NEAR(gray_of(scatter.branch[i].factor), left * r, 1e-15);
        CHECK_NEAR(scatter.branch[i].weight, left * r, 1e-15);
        CHECK_NEAR(scatter.branch[i].direction.x, -v.x, 1e-16);
        left *= 1 - r;
    }
    CHECK_NEAR(gray_of(scatter.local_factor), left, 1e-15);
    CHECK(scatter.local.shader == &stack.shaders[0] && scatter.local.diffuse.y == 0.25);
    /* Without glazing all is as it was given. */
    scatter = scatter_of_stack(&stack, 0, GLINT_DIALECT_GLINT, v, &from_camera);
    CHECK(scatter.count == 0 && gray_of(scatter.local_factor) == 1);
    CHECK(scatter.local.shader == &stack.shaders[0]);
    /* A chain without an end, which the reader does not let through, leaves nothing. */
    stack.shaders[1].substrate = 1;
    scatter = scatter_of_stack(&stack, 1, GLINT_DIALECT_GLINT, v, &from_camera);
    CHECK(scatter.local.shader == NULL && scatter.count <= GI_BRANCH_LIMIT);
}

static void glazed_years(void) {
    Stack stack;
    stack_init(&stack);
    GiVec v = shading_slant(70), behind = shading_slant(100);
    GiArrival in_glass = {.level = 1, .weight = 1, .inside = true};
    GiArrival last = {.level = 12, .weight = 1}, weak = {.level = 2, .weight = 0.011};
    /* 2012: Schlick, black from behind, the flag stays, levels and weights count. */
    double r = gi_dielectric_schlick(v.z, index_of_glass);
    GiScatter scatter = scatter_of_stack(&stack, 1, GLINT_DIALECT_2012, v, &in_glass);
    CHECK(scatter.count == 1 && scatter.branch[0].inside);
    CHECK_NEAR(gray_of(scatter.branch[0].factor), r, 0);
    CHECK_NEAR(gray_of(scatter.local_factor), 1 - r, 0);
    scatter = scatter_of_stack(&stack, 1, GLINT_DIALECT_2012, behind, &from_camera);
    CHECK(scatter.count == 0 && scatter.local.shader == NULL);
    scatter = scatter_of_stack(&stack, 1, GLINT_DIALECT_2012, v, &last);
    CHECK(scatter.count == 0 && scatter.local.shader == NULL);
    scatter = scatter_of_stack(&stack, 1, GLINT_DIALECT_2012, v, &weak);
    CHECK(scatter.count == 0 && scatter.local.shader == NULL); /* 0.011 (1 - R) < 0.01 */
    /* 2017b: from behind only the substrate, and neither levels nor weights. */
    scatter = scatter_of_stack(&stack, 1, GLINT_DIALECT_2017B, behind, &weak);
    CHECK(scatter.count == 0 && gray_of(scatter.local_factor) == 1);
    scatter = scatter_of_stack(&stack, 1, GLINT_DIALECT_2017B, v, &last);
    CHECK(scatter.count == 1 && scatter.local.shader == &stack.shaders[0]);
    /* 2018b: the substrate is not weakened. */
    scatter = scatter_of_stack(&stack, 2, GLINT_DIALECT_2018B, v, &from_camera);
    r = gi_dielectric_fresnel(v.z, index_of_glass);
    CHECK(scatter.count == 2 && gray_of(scatter.local_factor) == 1);
    CHECK(gray_of(scatter.branch[0].factor) == r && gray_of(scatter.branch[1].factor) == r);
}

static void glass_under_glazing(void) {
    Stack stack;
    stack_init(&stack);
    stack.shaders[0] = glass_of(2);
    GiVec v = shading_slant(40);
    GiScatter scatter = scatter_of_stack(&stack, 1, GLINT_DIALECT_GLINT, v, &from_camera);
    CHECK(scatter.count == 3 && scatter.local.shader == NULL);
    double sum = 0;
    for (int i = 0; i < scatter.count; i++) sum += gray_of(scatter.branch[i].factor);
    CHECK_NEAR(sum, 1, 1e-15);
    CHECK(scatter.branch[1].inside && scatter.branch[1].direction.z < 0);
    scatter = scatter_of_stack(&stack, LAYERS, GLINT_DIALECT_GLINT, v, &from_camera);
    CHECK_INT(scatter.count, LAYERS + 2);
}

/* ---------------------------------------------------------------- mirrors */

static void mirror_coefficient(void) {
    Random random = {43};
    static const GlintShaderType types[] = {
        GLINT_SHADER_LAMBERTIAN, GLINT_SHADER_PHONG, GLINT_SHADER_BECKMANN, GLINT_SHADER_GGX};
    for (int i = 0; i < 4; i++) {
        GiShader shader = shading_random_shader(&random, types[i]);
        GiVec v = shading_slant(60);
        CHECK(scatter_of(&shader, GLINT_DIALECT_2019, v, &from_camera).count == 0);
        shader.mirror = gi_vec(0.5, 0.25, 0);
        GiScatter scatter = scatter_of(&shader, GLINT_DIALECT_2019, v, &from_camera);
        CHECK(scatter.count == 1 && scatter.local.shader == &shader);
        CHECK(gray_of(scatter.local_factor) == 1);
        GiBranch branch = scatter.branch[0];
        CHECK_NEAR(branch.factor.x, 0.5 + 0.5 * 0.03125, 1e-15);
        CHECK_NEAR(branch.factor.y, 0.25 + 0.75 * 0.03125, 1e-15);
        CHECK_NEAR(branch.factor.z, 0.03125, 1e-15);
        CHECK(branch.weight == branch.factor.x && branch.direction.z == v.z);
        CHECK_NEAR(branch.direction.x, -v.x, 1e-16);
        CHECK(scatter_of(&shader, GLINT_DIALECT_2019, shading_slant(91), &from_camera).count == 0);
    }
}

const GiTest tests_scatter[] = {TEST(fresnel_and_schlick), TEST(glass_obeys_the_laws),
    TEST(glass_sides), TEST(levels_and_weights), TEST(glazed_layers), TEST(glazed_years),
    TEST(glass_under_glazing), TEST(mirror_coefficient), TEST_END};
