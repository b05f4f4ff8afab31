/* SPDX-License-Identifier: MIT
 * The reader: numbers, tables, values, names, groups, dialects and encodings. */
#include "test_reader_input.h"

#include "reader/element.h"
#include "reader/number.h"
#include "reader/reader.h"
#include "reader/suggest.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- numbers */

static void check_number(const char *text) {
    double value = 7, expected = strtod(text, NULL);
    size_t used;
    GiNumberStatus status = gi_number_read(text, strlen(text), &value, &used);
    bool same = memcmp(&value, &expected, sizeof value) == 0 && used == strlen(text);
    bool infinite = expected > DBL_MAX || expected < -DBL_MAX;
    if (infinite ? status != GI_NUMBER_TOO_LARGE : !same || status != GI_NUMBER_OK) {
        test_fail(__FILE__, __LINE__, "%.60s gives %.17g, not %.17g", text, value, expected);
    }
}

static uint64_t next_random(void) {
    static uint64_t state = UINT64_C(88172645463325252);
    state ^= state << 13;
    state ^= state >> 7;
    return state ^= state << 17;
}

static void numbers(void) {
    static const char *const texts[] = {"0", "-0", "+2", ".5", "1.", "-.5e1", "1e-3", "1E+3", "007",
        "9007199254740993", "9007199254740993.00000000000000000000000000000000000000001",
        "2.2250738585072011e-308", "2.2250738585072014e-308", "4.9e-324", "2.4703282292062327e-324",
        "2.4703282292062328e-324", "1.7976931348623157e308", "1.7976931348623158e308",
        "1.7976931348623159e308", "0e999999999999", "1e-999999999999", "1e999999999999", "8.41e+21",
        "6929495644600919.5", "3.7455744005952583e15", "1090544144181609348671888949248",
        "0.000000000000000000000000000000000000000000000000000000000000001e63"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) check_number(texts[i]);
    char text[2000];
    for (int i = 0; i < 20000; i++) {
        uint64_t bits = next_random();
        double value;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value)) continue;
        for (int digits = 16; digits <= 21; digits++) {
            snprintf(text, sizeof text, "%.*g", digits, value);
            check_number(text);
        }
        snprintf(
            text, sizeof text, "%.*f", (int)(bits % 25), (double)(int64_t)next_random() / 1e12);
        check_number(text);
        snprintf(text, sizeof text, "%llu.%llue%d", (unsigned long long)(bits >> bits % 61),
            (unsigned long long)next_random(), (int)(next_random() % 700) - 350);
        check_number(text);
        if (i % 10 != 0 || fabs(value) < 1e-30 || fabs(value) > 1e30) continue;
        /* Half way between two doubles, exactly and a hair above. */
        long double half = ((long double)value + (long double)nextafter(value, 1e300)) / 2;
        snprintf(text, sizeof text, "%.200Lf", half);
        check_number(text);
        strcat(text, "00000000000000000000001");
        check_number(text);
    }
}

/* Every count of digits on both sides of the point, and whatever may follow. */
static void digits_and_places(void) {
    static const char *const tails[] = {"", " ", " 123456789", ".5", "e", "x", "-1.5", "\xb2\xb3"};
    for (int whole = 0; whole <= 11; whole++) {
        for (int places = 0; places <= 11; places++) {
            if (whole + places == 0) continue;
            char number[32], text[64];
            snprintf(text, sizeof text, "%llu",
                (unsigned long long)(next_random() % 90000000000 + 10000000000));
            snprintf(number, sizeof number, "%s%.*s%s%.*s", places % 3 == 0 ? "-" : "", whole,
                "98765432109", places > 0 ? "." : "", places, text);
            check_number(number);
            double expected = strtod(number, NULL), value;
            for (size_t i = 0; i < sizeof tails / sizeof tails[0]; i++) {
                if (tails[i][0] == '.' && places == 0) continue;
                size_t used;
                snprintf(text, sizeof text, "%s%s", number, tails[i]);
                CHECK_INT(gi_number_read(text, strlen(text), &value, &used), GI_NUMBER_OK);
                CHECK_INT(used, strlen(number));
                CHECK_NEAR(value, expected, 0);
            }
        }
    }
}

static void not_numbers(void) {
    static const char *const texts[] = {
        "", "+", "-", ".", "+.", "e1", ".e1", "inf", "nan", "--1", "+-1", "x"};
    double value;
    size_t used;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        CHECK_INT(gi_number_read(texts[i], strlen(texts[i]), &value, &used), GI_NUMBER_MALFORMED);
        CHECK_INT(used, 0);
    }
    static const struct {
        const char *text;
        size_t used;
    } parts[] = {
        {"1e", 1}, {"1e+", 1}, {"0x10", 1}, {"1.2.3", 3}, {"1,5", 1}, {"2 3", 1}, {"1e5e", 3}};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        CHECK_INT(
            gi_number_read(parts[i].text, strlen(parts[i].text), &value, &used), GI_NUMBER_OK);
        CHECK_INT(used, parts[i].used);
    }
}

/* ---------------------------------------------------------------- tables */

static void tables(void) {
    GiElementIndex index;
    gi_element_index_init(&index);
    for (const GiElement *e = gi_elements; e->name != NULL; e++) {
        CHECK(e->help != NULL && e->help[0] != '\0');
        CHECK((e->kind == GI_KIND_CHOICE) == (e->choices != NULL));
        CHECK(e - gi_elements < GI_ELEMENT_LIMIT);
        for (int bit = 0; bit < 64; bit++) {
            GiContexts context = e->contexts & GI_CONTEXT(bit);
            if (context != 0) CHECK(gi_element_find(&index, gi_span(e->name), context) == e);
        }
        CHECK(e->type == NULL || gi_type_find(gi_span(e->type), e->kind) != NULL);
        CHECK(!e->required || e->default_text == NULL);
    }
    CHECK(gi_element_find(&index, gi_span("MINPT"), GI_IN_BOX) != NULL);
    CHECK(gi_element_find(&index, gi_span("minPt"), GI_IN_SPHERE) == NULL);
    for (const GiType *t = gi_types; t->name != NULL; t++) {
        CHECK(gi_type_find(gi_span(t->name), t->kind) == t);
        CHECK((gi_kind_contexts(t->kind) & t->context) == t->context);
    }
    CHECK(GI_SLOT_COUNT <= 64);
}

/* Guesses, right and wrong ones, never change what is found. */
static void guesses(void) {
    static const struct {
        const char *name;
        uint64_t contexts;
    } file[] = {{"shader", GI_IN_SCENE}, {"color", GI_IN_PHONG}, {"light", GI_IN_SCENE},
        {"color", GI_IN_POINT_LIGHT}, {"surface", GI_IN_SCENE}, {"Shader", GI_IN_SPHERE},
        {"radius", GI_IN_SPHERE}, {"radiu", GI_IN_SPHERE}, {"radius", GI_IN_BOX},
        {"surface", GI_IN_SCENE}, {"minPt", GI_IN_BOX}, {"surface", GI_IN_GROUP},
        {"shader", GI_IN_SPHERE}, {"shader", GI_IN_SCENE}, {"color", GI_IN_NORMAL_LIGHT}};
    GiElementIndex index;
    gi_element_index_init(&index);
    for (size_t i = 0; i < 3 * sizeof file / sizeof file[0]; i++) {
        const char *name = file[i % (sizeof file / sizeof file[0])].name;
        uint64_t contexts = file[i % (sizeof file / sizeof file[0])].contexts;
        const GiElement *found = gi_element_find(&index, gi_span(name), contexts);
        CHECK(gi_element_guess(&index, gi_span(name), contexts) == found);
    }
}

static void suggestions(void) {
    CHECK_INT(gi_edit_distance("center", 6, "centre", 6, 3), 1);
    CHECK_INT(gi_edit_distance("SPHERE", 6, "sphere", 6, 3), 0);
    CHECK_INT(gi_edit_distance("viewPont", 8, "viewPoint", 9, 3), 1);
    CHECK_INT(gi_edit_distance("abc", 3, "xyz", 3, 1), 2);
    CHECK_INT(gi_edit_distance("", 0, "ab", 2, 5), 2);
}

/* ---------------------------------------------------------------- what is read */

static void defaults(void) {
    GiScene *scene = good("<surface type='Sphere'/><surface type='Box'/><surface type='Cylinder'/>"
                          "<surface type='Disc'/><surface type='Plane'/><light/>"
                          "<shader name='p' type='Phong'/>");
    GiCamera camera = gi_camera_default();
    CHECK_INT(scene->camera.type, camera.type);
    check_vec(scene->camera.view_direction, 0, 0, camera.view_direction.z);
    check_vec(scene->camera.view_up, 0, camera.view_up.y, 0);
    check_vec(scene->camera.projection_normal, 0, 0, 0);
    CHECK_NEAR(scene->camera.projection_distance, camera.projection_distance, 0);
    CHECK_NEAR(scene->camera.view_width, camera.view_width, 0);
    CHECK_NEAR(scene->camera.view_height, camera.view_height, 0);
    CHECK(scene->has_camera && scene->has_image);
    CHECK_INT(scene->width, 4);
    CHECK_INT(scene->height, 2);
    CHECK_INT(scene->samples, 1);
    CHECK_NEAR(scene->exposure, 1, 0);
    check_vec(scene->spheres.data[0].center, 0, 0, 0);
    CHECK_NEAR(scene->spheres.data[0].radius, 1, 0);
    CHECK_NEAR(scene->cones.data[0].half_height, 0.5, 0);
    check_vec(scene->planes.data[0].normal, 0, 0, 1);
    CHECK_NEAR(scene->discs.data[0].radius, 1, 0);
    GiLight light = gi_light_default();
    check_vec(scene->lights.data[0].intensity, light.intensity.x, light.intensity.y, 1);
    CHECK_INT(scene->lights.data[0].falloff, GLINT_FALLOFF_DIALECT);
    GiShader shader = gi_shader_default(), *read = &scene->shaders.data[1];
    CHECK_INT(scene->shaders.count, 2);
    CHECK(!read->diffuse_given);
    check_vec(read->diffuse, shader.diffuse.x, shader.diffuse.y, shader.diffuse.z);
    CHECK_NEAR(read->exponent, shader.exponent, 0);
    CHECK_INT(scene->roots.count, 5);
    CHECK_INT(scene->info[GI_SHAPE_PLANE].data[0].order, 4);
    unload();
}

static void values(void) {
    GiScene *scene =
        good("<camera type='OrthographicCamera'><VIEWPOINT> 1\n2\t3 </VIEWPOINT><viewdir>0 -1 "
             "0</viewdir>"
             "<viewUp>1 0 0</viewUp><projNormal>0 1 .5</projNormal><projDistance>2</projDistance>"
             "<viewWidth>3</viewWidth><viewHeight>4</viewHeight><image>10 20</image></camera>"
             "<samples>9</samples><backColor>.1 .2 .3</backColor><exposure>2.5</exposure>"
             "<exposure>-1</exposure>"
             "<surface type='ray.surface.Box'><minPt>1 5 3</minPt><MAXPT>4 2 6</MAXPT>"
             "<shader type='Phong'><color>1 0 0</color><specularColor>0 1 0</specularColor>"
             "<exponent>7</exponent></shader></surface>"
             "<light type='AmbientLight'><color>.5 .5 .5</color></light>"
             "<light><position>1 2 3</position><falloff> inverse-square </falloff></light>"
             "<light><falloff>none</falloff></light>");
    CHECK_INT(scene->camera.type, GLINT_CAMERA_PARALLEL);
    check_vec(scene->camera.view_point, 1, 2, 3);
    check_vec(scene->camera.view_direction, 0, -1, 0);
    check_vec(scene->camera.projection_normal, 0, 1, .5);
    CHECK_NEAR(scene->camera.view_height, 4, 0);
    CHECK_INT(scene->height, 20);
    CHECK_INT(scene->samples, 9);
    check_vec(scene->back_color, .1, .2, .3);
    CHECK_NEAR(scene->exposure, 2.5, 0);
    check_vec(scene->boxes.data[0].low, 1, 2, 3);
    check_vec(scene->boxes.data[0].high, 4, 5, 6);
    CHECK_INT(scene->info[GI_SHAPE_BOX].data[0].shader, 1);
    CHECK(scene->shaders.data[1].diffuse_given);
    check_vec(scene->shaders.data[1].diffuse, 1, 0, 0);
    check_vec(scene->shaders.data[1].specular, 0, 1, 0);
    CHECK_INT(scene->lights.data[0].type, GLINT_LIGHT_AMBIENT);
    check_vec(scene->lights.data[0].intensity, .5, .5, .5);
    CHECK_INT(scene->lights.data[1].falloff, GLINT_FALLOFF_INVERSE_SQUARE);
    CHECK_INT(scene->lights.data[2].falloff, GLINT_FALLOFF_NONE);
    unload();
}

static void last_one_wins(void) {
    GiScene *scene = good("<shader name='a' type='Phong'/><shader name='b' type='Phong'/>"
                          "<surface type='Sphere'><radius>1</radius><shader ref='a'/>"
                          "<shader ref='b'/><radius>3</radius></surface><image>7 7</image>");
    CHECK_NEAR(scene->spheres.data[0].radius, 3, 0);
    CHECK_INT(scene->info[GI_SHAPE_SPHERE].data[0].shader, 2);
    CHECK_INT(scene->width, 7);
    unload();
}

static void comments_inside(void) {
    GiScene *scene = good("<surface type='Sphere'><center>1<!-- a -->.5 <!-- 9 9 -->2<?pi x?>\r\n"
                          "<![CDATA[ 3 ]]></center><radius>&#50;</radius></surface>");
    check_vec(scene->spheres.data[0].center, 1.5, 2, 3);
    CHECK_NEAR(scene->spheres.data[0].radius, 2, 0);
    unload();
}

static void cones(void) {
    GiScene *scene = good("<surface type='Cone'><center>0 0 1</center><radius>2</radius></surface>"
                          "<surface type='Cone'><tipz>4</tipz><theta>90</theta></surface>"
                          "<surface type='Cone'><theta>90</theta><radius>3</radius></surface>"
                          "<surface type='Cone'><center>5 5 5</center></surface>");
    CHECK_NEAR(scene->cones.data[0].slope, 2, 0); /* apex at 0, one below the centre */
    CHECK_NEAR(scene->cones.data[1].slope, -0.25, 0);
    CHECK_NEAR(scene->cones.data[2].slope, -1, 1e-15);
    CHECK_NEAR(scene->cones.data[3].slope, -tan(3.14159265358979 / 6), 1e-14);
    unload();
}

static void names(void) {
    GiScene *scene = good(
        "<shader name='s' type='Phong'><color name='c'>1 2 3</color></shader>"
        "<surface name='ball' type='Sphere'><radius name='r'>2</radius><shader ref='s'/></surface>"
        "<surface ref='ball' type='Nonsense'><any/>thing</surface>"
        "<shader name='t' ref='s'/><material name='s' type='Lambertian'><color ref='c'/></material>"
        "<surface type='Sphere'><center ref='c'/><radius ref='r' name='q'/><shader "
        "ref='t'/></surface>"
        "<surface type='Sphere'><radius ref='q'/><shader ref='s'/></surface>"
        "<light name='l'><position>1 1 1</position></light><light ref='l'/>"
        "<camera name='cam'><viewWidth>5</viewWidth></camera><camera/><camera ref='cam'/>"
        "<image name='i'>3 3</image><image>2 2</image><image ref='i'/>");
    CHECK_INT(scene->spheres.count, 3);
    CHECK_INT(scene->roots.count, 4);
    CHECK_INT(scene->roots.data[0].bits, scene->roots.data[1].bits);
    CHECK_INT(scene->info[GI_SHAPE_SPHERE].data[1].shader, 1);
    CHECK_INT(scene->info[GI_SHAPE_SPHERE].data[2].shader, 2);
    check_vec(scene->spheres.data[1].center, 1, 2, 3);
    CHECK_NEAR(scene->spheres.data[2].radius, 2, 0);
    check_vec(scene->shaders.data[2].diffuse, 1, 2, 3);
    CHECK_INT(scene->lights.count, 2);
    check_vec(scene->lights.data[1].position, 1, 1, 1);
    CHECK_NEAR(scene->camera.view_width, 5, 0);
    CHECK_INT(scene->width, 3);
    unload();
}

static void groups(void) {
    GiScene *scene = good(
        "<surface type='Group' name='g'><rotate name='r'>0 0 90</rotate><surface type='Sphere'/>"
        "<shader name='in' type='Phong'/><translate>1 0 0</translate>"
        "<surface type='Group'><surface type='Sphere' name='s'/><scale>1 -2 1</scale>"
        "<rotate ref='r'/></surface></surface>"
        "<surface ref='g'/><surface type='Sphere'><shader ref='in'/></surface><surface ref='s'/>");
    CHECK_INT(scene->groups.count, 2);
    CHECK_INT(scene->roots.count, 4);
    const GiGroup *outer = &scene->groups.data[0], *inner = &scene->groups.data[1];
    CHECK_INT(outer->steps.count, 2);
    CHECK_INT(outer->steps.data[0].kind, GI_STEP_ROTATE);
    CHECK_INT(outer->steps.data[1].kind, GI_STEP_TRANSLATE);
    CHECK_INT(outer->children.count, 2);
    CHECK_INT(gi_shape_kind(outer->children.data[1]), GI_SHAPE_GROUP);
    CHECK_INT(inner->children.count, 1);
    CHECK_INT(inner->children.data[0].bits, scene->roots.data[3].bits);
    check_vec(inner->steps.data[0].value, 1, -2, 1);
    check_vec(inner->steps.data[1].value, 0, 0, 90);
    CHECK_INT(scene->info[GI_SHAPE_SPHERE].data[0].shader, 0);
    CHECK_INT(scene->info[GI_SHAPE_SPHERE].data[2].shader, 1);
    unload();
}

/* Numbers that are too large in one order of the transforms only, here the one of 2017b. */
static void group_order(void) {
    static const char text[] =
        BEGIN "\n<surface type='Group'><translate>1e200 0 0</translate><scale>1e200 1 1</scale>"
              "</surface>" END;
    static const struct {
        GlintDialect dialect;
        const char *begin;
    } rows[] = {{GLINT_DIALECT_GLINT, ""}, {GLINT_DIALECT_2012, ""},
        {GLINT_DIALECT_2017B, "2:1: the transform of this group cannot be inverted"},
        {GLINT_DIALECT_2018B, "2:1: the transform of this group cannot be inverted"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (size_t chunk = 0; chunk < 3; chunk++) {
            Input input = {.head = text, .head_size = sizeof text - 1};
            load_input(input, chunk, rows[i].dialect, NULL);
            size_t length = strlen(rows[i].begin);
            CHECK_INT(loaded.count, length > 0);
            CHECK(strncmp(loaded.findings, rows[i].begin, length) == 0);
            unload();
        }
    }
}

static void dialects(void) {
    static const struct {
        const char *text;
        GlintDialect dialect;
    } rows[] = {
        {"<scene><camera/><image>1 1</image></scene>", GLINT_DIALECT_2012},
        {"<scene><camera/><image>1 1</image><material type='Phong'/></scene>",
            GLINT_DIALECT_MATERIAL},
        {"<scene><camera/><image>1 1</image><surface type='Disc'/></scene>",
            GLINT_DIALECT_MATERIAL},
        {"<scene><camera/><image>1 1</image><light type='PointLight'/></scene>",
            GLINT_DIALECT_MATERIAL},
        {"<scene><camera/><image>1 1</image><light type='Light'/></scene>", GLINT_DIALECT_2012},
        {"<scene><camera/><image>1 1</image><surface type='Group'/></scene>", GLINT_DIALECT_2012},
        {"<scene><camera type='ParallelCamera'/><image>1 1</image></scene>", GLINT_DIALECT_2013},
        {"<scene><camera type='ParallelCamera'/><image>1 1</image><exposure>1</exposure></scene>",
            GLINT_DIALECT_2017},
        {"<scene><camera type='ParallelCamera'/><image>1 1</image><surface type='Group'/></scene>",
            GLINT_DIALECT_2017B},
        {"<scene><camera type='ParallelCamera'/><image>1 1</image><light "
         "type='PointLight'/></scene>",
            GLINT_DIALECT_2017B},
        {"<scene dialect='2019'><camera/><image>1 1</image></scene>", GLINT_DIALECT_2019},
        {"<scene dialect='glint'><camera/><image>1 1</image></scene>", GLINT_DIALECT_GLINT},
        {"<scene dialect='auto'><camera/><image>1 1</image></scene>", GLINT_DIALECT_2012},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        load(rows[i].text);
        CHECK_TEXT(loaded.findings, "");
        CHECK_TEXT(glint_dialect_name(loaded.scene.dialect), glint_dialect_name(rows[i].dialect));
        unload();
    }
    Input input = {.head = rows[10].text, .head_size = strlen(rows[10].text)};
    load_input(input, 0, GLINT_DIALECT_2013, NULL);
    CHECK_INT(loaded.scene.dialect, GLINT_DIALECT_2013);
    unload();
}

static void encodings(void) {
    static const char bom[] = "\xef\xbb\xbf<?xml version='1.0'?><Scene><banana/></Scene>";
    load_bytes(bom, sizeof bom - 1, 0);
    CHECK(strstr(loaded.findings, "1:29: unknown element `banana` in the scene") != NULL);
    unload();
    static const char text[] =
        "<scene>\r\n<camera/><image>4 4</image><!-- \xe9 --><x/>\r\n</scene>";
    char utf16[2 * sizeof text + 2] = "\xff\xfe";
    for (size_t i = 0; i < sizeof text - 1; i++) utf16[2 * i + 2] = text[i];
    load_bytes(utf16, 2 * sizeof text, 3);
    CHECK_TEXT(loaded.findings, "2:38: unknown element `x` in the scene\n");
    CHECK(strstr(loaded.printed, "<!-- \xc3\xa9 --><x/>\n") != NULL);
    unload();
    char latin[200];
    snprintf(latin, sizeof latin, "<?xml version='1.0' encoding='iso-8859-1'?>%s", text);
    load(latin);
    CHECK_TEXT(loaded.findings, "2:38: unknown element `x` in the scene\n");
    CHECK(strstr(loaded.printed, "<!-- \xc3\xa9 --><x/>\n") != NULL);
    unload();
}

const GiTest tests_reader[] = {TEST(numbers), TEST(digits_and_places), TEST(not_numbers),
    TEST(tables), TEST(guesses), TEST(suggestions), TEST(defaults), TEST(values),
    TEST(last_one_wins), TEST(comments_inside), TEST(cones), TEST(names), TEST(groups),
    TEST(group_order), TEST(dialects), TEST(encodings), TEST_END};
