/* SPDX-License-Identifier: MIT
 * What the reader says of wrong files, and that neither chunk boundaries, hostile input nor a
 * failing allocator can upset it. */
#include "test_reader_input.h"

#include "reader/reader.h"

#include <dirent.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* ---------------------------------------------------------------- what is said of wrong files */

static bool read_file(const char *path, char *buffer, size_t size, size_t *length) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) return false;
    *length = fread(buffer, 1, size - 1, file);
    buffer[*length] = '\0';
    fclose(file);
    return true;
}

static void malformed(void) {
    static char text[65536], expected[65536], first[sizeof loaded.printed];
    char folder[1024], path[1400];
    snprintf(folder, sizeof folder, "%s/tests/malformed", test_source_dir());
    DIR *directory = opendir(folder);
    CHECK(directory != NULL);
    if (directory == NULL) return;
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        size_t length = strlen(entry->d_name), size = 0, expected_size = 0;
        if (length < 5 || strcmp(entry->d_name + length - 4, ".xml") != 0) continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        CHECK(read_file(path, text, sizeof text, &size));
        snprintf(path, sizeof path, "%s/%.*s.expected", folder, (int)length - 4, entry->d_name);
        if (!read_file(path, expected, sizeof expected, &expected_size)) {
            test_fail(__FILE__, __LINE__, "%s is missing", path);
            continue;
        }
        for (size_t i = 0; i <= 18; i++) {
            size_t chunk = (i + 1) / 2;
            load_threaded(text, size, chunk, 1 + (int)(i % 2));
            CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
            if (strcmp(loaded.findings, expected) != 0) {
                test_fail(__FILE__, __LINE__, "%s with chunks of %zu: found\n%sexpected\n%s",
                    entry->d_name, chunk, loaded.findings, expected);
            }
            char start[512];
            snprintf(start, sizeof start, "%d:%d: %s", loaded.error.line, loaded.error.column,
                loaded.error.message);
            CHECK(strncmp(expected, start, strlen(start)) == 0);
            if (i == 0) memcpy(first, loaded.printed, sizeof first);
            if (strcmp(first, loaded.printed) != 0) {
                test_fail(__FILE__, __LINE__, "%s with chunks of %zu: printed\n%sat first\n%s",
                    entry->d_name, chunk, loaded.printed, first);
            }
            unload();
        }
        count++;
    }
    closedir(directory);
    CHECK(count >= 45);
}

static void formatting(void) {
    GlintDiagnostic diagnostic = {.path = "a.xml",
        .line = 3,
        .column = 5,
        .message = "no",
        .excerpt = "\t\xc3\xa9 \tab",
        .caret = 4,
        .caret_length = 2};
    char text[100];
    static const char wanted[] = "a.xml:3:5: error: no\n\t\xc3\xa9 \tab\n\t  \t^~\n";
    CHECK_INT(glint_diagnostic_format(&diagnostic, text, sizeof text), sizeof wanted - 1);
    CHECK_TEXT(text, wanted);
    CHECK_INT(glint_diagnostic_format(&diagnostic, text, 6), sizeof wanted - 1);
    CHECK_TEXT(text, "a.xml");
    CHECK_INT(glint_diagnostic_format(&diagnostic, NULL, 0), sizeof wanted - 1);
    diagnostic.line = 0;
    diagnostic.excerpt = NULL;
    diagnostic.severity = GLINT_SEVERITY_WARNING;
    glint_diagnostic_format(&diagnostic, text, sizeof text);
    CHECK_TEXT(text, "a.xml: warning: no\n");
}

static void long_lines(void) {
    load_filled(BEGIN "<!--", "-x", 10000,
        "--><surface type='Sphere'><radius>zero</radius></surface>"
        "<!-- this line goes on for a while and then for some more, so that it must be cut "
        "--></scene>");
    CHECK_TEXT(loaded.findings, "1:20073: radius: zero is not a number\n");
    CHECK(strstr(loaded.printed, "\n...-x-x") != NULL);
    CHECK(strstr(loaded.printed, "some more,...\n") != NULL ||
          strstr(loaded.printed, "...\n") != NULL);
    CHECK(strlen(loaded.printed) < 400);
    unload();
}

static void many_errors(void) {
    load_filled(BEGIN, "<banana/>\n", 1000000, END);
    CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
    CHECK_INT(loaded.count, 101);
    CHECK(strstr(loaded.findings, "0:0: 999900 more errors in this file\n") != NULL);
    CHECK(strstr(loaded.findings, "100:1: unknown element `banana`") != NULL);
    CHECK(loaded.peak_extra < 4 << 20);
    unload();
}

/* ---------------------------------------------------------------- hostile input */

static void expect_error(const char *message) {
    CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
    if (strstr(loaded.findings, message) == NULL) {
        test_fail(__FILE__, __LINE__, "\"%s\" is not in:\n%s", message, loaded.findings);
    }
    unload();
}

static void hostile(void) {
    load_filled(BEGIN, "<surface type='Group'>", 200000, "");
    expect_error("nested more than 100000 deep");
    load_filled(BEGIN, "<a>", 200000, "");
    expect_error("nested more than 100000 deep");
    load_filled(
        BEGIN "<light><position>", "1234567890", 10000000, " 0 0</position></light><x/></scene>");
    CHECK(strstr(loaded.findings, "1:100000075: unknown element `x`") != NULL);
    CHECK(loaded.peak_extra < 4 << 20);
    expect_error("1:52: the value of position is too long");
    load_filled(BEGIN "<light><position>", " \n", 10000000, " 0 0</position></light></scene>");
    CHECK(loaded.peak_extra < 4 << 20);
    expect_error("10000001:2: position needs 3 numbers; found 2");
    load_filled(BEGIN "<!-- ", "long ", 2000000, "--></scene>");
    CHECK_INT(loaded.status, GLINT_OK);
    unload();
    load_filled(BEGIN "<!-- ", "long ", 30000000, "--></scene>");
    expect_error("1:35: what begins here (a comment or a tag) does not end within 64 MiB");
    load_filled(BEGIN "<shader name='", "n", 1000000, "' type='Phong'/></scene>");
    expect_error("the name of shader is longer than 4096 bytes");
    load_filled(BEGIN "<", "n", 1000000, "/></scene>");
    expect_error("unknown element `nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn...` in the scene");
    load_filled("<!DOCTYPE scene [<!ENTITY a 'aaaaaaaaaa'>", "<!ENTITY b '&a;&a;&a;&a;'>", 100,
        "]><scene>&b;</scene>");
    expect_error("a scene cannot declare entities: `a`");
    load("<!DOCTYPE scene SYSTEM 'http://example.invalid/scene.dtd'>" BEGIN "&a;</scene>");
    expect_error("unknown entity `&a;`");
    load("<!DOCTYPE scene SYSTEM '/dev/zero'>" BEGIN END);
    CHECK_INT(loaded.status, GLINT_OK);
    unload();
    static const char zero[] = BEGIN "\0" END;
    load_bytes(zero, sizeof zero - 1, 0);
    expect_error("a zero byte");
}

#define WIDE_GROUP                                                                                 \
    "<surface type='Group'><translate>1e200 0 0</translate><scale>1e200 1 1</scale>\n"
#define NO_INVERSE ": the transform of this group cannot be inverted"

/* Groups whose transform is good in some dialects only: those that are not are told with their
 * places, however far behind them that shows, and those that are cost no time for their lines. */
static void doubtful_groups(void) {
    Input input = {.head = BEGIN WIDE_GROUP WIDE_GROUP "</surface>",
        .filler = "<!-- far -->\n",
        .tail = WIDE_GROUP "</surface></surface>" END,
        .filler_count = 60000};
    input.head_size = strlen(input.head);
    input.filler_size = strlen(input.filler);
    input.tail_size = strlen(input.tail);
    load_input(input, 0, GLINT_DIALECT_2017B, NULL);
    CHECK_INT(loaded.count, 3);
    const char *place = loaded.findings;
    static const char *const places[] = {"1:35" NO_INVERSE, "2:1" NO_INVERSE, "60003:1" NO_INVERSE};
    for (int i = 0; i < 3 && place != NULL; i++) place = strstr(place, places[i]);
    CHECK(place != NULL);
    unload();

    static const char pair[] = WIDE_GROUP WIDE_GROUP "</surface></surface>";
    enum { COUNT = 20000, PAIR = sizeof pair - 1 };
    char *text = malloc(sizeof BEGIN + sizeof END + (size_t)COUNT * PAIR), *end = text;
    CHECK(text != NULL);
    if (text == NULL) return;
    end += sprintf(end, "%s", BEGIN);
    for (int i = 0; i < COUNT; i++, end += PAIR) memcpy(end, pair, PAIR);
    end += sprintf(end, "%s", END);
    input = (Input){.head = text, .head_size = (size_t)(end - text), .mapped = true};
    clock_t start = clock();
    load_input(input, 0, GLINT_DIALECT_GLINT, NULL);
    CHECK((double)(clock() - start) / (double)CLOCKS_PER_SEC < test_slowness());
    CHECK_INT(loaded.status, GLINT_OK);
    unload();
    free(text);
}

/* Nothing is longer in a mapped file than in one that is read. */
static void long_comment(void) {
    size_t begin = strlen(BEGIN "<!--"), size = begin + 150000000, end = strlen("-->" END);
    char *text = malloc(size + end + 1);
    CHECK(text != NULL);
    if (text == NULL) return;
    memset(text, 'x', size);
    memcpy(text, BEGIN "<!--", begin);
    memcpy(text + size, "-->" END, end + 1);
    for (int threads = 1; threads <= 2; threads++) {
        Input input = {
            .head = text, .head_size = size + end, .thread_count = threads, .mapped = true};
        load_input(input, 0, GLINT_DIALECT_AUTO, NULL);
        expect_error("1:35: what begins here (a comment or a tag) does not end within 64 MiB");
    }
    free(text);
}

static void cut_anywhere(void) {
    static const char text[] =
        "\xef\xbb\xbf<?xml version='1.0'?>\n" BEGIN
        "<!-- c --><surface type='Sphere'><center>1 2 3</center></surface><![CDATA[ ]]></scene>\n";
    for (size_t size = 0; size < sizeof text - 2; size++) {
        load_threaded(text, size, size % 5, 1 + (int)(size & 1));
        CHECK_INT(loaded.status, GLINT_ERROR_SCENE);
        CHECK_INT(loaded.count, 1);
        unload();
    }
}

static const char small_scene[] =
    BEGIN "<shader name='s' type='Phong'/><surface type='Group' name='g'><scale>1 2 3</scale>"
          "<surface type='Sphere'><radius name='r'>1</radius><shader ref='s'/></surface></surface>"
          "<surface ref='g'/><light name='l'/><camera name='c'/><surface type='Box'/>" END;

static void chunks(void) {
    load(small_scene);
    GiScene *scene = &loaded.scene;
    uint32_t shapes = scene->shape_count;
    size_t groups_count = scene->groups.count, roots = scene->roots.count;
    unload();
    for (size_t i = 2; i < 80; i++) {
        load_threaded(small_scene, sizeof small_scene - 1, i / 2, 1 + (int)(i % 2));
        CHECK_INT(loaded.status, GLINT_OK);
        CHECK_INT(scene->shape_count, shapes);
        CHECK_INT(scene->groups.count, groups_count);
        CHECK_INT(scene->roots.count, roots);
        unload();
    }
}

/* Refuses the request whose turn it is. */
static void *failing_reallocate(void *user, void *pointer, size_t old_size, size_t new_size) {
    _Atomic long *left = user;
    (void)old_size;
    if (new_size == 0) {
        free(pointer);
        return NULL;
    }
    return atomic_fetch_sub(left, 1) == 0 ? NULL : realloc(pointer, new_size);
}

/* Each request in its turn. Without memory for threads, or for what they do, things go on without
 * them: it takes three to have a crew. */
static void fail_each_request(const char *text, int thread_count, GlintStatus wanted, long least) {
    int refused = 0;
    for (long request = 0;; request++) {
        _Atomic long left = request;
        GlintAllocator allocator = {failing_reallocate, &left};
        Input input = {.head = text, .head_size = strlen(text), .thread_count = thread_count};
        load_input(input, 16, GLINT_DIALECT_AUTO, &allocator);
        GlintStatus status = loaded.status;
        unload();
        if (left >= 0) {
            CHECK_INT(status, wanted);
            CHECK(request > least);
            CHECK(thread_count > 1 ? refused >= 3 : refused == 0);
            return;
        }
        if (status == wanted) {
            refused++;
        } else {
            CHECK_INT(status, GLINT_ERROR_MEMORY);
        }
    }
}

static void failing_allocator(void) {
    for (int threads = 1; threads <= 2; threads++) {
        fail_each_request(small_scene, threads, GLINT_OK, 5);
        fail_each_request(
            BEGIN "<x name='x'/><surface ref='y'/>" END, threads, GLINT_ERROR_SCENE, 5);
        fail_each_request(BEGIN "<light name='&amp;'/>" END, threads, GLINT_OK, 20);
    }
}

static bool cancel_third(void *user) { return ++*(int *)user == 3; }

static void failing_source(void) {
    Input input = {.fails = true};
    load_input(input, 0, GLINT_DIALECT_AUTO, NULL);
    CHECK_INT(loaded.status, GLINT_ERROR_FILE);
    CHECK_TEXT(loaded.error.path, "test.xml");
    unload();

    for (int threads = 1; threads <= 2; threads++) {
        int calls = 0;
        GlintMonitor monitor = {.cancelled = cancel_third, .user = &calls};
        Input text = {.head = small_scene, .head_size = sizeof small_scene - 1};
        GiReaderSource source = {.read = read_input,
            .user = &text,
            .name = "x",
            .monitor = &monitor,
            .chunk_size = 10,
            .thread_count = threads};
        gi_memory_init(&loaded.memory, NULL, 0);
        CHECK(gi_scene_init(&loaded.scene, &loaded.memory));
        CHECK_INT(gi_reader_load(&loaded.scene, &source, NULL, NULL), GLINT_CANCELLED);
        unload();
    }
}

/* A source that fails after so many bytes, and must not be asked again then. */
typedef struct Failing {
    Input input;
    size_t left;
    bool failed;
} Failing;

static int64_t read_failing(void *user, void *buffer, size_t size) {
    Failing *failing = user;
    CHECK(!failing->failed);
    if (failing->left == 0) failing->failed = true;
    if (failing->failed) return -1;
    if (size > failing->left) size = failing->left;
    failing->left -= size;
    return read_input(&failing->input, buffer, size);
}

/* What the reader stopped at comes before a failure, though more had been read on two threads. Here
 * the chunk that stops it ends with enough of a comment that its message needs no more bytes. */
static void failing_ahead(void) {
    enum { COUNT = 100001, CHUNK = 5000, COMMENT = 8000 };
    static const char filler[] = "<surface type='Group'>";
    static char comment[COMMENT] = "<!--";
    memset(comment + 4, '-' + 1, sizeof comment - 4);
    Input text = {.head = BEGIN, .filler = filler, .filler_count = COUNT, .tail = comment};
    text.head_size = strlen(BEGIN);
    text.filler_size = strlen(filler);
    text.tail_size = sizeof comment;
    size_t stop = text.head_size + COUNT * text.filler_size, end = (stop / CHUNK + 1) * CHUNK;
    CHECK(end - stop > 2000);
    for (size_t left = end - 3 * CHUNK; left < end + CHUNK; left += CHUNK / 4) {
        for (int threads = 1; threads <= 2; threads++) {
            Failing failing = {text, left, false};
            GiReaderSource source = {.read = read_failing,
                .user = &failing,
                .name = "x",
                .chunk_size = CHUNK,
                .thread_count = threads};
            gi_memory_init(&loaded.memory, NULL, 0);
            CHECK(gi_scene_init(&loaded.scene, &loaded.memory));
            GlintStatus status = gi_reader_load(&loaded.scene, &source, NULL, NULL);
            CHECK_INT(status, left < end ? GLINT_ERROR_FILE : GLINT_ERROR_SCENE);
            unload();
        }
    }
}

const GiTest tests_malformed[] = {TEST(malformed), TEST(formatting), TEST(long_lines),
    TEST(many_errors), TEST(hostile), TEST(doubtful_groups), TEST(long_comment), TEST(cut_anywhere),
    TEST(chunks), TEST(failing_allocator), TEST(failing_source), TEST(failing_ahead), TEST_END};
