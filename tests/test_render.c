/* SPDX-License-Identifier: MIT */
#include "test.h"

extern const GiTest tests_render[];
const GiTest tests_render[] = {TEST_END};
