/* SPDX-License-Identifier: MIT
 * Watching files: who waits here learns within milliseconds that one of them has been saved, by
 * whatever way editors save: written in place, or under another name and renamed.
 *
 * What decides is the file itself, its identity, size and time, or a message of the system that
 * names it. The system's messages (inotify, on the folders, since a file that is renamed over takes
 * its own messages away with it) otherwise only say when to look; where there are none, on a
 * network for instance, files are looked at a few times a second. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

typedef struct CliFileWatch CliFileWatch;

/* How a file looks from outside. All zero: it is not there. */
typedef struct CliFileMark {
    uint64_t device, number;
    int64_t size, seconds, nanoseconds;
} CliFileMark;

CliFileMark cli_file_mark(const char *path);
bool cli_file_mark_equal(const CliFileMark *a, const CliFileMark *b);

/* Null when memory or descriptors are short. poll_only: the system's messages are not asked for,
 * as where there are none. */
CliFileWatch *cli_file_watch_create(bool poll_only);
void cli_file_watch_destroy(CliFileWatch *watch);

/* A moment to tell cli_file_watch_set, taken before files are read. */
int64_t cli_file_watch_now(void);

/* Watches these files from now on, and no others. They have been read since a moment; a new one
 * that has changed after it counts as changed. A file need not exist. False when memory is short;
 * the old ones are then watched. Any thread. */
bool cli_file_watch_set(CliFileWatch *watch, const char *const *paths, int count, int64_t since);

/* Waits until some file has changed and looks complete: nothing has moved for a few milliseconds,
 * and none is missing or empty that was not before, unless it stays so for a tenth of a second.
 * False when cli_file_watch_wake was called instead. One thread at a time. */
bool cli_file_watch_wait(CliFileWatch *watch);

/* Lets the waiting thread return false, now or when it next waits. Any thread. */
void cli_file_watch_wake(CliFileWatch *watch);
