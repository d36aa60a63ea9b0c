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
static output *last, *current; /* the newest, and the one that was opened last */

/* The files of inputs and outputs, hashed: at most half of the places are taken. */
typedef struct known {
    char *target; /* NULL: a free place */
    output *out;  /* NULL: an input */
} known;
static known *files;
static size_t places, taken;

static known *find_known(const char *target) {
    size_t at = 5381;
    for (const char *c = target; *c; c++)
        at = 33 * at + (unsigned char)*c;
    for (at &= places - 1; files[at].target && strcmp(files[at].target, target) != 0;)
        at = (at + 1) & (places - 1);
    return &files[at];
}

static known *make_known(const char *target) {
    if (2 * taken >= places) {
        known *old = files;
        const size_t count = places;
        places = count ? 2 * count : 64;
        files = allocate(places, sizeof *files);
        memset(files, 0, places * sizeof *files);
        for (size_t i = 0; i < count; i++)
            if (old[i].target)
                *find_known(old[i].target) = old[i];
        free(old);
    }
    return find_known(target);
}

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
    known *of = target ? make_known(target) : NULL;
    if (of && !of->target) {
        *of = (known){target, NULL};
        taken++;
    } else {
        free(target);
    }
}

static output *add_output(const char *path) {
    output *out = allocate(1, sizeof *out);
    *out = (output){.path = join_text(path, strlen(path), "")};
    if (strcmp(path, "-") != 0 && !is_special(path)) {
        if (!(out->target = find_target(path)))
            fail("%s: %s", path, strerror(errno));
        known *of = make_known(out->target);
        if (of->target)
            fail(of->out ? "%s: two outputs are the same file" : "%s: this output is one of the inputs", path);
        *of = (known){out->target, out};
        taken++;
    }
    if (!first)
        watch_signals(discard_outputs);
    *(first ? &last->next : &first) = out;
    last = out;
    return out;
}

void reserve_output(const char *path) {
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
    char *target = taken ? find_target(path) : NULL;
    output *out = target ? find_known(target)->out : NULL;
    free(target);
    if (!out || out->file || out->temporary)
        out = add_output(path);
    current = out;
    out->file = strcmp(path, "-") == 0 ? stdout
                : out->target          ? open_temporary(out->target, &out->temporary)
                                       : open_file(path, "wb");
    if (!out->file)
        fail("%s: %s", path, strerror(errno));
    return out->file;
}

static output *find_open(FILE *file) {
    output *out = current && current->file == file ? current : first;
    while (out && out->file != file)
        out = out->next;
    return out;
}

void flush_output(FILE *file) {
    const output *out = find_open(file);
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
    output *out = find_open(file);
    if (out && file != stdout)
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
    for (size_t i = 0; i < places; i++)
        if (!files[i].out)
            free(files[i].target); /* an input's */
    free(files);
    files = NULL;
    places = taken = 0;
    last = current = NULL;
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
