/* SPDX-License-Identifier: MIT
 * The layout: what it looks like, that it stays when it is laid out again, and that it means the
 * same, to the last bit of a picture. */
#include "scene_files.h"
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Said {
    int count;
    char first[300];
} Said;

static void on_finding(void *user, const GlintDiagnostic *diagnostic) {
    Said *said = user;
    if (said->count++ == 0) {
        snprintf(said->first, sizeof said->first, "%lld:%lld: %s", (long long)diagnostic->line,
            (long long)diagnostic->column, diagnostic->message);
    }
}

static GlintStatus format(const char *bytes, size_t size, Text *out, Said *said) {
    *out = (Text){0};
    *said = (Said){0};
    GlintFormatDesc desc = glint_format_desc_default();
    desc.diagnostic = on_finding;
    desc.diagnostic_user = said;
    GlintError error;
    GlintStatus status = glint_format(bytes, size, "test.xml", &desc, collect_text, out, &error);
    if (status != GLINT_OK) CHECK_INT(error.status, status);
    return status;
}

/* ---------------------------------------------------------------- what it looks like */

static void check_layout(const char *text, size_t size, const char *expected) {
    Text once, twice;
    Said said;
    CHECK_INT(format(text, size, &once, &said), GLINT_OK);
    if (said.count > 0) test_fail(__FILE__, __LINE__, "%s", said.first);
    CHECK_TEXT(once.bytes != NULL ? once.bytes : "", expected);
    if (once.bytes != NULL) {
        CHECK_INT(format(once.bytes, once.size, &twice, &said), GLINT_OK);
        CHECK_TEXT(twice.bytes != NULL ? twice.bytes : "", expected);
        free(twice.bytes);
    }
    free(once.bytes);
}

#define LAYOUT(text, expected) check_layout(text, sizeof(text) - 1, expected)
#define BEGIN                  "<scene>\n  <camera/>\n  <image>4 2</image>\n"
#define IN(text)               "<scene><camera/><image>4 2</image>\n" text "</scene>"

static void children(void) {
    LAYOUT(IN(""), BEGIN "</scene>\n");
    LAYOUT(IN("<surface type='Sphere'><radius>\n 2 </radius><center>0  1\t2</center></surface>"),
        BEGIN "  <surface type=\"Sphere\">\n    <radius>2</radius>\n    <center>0 1 2</center>\n"
              "  </surface>\n</scene>\n");
    /* Written on one line, it stays on one. */
    LAYOUT(IN("<SURFACE  type = \"Sphere\" ><Radius> 2 </Radius> </SURFACE >"),
        BEGIN "  <surface type=\"Sphere\"><radius>2</radius></surface>\n</scene>\n");
    LAYOUT(IN("<surface type='Sphere'></surface><light ></light>"),
        BEGIN "  <surface type=\"Sphere\"/>\n  <light/>\n</scene>\n");
    /* 160 columns are not too long, 161 are. */
    static const char fits[] = "<light><position>1 1 1</position><intensity>1 1 1</intensity>"
                               "<falloff>none</falloff></light>";
    char text[500], expected[500];
    for (int more = 0; more < 2; more++) {
        int digits = (int)(160 - 2 - strlen(fits) + 1) + more;
        snprintf(text, sizeof text,
            "<scene><camera/><image>4 2</image>\n<light><position>1 1 %0*d</position>"
            "<intensity>1 1 1</intensity><falloff>none</falloff></light></scene>",
            digits, 1);
        snprintf(expected, sizeof expected,
            more == 0 ? BEGIN "  <light><position>1 1 %0*d</position><intensity>1 1 1</intensity>"
                              "<falloff>none</falloff></light>\n</scene>\n"
                      : BEGIN "  <light>\n    <position>1 1 %0*d</position>\n"
                              "    <intensity>1 1 1</intensity>\n    <falloff>none</falloff>\n"
                              "  </light>\n</scene>\n",
            digits, 1);
        check_layout(text, strlen(text), expected);
    }
}

static void comments(void) {
    LAYOUT("<!--a--><?b c?><!DOCTYPE scene [<!-- ' -->\n]>" IN("") "<!--z-->",
        "<!--a-->\n<?b c?>\n<!DOCTYPE scene [<!-- ' -->\n]>\n" BEGIN "</scene>\n<!--z-->\n");
    LAYOUT(IN("<light/>   <!-- aside -->\n\n\n\n<!-- own --><light/><!-- aside\n  too -->"),
        BEGIN "  <light/> <!-- aside -->\n\n  <!-- own -->\n  <light/> <!-- aside\n"
              "too -->\n</scene>\n");
    /* Further lines move with the first, and lose blanks at their ends. */
    LAYOUT(IN("      <!-- a  \n           b\n\n    c\n\td -->\n"),
        BEGIN "  <!-- a\n       b\n\nc\nd -->\n</scene>\n");
    LAYOUT(IN("<light><position> 1 <!--\n x --> 2<!-- y -->3 4 <?z?> </position></light>"),
        BEGIN "  <light>\n    <position>1 <!--\n x --> 2<!-- y -->3 4 <?z?></position>\n"
              "  </light>\n</scene>\n");
    /* Nobody reads it, so nobody touches it. */
    LAYOUT(IN("<light name='a'/><light ref='a'> <x>  </x>\n</light><light ref='a'> </light>"),
        BEGIN "  <light name=\"a\"/>\n  <light ref=\"a\"> <x>  </x>\n</light>\n"
              "  <light ref=\"a\"/>\n</scene>\n");
}

static void texts(void) {
    /* A name may hold blanks, references and CDATA. */
    LAYOUT(IN("<surface type='Mesh'><data>\n a  &lt;b&gt;.obj\n</data></surface>"),
        BEGIN "  <surface type=\"Mesh\">\n    <data>a  &lt;b&gt;.obj</data>\n  </surface>\n"
              "</scene>\n");
    LAYOUT(IN("<surface type='Mesh'><data> <![CDATA[ a b.obj ]]> </data></surface>"),
        BEGIN "  <surface type=\"Mesh\"><data><![CDATA[ a b.obj ]]></data></surface>\n</scene>\n");
    LAYOUT(IN("&#32;<light name='\"'/>"),
        "<scene>\n  <camera/>\n  <image>4 2</image> &#32;\n  <light name='\"'/>\n</scene>\n");
    LAYOUT("\xef\xbb\xbf<?xml version='1.0' encoding='utf-8'?>\r\n<scene><camera/>\r<image>4\r\n2"
           "</image></scene>\r\n",
        "<?xml version='1.0' encoding='utf-8'?>\n" BEGIN "</scene>\n");
    LAYOUT("<?xml version='1.0' encoding='ISO-8859-1'?><scene><!--\xe9--><camera/>"
           "<image>4 2</image></scene>",
        "<?xml version='1.0' encoding='UTF-8'?>\n<scene> <!--\xc3\xa9-->\n"
        "  <camera/>\n  <image>4 2</image>\n</scene>\n");
}

static void wide(void) {
    static const char text[] = "<scene><!--\xc3\xa9 \xf0\x9f\x98\x80--><camera/>"
                               "<image>4 2</image></scene>";
    static const uint16_t units[] = {0xe9, ' ', 0xd83d, 0xde00};
    static const char before[] = "<scene><!--", after[] = "--><camera/><image>4 2</image></scene>";
    Text expected;
    Said said;
    CHECK_INT(format(text, sizeof text - 1, &expected, &said), GLINT_OK);
    for (int big = 0; big < 2; big++) {
        char bytes[400] = {0};
        size_t size = 0;
        uint16_t all[200] = {0xfeff}, count = 1;
        for (size_t i = 0; before[i] != '\0'; i++) all[count++] = (uint16_t)before[i];
        for (size_t i = 0; i < 4; i++) all[count++] = units[i];
        for (size_t i = 0; after[i] != '\0'; i++) all[count++] = (uint16_t)after[i];
        for (size_t i = 0; i < count; i++) {
            bytes[size++] = (char)(big ? all[i] >> 8 : all[i] & 0xff);
            bytes[size++] = (char)(big ? all[i] & 0xff : all[i] >> 8);
        }
        check_layout(bytes, size, expected.bytes);
    }
    free(expected.bytes);
}

static void refusals(void) {
    Text out;
    Said said;
    static const char wrong[] = "<scene>\n <camra/><image>4</image></scene>";
    CHECK_INT(format(wrong, sizeof wrong - 1, &out, &said), GLINT_ERROR_SCENE);
    CHECK_INT(said.count, 2);
    CHECK_TEXT(said.first, "2:2: unknown element `camra` in the scene: did you mean `camera`?");
    CHECK(out.bytes == NULL);
    CHECK_INT(format("", 0, &out, &said), GLINT_ERROR_SCENE);
    CHECK_INT(format("<scene", 6, &out, &said), GLINT_ERROR_SCENE);
    GlintFormatDesc desc = {0};
    CHECK_INT(glint_format("", 0, "a", &desc, collect_text, &out, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_format("", 0, "a", NULL, collect_text, &out, NULL), GLINT_ERROR_ARGUMENT);
}

/* ---------------------------------------------------------------- what it means */

static void check_file(const SceneFile *file, void *user) {
    int *drawn = user;
    Text once, twice;
    Said said;
    GlintStatus status = format(file->bytes, file->size, &once, &said);
    if (status != GLINT_OK) {
        CHECK_INT(status, GLINT_ERROR_SCENE);
        CHECK(said.count > 0 && once.bytes == NULL);
        return;
    }
    CHECK_INT(format(once.bytes, once.size, &twice, &said), GLINT_OK);
    if (twice.bytes == NULL || strcmp(once.bytes, twice.bytes) != 0) {
        test_fail(__FILE__, __LINE__, "%s: laid out again it changes", file->path);
    }
    GlintDialect before = 0, after = 0;
    Picture a = small_picture(file->bytes, file->size, file->path, GLINT_DIALECT_AUTO, &before);
    Picture b = small_picture(once.bytes, once.size, file->path, GLINT_DIALECT_AUTO, &after);
    bool same = a.pixels == NULL ? b.pixels == NULL : b.pixels != NULL && picture_equal(&a, &b);
    if (!same || before != after) {
        test_fail(__FILE__, __LINE__, "%s: laid out it is another picture", file->path);
    }
    *drawn += a.pixels != NULL;
    picture_free(&a);
    picture_free(&b);
    free(once.bytes);
    free(twice.bytes);
}

static void scenes_of_ours(void) {
    int drawn = 0;
    CHECK(each_scene_file("scenes", false, check_file, &drawn) >= 17);
    CHECK(each_scene_file("tests/golden", false, check_file, &drawn) >= 15);
    CHECK(each_scene_file("fuzz/corpus/reader", false, check_file, &drawn) >= 5);
    CHECK(drawn >= 32);
    each_scene_file("tests/malformed", false, check_file, &drawn);
}

static void scenes_of_the_course(void) {
    int drawn = 0;
    if (test_shared_dir() == NULL) {
        test_skip("there is no ../shared");
        return;
    }
    CHECK(each_scene_file("reference", true, check_file, &drawn) >= 70);
    CHECK(drawn >= 70);
}

/* ---------------------------------------------------------------- memory */

typedef struct Failing {
    int left;
} Failing;

static void *reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    Failing *failing = user;
    (void)old_size;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    return failing->left-- > 0 ? realloc(pointer, new_size) : NULL;
}

static void memory_fails(void) {
    static const char text[] = IN("<light name='a'/><!-- b --><light ref='a'/>");
    bool done = false;
    for (int n = 0; n < 500 && !done; n++) {
        Failing failing = {n};
        GlintAllocator allocator = {reallocate, &failing};
        GlintFormatDesc desc = glint_format_desc_default();
        desc.allocator = &allocator;
        Text out = {0};
        GlintStatus status =
            glint_format(text, sizeof text - 1, "a.xml", &desc, collect_text, &out, NULL);
        done = status == GLINT_OK;
        if (!done) CHECK_INT(status, GLINT_ERROR_MEMORY);
        CHECK(done == (out.bytes != NULL));
        free(out.bytes);
    }
    CHECK(done);
}

/* ---------------------------------------------------------------- tables */

static int find_type(const char *name) {
    GlintElementType type;
    for (int i = 0; glint_element_type_at(i, &type); i++) {
        if (strcmp(type.name, name) == 0) return i;
    }
    test_fail(__FILE__, __LINE__, "there is no type %s", name);
    return -1;
}

static void tables(void) {
    GlintElement element;
    GlintElementType type;
    int elements = 0, types = 0;
    CHECK(!glint_element_at(-1, &element) && !glint_element_type_at(-1, &type));
    for (; glint_element_at(elements, &element); elements++) {
        bool object = element.kind >= GLINT_ELEMENT_SCENE;
        CHECK(element.help != NULL && glint_element_kind_text(element.kind) != NULL);
        if (object != (element.example == NULL) && element.choices == NULL) {
            test_fail(__FILE__, __LINE__, "the example of %s", element.name);
        }
        /* Whatever has a place is a type's, or the scene's. */
        bool placed = glint_element_fits(elements, -1);
        for (int i = 0; glint_element_type_at(i, &type); i++) {
            placed |= glint_element_fits(elements, i);
        }
        CHECK(placed == (elements > 0));
        if (element.default_type != NULL) find_type(element.default_type);
    }
    while (glint_element_type_at(types, &type)) types++;
    CHECK(elements >= 60 && types >= 35);
    CHECK(!glint_element_at(elements, &element) && !glint_element_at(elements + 1000, &element));
    CHECK(!glint_element_fits(elements, -1) && !glint_element_fits(0, types));
    CHECK(glint_element_at(0, &element) && strcmp(element.name, "scene") == 0);
    for (int i = 0; glint_element_at(i, &element); i++) {
        if (strcmp(element.name, "theta") != 0) continue;
        CHECK(glint_element_fits(i, find_type("Cone")) && !glint_element_fits(i, -1));
        CHECK(!glint_element_fits(i, find_type("Sphere")));
        CHECK_TEXT(glint_element_range_text(element.range), "greater than 0, less than 180");
        CHECK_TEXT(element.default_text, "60");
        CHECK_TEXT(element.years, "2011");
    }
    CHECK(glint_element_range_text(GLINT_RANGE_ANY) == NULL);
}

/* ---------------------------------------------------------------- files */

static void saving(void) {
    char path[1100];
    GlintError error;
    snprintf(path, sizeof path, "%s/saved.xml", test_scratch_dir());
    CHECK_INT(glint_file_save(path, "abc", 3, &error), GLINT_OK);
    CHECK_INT(glint_file_save(path, "de", 2, &error), GLINT_OK);
    FILE *file = fopen(path, "rb");
    char text[8] = "";
    CHECK(file != NULL && fread(text, 1, sizeof text - 1, file) == 2);
    if (file != NULL) fclose(file);
    CHECK_TEXT(text, "de");
    snprintf(path, sizeof path, "%s/missing/saved.xml", test_scratch_dir());
    CHECK_INT(glint_file_save(path, "abc", 3, &error), GLINT_ERROR_FILE);
    CHECK_INT(glint_file_save(NULL, "abc", 3, &error), GLINT_ERROR_ARGUMENT);
}

const GiTest tests_format[] = {TEST(tables), TEST(saving), TEST(children), TEST(comments),
    TEST(texts), TEST(wide), TEST(refusals), TEST(scenes_of_ours), TEST(scenes_of_the_course),
    TEST(memory_fails), TEST_END};
