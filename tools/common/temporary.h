/* SPDX-License-Identifier: MIT
 *
 * temporary.h - a file beside its target, under another name until it is complete: rename() then gives it the target's.
 */
#ifndef NARC_TOOL_TEMPORARY_H
#define NARC_TOOL_TEMPORARY_H

#include <stdio.h>
#include <sys/stat.h>

/* The file that a path means, symbolic links followed, always by the same name; the caller's to free. NULL, and errno, if
 * neither it nor its folder exists. */
char *find_target(const char *path);

/* Opens a temporary file beside a target, with owner (where that is allowed) and permissions of the file that it will
 * replace, or (`old` NULL) with those that the user's mask allows. A file that is read-only is not replaced: EACCES or
 * EROFS. The new file's name, the caller's to remove and to free, is told before the file is there, so that a signal
 * handler can remove it. NULL, and errno, if it cannot be opened. */
FILE *open_temporary(const char *target, const struct stat *old, char *volatile *out_name);

#endif
