/* SPDX-License-Identifier: MIT
 *
 * files.c - output files that appear whole or not at all.
 */
#define _XOPEN_SOURCE 700 /* stat, unlink */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "dem.h"
#include "temporary.h"

enum { ERROR_SIZE = 512 };

static bool fail_file(const char *path, char *error) {
    snprintf(error, ERROR_SIZE, "%.400s: %s", path, strerror(errno));
    return false;
}

static void forget(dem_file *out) {
    free(out->target);
    free(out->temporary);
    *out = (dem_file){0};
}

bool dem_open_file(dem_file *out, const char *path, char *error) {
    struct stat old;
    const bool exists = stat(path, &old) == 0;
    *out = (dem_file){.path = path};
    if (exists && !S_ISREG(old.st_mode)) { /* a device would be replaced by a file */
        snprintf(error, ERROR_SIZE, "%.400s: it is there, and is not a file", path);
        return false;
    }
    out->target = find_target(path);
    if (out->target)
        out->file = open_temporary(out->target, exists ? &old : NULL, &out->temporary);
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
