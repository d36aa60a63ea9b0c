/* SPDX-License-Identifier: MIT
 *
 * output.c - temporary files beside their targets, renamed at the end.
 */
#define _XOPEN_SOURCE 700 /* realpath, mkstemp */
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

/* The file that a path means, symbolic links followed, always by the same name; the caller's to free. NULL, and errno, if
 * neither it nor its folder exists. */
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

/* rename() would replace a file that may not be written to, and root may write to all. */
static bool is_read_only(const char *target, const struct stat *old) {
    if (!(old->st_mode & 0222))
        errno = EACCES;
    return !(old->st_mode & 0222) || access(target, W_OK) != 0;
}

/* Opens a temporary file beside a target, with owner (where that is allowed) and permissions of the file that it will
 * replace, or (`old` NULL) with those that the user's mask allows. A file that is read-only is not replaced: EACCES or
 * EROFS. The new file's name, the caller's to remove and to free, is told before the file is there, so that a signal
 * handler can remove it. NULL, and errno, if it cannot be opened. */
static FILE *open_temporary(const char *target, const struct stat *old, char *volatile *out_name) {
    if (old && is_read_only(target, old))
        return NULL;
    const mode_t mask = umask(0);
    umask(mask);
    char *name = join(target, folder_length(target), ".narc-XXXXXX"); /* short: the target's may be as long as can be */
    *out_name = name;
    const int descriptor = mkstemp(name);
    if (descriptor < 0)
        return NULL;
    if (old && fchown(descriptor, old->st_uid, old->st_gid) != 0 && fchown(descriptor, (uid_t)-1, old->st_gid) != 0)
        errno = 0; /* only root gives files to others */
    fchmod(descriptor, old ? old->st_mode & 0777 : 0666 & ~mask);
    return fdopen(descriptor, "wb");
}

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

/* Signals that end a command remove its temporary files, also those of libraries that give up without memory; a file that
 * grows beyond a limit is an error of writing. */
static void watch_signals(void) {
    static const int numbers[] = {SIGINT,  SIGTERM, SIGHUP,    SIGPIPE, SIGQUIT, SIGALRM, SIGXCPU,
                                  SIGUSR1, SIGUSR2, SIGVTALRM, SIGPROF, SIGABRT, SIGTRAP};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (signal(numbers[i], on_signal) == SIG_IGN)
            signal(numbers[i], SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

void protect_input(const char *path) {
    char *target = find_target(path);
    if (!target && errno == ENOMEM)
        fail("%s: %s", path, strerror(errno));
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
        out->file = open_temporary(out->target, exists ? &old : NULL, &out->temporary);
    }
    if (!out->file)
        fail("%s: %s", path, strerror(errno));
    return out->file;
}

void flush_output(FILE *file) {
    size_t i = 0;
    while (i < output_count && outputs[i].file != file)
        i++;
    const bool failed = ferror(file);
    if ((fflush(file) != 0 || failed) && i < output_count)
        fail("%s: %s", outputs[i].path, strerror(errno));
}

FILE *finish_outputs(void) {
    FILE *report = stdout;
    for (size_t i = 0; i < output_count; i++) {
        flush_output(outputs[i].file);
        if (outputs[i].file != stdout && fclose(outputs[i].file) != 0)
            fail("%s: %s", outputs[i].path, strerror(errno));
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
