/* SPDX-License-Identifier: MIT
 * One line, redrawn in place:
 *
 *     snow-man.xml (2 of 5)  trace [############............]  48%  0:12  0:13 left
 *
 * It is put together in memory and written at once, so that it does not flicker. */
#define _DEFAULT_SOURCE
#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include "inputs.h"

#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#define DELAY_SECONDS  0.3
#define PERIOD_SECONDS 0.1
#define ERASE_LINE     "\r\033[K"

enum { LINE_LIMIT = 512, BAR_LIMIT = 40 };

double cli_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void cli_progress_begin(
    CliProgress *progress, bool wanted, const char *name, int index, int count) {
    double now = cli_clock();
    *progress = (CliProgress){.wanted = wanted,
        .name = cli_path_base(name),
        .index = index,
        .count = count,
        .began = now,
        .phase_began = now};
}

static int terminal_width(void) {
    struct winsize size;
    bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    int width = known ? size.ws_col : 80;
    return width < LINE_LIMIT / 2 ? width : LINE_LIMIT / 2;
}

static const char *phase_name(GlintPhase phase) {
    static const char *const names[] = {"read ", "build", "trace", "write"};
    return (unsigned)phase < sizeof names / sizeof names[0] ? names[phase] : "     ";
}

/* 0:07, 12:40, 3:00:00 */
static void format_time(double seconds, char *text, size_t size) {
    if (!(seconds < 360000)) seconds = 359999;
    int whole = (int)seconds;
    if (whole >= 3600) {
        snprintf(text, size, "%d:%02d:%02d", whole / 3600, whole / 60 % 60, whole % 60);
    } else {
        snprintf(text, size, "%d:%02d", whole / 60, whole % 60);
    }
}

/* The part behind the phase when the end is known. */
static void format_bar(char *text, size_t size, int width, double fraction, double elapsed) {
    char bar[BAR_LIMIT + 1], elapsed_text[16], left_text[16];
    format_time(elapsed, elapsed_text, sizeof elapsed_text);
    /* Too early a guess is a wrong guess. */
    bool guess = fraction > 0.01 && elapsed > DELAY_SECONDS;
    if (guess) {
        format_time(elapsed * (1 - fraction) / fraction + 0.5, left_text, sizeof left_text);
    } else {
        snprintf(left_text, sizeof left_text, "?");
    }
    int cells = width - 30 < BAR_LIMIT ? width - 30 : BAR_LIMIT;
    if (cells < 5) cells = 0;
    int full = (int)(fraction * cells);
    memset(bar, '.', sizeof bar);
    memset(bar, '#', (size_t)full);
    bar[cells] = '\0';
    snprintf(text, size, cells > 0 ? "[%s] %3d%%  %s  %s left" : "%s%3d%%  %s  %s left", bar,
        (int)(100 * fraction), elapsed_text, left_text);
}

static void format_spinner(const CliProgress *progress, char *text, size_t size, double elapsed) {
    char elapsed_text[16];
    format_time(elapsed, elapsed_text, sizeof elapsed_text);
    int used = snprintf(text, size, "%c  %s", "|/-\\"[progress->frame % 4], elapsed_text);
    if (progress->read_bytes > 0) {
        snprintf(
            text + used, size - (size_t)used, "  %.1f MB", 1e-6 * (double)progress->read_bytes);
    }
}

static void draw(CliProgress *progress, double fraction, double now) {
    /* The last column stays free: some terminals wrap as soon as it is written. */
    int width = terminal_width() - 1;
    char line[LINE_LIMIT] = "", text[LINE_LIMIT / 2];
    int used = 0;
    if (width >= 60) {
        used = snprintf(line, sizeof line, "%.*s", width / 4, progress->name);
        if (progress->count > 1) {
            used += snprintf(line + used, sizeof line - (size_t)used, " (%d of %d)",
                progress->index + 1, progress->count);
        }
        used += snprintf(line + used, sizeof line - (size_t)used, "  ");
    }
    double elapsed = now - progress->phase_began;
    if (fraction >= 0) {
        format_bar(text, sizeof text, width - used - 6, fraction < 1 ? fraction : 1, elapsed);
    } else {
        format_spinner(progress, text, sizeof text, elapsed);
    }
    snprintf(line + used, sizeof line - (size_t)used, "%s %s", phase_name(progress->phase), text);
    fprintf(stderr, ERASE_LINE "%.*s", width, line);
    fflush(stderr);
    progress->shown = true;
    progress->drawn = now;
    progress->frame++;
}

void cli_progress_update(CliProgress *progress, GlintPhase phase, double fraction) {
    if (!progress->wanted) return;
    double now = cli_clock();
    if (phase != progress->phase) {
        progress->phase = phase;
        progress->phase_began = now;
    }
    if (now - progress->began < DELAY_SECONDS || now - progress->drawn < PERIOD_SECONDS) return;
    draw(progress, fraction, now);
}

void cli_progress_clear(CliProgress *progress) {
    if (!progress->shown) return;
    fputs(ERASE_LINE, stderr);
    fflush(stderr);
    progress->shown = false;
}
