/* SPDX-License-Identifier: MIT
 * What the public functions for pictures ask, for those who write a picture while it is drawn. */
#pragma once

#include "glint/glint.h"

/* Errors: ARGUMENT. */
GlintStatus gi_image_check_desc(const GlintSaveDesc *desc, GlintError *error);

/* By its extension. */
bool gi_image_is_png(const char *path);
