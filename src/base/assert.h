/* SPDX-License-Identifier: MIT
 * For mistakes of the program, never of the input. On unless NDEBUG is set. */
#pragma once

#include <assert.h>

#define GI_ASSERT(condition) assert(condition)
