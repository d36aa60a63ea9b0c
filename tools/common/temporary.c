/* SPDX-License-Identifier: MIT
 *
 * temporary.c - names and permissions of temporary files.
 */
#define _XOPEN_SOURCE 700 /* realpath, mkstemp */
#include "temporary.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fail.h"

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

char *find_target(const char *path) {
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

FILE *open_temporary(const char *target, const struct stat *old, char *volatile *out_name) {
    const mode_t mask = umask(0);
    umask(mask);
    char *name = join(target, folder_length(target), ".narc-XXXXXX"); /* short: the target's may be as long as can be */
    *out_name = name;
    const int descriptor = mkstemp(name);
    if (descriptor < 0)
        return NULL;
    fchmod(descriptor, old ? old->st_mode & 0777 : 0666 & ~mask);
    return fdopen(descriptor, "wb");
}
