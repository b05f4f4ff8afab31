/* SPDX-License-Identifier: MIT
 * Pictures: the gamma curve against its formula, PNG against libpng, PFM. */
#include "base/cookie.h"
#include "base/memory.h"
#include "image/deflate.h"
#include "image/png.h"
#include "kernel/kernel.h"
#include "math/elementary.h"
#include "math/gamma.h"
#include "pictures.h"
#include "test.h"

#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- things to work with */

static float from_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint8_t encode_one(float value) {
    uint8_t byte;
    gi_gamma_encode(&value, 1, &byte);
    for (int i = 0; gi_kernel_at(i) != NULL; i++) {
        uint8_t other;
        gi_kernel_at(i)->encode(&value, 1, &other);
        CHECK_INT(other, byte);
    }
    return byte;
}

static Bytes encode(const GlintImage *image, const char *title, int thread_count) {
    Bytes bytes = {0};
    GlintSaveDesc desc = glint_save_desc_default();
    GlintError error;
    desc.title = title;
    desc.thread_count = thread_count;
    CHECK_INT(glint_image_encode_png(image, &desc, collect, &bytes, &error), GLINT_OK);
    return bytes;
}

/* ---------------------------------------------------------------- gamma */

/* The definition, worked out in double: good except within 1e-13 of a step. */
static int formula(double value) {
    if (!(value > 0)) return 0;
    double encoded = gi_pow(value, 1 / 2.2);
    return (int)floor(255 * (encoded < 1 ? encoded : 1) + 0.5);
}

static void gamma_steps_are_exact(void) {
    for (int k = 1; k <= 255; k++) {
        uint32_t low = 0, high = 0x3f800000; /* encode(low) < k <= encode(high) */
        while (high - low > 1) {
            uint32_t middle = low + (high - low) / 2;
            if (encode_one(from_bits(middle)) >= k) {
                high = middle;
            } else {
                low = middle;
            }
        }
        CHECK_INT(encode_one(from_bits(high)), k);
        CHECK_INT(encode_one(from_bits(low)), k - 1);
        CHECK_INT(formula(from_bits(high)), k);
        CHECK_INT(formula(from_bits(low)), k - 1);
        /* The step itself lies between the two floats and far enough from both for gi_pow. */
        double step = pow((k - 0.5) / 255, 2.2);
        CHECK(from_bits(low) < step * (1 - 1e-13) && step * (1 + 1e-13) < from_bits(high));
    }
}

static void gamma_follows_the_formula(void) {
    enum { COUNT = 1000003 };
    float *values = malloc(sizeof *values * COUNT);
    uint8_t *bytes = malloc(COUNT);
    uint32_t state = 7;
    for (int i = 0; i < COUNT; i++) {
        float unit = (float)next_random(&state) / (1 << 24);
        /* Even ones are spread evenly, odd ones over the exponents. */
        values[i] = i % 2 == 0 ? unit * 1.1f - 0.05f : ldexpf(1 + unit, (int)(state % 44) - 40);
    }
    gi_gamma_encode(values, COUNT, bytes);
    int wrong = 0;
    for (int i = 0; i < COUNT; i++) wrong += bytes[i] != formula(values[i]);
    CHECK_INT(wrong, 0);
    for (int i = 0; gi_kernel_at(i) != NULL; i++) {
        uint8_t *others = malloc(COUNT);
        gi_kernel_at(i)->encode(values, COUNT, others);
        CHECK(memcmp(bytes, others, COUNT) == 0);
        free(others);
    }
    free(values);
    free(bytes);
}

static void gamma_extremes(void) {
    CHECK_INT(encode_one(NAN), 0);
    CHECK_INT(encode_one(-NAN), 0);
    CHECK_INT(encode_one(from_bits(0x7fffffff)), 0);
    CHECK_INT(encode_one(INFINITY), 255);
    CHECK_INT(encode_one(-INFINITY), 0);
    CHECK_INT(encode_one(-1), 0);
    CHECK_INT(encode_one(-0.0f), 0);
    CHECK_INT(encode_one(0), 0);
    CHECK_INT(encode_one(1e-45f), 0);
    CHECK_INT(encode_one(1), 255);
    CHECK_INT(encode_one(3e38f), 255);
    float mixed[200];
    uint8_t bytes[201];
    for (int length = 0; length <= 200; length++) {
        for (int i = 0; i < length; i++) mixed[i] = (float)i / 200;
        memset(bytes, 77, sizeof bytes);
        gi_gamma_encode(mixed, (size_t)length, bytes);
        CHECK_INT(bytes[length], 77);
        if (length > 0) CHECK_INT(bytes[length - 1], encode_one(mixed[length - 1]));
        for (int i = 0; gi_kernel_at(i) != NULL; i++) {
            uint8_t others[201];
            memset(others, 77, sizeof others);
            gi_kernel_at(i)->encode(mixed, (size_t)length, others);
            CHECK(memcmp(bytes, others, sizeof bytes) == 0);
        }
    }
}

/* ---------------------------------------------------------------- PNG */

static void check_decodes(int width, int height) {
    GlintImage image = make_image(width, height, (uint32_t)(width * 31 + height));
    size_t size = 3 * (size_t)width * (size_t)height;
    uint8_t *expected = malloc(size), *decoded = malloc(size);
    glint_image_to_rgb8(&image, expected);
    Bytes bytes = encode(&image, "a title", 2);
    png_image png = {.version = PNG_IMAGE_VERSION};
    CHECK(png_image_begin_read_from_memory(&png, bytes.data, bytes.size));
    CHECK_INT(png.width, width);
    CHECK_INT(png.height, height);
    png.format = PNG_FORMAT_RGB; /* what is in the file, so nothing is converted */
    CHECK(png_image_finish_read(&png, NULL, decoded, 0, NULL));
    CHECK_INT(png.warning_or_error, 0);
    if (memcmp(expected, decoded, size) != 0) {
        test_fail(__FILE__, __LINE__, "%d x %d decodes to something else", width, height);
    }
    free(expected);
    free(decoded);
    free(bytes.data);
    free((void *)(uintptr_t)image.pixels);
}

static void png_decodes_to_the_same(void) {
    static const int sizes[][2] = {{1, 1}, {1, 2}, {2, 1}, {1, 777}, {777, 1}, {21, 22}, {22, 21},
        {63, 64}, {65, 3}, {341, 200}, {640, 1001}, {200000, 3}, {65536, 4}, {65537, 2}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        check_decodes(sizes[i][0], sizes[i][1]);
    }
}

static uint32_t get32(const uint8_t *from) {
    return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | from[3];
}

/* Bit by bit, from the definition. */
static uint32_t slow_crc(const uint8_t *bytes, size_t size) {
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

/* Checks that chunk number `index` has this name and, when data is not null, this data; the CRC in
 * any case. False when there is no such chunk. */
static bool check_chunk(
    const Bytes *bytes, int index, const char *name, const void *data, size_t size) {
    size_t at = 8;
    for (int i = 0; at + 12 <= bytes->size; i++) {
        const uint8_t *chunk = bytes->data + at;
        size_t length = get32(chunk);
        if (i == index) {
            char actual[5] = {(char)chunk[4], (char)chunk[5], (char)chunk[6], (char)chunk[7], 0};
            CHECK_TEXT(actual, name);
            CHECK_INT(get32(chunk + 8 + length), slow_crc(chunk + 4, length + 4));
            if (data != NULL) CHECK(length == size && memcmp(chunk + 8, data, size) == 0);
            return true;
        }
        at += length + 12;
    }
    CHECK_INT(at, bytes->size);
    return false;
}

static void check_title(const char *title, const char *name, const char *data, size_t size) {
    GlintImage image = make_image(2, 2, 1);
    Bytes bytes = encode(&image, title, 1);
    check_chunk(&bytes, 3, name, data, size);
    free(bytes.data);
    free((void *)(uintptr_t)image.pixels);
}

static void png_chunks(void) {
    GlintImage image = make_image(300, 700, 3);
    Bytes bytes = encode(&image, NULL, 1);
    char software[64];
    int length = snprintf(software, sizeof software, "Software%cGlint %s", 0, glint_version_text());
    CHECK(memcmp(bytes.data, "\x89PNG\r\n\x1a\n", 8) == 0);
    check_chunk(&bytes, 0, "IHDR", "\0\0\x01\x2c\0\0\x02\xbc\x08\x02\0\0\0", 13);
    check_chunk(&bytes, 1, "gAMA", "\0\0\xb1\x8f", 4);
    check_chunk(&bytes, 2, "tEXt", software, (size_t)length);
    int index = 3;
    /* 630 KB in 4 strips, and what ends the stream. */
    for (; index < 8; index++) check_chunk(&bytes, index, "IDAT", NULL, 0);
    check_chunk(&bytes, index++, "IEND", "", 0);
    CHECK(!check_chunk(&bytes, index, "", NULL, 0));
    free(bytes.data);
    free((void *)(uintptr_t)image.pixels);
}

static void png_titles(void) {
    check_title("plain", "tEXt", "Title\0plain", 11);
    check_title("", "tEXt", "Title", 6);
    check_title("Stra\xc3\x9f"
                "e",
        "tEXt",
        "Title\0Stra\xdf"
        "e",
        12);
    check_title("\xe2\x82\xac 5", "iTXt", "Title\0\0\0\0\0\xe2\x82\xac 5", 15);
    check_title("\xe2\x82\xac\xc2\x85", "iTXt", "Title\0\0\0\0\0\xe2\x82\xac?", 14);
    check_title("\xf0\x9f\x98\x80", "iTXt", "Title\0\0\0\0\0\xf0\x9f\x98\x80", 14);
    check_title("a\xff\xc3", "tEXt", "Title\0a??", 9);          /* not UTF-8 */
    check_title("\xed\xa0\x80\x01", "tEXt", "Title\0????", 10); /* a surrogate, a control */
    char *long_title = malloc(200001);
    memset(long_title, 'x', 200000);
    long_title[200000] = '\0';
    check_title(long_title, "tEXt", NULL, 0);
    for (int i = 0; i < 100000; i++) memcpy(long_title + 2 * i, "\xc5\x91", 2);
    check_title(long_title, "iTXt", NULL, 0);
    free(long_title);
}

static void png_same_for_all_thread_counts(void) {
    GlintImage image = make_image(1000, 1100, 9);
    Bytes first = encode(&image, "threads", 1);
    static const int counts[] = {2, 3, 8, 0, 1};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        Bytes other = encode(&image, "threads", counts[i]);
        CHECK(other.size == first.size && memcmp(other.data, first.data, first.size) == 0);
        free(other.data);
    }
    free(first.data);
    free((void *)(uintptr_t)image.pixels);
}

/* Fills new blocks with rubbish: noise, or many times the same small number of 16 bits, which is
 * more likely to pass for something meant. */
static void *dirty_reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    uint32_t state = *(uint32_t *)user;
    bool noise = state >= 16;
    (void)old_size;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    uint8_t *block = realloc(pointer, new_size);
    for (size_t i = 0; pointer == NULL && i < new_size; i++) {
        block[i] = (uint8_t)(noise ? next_random(&state) : i % 2 == 0 ? state : 0);
    }
    return block;
}

/* Neither what was in the deflater's memory nor what it compressed before may show: ISA-L leaves
 * fields of its state as they are. */
static void pieces_depend_on_bytes_alone(void) {
    enum { COUNT = 200000 };
    uint8_t *bytes = malloc(COUNT), *first = malloc(gi_deflate_bound(COUNT));
    uint8_t *other = malloc(gi_deflate_bound(COUNT));
    uint32_t state = 11;
    for (int i = 0; i < COUNT; i++) {
        uint32_t random = next_random(&state);
        bytes[i] = (uint8_t)(i > 3001 && random % 16 != 0 ? bytes[i - 3001] : random >> 12);
    }
    for (int piece = 0; piece < 4; piece++) {
        const uint8_t *from = bytes + piece * 30000;
        size_t size = (size_t)(COUNT - piece * 30000 - piece * piece * 1000), first_size = 0;
        for (uint32_t run = 0; run < 20; run++) {
            GiMemory memory;
            gi_memory_init(&memory, &(GlintAllocator){dirty_reallocate, &run}, 0);
            GiDeflater *deflater = gi_deflate_create(&memory);
            if (run % 2 == 1) {
                size_t skip = next_random(&state) % (COUNT - 1);
                gi_deflate_learn(deflater, bytes + skip, (COUNT - skip) / 2);
                CHECK(gi_deflate_piece(deflater, bytes + skip, COUNT - skip, other) > 0);
            }
            gi_deflate_learn(deflater, bytes, 10000);
            size_t other_size = gi_deflate_piece(deflater, from, size, run == 0 ? first : other);
            if (run == 0) first_size = other_size;
            CHECK_INT(other_size, first_size);
            CHECK(run == 0 || memcmp(first, other, first_size) == 0);
            gi_deflate_destroy(deflater);
        }
    }
    /* What cannot be compressed fits in the bound, for sizes about those of stored blocks too. */
    for (int i = 0; i < COUNT; i++) bytes[i] = (uint8_t)next_random(&state);
    static const size_t sizes[] = {1, 2, 100, 65534, 65535, 65536, 131070, 196607, COUNT};
    GiMemory memory;
    gi_memory_init(&memory, NULL, 0);
    GiDeflater *deflater = gi_deflate_create(&memory);
    gi_deflate_learn(deflater, bytes, 0);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        size_t size = gi_deflate_piece(deflater, bytes, sizes[i], other);
        CHECK(size > 0 && size <= gi_deflate_bound(sizes[i]));
    }
    gi_deflate_destroy(deflater);
    CHECK_INT(memory.used, 0);
    free(bytes);
    free(first);
    free(other);
}

static void checksums(void) {
    enum { COUNT = 300000 };
    uint8_t *bytes = malloc(COUNT);
    uint32_t state = 5;
    for (int i = 0; i < COUNT; i++) bytes[i] = (uint8_t)(next_random(&state) | 0xc0);
    CHECK_INT(gi_deflate_crc32(0, bytes, 1000), slow_crc(bytes, 1000));
    CHECK_INT(
        gi_deflate_crc32(gi_deflate_crc32(0, bytes, 77), bytes + 77, 923), slow_crc(bytes, 1000));
    uint32_t a = 1, b = 0;
    for (int i = 0; i < COUNT; i++) {
        a = (a + bytes[i]) % 65521;
        b = (b + a) % 65521;
    }
    uint32_t whole = b << 16 | a;
    CHECK_INT(gi_deflate_adler32(bytes, COUNT), whole);
    for (size_t cut = 0; cut <= COUNT; cut += 29999) {
        uint32_t first = gi_deflate_adler32(bytes, cut);
        uint32_t second = gi_deflate_adler32(bytes + cut, COUNT - cut);
        CHECK_INT(gi_deflate_adler32_join(first, second, COUNT - cut), whole);
    }
    free(bytes);
}

/* ---------------------------------------------------------------- PFM */

static void pfm_round_trip(void) {
    static const int sizes[][2] = {{1, 1}, {3, 5}, {300, 200}, {30000, 2}};
    char path[600];
    snprintf(path, sizeof path, "%s/picture.PFM", make_folder("pfm"));
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        int width = sizes[i][0], height = sizes[i][1];
        GlintImage image = make_image(width, height, 4);
        GlintSaveDesc desc = glint_save_desc_default();
        GlintError error;
        CHECK_INT(glint_image_save(&image, path, &desc, &error), GLINT_OK);
        Bytes bytes = read_whole(path);
        char head[64];
        size_t length = (size_t)snprintf(head, sizeof head, "PF\n%d %d\n-1.0\n", width, height);
        size_t row = 12 * (size_t)width;
        CHECK_INT(bytes.size, length + row * (size_t)height);
        CHECK(bytes.size > length && memcmp(bytes.data, head, length) == 0);
        /* The tests run on little-endian machines, where the floats can be compared as they are. */
        for (int y = 0; y < height && bytes.size == length + row * (size_t)height; y++) {
            const uint8_t *stored = bytes.data + length + row * (size_t)(height - 1 - y);
            CHECK(memcmp(stored, image.pixels + 3 * (size_t)width * (size_t)y, row) == 0);
        }
        free(bytes.data);
        free((void *)(uintptr_t)image.pixels);
    }
}

/* ---------------------------------------------------------------- arguments, monitor, memory */

static void image_arguments(void) {
    GlintImage image = make_image(4, 4, 1), bad = image;
    GlintSaveDesc desc = glint_save_desc_default(), raw = {0};
    GlintError error;
    Bytes bytes = {0};
    CHECK_INT(desc.cookie, GI_COOKIE);
    CHECK_INT(glint_image_encode_png(&image, &raw, collect, &bytes, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_encode_png(&image, NULL, collect, &bytes, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_encode_png(NULL, &desc, collect, &bytes, NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_encode_png(&image, &desc, NULL, &bytes, &error), GLINT_ERROR_ARGUMENT);
    bad.width = 0;
    CHECK_INT(glint_image_encode_png(&bad, &desc, collect, &bytes, &error), GLINT_ERROR_ARGUMENT);
    bad.width = bad.height = 1 << 15;
    CHECK_INT(glint_image_encode_png(&bad, &desc, collect, &bytes, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_save(&image, NULL, &desc, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_save(&image, "/nowhere/x.jpg", &desc, &error), GLINT_ERROR_ARGUMENT);
    CHECK_TEXT(error.path, "/nowhere/x.jpg");
    CHECK_INT(glint_image_save(&image, "png", &desc, &error), GLINT_ERROR_ARGUMENT);
    desc.thread_count = -1;
    CHECK_INT(glint_image_encode_png(&image, &desc, collect, &bytes, &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(bytes.size, 0);
    desc.thread_count = 1;
    bytes.limit = 150;
    CHECK_INT(glint_image_encode_png(&image, &desc, collect, &bytes, &error), GLINT_ERROR_FILE);
    free(bytes.data);
    free((void *)(uintptr_t)image.pixels);
}

typedef struct Watch {
    int polls, polls_allowed;
    double last;
    bool falling;
} Watch;

static bool watch_cancelled(void *user) {
    Watch *watch = user;
    return ++watch->polls > watch->polls_allowed;
}

static void watch_progress(void *user, GlintPhase phase, double fraction) {
    Watch *watch = user;
    CHECK_INT(phase, GLINT_PHASE_WRITE);
    watch->falling |= fraction < watch->last || fraction > 1;
    watch->last = fraction;
}

static void image_monitor(void) {
    static const char *const names[] = {"picture.png", "picture.pfm", "picture.exr"};
    int formats = glint_image_check_path(names[2], NULL) == GLINT_OK ? 3 : 2;
    const char *folder = make_folder("monitor");
    GlintImage image = make_image(700, 700, 2);
    GlintError error;
    for (int i = 0; i < 2 * formats; i++) {
        bool cancel = i < formats;
        Watch watch = {.polls_allowed = cancel ? 1 : 1000};
        GlintMonitor monitor = {watch_progress, watch_cancelled, &watch};
        GlintSaveDesc desc = glint_save_desc_default();
        desc.thread_count = 1;
        desc.monitor = &monitor;
        char path[600];
        snprintf(path, sizeof path, "%s/%s", folder, names[i % formats]);
        GlintStatus status = glint_image_save(&image, path, &desc, &error);
        CHECK_INT(status, cancel ? GLINT_CANCELLED : GLINT_OK);
        CHECK_INT(count_entries(folder), cancel ? 0 : i - formats + 1);
        CHECK(!watch.falling && (cancel ? watch.last < 1 : watch.last == 1));
    }
    free((void *)(uintptr_t)image.pixels);
}

typedef struct Rationed {
    _Atomic int left, blocks;
} Rationed;

static void *rationed_reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    Rationed *rationed = user;
    (void)old_size;
    if (new_size == 0) {
        rationed->blocks--;
        free(pointer);
        return NULL;
    }
    if (rationed->left-- <= 0) return NULL;
    if (pointer == NULL) rationed->blocks++;
    return realloc(pointer, new_size);
}

static void png_allocator_fails(void) {
    GlintImage image = make_image(500, 600, 2);
    for (int threads = 1; threads <= 2; threads++) {
        Bytes whole = encode(&image, NULL, threads);
        bool done = false;
        for (int allowed = 0; !done && allowed < 200; allowed++) {
            Rationed rationed = {.left = allowed};
            GlintAllocator allocator = {rationed_reallocate, &rationed};
            GiMemory memory;
            Bytes bytes = {0};
            gi_memory_init(&memory, &allocator, 0);
            GlintError error = {0};
            GlintStatus status = gi_png_encode(
                &memory, &image, &(GiPngExtras){0}, threads, NULL, collect, &bytes, &error);
            CHECK(status == GLINT_OK || status == GLINT_ERROR_MEMORY);
            CHECK_INT(error.status, status);
            CHECK_INT(rationed.blocks, 0);
            CHECK_INT(memory.used, 0);
            done = status == GLINT_OK;
            if (done) CHECK(bytes.size == whole.size);
            free(bytes.data);
        }
        CHECK(done);
        free(whole.data);
    }
    free((void *)(uintptr_t)image.pixels);
}

const GiTest tests_image[] = {
    TEST(gamma_steps_are_exact),
    TEST(gamma_follows_the_formula),
    TEST(gamma_extremes),
    TEST(png_decodes_to_the_same),
    TEST(png_chunks),
    TEST(png_titles),
    TEST(png_same_for_all_thread_counts),
    TEST(png_allocator_fails),
    TEST(pieces_depend_on_bytes_alone),
    TEST(checksums),
    TEST(pfm_round_trip),
    TEST(image_arguments),
    TEST(image_monitor),
    TEST_END,
};
