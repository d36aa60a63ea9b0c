/* SPDX-License-Identifier: MIT
 *
 * progress.c - the progress line. The second of patience counts from the first report of the whole command.
 */
#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include <stdbool.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { LOOK_EVERY = 256 }; /* reports between two looks at the clock */
static const double PATIENCE = 1.0, REFRESH = 0.1;

static double first_time = -1, last_time = -1;
static bool shown;

double seconds_now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void show_progress(const char *what, size_t done, size_t total) {
    static int terminal = -1;
    static unsigned reports;
    if (terminal < 0) {
        terminal = isatty(STDERR_FILENO);
    }
    if (!terminal || reports++ % LOOK_EVERY) {
        return;
    }
    const double now = seconds_now();
    if (first_time < 0) {
        first_time = now;
    }
    if (now - first_time < PATIENCE || (shown && now - last_time < REFRESH)) {
        return;
    }
    last_time = now;
    shown = true;
    fprintf(stderr, "\r\033[K%s: %.0f %%", what, total ? 100.0 * (double)done / (double)total : 100.0);
    fflush(stderr);
}

void hide_progress(void) {
    if (shown) {
        shown = false;
        fprintf(stderr, "\r\033[K");
        fflush(stderr);
    }
}
