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
        snprintf(error, 512, "%.400s: it cannot be read: %s", path, strerror(errno));
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

/* Beside its target, with the permissions of the file that it will replace, if there is one. rename() would replace one
 * that may not be written to, and root may write to all. */
static FILE *open_temporary(dem_file *out, const struct stat *old) {
    const char *slash = strrchr(out->target, '/');
    const int folder = slash ? (int)(slash - out->target) + 1 : 0;
    const size_t size = (size_t)folder + sizeof ".narc-XXXXXX"; /* short: the target's name may be as long as can be */
    const mode_t mask = umask(0);
    umask(mask);
    errno = old && !(old->st_mode & 0222) ? EACCES : 0;
    if (errno || (old && access(out->target, W_OK) != 0) || !(out->temporary = malloc(size)))
        return NULL;
    snprintf(out->temporary, size, "%.*s.narc-XXXXXX", folder, out->target);
    const int descriptor = mkstemp(out->temporary);
    if (descriptor < 0)
        return NULL;
    fchmod(descriptor, old ? old->st_mode & 0777 : 0666 & ~mask);
    return fdopen(descriptor, "wb");
}

bool dem_open_file(dem *d, dem_file *out, const char *path) {
    struct stat old;
    const bool exists = stat(path, &old) == 0;
    if (exists && !S_ISREG(old.st_mode)) /* a device would be replaced by a file */
        return dem_fail(d, "%.400s: it is there, and is not a file", path);
    *out = (dem_file){.path = path, .target = exists ? realpath(path, NULL) : strdup(path)}; /* a link stays one */
    if (out->target && (out->file = open_temporary(out, exists ? &old : NULL)) != NULL)
        return true;
    dem_fail(d, "%.400s: %s", path, strerror(errno));
    free(out->target);
    free(out->temporary);
    return false;
}

bool dem_close_file(dem *d, dem_file *file) {
    errno = 0;
    const bool written = fflush(file->file) == 0 && !ferror(file->file);
    const int reason = errno ? errno : EIO; /* an error that was earlier than the last flush has left none */
    const bool closed = fclose(file->file) == 0;
    const bool ok = written && closed && rename(file->temporary, file->target) == 0;
    if (!ok) {
        dem_fail(d, "%.400s: %s", file->path, strerror(written ? errno : reason));
        unlink(file->temporary);
    }
    free(file->target);
    free(file->temporary);
    return ok;
}
