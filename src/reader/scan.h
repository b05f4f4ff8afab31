/* SPDX-License-Identifier: MIT
 * A scanner for the plain part of XML that large scenes are made of: elements, attributes, text and
 * comments. It takes a quarter of expat's time and knows nothing of errors: what it does not take
 * for certainly well-formed, it leaves, and expat goes on from there. */
#pragma once

#include "base/array.h"
#include "reader/pattern.h"
#include "reader/span.h"

/* What a stretch of the file says. */
typedef struct GiTape {
    int64_t begin; /* the stretch's offset in the file */
    GI_ARRAY(GiTapeEntry) entries;
    GiPattern patterns[GI_PATTERN_LIMIT];
    int pattern_count;
} GiTape;

typedef enum GiScanStatus {
    GI_SCAN_MORE,    /* the rest is not whole yet, or nothing is left */
    GI_SCAN_STRANGE, /* the rest is for expat */
    GI_SCAN_MEMORY
} GiScanStatus;

typedef struct GiScanner {
    GiMemory *memory;
    int64_t next;              /* offset of what is not scanned */
    GI_ARRAY(char) open;       /* the tags of the open elements, without attributes: <a><b> */
    GI_ARRAY(uint32_t) starts; /* of these tags */
    bool begun;                /* the root element was seen */
    bool inside;               /* it began somewhere in the root element, before a start tag */
    GI_ARRAY(GiSpan) closed;   /* then: names of the elements that were open there and are closed */
    uint8_t classes[256];      /* what each byte may be */
} GiScanner;

void gi_scanner_init(GiScanner *scanner, GiMemory *memory);
void gi_scanner_reset(GiScanner *scanner);

/* Begins anew at an offset somewhere in the root element, where a start tag seems to stand. */
void gi_scanner_begin_inside(GiScanner *scanner, int64_t offset);

/* Scans the bytes at scanner->next, as far as they are whole tokens that begin among the first
 * `part` of them, and writes the tape anew. bytes[size] is readable and zero. */
GiScanStatus gi_scan(GiScanner *scanner, const char *bytes, size_t size, size_t part, GiTape *tape);

/* Goes on where one has got that began inside, at this one's next token. False, and nothing has
 * happened, when the two do not fit together or memory is short. */
bool gi_scanner_join(GiScanner *scanner, const GiScanner *next);

/* Whether the root element is closed. */
static inline bool gi_scanner_is_complete(const GiScanner *scanner) {
    return scanner->begun && scanner->starts.count == 0;
}
