/* SPDX-License-Identifier: MIT
 * Lines of OBJ files as nearly all are written go a shorter way: whether they give there what they
 * give on the long way, which a file is made to go by blanks that change nothing. */
#include "test_mesh_input.h"

#include "mesh/obj.h"
#include "random.h"

#include <stdlib.h>

/* ---------------------------------------------------------------- counting */

static void check_counts(const char *text) {
    /* A copy of exact size, so that reading past the end is found; and an indented one. */
    size_t length = strlen(text);
    char *copy = malloc(length + 1), *indented = malloc(length + 2);
    memcpy(copy, text, length);
    memcpy(indented, " \n", 2);
    memcpy(indented + 2, text, length);
    const char *face, *other_face;
    GiMeshCounts counts = gi_obj_count(copy, copy + length, &face);
    GiMeshCounts others = gi_obj_count(indented, indented + 2 + length, &other_face);
    bool same_face = face == NULL ? other_face == NULL
                                  : other_face != NULL && face - copy == other_face - indented - 2;
    if (counts.positions != others.positions || counts.normals != others.normals ||
        counts.texcoords != others.texcoords || counts.triangles != others.triangles ||
        !same_face) {
        test_fail(__FILE__, __LINE__, "other counts of \"%s\"", text);
    }
    free(copy);
    free(indented);
}

static void counts(void) {
    static const char *const lines[] = {"v 1 2 3", "v -0.5 1e-3 2 0.5 0.5 0.5", "vn 0 0 1",
        "vt 0.25 0.75", "f 1 2 3", "f 1//1 2//2 3//3 4//4 5//5", "f 1/1/1 2/2/2 3/3/3", "f 1 2 3 ",
        "f 1  2\t3", "f 123456/123456/123456 123457/123457/123457 123458/123458/123458",
        "usemtl red", "g f 1 2 3 4", "s off", "o v", "vp 1 2", "vnx 1", "f1 2 3", "v", "vn", "vt",
        "fx 1 2 3", "# v 1 2 3", "#f 1 2 3 4", "", "", "mtllib f:\\v\\f.mtl",
        /* from here on what only the long way can count */
        "f 1 2 3 # 4 5", " v 1 2 3", "\tf 1 2 3", "v 1 \\", "f 1 2 3 \\", "f 1 2 3\\", "f\v1\f2 3"};
    enum { LINES = sizeof lines / sizeof lines[0], PLAIN = LINES - 7 };
    static char text[4096];
    Random random = {11};
    for (int round = 0; round < 4000; round++) {
        int kinds = round % 4 == 0 ? LINES : PLAIN, count = 1 + random_below(&random, 40);
        const char *end = round % 3 == 0 ? "\r\n" : "\n";
        char *p = text;
        for (int i = 0; i < count; i++) {
            p += sprintf(p, "%s%s", lines[random_below(&random, kinds)], end);
        }
        /* The last line may end with the file. */
        if (random_below(&random, 2) == 0) p[-(long)strlen(end)] = '\0';
        check_counts(text);
    }
    const char *face;
    GiMeshCounts plain = gi_obj_count("", "", &face);
    CHECK(plain.positions == 0 && plain.triangles == 0 && face == NULL);
}

/* What the sum of the corners hides: faces with too few of them beside others with many. */
static void few_corners(void) {
    static char text[1 << 14];
    for (int corners = 0; corners < 3; corners++) {
        char *p = text, expected[100];
        p += sprintf(p, "v 1 0 0\nv 0 1 0\nv 0 0 1\n");
        for (int i = 0; i < 300; i++) {
            bool faulty = i == 200 || i == 250;
            p += sprintf(p, "f%.*s\n", 2 * (faulty ? corners : 3 + i % 2), " 1 2 3 1");
        }
        snprintf(expected, sizeof expected, "204: a face has at least 3 corners, not %d", corners);
        check(GI_MESH_OBJ, text, expected);
        Loaded whole;
        load(&whole, GI_MESH_OBJ, text);
        CHECK_TEXT(describe(&whole), expected);
        unload(&whole);
    }
}

const GiTest tests_obj[] = {TEST(counts), TEST(few_corners), TEST_END};
