/* SPDX-License-Identifier: MIT
 * One rectangle of the picture, drawn by one worker in stages: camera rays to hits, hits and lights
 * to shadow rays, shadow rays to light. A stage works on all the tile's pixels before the next
 * begins, so that rays meet the kernels in numbers. */
#pragma once

#include "render/render.h"

enum { GI_TILE_SIDE_LIMIT = 128 };

typedef struct GiTileSize {
    int width, height;
} GiTileSize;

typedef struct GiTileScratch GiTileScratch;

GiTileScratch *gi_tile_scratch_create(
    const GiWorld *world, const GiRenderTarget *target); /* null: no memory */
void gi_tile_scratch_destroy(GiMemory *memory, GiTileScratch *scratch);

/* Whether drawing stopped because memory was short. */
bool gi_tile_out_of_memory(const GiTileScratch *scratch);

/* How a tile learns that it is to stop: by the flag, and on the caller's thread by asking. */
typedef struct GiTileControl {
    _Atomic bool *stop;
    const GlintMonitor *monitor; /* null on the other workers */
    int worker;
} GiTileControl;

/* Draws the part of the tile with corner (x, y) and the given size that lies in the area. control
 * is asked every few hundred rays; when it says stop, or there is no memory for what was drawn, the
 * tile stays unfinished: false. */
bool gi_tile_draw(const GiWorld *world, const GiRenderArea *area, int x, int y, GiTileSize size,
    const GiRenderTarget *target, GiTileScratch *scratch, GiRenderCounts *counts,
    const GiTileControl *control);
