/* SPDX-License-Identifier: MIT
 *
 * output.c - temporary files beside their targets, renamed at the end.
 */
#define _XOPEN_SOURCE 700 /* realpath */
#include "output.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fail.h"
#include "progress.h"

enum { MAX_OUTPUTS = 4 };

typedef struct output {
    const char *path;         /* as the user gave it */
    char *target;             /* the file to replace, symbolic links followed; NULL: written directly */
    char *volatile temporary; /* NULL: nothing to remove. The signal handler reads it. */
    FILE *file;
} output;

static output outputs[MAX_OUTPUTS];
static size_t output_count;
static char **inputs;
static size_t input_count, input_capacity;

void discard_outputs(void) {
    for (size_t i = 0; i < MAX_OUTPUTS; i++) {
        if (outputs[i].temporary) {
            unlink(outputs[i].temporary);
            outputs[i].temporary = NULL;
        }
    }
}

static void on_signal(int number) {
    discard_outputs();
    signal(number, SIG_DFL);
    raise(number);
}

/* Signals that end a command remove its temporary files; a file that grows beyond a limit is an error of writing. */
static void watch_signals(void) {
    static const int numbers[] = {SIGINT,  SIGTERM, SIGHUP,  SIGPIPE,   SIGQUIT, SIGALRM,
                                  SIGXCPU, SIGUSR1, SIGUSR2, SIGVTALRM, SIGPROF};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (signal(numbers[i], on_signal) == SIG_IGN)
            signal(numbers[i], SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

/* `suffix` behind the first `length` bytes of `text`. */
static char *join(const char *text, size_t length, const char *suffix) {
    char *joined = allocate(length + strlen(suffix) + 1, 1);
    memcpy(joined, text, length);
    strcpy(joined + length, suffix);
    return joined;
}

/* The length of the part of a path that names its folder: up to the last slash, or 0. */
static size_t folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* The file that a path means, always by the same name; NULL if neither it nor its folder exists. */
static char *find_target(const char *path) {
    char *found = realpath(path, NULL);
    if (found || errno != ENOENT)
        return found;
    const size_t length = folder_length(path);
    char *as_given = join(path, length, "."), *folder = realpath(as_given, NULL);
    if (folder) {
        char *with_slash = join(folder, strlen(folder), "/");
        found = join(with_slash, strlen(with_slash), path + length);
        free(with_slash);
    }
    free(as_given);
    free(folder);
    return found;
}

void protect_input(const char *path) {
    char *target = find_target(path);
    if (target) {
        inputs = grow(inputs, &input_capacity, input_count + 1, sizeof *inputs);
        inputs[input_count++] = target;
    }
}

static void check_target(const output *out) {
    for (size_t i = 0; i < input_count; i++)
        if (strcmp(out->target, inputs[i]) == 0)
            fail("%s: this output is one of the inputs", out->path);
    for (const output *other = outputs; other < out; other++)
        if (other->target && strcmp(out->target, other->target) == 0)
            fail("%s: two outputs are the same file", out->path);
}

/* Opens a temporary file beside the target, with the permissions of the file that it replaces, or those that the user's
 * mask allows. Its name is short: the target's may be as long as names can be. */
static void open_temporary(output *out, const struct stat *old) {
    const mode_t mask = umask(0);
    umask(mask);
    char *name = join(out->target, folder_length(out->target), ".narc-XXXXXX");
    out->temporary = name;
    const int descriptor = mkstemp(name);
    if (descriptor >= 0) {
        fchmod(descriptor, old ? old->st_mode & 0777 : 0666 & ~mask);
        out->file = fdopen(descriptor, "wb");
    }
}

FILE *open_output(const char *path) {
    if (output_count == MAX_OUTPUTS)
        fail("%s: too many outputs", path);
    if (output_count == 0)
        watch_signals();
    output *out = &outputs[output_count++];
    out->path = path;
    struct stat old;
    const bool exists = stat(path, &old) == 0;
    if (strcmp(path, "-") == 0) {
        out->path = "standard output";
        out->file = stdout;
    } else if (exists && !S_ISREG(old.st_mode)) {
        out->file = fopen(path, "wb");
    } else if ((out->target = find_target(path))) {
        check_target(out);
        open_temporary(out, exists ? &old : NULL);
    }
    if (!out->file)
        fail("%s: %s", path, strerror(errno));
    return out->file;
}

FILE *finish_outputs(void) {
    FILE *report = stdout;
    for (size_t i = 0; i < output_count; i++) {
        const bool written = !ferror(outputs[i].file) && fflush(outputs[i].file) == 0;
        const int reason = errno;
        const bool closed = outputs[i].file == stdout || fclose(outputs[i].file) == 0;
        if (!written || !closed)
            fail("%s: %s", outputs[i].path, strerror(written ? errno : reason));
        report = outputs[i].file == stdout ? stderr : report;
    }
    hide_progress();
    return report;
}

void finish_report(FILE *file) {
    errno = 0;
    if (fflush(file) != 0 || ferror(file)) {
        fail("%s: %s", file == stdout ? "standard output" : "standard error",
             errno ? strerror(errno) : "it cannot be written");
    }
}

void commit_outputs(void) {
    for (size_t i = 0; i < output_count; i++) {
        if (outputs[i].temporary) {
            if (rename(outputs[i].temporary, outputs[i].target) != 0)
                fail("%s: %s", outputs[i].path, strerror(errno));
            free(outputs[i].temporary);
        }
        free(outputs[i].target);
        outputs[i] = (output){0};
    }
    output_count = 0;
}
