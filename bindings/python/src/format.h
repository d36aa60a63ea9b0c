/* SPDX-License-Identifier: MIT
 *
 * format.h - formats of the buffer protocol (PEP 3118): which numbers a buffer holds, and where fields of records lie.
 */
#ifndef NARC_FORMAT_H
#define NARC_FORMAT_H

#include <stdbool.h>
#include <stddef.h>

/* An item: one number, or several of a kind. Its code is that of struct; 'Z' is complex, 'T' a record. */
typedef struct item {
    char code, order;
    size_t offset, size, count; /* the size of one number */
    const char *name;           /* of a field, not NUL-terminated */
    size_t name_length;
} item;

/* The only number of a format (NULL: bytes). Or the field of records that is called like a member: "motion_x" is also number
 * 0 of a field "motion", and "y" number 1 of "xy". False: there is none, or the format is not understood. */
bool find_item(const char *format, const char *member, item *out);

/* In another order of bytes than this machine's? */
bool is_foreign(const item *of);

bool is_integer(const item *of);
bool is_signed(const item *of);

/* "float32"; for messages. */
const char *describe_item(const item *of);

#endif
