/* SPDX-License-Identifier: MIT
 * What a module that shows a window exports, under the name CLI_WINDOW_SYMBOL. It knows the
 * system's windows and nothing of scenes; the program knows nothing of its library. All calls come
 * from one thread, but wake. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CLI_WINDOW_SYMBOL  "glint_window"
#define CLI_WINDOW_VERSION 1 /* of this header; a module of another is refused */

typedef enum CliWindowEventKind {
    CLI_WINDOW_NONE, /* woken, or the time is up */
    CLI_WINDOW_CLOSE,
    CLI_WINDOW_KEY,
    CLI_WINDOW_PRESS,
    CLI_WINDOW_MOVE,
    CLI_WINDOW_RELEASE,
    CLI_WINDOW_WHEEL,
    CLI_WINDOW_REDRAW /* the size has changed, or what was shown is lost */
} CliWindowEventKind;

typedef enum CliWindowArrow {
    CLI_WINDOW_LEFT = 0x1000, /* the values of CliKey */
    CLI_WINDOW_RIGHT,
    CLI_WINDOW_UP,
    CLI_WINDOW_DOWN
} CliWindowArrow;

typedef struct CliWindowEvent {
    CliWindowEventKind kind;
    int key; /* the character that was typed (ASCII), 27 for Escape, or a CliWindowArrow */
    bool shift;
    int button;    /* 1 left, 2 middle, 3 right */
    double x, y;   /* of the mouse, in pixels of the inside */
    double amount; /* of the wheel, away from the user */
} CliWindowEvent;

/* What to show: an opaque picture, stretched over a part of the window, and a sheet of the window's
 * own size over it. */
typedef struct CliWindowImage {
    const uint8_t *rgb; /* null: no picture */
    int width, height;
    int x, y, shown_width, shown_height; /* where in the window */
    bool smooth;                         /* blend neighbouring pixels when stretched */
    const uint8_t *rgba;                 /* null: no sheet */
    int sheet_width, sheet_height;       /* at the top left */
} CliWindowImage;

typedef struct CliWindowModule {
    int version;
    /* Prepares a window, which is not seen yet. Null, with a sentence in message, when there is no
     * screen. */
    void *(*open)(const char *title, char *message, size_t size);
    void (*close)(void *window);
    /* Gives the inside this many pixels, or fewer where the screen has less room, and shows it. */
    void (*set_size)(void *window, int width, int height);
    /* Pixels of the inside. */
    void (*measure)(void *window, int *width, int *height);
    void (*set_title)(void *window, const char *title);
    bool (*show)(void *window, const CliWindowImage *image);
    /* Waits at most so many milliseconds for the next event. */
    void (*wait)(void *window, int milliseconds, CliWindowEvent *event);
    /* Ends a wait, now or the next one. From any thread. */
    void (*wake)(void *window);
} CliWindowModule;
