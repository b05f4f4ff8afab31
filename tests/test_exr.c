/* SPDX-License-Identifier: MIT
 * EXR: what is written is read back with OpenEXR's own library and compared bit by bit. */
#define _GNU_SOURCE /* RLIMIT_FSIZE, fork */
#include "glint/glint.h"
#include "pictures.h"
#include "test.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef GI_BUILT_EXR
#include <openexr.h>
#endif

static bool is_missing(void) {
#ifdef GI_BUILT_EXR
    return false;
#else
    test_skip("the module for EXR is not built");
    return true;
#endif
}

static char *path_in(const char *folder) {
    static char path[600];
    snprintf(path, sizeof path, "%s/picture.EXR", folder);
    return path;
}

/* ---------------------------------------------------------------- round trip */

#ifdef GI_BUILT_EXR

static void check_text(exr_context_t context, const char *name, const char *expected) {
    const char *text = NULL;
    int32_t length = 0;
    CHECK_INT(exr_attr_get_string(context, 0, name, &length, &text), EXR_ERR_SUCCESS);
    CHECK_TEXT(text, expected);
}

/* Reads all rows of the channels, each to its own array in the order of the file. */
static void read_rows(exr_context_t context, int width, int height, float **values) {
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t rows = 0;
    CHECK_INT(exr_get_scanlines_per_chunk(context, 0, &rows), EXR_ERR_SUCCESS);
    for (int y = 0; y < height; y += rows) {
        exr_chunk_info_t chunk;
        CHECK_INT(exr_read_scanline_chunk_info(context, 0, y, &chunk), EXR_ERR_SUCCESS);
        if (y == 0) {
            exr_decoding_initialize(context, 0, &chunk, &pipeline);
        } else {
            exr_decoding_update(context, 0, &chunk, &pipeline);
        }
        for (int i = 0; i < pipeline.channel_count; i++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[i];
            channel->decode_to_ptr = (uint8_t *)(values[i] + (size_t)y * (size_t)width);
            channel->user_pixel_stride = sizeof(float);
            channel->user_line_stride = width * (int32_t)sizeof(float);
            channel->user_bytes_per_element = sizeof(float);
            channel->user_data_type = EXR_PIXEL_FLOAT;
        }
        if (y == 0) exr_decoding_choose_default_routines(context, 0, &pipeline);
        CHECK_INT(exr_decoding_run(context, 0, &pipeline), EXR_ERR_SUCCESS);
    }
    exr_decoding_destroy(context, &pipeline);
}

typedef struct Expected {
    const char *name;
    const float *first;
    size_t stride;
} Expected;

/* expected: in the order of names, which is that of the file. */
static void check_file(
    const char *path, int width, int height, const Expected *expected, int count) {
    exr_context_t context = NULL;
    const exr_attr_chlist_t *channels = NULL;
    exr_attr_box2i_t window = {0};
    size_t pixels = (size_t)width * (size_t)height;
    float *values[8] = {0};
    CHECK_INT(exr_start_read(&context, path, NULL), EXR_ERR_SUCCESS);
    if (context == NULL) return;
    CHECK_INT(exr_get_channels(context, 0, &channels), EXR_ERR_SUCCESS);
    CHECK_INT(exr_get_data_window(context, 0, &window), EXR_ERR_SUCCESS);
    CHECK_INT(window.max.x - window.min.x + 1, width);
    CHECK_INT(window.max.y - window.min.y + 1, height);
    CHECK_INT(channels->num_channels, count);
    if (channels->num_channels == count) {
        for (int i = 0; i < count; i++) values[i] = calloc(pixels, sizeof(float));
        read_rows(context, width, height, values);
        for (int i = 0; i < count; i++) {
            CHECK_TEXT(channels->entries[i].name.str, expected[i].name);
            CHECK_INT(channels->entries[i].pixel_type, EXR_PIXEL_FLOAT);
            size_t wrong = 0;
            for (size_t k = 0; k < pixels; k++) {
                const float *from = expected[i].first + k * expected[i].stride;
                if (memcmp(&values[i][k], from, sizeof(float)) != 0) wrong++;
            }
            CHECK_INT(wrong, 0);
            free(values[i]);
        }
    }
    char software[64];
    snprintf(software, sizeof software, "Glint %s", glint_version_text());
    check_text(context, "software", software);
    check_text(context, "title", "A sc\xc3\xa8ne");
    exr_finish(&context);
}

#endif

static void exr_round_trip(void) {
    if (is_missing()) return;
#ifdef GI_BUILT_EXR
    static const int sizes[][2] = {{1, 1}, {3, 16}, {17, 33}, {300, 200}, {5000, 2}};
    char *path = path_in(make_folder("exr"));
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        int width = sizes[i][0], height = sizes[i][1];
        GlintImage image = make_image(width, height, 4), normals = make_image(width, height, 9);
        GlintImage depth = make_image(width, height, 5); /* a third of it */
        GlintLayer layers[2] = {
            {"normal", "XYZ", normals.pixels}, {"depth.raw", "Z", depth.pixels}};
        Expected expected[7] = {{"B", image.pixels + 2, 3}, {"G", image.pixels + 1, 3},
            {"R", image.pixels, 3}, {"depth.raw.Z", depth.pixels, 1},
            {"normal.X", normals.pixels, 3}, {"normal.Y", normals.pixels + 1, 3},
            {"normal.Z", normals.pixels + 2, 3}};
        GlintSaveDesc desc = glint_save_desc_default();
        GlintError error = {0};
        desc.title = "A sc\xc3\xa8ne";
        CHECK_INT(glint_image_save(&image, path, &desc, &error), GLINT_OK);
        check_file(path, width, height, expected, 3);
        desc.layers = layers;
        desc.layer_count = 2;
        CHECK_INT(glint_image_save(&image, path, &desc, &error), GLINT_OK);
        check_file(path, width, height, expected, 7);
        free((void *)(uintptr_t)image.pixels);
        free((void *)(uintptr_t)normals.pixels);
        free((void *)(uintptr_t)depth.pixels);
    }
#endif
}

static void exr_same_for_all_thread_counts(void) {
    if (is_missing()) return;
    char *path = path_in(make_folder("exr-threads"));
    GlintImage image = make_image(100, 500, 6);
    Bytes first = {0};
    for (int threads = 1; threads <= 8; threads++) {
        GlintSaveDesc desc = glint_save_desc_default();
        GlintError error = {0};
        desc.thread_count = threads;
        CHECK_INT(glint_image_save(&image, path, &desc, &error), GLINT_OK);
        Bytes bytes = read_whole(path);
        if (threads == 1) {
            first = bytes;
        } else {
            CHECK(bytes.size == first.size && memcmp(bytes.data, first.data, first.size) == 0);
            free(bytes.data);
        }
    }
    free(first.data);
    free((void *)(uintptr_t)image.pixels);
}

/* ---------------------------------------------------------------- refusals and failures */

static void layers_refused(void) {
    GlintImage image = make_image(4, 4, 1);
    GlintSaveDesc desc = glint_save_desc_default();
    GlintError error = {0};
    GlintLayer good = {"normal", "XYZ", image.pixels};
    static const float one = 1;
    static const GlintLayer bad[] = {{"normal", "XYZ", NULL}, {NULL, "XYZ", &one},
        {"", "XYZ", &one}, {"2d", "X", &one}, {"a b", "X", &one},
        {"a234567890123456789012345678z", "X", &one}, {"n", NULL, &one}, {"n", "", &one},
        {"n", "XYX", &one}, {"n", "ABCDE", &one}, {"n", "X1", &one}};
    char path[600];
    desc.layer_count = 1;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        desc.layers = &bad[i];
        CHECK_INT(glint_image_save(&image, "/nowhere/x.exr", &desc, &error), GLINT_ERROR_ARGUMENT);
    }
    GlintLayer twice[2] = {good, good};
    desc.layers = twice;
    CHECK_INT(glint_image_save(&image, "/nowhere/x.pfm", &desc, &error), GLINT_ERROR_ARGUMENT);
    CHECK_TEXT(error.message, "only EXR has layers");
    snprintf(path, sizeof path, "%s/layers.png", test_scratch_dir());
    CHECK_INT(glint_image_save(&image, path, &desc, &error), GLINT_ERROR_ARGUMENT);
    Bytes bytes = {0};
    CHECK_INT(glint_image_encode_png(&image, &desc, collect, &bytes, &error), GLINT_ERROR_ARGUMENT);
    CHECK(access(path, F_OK) != 0);
    desc.layer_count = 2;
    CHECK_INT(glint_image_save(&image, "/nowhere/x.exr", &desc, &error), GLINT_ERROR_ARGUMENT);
    CHECK_TEXT(error.message, "two layers have one name");
    desc.layers = NULL;
    CHECK_INT(glint_image_save(&image, "/nowhere/x.exr", &desc, &error), GLINT_ERROR_ARGUMENT);
    desc.layer_count = -1;
    CHECK_INT(glint_image_save(&image, "/nowhere/x.exr", &desc, &error), GLINT_ERROR_ARGUMENT);
    desc.layer_count = 0;
    image.width = 1 << 24;
    image.height = 16;
    CHECK_INT(glint_image_save(&image, "/nowhere/x.exr", &desc, &error), GLINT_ERROR_ARGUMENT);
    CHECK_TEXT(error.message, "the picture is too wide for EXR");
    free((void *)(uintptr_t)image.pixels);
}

static void picture_names(void) {
    GlintError error = {0};
    CHECK_INT(glint_image_check_path("a.png", &error), GLINT_OK);
    CHECK_INT(glint_image_check_path("/nowhere/a.PFM", &error), GLINT_OK);
    CHECK_INT(glint_image_check_path("a.jpg", &error), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_check_path("exr", NULL), GLINT_ERROR_ARGUMENT);
    CHECK_INT(glint_image_check_path(NULL, &error), GLINT_ERROR_ARGUMENT);
#ifdef GI_BUILT_EXR
    CHECK_INT(glint_image_check_path("a.Exr", &error), GLINT_OK);
#else
    CHECK_INT(glint_image_check_path("a.Exr", &error), GLINT_ERROR_FILE);
    CHECK(strstr(error.message, "glint-exr.so") != NULL);
#endif
}

static void write_old(const char *path) {
    FILE *file = fopen(path, "wb");
    fputs("old", file);
    fclose(file);
}

static bool is_old(const char *path) {
    Bytes bytes = read_whole(path);
    bool old = bytes.size == 3 && memcmp(bytes.data, "old", 3) == 0;
    free(bytes.data);
    return old;
}

static bool never(void *user) {
    (void)user;
    return true;
}

/* In a process of its own, whose files may not grow beyond `limit`. */
static int save_with_limit(const GlintImage *image, const char *path, rlim_t limit) {
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        struct rlimit files = {limit, limit};
        GlintSaveDesc desc = glint_save_desc_default();
        GlintError error = {0};
        signal(SIGXFSZ, SIG_IGN);
        if (setrlimit(RLIMIT_FSIZE, &files) != 0) _exit(100);
        GlintStatus status = glint_image_save(image, path, &desc, &error);
        _exit(strstr(error.message, "too large") != NULL ? (int)status : 99);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void exr_failures(void) {
    if (is_missing()) return;
    const char *folder = make_folder("exr-failures");
    char *path = path_in(folder);
    GlintImage image = make_image(300, 200, 3);
    GlintSaveDesc desc = glint_save_desc_default();
    GlintMonitor monitor = {.cancelled = never};
    GlintError error = {0};
    write_old(path);
    /* In the header, in the pixels, and in the table of chunks at the end. */
    static const rlim_t limits[] = {50, 2000, 100000};
    for (size_t i = 0; i < 3; i++) {
        CHECK_INT(save_with_limit(&image, path, limits[i]), GLINT_ERROR_FILE);
        CHECK(is_old(path));
        CHECK_INT(count_entries(folder), 1);
    }
    desc.monitor = &monitor;
    CHECK_INT(glint_image_save(&image, path, &desc, &error), GLINT_CANCELLED);
    CHECK(is_old(path));
    CHECK_INT(count_entries(folder), 1);
    desc.monitor = NULL;
    CHECK_INT(glint_image_save(&image, "/nowhere/x.exr", &desc, &error), GLINT_ERROR_FILE);
    if (geteuid() != 0) {
        CHECK_INT(chmod(folder, 0555), 0);
        CHECK_INT(glint_image_save(&image, path, &desc, &error), GLINT_ERROR_FILE);
        CHECK_INT(chmod(folder, 0755), 0);
        CHECK(is_old(path));
    }
    /* A pipe has no places to write to. */
    CHECK_INT(unlink(path), 0);
    CHECK_INT(mkfifo(path, 0600), 0);
    FILE *pipe = fopen(path, "r+");
    CHECK_INT(glint_image_save(&image, path, &desc, &error), GLINT_ERROR_FILE);
    CHECK(strstr(error.message, "seek") != NULL);
    fclose(pipe);
    free((void *)(uintptr_t)image.pixels);
}

const GiTest tests_exr[] = {TEST(exr_round_trip), TEST(exr_same_for_all_thread_counts),
    TEST(layers_refused), TEST(picture_names), TEST(exr_failures), TEST_END};
