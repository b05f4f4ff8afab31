/* SPDX-License-Identifier: MIT */
#include "watch/window.h"

#include "interrupt.h"
#include "message.h"
#include "watch/control.h"
#include "watch/letters.h"
#include "watch/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of the window before the first picture is known. */
enum { FIRST_WIDTH = 720, FIRST_HEIGHT = 480, WAIT_MS = 250, LEAST_COLUMNS = 60 };

typedef struct Window {
    const CliWindowModule *module;
    void *handle;
    const char *path;
    CliControl control;
    CliFrame frame;
    uint8_t *rgb; /* of the frame */
    CliSheet sheet;
    CliWindowImage image;
    double press_x, press_y;
    char title[512];
    bool once;
} Window;

/* ---------------------------------------------------------------- showing */

/* The picture in the middle, as large as the window allows. */
static void place_picture(Window *window, int width, int height) {
    const CliFrame *frame = &window->frame;
    CliWindowImage *image = &window->image;
    cli_picture_fit(frame->full_width, frame->full_height, width, height, true, &image->shown_width,
        &image->shown_height);
    image->x = (width - image->shown_width) / 2;
    image->y = (height - image->shown_height) / 2;
    /* Single pixels are what one wants to see in a finished picture that is enlarged. */
    image->smooth = !frame->finished || image->shown_width < frame->full_width;
}

static bool convert_picture(Window *window) {
    const CliFrame *frame = &window->frame;
    size_t count = (size_t)frame->width * (size_t)frame->height;
    uint8_t *rgb = realloc(window->rgb, 3 * count);
    if (rgb == NULL) return false;
    window->rgb = rgb;
    const GlintImage image = {frame->width, frame->height, frame->pixels};
    glint_image_to_rgb8(&image, rgb);
    window->image.rgb = rgb;
    window->image.width = frame->width;
    window->image.height = frame->height;
    return true;
}

/* What there is to say about the scene, over the picture. */
static void write_findings(Window *window, int width, int height) {
    const char *text = cli_bytes_text(&window->frame.findings);
    window->image.rgba = NULL;
    if (text[0] == '\0') return;
    size_t size = 4 * (size_t)width * (size_t)height;
    uint8_t *rgba = realloc(window->sheet.rgba, size);
    if (rgba == NULL) return;
    memset(rgba, 0, size);
    window->sheet = (CliSheet){rgba, width, height};
    int scale = width / (CLI_LETTER_WIDTH * LEAST_COLUMNS);
    cli_letters_draw(&window->sheet, text, scale < 1 ? 1 : scale > 4 ? 4 : scale);
    window->image.rgba = rgba;
    window->image.sheet_width = width;
    window->image.sheet_height = height;
}

static void show(Window *window) {
    int width, height;
    window->module->measure(window->handle, &width, &height);
    if (width < 1 || height < 1) return;
    if (window->frame.pixels != NULL) {
        if (!convert_picture(window)) return;
        place_picture(window, width, height);
    }
    write_findings(window, width, height);
    window->module->show(window->handle, &window->image);
}

static void set_title(Window *window) {
    char title[512];
    cli_control_title(&window->control, &window->frame, window->path, title, sizeof title);
    if (strcmp(title, window->title) == 0) return;
    memcpy(window->title, title, sizeof title);
    window->module->set_title(window->handle, title);
}

/* ---------------------------------------------------------------- events */

static CliInput input_of(Window *window, const CliWindowEvent *event) {
    static const CliInputKind kinds[] = {
        [CLI_WINDOW_NONE] = CLI_INPUT_NONE,
        [CLI_WINDOW_CLOSE] = CLI_INPUT_QUIT,
        [CLI_WINDOW_KEY] = CLI_INPUT_KEY,
        [CLI_WINDOW_PRESS] = CLI_INPUT_PRESS,
        [CLI_WINDOW_MOVE] = CLI_INPUT_MOVE,
        [CLI_WINDOW_RELEASE] = CLI_INPUT_RELEASE,
        [CLI_WINDOW_WHEEL] = CLI_INPUT_WHEEL,
        [CLI_WINDOW_REDRAW] = CLI_INPUT_RESIZE,
    };
    const CliWindowImage *image = &window->image;
    CliInput input = {.kind = kinds[event->kind],
        .key = event->key,
        .shift = event->shift,
        .button = event->button,
        .amount = event->amount};
    if (image->shown_width > 0 && image->shown_height > 0) {
        input.x = (event->x - image->x) / image->shown_width;
        input.y = (event->y - image->y) / image->shown_height;
    }
    if (event->kind == CLI_WINDOW_PRESS) {
        window->press_x = event->x;
        window->press_y = event->y;
    }
    input.pixels = hypot(event->x - window->press_x, event->y - window->press_y);
    return input;
}

static void print_line(void *user, const char *text) {
    (void)user;
    fputs(text, stdout);
    fflush(stdout);
}

/* One round; false when it is to end. */
static bool go_on(Window *window) {
    CliWindowEvent event = {0};
    window->module->wait(window->handle, WAIT_MS, &event);
    CliInput input = input_of(window, &event);
    if (!cli_control_handle(&window->control, &input, &window->frame)) return false;
    bool news = cli_session_take(window->control.session, &window->frame);
    if (news || input.kind == CLI_INPUT_RESIZE) show(window);
    set_title(window);
    return !(window->once && (window->frame.finished || window->frame.broken));
}

/* ---------------------------------------------------------------- the whole */

/* The window appears with the first that there is to show, in its size. */
static void appear(Window *window, const CliWindowDesc *desc) {
    const CliFrame *frame = &window->frame;
    while (!cli_interrupt_seen() && frame->pixels == NULL && !frame->broken) {
        CliWindowEvent event = {0};
        window->module->wait(window->handle, WAIT_MS, &event);
        if (event.kind == CLI_WINDOW_CLOSE) return;
        cli_session_take(window->control.session, &window->frame);
    }
    int width = frame->pixels != NULL ? frame->full_width : desc->session.width;
    int height = frame->pixels != NULL ? frame->full_height : desc->session.height;
    window->module->set_size(
        window->handle, width > 0 ? width : FIRST_WIDTH, height > 0 ? height : FIRST_HEIGHT);
    set_title(window);
    show(window);
}

static void wake(void *user) {
    const Window *window = user;
    window->module->wake(window->handle);
}

static CliStatus run(Window *window, const CliWindowDesc *desc) {
    CliSessionDesc session_desc = desc->session;
    session_desc.wake = wake;
    session_desc.user = window;
    char message[256];
    CliSession *session = cli_session_create(&session_desc, message, sizeof message);
    if (session == NULL) {
        cli_message_error("%s", message);
        return CLI_MACHINE;
    }
    window->control.session = session;
    appear(window, desc);
    while (!cli_interrupt_seen() && go_on(window)) continue;
    CliStatus status = desc->once && window->frame.broken ? CLI_INPUT : CLI_OK;
    cli_session_destroy(session);
    return status;
}

CliStatus cli_window_run(const CliWindowModule *module, const CliWindowDesc *desc, bool *opened,
    char *message, size_t size) {
    Window window = {.module = module,
        .path = desc->session.path,
        .control = {.print = print_line},
        .once = desc->once};
    window.handle = module->open(desc->session.path, message, size);
    *opened = window.handle != NULL;
    if (!*opened) return CLI_OK;
    CliStatus status = run(&window, desc);
    module->close(window.handle);
    cli_frame_reset(&window.frame);
    free(window.rgb);
    free(window.sheet.rgba);
    return status;
}
