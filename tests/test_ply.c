/* SPDX-License-Identifier: MIT
 * PLY files: what is accepted, what is refused and in which line, in words and in bytes; the same
 * result wherever rows lie and parts begin. */
#include "test_mesh_input.h"

#include "random.h"

#include <math.h>
#include <stdarg.h>

#define PLY_ASCII "ply\nformat ascii 1.0\n"
#define PLY_XYZ   "property float x\nproperty float y\nproperty float z\n"
#define PLY_FACES "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
#define PLY_THREE PLY_ASCII "element vertex 3\n" PLY_XYZ PLY_FACES

static void ascii(void) {
    const char *flat = "1 0 0, 0 1 0, 0 0 1; ";
    check(GI_MESH_PLY, PLY_THREE "1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n", flat);
    check(GI_MESH_PLY, PLY_THREE "1 0 0 0 1 0 0 0 1\r\n3 0 1 2", flat);
    check(GI_MESH_PLY, PLY_THREE "1 0 0 0\n1 0\n0 0 1 3\n0 1 2\n", flat);
    check(GI_MESH_PLY, PLY_THREE "\n1 0 0\n\n 0 1 0\n\t\r\n0 0 1\n3 0 1 2\n\n\n", flat);
    check(GI_MESH_PLY,
        "ply\r\ncomment made by hand\r\nformat ascii 1.0\r\nobj_info x y z q r s t u v w\r\n"
        "element camera 2\r\nproperty float x\r\nproperty list uint8 float64 y\r\n"
        "element vertex 3\r\nproperty uchar red\r\nproperty float64 x\r\nproperty int16 y\r\n"
        "property list short int8 extra\r\nproperty float32 z\r\nelement nothing 1000000000000\r\n"
        "element face 1\r\nproperty uchar q\r\nproperty list uint32 uint16 vertex_index\r\n"
        "property list int float32 quality\r\nelement edge 1\r\nproperty int vertex1\r\n"
        "end_header\r\n"
        "1 2 x y\r\n2 0\r\n255 1 0 2 5 5 0\r\n255 0 1 0 0\r\n255 0 0 1 7 1\r\n"
        "1 3 0 1 2 1 .5\r\n6\r\n",
        flat);
    check(GI_MESH_PLY,
        PLY_ASCII "element face 2\nproperty list uchar int vertex_indices\n"
                  "element vertex 4\n" PLY_XYZ "end_header\n"
                  "4 0 1 2 3\n3 1 1 1\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n",
        "1 0 0, 0 1 0, 0 0 1; 1 0 0, 0 0 1, 1 1 1; 0 1 0, 0 1 0, 0 1 0; ");
    check(GI_MESH_PLY,
        PLY_ASCII "element vertex 3\n" PLY_XYZ
                  "property float nx\nproperty float ny\nproperty float nz\n"
                  "property float s\nproperty float t\n" PLY_FACES
                  "1 0 0 1 2 3 .1 .2\n0 1 0 4 5 6 .3 .4\n0 0 1 7 8 9 .5 .6\n3 0 1 2\n",
        "1 0 0 n 1 2 3 t 0.1 0.2, 0 1 0 n 4 5 6 t 0.3 0.4, 0 0 1 n 7 8 9 t 0.5 0.6; ");
    check(GI_MESH_PLY,
        PLY_ASCII "element vertex 3\n" PLY_XYZ "property float nx\nproperty float texture_u\n"
                  "property float texture_v\n" PLY_FACES
                  "1 0 0 1 2 3\n0 1 0 4 5 6\n0 0 1 7 8 9\n3 0 1 2\n",
        "1 0 0 t 2 3, 0 1 0 t 5 6, 0 0 1 t 8 9; ");
}

/* A file of bytes, made value by value. */
typedef struct Bytes {
    char data[1 << 16];
    size_t size;
    bool big;
} Bytes;

static void put(Bytes *bytes, const void *value, size_t size) {
    for (size_t i = 0; i < size; i++) {
        uint64_t bits = 0;
        if (size == 1) bits = *(const uint8_t *)value;
        if (size == 2) bits = *(const uint16_t *)value;
        if (size == 4) bits = *(const uint32_t *)value;
        if (size == 8) bits = *(const uint64_t *)value;
        size_t shift = 8 * (bytes->big ? size - 1 - i : i);
        bytes->data[bytes->size++] = (char)(bits >> shift);
    }
}

static void put_text(Bytes *bytes, const char *text) {
    memcpy(bytes->data + bytes->size, text, strlen(text));
    bytes->size += strlen(text);
}

static void make_binary(Bytes *bytes, bool big, float last, int32_t corner) {
    *bytes = (Bytes){.big = big};
    put_text(bytes, "ply\nformat binary_");
    put_text(bytes, big ? "big" : "little");
    put_text(bytes, "_endian 1.0\nelement before 1\nproperty short a\nelement vertex 4\n"
                    "property float x\nproperty double y\nproperty uchar red\nproperty float z\n"
                    "property double u\nproperty float v\nelement face 2\nproperty short a\n"
                    "property list ushort int vertex_indices\nproperty list uchar double b\n"
                    "end_header\n");
    put(bytes, &(int16_t){-1}, 2);
    for (int i = 0; i < 4; i++) {
        put(bytes, &(float){(float)i}, 4);
        put(bytes, &(double){i + 0.5}, 8);
        put(bytes, &(uint8_t){10}, 1);
        put(bytes, &(float){i == 3 ? last : -1}, 4);
        put(bytes, &(double){7}, 8);
        put(bytes, &(float){0.25f}, 4);
    }
    for (int i = 0; i < 2; i++) {
        put(bytes, &(int16_t){10}, 2);
        put(bytes, &(uint16_t){(uint16_t)(3 + i)}, 2);
        for (int k = 0; k < 3 + i; k++) put(bytes, &(int32_t){k == 3 ? corner : k}, 4);
        put(bytes, &(uint8_t){(uint8_t)i}, 1);
        if (i == 1) put(bytes, &(double){5}, 8);
    }
}

static void binary(void) {
    for (int big = 0; big < 2; big++) {
        Bytes bytes;
        make_binary(&bytes, big != 0, -2, 3);
        const char *expected = "0 0.5 -1 t 7 0.25, 1 1.5 -1 t 7 0.25, 2 2.5 -1 t 7 0.25; "
                               "0 0.5 -1 t 7 0.25, 1 1.5 -1 t 7 0.25, 2 2.5 -1 t 7 0.25; "
                               "0 0.5 -1 t 7 0.25, 2 2.5 -1 t 7 0.25, 3 3.5 -2 t 7 0.25; ";
        check_bytes(GI_MESH_PLY, bytes.data, bytes.size, expected);
        bytes.data[bytes.size] = 'x'; /* what follows is not looked at */
        check_bytes(GI_MESH_PLY, bytes.data, bytes.size + 1, expected);
        for (size_t size = strlen(PLY_ASCII); size < bytes.size; size++) {
            Loaded loaded = {.status = GLINT_OK};
            gi_memory_init(&loaded.memory, NULL, 0);
            load_more(&loaded, GI_MESH_PLY, bytes.data, size, 1, 0);
            CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
            unload(&loaded);
        }
        check_bytes(
            GI_MESH_PLY, bytes.data, bytes.size - 1, "0: the file ends before its last element");
        make_binary(&bytes, big != 0, INFINITY, 3);
        check_bytes(GI_MESH_PLY, bytes.data, bytes.size, "0: a number of a vertex is not finite");
        make_binary(&bytes, big != 0, 1, 4);
        check_bytes(
            GI_MESH_PLY, bytes.data, bytes.size, "0: face 1 names vertex 4, but there are 4");
        make_binary(&bytes, big != 0, 1, -1);
        check_bytes(
            GI_MESH_PLY, bytes.data, bytes.size, "0: face 1 names vertex -1, but there are 4");
    }
}

static void faults(void) {
    static const char *const cases[][2] = {
        {"", "1: expected \"ply\", found nothing"},
        {"plx\n", "1: expected \"ply\", found \"plx\""},
        {"ply\n", "2: the file ends within its header"},
        {"ply\nformat\n",
            "2: expected ascii, binary_little_endian or binary_big_endian, found nothing"},
        {"ply\nformat text 1.0\n",
            "2: expected ascii, binary_little_endian or binary_big_endian, found \"text\""},
        {"ply\nformat ascii 2.0\n", "2: expected 1.0, found \"2.0\""},
        {PLY_ASCII "format ascii 1.0\n", "3: a second format"},
        {PLY_ASCII "colour red\n", "3: expected a line of a header, found \"colour\""},
        {PLY_ASCII "property int x\n", "3: a property without an element"},
        {PLY_ASCII "element\n", "3: expected the name of an element, found nothing"},
        {PLY_ASCII "element a\n", "3: expected a number of elements, found nothing"},
        {PLY_ASCII "element a -1\n", "3: expected a number of elements, found \"-1\""},
        {PLY_ASCII "element a 1x\n", "3: expected a number of elements, found \"1x\""},
        {PLY_ASCII "element a 1 2\n", "3: expected the end of the line, found \"2\""},
        {PLY_ASCII "element face 1\nelement face 1\n", "4: a second element \"face\""},
        {PLY_ASCII "element a 1\nproperty\n", "4: expected a type, found nothing"},
        {PLY_ASCII "element a 1\nproperty half x\n", "4: expected a type, found \"half\""},
        {PLY_ASCII "element a 1\nproperty int\n",
            "4: expected the name of a property, found nothing"},
        {PLY_ASCII "element a 1\nproperty int x y\n",
            "4: expected the end of the line, found \"y\""},
        {PLY_ASCII "element a 1\nproperty list float int x\n",
            "4: expected the type of a whole number, found \"float\""},
        {PLY_ASCII "element face 1\nproperty list int float vertex_indices\n",
            "4: expected the type of a whole number, found \"float\""},
        {"ply\nelement a 1\nend_header\n", "3: the header names no format"},
        {PLY_ASCII "end_header\n", "3: there is no element \"vertex\""},
        {PLY_ASCII "element vertex 1\n" PLY_XYZ "end_header", "7: there is no element \"face\""},
        {PLY_ASCII "element vertex 1\nproperty float x\nproperty float z\n" PLY_FACES,
            "8: a vertex lacks x, y or z"},
        {PLY_ASCII "element vertex 1\n" PLY_XYZ "element face 1\nproperty int a\nend_header\n",
            "9: a face lacks its list vertex_indices"},
        {PLY_THREE "1 2 3\n", "11: the file ends before its last element"},
        {PLY_THREE "1 2 3 4 5 6 7 8 9\n3 1 2\n", "12: the file ends before its last element"},
        {PLY_THREE "1 2 3 4 5 x 7 8 9\n3 0 1 2\n", "10: expected a number, found \"x\""},
        {PLY_THREE "1 2 3 4 5 1e50 7 8 9\n3 0 1 2\n",
            "10: 1e50 is beyond the range of single precision"},
        {PLY_THREE "1 2 3 4 5 6 7 8 9\n3 0 1 3\n", "11: face 0 names vertex 3, but there are 3"},
        {PLY_THREE "1 2 3 4 5 6 7 8 9\n3 0 1 -1\n", "11: face 0 names vertex -1, but there are 3"},
        {PLY_THREE "1 2 3 4 5 6 7 8 9\n3 0 1 1.5\n", "11: expected a whole number, found \"1.5\""},
        {PLY_THREE "1 2 3 4 5 6 7 8 9\n2 0 1\n", "11: face 0 has 2 corners, which is less than 3"},
        {PLY_THREE "1 2 3 4 5 6 7 8 9\n-2 0 1\n", "11: a list has -2 entries"},
        {PLY_THREE "1 2 3 4 5 6 7 8 9\n9999999999999999999999 0 1\n",
            "12: the file ends before its last element"},
        {PLY_THREE "1 2 3 4 5 6 7 8 9\n3 0 1 2\n1",
            "12: expected the end of the file, found \"1\""},
        {PLY_ASCII "element vertex 1000000000000\n" PLY_XYZ PLY_FACES "1 2 3\n",
            "11: the file ends before its last element"},
        {PLY_ASCII "element vertex 1\n" PLY_XYZ
                   "element face 0\nproperty list int int vertex_index\nend_header\n1 2 3",
            "0: the mesh has no triangles"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        check(GI_MESH_PLY, cases[i][0], cases[i][1]);
    }
}

/* ---------------------------------------------------------------- many rows */

typedef enum Encoding { ASCII, LITTLE_ENDIAN_BYTES, BIG_ENDIAN_BYTES, ENCODING_COUNT } Encoding;

enum { VERTEX_COUNT = 50, FACE_COUNT = 90 };

/* The same numbers in any encoding. */
typedef struct Many {
    Encoding encoding;
    int corner_count;      /* of each face; 0: from 3 to 5 */
    bool vertex_lists;     /* whether vertices have a list */
    const char *separator; /* behind a row of words; null: anything behind any word */
    int far_face;          /* this face and those after it name a vertex that is not there */
    int short_face;        /* this one has two corners */
    int fault_line;        /* of the first of these */
    size_t middle_count;   /* where the number of corners of a face in the middle is */
    Random random;
    Bytes bytes;
} Many;

static void put_value(Many *many, char type, int value) {
    static const char *const separators[] = {" ", "\n", "\t", "\r\n", "\n \n\n", "  "};
    Bytes *bytes = &many->bytes;
    switch (many->encoding == ASCII ? 'a' : type) {
    case 'a': {
        char text[20];
        snprintf(text, sizeof text, "%d", value);
        put_text(bytes, text);
        put_text(bytes, many->separator != NULL ? " " : separators[random_below(&many->random, 6)]);
        break;
    }
    case 'b': put(bytes, &(uint8_t){(uint8_t)value}, 1); break;
    case 's': put(bytes, &(int16_t){(int16_t)value}, 2); break;
    case 'i': put(bytes, &(int32_t){value}, 4); break;
    case 'f': put(bytes, &(float){(float)value}, 4); break;
    case 'd': put(bytes, &(double){value}, 8); break;
    default: break;
    }
}

static void end_row(Many *many) {
    if (many->encoding == ASCII && many->separator != NULL) {
        put_text(&many->bytes, many->separator);
    }
}

/* Whole numbers from `first` on that name vertices. */
static void put_list(Many *many, char type, int count, int first) {
    put_value(many, 'b', count);
    for (int i = 0; i < count; i++) put_value(many, type, (first + i * i) % VERTEX_COUNT);
}

static int line_of_end(const Bytes *bytes) {
    int line = 1;
    for (size_t i = 0; i < bytes->size; i++) line += bytes->data[i] == '\n';
    return line;
}

/* Faults begin with the last corner of a face or with its number of corners. */
static void put_corners(Many *many, int face) {
    int count = many->corner_count > 0 ? many->corner_count : 3 + face * face % 7 % 3;
    if (face == many->short_face) {
        many->fault_line = line_of_end(&many->bytes);
        count = 2;
    }
    if (face == FACE_COUNT / 2) many->middle_count = many->bytes.size;
    put_value(many, 'b', count);
    for (int i = 0; i < count; i++) {
        bool is_far = face >= many->far_face && i == count - 1;
        if (is_far && face == many->far_face) many->fault_line = line_of_end(&many->bytes);
        put_value(many, 'i', is_far ? VERTEX_COUNT : (face + i * i) % VERTEX_COUNT);
    }
}

static void put_header(Many *many) {
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    char text[1000];
    snprintf(text, sizeof text,
        "ply\nformat %s 1.0\nelement before 3\nproperty list uchar short a\nelement vertex %d\n"
        "property float x\n%sproperty short y\nproperty uchar red\nproperty double z\n"
        "element nothing 7\nelement between 2\nproperty int a\nelement face %d\n"
        "property short a\nproperty list uchar int vertex_indices\nproperty list uchar float b\n"
        "element after 4\nproperty double a\nend_header\n",
        names[many->encoding], VERTEX_COUNT,
        many->vertex_lists ? "property list uchar float a\n" : "", FACE_COUNT);
    put_text(&many->bytes, text);
}

static void make_many(Many *many) {
    many->bytes.size = 0;
    many->bytes.big = many->encoding == BIG_ENDIAN_BYTES;
    put_header(many);
    for (int i = 0; i < 3; i++, end_row(many)) put_list(many, 's', i, i);
    for (int i = 0; i < VERTEX_COUNT; i++, end_row(many)) {
        put_value(many, 'f', i);
        if (many->vertex_lists) put_list(many, 'f', i % 3, i);
        put_value(many, 's', i * i % 100 - 50);
        put_value(many, 'b', 200);
        put_value(many, 'd', i * 123456);
    }
    for (int i = 0; i < 2; i++, end_row(many)) put_value(many, 'i', i);
    for (int i = 0; i < FACE_COUNT; i++, end_row(many)) {
        put_value(many, 's', i);
        put_corners(many, i);
        put_list(many, 'f', many->corner_count > 0 ? 1 : i % 3, i);
    }
    for (int i = 0; i < 4; i++, end_row(many)) put_value(many, 'd', i);
}

static Many many_of(Encoding encoding, int corner_count, const char *separator) {
    return (Many){.encoding = encoding,
        .corner_count = corner_count,
        .separator = separator,
        .far_face = FACE_COUNT,
        .short_face = FACE_COUNT,
        .random = {5}};
}

/* Triangles, quadrangles and mixed polygons, in each encoding, a row a line or not. */
static void many(void) {
    static const char *const separators[] = {"\n", "\r\n", " ", "\n\n \n", NULL};
    for (int k = 0; k < 6; k++) {
        Many made = many_of(ASCII, k / 2 > 0 ? k / 2 + 2 : 0, "\n");
        made.vertex_lists = k % 2 != 0;
        make_many(&made);
        Loaded loaded = {.status = GLINT_OK};
        gi_memory_init(&loaded.memory, NULL, 0);
        load_more(&loaded, GI_MESH_PLY, made.bytes.data, made.bytes.size, 1, 0);
        CHECK_INT(loaded.status, GLINT_OK);
        CHECK(loaded.store.corners.count >= FACE_COUNT);
        char expected[1 << 16];
        snprintf(expected, sizeof expected, "%s", describe(&loaded));
        unload(&loaded);
        for (int i = 0; i < 5; i++) {
            made.separator = separators[i];
            make_many(&made);
            check_bytes(GI_MESH_PLY, made.bytes.data, made.bytes.size, expected);
        }
        for (int encoding = LITTLE_ENDIAN_BYTES; encoding < ENCODING_COUNT; encoding++) {
            made.encoding = (Encoding)encoding;
            make_many(&made);
            check_bytes(GI_MESH_PLY, made.bytes.data, made.bytes.size, expected);
        }
    }
}

static void check_many(Many *many, const char *message) {
    char expected[200];
    make_many(many);
    snprintf(expected, sizeof expected, "%d: %s", many->encoding == ASCII ? many->fault_line : 0,
        message);
    check_bytes(GI_MESH_PLY, many->bytes.data, many->bytes.size, expected);
}

/* Of several faults the first counts, but what is missing counts before what is wrong. */
static void many_faults(void) {
    static const char *const separators[] = {"\n", " ", NULL};
    for (int k = 0; k < 6 * ENCODING_COUNT; k++) {
        Many made = many_of((Encoding)(k / 6), k % 2 * 3, separators[k / 2 % 3]);
        made.far_face = 60;
        check_many(&made, "face 60 names vertex 50, but there are 50");
        made.short_face = 80;
        check_many(&made, "face 80 has 2 corners, which is less than 3");
        made.short_face = FACE_COUNT;
        make_many(&made);
        made.bytes.size = made.bytes.size * 4 / 5;
        char expected[200];
        snprintf(expected, sizeof expected, "%d: the file ends before its last element",
            made.encoding == ASCII ? line_of_end(&made.bytes) : 0);
        check_bytes(GI_MESH_PLY, made.bytes.data, made.bytes.size, expected);
        if (made.encoding != ASCII) continue;
        make_many(&made);
        snprintf(expected, sizeof expected, "%d: expected the end of the file, found \"1\"",
            line_of_end(&made.bytes));
        put_text(&made.bytes, "1\n2 3\n");
        check_bytes(GI_MESH_PLY, made.bytes.data, made.bytes.size, expected);
    }
}

/* ---------------------------------------------------------------- others who take part */

/* Does something when it is asked for the n-th time whether to go on. */
typedef struct Event {
    int calls, n;
    char *byte; /* null: cancels */
    char value; /* that the byte gets */
} Event;

static bool on_call(void *user) {
    Event *event = user;
    if (++event->calls != event->n) return false;
    if (event->byte == NULL) return true;
    *event->byte = event->value;
    return false;
}

static GlintStatus load_with_event(const Bytes *bytes, int thread_count, Event *event, char *text) {
    GlintMonitor monitor = {.cancelled = on_call, .user = event};
    GiMeshSource source = {.bytes = bytes->data,
        .size = bytes->size,
        .format = GI_MESH_PLY,
        .thread_count = thread_count,
        .chunk_size = 64,
        .monitor = &monitor};
    Loaded loaded = {.status = GLINT_OK};
    gi_memory_init(&loaded.memory, NULL, 0);
    loaded.status =
        gi_mesh_read(&loaded.store, &loaded.memory, &source, &loaded.mesh, &loaded.fault);
    snprintf(text, sizeof loaded.fault.message, "%s", loaded.fault.message);
    unload(&loaded);
    return loaded.status;
}

static void cancelled(void) {
    for (int k = 0; k < 12; k++) {
        Many made = many_of((Encoding)(k % 3), k / 3 % 2 * 3, "\n");
        make_many(&made);
        int cancelled_count = 0;
        for (int n = 1;; n++) {
            Event event = {.n = n};
            char message[256];
            GlintStatus status = load_with_event(&made.bytes, k / 6 + 1, &event, message);
            if (event.calls < n) {
                CHECK_INT(status, GLINT_OK);
                break;
            }
            CHECK_INT(status, GLINT_CANCELLED);
            cancelled_count++;
        }
        /* Of several threads one is asked, which may find all done. */
        CHECK(k >= 6 || cancelled_count > 20);
    }
}

/* Another program writes to the file between the passes, or meanwhile. */
static void changed(void) {
    int refused = 0;
    for (int k = 0; k < 2 * ENCODING_COUNT; k++) {
        Many made = many_of((Encoding)(k / 2), 4, "\n");
        for (int n = 1;; n++) {
            make_many(&made);
            char *byte = made.bytes.data + made.middle_count;
            Event event = {.n = n, .byte = byte, .value = (char)(*byte + (k % 2 != 0 ? 1 : -1))};
            char message[256];
            GlintStatus status = load_with_event(&made.bytes, 1, &event, message);
            if (event.calls < n) break;
            CHECK(status == GLINT_OK || status == GLINT_ERROR_SCENE);
            refused += strcmp(message, "the file changed while it was read") == 0;
        }
    }
    CHECK(refused > 0);
}

const GiTest tests_ply[] = {TEST(ascii), TEST(binary), TEST(faults), TEST(many), TEST(many_faults),
    TEST(cancelled), TEST(changed), TEST_END};
