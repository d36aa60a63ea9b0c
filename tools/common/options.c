/* SPDX-License-Identifier: MIT
 *
 * options.c - the command line of one command.
 */
#include "options.h"

#include <inttypes.h>
#include <string.h>

#include "fail.h"
#include "output.h"
#include "text.h"

static option *find_option(option *options, size_t count, const char *name, size_t length) {
    for (size_t i = 0; i < count; i++)
        if (strlen(options[i].name) == length && memcmp(options[i].name, name, length) == 0)
            return &options[i];
    return NULL;
}

/* One argument that begins with dashes; returns how many arguments it used. */
static int parse_option(int argc, char **argv, option *options, size_t count) {
    const char *argument = argv[0];
    const char *equals = strchr(argument, '=');
    const size_t length = equals ? (size_t)(equals - argument) : strlen(argument);
    option *found = find_option(options, count, argument, length);
    if (!found)
        fail("unknown option '%s'", narc_make_excerpt(argument).text);
    if (found->value)
        fail("%s is given twice", found->name);
    if (!found->takes_value) {
        if (equals)
            fail("%s takes no value, not '%s'", found->name, narc_make_excerpt(equals + 1).text);
        found->value = "";
        return 1;
    }
    if (equals)
        found->value = equals + 1;
    else if (argc > 1 && strncmp(argv[1], "--", 2) != 0)
        found->value = argv[1];
    if (!found->value || !*found->value)
        fail("%s needs a value", found->name);
    if (found->takes_value == OUTPUT_FILE && strstr(found->value, NAME_MARK))
        fail("%s is one file, it takes no " NAME_MARK, found->name);
    return equals ? 1 : 2;
}

size_t parse_options(int argc, char **argv, option *options, size_t option_count, const char *operand_name,
                     const char **operands) {
    size_t found = 0;
    bool only_operands = false;
    for (int i = 0; i < argc;) {
        if (!only_operands && strcmp(argv[i], "--") == 0) {
            only_operands = true;
            i++;
        } else if (!only_operands && argv[i][0] == '-' && argv[i][1]) {
            i += parse_option(argc - i, argv + i, options, option_count);
        } else if (operand_name) {
            operands[found++] = argv[i++];
        } else {
            fail("unexpected argument '%s'", narc_make_excerpt(argv[i]).text);
        }
    }
    if (operand_name && found == 0)
        fail("%s is missing", operand_name);
    size_t standard = 0;
    for (size_t k = 0; k < found; k++)
        standard += strcmp(operands[k], "-") == 0;
    for (size_t k = 0; k < option_count; k++)
        standard += options[k].takes_value == INPUT_FILE && options[k].value && strcmp(options[k].value, "-") == 0;
    if (standard > 1)
        fail("only one input may be -, standard input");
    return found;
}

const char *required_option(const option *given) {
    if (!given->value)
        fail("%s is missing", given->name);
    return given->value;
}

double number_option(const option *given, double low, double high, const char *range, double otherwise) {
    double value;
    if (!given->value)
        return otherwise;
    if (!parse_number(given->value, &value) || !(value >= low && value <= high))
        fail("%s must be a number %s, not '%s'", given->name, range, narc_make_excerpt(given->value).text);
    return value;
}

uint64_t whole_option(const option *given, uint64_t smallest, uint64_t largest) {
    uint64_t value;
    if (!parse_whole(required_option(given), largest, &value) || value < smallest) {
        fail("%s must be a whole number from %" PRIu64 " to %" PRIu64 ", not '%s'", given->name, smallest, largest,
             narc_make_excerpt(given->value).text);
    }
    return value;
}
