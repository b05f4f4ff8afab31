/* SPDX-License-Identifier: MIT
 * From a scene's camera to a view. */
#pragma once

#include "math/view.h"
#include "scene/scene.h"

GiView gi_view_of(const GiCamera *camera);
