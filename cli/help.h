/* SPDX-License-Identifier: MIT
 * Help on the screen, as a manual page, and as a table for the documentation. */
#pragma once

#include "arguments.h"

/* Answers what was asked for, about the verb or, when none was named, the whole program. */
void cli_help_print(const CliArguments *arguments);
