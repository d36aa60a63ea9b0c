/* SPDX-License-Identifier: MIT
 *
 * setting.h - what a program is told: its options, the scenes it compares, the clock.
 */
#ifndef NARC_BENCH_SCENE_SETTING_H
#define NARC_BENCH_SCENE_SETTING_H

#include <stddef.h>

enum { MOST_ROUNDS = 100 };

/* Of a program's options; 0: its default. */
struct setting {
    size_t bodies, questions, rounds;
};

/* Reads --bodies=, --rounds= and `questions`, such as "--points=", or ends the program. */
struct setting read_setting(int argc, char **argv, const char *questions, size_t count, size_t rounds);

/* The scenes of all programs: calls compare() for each of 1,000, 30,000 and 1,000,000 bodies, or those of the setting,
 * in a pile and three times as far apart. */
typedef void compare_scene(const struct setting *setting, const char *name, size_t bodies, double spread);
void compare_scenes(const struct setting *setting, compare_scene *compare);

/* Several threads' time: the clock on the wall, in ns. */
double read_clock(void);

#endif
