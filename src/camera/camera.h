/* SPDX-License-Identifier: MIT
 * From a scene's camera to a view. */
#pragma once

#include "math/view.h"
#include "scene/scene.h"

GiView gi_view_of(const GiCamera *camera);

/* The same of a program with these mistakes, for a picture of so many pixels. */
GiView gi_view_spoiled(
    const GiCamera *camera, const GlintMistakes *mistakes, int width, int height);
