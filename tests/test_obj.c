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

/* ---------------------------------------------------------------- parsing */

/* A text as it is, and with each line indented, which makes it go the long way. */
static void check_lines(const char *text, bool good) {
    static char indented[1 << 17];
    char *p = indented;
    for (const char *q = text; *q != '\0'; q++) {
        if (q == text || q[-1] == '\n') *p++ = ' ';
        *p++ = *q;
    }
    *p = '\0';
    Loaded plain, other;
    load(&plain, GI_MESH_OBJ, text);
    load(&other, GI_MESH_OBJ, indented);
    CHECK_INT(plain.status, good ? GLINT_OK : GLINT_ERROR_SCENE);
    CHECK_TEXT(describe(&plain), describe(&other));
    const GiMeshStore *a = &plain.store, *b = &other.store;
    bool same = a->positions.count == b->positions.count && a->normals.count == b->normals.count &&
                a->texcoords.count == b->texcoords.count && a->corners.count == b->corners.count;
    if (same && good) {
        size_t positions = a->positions.count * sizeof a->positions.data[0];
        size_t normals = a->normals.count * sizeof a->normals.data[0];
        size_t texcoords = a->texcoords.count * sizeof a->texcoords.data[0];
        size_t corners = a->corners.count * sizeof a->corners.data[0];
        same = memcmp(a->positions.data, b->positions.data, positions) == 0 &&
               (normals == 0 || memcmp(a->normals.data, b->normals.data, normals) == 0) &&
               (texcoords == 0 || memcmp(a->texcoords.data, b->texcoords.data, texcoords) == 0) &&
               memcmp(a->corners.data, b->corners.data, corners) == 0;
    }
    CHECK(same);
    check(GI_MESH_OBJ, text, describe(&plain));
    unload(&plain);
    unload(&other);
}

static char *put(char *p, const char *text) {
    size_t size = strlen(text);
    memcpy(p, text, size + 1);
    return p + size;
}

/* Now as any program writes it, now as hardly any does, now about half-way between two floats. */
static char *put_number(char *p, Random *random) {
    static const char *const odd[] = {"0", "-0", "+1", ".5", "-.5", "5.", "1e3", "-1.5E-3", "1e-40",
        "123456789", "1234567890", "0.1234567890123456", "0.12345678901234567", "16777217",
        "16777217.0000000000000000000000001", "1.000000059604644775390625",
        "0.00000000000000000000001", "123456789.123456789", "12.345678", "-1.2345678901"};
    int kind = random_below(random, 8);
    double value = random_real(random, -10, 10);
    if (kind == 0) return put(p, odd[random_below(random, 20)]);
    if (kind == 1) return p + sprintf(p, "%.*f", 8 + random_below(random, 12), value);
    return p + sprintf(p, "%.*g", 1 + random_below(random, 10), value);
}

static char *put_vector(char *p, Random *random, const char *keyword, int count) {
    p = put(p, keyword);
    for (int i = 0; i < count; i++) {
        p = put(p, random_below(random, 20) == 0 ? "  " : " ");
        p = put_number(p, random);
    }
    return p;
}

static char *put_face(char *p, Random *random, int style, int vertices) {
    p = put(p, "f");
    for (int i = 2 + random_below(random, 3 + 20 * (style == 4)); i >= 0; i--) {
        int a = 1 + random_below(random, vertices), b = 1 + random_below(random, vertices);
        if (random_below(random, 30) == 0) a -= vertices + 1;
        if (style == 0) p += sprintf(p, " %d", a);
        if (style == 1) p += sprintf(p, " %d//%d", a, a);
        if (style == 2) p += sprintf(p, " %d/%d", a, b);
        if (style >= 3) p += sprintf(p, " %d/%d/%d", a, b, a);
    }
    return p;
}

static void plain_lines(void) {
    static char text[1 << 16];
    Random random = {23};
    for (int round = 0; round < 200; round++) {
        const char *end = round % 3 == 0 ? "\r\n" : round % 7 == 0 ? " \n" : "\n";
        char *p = text;
        int vertices = 20;
        for (int i = 0; i < vertices; i++) {
            p = put_vector(p, &random, "v", i % 9 == 0 ? 6 : 3);
            p = put_vector(put(p, end), &random, "vn", 3);
            p = put_vector(put(p, end), &random, "vt", i % 9 == 0 ? 1 : 2);
            p = put(p, end);
        }
        for (int i = 0; i < 40; i++) {
            if (i % 16 == 0) p += sprintf(p, "# a comment%sf 1/ 2// 3/1/%s", end, end);
            p = put_face(p, &random, round % 5, vertices);
            p = put(p, i == 39 && round % 2 == 0 ? "" : end);
        }
        check_lines(text, true);
    }
}

/* One line with a fault among plain ones. */
static void faulty_lines(void) {
    static const char *const faults[] = {"v 1 2", "v 1 2 3 4 5 6 7 8", "v 1 2 3x", "v 1 2\x01 3",
        "v 1 2 1e39", "vn 1 2", "vn 1 2 3 4", "vt 1 2 3 4", "vt", "f 1 2 21", "f 1 2 0", "f 1 2",
        "f 1//1 2//2 3//21", "f 1/1 2/2 3/21", "f 1 2 3///1", "f 1 2 3/1/1/1", "f 1 2 12345678",
        "f 1 2 4294967297", "f 1 2 -21", "f 1 2 3 \\ 4", "vv 1 2 3", "f1 2 3",
        /* the next line is no part of it */
        "v 1 2\n3", "v 1\n2\n3", "vn 0 0\n1", "vt 0.5\n1"};
    static char text[1 << 14];
    Random random = {29};
    for (size_t k = 0; k < sizeof faults / sizeof faults[0]; k++) {
        char *p = text;
        for (int i = 0; i < 20; i++) {
            p += sprintf(p, "v %d 0.5 1\nvn 0 0 1\nvt 0.5 0.25\n", i);
        }
        for (int i = 0; i < 20; i++) {
            p = put_face(p, &random, 3, 20);
            p += sprintf(p, "\n%s\n", i == 10 ? faults[k] : "");
        }
        check_lines(text, false);
    }
}

const GiTest tests_obj[] = {
    TEST(counts), TEST(few_corners), TEST(plain_lines), TEST(faulty_lines), TEST_END};
