/* SPDX-License-Identifier: MIT
 *
 * files.c - output files that appear whole or not at all.
 */
#define _XOPEN_SOURCE 700 /* mkstemp, fchmod */
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

bool dem_open_file(dem_file *out, const char *path, char *error) {
    const mode_t mask = umask(0);
    umask(mask);
    struct stat old;
    out->file = NULL;
    if (stat(path, &old) == 0 && !S_ISREG(old.st_mode)) { /* a device would be replaced by a file */
        snprintf(error, ERROR_SIZE, "%.400s: it is there, and is not a file", path);
        return false;
    }
    const int length = snprintf(out->path, sizeof out->path, "%s", path);
    if (length < 0 || (size_t)length >= sizeof out->path) {
        errno = ENAMETOOLONG;
        return fail_file(path, error);
    }
    snprintf(out->temporary, sizeof out->temporary, "%s.XXXXXX", path);
    const int descriptor = mkstemp(out->temporary);
    if (descriptor < 0)
        return fail_file(path, error);
    fchmod(descriptor, 0666 & ~mask);
    out->file = fdopen(descriptor, "wb");
    return out->file ? true : fail_file(path, error);
}

bool dem_close_file(dem_file *out, bool ok, char *error) {
    errno = 0;
    const bool flushed = fflush(out->file) == 0, written = flushed && !ferror(out->file);
    const int reason = errno ? errno : EIO; /* an error that was earlier than the last flush has left none */
    const bool closed = fclose(out->file) == 0;
    if (ok && written && closed && rename(out->temporary, out->path) == 0)
        return true;
    if (ok) {
        errno = written ? errno : reason;
        fail_file(out->path, error);
    }
    unlink(out->temporary);
    return false;
}
