/* SPDX-License-Identifier: MIT
 * What a key can show of a scene besides its picture. */
#pragma once

#include "glint/glint.h"

/* The name of a view, "picture" first; null at an index >= the number of them. */
const char *cli_view_name(int view);

/* Draws a view into pixels (width * height * 3 of desc, which must say both), as linear colours.
 * The outputs of *desc are the view's. */
GlintStatus cli_view_render(
    GlintScene *scene, GlintRenderDesc *desc, int view, float *pixels, GlintError *error);
