/* SPDX-License-Identifier: MIT
 * The handler only stores the number of the signal; everything else happens in the main program.
 * SA_RESETHAND makes the second signal deadly, and the absence of SA_RESTART lets a read from a
 * terminal return at once. */
#define _XOPEN_SOURCE 700
#include "interrupt.h"

#include "status.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <unistd.h>

static atomic_int seen_signal;

static void remember(int number) { atomic_store(&seen_signal, number); }

/* Large files are mapped. What another program cuts off from one meanwhile is not there any more,
 * and nothing can go on without it. */
static void cut_short(int number) {
    static const char text[] = "glint: error: a file was cut short while it was read\n";
    (void)number;
    if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(CLI_MACHINE);
    _exit(CLI_INPUT);
}

void cli_interrupt_install(void) {
    static const int numbers[] = {SIGINT, SIGTERM};
    struct sigaction action = {.sa_handler = remember, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        struct sigaction inherited;
        /* nohup and background jobs of a shell ignore them on purpose. */
        if (sigaction(numbers[i], NULL, &inherited) == 0 && inherited.sa_handler == SIG_IGN)
            continue;
        sigaction(numbers[i], &action, NULL);
    }
    action.sa_handler = cut_short;
    sigaction(SIGBUS, &action, NULL);
    /* `glint scenes | head -1` still draws the rest: the pictures matter, the list does not. */
    signal(SIGPIPE, SIG_IGN);
    /* A limit on the size of files then shows as a failed write, which is reported. */
    signal(SIGXFSZ, SIG_IGN);
}

bool cli_interrupt_seen(void) {
    return atomic_load_explicit(&seen_signal, memory_order_relaxed) != 0;
}

void cli_interrupt_die(void) {
    int number = atomic_load(&seen_signal);
    if (number == 0) return;
    signal(number, SIG_DFL);
    raise(number);
}
