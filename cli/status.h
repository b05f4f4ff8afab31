/* SPDX-License-Identifier: MIT
 * What the program tells the shell. Of several outcomes the largest wins, so the order matters. */
#pragma once

typedef enum CliStatus {
    CLI_OK,     /* all pictures are drawn */
    CLI_INPUT,  /* a scene is wrong, or cannot be read */
    CLI_USAGE,  /* the command line is wrong */
    CLI_MACHINE /* memory, disk or threads ran out */
} CliStatus;

static inline CliStatus cli_status_worse(CliStatus a, CliStatus b) { return a > b ? a : b; }
