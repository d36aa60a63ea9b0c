/* SPDX-License-Identifier: MIT
 *
 * temporary.c - names and permissions of temporary files.
 */
#define _XOPEN_SOURCE 700 /* realpath, mkstemp */
#include "temporary.h"

#include <errno.h>
#include <stdbool.h>
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

/* rename() would replace a file that may not be written to, and root may write to all. */
static bool is_read_only(const char *target, const struct stat *old) {
    if (!(old->st_mode & 0222))
        errno = EACCES;
    return !(old->st_mode & 0222) || access(target, W_OK) != 0;
}

FILE *open_temporary(const char *target, const struct stat *old, char *volatile *out_name) {
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
