/* SPDX-License-Identifier: MIT
 * glint watch: a scene in a window or in the terminal, drawn again whenever it is saved. Here are
 * the options, and the choice between the two; the rest is in cli/watch. */
#define _POSIX_C_SOURCE 200809L
#include "inputs.h"
#include "message.h"
#include "value.h"
#include "verb.h"
#include "watch/screen.h"
#include "watch/window.h"
#include "watch_why.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef enum Front { FRONT_AUTO, FRONT_WINDOW, FRONT_TERMINAL } Front;

typedef struct Options {
    CliSessionDesc session;
    Front front;
    CliGraphics graphics;
    bool once;
} Options;

/* ---------------------------------------------------------------- options */

static CliStatus set_window(void *values, const char *value) {
    Options *options = values;
    (void)value;
    options->front = FRONT_WINDOW;
    return CLI_OK;
}

static const char *graphics_name_at(int index) {
    /* In the order of CliGraphics. */
    static const char *const names[] = {"auto", "kitty", "sixel", "blocks", NULL};
    return names[index];
}

static CliStatus set_terminal(void *values, const char *value) {
    Options *options = values;
    int index = 0;
    CliStatus status =
        value == NULL ? CLI_OK : cli_value_name("terminal", value, graphics_name_at, &index);
    options->front = FRONT_TERMINAL;
    options->graphics = (CliGraphics)index;
    return status;
}

static CliStatus set_once(void *values, const char *value) {
    Options *options = values;
    (void)value;
    options->once = true;
    return CLI_OK;
}

static CliStatus set_size(void *values, const char *value) {
    CliSessionDesc *session = &((Options *)values)->session;
    return cli_value_size("size", value, &session->width, &session->height);
}

static CliStatus set_samples(void *values, const char *value) {
    enum { SAMPLES_LIMIT = 65536 };
    Options *options = values;
    return cli_value_number("samples", value, 1, SAMPLES_LIMIT, &options->session.samples);
}

static CliStatus set_dialect(void *values, const char *value) {
    Options *options = values;
    return cli_value_dialect(value, &options->session.dialect);
}

static CliStatus set_threads(void *values, const char *value) {
    Options *options = values;
    return cli_value_threads(value, &options->session.thread_count);
}

static const char picture[] = "The picture", shown[] = "Where it is shown",
                  machine[] = "The machine";

static const CliOption option_table[] = {
    {0, "window", NULL, CLI_FORM_NONE, shown, "in a window", set_window},
    {0, "terminal", "auto|kitty|sixel|blocks", CLI_FORM_HIDDEN, shown,
        "in the terminal (=auto, =kitty, =sixel or =blocks)", set_terminal},
    {0, "once", NULL, CLI_FORM_NONE, shown, "show one finished picture and end", set_once},
    {0, "size", "WxH", CLI_FORM_REQUIRED, picture, "draw W x H pixels, whatever the scene says",
        set_size},
    {0, "samples", "N", CLI_FORM_REQUIRED, picture,
        "draw N samples a pixel, whatever the scene says", set_samples},
    {0, "dialect", "NAME", CLI_FORM_REQUIRED, picture, "follow the rules of a year (see below)",
        set_dialect},
    {'t', "threads", "N", CLI_FORM_REQUIRED, machine, "draw with N threads (default: one a core)",
        set_threads},
};

/* ---------------------------------------------------------------- where */

static bool is_set(const char *name) {
    const char *value = getenv(name);
    return value != NULL && value[0] != '\0';
}

static bool has_display(void) { return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"); }

static bool has_terminal(const Options *options) {
    return isatty(STDOUT_FILENO) && (options->once || isatty(STDIN_FILENO));
}

/* In a window; *shown_there is false, with the reason in message, when there is none. */
static CliStatus run_window(
    const Options *options, bool *shown_there, char *message, size_t message_size) {
    const CliWindowModule *module = cli_window_find_module(message, message_size);
    *shown_there = false;
    if (module == NULL) return CLI_OK;
    CliWindowDesc desc = {.session = options->session, .once = options->once};
    return cli_window_run(module, &desc, shown_there, message, message_size);
}

static CliStatus run_terminal(const Options *options) {
    CliScreenDesc desc = {
        .session = options->session, .graphics = options->graphics, .once = options->once};
    return cli_screen_run(&desc);
}

static CliStatus show(const Options *options) {
    char message[512] = "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)";
    bool opened = false;
    if (options->front == FRONT_WINDOW || (options->front == FRONT_AUTO && has_display())) {
        CliStatus status = run_window(options, &opened, message, sizeof message);
        if (opened) return status;
        if (options->front == FRONT_WINDOW) {
            cli_message_error("%s; `glint watch --terminal` needs no window", message);
            return CLI_MACHINE;
        }
    }
    if (options->front == FRONT_TERMINAL && options->once) return run_terminal(options);
    if (has_terminal(options)) return run_terminal(options);
    if (options->front == FRONT_TERMINAL) {
        cli_message_error("--terminal needs a terminal as standard input and output");
        return CLI_USAGE;
    }
    cli_message_error(
        "there is nothing to show a picture in: %s, and standard input and output are "
        "no terminal; `glint render` writes pictures to files",
        message);
    return CLI_USAGE;
}

static CliStatus run(void *values, const CliOperands *operands) {
    Options *options = values;
    if (operands->count != 1) {
        return cli_message_usage(operands->count == 0 ? "which scene? glint watch SCENE"
                                                      : "glint watch takes one scene");
    }
    const char *path = operands->items[0];
    if (strcmp(path, "-") == 0) {
        return cli_message_usage("standard input cannot be watched; name a scene file");
    }
    if (access(path, R_OK) != 0) {
        cli_message_error("%s: %s", path, strerror(errno));
        return CLI_INPUT;
    }
    options->session.path = path;
    return show(options);
}

static Options defaults = {
    .session = {.dialect = GLINT_DIALECT_AUTO, .explain = cli_watch_explain}};

const CliVerb cli_verb_watch = {.name = "watch",
    .operands = "SCENE",
    .summary = "show a scene, and again whenever it is saved",
    .about = "Shows a scene in a window, or in the terminal where there is no display, and\n"
             "draws it again whenever the scene or a file that it names is saved. Errors\n"
             "are shown with the last good picture.",
    .notes = "Drag to turn, with Shift to move; the wheel zooms; a click tells about a pixel.\n"
             "Keys: arrows turn, Shift+arrows move, + and - zoom, s writes the camera into\n"
             "the scene file, r resets it, v and 1 to 9 choose a view, h helps, q quits.",
    .example_text = "see a scene change while you write it",
    .example = "glint watch scenes/solids.xml",
    .options = option_table,
    .option_count = CLI_COUNT(option_table),
    .values = &defaults,
    .run = run};
