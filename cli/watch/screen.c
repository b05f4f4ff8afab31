/* SPDX-License-Identifier: MIT */
#include "watch/screen.h"

#include "interrupt.h"
#include "message.h"
#include "watch/encode.h"
#include "watch/picture.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is sent between these appears at once, where the terminal knows how. */
#define BEGIN_UPDATE "\033[?2026h"
#define END_UPDATE   "\033[?2026l"

#define RED   "\033[1;31m"
#define GREEN "\033[1;32m"
#define DIM   "\033[2m"
#define PLAIN "\033[0m"

typedef struct Screen {
    CliTerminal terminal;
    CliControl control;
    CliFrame frame;
    const char *path;
    CliLayout layout; /* as drawn */
    CliBytes out;
    bool gone; /* the terminal cannot be written to any more */
} Screen;

/* ---------------------------------------------------------------- layout */

static int count_lines(const char *text) {
    int lines = 0;
    for (; *text != '\0'; text++) {
        if (*text == '\n' || text[1] == '\0') lines++;
    }
    return lines;
}

CliLayout cli_screen_layout(const CliTerminal *terminal, const CliFrame *frame) {
    CliLayout layout = {.status_row = terminal->rows - 1};
    int lines = count_lines(cli_bytes_text(&frame->findings));
    int room = terminal->rows - 1;
    layout.findings_rows = lines < room / 2 || frame->pixels == NULL ? lines : room / 2;
    if (layout.findings_rows > room) layout.findings_rows = room;
    layout.findings_row = layout.status_row - layout.findings_rows;
    if (frame->pixels == NULL || layout.findings_row < 1) return layout;
    bool blocks = terminal->graphics == CLI_GRAPHICS_BLOCKS;
    int most_width = terminal->columns * (blocks ? 1 : terminal->cell_width);
    int most_height = layout.findings_row * (blocks ? 2 : terminal->cell_height);
    cli_picture_fit(frame->full_width, frame->full_height, most_width, most_height, false,
        &layout.width, &layout.height);
    return layout;
}

/* ---------------------------------------------------------------- the picture */

static bool add_bytes(void *user, const void *bytes, size_t size) {
    CliBytes *png = user;
    cli_bytes_add(png, bytes, size);
    return !png->failed;
}

static bool encode_kitty(const GlintImage *image, bool stay, CliBytes *out) {
    CliBytes png = {0};
    GlintSaveDesc desc = glint_save_desc_default();
    bool good = glint_image_encode_png(image, &desc, add_bytes, &png, NULL) == GLINT_OK;
    if (good) cli_encode_kitty(out, &png, stay);
    cli_bytes_reset(&png);
    return good;
}

/* A picture of 8-bit values; blocks need an even number of rows, the last of which may be black. */
static bool encode_bytes(const CliTerminal *terminal, const GlintImage *image, CliBytes *out) {
    size_t row = 3 * (size_t)image->width;
    uint8_t *rgb = calloc((size_t)image->height + 1, row);
    if (rgb == NULL) return false;
    glint_image_to_rgb8(image, rgb);
    if (terminal->graphics == CLI_GRAPHICS_SIXEL) {
        cli_encode_sixel(out, rgb, image->width, image->height);
    } else {
        cli_encode_blocks(out, rgb, image->width, (image->height + 1) / 2, terminal->fine_colors);
    }
    free(rgb);
    return true;
}

bool cli_screen_encode(
    const CliTerminal *terminal, const CliFrame *frame, int width, int height, CliBytes *out) {
    float *pixels = malloc(3 * (size_t)width * (size_t)height * sizeof *pixels);
    if (pixels == NULL) return false;
    cli_picture_resize(frame->pixels, frame->width, frame->height, pixels, width, height);
    const GlintImage image = {width, height, pixels};
    bool good = terminal->graphics == CLI_GRAPHICS_KITTY
                    ? encode_kitty(&image, terminal->interactive, out)
                    : encode_bytes(terminal, &image, out);
    free(pixels);
    return good && !out->failed;
}

/* ---------------------------------------------------------------- text */

const char *cli_screen_line(const char *text, int columns, CliBytes *out) {
    for (int used = 0; *text != '\0' && *text != '\n';) {
        int size = 1;
        while (((unsigned char)text[size] & 0xc0) == 0x80) size++;
        unsigned char first = (unsigned char)*text;
        bool control = first < 0x20 || first == 0x7f ||
                       (first == 0xc2 && size == 2 && (unsigned char)text[1] < 0xa0);
        if (used++ < columns) {
            cli_bytes_add(
                out, control ? first == '\t' ? " " : "?" : text, control ? 1 : (size_t)size);
        }
        text += size;
    }
    return *text == '\n' ? text + 1 : text;
}

static bool is_caret_line(const char *text) {
    size_t blank = strspn(text, " \t");
    return text[blank] == '^' || text[blank] == '~';
}

static void add_findings(Screen *screen, const CliLayout *layout) {
    const char *text = cli_bytes_text(&screen->frame.findings);
    for (int row = 0; row < layout->findings_rows; row++) {
        cli_bytes_format(&screen->out, "\033[%d;1H", layout->findings_row + row + 1);
        if (is_caret_line(text)) {
            cli_bytes_add_text(&screen->out, GREEN);
        } else if (text[0] != ' ') {
            cli_bytes_add_text(&screen->out, RED);
        }
        text = cli_screen_line(text, screen->terminal.columns, &screen->out);
        cli_bytes_add_text(&screen->out, PLAIN "\033[K");
    }
}

static void add_status(Screen *screen, const CliLayout *layout) {
    char title[1024];
    cli_control_title(&screen->control, &screen->frame, screen->path, title, sizeof title);
    if (screen->control.message[0] == '\0') {
        size_t used = strlen(title);
        snprintf(title + used, sizeof title - used, "   (h: keys, q: quit)");
    }
    cli_bytes_format(&screen->out, "\033[%d;1H" DIM, layout->status_row + 1);
    cli_screen_line(title, screen->terminal.columns, &screen->out);
    cli_bytes_add_text(&screen->out, PLAIN "\033[K");
}

/* ---------------------------------------------------------------- the screen */

static const CliLayout nothing_drawn = {.status_row = -1};

static bool same_layout(const CliLayout *a, const CliLayout *b) {
    return a->width == b->width && a->height == b->height && a->findings_row == b->findings_row &&
           a->findings_rows == b->findings_rows && a->status_row == b->status_row;
}

static void send(Screen *screen) {
    if (!cli_terminal_write(&screen->terminal, &screen->out)) screen->gone = true;
    cli_bytes_clear(&screen->out);
}

static void show(Screen *screen, bool with_picture) {
    CliLayout layout = cli_screen_layout(&screen->terminal, &screen->frame);
    bool moved = !same_layout(&layout, &screen->layout);
    screen->layout = layout;
    cli_bytes_add_text(&screen->out, BEGIN_UPDATE);
    if (moved && screen->terminal.graphics == CLI_GRAPHICS_KITTY) {
        cli_bytes_add_text(&screen->out, cli_encode_kitty_remove);
    }
    if (moved) cli_bytes_add_text(&screen->out, "\033[2J");
    if (layout.width > 0 && (moved || with_picture)) {
        cli_bytes_add_text(&screen->out, "\033[H");
        cli_screen_encode(
            &screen->terminal, &screen->frame, layout.width, layout.height, &screen->out);
    }
    add_findings(screen, &layout);
    add_status(screen, &layout);
    cli_bytes_add_text(&screen->out, END_UPDATE);
    send(screen);
}

/* One round; false when it is to end. */
static bool go_on(Screen *screen) {
    CliInput input = cli_terminal_wait(&screen->terminal);
    if (!cli_control_handle(&screen->control, &input, &screen->frame)) return false;
    if (input.kind == CLI_INPUT_RESIZE) {
        cli_terminal_measure(&screen->terminal);
        screen->layout = nothing_drawn;
    }
    bool news = cli_session_take(screen->control.session, &screen->frame);
    if (news || input.kind == CLI_INPUT_RESIZE) {
        show(screen, true);
    } else if (input.kind == CLI_INPUT_KEY) {
        show(screen, false);
    }
    return !screen->gone;
}

/* Draws the finished picture, or says why there is none. */
static CliStatus draw_once(Screen *screen) {
    CliFrame *frame = &screen->frame;
    while (!cli_interrupt_seen() && !frame->finished && !frame->broken) {
        cli_terminal_wait(&screen->terminal);
        cli_session_take(screen->control.session, frame);
    }
    if (frame->findings.size > 0) fputs(cli_bytes_text(&frame->findings), stderr);
    if (frame->broken || !frame->finished) return frame->broken ? CLI_INPUT : CLI_OK;
    cli_bytes_clear(&frame->findings);
    CliLayout layout = cli_screen_layout(&screen->terminal, frame);
    if (layout.width < 1) return CLI_OK;
    if (!cli_screen_encode(&screen->terminal, frame, layout.width, layout.height, &screen->out)) {
        cli_message_error("%s", glint_status_text(GLINT_ERROR_MEMORY));
        return CLI_MACHINE;
    }
    if (screen->terminal.graphics != CLI_GRAPHICS_BLOCKS) cli_bytes_add_text(&screen->out, "\r\n");
    send(screen);
    return CLI_OK;
}

static CliStatus run(Screen *screen, const CliScreenDesc *desc) {
    CliSessionDesc session_desc = desc->session;
    session_desc.wake = cli_terminal_wake;
    char message[256];
    CliSession *session = cli_session_create(&session_desc, message, sizeof message);
    CliStatus status = session != NULL ? CLI_OK : CLI_MACHINE;
    screen->control.session = session;
    if (session != NULL && desc->once) {
        status = draw_once(screen);
    } else if (session != NULL) {
        show(screen, false);
        while (!cli_interrupt_seen() && go_on(screen)) continue;
    }
    /* The user has the screen back before the last thread has ended. */
    cli_terminal_close(&screen->terminal);
    if (session == NULL) cli_message_error("%s", message);
    cli_session_destroy(session);
    return status;
}

CliStatus cli_screen_run(const CliScreenDesc *desc) {
    Screen screen = {.path = desc->session.path, .layout = nothing_drawn};
    if (!cli_terminal_open(&screen.terminal, desc->graphics, !desc->once)) {
        cli_message_error("the terminal cannot be used: %s", strerror(errno));
        return CLI_MACHINE;
    }
    CliStatus status = run(&screen, desc);
    cli_frame_reset(&screen.frame);
    cli_bytes_reset(&screen.out);
    return status;
}
