/* SPDX-License-Identifier: MIT
 *
 * setting.c - options, the scenes of a program, the clock.
 */
#include "setting.h"

#include <stdlib.h>
#include <time.h>

#include "common.h"

struct setting read_setting(int argc, char **argv, const char *questions, size_t count, size_t rounds) {
    struct setting s = {0, count, rounds};
    for (int k = 1; k < argc; k++) {
        const char *const values[] = {option_value(argv[k], "--bodies="), option_value(argv[k], questions),
                                      option_value(argv[k], "--rounds=")};
        size_t *const places[] = {&s.bodies, &s.questions, &s.rounds};
        int which = 0;
        while (which < 3 && !values[which])
            which++;
        if (which == 3)
            fail("%s: unknown; there are --bodies=, %s and --rounds=", argv[k], questions);
        *places[which] = strtoul(values[which], NULL, 10);
    }
    if (s.rounds < 1 || s.rounds > MOST_ROUNDS || s.questions < 1 || (s.bodies > 0 && s.bodies < 100))
        fail("--rounds=1 .. %d, %s1 or more, --bodies=100 or more", MOST_ROUNDS, questions);
    return s;
}

void compare_scenes(const struct setting *setting, compare_scene *compare) {
    static const size_t sizes[] = {1000, 30000, 1000000};
    for (size_t k = 0; k < (setting->bodies ? 1 : sizeof sizes / sizeof *sizes); k++)
        for (int sparse = 0; sparse < 2; sparse++)
            compare(setting, sparse ? "sparse" : "pile", setting->bodies ? setting->bodies : sizes[k], sparse ? 3 : 1);
}

double read_clock(void) {
    struct timespec time;
    timespec_get(&time, TIME_UTC);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}
