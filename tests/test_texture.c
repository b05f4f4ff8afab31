/* SPDX-License-Identifier: MIT
 * Textures: lookup against the formula, pictures of every kind through the modules, broken ones. */
#include "pictures.h"
#include "port/module.h"
#include "random.h"
#include "test.h"
#include "texture/texture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>
#include <setjmp.h>
#ifdef GI_BUILT_JPEG
#include <jpeglib.h>
#endif

/* ---------------------------------------------------------------- lookup */

static void texture_lookup(void) {
    uint8_t rgb[2 * 3 * 3];
    for (int i = 0; i < 18; i++) rgb[i] = (uint8_t)i;
    GiPicture picture = {2, 3, rgb};
    /* x = trunc(2u + 0.5), y = trunc(3(1 - v) + 0.5); pixel (x, y) is byte 3(2y + x) */
    static const struct {
        double u, v;
        int repeat, clamp;
    } cases[] = {
        {0, 0, 0, 4},           /* y = 3 */
        {0, 1, 0, 0},           /* y = 0 */
        {0.24, 0.84, 0, 0},     /* 0.98, 0.98 */
        {0.26, 0.82, 3, 3},     /* 1.02, 1.04 */
        {0.99, 0.5, 4, 5},      /* 2.48, 2.0 */
        {-0.3, 1, 0, 0},        /* -0.1 is cut to 0 */
        {-0.8, 1, 1, 0},        /* -1.1 */
        {0, 1.8, 4, 0},         /* -1.9 is cut to -1 */
        {100.26, -99.18, 3, 5}, /* 201.02, 301.04 */
        {1e300, 1, 0, 1},
        {0, -1e300, 0, 4},
        {-1e300, 1, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double u = cases[i].u, v = cases[i].v;
        GiVec repeat = gi_texture_color(&picture, GI_WRAP_REPEAT, u, v);
        GiVec clamp = gi_texture_color(&picture, GI_WRAP_CLAMP, u, v);
        CHECK(repeat.y == (3 * cases[i].repeat + 1) / 255.0);
        CHECK(clamp.x == 3 * cases[i].clamp / 255.0);
        CHECK(clamp.z == (3 * cases[i].clamp + 2) / 255.0);
    }
    for (int wrap = GI_WRAP_REPEAT; wrap <= GI_WRAP_CLAMP; wrap++) {
        static const double odd[] = {NAN, INFINITY, -INFINITY, 1.7e308, -0x1p-1074, 0x1p53};
        for (int i = 0; i < 36; i++) {
            GiVec color = gi_texture_color(&picture, (GiWrap)wrap, odd[i % 6], odd[i / 6]);
            CHECK(color.x >= 0 && color.x <= 15 / 255.0);
        }
    }
}

/* ---------------------------------------------------------------- files */

static const char *write_picture(const uint8_t *data, size_t size) {
    static char path[600];
    snprintf(path, sizeof path, "%s/texture", test_scratch_dir());
    FILE *file = fopen(path, "wb");
    fwrite(data, 1, size, file);
    fclose(file);
    return path;
}

static GlintStatus load(const uint8_t *data, size_t size, size_t limit, GiPicture *picture,
    GiMemory *memory, GlintError *error) {
    gi_memory_init(memory, NULL, limit);
    GlintStatus status = gi_picture_load(picture, memory, write_picture(data, size), error);
    if (status != GLINT_OK) {
        CHECK_INT(memory->used, 0);
        CHECK(picture->rgb == NULL && picture->width == 0);
        CHECK(error->message[0] != '\0');
    }
    return status;
}

static void check_refused(const void *data, size_t size, const char *reason) {
    GiPicture picture;
    GiMemory memory;
    GlintError error = {0};
    CHECK_INT(load(data, size, 0, &picture, &memory, &error), GLINT_ERROR_FILE);
    if (strstr(error.message, reason) == NULL) CHECK_TEXT(error.message, reason);
    gi_picture_free(&picture, &memory);
}

/* Files cut anywhere, and files with a byte changed: refused or read, never worse. */
static void check_broken(const Bytes *bytes) {
    Random random = {1};
    for (int i = 0; i < 300; i++) {
        GiPicture picture;
        GiMemory memory;
        GlintError error = {0};
        size_t cut = (size_t)random_below(&random, (int)bytes->size - 12);
        CHECK_INT(load(bytes->data, cut, 0, &picture, &memory, &error), GLINT_ERROR_FILE);
        uint8_t *changed = malloc(bytes->size);
        memcpy(changed, bytes->data, bytes->size);
        for (int k = 0; k < 1 + i % 3; k++) {
            changed[random_below(&random, (int)bytes->size)] = (uint8_t)random_bits(&random);
        }
        load(changed, bytes->size, (size_t)1 << 26, &picture, &memory, &error);
        gi_picture_free(&picture, &memory);
        CHECK_INT(memory.used, 0);
        free(changed);
    }
}

static void texture_other_files(void) {
    check_refused("GIF89a", 6, "neither");
    check_refused("", 0, "neither");
    GiPicture picture;
    GiMemory memory;
    GlintError error = {0};
    gi_memory_init(&memory, NULL, 0);
    CHECK_INT(gi_picture_load(&picture, &memory, "/nowhere/a.png", &error), GLINT_ERROR_FILE);
    CHECK_TEXT(error.path, "/nowhere/a.png");
}

static void module_missing(void) {
    GiModule module;
    GlintError error = {0};
    CHECK_INT(
        gi_module_open(&module, "nonesuch", "x", "read such files", &error), GLINT_ERROR_FILE);
    CHECK(strstr(error.message, "cannot read such files") != NULL);
    CHECK(strstr(error.message, "glint-nonesuch.so") != NULL);
#ifdef GI_BUILT_PNG
    CHECK_INT(gi_module_open(&module, "png", "nonesuch", "read PNG", &error), GLINT_ERROR_FILE);
    CHECK(module.handle == NULL);
#endif
}

/* ---------------------------------------------------------------- PNG */

static void png_collect(png_structp png, png_bytep data, size_t size) {
    collect(png_get_io_ptr(png), data, size);
}
static void png_nothing(png_structp png) { (void)png; }

enum { WIDTH = 21, HEIGHT = 13 };

/* What a sample of kind `type` with `bits` is, and the bytes that it should become. */
static void make_pixel(
    Random *random, int type, int bits, uint8_t *stored, int x, uint8_t expected[3]) {
    unsigned most = (1u << bits) - 1;
    int channels = type == PNG_COLOR_TYPE_GRAY         ? 1
                   : type == PNG_COLOR_TYPE_PALETTE    ? 1
                   : type == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
                   : type == PNG_COLOR_TYPE_RGB        ? 3
                                                       : 4;
    for (int k = 0; k < channels; k++) {
        unsigned value = (unsigned)random_bits(random) & most;
        if (bits == 16) {
            stored[2 * (channels * x + k)] = (uint8_t)(value >> 8);
            stored[2 * (channels * x + k) + 1] = (uint8_t)value;
        } else {
            int place = bits * (channels * x + k);
            stored[place / 8] |= (uint8_t)(value << (8 - bits - place % 8));
        }
        if (k < 3) expected[k] = (uint8_t)(value * 255.0 / most + 0.5);
        if (type == PNG_COLOR_TYPE_PALETTE) {
            for (int c = 0; c < 3; c++) expected[c] = (uint8_t)(value * 16 + (unsigned)c);
        }
    }
    if (channels <= 2 && type != PNG_COLOR_TYPE_PALETTE) expected[2] = expected[1] = expected[0];
}

static Bytes make_png(int type, int bits, bool interlaced, uint8_t *expected) {
    static uint8_t rows[HEIGHT][WIDTH * 8];
    png_bytep pointers[HEIGHT];
    Random random = {(uint64_t)(type * 100 + bits)};
    Bytes bytes = {0};
    memset(rows, 0, sizeof rows);
    for (int y = 0; y < HEIGHT; y++) {
        pointers[y] = rows[y];
        for (int x = 0; x < WIDTH; x++) {
            make_pixel(&random, type, bits, rows[y], x, expected + 3 * (y * WIDTH + x));
        }
    }
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &bytes, png_collect, png_nothing);
    png_set_IHDR(png, info, WIDTH, HEIGHT, bits, type, interlaced, 0, 0);
    png_set_gAMA(png, info, 0.9); /* not heeded */
    if (type == PNG_COLOR_TYPE_PALETTE) {
        png_color palette[16];
        png_byte alpha[2] = {0, 100}; /* dropped */
        for (int i = 0; i < 16; i++) {
            int value = 16 * i;
            palette[i] = (png_color){(png_byte)value, (png_byte)(value + 1), (png_byte)(value + 2)};
        }
        png_set_PLTE(png, info, palette, 1 << bits);
        png_set_tRNS(png, info, alpha, 2, NULL);
    }
    png_write_info(png, info);
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

static bool has_png(void) {
#ifdef GI_BUILT_PNG
    return true;
#else
    test_skip("the module for PNG is not built");
    return false;
#endif
}

static void texture_png(void) {
    if (!has_png()) return;
    static const int kinds[][2] = {{PNG_COLOR_TYPE_GRAY, 1}, {PNG_COLOR_TYPE_GRAY, 2},
        {PNG_COLOR_TYPE_GRAY, 4}, {PNG_COLOR_TYPE_GRAY, 8}, {PNG_COLOR_TYPE_GRAY, 16},
        {PNG_COLOR_TYPE_GRAY_ALPHA, 8}, {PNG_COLOR_TYPE_GRAY_ALPHA, 16}, {PNG_COLOR_TYPE_RGB, 8},
        {PNG_COLOR_TYPE_RGB, 16}, {PNG_COLOR_TYPE_RGB_ALPHA, 8}, {PNG_COLOR_TYPE_RGB_ALPHA, 16},
        {PNG_COLOR_TYPE_PALETTE, 2}, {PNG_COLOR_TYPE_PALETTE, 4}};
    for (size_t i = 0; i < 2 * sizeof kinds / sizeof kinds[0]; i++) {
        static uint8_t expected[3 * WIDTH * HEIGHT];
        Bytes bytes = make_png(kinds[i / 2][0], kinds[i / 2][1], i % 2 == 1, expected);
        GiPicture picture;
        GiMemory memory;
        GlintError error = {0};
        CHECK_INT(load(bytes.data, bytes.size, 0, &picture, &memory, &error), GLINT_OK);
        CHECK(picture.width == WIDTH && picture.height == HEIGHT);
        if (picture.rgb != NULL && memcmp(picture.rgb, expected, sizeof expected) != 0) {
            test_fail(__FILE__, __LINE__, "PNG of type %d with %d bits, interlaced %d, differs",
                kinds[i / 2][0], kinds[i / 2][1], (int)(i % 2));
        }
        gi_picture_free(&picture, &memory);
        CHECK_INT(memory.used, 0);
        CHECK_INT(load(bytes.data, bytes.size, bytes.size + 100, &picture, &memory, &error),
            GLINT_ERROR_MEMORY);
        if (i == 15) check_broken(&bytes);
        free(bytes.data);
    }
    /* A head that promises 2^31 x 2^31 pixels, with a good checksum or without. */
    static const char huge[] =
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\x02"
        "\0\0\0\0\0\0\0";
    check_refused(huge, sizeof huge - 1, "PNG");
}

/* ---------------------------------------------------------------- JPEG */

#ifdef GI_BUILT_JPEG

static Bytes make_jpeg(
    const uint8_t *samples, int channels, J_COLOR_SPACE space, bool progressive) {
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned char *data = NULL;
    unsigned long size = 0;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &data, &size);
    jpeg.image_width = WIDTH;
    jpeg.image_height = HEIGHT;
    jpeg.input_components = channels;
    jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        JSAMPROW row =
            (JSAMPROW)(uintptr_t)(samples + jpeg.next_scanline * WIDTH * (unsigned)channels);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    Bytes bytes = {0};
    collect(&bytes, data, size);
    free(data);
    return bytes;
}

static void check_jpeg(int channels, J_COLOR_SPACE space, bool progressive) {
    uint8_t samples[WIDTH * HEIGHT * 3];
    for (int i = 0; i < WIDTH * HEIGHT * channels; i++) {
        int pixel = i / channels, x = pixel % WIDTH, y = pixel / WIDTH;
        samples[i] = (uint8_t)(10 + 6 * x + 5 * y + 20 * (i % channels));
    }
    Bytes bytes = make_jpeg(samples, channels, space, progressive);
    GiPicture picture;
    GiMemory memory;
    GlintError error = {0};
    CHECK_INT(load(bytes.data, bytes.size, 0, &picture, &memory, &error), GLINT_OK);
    CHECK(picture.width == WIDTH && picture.height == HEIGHT);
    for (int i = 0; picture.rgb != NULL && i < WIDTH * HEIGHT * 3; i++) {
        CHECK_NEAR(picture.rgb[i], samples[channels == 3 ? i : i / 3], 4);
    }
    gi_picture_free(&picture, &memory);
    CHECK_INT(memory.used, 0);
    CHECK_INT(load(bytes.data, bytes.size, bytes.size + 100, &picture, &memory, &error),
        GLINT_ERROR_MEMORY);
    check_broken(&bytes);
    free(bytes.data);
}

#endif

static void texture_jpeg(void) {
#ifndef GI_BUILT_JPEG
    test_skip("the module for JPEG is not built");
#else
    check_jpeg(3, JCS_RGB, false);
    check_jpeg(3, JCS_RGB, true);
    check_jpeg(1, JCS_GRAYSCALE, false);
    static const uint8_t ink[WIDTH * HEIGHT * 4];
    Bytes bytes = make_jpeg(ink, 4, JCS_CMYK, false);
    check_refused(bytes.data, bytes.size, "CMYK");
    free(bytes.data);
#endif
}

const GiTest tests_texture[] = {TEST(texture_lookup), TEST(texture_other_files),
    TEST(module_missing), TEST(texture_png), TEST(texture_jpeg), TEST_END};
