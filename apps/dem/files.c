/* SPDX-License-Identifier: MIT
 *
 * files.c - files as a whole: those that are read, and outputs that appear whole or not at all.
 */
#define _XOPEN_SOURCE 700 /* realpath, mkstemp, fchmod */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dem.h"

enum { ERROR_SIZE = 512 };

static bool fail_file(const char *path, char *error) {
    snprintf(error, ERROR_SIZE, "%.400s: %s", path, strerror(errno));
    return false;
}

char *dem_read_file(const char *path, size_t *out_size, char *error) {
    FILE *file = fopen(path, "rb");
    char *bytes = NULL;
    size_t size = 0, got = file ? 1 : 0;
    for (size_t capacity = 65536; got > 0; capacity *= 2) {
        char *larger = realloc(bytes, capacity);
        if (!larger)
            break;
        bytes = larger;
        got = fread(bytes + size, 1, capacity - 1 - size, file);
        size += got;
    }
    if (got > 0 || !file || ferror(file)) {
        snprintf(error, ERROR_SIZE, "%.400s: it cannot be read: %s", path, strerror(errno));
        free(bytes);
        bytes = NULL;
    } else {
        bytes[size] = 0;
        *out_size = size;
    }
    if (file)
        fclose(file);
    return bytes;
}

static void forget(dem_file *out) {
    free(out->target);
    free(out->temporary);
    *out = (dem_file){0};
}

/* The temporary file is beside its target, and has the permissions of the file that it will replace. rename() would
 * replace one that may not be written to, and root may write to all. */
static FILE *open_temporary(dem_file *out, const struct stat *old) {
    const char *slash = strrchr(out->target, '/');
    const size_t folder = slash ? (size_t)(slash - out->target) + 1 : 0;
    const mode_t mask = umask(0);
    umask(mask);
    errno = old && !(old->st_mode & 0222) ? EACCES : 0;
    if (errno || (old && access(out->target, W_OK) != 0))
        return NULL;
    if (!(out->temporary = malloc(folder + sizeof ".narc-XXXXXX")))
        return NULL;
    memcpy(out->temporary, out->target, folder);
    strcpy(out->temporary + folder, ".narc-XXXXXX"); /* short: the target's may be as long as can be */
    const int descriptor = mkstemp(out->temporary);
    if (descriptor < 0)
        return NULL;
    fchmod(descriptor, old ? old->st_mode & 0777 : 0666 & ~mask);
    return fdopen(descriptor, "wb");
}

bool dem_open_file(dem_file *out, const char *path, char *error) {
    struct stat old;
    const bool exists = stat(path, &old) == 0;
    *out = (dem_file){.path = path};
    if (exists && !S_ISREG(old.st_mode)) { /* a device would be replaced by a file */
        snprintf(error, ERROR_SIZE, "%.400s: it is there, and is not a file", path);
        return false;
    }
    out->target = exists ? realpath(path, NULL) : strdup(path); /* a symbolic link stays one */
    if (out->target)
        out->file = open_temporary(out, exists ? &old : NULL);
    if (out->file)
        return true;
    fail_file(path, error);
    forget(out);
    return false;
}

bool dem_close_file(dem_file *out, bool ok, char *error) {
    errno = 0;
    const bool flushed = fflush(out->file) == 0, written = flushed && !ferror(out->file);
    const int reason = errno ? errno : EIO; /* an error that was earlier than the last flush has left none */
    const bool closed = fclose(out->file) == 0;
    const bool done = ok && written && closed && rename(out->temporary, out->target) == 0;
    if (ok && !done) {
        errno = written ? errno : reason;
        fail_file(out->path, error);
    }
    if (!done)
        unlink(out->temporary);
    forget(out);
    return done;
}
