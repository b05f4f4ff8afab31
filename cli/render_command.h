/* SPDX-License-Identifier: MIT
 * glint render: every scene of the command line, one after the other. */
#pragma once

#include "options.h"

CliStatus cli_render(const CliOptions *options);
