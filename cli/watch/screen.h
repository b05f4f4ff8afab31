/* SPDX-License-Identifier: MIT
 * A scene that is being watched, shown in a terminal: the picture, what there is to say about the
 * scene beneath it, and a line at the bottom. */
#pragma once

#include "status.h"
#include "watch/session.h"
#include "watch/terminal.h"

typedef struct CliScreenDesc {
    CliSessionDesc session; /* wake and user are set here */
    CliGraphics graphics;
    bool once; /* draws the finished picture where the cursor is, and ends */
} CliScreenDesc;

CliStatus cli_screen_run(const CliScreenDesc *desc);

/* ---- what is drawn, for tests */

/* Where things stand on the screen. */
typedef struct CliLayout {
    int width, height; /* of the picture, in the pixels of the terminal's kind of graphics */
    int findings_row;  /* from 0 */
    int findings_rows; /* lines that have room */
    int status_row;    /* the last one */
} CliLayout;

CliLayout cli_screen_layout(const CliTerminal *terminal, const CliFrame *frame);

/* Appends the picture of a frame in this size. False when memory is short. */
bool cli_screen_encode(
    const CliTerminal *terminal, const CliFrame *frame, int width, int height, CliBytes *out);

/* Appends a line of text that cannot steer the terminal, cut to its width. Returns where the next
 * line begins. */
const char *cli_screen_line(const char *text, int columns, CliBytes *out);
