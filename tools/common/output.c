/* SPDX-License-Identifier: MIT
 *
 * output.c - temporary files beside their targets, renamed at the end.
 */
#include "output.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "progress.h"
#include "system.h"

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

/* The file that a path means, symbolic links followed, always by the same name; the caller's to free. NULL, and errno, if
 * neither it nor its folder exists. */
static char *find_target(const char *path) {
    char *found = find_real_path(path);
    if (found || errno != ENOENT)
        return found;
    const size_t length = folder_length(path);
    char *as_given = join_text(path, length, "."), *folder = find_real_path(as_given);
    if (folder) {
        const bool is_root = folder_length(folder) == strlen(folder); /* its name has the separator */
        char *with_slash = join_text(folder, strlen(folder), is_root ? "" : path_separator);
        found = join_text(with_slash, strlen(with_slash), path + length);
        free(with_slash);
    }
    free(as_given);
    free(folder);
    return found;
}

void discard_outputs(void) {
    for (size_t i = 0; i < MAX_OUTPUTS; i++) {
        if (outputs[i].temporary) {
            remove_file(outputs[i].temporary);
            outputs[i].temporary = NULL;
        }
    }
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
        watch_signals(discard_outputs);
    output *out = &outputs[output_count++];
    out->path = path;
    if (strcmp(path, "-") == 0) {
        out->path = "standard output";
        out->file = stdout;
    } else if (is_special(path)) {
        out->file = open_file(path, "wb");
    } else if ((out->target = find_target(path))) {
        check_target(out);
        out->file = open_temporary(out->target, &out->temporary);
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
            if (!replace_file(outputs[i].temporary, outputs[i].target))
                fail("%s: %s", outputs[i].path, strerror(errno));
            char *name = outputs[i].temporary;
            outputs[i].temporary = NULL; /* before a signal finds it freed */
            free(name);
        }
        free(outputs[i].target);
        outputs[i] = (output){0};
    }
    output_count = 0;
}
