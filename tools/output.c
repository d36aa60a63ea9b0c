/* SPDX-License-Identifier: MIT
 *
 * output.c - temporary files beside their targets, renamed at the end.
 */
#define _XOPEN_SOURCE 700 /* realpath */
#include "output.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fail.h"

enum { MAX_OUTPUTS = 4 };

/* Which file, whatever it is called. */
typedef struct identity {
    dev_t device;
    ino_t number;
} identity;

typedef struct output {
    const char *path;         /* as the user gave it */
    char *target;             /* the file to replace, symbolic links followed; NULL: written directly */
    identity folder;          /* of the target */
    char *volatile temporary; /* NULL: nothing to remove. The signal handler reads it. */
    FILE *file;
} output;

static output outputs[MAX_OUTPUTS];
static size_t output_count;
static identity *inputs;
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

/* A command that is interrupted, or whose reader goes away, leaves no temporary file either. */
static void watch_signals(void) {
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        if (signal(numbers[i], on_signal) == SIG_IGN) {
            signal(numbers[i], SIG_IGN);
        }
    }
}

/* The permissions of a new file: those of the file it replaces, or what the user's mask allows. */
static mode_t output_mode(const struct stat *old) {
    if (old) {
        return old->st_mode & 0777;
    }
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

static identity identify(const struct stat *state) { return (identity){state->st_dev, state->st_ino}; }

static bool is_same(identity a, identity b) { return a.device == b.device && a.number == b.number; }

void protect_input(FILE *file) {
    struct stat state;
    if (fstat(fileno(file), &state) != 0 || !S_ISREG(state.st_mode)) {
        return;
    }
    inputs = grow(inputs, &input_capacity, input_count + 1, sizeof *inputs);
    inputs[input_count++] = identify(&state);
}

/* The length of the part of a path that names its folder: up to the last slash, or 0. */
static size_t folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* Finds the target's folder. A file that does not exist yet is told from others by its folder and its name there. */
static void identify_folder(output *out) {
    const size_t length = folder_length(out->target);
    char *folder = allocate(length + sizeof ".", 1);
    memcpy(folder, out->target, length);
    strcpy(folder + length, ".");
    struct stat state;
    if (stat(folder, &state) != 0) {
        fail("%s: %s", out->path, strerror(errno));
    }
    free(folder);
    out->folder = identify(&state);
}

static bool is_same_target(const output *a, const output *b) {
    return a->target && b->target && is_same(a->folder, b->folder) &&
           strcmp(a->target + folder_length(a->target), b->target + folder_length(b->target)) == 0;
}

/* Opens a temporary file beside out->target. Its name is short: the target's may be as long as names can be. */
static void open_temporary(output *out, const struct stat *old) {
    static const char own[] = ".narc-XXXXXX";
    const size_t length = folder_length(out->target);
    char *name = allocate(length + sizeof own, 1);
    memcpy(name, out->target, length);
    memcpy(name + length, own, sizeof own);
    const int descriptor = mkstemp(name);
    if (descriptor < 0) {
        fail("%s: %s", out->path, strerror(errno));
    }
    out->temporary = name;
    fchmod(descriptor, output_mode(old));
    out->file = fdopen(descriptor, "wb");
}

FILE *open_output(const char *path) {
    if (output_count == MAX_OUTPUTS) {
        fail("%s: too many outputs", path);
    }
    if (output_count == 0) {
        watch_signals();
    }
    output *out = &outputs[output_count++];
    out->path = path;
    struct stat state;
    const bool exists = !is_standard_output(path) && stat(path, &state) == 0;
    if (is_standard_output(path)) {
        out->path = "standard output";
        out->file = stdout;
    } else if (exists && S_ISDIR(state.st_mode)) {
        fail("%s: %s", path, strerror(EISDIR));
    } else if (exists && !S_ISREG(state.st_mode)) {
        out->file = fopen(path, "wb");
    } else {
        out->target = exists ? realpath(path, NULL) : strcpy(allocate(strlen(path) + 1, 1), path);
        if (!out->target) {
            fail("%s: %s", path, strerror(errno));
        }
        for (size_t i = 0; exists && i < input_count; i++) {
            if (is_same(identify(&state), inputs[i])) {
                fail("%s: this output is one of the inputs", path);
            }
        }
        identify_folder(out);
        for (size_t i = 0; i + 1 < output_count; i++) {
            if (is_same_target(&outputs[i], out)) {
                fail("%s: two outputs are the same file", path);
            }
        }
        open_temporary(out, exists ? &state : NULL);
    }
    if (!out->file) {
        fail("%s: %s", path, strerror(errno));
    }
    return out->file;
}

bool is_standard_output(const char *path) { return path && strcmp(path, "-") == 0; }

void finish_outputs(void) {
    for (size_t i = 0; i < output_count; i++) {
        const bool written = !ferror(outputs[i].file) && fflush(outputs[i].file) == 0;
        const int reason = errno;
        const bool closed = outputs[i].file == stdout || fclose(outputs[i].file) == 0;
        if (!written || !closed) {
            fail("%s: %s", outputs[i].path, strerror(written ? errno : reason));
        }
    }
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
            if (rename(outputs[i].temporary, outputs[i].target) != 0) {
                fail("%s: %s", outputs[i].path, strerror(errno));
            }
            free(outputs[i].temporary);
            outputs[i].temporary = NULL;
        }
        free(outputs[i].target);
        outputs[i] = (output){0};
    }
    output_count = 0;
}
