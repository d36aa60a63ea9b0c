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

typedef struct output output;
struct output {
    output *volatile next;
    char *path;               /* as the user gave it */
    char *target;             /* the file to replace, symbolic links followed; NULL: written directly */
    char *volatile temporary; /* NULL: nothing to remove. The signal handler reads it. */
    FILE *file;               /* NULL: not opened yet, or written and closed */
};

static output *volatile first;
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
    for (output *out = first; out; out = out->next) {
        if (out->temporary) {
            remove_file(out->temporary);
            out->temporary = NULL;
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
    for (const output *other = first; other; other = other->next)
        if (other->target && strcmp(out->target, other->target) == 0)
            fail("%s: two outputs are the same file", out->path);
}

static output *find_output(const char *path) {
    output *out = first;
    while (out && strcmp(out->path, path) != 0)
        out = out->next;
    return out;
}

static output *add_output(const char *path) {
    output *out = allocate(1, sizeof *out), *volatile *end = &first;
    *out = (output){.path = join_text(path, strlen(path), "")};
    if (strcmp(path, "-") != 0 && !is_special(path)) {
        if (!(out->target = find_target(path)))
            fail("%s: %s", path, strerror(errno));
        check_target(out);
    }
    if (!first)
        watch_signals(discard_outputs);
    while (*end)
        end = &(*end)->next;
    *end = out;
    return out;
}

void reserve_output(const char *path) {
    if (find_output(path))
        fail("%s: two outputs are the same file", path);
    output *out = add_output(path);
    if (out->target) {
        FILE *file = open_temporary(out->target, &out->temporary);
        if (!file)
            fail("%s: %s", path, strerror(errno));
        fclose(file);
        char *name = out->temporary;
        remove_file(name);
        out->temporary = NULL;
        free(name);
    }
}

FILE *open_output(const char *path) {
    output *out = find_output(path);
    if (!out || out->file || out->temporary)
        out = add_output(path);
    out->file = strcmp(path, "-") == 0 ? stdout
                : out->target          ? open_temporary(out->target, &out->temporary)
                                       : open_file(path, "wb");
    if (!out->file)
        fail("%s: %s", path, strerror(errno));
    return out->file;
}

void flush_output(FILE *file) {
    const output *out = first;
    while (out && out->file != file)
        out = out->next;
    const bool failed = ferror(file);
    if ((fflush(file) != 0 || failed) && out)
        fail("%s: %s", file == stdout ? "standard output" : out->path, strerror(errno));
}

/* What is written stands; the file has no name yet. */
static void close_file(output *out) {
    flush_output(out->file);
    if (fclose(out->file) != 0)
        fail("%s: %s", out->path, strerror(errno));
    out->file = NULL;
}

void close_output(FILE *file) {
    for (output *out = first; out; out = out->next)
        if (out->file == file && file != stdout)
            close_file(out);
}

FILE *finish_outputs(void) {
    FILE *report = stdout;
    for (output *out = first; out; out = out->next) {
        if (out->file == stdout) {
            flush_output(stdout);
            report = stderr;
        } else if (out->file) {
            close_file(out);
        }
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
    if (first)
        ignore_signals(); /* all files or none */
    while (first) {
        output *out = first;
        if (out->temporary && !replace_file(out->temporary, out->target))
            fail("%s: %s", out->path, strerror(errno));
        first = out->next; /* before a signal finds it freed */
        free(out->temporary);
        free(out->target);
        free(out->path);
        free(out);
    }
}

char *expand_pattern(const char *pattern, const char *name) {
    static const char odd[] = "/\\:*?<>|";
    static const char mark[] = NAME_MARK;
    if (!strstr(pattern, mark))
        return NULL;
    const bool is_dots = !name[strspn(name, ".")]; /* which are folders */
    char *safe = join_text(name, strlen(name), ""), *path = join_text("", 0, "");
    for (char *c = safe; *c; c++)
        *c = is_dots || strchr(odd, *c) ? '_' : *c;
    for (const char *found; pattern; pattern = found ? found + strlen(mark) : NULL) {
        found = strstr(pattern, mark);
        char *piece = join_text(pattern, found ? (size_t)(found - pattern) : strlen(pattern), found ? safe : ""),
             *longer = join_text(path, strlen(path), piece);
        free(piece);
        free(path);
        path = longer;
    }
    free(safe);
    if (strcmp(path, "-") == 0) { /* no standard output */
        free(path);
        path = join_text("./-", 3, "");
    }
    return path;
}
