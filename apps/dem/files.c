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

char *dem_read_file(const char *path, size_t *out_size) {
    FILE *file = fopen(path, "rb");
    char *bytes = NULL;
    size_t size = 0, got = 1;
    while (file && got > 0) {
        dem_grow(&bytes, size + 65536, 1);
        got = fread(bytes + size, 1, 65535, file);
        size += got;
    }
    if (!file || ferror(file))
        dem_quit("%.400s: it cannot be read: %s", path, strerror(errno));
    fclose(file);
    bytes[size] = 0;
    *out_size = size;
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
    FILE *file = fdopen(descriptor, "wb");
    if (!file) {
        unlink(out->temporary);
        errno = ENOMEM;
    }
    return file;
}

dem_file dem_open_file(dem *d, const char *path) {
    struct stat old;
    const bool exists = stat(path, &old) == 0;
    if (exists && !S_ISREG(old.st_mode)) /* a device would be replaced by a file */
        dem_fail(d, "%.400s: it is there, and is not a file", path);
    dem_file out = {.path = path, .target = exists ? realpath(path, NULL) : strdup(path)}; /* a link stays one */
    out.file = out.target ? open_temporary(&out, exists ? &old : NULL) : NULL;
    const int reason = errno;
    if (!out.file) {
        free(out.target);
        free(out.temporary);
        dem_fail(d, "%.400s: %s", path, strerror(reason));
    }
    return out;
}

void dem_close_file(dem *d, dem_file *file) {
    errno = 0;
    const bool written = fflush(file->file) == 0 && !ferror(file->file);
    int reason = errno ? errno : EIO; /* an error that was earlier than the last flush has left none */
    const bool closed = fclose(file->file) == 0, ok = written && closed && rename(file->temporary, file->target) == 0;
    reason = written ? errno : reason;
    if (!ok)
        unlink(file->temporary);
    free(file->target);
    free(file->temporary);
    if (!ok)
        dem_fail(d, "%.400s: %s", file->path, strerror(reason));
}
