/* SPDX-License-Identifier: MIT
 * What keys and the mouse do, whatever they come from. */
#pragma once

#include "watch/session.h"

/* Keys that are not a letter. */
typedef enum CliKey {
    CLI_KEY_ESCAPE = 27,
    CLI_KEY_LEFT = 0x1000,
    CLI_KEY_RIGHT,
    CLI_KEY_UP,
    CLI_KEY_DOWN
} CliKey;

typedef enum CliInputKind {
    CLI_INPUT_NONE,
    CLI_INPUT_QUIT,
    CLI_INPUT_KEY,
    CLI_INPUT_PRESS, /* of a mouse button */
    CLI_INPUT_MOVE,
    CLI_INPUT_RELEASE,
    CLI_INPUT_WHEEL,
    CLI_INPUT_RESIZE /* what is shown has to be shown anew */
} CliInputKind;

typedef struct CliInput {
    CliInputKind kind;
    int key; /* an ASCII character, or a CliKey */
    bool shift;
    int button;    /* 1 left, 2 middle, 3 right */
    double x, y;   /* of the mouse: parts of the picture, from its top left */
    double pixels; /* of a move: how far from the press, in pixels of the screen */
    double amount; /* of the wheel: steps away from the user, toward the scene */
} CliInput;

typedef struct CliControl {
    CliSession *session;
    /* Where lines about a clicked pixel go. */
    void (*print)(void *user, const char *text);
    void *user;
    char message[512]; /* of the last key that had something to say; "" for none */
    int view;

    /* private */
    GlintCameraDesc camera, drag_camera;
    double distance, drag_distance;
    int button; /* that is down; 0: none */
    bool dragged;
    double press_x, press_y;
} CliControl;

/* Acts on an input. frame: what is shown. False: the user wants to quit. */
bool cli_control_handle(CliControl *control, const CliInput *input, const CliFrame *frame);

/* What stands in the title or below the picture: name, size, samples, time, view. */
void cli_control_title(
    const CliControl *control, const CliFrame *frame, const char *path, char *text, size_t size);

/* The keys, in one line. */
extern const char cli_control_help[];
