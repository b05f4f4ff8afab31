/* SPDX-License-Identifier: MIT
 * Scanning on several threads. A chunk of the file is cut into pieces where start tags seem to
 * begin; all are scanned at the same time, while the caller builds from the chunk before, and then
 * helps. Where a piece begins is a guess, which is right where the scanner of the piece before it
 * ends there as well; the elements open there are not known to its scanner, which therefore only
 * notes what it closes of them. Afterwards the pieces are joined, in order. From the first that
 * does not fit, or in which anything is strange, the chunk is scanned again, by the one scanner
 * that knows all: so what comes out is what that scanner alone would have found. */
#pragma once

#include "reader/scan.h"
#include "reader/window.h"
#include "sched/pool.h"

enum { GI_PIECE_LIMIT = 32 };

typedef struct GiReel {
    GiTape tapes[GI_PIECE_LIMIT]; /* of the pieces of a chunk, in the order of the file */
    int count;
} GiReel;

typedef struct GiCrew {
    GiMemory *memory;
    GiPool *pool;
    GiReel reels[2];
    GiReel *scanned;                    /* waits to be played */
    GiReel *empty;                      /* for the next chunk */
    GiScanner scanners[GI_PIECE_LIMIT]; /* those of all pieces but the first */
    GiScanStatus statuses[GI_PIECE_LIMIT];
    size_t begins[GI_PIECE_LIMIT + 1]; /* of the pieces in the window, and the end of the last */
    int piece_count;
} GiCrew;

/* Null where there are no threads to be had. */
GiCrew *gi_crew_create(GiMemory *memory, int thread_count);
void gi_crew_destroy(GiCrew *crew); /* null is allowed */

/* Something else that is done meanwhile, by any thread. */
typedef void (*GiCrewTask)(void *context);

/* Scans, from scanner->next to the end of the window, while `play` is called on this thread and
 * `task` on any; then what was scanned is crew->scanned. The window's bytes up to `size` may be
 * looked at, and a zero is behind them. */
GiScanStatus gi_crew_scan(GiCrew *crew, GiScanner *scanner, const GiWindow *window, size_t size,
    GiCrewTask play, GiCrewTask task, void *context);
