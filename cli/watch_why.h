/* SPDX-License-Identifier: MIT
 * What `glint why` has to say in short about a pixel that was clicked in `glint watch`. */
#pragma once

#include "watch/bytes.h"

/* Appends it. desc: how the picture was drawn, with its size. The scene is not drawn meanwhile. A
 * CliExplainFn. */
void cli_watch_explain(
    GlintScene *scene, const GlintRenderDesc *desc, const char *name, int x, int y, CliBytes *text);
