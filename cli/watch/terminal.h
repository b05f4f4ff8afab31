/* SPDX-License-Identifier: MIT
 * The terminal: what it can show, how large it is, which keys are pressed, and that it is left as
 * it was found, whatever ends the program. */
#pragma once

#include "watch/bytes.h"
#include "watch/control.h"

#include <termios.h>

/* How pictures are shown. */
typedef enum CliGraphics {
    CLI_GRAPHICS_AUTO, /* the terminal is asked */
    CLI_GRAPHICS_KITTY,
    CLI_GRAPHICS_SIXEL,
    CLI_GRAPHICS_BLOCKS
} CliGraphics;

typedef struct CliTerminal {
    int in, out;
    int columns, rows;           /* in cells */
    int cell_width, cell_height; /* in pixels; a guess where the terminal does not tell */
    CliGraphics graphics;        /* not AUTO once it has been asked */
    bool fine_colors;            /* 24-bit */
    bool interactive;            /* keys are read, and the whole screen is ours */
    CliBytes pending;            /* keys that have come, not yet used */
} CliTerminal;

/* Begins with standard input and output. interactive: takes the screen over. Signals that end or
 * stop the program from now on give it back first. Errors are errno's. */
bool cli_terminal_open(CliTerminal *terminal, CliGraphics graphics, bool interactive);

/* Gives the screen back. */
void cli_terminal_close(CliTerminal *terminal);

/* Asks for the size again. */
void cli_terminal_measure(CliTerminal *terminal);

/* Writes all of it; false when the terminal has gone away. */
bool cli_terminal_write(const CliTerminal *terminal, const CliBytes *bytes);

/* Ends a wait, now or the next one. From any thread. */
void cli_terminal_wake(void *unused);

/* Waits for a key, a change of size (RESIZE), a wake or a signal (NONE), the end of input (QUIT).
 */
CliInput cli_terminal_wait(CliTerminal *terminal);

/* The key at the beginning of a text of keys, and its length in bytes: 0 when it is not complete
 * yet (and more may follow). kind is NONE for what means nothing here. */
CliInput cli_terminal_key(const char *text, size_t size, bool more, size_t *length);

/* What a terminal has answered to the question for its graphics; a zero stands behind the text. */
typedef struct CliTerminalAnswer {
    bool complete; /* the last answer is there */
    bool kitty, sixel;
    int cell_width, cell_height; /* 0: not told */
} CliTerminalAnswer;
CliTerminalAnswer cli_terminal_read_answer(const char *text, size_t size);
