/* SPDX-License-Identifier: MIT
 * Where one ray meets a shape: hit_template.h over plain doubles. This is the definition that every
 * kernel must agree with, bit for bit. */
#pragma once

#include "shape/shape.h"

#define R                  double
#define M                  int
#define GI_HIT(name)       gi_hit_##name
#define R_OF(x)            (x)
#define R_SQRT(a)          sqrt(a)
#define R_MIN(a, b)        gi_hit_minimum(a, b)
#define R_MAX(a, b)        gi_hit_maximum(a, b)
#define R_LESS(a, b)       ((a) < (b))
#define R_LESS_EQUAL(a, b) ((a) <= (b))
#define R_EQUAL(a, b)      ((a) == (b))
#define R_SELECT(m, a, b)  ((m) ? (a) : (b))
#define M_OF(x)            ((int)(x))
#define M_NOT(m)           (!(m))

static inline double gi_hit_minimum(double a, double b) { return a < b ? a : b; }
static inline double gi_hit_maximum(double a, double b) { return a > b ? a : b; }

#include "shape/hit_template.h"

#undef R
#undef M
#undef GI_HIT
#undef R_OF
#undef R_SQRT
#undef R_MIN
#undef R_MAX
#undef R_LESS
#undef R_LESS_EQUAL
#undef R_EQUAL
#undef R_SELECT
#undef M_OF
#undef M_NOT
