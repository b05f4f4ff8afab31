/* SPDX-License-Identifier: MIT
 * Drawing pixels one by one with a record of what happens. */
#pragma once

#include "render/render.h"

/* The pixels of the area, each drawn as the whole picture of one pixel that it could be: a pixel
 * does not depend on what is drawn beside it. target: samples, light, sampling. Errors: MEMORY,
 * CANCELLED. */
GlintStatus gi_explain(const GiWorld *world, const GiRenderArea *area, const GlintMonitor *monitor,
    const GiRenderTarget *target, const GlintExplainSink *sink);
