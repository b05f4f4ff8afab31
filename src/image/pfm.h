/* SPDX-License-Identifier: MIT
 * PFM: linear float RGB as it is, little-endian, bottom row first. */
#pragma once

#include "base/memory.h"

/* Hands the file's bytes for image, which has been checked, to sink. monitor may be null. Errors:
 * FILE (the sink stopped), MEMORY, CANCELLED. */
GlintStatus gi_pfm_encode(GiMemory *memory, const GlintImage *image, const GlintMonitor *monitor,
    GlintSinkFn sink, void *user, GlintError *error);
