/* SPDX-License-Identifier: MIT
 *
 * options.h - the command line of one command: --name value, --name=value, --flag, operands.
 */
#ifndef NARC_TOOL_OPTIONS_H
#define NARC_TOOL_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What an option may take besides nothing (false) and a value (true): the name of a file that is read, as operands are, "-"
 * for one of all these; the name of one that is written, without {name}. */
enum { INPUT_FILE = 2, OUTPUT_FILE };

typedef struct option {
    const char *name;     /* with its dashes */
    unsigned takes_value; /* false, true, INPUT_FILE or OUTPUT_FILE */
    const char *value;    /* NULL: not given; "" for a flag that was */
} option;

/* Fills in the options, and the operands if there is a name for them: one or more, in order, into `operands` with room
 * for `argc`. Returns their number. Without a name an operand is an error. */
size_t parse_options(int argc, char **argv, option *options, size_t option_count, const char *operand_name,
                     const char **operands);

/* The value of an option that must be given. */
const char *required_option(const option *given);

/* The value as a number between limits, which `range` describes ("more than 0"), or `otherwise` if the option is not
 * given; as a whole number from `smallest` to `largest`. */
double number_option(const option *given, double low, double high, const char *range, double otherwise);
uint64_t whole_option(const option *given, uint64_t smallest, uint64_t largest);

#endif
