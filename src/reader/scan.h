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
    uint8_t classes[256];      /* what each byte may be */
} GiScanner;

void gi_scanner_init(GiScanner *scanner, GiMemory *memory);
void gi_scanner_reset(GiScanner *scanner);

/* Scans the bytes at scanner->next, as far as they are whole tokens, and appends to the tape, which
 * is emptied before. bytes[size] is readable and zero. */
GiScanStatus gi_scan(GiScanner *scanner, const char *bytes, size_t size, GiTape *tape);

/* Whether the root element is closed. */
static inline bool gi_scanner_is_complete(const GiScanner *scanner) {
    return scanner->begun && scanner->starts.count == 0;
}
