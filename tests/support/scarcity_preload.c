/* SPDX-License-Identifier: MIT
 *
 * scarcity_preload.c - for LD_PRELOAD: from main() on allocation NARC_DENIED fails, from 1, and with NARC_DENIED_ON each
 * one behind it. With NARC_DENIED_TO those alone count that a program or library with this word in its file's name asks
 * for. How many there were goes to the file NARC_ALLOCATIONS, when the program ends by exit().
 */
#define _GNU_SOURCE /* RTLD_NEXT, dladdr */
#include "scarcity.h"

#if CAN_FAIL
#include <dlfcn.h>
#include <execinfo.h>
#include <stdio.h>
#include <string.h>

typedef int main_function(int count, char **arguments, char **environment);
typedef int start_function(main_function *main, int count, char **arguments, void (*begin)(void), void (*end)(void),
                           void (*end_linker)(void), void *stack);

static main_function *program;
static const char *denied_to;

/* Within libraries that crash without memory: fontconfig reads through NULL, or goes round in circles, cairo jumps to a
 * frame that is gone, glib and librsvg end the process. */
static const char *const spared_libraries[] = {"/libfontconfig.", "/libcairo.", "/libglib-", "/librsvg-"};

static bool belongs_to_spared(const char *file) {
    bool spared = false;
    for (size_t k = 0; k < sizeof spared_libraries / sizeof *spared_libraries; k++)
        spared = spared || strstr(file, spared_libraries[k]);
    return spared;
}

static bool is_spared(void) {
    enum { DEPTH = 64 };
    void *frames[DEPTH];
    scarcity.counts = false;
    const int count = backtrace(frames, DEPTH);
    /* Nor what libgomp itself allocates, for threads by the C library and its loader, which ends the process too; it calls
     * narc. */
    bool spared = false, direct = true;
    Dl_info here, object;
    for (int k = 0; k < count && !spared; k++) {
        if (!dladdr(frames[0], &here) || !dladdr(frames[k], &object) || object.dli_fbase == here.dli_fbase)
            continue;
        spared = belongs_to_spared(object.dli_fname) || (direct && strstr(object.dli_fname, "/libgomp."));
        direct = direct && (strstr(object.dli_fname, "/libc.") || strstr(object.dli_fname, "/ld-linux"));
    }
    scarcity.counts = true;
    return spared;
}

/* Containers of the C++ library are its callers'. */
static bool is_of_another(void) {
    void *frames[8];
    scarcity.counts = false;
    const int count = backtrace(frames, sizeof frames / sizeof *frames);
    Dl_info here, object = {.dli_fname = ""};
    for (int k = 1; k < count && dladdr(frames[0], &here); k++)
        if (dladdr(frames[k], &object) && object.dli_fbase != here.dli_fbase &&
            !strstr(object.dli_fname, "/libstdc++."))
            break;
    scarcity.counts = true;
    return !strstr(object.dli_fname, denied_to);
}

static int run(int count, char **arguments, char **environment) {
    const char *const denied = getenv("NARC_DENIED");
    scarcity.denied = denied ? strtoul(denied, NULL, 10) : 0;
    scarcity.forever = getenv("NARC_DENIED_ON") != NULL;
    denied_to = getenv("NARC_DENIED_TO");
    scarcity.ignores = denied_to ? is_of_another : NULL;
    scarcity.spares = is_spared;
    is_spared(); /* loads what it needs */
    scarcity.counts = true;
    return program(count, arguments, environment);
}

__attribute__((destructor)) static void tell(void) {
    const char *const name = getenv("NARC_ALLOCATIONS");
    scarcity.counts = false;
    FILE *const file = name ? fopen(name, "w") : NULL;
    if (!file)
        return;
    fprintf(file, "%zu\n", scarcity.count);
    fclose(file);
}

/* What calls main(), in the C library. */
__attribute__((visibility("default"))) start_function __libc_start_main;
int __libc_start_main(main_function *main, int count, char **arguments, void (*begin)(void), void (*end)(void),
                      void (*end_linker)(void), void *stack) {
    start_function *start;
    void *const found = dlsym(RTLD_NEXT, "__libc_start_main");
    memcpy(&start, &found, sizeof start);
    program = main;
    return start(run, count, arguments, begin, end, end_linker, stack);
}
#endif
