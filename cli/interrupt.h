/* SPDX-License-Identifier: MIT
 * Ctrl-C and SIGTERM: the first asks the program to stop cleanly, the second kills it. And what
 * happens when a file that is mapped loses its end. */
#pragma once

#include <stdbool.h>

void cli_interrupt_install(void);

/* Whether a signal has come. */
bool cli_interrupt_seen(void);

/* Dies of the signal that has come, so that the shell learns the truth. Returns when none has. */
void cli_interrupt_die(void);
