/* SPDX-License-Identifier: MIT */
#include "watch/control.h"

#include "inputs.h"
#include "watch/camera.h"
#include "watch/views.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of a key press, of a drag across the whole picture, of a step of the wheel. */
static const double key_degrees = 5, drag_degrees = 180, key_pan = 0.05, zoom_step = 1.1;

enum { CLICK_PIXELS = 4 }; /* a hand that moves less meant a click */

const char cli_control_help[] =
    "arrows turn, shift+arrows move, +/- zoom, s save camera, r reset, v view, q quit";

/* The camera, and the distance about which it turns. That stays the same while the camera is
 * turned, even where something nearer comes to the middle. */
static bool get_camera(CliControl *control) {
    GlintCameraDesc camera;
    double distance;
    if (!cli_session_camera(control->session, &camera, &distance)) return false;
    bool same = control->distance > 0 && cli_camera_equal(&camera, &control->camera);
    control->camera = camera;
    if (!same) control->distance = distance;
    return true;
}

static void use_camera(CliControl *control) {
    cli_session_set_camera(control->session, &control->camera);
}

static void zoom(CliControl *control, double steps) {
    if (!get_camera(control)) return;
    double factor = pow(zoom_step, -steps);
    cli_camera_zoom(&control->camera, control->distance, factor);
    control->distance *= factor;
    use_camera(control);
}

/* ---------------------------------------------------------------- keys */

static void turn_or_move(CliControl *control, const CliInput *input) {
    if (!get_camera(control)) return;
    int right = (input->key == CLI_KEY_RIGHT) - (input->key == CLI_KEY_LEFT);
    int up = (input->key == CLI_KEY_UP) - (input->key == CLI_KEY_DOWN);
    if (input->shift) {
        cli_camera_pan(&control->camera, control->distance, -right * key_pan, up * key_pan);
    } else {
        cli_camera_orbit(
            &control->camera, control->distance, right * key_degrees, up * key_degrees);
    }
    use_camera(control);
}

static void set_view(CliControl *control, int view) {
    if (cli_view_name(view) == NULL) return;
    control->view = view;
    cli_session_set_view(control->session, view);
}

static bool press_key(CliControl *control, const CliInput *input) {
    control->message[0] = '\0';
    int key = input->key;
    switch (key) {
    case 'q':
    case CLI_KEY_ESCAPE: return false;
    case CLI_KEY_LEFT:
    case CLI_KEY_RIGHT:
    case CLI_KEY_UP:
    case CLI_KEY_DOWN: turn_or_move(control, input); break;
    case '+':
    case '=': zoom(control, 1); break;
    case '-':
    case '_': zoom(control, -1); break;
    case 'r': cli_session_reset_camera(control->session); break;
    case 's':
        cli_session_save_camera(control->session, control->message, sizeof control->message);
        break;
    case 'v':
        set_view(control, cli_view_name(control->view + 1) != NULL ? control->view + 1 : 0);
        break;
    case 'h':
    case '?': snprintf(control->message, sizeof control->message, "%s", cli_control_help); break;
    default:
        if (key >= '1' && key <= '9') set_view(control, key - '1');
    }
    return true;
}

/* ---------------------------------------------------------------- the mouse */

static void press(CliControl *control, const CliInput *input) {
    if (control->button != 0 || !get_camera(control)) return;
    control->button = input->button;
    control->dragged = false;
    control->press_x = input->x;
    control->press_y = input->y;
    control->drag_camera = control->camera;
    control->drag_distance = control->distance;
}

/* Every move starts from the camera at the press, so that no rounding adds up. */
static void drag(CliControl *control, const CliInput *input, const CliFrame *frame) {
    if (control->button == 0) return;
    if (input->pixels >= CLICK_PIXELS) control->dragged = true;
    if (!control->dragged) return;
    double right = input->x - control->press_x, down = input->y - control->press_y;
    control->camera = control->drag_camera;
    if (control->button == 1 && !input->shift) {
        /* As far for the hand up and down as across. */
        double shape = frame->full_width > 0 ? (double)frame->full_height / frame->full_width : 1;
        cli_camera_orbit(&control->camera, control->drag_distance, -right * drag_degrees,
            down * shape * drag_degrees);
    } else {
        cli_camera_pan(&control->camera, control->drag_distance, right, down);
    }
    control->distance = control->drag_distance;
    use_camera(control);
}

static void release(CliControl *control, const CliInput *input, const CliFrame *frame) {
    if (input->button != control->button) return;
    control->button = 0;
    bool inside = input->x >= 0 && input->x < 1 && input->y >= 0 && input->y < 1;
    if (control->dragged || !inside || input->button != 1 || control->print == NULL) return;
    CliBytes text = {0};
    cli_session_pick(control->session, frame, input->x, input->y, &text);
    if (text.size > 0) control->print(control->user, cli_bytes_text(&text));
    cli_bytes_reset(&text);
}

bool cli_control_handle(CliControl *control, const CliInput *input, const CliFrame *frame) {
    switch (input->kind) {
    case CLI_INPUT_QUIT: return false;
    case CLI_INPUT_KEY: return press_key(control, input);
    case CLI_INPUT_PRESS: press(control, input); break;
    case CLI_INPUT_MOVE: drag(control, input, frame); break;
    case CLI_INPUT_RELEASE: release(control, input, frame); break;
    case CLI_INPUT_WHEEL: zoom(control, input->amount); break;
    default: break;
    }
    return true;
}

/* ---------------------------------------------------------------- the title */

static void format_seconds(double seconds, char *text, size_t size) {
    if (seconds < 1) {
        snprintf(text, size, "%.0f ms", 1e3 * seconds);
    } else {
        snprintf(text, size, "%.1f s", seconds);
    }
}

void cli_control_title(
    const CliControl *control, const CliFrame *frame, const char *path, char *text, size_t size) {
    int used = snprintf(text, size, "%s", cli_path_base(path));
    if (frame->pixels != NULL && used > 0 && (size_t)used < size) {
        char seconds[32];
        format_seconds(frame->seconds, seconds, sizeof seconds);
        used += snprintf(text + used, size - (size_t)used, "  %d x %d  %d sample%s  %s%s",
            frame->full_width, frame->full_height, frame->samples, frame->samples == 1 ? "" : "s",
            seconds, frame->finished ? "" : " ...");
    }
    if (frame->view != 0 && used > 0 && (size_t)used < size) {
        used += snprintf(text + used, size - (size_t)used, "  %s", cli_view_name(frame->view));
    }
    if (frame->broken && used > 0 && (size_t)used < size) {
        used += snprintf(text + used, size - (size_t)used, "  errors");
    }
    if (control->message[0] != '\0' && used > 0 && (size_t)used < size) {
        snprintf(text + used, size - (size_t)used, "  -  %s", control->message);
    }
}
