/* SPDX-License-Identifier: MIT
 * There is one terminal, so what a signal handler has to know about it is static. */
#define _GNU_SOURCE /* ppoll, pipe2 */
#include "watch/terminal.h"

#include "interrupt.h"
#include "watch/encode.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

/* The other screen, no cursor, no line breaks; and back. The name of the window is kept meanwhile.
 */
static const char enter_text[] = "\033[?1049h\033[?25l\033[?7l\033[2J\033[H";
static const char leave_text[] = "\033[0m\033[?7h\033[?25h\033[?1049l";

/* Whether kitty's graphics are there (of one pixel, not shown); the size of a cell; at last what
 * every terminal answers: its attributes. */
static const char question[] = "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\\033[16t\033[c";

enum {
    ANSWER_MS = 700, /* a terminal behind a slow line */
    ESCAPE_MS = 50,  /* a lone Escape is the key, with more behind it another key */
    DEFAULT_COLUMNS = 80,
    DEFAULT_ROWS = 24,
    DEFAULT_CELL_WIDTH = 8,
    DEFAULT_CELL_HEIGHT = 16
};

static struct termios saved_mode, raw_mode;
static volatile sig_atomic_t mode_changed, screen_taken, size_changed, stop_asked;
static bool shows_kitty;
static size_t kitty_remove_size;
static int screen_fd = -1, mode_fd = -1;
static int wake_pipe[2] = {-1, -1};
static sigset_t outside_mask; /* of signals, outside of our waits all of ours are blocked */

/* ---------------------------------------------------------------- taking and giving back
 * Only calls that may be made in a signal handler. */

static void put_text(const char *text, size_t size) {
    while (size > 0) {
        ssize_t written = write(screen_fd, text, size);
        if (written < 0 && errno != EINTR) return;
        if (written > 0) {
            text += written;
            size -= (size_t)written;
        }
    }
}

static void take_screen(void) {
    if (mode_fd >= 0) {
        mode_changed = 1;
        tcsetattr(mode_fd, TCSADRAIN, &raw_mode);
    }
    screen_taken = 1;
    put_text(enter_text, sizeof enter_text - 1);
}

static void give_back(void) {
    if (screen_taken && shows_kitty) put_text(cli_encode_kitty_remove, kitty_remove_size);
    if (screen_taken) put_text(leave_text, sizeof leave_text - 1);
    screen_taken = 0;
    if (mode_changed) tcsetattr(mode_fd, TCSANOW, &saved_mode);
    mode_changed = 0;
}

/* ---------------------------------------------------------------- signals */

/* What kills the program kills it still, but not before the terminal is in order. */
static void on_death(int number) {
    give_back();
    signal(number, SIG_DFL);
    raise(number);
}

static void on_resize(int number) {
    (void)number;
    size_changed = 1;
}

static void on_stop(int number) {
    (void)number;
    stop_asked = 1;
}

static const int deaths[] = {SIGHUP, SIGQUIT, SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGXCPU};

static void install(int number, void (*handler)(int)) {
    struct sigaction action = {.sa_handler = handler}, before;
    sigemptyset(&action.sa_mask);
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler == SIG_IGN) return;
    sigaction(number, &action, NULL);
}

/* They come in our waits only, so that none is missed between a question and a wait. */
static void block_own_signals(void) {
    sigset_t own;
    sigemptyset(&own);
    sigaddset(&own, SIGINT);
    sigaddset(&own, SIGTERM);
    sigaddset(&own, SIGWINCH);
    sigaddset(&own, SIGTSTP);
    pthread_sigmask(SIG_BLOCK, &own, &outside_mask);
}

static void install_all(void) {
    for (size_t i = 0; i < sizeof deaths / sizeof *deaths; i++) install(deaths[i], on_death);
    install(SIGWINCH, on_resize);
    install(SIGTSTP, on_stop);
    block_own_signals();
}

/* What was ignored still is. */
static void uninstall(int number) {
    struct sigaction now;
    if (sigaction(number, NULL, &now) == 0 && now.sa_handler != SIG_IGN) signal(number, SIG_DFL);
}

static void uninstall_all(void) {
    for (size_t i = 0; i < sizeof deaths / sizeof *deaths; i++) uninstall(deaths[i]);
    uninstall(SIGWINCH);
    uninstall(SIGTSTP);
    pthread_sigmask(SIG_SETMASK, &outside_mask, NULL);
}

/* Ctrl-Z: the shell gets its screen, and we take it again when we go on. */
static void stop_here(void) {
    stop_asked = 0;
    give_back();
    raise(SIGSTOP);
    take_screen();
    size_changed = 1;
}

/* ---------------------------------------------------------------- open, close */

static int number_from(const char *name) {
    const char *value = getenv(name);
    int number = value != NULL ? atoi(value) : 0;
    return number > 0 && number < 10000 ? number : 0;
}

static int first_positive(int a, int b, int c) { return a > 0 ? a : b > 0 ? b : c; }

void cli_terminal_measure(CliTerminal *terminal) {
    struct winsize size = {0};
    if (ioctl(terminal->out, TIOCGWINSZ, &size) != 0) memset(&size, 0, sizeof size);
    terminal->columns = first_positive(size.ws_col, number_from("COLUMNS"), DEFAULT_COLUMNS);
    terminal->rows = first_positive(size.ws_row, number_from("LINES"), DEFAULT_ROWS);
    if (size.ws_col > 0 && size.ws_row > 0 && size.ws_xpixel > 0 && size.ws_ypixel > 0) {
        terminal->cell_width = size.ws_xpixel / size.ws_col;
        terminal->cell_height = size.ws_ypixel / size.ws_row;
    }
    if (terminal->cell_width < 1) terminal->cell_width = DEFAULT_CELL_WIDTH;
    if (terminal->cell_height < 1) terminal->cell_height = DEFAULT_CELL_HEIGHT;
}

static bool has_fine_colors(void) {
    const char *colors = getenv("COLORTERM"), *name = getenv("TERM");
    if (colors != NULL &&
        (strstr(colors, "truecolor") != NULL || strstr(colors, "24bit") != NULL)) {
        return true;
    }
    return name != NULL && (strstr(name, "direct") != NULL || strstr(name, "kitty") != NULL);
}

/* Reads keys into pending until the answer is there or the time is up. */
static CliTerminalAnswer ask(CliTerminal *terminal) {
    CliTerminalAnswer answer = {0};
    CliBytes text = {0};
    put_text(question, sizeof question - 1);
    for (int left = ANSWER_MS; left > 0 && !answer.complete;) {
        struct timespec before, after;
        struct pollfd end = {terminal->in, POLLIN, 0};
        char bytes[256];
        clock_gettime(CLOCK_MONOTONIC, &before);
        if (poll(&end, 1, left) > 0) {
            ssize_t size = read(terminal->in, bytes, sizeof bytes);
            if (size <= 0) break;
            cli_bytes_add(&text, bytes, (size_t)size);
        }
        clock_gettime(CLOCK_MONOTONIC, &after);
        left -= (int)((after.tv_sec - before.tv_sec) * 1000 +
                      (after.tv_nsec - before.tv_nsec) / 1000000);
        answer = cli_terminal_read_answer(cli_bytes_text(&text), text.size);
    }
    cli_bytes_reset(&text);
    return answer;
}

static void choose_graphics(CliTerminal *terminal) {
    if (mode_fd < 0) {
        /* Nobody would answer. */
        if (terminal->graphics == CLI_GRAPHICS_AUTO) terminal->graphics = CLI_GRAPHICS_BLOCKS;
        return;
    }
    CliTerminalAnswer answer = ask(terminal);
    if (terminal->graphics == CLI_GRAPHICS_AUTO) {
        terminal->graphics = answer.kitty   ? CLI_GRAPHICS_KITTY
                             : answer.sixel ? CLI_GRAPHICS_SIXEL
                                            : CLI_GRAPHICS_BLOCKS;
    }
    if (answer.cell_width > 0 && answer.cell_height > 0) {
        terminal->cell_width = answer.cell_width;
        terminal->cell_height = answer.cell_height;
    }
}

bool cli_terminal_open(CliTerminal *terminal, CliGraphics graphics, bool interactive) {
    *terminal = (CliTerminal){.in = STDIN_FILENO,
        .out = STDOUT_FILENO,
        .graphics = graphics,
        .fine_colors = has_fine_colors(),
        .interactive = interactive};
    if (pipe2(wake_pipe, O_CLOEXEC | O_NONBLOCK) != 0) return false;
    screen_fd = terminal->out;
    bool two_way = isatty(terminal->in) && isatty(terminal->out);
    mode_fd = two_way && tcgetattr(terminal->in, &saved_mode) == 0 ? terminal->in : -1;
    if (mode_fd >= 0) {
        /* Keys at once and unseen; Ctrl-C and Ctrl-Z stay what they are. */
        raw_mode = saved_mode;
        raw_mode.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
        raw_mode.c_iflag &= ~(tcflag_t)IXON; /* no key may stop the output for good */
        raw_mode.c_cc[VMIN] = 1;
        raw_mode.c_cc[VTIME] = 0;
    }
    install_all();
    if (interactive) {
        take_screen();
    } else if (mode_fd >= 0) {
        mode_changed = 1;
        tcsetattr(mode_fd, TCSADRAIN, &raw_mode);
    }
    cli_terminal_measure(terminal);
    choose_graphics(terminal);
    kitty_remove_size = strlen(cli_encode_kitty_remove);
    shows_kitty = terminal->graphics == CLI_GRAPHICS_KITTY;
    return true;
}

void cli_terminal_close(CliTerminal *terminal) {
    give_back();
    uninstall_all();
    close(wake_pipe[0]);
    close(wake_pipe[1]);
    wake_pipe[0] = wake_pipe[1] = -1;
    cli_bytes_reset(&terminal->pending);
}

bool cli_terminal_write(const CliTerminal *terminal, const CliBytes *bytes) {
    for (size_t at = 0; at < bytes->size;) {
        ssize_t size = write(terminal->out, bytes->data + at, bytes->size - at);
        if (size < 0 && errno != EINTR) return false;
        if (size > 0) at += (size_t)size;
    }
    return true;
}

/* ---------------------------------------------------------------- answers */

/* "ESC [ 6 ; height ; width t": what it tells. */
static void read_cell_size(const char *text, CliTerminalAnswer *answer) {
    int height = 0, width = 0;
    if (sscanf(text, "\033[6;%d;%dt", &height, &width) != 2) return;
    if (height < 1 || height > 1000 || width < 1 || width > 1000) return;
    answer->cell_height = height;
    answer->cell_width = width;
}

/* "ESC [ ? 62 ; 4 ; ... c": the attributes, of which 4 is sixel. */
static void read_attributes(const char *text, CliTerminalAnswer *answer) {
    size_t size = strspn(text + 3, "0123456789;");
    if (text[3 + size] != 'c') return;
    answer->complete = true;
    for (const char *number = text + 3; number < text + 3 + size; number++) {
        char *end;
        if (strtol(number, &end, 10) == 4 && number > text + 3) answer->sixel = true;
        number = end;
    }
}

CliTerminalAnswer cli_terminal_read_answer(const char *text, size_t size) {
    CliTerminalAnswer answer = {0};
    for (size_t at = 0; at < size; at++) {
        const char *here = text + at;
        if (strncmp(here, "\033_Gi=31;OK", 10) == 0) answer.kitty = true;
        if (strncmp(here, "\033[6;", 4) == 0) read_cell_size(here, &answer);
        if (strncmp(here, "\033[?", 3) == 0) read_attributes(here, &answer);
    }
    return answer;
}

/* ---------------------------------------------------------------- keys */

static CliInput key_input(int key, bool shift) {
    return (CliInput){
        .kind = key != 0 ? CLI_INPUT_KEY : CLI_INPUT_NONE, .key = key, .shift = shift};
}

static int arrow_of(char letter) {
    switch (letter) {
    case 'A': return CLI_KEY_UP;
    case 'B': return CLI_KEY_DOWN;
    case 'C': return CLI_KEY_RIGHT;
    case 'D': return CLI_KEY_LEFT;
    default: return 0;
    }
}

/* "ESC [ 1 ; 2 A": an arrow with Shift; anything up to its last letter is passed by. */
static CliInput read_sequence(const char *text, size_t size, size_t *length) {
    for (size_t at = 2; at < size; at++) {
        char c = text[at];
        if (c < 0x40 || c > 0x7e) continue; /* numbers */
        *length = at + 1;
        /* The number behind the last semicolon is 1 and a bit for each modifier, 1 for Shift. */
        int modifiers = at > 2 && text[at - 2] == ';' ? text[at - 1] - '1' : 0;
        return key_input(arrow_of(c), (modifiers & 1) != 0);
    }
    *length = 0;
    return (CliInput){0};
}

CliInput cli_terminal_key(const char *text, size_t size, bool more, size_t *length) {
    *length = size > 0;
    if (size == 0) return (CliInput){0};
    unsigned char first = (unsigned char)text[0];
    if (first != '\033') return key_input(first < 127 && first >= 32 ? first : 0, false);
    if (size == 1) {
        *length = !more;
        return more ? (CliInput){0} : key_input(CLI_KEY_ESCAPE, false);
    }
    if (text[1] == '[' || text[1] == 'O') {
        CliInput input = read_sequence(text, size, length);
        if (*length == 0 && !more) *length = size;
        return input;
    }
    *length = 2; /* a letter with Alt */
    return (CliInput){0};
}

/* Takes a key that has come already. */
static bool take_key(CliTerminal *terminal, bool more, CliInput *input) {
    CliBytes *pending = &terminal->pending;
    size_t length;
    *input = cli_terminal_key(cli_bytes_text(pending), pending->size, more, &length);
    if (length == 0) return false;
    memmove(pending->data, pending->data + length, pending->size - length + 1);
    pending->size -= length;
    return true;
}

void cli_terminal_wake(void *unused) {
    (void)unused;
    while (write(wake_pipe[1], "", 1) < 0 && errno == EINTR) continue;
}

CliInput cli_terminal_wait(CliTerminal *terminal) {
    CliInput input;
    char bytes[256];
    if (take_key(terminal, true, &input)) return input;
    struct pollfd ends[] = {{wake_pipe[0], POLLIN, 0}, {terminal->in, POLLIN, 0}};
    struct timespec escape = {0, ESCAPE_MS * 1000000L};
    bool unfinished = terminal->pending.size > 0;
    int count = ppoll(ends, mode_fd >= 0 ? 2 : 1, unfinished ? &escape : NULL, &outside_mask);
    if (stop_asked) stop_here();
    if (size_changed) {
        size_changed = 0;
        return (CliInput){.kind = CLI_INPUT_RESIZE};
    }
    if (count == 0 && unfinished && take_key(terminal, false, &input)) return input;
    if (count <= 0) return (CliInput){0};
    while ((ends[0].revents & POLLIN) != 0 && read(wake_pipe[0], bytes, sizeof bytes) > 0) continue;
    if (ends[1].revents != 0) {
        ssize_t size = read(terminal->in, bytes, sizeof bytes);
        if (size == 0 || (size < 0 && errno != EINTR)) return (CliInput){.kind = CLI_INPUT_QUIT};
        if (size > 0) cli_bytes_add(&terminal->pending, bytes, (size_t)size);
        if (take_key(terminal, true, &input)) return input;
    }
    return (CliInput){0};
}
