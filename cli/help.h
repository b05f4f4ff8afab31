/* SPDX-License-Identifier: MIT
 * The help, as it appears on a screen, in the manual and in the documentation. */
#pragma once

#include "options.h"

/* Prints to standard output. */
void cli_help_print(CliHelpFormat format);
