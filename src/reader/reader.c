/* SPDX-License-Identifier: MIT
 * The outer loop: bytes from the source through the window into the scanner or the parser, whose
 * events go to tree.c. Nothing of the document is kept but the open elements and what is named.
 *
 * Of a large file other threads scan a chunk while this one builds from the chunk before it. The
 * source is read and the window moved by this thread alone, before that or after it; meanwhile all
 * only look at the window's bytes. The user is called back by this thread, too.
 *
 * A large file is mapped. Then all bytes are there from the beginning, but the window grows through
 * them chunk by chunk, and what was played is forgotten. */
#include "reader/reader.h"

#include "base/digest.h"
#include "base/error.h"
#include "reader/state.h"

#include <string.h>

enum {
    CHUNK_SIZE = 256 * 1024,
    MAPPED_CHUNK_SIZE = 512 * 1024,
    THREAD_SIZE = 2 * 1024 * 1024, /* of a file that is worth a thread */
    TOKEN_LIMIT = 64 * 1024 * 1024,
    THREAD_LIMIT = 4 /* building from what they scan keeps the caller's thread busy */
};

/* ---------------------------------------------------------------- stopping */

void gi_reader_stop(GiReader *reader) {
    if (reader->stopped) return;
    reader->stopped = true;
    if (reader->parser != NULL) XML_StopParser(reader->parser, XML_FALSE);
}

void gi_reader_out_of_memory(GiReader *reader) {
    reader->out_of_memory = true;
    gi_reader_stop(reader);
}

/* ---------------------------------------------------------------- window and places */

/* Gives lines and columns to the places that are still wanted, before their bytes go. The frames
 * are in the order of the file, so that those without a line are on top. */
static void locate_places(GiReader *reader) {
    size_t first = reader->frames.count;
    while (first > 0 && reader->frames.data[first - 1].place.line == 0) first--;
    for (size_t i = first; i < reader->frames.count; i++) {
        gi_window_locate(&reader->window, &reader->frames.data[i].place);
    }
    for (; reader->doubtful_located < reader->doubtful.count; reader->doubtful_located++) {
        GiDoubtfulGroup *group = &reader->doubtful.data[reader->doubtful_located];
        gi_window_locate(&reader->window, &group->place);
    }
    for (int i = 0; i < GI_SLOT_COUNT; i++) {
        if (gi_reader_is_given(reader, (GiSlot)i)) {
            gi_window_locate(&reader->window, &reader->slots[i].place);
        }
    }
    for (size_t i = 0; i < reader->segment_count; i++) {
        gi_window_locate(&reader->window, &reader->segments[i].place);
    }
}

static int64_t window_end(const GiReader *reader) {
    return reader->window.base + (int64_t)reader->window.size;
}

/* The first byte that the scanner or expat has not dealt with. */
static int64_t parsed_end(const GiReader *reader) {
    if (reader->parser == NULL) return reader->scanner.next;
    int64_t offset = gi_parser_offset(reader), end = window_end(reader);
    return offset < reader->window.base ? reader->window.base : offset > end ? end : offset;
}

/* The first byte of which the tree has not been told. */
static int64_t played_end(const GiReader *reader) {
    const GiReel *waiting = reader->crew != NULL ? reader->crew->scanned : NULL;
    return waiting != NULL && waiting->count > 0 ? waiting->tapes[0].begin : parsed_end(reader);
}

/* Makes the window small again, when that is worth moving what stays. */
static void slide_window(GiReader *reader, size_t more) {
    GiWindow *window = &reader->window;
    int64_t keep = played_end(reader) - GI_WINDOW_KEEP;
    size_t room = window->capacity - window->size;
    if (reader->source->mapped != NULL) {
        /* What was before that is forgotten already; counting lines, if it comes to that, brings it
         * back. */
        int64_t begin = keep > 4 * MAPPED_CHUNK_SIZE ? keep - 4 * MAPPED_CHUNK_SIZE : 0;
        if (keep > 0) gi_file_bytes_forget(reader->source->mapped, (size_t)begin, (size_t)keep);
        return;
    }
    bool whole = reader->source->sources != NULL;
    if (whole || room >= more || keep - window->base < GI_WINDOW_KEEP) return;
    gi_report_capture(&reader->report, window_end(reader) - GI_WINDOW_CONTEXT);
    locate_places(reader);
    gi_window_discard(window, keep);
}

/* ---------------------------------------------------------------- the loop */

typedef struct Feed {
    const GiReaderSource *source;
    int64_t total; /* bytes read */
    bool ended;
    GlintStatus status; /* nothing is read after a failure */
} Feed;

static bool is_cancelled(const GlintMonitor *monitor) {
    return monitor != NULL && monitor->cancelled != NULL && monitor->cancelled(monitor->user);
}

static GlintStatus report_cancelled(GlintError *error) {
    return gi_error_set(error, GLINT_CANCELLED, "cancelled while reading the scene");
}

/* As much of a mapped file is read when the window shows it. */
static int64_t show_bytes(GiReader *reader, size_t size) {
    size_t left = reader->source->mapped->size - reader->window.size;
    if (size > left) size = left;
    reader->window.size += size;
    return (int64_t)size;
}

/* Reads up to `size` bytes behind the window; negative when that fails. */
static int64_t read_some(GiReader *reader, size_t size) {
    const GiReaderSource *source = reader->source;
    GiWindow *window = &reader->window;
    if (source->mapped != NULL) return show_bytes(reader, size);
    int64_t count = source->read(source->user, window->data + window->size, size);
    if (count < 0 || (uint64_t)count > size) return -1;
    window->size += (size_t)count;
    window->data[window->size] = 0; /* where the scanner stops */
    return count;
}

static GlintStatus read_bytes(GiReader *reader, Feed *feed, size_t wanted, GlintError *error) {
    const GiReaderSource *source = feed->source;
    const GlintMonitor *monitor = source->monitor;
    if (source->mapped == NULL && !gi_window_reserve(&reader->window, wanted + 1)) {
        return gi_error_memory(error);
    }
    for (size_t got = 0; got < wanted && !feed->ended;) {
        if (is_cancelled(monitor)) return report_cancelled(error);
        size_t size = wanted - got < CHUNK_SIZE ? wanted - got : CHUNK_SIZE;
        int64_t count = read_some(reader, size);
        if (count < 0) {
            /* A source that waits may give up because of that. */
            if (is_cancelled(monitor)) return report_cancelled(error);
            return gi_error_set_path(
                error, GLINT_ERROR_FILE, source->name, "the file cannot be read");
        }
        feed->ended = count == 0;
        got += (size_t)count;
    }
    feed->total = window_end(reader);
    if (monitor != NULL && monitor->progress != NULL) {
        double total = (double)source->total_size;
        double fraction = total > 0 ? (double)feed->total / total : -1;
        monitor->progress(monitor->user, GLINT_PHASE_READ, fraction < 1 ? fraction : 1);
    }
    return GLINT_OK;
}

/* Reads up to `wanted` bytes behind the window. */
static GlintStatus read_more(GiReader *reader, Feed *feed, size_t wanted, GlintError *error) {
    if (feed->status == GLINT_OK) feed->status = read_bytes(reader, feed, wanted, error);
    return feed->status;
}

/* ---------------------------------------------------------------- scanning */

/* Brings the digest to the end of the window. */
static void digest_window(GiReader *reader) {
    const GiWindow *window = &reader->window;
    size_t from = (size_t)(reader->digested - window->base);
    if (from == window->size) return;
    reader->digest = gi_digest(reader->digest, window->data + from, window->size - from);
    reader->digested = window_end(reader);
}

/* Gives a large file threads that scan it; a test's small one as well. When none are to be had,
 * this one does all. */
static void need_crew(GiReader *reader, const Feed *feed) {
    const GiReaderSource *source = feed->source;
    int64_t size = source->total_size > feed->total ? source->total_size : feed->total;
    if (reader->crew_considered || (size < THREAD_SIZE && source->chunk_size == 0)) return;
    reader->crew_considered = true;
    int count = gi_pool_size(source->thread_count);
    if (count > THREAD_LIMIT) count = THREAD_LIMIT;
    if (count > 1) reader->crew = gi_crew_create(reader->memory, count);
}

/* Plays what was scanned and waits. */
static void play_waiting(void *context) {
    GiReader *reader = context;
    GiReel *reel = reader->crew != NULL ? reader->crew->scanned : NULL;
    for (int i = 0; reel != NULL && i < reel->count; i++) gi_tape_play(reader, &reel->tapes[i]);
    if (reel != NULL) reel->count = 0;
}

/* What else is to be done with the bytes while they are scanned: the digest, and counting the lines
 * up to where a window that moves will begin. */
static void look_aside(void *context) {
    GiReader *reader = context;
    digest_window(reader);
    if (reader->source->mapped != NULL || reader->source->sources != NULL) return;
    int64_t keep = reader->scan_begin - GI_WINDOW_KEEP;
    if (keep > reader->next_keep.offset) {
        gi_window_advance(&reader->window, &reader->next_keep, keep);
    }
}

/* Scans what is new in the window, and plays it now, or the next time, while what follows is
 * scanned. GI_SCAN_MORE only where there is more, or all is done. */
static GiScanStatus scan_window(GiReader *reader, const Feed *feed) {
    GiWindow *window = &reader->window;
    GiScanner *scanner = &reader->scanner;
    const GiFileBytes *mapped = reader->source->mapped;
    size_t size = mapped != NULL ? mapped->size : window->size;
    size_t from = (size_t)(scanner->next - window->base);
    GiScanStatus status;
    need_crew(reader, feed);
    if (reader->crew != NULL) {
        reader->next_keep = window->cursor;
        reader->scan_begin = scanner->next;
        status =
            gi_crew_scan(reader->crew, scanner, window, size, play_waiting, look_aside, reader);
        if (reader->next_keep.offset > window->cursor.offset) window->cursor = reader->next_keep;
    } else {
        digest_window(reader);
        status = gi_scan(scanner, (const char *)window->data + from, size - from,
            window->size - from, &reader->tape);
    }
    if (status == GI_SCAN_MEMORY) return GI_SCAN_MEMORY;
    /* The last token may end behind what the window shows of a mapped file. */
    if (scanner->next > window_end(reader)) window->size = (size_t)(scanner->next - window->base);
    bool done = scanner->next == window_end(reader) && gi_scanner_is_complete(scanner);
    if (feed->ended && !done) status = GI_SCAN_STRANGE;
    if (reader->crew == NULL) {
        gi_tape_play(reader, &reader->tape);
    } else if (feed->ended || status != GI_SCAN_MORE) {
        play_waiting(reader);
    }
    return status;
}

/* Hands what is new in the window, from an offset on, to the scanner or expat. False when neither
 * can go on; memory may be short then, or the reader stopped. */
static bool parse_window(GiReader *reader, const Feed *feed, int64_t from) {
    if (reader->parser == NULL) {
        GiScanStatus status = scan_window(reader, feed);
        if (status == GI_SCAN_MORE || reader->stopped) return !reader->stopped;
        if (status == GI_SCAN_MEMORY || !gi_parser_open(reader)) {
            gi_reader_out_of_memory(reader);
            return false;
        }
        from = reader->scanner.next;
    }
    digest_window(reader);
    size_t begin = (size_t)(from - reader->window.base);
    return gi_parser_feed(
        reader, reader->window.data + begin, reader->window.size - begin, feed->ended);
}

static GlintStatus parse(GiReader *reader, Feed *feed, GlintError *error) {
    size_t chunk = feed->source->mapped != NULL ? MAPPED_CHUNK_SIZE : CHUNK_SIZE;
    if (feed->source->chunk_size > 0) chunk = feed->source->chunk_size;
    bool first = true;
    while (!feed->ended && !reader->stopped) {
        /* As much again as is waiting: a token that spans many chunks is scanned from its start
         * each time, which adds up to no more than twice its length this way. */
        size_t waiting = (size_t)(window_end(reader) - parsed_end(reader));
        size_t wanted = waiting > chunk ? waiting : chunk;
        if (waiting > TOKEN_LIMIT) {
            play_waiting(reader);
            if (reader->stopped) return GLINT_OK;
            gi_report_add(&reader->report, (GiPlace){.offset = parsed_end(reader)}, 1,
                "what begins here (a comment or a tag) does not end within 64 MiB");
            reader->stopped = true;
            return GLINT_OK;
        }
        if (first && wanted < 4) wanted = 4; /* the encoding shows in the first bytes */
        slide_window(reader, wanted + 1);
        int64_t from = window_end(reader);
        GlintStatus status = read_more(reader, feed, wanted, error);
        if (status != GLINT_OK) {
            play_waiting(reader); /* what is wrong there was there before */
            return reader->stopped ? GLINT_OK : status;
        }
        if (first) gi_window_detect(&reader->window);
        first = false;
        if (parse_window(reader, feed, from)) continue;
        if (!reader->stopped) {
            int64_t place = parsed_end(reader);
            /* The message may look at what follows, and shows the rest of the line. */
            if (window_end(reader) - place < GI_WINDOW_CONTEXT) {
                status = read_more(reader, feed, GI_WINDOW_CONTEXT, error);
                if (status != GLINT_OK) return status;
            }
            gi_malformed_report(reader);
        }
        reader->stopped = true;
    }
    return GLINT_OK;
}

static void open_reader(GiReader *reader, GiScene *scene, const GiReaderSource *source) {
    memset(reader, 0, sizeof *reader);
    reader->source = source;
    reader->scene = scene;
    reader->memory = scene->memory;
    gi_element_index_init(&reader->elements);
    gi_window_init(&reader->window, scene->memory);
    if (source->mapped != NULL) {
        reader->window.data = (unsigned char *)(uintptr_t)source->mapped->bytes;
    }
    gi_scanner_init(&reader->scanner, scene->memory);
    gi_report_init(&reader->report, scene->memory, &reader->window);
    gi_names_init(&reader->names, scene->memory);
    gi_names_init(&reader->strings, scene->memory);
    for (int row = 0; gi_elements[row].name != NULL; row++) {
        const char *text = gi_elements[row].default_text;
        if (text == NULL) continue;
        reader->row_defaults[row] = gi_value_parse_default(text);
        reader->defaults[gi_elements[row].slot] = reader->row_defaults[row];
    }
}

static void close_reader(GiReader *reader) {
    gi_parser_close(reader);
    gi_crew_destroy(reader->crew);
    gi_scanner_reset(&reader->scanner);
    gi_array_free(reader->memory, &reader->tape.entries);
    gi_array_free(reader->memory, &reader->frames);
    gi_array_free(reader->memory, &reader->tags);
    gi_array_free(reader->memory, &reader->cameras);
    gi_array_free(reader->memory, &reader->doubtful);
    gi_names_reset(&reader->names);
    gi_names_reset(&reader->strings);
    gi_files_reset(&reader->files, reader->memory);
    gi_report_reset(&reader->report);
    if (reader->source->mapped == NULL) gi_window_reset(&reader->window);
}

GlintStatus gi_reader_load(
    GiScene *scene, const GiReaderSource *source, GiReaderResult *result, GlintError *error) {
    Feed feed = {.source = source};
    GiReader *reader = gi_memory_allocate(scene->memory, sizeof *reader);
    if (reader == NULL) return gi_error_memory(error);
    open_reader(reader, scene, source);
    bool noted = gi_scene_add_file(scene, GLINT_FILE_SCENE, source->name, source->name) != NULL;
    bool open = noted && (!source->expat_only || gi_parser_open(reader));
    GlintStatus status = open ? parse(reader, &feed, error) : gi_error_memory(error);
    if (status == GLINT_OK && reader->file_status != GLINT_OK) {
        status = reader->file_status == GLINT_CANCELLED ? report_cancelled(error)
                                                        : gi_error_set(error, reader->file_status,
                                                              "%s", "the system refused a thread");
    }
    GlintDialect dialect = source->dialect != GLINT_DIALECT_AUTO ? source->dialect
                           : reader->dialect != GLINT_DIALECT_AUTO
                               ? reader->dialect
                               : gi_dialect_detect(reader->evidence);
    if (status == GLINT_OK && !reader->out_of_memory) gi_object_check_groups(reader, dialect);
    if (status == GLINT_OK && (reader->out_of_memory || reader->report.out_of_memory)) {
        status = gi_error_memory(error);
    }
    if (status == GLINT_OK && reader->report.error_count > 0) {
        while (!feed.ended && window_end(reader) - parsed_end(reader) < GI_WINDOW_CONTEXT &&
               status == GLINT_OK) {
            status = read_more(reader, &feed, GI_WINDOW_CONTEXT, error);
        }
        gi_report_capture(&reader->report, INT64_MAX);
        if (status == GLINT_OK) {
            gi_report_emit(
                &reader->report, source->name, source->diagnostic, source->diagnostic_user, error);
            status = GLINT_ERROR_SCENE;
        }
    }
    if (status == GLINT_OK) scene->dialect = dialect;
    if (noted) {
        scene->files.data[0].size = (uint64_t)feed.total;
        digest_window(reader);
        scene->files.data[0].digest = reader->digest;
    }
    if (result != NULL) result->byte_count = feed.total;
    if (source->sources != NULL) {
        source->sources->root = reader->report.root.offset;
        source->sources->evidence = reader->evidence;
        source->sources->guessed =
            source->dialect == GLINT_DIALECT_AUTO && reader->dialect == GLINT_DIALECT_AUTO;
        source->sources->window = reader->window;
        gi_window_init(&reader->window, reader->memory);
    }
    close_reader(reader);
    gi_memory_free(scene->memory, reader, sizeof *reader);
    return status;
}
