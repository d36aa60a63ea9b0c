/* SPDX-License-Identifier: MIT
 *
 * system.h - what POSIX and Windows do differently: system_posix.c, system_windows.c. Paths are UTF-8.
 */
#ifndef NARC_TOOL_SYSTEM_H
#define NARC_TOOL_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Call it first: makes the standard streams safe to use, and the arguments UTF-8. */
void start_system(int *argc, char ***argv);

/* Does standard error show escape sequences? */
bool is_terminal(void);

/* fopen(). */
FILE *open_file(const char *path, const char *mode);

/* What stands between a folder and a file, and the length of the part of a path that names its folder, with that. */
extern const char path_separator[];
size_t folder_length(const char *path);

/* The one name that a file or folder has, symbolic links followed; the caller's to free. NULL, and errno, if there is
 * none. */
char *find_real_path(const char *path);

/* Is something there that is no regular file, such as a device, a pipe or a folder? */
bool is_special(const char *path);

/* The paths of what a folder holds, hidden files left out, sorted by their bytes; the caller's to free, each and all. NULL
 * if it is no folder that can be read. */
char **list_folder(const char *path, size_t *out_count);

/* Opens a temporary file beside a target. Where that is there, the file has its owner (where that is allowed) and its
 * permissions, or else those that the user's mask allows. A target that is read-only is not to be replaced: EACCES or
 * EROFS. The new file's name, the caller's to remove and to free, is told before the file is there, so that a signal
 * handler can remove it. NULL, and errno, if it cannot be opened. */
FILE *open_temporary(const char *target, char *volatile *out_name);

/* Gives a closed file another file's name. False, and errno, if that fails. */
bool replace_file(const char *from, const char *target);

/* Removes a file, open or not. */
void remove_file(const char *path);

/* What ends the command from outside, or from a library that gives up without memory, calls `clean_up` first. A file that
 * grows beyond a limit is an error of writing. */
void watch_signals(void (*clean_up)(void));

/* From hear_interrupts(true) to hear_interrupts(false) the first Ctrl-C does not end the command but is told. */
void hear_interrupts(bool hear);
bool was_interrupted(void);

/* They no longer end the command, which is about to end itself. */
void ignore_signals(void);

#endif
