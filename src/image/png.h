/* SPDX-License-Identifier: MIT
 * PNG: 8-bit RGB, gamma 2.2. A picture that is there is encoded by one call; one that is being made
 * is encoded meanwhile. Either way the bytes depend on the pixels and the extras alone. */
#pragma once

#include "base/memory.h"
#include "image/png_extra.h"
#include "math/gamma.h"

/* Encodes image, which has been checked, and hands the bytes to sink in order. monitor may
 * be null; thread_count 0 is one per core. Errors: FILE (the sink stopped), MEMORY,
 * CANCELLED. */
GlintStatus gi_png_encode(GiMemory *memory, const GlintImage *image, const GiPngExtras *extras,
    int thread_count, const GlintMonitor *monitor, GlintSinkFn sink, void *user, GlintError *error);

/* ---------------------------------------------------------------- while it is being made */

typedef struct GiPng GiPng;

typedef struct GiPngDesc {
    int width, height, worker_count;
    GiGammaFn gamma;    /* null: gi_gamma_encode; or another that gives the same */
    GiPngExtras extras; /* what they point at must live as long as the picture is made */
    GlintSinkFn sink;   /* called by those functions that send, on their thread */
    void *user;
} GiPngDesc;

/* Sends the head. Errors: FILE, MEMORY. */
GlintStatus gi_png_create(GiMemory *memory, const GiPngDesc *desc, GiPng **png, GlintError *error);
void gi_png_destroy(GiPng *png); /* null is allowed */

/* Count linear pixels of row y from column x on: in any order, any number of threads at a time,
 * each pixel once. False: there is no memory for them; the picture is lost. */
bool gi_png_put(GiPng *png, int x, int y, int count, const float *linear);

/* Tells that count pixels of each of the rows y to y + rows - 1 were put, by this worker, a number
 * below worker_count that no other thread has. Encodes what is then whole. False: as above. */
bool gi_png_account(GiPng *png, int y, int rows, int count, int worker);

/* Sends what is ready. One thread at a time, also while others put pixels. False: the sink has
 * stopped. */
bool gi_png_send(GiPng *png);

/* Sends the rest, when all pixels are there. Errors: FILE (the sink stopped), MEMORY. */
GlintStatus gi_png_finish(GiPng *png, GlintError *error);
