/* SPDX-License-Identifier: MIT
 * The part of the file that is in memory: what expat has not finished with, and some kilobytes
 * before it. While parsing, places are byte offsets; they become lines and columns only for a
 * message, or when their bytes are about to leave the window. */
#pragma once

#include "base/memory.h"

typedef struct GiPlace {
    int64_t offset;       /* of the byte, in the file */
    int64_t line, column; /* from 1, in characters; line 0: not counted yet */
} GiPlace;

typedef enum GiEncoding {
    GI_ENCODING_UTF8,
    GI_ENCODING_LATIN1,
    GI_ENCODING_UTF16_LE,
    GI_ENCODING_UTF16_BE
} GiEncoding;

typedef struct GiWindow {
    GiMemory *memory;
    unsigned char *data;
    size_t size, capacity;
    int64_t base;   /* offset of data[0] */
    GiPlace start;  /* the place of data[0] */
    GiPlace cursor; /* the last place counted: the next is normally a little further on */
    GiEncoding encoding;
} GiWindow;

/* How much is kept before the point up to which everything is parsed, and how far round a place a
 * message may look. GI_WINDOW_KEEP is at least twice GI_WINDOW_CONTEXT. */
enum { GI_WINDOW_KEEP = 4096, GI_WINDOW_CONTEXT = 1024 };

void gi_window_init(GiWindow *window, GiMemory *memory);
void gi_window_reset(GiWindow *window);

/* Room for `more` bytes after data[size]. False when memory is short. */
bool gi_window_reserve(GiWindow *window, size_t more);

/* Tells the encoding from the first bytes; to be called when at least four (or all) are there. */
void gi_window_detect(GiWindow *window);

/* Lets go of what is before offset (less a little, to stay on a character). */
void gi_window_discard(GiWindow *window, int64_t offset);

static inline bool gi_window_holds(const GiWindow *window, int64_t offset) {
    return offset >= window->base && offset <= window->base + (int64_t)window->size;
}

/* Brings a place whose line and column are known to an offset behind it; both in the window. Only
 * looks at the bytes, so that another thread may do it. */
void gi_window_advance(const GiWindow *window, GiPlace *place, int64_t offset);

/* Counts line and column of a place unless they are known or its bytes are gone. */
void gi_window_locate(GiWindow *window, GiPlace *place);

/* Bytes of a character unit: 2 in UTF-16, else 1. */
int gi_window_unit(const GiWindow *window);

/* The unit at an offset; above 0xffff (GI_WINDOW_END) outside of the window. */
#define GI_WINDOW_END 0x10000u
unsigned gi_window_at(const GiWindow *window, int64_t offset);

/* How many bytes of the file a piece of UTF-8 text took that expat handed out unchanged. */
int64_t gi_window_span(const GiWindow *window, const char *text, size_t size);

/* Copies the text of the file from offset on, up to `count` characters or the end of the line, as
 * clean UTF-8: control characters become '?'. Returns the number of characters. */
int gi_window_copy(const GiWindow *window, int64_t offset, int count, char *buffer, size_t size);

/* The line round a place, cut to about 120 characters, with "..." where it is cut; *caret is
 * where the place is in it, in characters. */
enum { GI_EXCERPT_SIZE = 132 * 4 };
void gi_window_excerpt(
    const GiWindow *window, int64_t offset, char buffer[GI_EXCERPT_SIZE], int *caret);
