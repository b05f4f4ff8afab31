/* SPDX-License-Identifier: MIT */
#include "reader/crew.h"

#include <string.h>

GiCrew *gi_crew_create(GiMemory *memory, int thread_count) {
    GiCrew *crew = gi_memory_allocate(memory, sizeof *crew);
    if (crew == NULL) return NULL;
    memset(crew, 0, sizeof *crew);
    crew->memory = memory;
    crew->scanned = &crew->reels[0];
    crew->empty = &crew->reels[1];
    for (int i = 0; i < GI_PIECE_LIMIT; i++) gi_scanner_init(&crew->scanners[i], memory);
    if (gi_pool_create(memory, thread_count, &crew->pool) == GLINT_OK) return crew;
    gi_crew_destroy(crew);
    return NULL;
}

void gi_crew_destroy(GiCrew *crew) {
    if (crew == NULL) return;
    gi_pool_destroy(crew->pool);
    for (int i = 0; i < GI_PIECE_LIMIT; i++) {
        gi_scanner_reset(&crew->scanners[i]);
        gi_array_free(crew->memory, &crew->reels[0].tapes[i].entries);
        gi_array_free(crew->memory, &crew->reels[1].tapes[i].entries);
    }
    gi_memory_free(crew->memory, crew, sizeof *crew);
}

/* ---------------------------------------------------------------- pieces */

static bool is_blank(unsigned char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/* The first start tag from `from` on that stands behind a tag, as most do; or the end. */
static size_t find_start(const unsigned char *data, size_t from, size_t end) {
    while (from + 1 < end) {
        const unsigned char *tag = memchr(data + from, '<', end - 1 - from);
        if (tag == NULL) break;
        from = (size_t)(tag - data);
        const unsigned char *before = tag;
        while (before > data && is_blank(before[-1])) before--;
        unsigned char letter = tag[1] | 0x20;
        if (before > data && before[-1] == '>' && letter >= 'a' && letter <= 'z') return from;
        from++;
    }
    return end;
}

static void cut(GiCrew *crew, const GiScanner *scanner, const GiWindow *window) {
    size_t from = (size_t)(scanner->next - window->base), all = window->size - from;
    crew->begins[0] = from;
    crew->piece_count = 1;
    while (!gi_scanner_is_complete(scanner) && crew->piece_count < GI_PIECE_LIMIT) {
        int count = crew->piece_count;
        size_t least = from + all / GI_PIECE_LIMIT * (size_t)count;
        if (least <= crew->begins[count - 1]) least = crew->begins[count - 1] + 1;
        size_t begin = find_start(window->data, least, window->size);
        if (begin == window->size) break;
        crew->begins[count] = begin;
        gi_scanner_begin_inside(&crew->scanners[count], window->base + (int64_t)begin);
        crew->piece_count++;
    }
    crew->begins[crew->piece_count] = window->size;
}

typedef struct Round {
    GiCrew *crew;
    GiScanner *scanner;
    const GiWindow *window;
    size_t size;
    GiCrewTask task;
    void *context;
} Round;

/* From where a scanner is, as far as it can get among the bytes before `end`. */
static GiScanStatus scan(const Round *round, GiScanner *scanner, size_t end, GiTape *tape) {
    const GiWindow *window = round->window;
    size_t from = (size_t)(scanner->next - window->base);
    const char *bytes = (const char *)window->data + from;
    return gi_scan(scanner, bytes, round->size - from, end - from, tape);
}

static void scan_pieces(void *context, size_t begin, size_t end, int worker) {
    const Round *round = context;
    GiCrew *crew = round->crew;
    (void)worker;
    for (size_t i = begin; i < end; i++) {
        if (i == (size_t)crew->piece_count) {
            round->task(round->context);
            continue;
        }
        GiScanner *scanner = i == 0 ? round->scanner : &crew->scanners[i];
        crew->statuses[i] = scan(round, scanner, crew->begins[i + 1], &crew->empty->tapes[i]);
    }
}

/* Joins the pieces behind the first, as far as they are good, and scans the rest again. */
static GiScanStatus join(const Round *round) {
    GiCrew *crew = round->crew;
    GiScanner *scanner = round->scanner;
    GiScanStatus status = crew->statuses[0];
    GiReel *reel = crew->empty;
    reel->count = 1;
    while (status == GI_SCAN_MORE && reel->count < crew->piece_count) {
        int i = reel->count++;
        if (scanner->next == round->window->base + (int64_t)crew->begins[i] &&
            crew->statuses[i] == GI_SCAN_MORE && gi_scanner_join(scanner, &crew->scanners[i])) {
            continue;
        }
        size_t from = (size_t)(scanner->next - round->window->base);
        if (from >= round->window->size) {
            reel->count--;
            return status;
        }
        return scan(round, scanner, round->window->size, &reel->tapes[i]);
    }
    return status;
}

GiScanStatus gi_crew_scan(GiCrew *crew, GiScanner *scanner, const GiWindow *window, size_t size,
    GiCrewTask play, GiCrewTask task, void *context) {
    Round round = {crew, scanner, window, size, task, context};
    cut(crew, scanner, window);
    gi_parallel_begin(crew->pool, (size_t)crew->piece_count + 1, 1, scan_pieces, &round);
    play(context);
    gi_parallel_end(crew->pool);
    GiScanStatus status = join(&round);
    GiReel *played = crew->scanned;
    crew->scanned = crew->empty;
    crew->empty = played;
    return status;
}
