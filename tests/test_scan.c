/* SPDX-License-Identifier: MIT
 * The scanner takes what it should and nothing else, and a scene is the same, with the same
 * findings, whether the scanner reads it, expat, or each a part, and on how many threads. */
#include "test_reader_input.h"

#include "random.h"
#include "reader/scan.h"

#include <stdlib.h>

/* ---------------------------------------------------------------- what is taken */

/* How much of a text the scanner takes; its end is the end of the file. */
static size_t taken(const char *text, GiScanStatus *status, GiTape *tape) {
    GiScanner scanner;
    gi_scanner_init(&scanner, &loaded.memory);
    *status = gi_scan(&scanner, text, strlen(text), strlen(text), tape);
    size_t size = (size_t)scanner.next;
    gi_scanner_reset(&scanner);
    return size;
}

static void plain(void) {
    static const char *const texts[] = {
        "<a/>",
        "<a></a>",
        "\xef\xbb\xbf<a b=\"1\" c=''/>",
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\r\n<!-- \xc3\xa4 <&]]> - -->\n<a/>\n",
        "<_a-.0:><b\n\tc='\xe2\x82\xac' d='' e='>' f=''\n/>text > \xc3\xa9\r\n</_a-.0:><!---->\r\n",
        "<a> 1 -2.5\n+.5e3 </a>",
    };
    gi_memory_init(&loaded.memory, NULL, 0);
    GiTape tape = {0};
    GiScanStatus status;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        CHECK_INT(taken(texts[i], &status, &tape), strlen(texts[i]));
        CHECK_INT(status, GI_SCAN_MORE);
    }
    CHECK_INT(tape.entries.count, 6);
    CHECK_INT(tape.entries.data[0].token.kind, GI_TOKEN_START);
    GiToken numbers = tape.entries.data[1].token;
    CHECK(numbers.kind == GI_TOKEN_NUMBERS && numbers.count == 3 && numbers.at == 3);
    CHECK_NEAR(tape.entries.data[2].number, 1, 0);
    CHECK_NEAR(tape.entries.data[3].number, -2.5, 0);
    CHECK_NEAR(tape.entries.data[4].number, 500, 0);
    CHECK_INT(tape.entries.data[5].token.kind, GI_TOKEN_END);
    gi_array_free(&loaded.memory, &tape.entries);
}

/* White space before and behind children is left out, and no other: of what stands in a value,
 * nothing is. Each text with the kinds of its tokens: start, end, text, numbers. */
static void blanks(void) {
    static const char *const cases[][2] = {
        {"<a>\n <b/>\r\n\t<c></c>\n</a>", "S SE SE E"},
        {"<a> </a>", "S T E"},
        {"<a> <!-- -->1<!-- --> </a>", "S T T T E"},
        {"<a> 1 <b/> 2 </a> ", "S T SE T E"},
        {"<a><!-- --> <b/><!-- --> <!-- --> </a>", "S SE E"},
        {"<a>\n <b>\n1 </b>\n</a>", "S S1 E E"},
    };
    gi_memory_init(&loaded.memory, NULL, 0);
    GiTape tape = {0};
    GiScanStatus status;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *expected = cases[i][1];
        CHECK_INT(taken(cases[i][0], &status, &tape), strlen(cases[i][0]));
        for (size_t k = 0; k < tape.entries.count; k++) {
            GiToken token = tape.entries.data[k].token;
            expected += *expected == ' ';
            CHECK(*expected++ == (token.kind == GI_TOKEN_START     ? 'S'
                                     : token.kind == GI_TOKEN_END  ? 'E'
                                     : token.kind == GI_TOKEN_TEXT ? 'T'
                                                                   : '1'));
            if (token.kind == GI_TOKEN_NUMBERS) k += token.count;
        }
        CHECK(*expected == '\0');
    }
    gi_array_free(&loaded.memory, &tape.entries);
}

/* Each is left from the bar on, which is not there. */
static void strange(void) {
    static const char *const texts[] = {
        "|<?xml version='1.0' encoding='iso-8859-1'?><a/>",
        "|<?xml version=\"1.0\"?><?xml version=\"1.0\" encoding=\"UTF-8\"?><a/>",
        "|<!----><?xml version=\"1.0\"?><a/>                        ",
        "|<!DOCTYPE a><a/>",
        "| <a b='&lt;'/>",
        "|a",
        "|<a b='1' b='2'/>",
        "|<a b='1'c='2'/>",
        "|<a b = '1'/>",
        "|<a b='\t'/>",
        "|<a b='<'/>",
        "|<a b='\"'/>",
        "|<\xc3\xa4/>",
        "<a>|</b>",
        "<a>|</a >",
        "<a>|&lt;</a>",
        "<a>|]]></a>",
        "<a>|\x01</a>",
        "<a>|\xff</a>",
        "<a>|\xc0\x80</a>",
        "<a>|\xed\xa0\x80</a>",
        "<a>|\xef\xbf\xbf</a>",
        "<a>1 2|</c>",
        "<a>|< b/></a>",
        "<a>|<![CDATA[]]></a>",
        "<a>|<?b?></a>",
        "<a>|<!-- -- --></a>",
        "<a>|<!-- --->",
        "<a>|<!-- \x02 -->",
        "<a>|<b c='' d='' e='' f='' g=''/></a>",
        "<a/>|<b/>",
        "<a/> |b",
        "<a/>|</a>",
    };
    gi_memory_init(&loaded.memory, NULL, 0);
    GiTape tape = {0};
    GiScanStatus status;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        char text[200];
        size_t bar = strcspn(texts[i], "|");
        snprintf(text, sizeof text, "%.*s%s", (int)bar, texts[i], texts[i] + bar + 1);
        size_t size = taken(text, &status, &tape);
        if (size != bar || status != GI_SCAN_STRANGE) {
            test_fail(__FILE__, __LINE__, "%s: %zu bytes", texts[i], size);
        }
    }
    gi_array_free(&loaded.memory, &tape.entries);
}

/* What is behind the texts below, so that the scanner does not find their end near. */
#define FAR "                                                                \n</s>"

/* Elements like one before are one token: L, where others are as above. */
static void alike(void) {
    static const char *const cases[][2] = {
        {"<s><a><v>1</v></a><a><v>2</v></a><a><v>-.3e1</v></a>" FAR, "SSS1EELLE"},
        {"<s><a b='c'><v>1 2 3</v>\n<r e='m'/><w>4</w> </a>\n"
         "<a b='c'><v>\t6 7\r8 </v>\n<r e=''/><w>9</w> </a>" FAR,
            "SSS1ESES1EELE"},
        {"<s><a><r e='f'/><!-- > --></a><a><r e='\xc3\xa4'/><!-- > --></a>"
         "<a><r e='g'/><!-- > --></a>" FAR,
            "SSSEESSEELE"}, /* of what is not ASCII nothing is said */
        {"<s><a><v>1</v></a><b><w>1</w></b><b><w>2</w></b><a><v>2</v></a>" FAR, "SSS1EESS1EELLE"},
        {"<s><g><a><v>1</v></a></g><g><a><v>1</v></a></g>" FAR, "SSSS1EEESLEE"},
        /* a start tag, an end tag, a number more or less, another attribute, blanks elsewhere */
        {"<s><a><v>1</v></a><a ><v>2</v></a>" FAR, "SSS1EESS1EEE"},
        {"<s><a><v>1</v></a><a><v>2 3</v></a>" FAR, "SSS1EESS1EEE"},
        {"<s><a><v>1</v></a><a><v>2</v> </a>" FAR, "SSS1EESS1EEE"},
        {"<s><a><v>1</v></a><a><v>2</v><v>3</v></a>" FAR, "SSS1EESS1ES1EEE"},
        {"<s><a><v>1</v></a><a><w>2</w></a>" FAR, "SSS1EESS1EEE"},
        {"<s><a><v>1</v></a><a><v>x</v></a>" FAR, "SSS1EESSTEEE"},
        {"<s><a><r e='f'/></a><a><r h='f'/></a>" FAR, "SSSEESSEEE"},
        {"<s><a><r e='f'/></a><a><r e=\"f\"/></a>" FAR, "SSSEESSEEE"},
        /* no elements of values and references */
        {"<s><a>t<v>1</v></a><a>t<v>1</v></a>" FAR, "SSTS1EESTS1EEE"},
        {"<s><a><r e='f' h='i'/></a><a><r e='f' h='i'/></a>" FAR, "SSSEESSEEE"},
        {"<s><a><v/></a><a><v/></a>" FAR, "SSSEESSEEE"},
        {"<s><a><v>t</v></a><a><v>t</v></a>" FAR, "SSSTEESSTEEE"},
    };
    gi_memory_init(&loaded.memory, NULL, 0);
    GiTape tape = {0};
    GiScanStatus status;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char kinds[40];
        size_t count = 0;
        CHECK_INT(taken(cases[i][0], &status, &tape), strlen(cases[i][0]));
        for (size_t k = 0; k < tape.entries.count && count + 1 < sizeof kinds; k++) {
            GiToken token = tape.entries.data[k].token;
            if (token.kind == GI_TOKEN_SPAN) continue;
            kinds[count++] = "SET1?L"[token.kind];
            if (token.kind == GI_TOKEN_NUMBERS) k += token.count;
            for (int hole = 0; token.kind == GI_TOKEN_LIKE && hole < token.count; hole++) {
                GiToken in = tape.entries.data[++k].token;
                if (in.kind == GI_TOKEN_NUMBERS) k += in.count;
            }
        }
        kinds[count] = '\0';
        CHECK_TEXT(kinds, cases[i][1]);
    }
    gi_array_free(&loaded.memory, &tape.entries);
}

/* What an element like another would have on the tape is what it has where it comes first. */
static void expanded(void) {
    static const char *const first = "<a b='c'><v>1 2 3</v>\n<r e='mn'/><w>4</w> <r e=''/></a>";
    static const char *const next = "<a b='c'><v> 77 8 -9.5\n</v>\n<r e=''/><w>\t0 </w> "
                                    "<r e='opq'/></a>";
    char text[400], alone[400];
    gi_memory_init(&loaded.memory, NULL, 0);
    GiTape tape = {0}, plain = {0};
    GiScanStatus status;
    snprintf(text, sizeof text, "<s>%s%s" FAR, first, next);
    snprintf(alone, sizeof alone, "<s>%*s%s" FAR, (int)strlen(first), "", next);
    taken(text, &status, &tape);
    taken(alone, &status, &plain);
    size_t k = 0;
    while (k < tape.entries.count && tape.entries.data[k].token.kind != GI_TOKEN_LIKE) k++;
    CHECK(k < tape.entries.count);
    GiTapeEntry entries[GI_PATTERN_ENTRY_LIMIT];
    int count =
        gi_pattern_expand(&tape.patterns[0], tape.entries.data, &tape.entries.data[k], entries);
    CHECK_INT(count, plain.entries.count - 2); /* without <s> and </s> */
    for (int i = 0; i < count; i++) {
        GiTapeEntry wanted = plain.entries.data[i + 1];
        if (wanted.token.kind == GI_TOKEN_END) {
            CHECK_INT(entries[i].token.kind, GI_TOKEN_END);
            CHECK_INT(
                entries[i].token.at + entries[i].token.size, wanted.token.at + wanted.token.size);
        } else {
            CHECK(memcmp(&entries[i], &wanted, sizeof wanted) == 0);
        }
    }
    gi_array_free(&loaded.memory, &tape.entries);
    gi_array_free(&loaded.memory, &plain.entries);
}

/* Scans what a text has before and behind a place by two scanners, and joins them. */
static bool join_at(const char *text, size_t place, GiScanner *scanner) {
    GiScanner behind;
    GiTape tape = {0};
    size_t size = strlen(text);
    gi_scanner_init(scanner, &loaded.memory);
    gi_scanner_init(&behind, &loaded.memory);
    gi_scanner_begin_inside(&behind, (int64_t)place);
    GiScanStatus before = gi_scan(scanner, text, size, place, &tape);
    bool met = before == GI_SCAN_MORE && scanner->next == (int64_t)place;
    bool good = gi_scan(&behind, text + place, size - place, size - place, &tape) == GI_SCAN_MORE;
    bool joined = met && good && gi_scanner_join(scanner, &behind);
    gi_scanner_reset(&behind);
    gi_array_free(&loaded.memory, &tape.entries);
    return joined;
}

/* Two halves are joined where one scanner would have gone through, with the same elements open, and
 * nowhere else. The bar is the place. */
static void joined(void) {
    static const struct {
        const char *text, *open; /* open: null when they are not to be joined */
    } cases[] = {
        {"<a><b>1</b>|<b>2</b>", "<a>"},
        {"<a><b>1</b>\n  |<b>", "<a><b>"},
        {"<a><b><c>|<d/></c></b><e><f>", "<a><e><f>"},
        {"<a><b><c>|<d></d></c>", "<a><b>"},
        {"<a><b>|<c></b>", NULL},
        {"<a><b>|<c/></a>", NULL},
        {"<a><b>|<c/></bb>", NULL},
        {"<a><b>|<c/></b></a>", NULL}, /* the root, behind which other things hold */
        {"<a/>|<b/>", NULL},
        {"<a><!-- > |<b/> --></a>", NULL},
        {"<a><b c='>|<d/>'/></a>", NULL},
        {"<a>|<b>&lt;", NULL},
    };
    gi_memory_init(&loaded.memory, NULL, 0);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[100];
        GiScanner scanner;
        size_t bar = strcspn(cases[i].text, "|");
        snprintf(text, sizeof text, "%.*s%s", (int)bar, cases[i].text, cases[i].text + bar + 1);
        bool found = join_at(text, bar, &scanner);
        CHECK_INT(found, cases[i].open != NULL);
        if (found && cases[i].open != NULL) {
            char open[100];
            snprintf(open, sizeof open, "%.*s", (int)scanner.open.count, scanner.open.data);
            CHECK_TEXT(open, cases[i].open);
            CHECK_INT(scanner.next, strlen(text));
            for (size_t k = 0; k < scanner.starts.count; k++) {
                CHECK(open[scanner.starts.data[k]] == '<');
            }
        }
        gi_scanner_reset(&scanner);
    }
    CHECK_INT(loaded.memory.used, 0);
}

/* ---------------------------------------------------------------- the same as by expat */

typedef struct Outcome {
    GlintStatus status;
    uint64_t hash; /* of the findings, and of a scene without any */
} Outcome;

static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size) {
    const unsigned char *p = bytes;
    for (size_t i = 0; i < size; i++) hash = (hash ^ p[i]) * UINT64_C(1099511628211);
    return hash;
}

#define HASH_ARRAY(hash, array)                                                                    \
    hash_bytes((hash), (array).data, (array).count * sizeof *(array).data)

static Outcome load_as(Input input, size_t chunk_size, bool expat_only) {
    load_by(input, chunk_size, GLINT_DIALECT_AUTO, NULL, expat_only);
    const GiScene *scene = &loaded.scene;
    Outcome outcome = {loaded.status, hash_bytes(1, loaded.printed, strlen(loaded.printed))};
    if (loaded.status == GLINT_OK) {
        outcome.hash = HASH_ARRAY(outcome.hash, scene->spheres);
        outcome.hash = HASH_ARRAY(outcome.hash, scene->boxes);
        outcome.hash = HASH_ARRAY(outcome.hash, scene->cones);
        outcome.hash = HASH_ARRAY(outcome.hash, scene->info[GI_SHAPE_SPHERE]);
        outcome.hash = HASH_ARRAY(outcome.hash, scene->roots);
        outcome.hash =
            hash_bytes(outcome.hash, &scene->camera.view_point, sizeof scene->camera.view_point);
        outcome.hash += scene->lights.count + 16 * scene->groups.count + 256 * scene->shaders.count;
    }
    unload();
    return outcome;
}

static Outcome load_either(
    const char *text, size_t size, size_t chunk_size, int thread_count, bool expat_only) {
    Input input = {.head = text, .head_size = size, .thread_count = thread_count};
    return load_as(input, chunk_size, expat_only);
}

static Outcome load_mapped(const char *text, size_t size, size_t chunk_size, int thread_count) {
    Input input = {.head = text, .head_size = size, .thread_count = thread_count, .mapped = true};
    return load_as(input, chunk_size, false);
}

static bool same_outcome(Outcome a, Outcome b) { return a.status == b.status && a.hash == b.hash; }

/* Puts in, takes out or doubles a little, in a few places. */
static size_t mutate(Random *random, char *text, size_t size) {
    static const struct {
        const char *text;
        size_t size;
    } pieces[] = {
#define PIECE(text) {text, sizeof text - 1}
        PIECE("<"), PIECE(">"), PIECE("/"), PIECE("&"), PIECE("&lt;"), PIECE("&#49;"), PIECE("]]>"),
        PIECE("<!--"), PIECE("-->"), PIECE("<!-- \r -->"), PIECE("\r\n"), PIECE("\r"), PIECE("\n"),
        PIECE("\t"), PIECE("'"), PIECE("\""), PIECE("="), PIECE(" "), PIECE("\xc3\xa9"),
        PIECE("\xff"), PIECE("\xed\xa0\x80"), PIECE("\xef\xbf\xbe"), PIECE("\xf0\x9f\x98\x80"),
        PIECE("\0"), PIECE("\x01"), PIECE("<![CDATA[1 2]]>"), PIECE("<?x y?>"), PIECE("1"),
        PIECE("."), PIECE("e5"), PIECE("-"), PIECE("name='a'"), PIECE(" ref=\"s\""),
        PIECE("<!-- ><radius> -->"), PIECE("</surface>"), PIECE("<surface type='Group'>"),
        PIECE("<center>"), PIECE("</center>"), PIECE("<radius/>"), PIECE("</scene>"),
        PIECE("<surface type='Box'/>"), PIECE("<!DOCTYPE scene>"), PIECE("<?xml version='1.0'?>"),
        PIECE("<?xml version=\"1.0\"?>")};
    for (int count = 1 + random_below(random, 3); count > 0; count--) {
        size_t at = (size_t)random_below(random, (int)size + 1);
        if (random_below(random, 4) == 0) {
            size_t length = (size_t)random_below(random, 9);
            if (length > size - at) length = size - at;
            memmove(text + at, text + at + length, size - at - length);
            size -= length;
            continue;
        }
        int which = random_below(random, (int)(sizeof pieces / sizeof pieces[0]));
        memmove(text + at + pieces[which].size, text + at, size - at);
        memcpy(text + at, pieces[which].text, pieces[which].size);
        size += pieces[which].size;
    }
    return size;
}

#define SPHERE(shader, center)                                                                     \
    "<surface type='Sphere'><shader ref='" shader "'/><center>" center                             \
    "</center>\n <radius>1.5</radius></surface>\n"
#define TIP(z)      "<surface type='Cone'><tipz>" z "</tipz></surface>"
#define CONE(theta) "<surface type='Cone'><theta>" theta "</theta><height>3</height></surface>"

static void same_as_expat(void) {
    static const char *const seeds[] = {
        BEGIN "<shader name='s' type='Phong'/>\r\n<surface type='Sphere'><shader ref='s'/>\r\n"
              "<center>1 2\t3.5e1</center><radius>.5</radius></surface><samples>4</samples>\n" END,
        "\xef\xbb\xbf<?xml version=\"1.0\"?>\n<!-- a <b> & c -->\n<scene dialect=\"2013\">\n"
        "  <camera><viewPoint>1 <!-- 5 --> 2 3</viewPoint></camera>\n  <image>4 2</image>\n"
        "  <surface type=\"Group\" name='g'><scale>1 2 3</scale>\n"
        "    <surface type='Cone'><height>2</height><tipz>9</tipz></surface></surface>\n"
        "  <surface ref='g'/><light><intensity>1 1 1</intensity></light>\n</scene>\n<!-- end -->",
        /* many alike */
        BEGIN "<shader name='s' type='Phong'/><shader name='t' type='Glazed'/>\n" SPHERE(
            "s", "1 2 3") SPHERE("t", "-1 .5 7") SPHERE("s", "1 2 4e1") CONE("45") CONE("30.5")
            CONE("179") SPHERE("t", "0 0 0") "<surface type='Group'>" CONE("20") SPHERE(
                "s", "5 6 7") "<translate>1 2 3</translate></surface>\n" SPHERE("t", "8 9 10")
                CONE("90") "<!-- the end of the scene, which is far enough behind -->\n" END,
    };
    Random random = {5};
    for (int i = 0; i < 30000; i++) {
        char text[2000];
        const char *seed = seeds[i % 3];
        size_t size = strlen(seed);
        memcpy(text, seed, size);
        if (i > 2) size = mutate(&random, text, size);
        Outcome expected = load_either(text, size, 0, 1, true);
        Outcome found = load_either(text, size, 0, 1, false);
        bool same = same_outcome(found, expected);
        /* Of malformed text expat hands out more or less, depending on the chunks. */
        size_t chunk_size = 1 + (size_t)random_below(&random, i % 7 < 4 ? 60 : 900);
        found = load_either(text, size, chunk_size, 1, false);
        same &= found.status == expected.status &&
                (found.status != GLINT_OK || found.hash == expected.hash);
        /* Threads make no difference at all. */
        if (i % 4 < 2) {
            same &= same_outcome(load_either(text, size, chunk_size, 2 + i % 2, false), found);
        } else {
            text[size] = '\0';
            Outcome mapped = load_mapped(text, size, chunk_size, 1);
            same &= mapped.status == expected.status &&
                    (mapped.status != GLINT_OK || mapped.hash == expected.hash);
            same &= same_outcome(load_mapped(text, size, chunk_size, 2 + i % 2), mapped);
        }
        if (!same) test_fail(__FILE__, __LINE__, "not the same: %.*s", (int)size, text);
    }
}

/* A scene of many surfaces in a few kinds, with a mistake here and there, cut into pieces that hold
 * several: by expat, by one thread and by some, read and mapped. */
static void many_alike(void) {
    enum { COUNT = 400, LIMIT = 64 * 1024 };
    static const char *const kinds[] = {SPHERE("s", "1 2 3"), SPHERE("s", "-.5 7.25 1e2"),
        SPHERE("t", "0 0 1"), SPHERE("s", "1 2"), SPHERE("u", "1 2 3"), CONE("45"), CONE("30.5"),
        CONE("180"), "<surface type='Group'>", "</surface>", "<!-- ><radius> -->",
        "<surface type='Box'/>", TIP("4"), TIP("0")};
    static char text[LIMIT];
    Random random = {9};
    for (int round = 0; round < 150; round++) {
        size_t size = (size_t)snprintf(text, sizeof text,
            BEGIN "<shader name='s' type='Phong'/>\n<shader name='t' type='Glazed'/>");
        int depth = 0, common = round % 2 == 0 ? 3 : 14;
        for (int i = 0; i < COUNT; i++) {
            int kind = random_below(&random, random_below(&random, 20) == 0 ? 14 : common);
            if (kind == 9 && depth == 0) continue;
            depth += kind == 8 ? 1 : kind == 9 ? -1 : 0;
            size += (size_t)snprintf(text + size, sizeof text - size, "%s", kinds[kind]);
        }
        while (depth-- > 0) size += (size_t)snprintf(text + size, sizeof text - size, "</surface>");
        size += (size_t)snprintf(text + size, sizeof text - size, "%s", END);
        if (round % 3 == 0) size = mutate(&random, text, size);
        text[size] = '\0';
        Outcome expected = load_either(text, size, 0, 1, true);
        CHECK(same_outcome(load_either(text, size, 0, 1, false), expected));
        size_t chunk_size = 5000 + (size_t)random_below(&random, 60000);
        Outcome read = load_either(text, size, chunk_size, 1, false);
        Outcome mapped = load_mapped(text, size, chunk_size, 1);
        CHECK_INT(read.status, expected.status);
        CHECK_INT(mapped.status, expected.status);
        if (round % 3 != 0) CHECK(same_outcome(read, expected) && same_outcome(mapped, expected));
        for (int threads = 2; threads <= 3; threads++) {
            CHECK(same_outcome(load_either(text, size, chunk_size, threads, false), read));
            CHECK(same_outcome(load_mapped(text, size, chunk_size, threads), mapped));
        }
    }
}

const GiTest tests_scan[] = {TEST(plain), TEST(blanks), TEST(strange), TEST(alike), TEST(expanded),
    TEST(joined), TEST(same_as_expat), TEST(many_alike), TEST_END};
