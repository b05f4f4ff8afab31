/* SPDX-License-Identifier: MIT
 * What each year's shaders, lights, textures, environments and integrators become in the model:
 * types, defaults, names, nesting, and the dialect that they show. No file is opened here. */
#include "test_reader_input.h"

#include "reader/element.h"

/* Loads a whole text with files taken for empty. */
static GiScene *good_text(const char *text) {
    Input input = {.head = text, .head_size = strlen(text)};
    memset(&loaded, 0, sizeof loaded);
    gi_memory_init(&loaded.memory, NULL, (size_t)1 << 30);
    CHECK(gi_scene_init(&loaded.scene, &loaded.memory));
    GiReaderSource source = {.read = read_input,
        .user = &input,
        .name = "test.xml",
        .total_size = -1,
        .diagnostic = on_diagnostic,
        .diagnostic_user = &loaded,
        .without_files = true};
    loaded.status = gi_reader_load(&loaded.scene, &source, NULL, &loaded.error);
    CHECK_TEXT(loaded.findings, "");
    CHECK_INT(loaded.status, GLINT_OK);
    return &loaded.scene;
}

static GiScene *good_scene(const char *middle) {
    char text[4000];
    snprintf(text, sizeof text, "%s%s%s", BEGIN, middle, END);
    return good_text(text);
}

/* ---------------------------------------------------------------- shaders */

typedef struct ShaderCase {
    const char *xml; /* of one shader, named s */
    GlintShaderType type;
    double diffuse, specular, roughness, index;
} ShaderCase;

/* Every type with its defaults; what a type does not have is not looked at (-1). */
static void shader_defaults(void) {
    static const ShaderCase cases[] = {
        {"<shader name='s' type='Lambertian'/>", GLINT_SHADER_LAMBERTIAN, 1, -1, -1, -1},
        {"<shader name='s' type='Phong'/>", GLINT_SHADER_PHONG, 1, 1, -1, -1},
        {"<shader name='s' type='RGBNormals'/>", GLINT_SHADER_RGB_NORMALS, -1, -1, -1, -1},
        {"<shader name='s' type='Glass'/>", GLINT_SHADER_GLASS, -1, -1, -1, 1},
        {"<shader name='s' type='Glazed'><refractiveIndex>3</refractiveIndex>"
         "<substrate type='Lambertian'/></shader>",
            GLINT_SHADER_GLAZED, -1, -1, -1, 3},
        {"<shader name='s' type='CookTorrance'><refractiveIndex>2</refractiveIndex></shader>",
            GLINT_SHADER_COOK_TORRANCE, 1, 1, 1, 2},
        {"<shader name='s' type='Microfacet'><brdf type='Beckmann'><alpha>.2</alpha><nt>7</nt>"
         "</brdf></shader>",
            GLINT_SHADER_BECKMANN, 0, 0, .2, 7},
        {"<shader name='s' type='Microfacet'><brdf type='GGX'><alpha>.3</alpha><nt>8</nt></brdf>"
         "</shader>",
            GLINT_SHADER_GGX, 0, 0, .3, 8},
        {"<shader name='s' type='MicrofacetBeckmann'><alpha>.2</alpha><nt>7</nt></shader>",
            GLINT_SHADER_BECKMANN, 0, 1, .2, 7},
        {"<shader name='s' type='MicrofacetGGX'><nt>8</nt><alpha>.3</alpha></shader>",
            GLINT_SHADER_GGX, 0, 1, .3, 8},
        {"<bsdf name='s' type='LambertianBSDF'/>", GLINT_SHADER_LAMBERTIAN, 1, -1, -1, -1},
        {"<bsdf name='s' type='MicrofacetBSDF'/>", GLINT_SHADER_BECKMANN, 1, 1, .5, 1.5},
        {"<bsdf name='s' type='GlassBSDF'/>", GLINT_SHADER_GLASS, -1, -1, -1, 1.5},
        {"<bsdf name='s' type='GlazedBSDF'><substrate type='LambertianBSDF'/></bsdf>",
            GLINT_SHADER_GLAZED, -1, -1, -1, 1.5},
    };
    enum { COUNT = sizeof cases / sizeof cases[0] };
    for (int i = 0; i < COUNT; i++) {
        /* Before and behind another of the types, whose defaults must not be left over. */
        for (int k = 0; k < COUNT; k++) {
            char text[1000];
            snprintf(text, sizeof text, "%s%s<surface type='Sphere'><shader ref='s'/></surface>",
                cases[k].xml, cases[i].xml);
            GiScene *scene = good_scene(text);
            uint32_t index = scene->info[GI_SHAPE_SPHERE].data[0].shader;
            const GiShader *shader = &scene->shaders.data[index];
            const ShaderCase *wanted = &cases[i];
            CHECK_INT(shader->type, wanted->type);
            if (wanted->diffuse >= 0) CHECK_NEAR(shader->diffuse.y, wanted->diffuse, 0);
            if (wanted->specular >= 0) CHECK_NEAR(shader->specular.z, wanted->specular, 0);
            if (wanted->roughness >= 0) CHECK_NEAR(shader->roughness, wanted->roughness, 0);
            if (wanted->index >= 0) CHECK_NEAR(shader->index, wanted->index, 0);
            check_vec(shader->mirror, 0, 0, 0);
            CHECK(shader->texture == GI_NONE);
            CHECK((shader->substrate != GI_NONE) == (shader->type == GLINT_SHADER_GLAZED));
            unload();
        }
    }
}

static void shader_values(void) {
    GiScene *scene = good_scene(
        "<texture name='t' type='ClampTexture'><image> a.png </image></texture>"
        "<shader name='a' type='Microfacet'><diffuseColor>1 2 3</diffuseColor>"
        "<brdf name='b' type='GGX'><nt>3</nt><alpha>.1</alpha></brdf>"
        "<microfacetColor>4 5 6</microfacetColor><texture ref='t'/></shader>"
        "<brdf name='c' ref='b'/><shader name='d' type='Microfacet'><brdf ref='c'/></shader>"
        "<shader name='e' type='Phong'><mirrorCoefficient>.1 .2 .3</mirrorCoefficient>"
        "<texture type='RepeatTexture'><image>a.png</image></texture></shader>"
        "<shader name='f' type='CookTorrance'><roughness>.4</roughness>"
        "<refractiveIndex name='n'>1.2</refractiveIndex><specularColor>7 8 9</specularColor>"
        "</shader><bsdf name='g' type='GlassBSDF'><refractiveIndex ref='n'/></bsdf>");
    const GiShader *shaders = scene->shaders.data;
    CHECK_INT(shaders[1].type, GLINT_SHADER_GGX);
    check_vec(shaders[1].diffuse, 1, 2, 3);
    check_vec(shaders[1].specular, 4, 5, 6);
    CHECK_NEAR(shaders[1].roughness, .1, 0);
    CHECK_NEAR(shaders[1].index, 3, 0);
    CHECK_INT(shaders[1].texture, 0);
    CHECK_NEAR(shaders[2].index, 3, 0);
    check_vec(shaders[3].mirror, .1, .2, .3);
    CHECK_INT(shaders[3].texture, 1);
    CHECK_INT(shaders[4].type, GLINT_SHADER_COOK_TORRANCE);
    CHECK_NEAR(shaders[4].roughness, .4, 0);
    check_vec(shaders[4].specular, 7, 8, 9);
    CHECK_NEAR(shaders[5].index, 1.2, 0);
    CHECK_INT(scene->textures.count, 2);
    CHECK_INT(scene->textures.data[0].wrap, GI_WRAP_CLAMP);
    CHECK_INT(scene->textures.data[1].wrap, GI_WRAP_REPEAT);
    CHECK_INT(scene->pictures.count, 1); /* one file */
    unload();
}

/* Roughness and index count only through a later disttype. */
static void disttype(void) {
    static const struct {
        const char *xml;
        GlintShaderType type;
        double roughness, index;
    } cases[] = {
        {"<roughness>.1</roughness><refractiveIndex>3</refractiveIndex>", GLINT_SHADER_BECKMANN, .5,
            1.5},
        {"<roughness>.1</roughness><refractiveIndex>3</refractiveIndex><disttype>1</disttype>",
            GLINT_SHADER_GGX, .1, 3},
        {"<roughness>.1</roughness><disttype>0</disttype><refractiveIndex>3</refractiveIndex>",
            GLINT_SHADER_BECKMANN, .1, 1.5},
        {"<disttype>1</disttype><roughness>.1</roughness>", GLINT_SHADER_GGX, .5, 1.5},
        {"<disttype>1</disttype><roughness>.1</roughness><disttype>1</disttype>", GLINT_SHADER_GGX,
            .1, 1.5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[500];
        snprintf(text, sizeof text, "<bsdf name='s' type='MicrofacetBSDF'>%s</bsdf>", cases[i].xml);
        GiScene *scene = good_scene(text);
        CHECK_INT(scene->shaders.data[1].type, cases[i].type);
        CHECK_NEAR(scene->shaders.data[1].roughness, cases[i].roughness, 0);
        CHECK_NEAR(scene->shaders.data[1].index, cases[i].index, 0);
        unload();
    }
}

/* What glazing has is its own, whatever stands in its substrate, before or behind it. */
static void glazing(void) {
    GiScene *scene = good_scene(
        "<shader name='p' type='Phong'/>"
        "<shader name='a' type='Glazed'><refractiveIndex>2</refractiveIndex>"
        "<substrate type='CookTorrance'><refractiveIndex>9</refractiveIndex></substrate></shader>"
        "<shader name='b' type='Glazed'><substrate type='Glass'><refractiveIndex>9"
        "</refractiveIndex></substrate><refractiveIndex>3</refractiveIndex></shader>"
        "<shader name='c' type='Glazed'><refractiveIndex>4</refractiveIndex><substrate name='d' "
        "type='Glazed'><refractiveIndex>5</refractiveIndex><substrate ref='p'/></substrate>"
        "</shader><shader name='e' ref='d'/>"
        "<bsdf name='f' type='GlazedBSDF'><substrate type='GlassBSDF'><refractiveIndex>9"
        "</refractiveIndex></substrate></bsdf><surface type='Sphere'><bsdf ref='f'/></surface>"
        "<surface type='Sphere'><shader ref='f'/></surface>"
        "<surface type='Sphere'><shader ref='e'/></surface>");
    static const struct {
        int shader;
        double index;
        uint32_t substrate;
    } wanted[] = {{3, 2, 2}, {5, 3, 4}, {6, 5, 1}, {7, 4, 6}, {9, 1.5, 8}};
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        const GiShader *shader = &scene->shaders.data[wanted[i].shader];
        CHECK_INT(shader->type, GLINT_SHADER_GLAZED);
        CHECK_NEAR(shader->index, wanted[i].index, 0);
        CHECK_INT(shader->substrate, wanted[i].substrate);
    }
    CHECK_INT(scene->info[GI_SHAPE_SPHERE].data[0].shader, 9);
    CHECK_INT(scene->info[GI_SHAPE_SPHERE].data[1].shader, 9);
    CHECK_INT(scene->info[GI_SHAPE_SPHERE].data[2].shader, 6);
    unload();
}

static void glazing_depth(void) {
    for (int layers = GI_SUBSTRATE_LIMIT; layers <= GI_SUBSTRATE_LIMIT + 1; layers++) {
        char text[3000] = BEGIN "<bsdf name='g' type='LambertianBSDF'/>\n";
        for (int i = 0; i < layers; i++) {
            strcat(text, "<bsdf name='g' type='GlazedBSDF'><substrate ref='g'/></bsdf>\n");
        }
        strcat(text, END);
        load(text);
        CHECK_TEXT(
            loaded.findings, layers <= GI_SUBSTRATE_LIMIT
                                 ? ""
                                 : "10:1: Glazed shaders lie more than 8 deep on each other\n");
        unload();
    }
}

/* ---------------------------------------------------------------- lights and the rest */

static void lights(void) {
    GiScene *scene = good_scene(
        "<light type='DirectionalLight'><direction>1 2 3</direction><color>4 5 6</color></light>"
        "<light type='RectangleLight'/><light type='RectangleLight' name='r'><position>1 1 1"
        "</position><normalDir>0 5 0</normalDir><upDir>0 0 2</upDir><width>3</width><height>4"
        "</height><intensity>7 7 7</intensity></light><light ref='r'/><light/>");
    const GiLight *light = scene->lights.data;
    CHECK_INT(light[0].type, GLINT_LIGHT_DIRECTIONAL);
    check_vec(light[0].direction, 1, 2, 3);
    check_vec(light[0].intensity, 4, 5, 6);
    CHECK_INT(light[1].type, GLINT_LIGHT_RECTANGLE);
    check_vec(light[1].direction, 0, 0, -1);
    check_vec(light[1].up, 0, 1, 0);
    CHECK(light[1].width == 1 && light[1].height == 1);
    for (int i = 2; i <= 3; i++) {
        check_vec(light[i].position, 1, 1, 1);
        check_vec(light[i].direction, 0, 5, 0);
        check_vec(light[i].up, 0, 0, 2);
        CHECK(light[i].width == 3 && light[i].height == 4);
        check_vec(light[i].intensity, 7, 7, 7);
    }
    CHECK_INT(light[4].type, GLINT_LIGHT_POINT);
    unload();
}

static void integrators(void) {
    static const struct {
        const char *xml;
        GlintIntegrator integrator;
        int depth;
    } cases[] = {
        {"", GLINT_INTEGRATOR_LIGHT_SAMPLING, 12},
        {"<integrator type='LightSamplingIntegrator'/>", GLINT_INTEGRATOR_LIGHT_SAMPLING, 12},
        {"<integrator type='BSDFSamplingIntegrator'/>", GLINT_INTEGRATOR_BSDF_SAMPLING, 12},
        {"<integrator type='ray2.PointLightIntegrator'/>", GLINT_INTEGRATOR_POINT_LIGHT, 12},
        {"<integrator type='PathIntegrator'/>", GLINT_INTEGRATOR_PATH, 12},
        {"<integrator type='PathIntegrator'><maxDepth>5</maxDepth></integrator>",
            GLINT_INTEGRATOR_PATH, 5},
        {"<integrator name='i' type='PathIntegrator'><maxDepth>5</maxDepth></integrator>"
         "<integrator type='PointLightIntegrator'/><integrator ref='i'/>",
            GLINT_INTEGRATOR_PATH, 5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        GiScene *scene = good_scene(cases[i].xml);
        CHECK_INT(scene->integrator, cases[i].integrator);
        CHECK_INT(scene->max_depth, cases[i].depth);
        unload();
    }
}

static void meshes(void) {
    GiScene *scene = good_scene(
        "<surface type='Sphere'/><surface name='m' type='Mesh'><data "
        "name='d'>a.obj</data></surface>"
        "<surface type='Group'><surface type='Mesh'><shader type='Phong'/><data ref='d'/></surface>"
        "<surface ref='m'/><surface type='Mesh'><data>b.msh</data></surface></surface>");
    CHECK_INT(scene->mesh_surfaces.count, 3);
    CHECK_INT(scene->meshes.meshes.count, 2);
    const GiMeshSurface *surfaces = scene->mesh_surfaces.data;
    CHECK(surfaces[0].mesh == 0 && surfaces[1].mesh == 0 && surfaces[2].mesh == 1);
    CHECK(surfaces[0].info.order == 1 && surfaces[2].info.order == 3);
    CHECK(surfaces[0].info.shader == 0 && surfaces[1].info.shader == 1);
    CHECK_INT(scene->shape_count, 4);
    CHECK_INT(scene->groups.data[0].children.count, 3);
    CHECK_INT(scene->groups.data[0].children.data[1].bits, gi_shape_ref(GI_SHAPE_MESH, 0).bits);
    unload();
}

/* ---------------------------------------------------------------- dialects */

#define TYPED   "<scene><camera type='PerspectiveCamera'/><image>1 1</image>"
#define UNTYPED "<scene><camera/><image>1 1</image>"
#define BRDF    "<brdf type='GGX'><alpha>1</alpha><nt>2</nt></brdf>"
#define FACETS  "<alpha>1</alpha><nt>2</nt></shader>"
#define TEXTURE "<texture type='ClampTexture'><image>a</image></texture>"

/* Each line of the table in docs/scene-format.md, and that it goes before those below it. */
static void evidence(void) {
    static const struct {
        const char *begin, *middle;
        GlintDialect dialect;
    } cases[] = {
        {"<scene dialect='2012'><camera/><image>1 1</image>", "<bsdf type='GlassBSDF'/>",
            GLINT_DIALECT_2012},
        {UNTYPED, "<bsdf type='GlassBSDF'/>", GLINT_DIALECT_2018B},
        {TYPED, "<surface type='Sphere'><bsdf type='GlassBSDF'/></surface>", GLINT_DIALECT_2018B},
        {TYPED, "<integrator type='PathIntegrator'/>", GLINT_DIALECT_2018B},
        {TYPED, "<environment type='Cubemap'><filename>a</filename></environment>",
            GLINT_DIALECT_2018B},
        {TYPED, "<material type='Phong'/><bsdf type='GlassBSDF'/>", GLINT_DIALECT_2018B},
        {TYPED, "<material type='Phong'/>", GLINT_DIALECT_MATERIAL},
        {TYPED, "<surface type='Plane'/><exposure>1</exposure>", GLINT_DIALECT_MATERIAL},
        {TYPED, "<surface type='Group'><surface type='Disc'/></surface>", GLINT_DIALECT_MATERIAL},
        {UNTYPED, "<light type='RectangleLight'/>", GLINT_DIALECT_MATERIAL},
        {UNTYPED, "<light type='Light'/>", GLINT_DIALECT_2012},
        {UNTYPED, "<shader type='Glass'/><surface type='Group'/>" BRDF TEXTURE, GLINT_DIALECT_2012},
        {UNTYPED, "<cubemap><filename>a</filename></cubemap><exposure>1</exposure>",
            GLINT_DIALECT_2012},
        {TYPED, "<light type='PointLight'/>", GLINT_DIALECT_2017B},
        {TYPED,
            "<light type='DirectionalLight'><direction>1 1 1</direction></light>" BRDF
            "<shader type='MicrofacetGGX'>" FACETS,
            GLINT_DIALECT_2017B},
        {TYPED, "<cubemap><filename>a</filename></cubemap>", GLINT_DIALECT_2017B},
        {TYPED, "<surface type='Group'/>", GLINT_DIALECT_2017B},
        {TYPED, "<shader type='Glass'/>" BRDF, GLINT_DIALECT_2017B},
        {TYPED,
            "<shader type='Glazed'><refractiveIndex>2</refractiveIndex><substrate "
            "type='Phong'/></shader>",
            GLINT_DIALECT_2017B},
        {TYPED, "<shader type='CookTorrance'><refractiveIndex>2</refractiveIndex></shader>",
            GLINT_DIALECT_2017B},
        {TYPED, BRDF "<shader type='MicrofacetGGX'>" FACETS TEXTURE, GLINT_DIALECT_2018},
        {TYPED, "<shader type='Microfacet'>" BRDF "</shader>", GLINT_DIALECT_2018},
        {TYPED, "<shader type='MicrofacetGGX'>" FACETS TEXTURE, GLINT_DIALECT_2019},
        {TYPED, "<shader type='MicrofacetBeckmann'>" FACETS, GLINT_DIALECT_2019},
        {TYPED,
            "<shader type='Phong'><mirrorCoefficient>0 0 0</mirrorCoefficient></shader>"
            "<exposure>2</exposure>",
            GLINT_DIALECT_2019},
        {TYPED, TEXTURE, GLINT_DIALECT_2017},
        {TYPED, "<shader type='Phong'>" TEXTURE "</shader>", GLINT_DIALECT_2017},
        {TYPED, "<exposure>2</exposure>", GLINT_DIALECT_2017},
        {TYPED, "<surface type='Mesh'><data>a</data></surface><light type='Light'/>",
            GLINT_DIALECT_2013},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[1000];
        snprintf(text, sizeof text, "%s%s</scene>", cases[i].begin, cases[i].middle);
        CHECK_TEXT(
            glint_dialect_name(good_text(text)->dialect), glint_dialect_name(cases[i].dialect));
        unload();
    }
}

const GiTest tests_elements[] = {TEST(shader_defaults), TEST(shader_values), TEST(disttype),
    TEST(glazing), TEST(glazing_depth), TEST(lights), TEST(integrators), TEST(meshes),
    TEST(evidence), TEST_END};
