/* SPDX-License-Identifier: MIT
 * Old scenes by the rules of glint: what is said to be the same is the same, to the last bit. */
#include "scene_files.h"
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Told {
    int counts[3];
    char text[8000]; /* "line:column kind message\n" each */
} Told;

static void on_change(void *user, const GlintChange *change) {
    Told *told = user;
    size_t length = strlen(told->text);
    told->counts[change->kind]++;
    snprintf(told->text + length, sizeof told->text - length, "%lld:%lld %d %s\n",
        (long long)change->line, (long long)change->column, (int)change->kind, change->message);
}

static GlintStatus upgrade(
    const char *bytes, size_t size, GlintDialect dialect, Text *out, Told *told) {
    *out = (Text){0};
    memset(told, 0, sizeof *told);
    GlintUpgradeDesc desc = glint_upgrade_desc_default();
    desc.dialect = dialect;
    desc.change = on_change;
    desc.change_user = told;
    return glint_upgrade(bytes, size, "a.xml", &desc, collect_text, out, NULL, NULL);
}

/* ---------------------------------------------------------------- texts */

static void check_text(GlintDialect dialect, const char *text, const char *expected, int same,
    int rounding, int different) {
    Text out;
    Told told;
    CHECK_INT(upgrade(text, strlen(text), dialect, &out, &told), GLINT_OK);
    CHECK_TEXT(out.bytes != NULL ? out.bytes : "", expected);
    CHECK_INT(told.counts[GLINT_CHANGE_SAME], same);
    CHECK_INT(told.counts[GLINT_CHANGE_ROUNDING], rounding);
    CHECK_INT(told.counts[GLINT_CHANGE_DIFFERENT], different);
    free(out.bytes);
}

#define HEAD      "<camera/><image>4 2</image>"
#define OLD(text) "<scene>" HEAD text "</scene>"
#define NEW(text) "<scene dialect=\"glint\">" HEAD text "</scene>"

static void words(void) {
    check_text(GLINT_DIALECT_2013, OLD("<!-- a -->"), NEW("<!-- a -->"), 1, 0, 0);
    check_text(GLINT_DIALECT_2013,
        "<Scene dialect = '2013'  name='x' >" HEAD "<material name='m' type='a.b.Phong'>"
        "<COLOR>1 0 0</COLOR></material ><light type='Light'><color>1 1 1</color></light></Scene>",
        "<scene dialect = 'glint'  name='x' >" HEAD "<shader name='m' type='Phong'>"
        "<diffuseColor>1 0 0</diffuseColor></shader ><light type='PointLight'>"
        "<intensity>1 1 1</intensity></light></scene>",
        6, 0, 1);
    check_text(GLINT_DIALECT_2018B,
        OLD("<cubemap name='c'><filename>a.pfm</filename></cubemap>"
            "<cubemap ref='c'/>"),
        NEW("<environment type=\"Cubemap\" name='c'><filename>a.pfm</filename></environment>"
            "<environment ref='c'/>"),
        4, 0, 1);
    /* Nothing is left to do. */
    check_text(GLINT_DIALECT_AUTO, NEW("<light>  </light>"), NEW("<light>  </light>"), 0, 0, 0);
}

static void lights(void) {
    check_text(GLINT_DIALECT_2017, OLD("<light/><light  ><falloff>none</falloff></light>"),
        NEW("<light><falloff>inverse-square</falloff></light>"
            "<light  ><falloff>none</falloff></light>"),
        2, 0, 1);
    /* On a line of its own where the others are. */
    check_text(GLINT_DIALECT_2017,
        OLD("\n\t<light>\n\t\t<position>1 1 1</position> <!-- here -->\n\t</light>"),
        NEW("\n\t<light>\n\t\t<position>1 1 1</position> <!-- here -->\n"
            "\t\t<falloff>inverse-square</falloff>\n\t</light>"),
        2, 0, 1);
    check_text(GLINT_DIALECT_2017B,
        OLD("<light type='RectangleLight'><intensity>2 0 1</intensity></light>"),
        NEW("<light type='RectangleLight'><intensity>6.283185307179586 0 3.141592653589793"
            "</intensity></light>"),
        1, 0, 3);
}

static void shaders(void) {
    static const char lit[] = "<light><falloff>none</falloff></light>";
    char old[1000], new[1000];
    snprintf(old, sizeof old,
        OLD("%s<surface type='Sphere'/><surface type='Sphere'>"
            "<shader type='Lambertian'/></surface>"),
        lit);
    snprintf(new, sizeof new,
        NEW("%s<surface type='Sphere'><shader type=\"MicrofacetBeckmann\">"
            "<diffuseColor>0.2 0.2 0.2</diffuseColor><microfacetColor>0 0 0</microfacetColor>"
            "<alpha>1</alpha><nt>1.5</nt></shader></surface><surface type='Sphere'>"
            "<shader type='MicrofacetBeckmann'><diffuseColor>0.2 0.2 0.2</diffuseColor>"
            "<microfacetColor>0 0 0</microfacetColor><alpha>1</alpha><nt>1.5</nt></shader>"
            "</surface>"),
        lit);
    check_text(GLINT_DIALECT_2019, old, new, 3, 0, 1);
    check_text(GLINT_DIALECT_2018,
        OLD("<light/><shader name='a' type='Phong'><diffuseColor name='d'>1 .5 0</diffuseColor>"
            "</shader><shader name='b' type='Phong'><diffuseColor ref='d'/></shader>"),
        NEW("<light><falloff>inverse-square</falloff></light><shader name='a' type='Phong'>"
            "<diffuseColor name='d'>1 .5 0</diffuseColor><diffuseColor>0.3183098861837907 "
            "0.15915494309189535 0</diffuseColor></shader><shader name='b' type='Phong'>"
            "<diffuseColor>0.3183098861837907 0.15915494309189535 0</diffuseColor></shader>"),
        2, 2, 3);
}

static void groups(void) {
    check_text(GLINT_DIALECT_2017B,
        OLD("<surface type='Group'>\n<translate>.4 .5 .6</translate> <!-- a -->\n"
            "<rotate name='r'>1 2 3</rotate><surface type='Sphere'><center ref='r'/></surface>\n"
            "<scale> .1 .7 .3 </scale>\n</surface>"
            "<surface type='Group'><rotate ref='r'/></surface>"),
        NEW("<surface type='Group'>\n<scale> .1 .7 .3 </scale> <!-- a -->\n"
            "<rotate>1 2 3</rotate><surface type='Sphere'><center>1 2 3</center></surface>\n"
            "<translate>.4 .5 .6</translate>\n</surface>"
            "<surface type='Group'><rotate>1 2 3</rotate></surface>"),
        1, 1, 0);
    /* Names and types may be written by references. */
    check_text(GLINT_DIALECT_2017B,
        OLD("<surface type='Gr&#111;up'><rotate name='a&amp;&lt;'>1 2 3</rotate>"
            "<scale ref='&#97;&#x26;&#x3C;'/></surface>"),
        NEW("<surface type='Group'><scale>1 2 3</scale><rotate>1 2 3</rotate></surface>"), 3, 0, 0);
    /* Two have no order of multiplication. */
    check_text(GLINT_DIALECT_2018B,
        OLD("<surface type='Group'><rotate>1 2 3</rotate><scale>1 2 3</scale></surface>"),
        NEW("<surface type='Group'><scale>1 2 3</scale><rotate>1 2 3</rotate></surface>"), 2, 0, 0);
}

/* ---------------------------------------------------------------- pictures */

typedef struct Tally {
    GlintDialect dialect; /* by which scenes are read */
    int files, same, rounding, different;
} Tally;

/* The largest difference of a channel, relative above 1. */
static double difference(const Picture *a, const Picture *b) {
    double most = 0;
    for (int i = 0; i < a->width * a->height * 3; i++) {
        double x = a->pixels[i], y = b->pixels[i];
        most = fmax(most, fabs(x - y) / fmax(1, fabs(x)));
    }
    return most;
}

static void check_pictures(const SceneFile *file, void *user) {
    Tally *tally = user;
    Text out, again;
    Told told, nothing;
    if (upgrade(file->bytes, file->size, tally->dialect, &out, &told) != GLINT_OK) return;
    tally->files++;
    /* Of today's scenes nothing is left to do. */
    CHECK_INT(upgrade(out.bytes, out.size, GLINT_DIALECT_AUTO, &again, &nothing), GLINT_OK);
    CHECK_TEXT(nothing.text, "");
    CHECK_TEXT(again.bytes, out.bytes);
    GlintDialect before = 0, after = 0;
    Picture a = small_picture(file->bytes, file->size, file->path, tally->dialect, &before);
    Picture b = small_picture(out.bytes, out.size, file->path, GLINT_DIALECT_AUTO, &after);
    if (a.pixels != NULL && b.pixels != NULL) {
        CHECK_INT(after, GLINT_DIALECT_GLINT);
        double most = difference(&a, &b);
        bool differs = told.counts[GLINT_CHANGE_DIFFERENT] > 0;
        bool rounds = told.counts[GLINT_CHANGE_ROUNDING] > 0;
        if (!differs && !rounds && !picture_equal(&a, &b)) {
            test_fail(__FILE__, __LINE__, "%s: said to be the same, but differs by %g\n%s",
                file->path, most, told.text);
        } else if (!differs && most > 1e-4) {
            test_fail(__FILE__, __LINE__, "%s: said to be rounded, but differs by %g\n%s",
                file->path, most, told.text);
        }
        tally->same += !differs && !rounds;
        tally->rounding += !differs && rounds;
        tally->different += differs;
    } else if (a.pixels != NULL || before != GLINT_DIALECT_AUTO) {
        test_fail(__FILE__, __LINE__, "%s: upgraded it cannot be drawn", file->path);
    }
    picture_free(&a);
    picture_free(&b);
    free(out.bytes);
    free(again.bytes);
}

/* By the rules of years that they were not made for. */
static void other_years(void) {
    for (int i = 1; i < GLINT_DIALECT_COUNT; i++) {
        Tally tally = {.dialect = (GlintDialect)i};
        each_scene_file("tests/golden", false, check_pictures, &tally);
        each_scene_file("fuzz/corpus/reader", false, check_pictures, &tally);
        CHECK(tally.files >= 20);
    }
}

static void scenes_of_ours(void) {
    Tally tally = {0};
    each_scene_file("scenes", false, check_pictures, &tally);
    each_scene_file("tests/golden", false, check_pictures, &tally);
    each_scene_file("fuzz/corpus/reader", false, check_pictures, &tally);
    CHECK(tally.files >= 37);
    CHECK(tally.same >= 19);
}

static void scenes_of_the_course(void) {
    Tally tally = {0};
    if (test_shared_dir() == NULL) {
        test_skip("there is no ../shared");
        return;
    }
    each_scene_file("reference", true, check_pictures, &tally);
    CHECK(tally.files >= 70);
    CHECK(tally.same >= 10);
}

const GiTest tests_upgrade[] = {TEST(words), TEST(lights), TEST(shaders), TEST(groups),
    TEST(scenes_of_ours), TEST(other_years), TEST(scenes_of_the_course), TEST_END};
