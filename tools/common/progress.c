/* SPDX-License-Identifier: MIT
 *
 * progress.c - the progress line.
 */
#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include <stdio.h>
#include <time.h>

#include "system.h"

enum { LOOK_EVERY = 256 }; /* reports between two looks at the clock */
static const double PATIENCE = 1.0, REFRESH = 0.1;

static double start_time, last_time;
static bool terminal, shown;

double seconds_now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void start_progress(void) {
    start_time = seconds_now();
    terminal = is_terminal();
}

void show_share(const char *what, double share) {
    if (!terminal)
        return;
    const double now = seconds_now();
    if (now - start_time < PATIENCE || (shown && now - last_time < REFRESH))
        return;
    last_time = now;
    shown = true;
    fprintf(stderr, "\r\033[K%s: %.0f %%", what, 100 * share);
    fflush(stderr);
}

void show_progress(const char *what, size_t done, size_t total) {
    static unsigned reports;
    if (terminal && reports++ % LOOK_EVERY == 0)
        show_share(what, total ? (double)done / (double)total : 1);
}

void show_stage(const char *what, size_t count, const char *items, bool is_long) {
    if (terminal && (is_long || seconds_now() - start_time >= PATIENCE)) {
        shown = true;
        fprintf(stderr, "\r\033[K%s, %zu %s", what, count, items);
        fflush(stderr);
    }
}

void hide_progress(void) {
    if (shown) {
        shown = false;
        fprintf(stderr, "\r\033[K");
        fflush(stderr);
    }
}
