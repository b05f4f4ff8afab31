/* SPDX-License-Identifier: MIT */
#include "test.h"

extern const GiTest tests_api[];
const GiTest tests_api[] = {TEST_END};
