/* SPDX-License-Identifier: MIT
 *
 * output.h - output files that appear whole or not at all, and never in place of an input.
 *
 * A file is written under a temporary name beside its target and renamed when everything has been written; an error or
 * a signal removes it. Standard output, devices and pipes are written directly.
 */
#ifndef NARC_TOOL_OUTPUT_H
#define NARC_TOOL_OUTPUT_H

#include <stdio.h>

/* Remembers a file that the command reads: no output may replace it. */
void protect_input(const char *path);

/* Opens an output; "-" is standard output. Two outputs cannot be the same file, and none can be an input. */
FILE *open_output(const char *path);

/* Of many outputs: says early what is wrong with one that is opened later; it is closed when it is written. */
void reserve_output(const char *path);
void close_output(FILE *file);

#define NAME_MARK "{name}"

/* A path with a body's name for each {name}, in which what paths cannot have is _, to be freed; NULL: it has no {name}. */
char *expand_pattern(const char *pattern, const char *name);

/* Writes out what an output has so far, and checks it: after the last line of a file, while the reason why it cannot be
 * written is known. */
void flush_output(FILE *file);

/* Writes everything out, checks it and clears the progress line. Returns where the report goes: to standard output, or
 * to standard error if an output is there. The files have no names yet, so that a report that cannot be printed leaves
 * no outputs either. */
FILE *finish_outputs(void);

/* Writes out what was printed to standard output or standard error, and checks it. */
void finish_report(FILE *file);

/* Gives the finished files their names. */
void commit_outputs(void);

/* Removes what was not committed. */
void discard_outputs(void);

#endif
