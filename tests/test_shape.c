/* SPDX-License-Identifier: MIT */
#include "test.h"

extern const GiTest tests_shape[];
const GiTest tests_shape[] = {TEST_END};
