/* SPDX-License-Identifier: MIT
 * Mesh files but PLY: what the formats accept, what they refuse and in which line, the same result
 * for any number of threads and any borders of chunks, and numbers rounded as strtof does. */
#define _XOPEN_SOURCE 700 /* symlink */
#include "test_mesh_input.h"

#include "mesh/decimal.h"
#include "random.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

/* ---------------------------------------------------------------- numbers */

/* With nothing behind it, in a copy of exact size, so that reading past the end is found; and with
 * enough behind it for the short way. */
static void check_number(const char *text) {
    size_t length = strlen(text), sizes[] = {length, length + GI_DECIMAL_LOOK};
    char *expected_end;
    float expected = strtof(text, &expected_end);
    for (int i = 0; i < 2; i++) {
        char *copy = malloc(sizes[i] + 1);
        memset(copy, ' ', sizes[i]);
        memcpy(copy, text, length);
        float value = 0;
        const char *end = gi_decimal_read(copy, copy + sizes[i], &value);
        if (end == NULL || end - copy != expected_end - text ||
            memcmp(&value, &expected, sizeof value) != 0) {
            test_fail(
                __FILE__, __LINE__, "%s is %.9g, not %.9g", text, (double)value, (double)expected);
        }
        free(copy);
    }
}

static float float_of_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void numbers_by_hand(void) {
    static const char *const texts[] = {"0", "-0", "+0", "0.0", ".5", "5.", "-.5e1", "1e", "1e+",
        "1e+x", "1.5.5", "1-2", "123456789012345678", "1234567890123456789",
        "12345678901234567890123", "0.000000000000000000000000000000000000000000001",
        "3.4028235e38", "3.4028236e38", "340282356779733661637539395458142568447",
        "340282356779733661637539395458142568448", "340282356779733661637539395458142568449",
        "3.4028235677973366e38", "1e39", "1e400", "1e99999999999999999999", "-1e39",
        "0e99999999999999999999", "1e-45", "7e-46", "7.006492321624085e-46",
        "7.0064923216240853546186479164495807e-46", "7.0064923216240853546186479164495806e-46",
        "7.0064923216240853546186479164495e-46", "1e-46", "1e-99999999999999999999",
        "1.1754943508222875e-38", "1.17549429e-38", "1.1754942807573643e-38", "16777217",
        "16777217.0000000000000000000000001", "16777216.9999999999999999999999999", "16777219",
        "33554434", "33554435", "33554437.99999999999999999999999999999999", "0.3", "0.1",
        "3.14159274101257324", "8.5899345920e9", "1e22", "1e23", "9007199254740993"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) check_number(texts[i]);
    /* The middle of two floats, and a digit far behind that decides. */
    char long_text[300];
    snprintf(long_text, sizeof long_text, "1.000000059604644775390625%0*d", 200, 1);
    check_number(long_text);
    snprintf(long_text, sizeof long_text, "1.000000059604644775390625%0*d", 200, 0);
    check_number(long_text);
    static const char *const none[] = {
        "", "-", "+", ".", "-.", "e5", "abc", "inf", "nan", " 1", "--1", "+-1"};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        float value;
        char padded[64];
        int length = snprintf(padded, sizeof padded, "%-48s", none[i]);
        CHECK(gi_decimal_read(none[i], none[i] + strlen(none[i]), &value) == NULL);
        CHECK(gi_decimal_read(padded, padded + length, &value) == NULL);
    }
}

/* Floats as printed, what lies beside the middle of two, and digits at random. */
static void numbers_at_random(void) {
    Random random = {7};
    char text[400];
    for (int i = 0; i < 300000; i++) {
        uint32_t bits = (uint32_t)random_bits(&random) & 0x7fffffff;
        if (bits >= 0x7f7fffff) continue;
        double value = (double)float_of_bits(bits);
        double middle = (value + (double)float_of_bits(bits + 1)) / 2;
        snprintf(text, sizeof text, "%.*g", random_below(&random, 20) + 1, value);
        check_number(text);
        if (i % 4 != 0) continue;
        int length = snprintf(text, sizeof text, "%.*e", 112, middle);
        check_number(text);
        char *exponent = strchr(text, 'e');
        exponent[-1] = (char)('0' + random_below(&random, 10));
        check_number(text);
        snprintf(text, sizeof text, "%.*e", random_below(&random, 40), middle);
        check_number(text);
        CHECK(length > 0);
    }
    for (int i = 0; i < 300000; i++) {
        char *p = text;
        if (random_below(&random, 2) != 0) *p++ = '-';
        for (int k = random_below(&random, 24); k >= 0; k--) {
            *p++ = (char)('0' + random_below(&random, 10));
        }
        *p++ = '.';
        for (int k = random_below(&random, 12); k > 0; k--) {
            *p++ = (char)('0' + random_below(&random, 10));
        }
        *p = '\0';
        if (i % 2 != 0) sprintf(p, "e%d", random_below(&random, 110) - 60);
        check_number(text);
    }
}

/* ---------------------------------------------------------------- msh */

static void msh(void) {
    const char *flat = "1 0 0, 0 1 0, 0 0 1; ";
    check(GI_MESH_MSH, "3\n1\nvertices\n1\n0\n0\n0\n1\n0\n0\n0\n1\ntriangles\n0\n1\n2\n", flat);
    check(GI_MESH_MSH,
        "3\r\n1\r\nvertices\r\n1\r\n0\r\n0\r\n0\r\n1\r\n0\r\n0\r\n0\r\n1\r\ntriangles\r\n0\r\n1\r\n"
        "2",
        flat);
    check(GI_MESH_MSH, "  3 1 triangles 0 1 2\tvertices 1 0 0 0 1 0 0 0 1", flat);
    check(GI_MESH_MSH, "3 1 triangles 0 1 2 vertices 1 0 0 0 1 0 0 0 1 normals 1 2 3 4 5 6 7 8 9",
        "1 0 0 n 1 2 3, 0 1 0 n 4 5 6, 0 0 1 n 7 8 9; ");
    check(GI_MESH_MSH,
        "3 1 texcoords 1 2 3 4 5 6 triangles 0 1 2 normals 1 2 3 4 5 6 7 8 9 vertices 1 0 0 0 1 0 "
        "0 0 1",
        "1 0 0 n 1 2 3 t 1 2, 0 1 0 n 4 5 6 t 3 4, 0 0 1 n 7 8 9 t 5 6; ");
    check(GI_MESH_MSH, "2 2 vertices 1e1 -.5 +2 0 1 0 triangles 0 0 0 1 1 0",
        "10 -0.5 2, 10 -0.5 2, 10 -0.5 2; 0 1 0, 0 1 0, 10 -0.5 2; ");
}

static void msh_faults(void) {
    static const char *const cases[][2] = {
        {"", "1: the file ends before the number of vertices"},
        {"3\n", "2: the file ends before the number of triangles"},
        {"a 1 vertices", "1: expected the number of vertices, found \"a\""},
        {"-3 1 vertices", "1: expected the number of vertices, found \"-3\""},
        {"3\n1.5\n", "2: expected the number of triangles, found \"1.5\""},
        {"1 1\nvertices\n1 2 3\n", "4: there is no section \"triangles\""},
        {"1 1\ntriangles\n0 0 0", "3: there is no section \"vertices\""},
        {"1 1", "1: there is no section \"vertices\""},
        {"1 1\n7 vertices", "2: expected a keyword, found \"7\""},
        {"1 1 vertices 1 2 3\ntriangles 0 0 0\n9\n", "3: expected a keyword, found \"9\""},
        {"1 1 vertices 1 2 3\n4 triangles 0 0 0", "2: expected a keyword, found \"4\""},
        {"1 1 vertices 1 2\ntriangles 0 0 0",
            "2: the section ends after 2 of the 3 numbers of \"vertices\""},
        {"1 1 vertices 1 2 3 triangles 0\n0\n",
            "3: the file ends after 2 of the 3 numbers of \"triangles\""},
        {"1 1 vertices 1\nabc 3 triangles 0 0 0", "2: expected a number, found \"abc\""},
        {"1 1 vertices 1\nnan 3 triangles 0 0 0", "2: expected a number, found \"nan\""},
        {"1 1 vertices 1\n1x 3 triangles 0 0 0", "2: expected a number, found \"1x\""},
        {"1 1 vertices 1\n1\\ 3 triangles 0 0 0", "2: expected a number, found \"1\\\""},
        {"1 1 vertices 1\n1e39 3 triangles 0 0 0",
            "2: 1e39 is beyond the range of single precision"},
        {"1 1 vertices 1 2 3\ncolours 1\ntriangles 0 0 0", "2: unknown keyword \"colours\""},
        {"1 1 Vertices 1 2 3 triangles 0 0 0", "1: unknown keyword \"Vertices\""},
        {"1 1 vertices 1 2 3\nvertices 1 2 3 triangles 0 0 0", "2: a second section \"vertices\""},
        {"1 1 vertices 1 2 3\ntriangles 0\n1 0",
            "3: triangle 0 names vertex 1, but the last of 1 is 0"},
        {"1 1 vertices 1 2 3\ntriangles 0\n-1 0", "3: expected a vertex index, found \"-1\""},
        {"1 1 vertices 1 2 3\ntriangles 0\n0.5 0", "3: expected a vertex index, found \"0.5\""},
        {"1 0 vertices 1 2 3 triangles", "0: the mesh has no triangles"},
        {"1000000000000 1 vertices 1 2 3",
            "1: the file ends after 3 of the 3000000000000 numbers of \"vertices\""},
        {"99999999999999999999999999 1 vertices 1 2 3 triangles 0 0 0", NULL},
        {"1 1 vertices 1 2 3 triangles 0 0 0 a b c d e f g h i", "1: unknown keyword \"a\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        Loaded loaded;
        load(&loaded, GI_MESH_MSH, cases[i][0]);
        CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
        CHECK_INT(loaded.store.meshes.count, 0);
        CHECK_INT(loaded.store.positions.count, 0);
        char *expected = describe(&loaded);
        if (cases[i][1] != NULL) CHECK_TEXT(expected, cases[i][1]);
        check(GI_MESH_MSH, cases[i][0], expected);
        unload(&loaded);
    }
}

/* ---------------------------------------------------------------- obj */

static void obj(void) {
    const char *flat = "1 0 0, 0 1 0, 0 0 1; ";
    check(GI_MESH_OBJ, "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", flat);
    check(GI_MESH_OBJ, "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3", flat);
    check(GI_MESH_OBJ, "# x\r\n\r\nv 1 0 0\r\nv  0\t1 0 \r\n v 0 0 1\r\nf 1 2 3 # last\r\n", flat);
    check(GI_MESH_OBJ, "v 1 0 0 1\nv 0 1 0 .5 .5 .5\nv 0 0 1 1 .1 .2 .3\nf 1// 2/ 3\n", flat);
    check(GI_MESH_OBJ, "f 1 2 3\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", flat);
    check(GI_MESH_OBJ, "v 1 0 0\nv 0 1 0\nv 0 0 1\nf -3 -2 -1\nv 9 9 9\n", flat);
    check(GI_MESH_OBJ, "v 1 \\\n0 0\nv 0 1\\\r\n 0\nv 0 0 1\nf 1\\\n2 \\\n\\\n 3\n", flat);
    check(GI_MESH_OBJ, "# in C:\\\nv 1 0 0\n#\\\nv 0 1 0 # 1\\\nv 8 8 8\nv 0 0 1\nf 1 2 3", flat);
    check(GI_MESH_OBJ,
        "mtllib a.mtl\no bunny\ng a b\ns off\nusemtl red\nv 1 0 0\nvp 1 2\nv 0 1 0\nl 1 2\np 1\n"
        "v 0 0 1\nlod 1\ns 1\nf 1 2 3\n",
        flat);
    check(GI_MESH_OBJ, "v 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3 4\nf 4 4 4\n",
        "1 0 0, 0 1 0, 0 0 1; 1 0 0, 0 0 1, 1 1 1; 1 1 1, 1 1 1, 1 1 1; ");
}

/* Which faces have normals and texture coordinates. */
static void obj_attributes(void) {
#define VERTICES "v 1 0 0\nv 0 1 0\nv 0 0 1\n"
#define NORMALS  "vn 1 2 3\nvn 4 5 6\nvn 7 8 9\n"
#define TEXTURES "vt 1\nvt 2 3\nvt 4 5 6\n"
    check(GI_MESH_OBJ, VERTICES NORMALS "f 1//1 2//2 3//3\n",
        "1 0 0 n 1 2 3, 0 1 0 n 4 5 6, 0 0 1 n 7 8 9; ");
    check(GI_MESH_OBJ, VERTICES NORMALS "f 1//-3 2//-2 3//-1\n",
        "1 0 0 n 1 2 3, 0 1 0 n 4 5 6, 0 0 1 n 7 8 9; ");
    check(GI_MESH_OBJ, VERTICES NORMALS "f 1//1 2//1 3//1\n",
        "1 0 0 n 1 2 3, 0 1 0 n 1 2 3, 0 0 1 n 1 2 3; ");
    check(GI_MESH_OBJ, VERTICES NORMALS NORMALS NORMALS "vn 0 0 1\nf 1//10 2//2 3//3 # not 1//1\n",
        "1 0 0 n 0 0 1, 0 1 0 n 4 5 6, 0 0 1 n 7 8 9; ");
    check(GI_MESH_OBJ, VERTICES "vn 1 2 3\nf 1//1 2//2 3//3 # no more\n",
        "5: face corner 2 names normal 2, but there are 1");
    check(GI_MESH_OBJ, VERTICES NORMALS "f 1//1 2 3//3\n", "1 0 0, 0 1 0, 0 0 1; ");
    check(GI_MESH_OBJ, VERTICES NORMALS "f 1//1 2 3//3\nf 1//1 2//2 3//3\nf 1 2 3//3\n",
        "1 0 0, 0 1 0, 0 0 1; 1 0 0 n 1 2 3, 0 1 0 n 4 5 6, 0 0 1 n 7 8 9; 1 0 0, 0 1 0, 0 0 1; ");
    check(GI_MESH_OBJ, VERTICES NORMALS TEXTURES "f 1/1/1 2/2/2 3/3/3\n",
        "1 0 0 n 1 2 3 t 1 0, 0 1 0 n 4 5 6 t 2 3, 0 0 1 n 7 8 9 t 4 5; ");
    check(GI_MESH_OBJ, VERTICES NORMALS TEXTURES "f 1/1/1 2/2/2 3/3/3\nf 1/3 2/2 3/1\n",
        "1 0 0 n 1 2 3 t 1 0, 0 1 0 n 4 5 6 t 2 3, 0 0 1 n 7 8 9 t 4 5; "
        "1 0 0 t 4 5, 0 1 0 t 2 3, 0 0 1 t 1 0; ");
    check(GI_MESH_OBJ, VERTICES TEXTURES "f 1/3 2/3 3/3 1/1\n",
        "1 0 0 t 4 5, 0 1 0 t 4 5, 0 0 1 t 4 5; 1 0 0 t 4 5, 0 0 1 t 4 5, 1 0 0 t 1 0; ");
}

/* Corners of their own only where they differ; no room for what is not used. */
static void obj_memory(void) {
    Loaded loaded;
    load(&loaded, GI_MESH_OBJ, VERTICES NORMALS TEXTURES "f 1//1 2//2 3//3\n");
    const GiMesh *mesh = &loaded.store.meshes.data[0];
    CHECK(mesh->smooth && !mesh->textured);
    CHECK(mesh->normal_corners == NULL && mesh->texcoord_corners == NULL);
    CHECK_INT(loaded.store.normals.capacity, 3);
    CHECK_INT(loaded.store.texcoords.capacity, 0);
    CHECK_INT(loaded.store.corners.capacity, 1);
    /* The guess is that corners differ, and it is wrong. */
    const char *text = VERTICES NORMALS TEXTURES "f -3/1/1 2/2/2 3/3/3\n";
    load_more(&loaded, GI_MESH_OBJ, text, strlen(text), 1, 0);
    mesh = &loaded.store.meshes.data[1];
    CHECK(mesh->smooth && mesh->textured);
    CHECK(mesh->normal_corners == NULL && mesh->texcoord_corners == NULL);
    CHECK_INT(mesh->first_normal, 3);
    CHECK_INT(mesh->first_texcoord, 0);
    /* The other way round. */
    text = VERTICES NORMALS TEXTURES "f 1/1/1 2/2/2 3/3/3\nf 1/1/2 2/2/2 3/3/3\n";
    load_more(&loaded, GI_MESH_OBJ, text, strlen(text), 1, 0);
    mesh = &loaded.store.meshes.data[2];
    CHECK(mesh->normal_corners != NULL && mesh->texcoord_corners == NULL);
    CHECK_INT(mesh->normal_corners[1][0], mesh->first_normal + 1);
    CHECK_INT(mesh->first_triangle, 2);
    CHECK_INT(mesh->first_position, 6);
    CHECK_INT(loaded.store.corners.data[2][0], 6);
    /* A file that fails leaves nothing behind. */
    text = VERTICES "f 1 2 4\n";
    load_more(&loaded, GI_MESH_OBJ, text, strlen(text), 1, 0);
    CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
    CHECK_INT(loaded.store.meshes.count, 3);
    CHECK_INT(loaded.store.positions.count, 9);
    unload(&loaded);
}

static void obj_faults(void) {
    static const char *const cases[][2] = {
        {"", "0: the mesh has no triangles"},
        {"v 1 2 3\n", "0: the mesh has no triangles"},
        {"v 1 2\n", "1: expected 3 numbers, found 2"},
        {"\nv\n", "2: expected 3 numbers, found 0"},
        {"v 1 2 x\n", "1: expected a number, found \"x\""},
        {"v 1 2 3x\n", "1: expected a number, found \"3x\""},
        {"v 1 2 1,5\n", "1: expected a number, found \"1,5\""},
        {"v 1 2 nan\n", "1: expected a number, found \"nan\""},
        {"v 1 2 -inf\n", "1: expected a number, found \"-inf\""},
        {"v 1 2 0x10\n", "1: expected a number, found \"0x10\""},
        {"v 1 2 \\3\n", "1: expected a number, found \"\\3\""},
        {"v 1 2 -1e40\n", "1: -1e40 is beyond the range of single precision"},
        {"v 1 2 3 4 5 6 7 8\n", "1: expected the end of the line, found \"8\""},
        {"vn 1 2\n", "1: expected 3 numbers, found 2"},
        {"vn 1 2 3 4\n", "1: expected the end of the line, found \"4\""},
        {"vt\n", "1: expected 1 number, found 0"},
        {"vt 1 2 3 4\n", "1: expected the end of the line, found \"4\""},
        {"v 1 2 3\n\nabc 1\n", "3: unknown keyword \"abc\""},
        {"v 1 2 3\nvx 1\n", "2: unknown keyword \"vx\""},
        {"v1 2 3\n", "1: unknown keyword \"v1\""},
        {"\x01\xff 1\n", "1: unknown keyword \"??\""},
        {VERTICES "f 1 2\n", "4: a face has at least 3 corners, not 2"},
        {VERTICES "f\n", "4: a face has at least 3 corners, not 0"},
        {VERTICES "f 1 2 9\n", "4: face corner 3 names vertex 9, but there are 3"},
        {VERTICES "f 1 2 0\n", "4: face corner 3 names vertex 0, but they count from 1"},
        {VERTICES "f 1 -4 2\n", "4: face corner 2 names vertex -4, but there are 3 so far"},
        {"f 1 -1 2\n" VERTICES, "1: face corner 2 names vertex -1, but there are 0 so far"},
        {VERTICES "f 1 2 99999999999999999999999\n",
            "4: face corner 3 names vertex 99999999999999999999999, but there are 3"},
        {VERTICES "f 1 2 -99999999999999999999999\n",
            "4: face corner 3 names vertex -99999999999999999999999, but there are 3 so far"},
        {VERTICES "f 1//1 2//1 3//1\n", "4: face corner 1 names normal 1, but there are 0"},
        {VERTICES NORMALS "f 1//1 2//4 3//1\n", "7: face corner 2 names normal 4, but there are 3"},
        {VERTICES TEXTURES "f 1/1 2/2 3/4\n",
            "7: face corner 3 names texture coordinate 4, but there are 3"},
        {VERTICES "f 1 2 x\n", "4: face corner 3: expected a number, found \"x\""},
        {VERTICES "f 1 2 /1\n", "4: face corner 3: expected a number, found \"/1\""},
        {VERTICES "f 1 2 3/x\n", "4: face corner 3: expected a number, found \"x\""},
        {VERTICES "f 1 2 3x\n", "4: face corner 3 is not a, a/b, a//c or a/b/c: \"3x\""},
        {VERTICES "f 1 2 3///1\n", "4: face corner 3: expected a number, found \"/1\""},
        {VERTICES "f 1 2 1.5\n", "4: face corner 3 is not a, a/b, a//c or a/b/c: \"1.5\""},
        {VERTICES "f 1 2 3 \\ 1\n", "4: face corner 4: expected a number, found \"\\\""},
        {"v 1 2 3\\\n x\n", "2: expected a number, found \"x\""},
        {"v 1 2 a123456789012345678901234567890123456789012345678901234567890123456789\n",
            "1: expected a number, found \"a123456789012345678901234567890123456789...\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        check(GI_MESH_OBJ, cases[i][0], cases[i][1]);
    }
    check_bytes(GI_MESH_OBJ, "v 1 2\0 3\n", 9, "1: expected a number, found \"2?\"");
    check_bytes(GI_MESH_MSH, "1 1\0 3\n", 7, "1: expected the number of triangles, found \"1?\"");
}

/* A surface with thousands of lines, with now these and now those corners. */
static void obj_large(void) {
    enum { COUNT = 900 };
    static char text[1 << 18];
    static const char *const blanks[] = {"", "", "", " ", "        ", "\t"};
    static const char *const ends[] = {"\n", "\n", "\n", "  \n", "\r\n", " # 1 2\n", "\\\n\n"};
    Random random = {3};
    char *p = text;
    size_t triangles = 0;
    for (int i = 0; i < COUNT; i++) {
        if (i < 3 || random_below(&random, 2) != 0) {
            p += sprintf(p, "v %d %d %d\nvn %d 0 1\nvt %d 2\n", i, i + 1, i + 2, i, i);
        }
        if (i >= 3 && random_below(&random, 4) != 0) {
            bool relative = random_below(&random, 2) != 0;
            p += sprintf(p, "f");
            int last = random_below(&random, 4) + 2;
            triangles += (size_t)last - 1;
            for (int k = last; k >= 0; k--) {
                int at = relative ? -1 - random_below(&random, 3) : 1 + random_below(&random, 3);
                p += sprintf(p, "%s", blanks[random_below(&random, 6)]);
                if (i < 400) p += sprintf(p, " %d//%d", at, at);
                if (i >= 400 && i < 600) p += sprintf(p, " %d/%d", at, relative ? -1 : 2);
                if (i >= 600) p += sprintf(p, " %d", at);
            }
            p += sprintf(p, "%s", ends[random_below(&random, 7)]);
        }
    }
    Loaded whole;
    load(&whole, GI_MESH_OBJ, text);
    CHECK_INT(whole.status, GLINT_OK);
    CHECK(whole.store.corners.count == triangles && triangles > 1000);
    check(GI_MESH_OBJ, text, describe(&whole));
    unload(&whole);
    /* With a fault in the middle, and a second one after it. */
    memcpy(text + (p - text) / 2, "\nq\n", 3);
    memcpy(p - 20, "\nr\n", 3);
    load(&whole, GI_MESH_OBJ, text);
    CHECK_INT(whole.status, GLINT_ERROR_SCENE);
    check(GI_MESH_OBJ, text, describe(&whole));
    unload(&whole);
}

/* ---------------------------------------------------------------- memory */

typedef struct Failing {
    long requests, fail_at;
} Failing;

static void *failing_reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    Failing *failing = user;
    (void)old_size;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    /* The workers of the loader ask for nothing, so there is no need for an atomic counter. */
    return ++failing->requests == failing->fail_at ? NULL : realloc(pointer, new_size);
}

static void failing_allocator(void) {
    static const char *const texts[] = {
        "3 1 vertices 1 0 0 0 1 0 0 0 1 triangles 0 1 2 normals 1 2 3 4 5 6 7 8 9 texcoords "
        "1 2 3 4 5 6",
        VERTICES NORMALS TEXTURES "f 1/1/1 2/2/2 3/3/3\nf 3/2/1 2/2/2 1/3/1\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "property float s\nproperty float t\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "1 0 0 1 2 3 .1 .2\n0 1 0 4 5 6 .3 .4\n0 0 1 7 8 9 .5 .6\n3 0 1 2\n"};
    for (int format = 0; format < GI_MESH_FORMAT_COUNT; format++) {
        long failed = 0;
        for (long n = 1; n < 100; n++) {
            Failing failing = {.fail_at = n};
            GlintAllocator allocator = {failing_reallocate, &failing};
            Loaded loaded = {.status = GLINT_OK};
            gi_memory_init(&loaded.memory, &allocator, 0);
            load_more(&loaded, (GiMeshFormat)format, texts[format], strlen(texts[format]), 3, 8);
            if (failing.requests < n) {
                CHECK_INT(loaded.status, GLINT_OK);
                n = 100;
            } else if (loaded.status != GLINT_OK) {
                CHECK_INT(loaded.status, GLINT_ERROR_MEMORY);
                CHECK_TEXT(loaded.fault.message, "not enough memory");
                CHECK_INT(loaded.store.meshes.count, 0);
                failed++;
            }
            unload(&loaded);
        }
        CHECK(failed > 5);
    }
}

/* ---------------------------------------------------------------- calls and files */

static void by_calls(void) {
    static const GiFloat3 positions[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const GiFloat3 normals[] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    static const GiFloat2 texcoords[] = {{1, 2}, {3, 4}, {5, 6}};
    static const GiCorners triangles[] = {{0, 1, 2}, {2, 1, 3}};
    Loaded loaded = {.status = GLINT_OK};
    gi_memory_init(&loaded.memory, NULL, 0);
    GiMeshArrays arrays = {positions, NULL, NULL, triangles, 3, 1};
    for (int i = 0; i < 2; i++) {
        loaded.status =
            gi_mesh_add(&loaded.store, &loaded.memory, &arrays, &loaded.mesh, &loaded.fault);
        CHECK_INT(loaded.mesh, i);
        CHECK_TEXT(describe(&loaded), i == 0 ? "1 0 0, 0 1 0, 0 0 1; "
                                             : "1 0 0 n 1 2 3 t 1 2, 0 1 0 n 4 5 6 t 3 4, "
                                               "0 0 1 n 7 8 9 t 5 6; ");
        arrays.normals = normals;
        arrays.texcoords = texcoords;
    }
    arrays.triangle_count = 2;
    loaded.status =
        gi_mesh_add(&loaded.store, &loaded.memory, &arrays, &loaded.mesh, &loaded.fault);
    CHECK_TEXT(describe(&loaded), "0: triangle 1 names vertex 3, but there are 3");
    arrays.triangle_count = 0;
    loaded.status =
        gi_mesh_add(&loaded.store, &loaded.memory, &arrays, &loaded.mesh, &loaded.fault);
    CHECK_TEXT(describe(&loaded), "0: the mesh has no triangles");
    arrays.triangle_count = 1;
    arrays.positions = (const GiFloat3[]){{1, 0, 0}, {0, NAN, 0}, {0, 0, 1}};
    loaded.status =
        gi_mesh_add(&loaded.store, &loaded.memory, &arrays, &loaded.mesh, &loaded.fault);
    CHECK_TEXT(describe(&loaded), "0: a number of the mesh is not finite");
    arrays.triangle_count = (size_t)GI_SHAPE_INDEX_LIMIT + 1;
    CHECK_INT(loaded.store.meshes.count, 2);
    unload(&loaded);
}

static const char *load_file(Loaded *loaded, const char *path, const GlintMonitor *monitor) {
    memset(loaded, 0, sizeof *loaded);
    gi_memory_init(&loaded->memory, NULL, 0);
    loaded->status = gi_mesh_load(
        &loaded->store, &loaded->memory, 2, path, NULL, monitor, &loaded->mesh, &loaded->fault);
    return describe(loaded);
}

static bool always_cancelled(void *user) {
    (void)user;
    return true;
}

static void files(void) {
    CHECK_INT(gi_mesh_format("a/b.MSH"), GI_MESH_MSH);
    CHECK_INT(gi_mesh_format(".Obj"), GI_MESH_OBJ);
    CHECK_INT(gi_mesh_format("x.obj.ply"), GI_MESH_PLY);
    CHECK_INT(gi_mesh_format("obj"), GI_MESH_FORMAT_COUNT);
    CHECK_INT(gi_mesh_format("x.obj "), GI_MESH_FORMAT_COUNT);
    Loaded loaded;
    CHECK_TEXT(load_file(&loaded, "/x/y.stl", NULL),
        "0: the name of a mesh file ends in .msh, .obj or .ply");
    CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
    unload(&loaded);
    CHECK_TEXT(
        load_file(&loaded, "/x/y.obj", NULL), "0: cannot read the file: No such file or directory");
    CHECK_INT(loaded.status, GLINT_ERROR_FILE);
    unload(&loaded);

    char path[4096];
    snprintf(path, sizeof path, "%s/mesh.obj", test_scratch_dir());
    FILE *file = fopen(path, "wb");
    CHECK(file != NULL);
    if (file == NULL) return;
    fclose(file);
    CHECK_TEXT(load_file(&loaded, path, NULL), "0: the mesh has no triangles");
    unload(&loaded);
    file = fopen(path, "wb");
    CHECK(file != NULL);
    if (file == NULL) return;
    fputs(VERTICES, file);
    /* More than what one thread is taken for. */
    for (int i = 0; i < 1000000; i++) fputs("f 1 2 3\n", file);
    fclose(file);
    load_file(&loaded, path, NULL);
    CHECK_INT(loaded.status, GLINT_OK);
    CHECK_INT(loaded.store.corners.count, 1000000);
    CHECK_INT(loaded.store.corners.data[999999][2], 2);
    CHECK(loaded.memory.peak < 12100000);
    unload(&loaded);
    GlintMonitor monitor = {.cancelled = always_cancelled};
    CHECK_TEXT(load_file(&loaded, path, &monitor), "0: the caller cancelled");
    CHECK_INT(loaded.status, GLINT_CANCELLED);
    unload(&loaded);
}

/* What cannot be mapped is read. */
static void pipes(void) {
    const char *text = VERTICES "f 1 2 3\n";
    int ends[2];
    CHECK(pipe(ends) == 0);
    CHECK(write(ends[1], text, strlen(text)) == (ssize_t)strlen(text));
    close(ends[1]);
    char target[64], path[4096];
    snprintf(target, sizeof target, "/dev/fd/%d", ends[0]);
    snprintf(path, sizeof path, "%s/pipe.obj", test_scratch_dir());
    CHECK(symlink(target, path) == 0);
    Loaded loaded;
    CHECK_TEXT(load_file(&loaded, path, NULL), "1 0 0, 0 1 0, 0 0 1; ");
    unload(&loaded);
    close(ends[0]);
}

/* The meshes of the course, where they are at hand. */
static void reference(void) {
    static const struct {
        const char *path;
        unsigned triangle_count, position_count, normal_count, texcoord_count;
    } meshes[] = {
        {"2012/TEST3/bunny500.msh", 500, 293, 0, 0},
        {"2012/TEST3/bunny500_norms.msh", 500, 293, 293, 0},
        {"2012/TEST4/check20.msh", 400, 441, 0, 0},
        {"2012/TEST4/diamond.msh", 72, 38, 0, 0},
        {"2012/TEST5/buddha100k.msh", 100000, 49950, 0, 0},
        {"2012/TEST5/bunny10k.msh", 10000, 5088, 0, 0},
        {"2012/TEST5/sphere.msh", 760, 382, 382, 0},
        {"2017/ray1/a2/data/meshes/bunny-shadow-v2.obj", 130, 71, 0, 0},
        {"2017/ray1/a2/data/meshes/plane.obj", 2, 4, 0, 4},
        {"2017/ray1/a2/data/meshes/teapot.obj", 6320, 3241, 3242, 1716},
        {"2017/ray2/a7/data/meshes/horse_norms.obj", 96966, 48485, 48485, 0},
        {"2019/ray/data/meshes/bunny.obj", 4968, 2503, 0, 0},
        {"2019/ray/data/meshes/bunnyNV.obj", 4968, 2503, 2503, 0},
        {"2018/ray1/a2/data/meshes/sphere.obj", 1984, 994, 994, 1040},
    };
    if (test_shared_dir() == NULL) {
        test_skip("there is no ../shared");
        return;
    }
    for (size_t i = 0; i < sizeof meshes / sizeof meshes[0]; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/reference/%s", test_shared_dir(), meshes[i].path);
        Loaded loaded;
        load_file(&loaded, path, NULL);
        if (loaded.status != GLINT_OK) {
            test_fail(__FILE__, __LINE__, "%s:%" PRIu64 ": %s", path, loaded.fault.line,
                loaded.fault.message);
        }
        CHECK_INT(loaded.store.corners.count, meshes[i].triangle_count);
        CHECK_INT(loaded.store.positions.count, meshes[i].position_count);
        CHECK_INT(loaded.store.normals.count, meshes[i].normal_count);
        CHECK_INT(loaded.store.texcoords.count, meshes[i].texcoord_count);
        unload(&loaded);
    }
}

const GiTest tests_mesh[] = {TEST(numbers_by_hand), TEST(numbers_at_random), TEST(msh),
    TEST(msh_faults), TEST(obj), TEST(obj_attributes), TEST(obj_memory), TEST(obj_faults),
    TEST(obj_large), TEST(failing_allocator), TEST(by_calls), TEST(files), TEST(pipes),
    TEST(reference), TEST_END};
