/* SPDX-License-Identifier: MIT
 *
 * format.c - reads formats of the buffer protocol.
 */
#include "format.h"

#include <stdint.h>
#include <string.h>

enum family { OTHER, UNSIGNED, SIGNED };

/* Codes with their size as the standard has it, and as this machine has it. */
static const struct code {
    char code;
    unsigned char size, native;
    enum family family;
    const char *name; /* of what is no whole number */
} codes[] = {{'I', 4, 4, UNSIGNED, NULL},
             {'f', 4, 4, OTHER, "float32"},
             {'d', 8, 8, OTHER, "float64"},
             {'e', 2, 2, OTHER, "float16"},
             {'g', sizeof(long double), sizeof(long double), OTHER, "long double"},
             {'?', 1, 1, OTHER, "bool"},
             {'b', 1, 1, SIGNED, NULL},
             {'B', 1, 1, UNSIGNED, NULL},
             {'h', 2, 2, SIGNED, NULL},
             {'H', 2, 2, UNSIGNED, NULL},
             {'i', 4, 4, SIGNED, NULL},
             {'l', 4, sizeof(long), SIGNED, NULL},
             {'L', 4, sizeof(long), UNSIGNED, NULL},
             {'q', 8, 8, SIGNED, NULL},
             {'Q', 8, 8, UNSIGNED, NULL},
             {'n', sizeof(void *), sizeof(void *), SIGNED, NULL},
             {'N', sizeof(void *), sizeof(void *), UNSIGNED, NULL},
             {'x', 1, 1, OTHER, "nothing"},
             {'c', 1, 1, OTHER, "characters"},
             {'s', 1, 1, OTHER, "text"},
             {'p', 1, 1, OTHER, "text"},
             {'w', 4, 4, OTHER, "text"},
             {'O', sizeof(void *), sizeof(void *), OTHER, "objects"},
             {'P', sizeof(void *), sizeof(void *), OTHER, "pointers"},
             {'T', 0, 0, OTHER, "records"},
             {'Z', 0, 0, OTHER, "complex numbers"}};

static const struct code *find_code(char code) {
    for (size_t k = 0; k < sizeof codes / sizeof *codes; k++)
        if (codes[k].code == code)
            return &codes[k];
    return NULL;
}

bool is_integer(const item *of) {
    const struct code *const code = find_code(of->code);
    return code && code->family != OTHER;
}

bool is_signed(const item *of) {
    const struct code *const code = find_code(of->code);
    return code && code->family == SIGNED;
}

const char *describe_item(const item *of) {
    static const char *const whole[2][4] = {{"uint8", "uint16", "uint32", "uint64"},
                                            {"int8", "int16", "int32", "int64"}};
    const struct code *const code = find_code(of->code);
    if (!code || code->family == OTHER)
        return code ? code->name : "something else";
    return whole[code->family == SIGNED][of->size == 8 ? 3 : of->size / 2];
}

bool is_foreign(const item *of) {
    const uint16_t one = 1;
    const bool little = *(const uint8_t *)&one == 1;
    return of->size > 1 && (of->order == '<' ? !little : (of->order == '>' || of->order == '!') && little);
}

/* Goes over orders of bytes, shapes "(3,2)" and repetitions; returns how many numbers there are. */
static size_t read_prefix(const char **format, char *order) {
    size_t count = 1;
    const char *p = *format;
    for (; *p && strchr("@=<>!^(,) \n0123456789", *p); p++) {
        if (strchr("@=<>!^", *p))
            *order = *p;
        if (*p < '0' || *p > '9')
            continue;
        size_t number = 0;
        for (; *p >= '0' && *p <= '9'; p++)
            number = number * 10 + (size_t)(*p - '0');
        count *= number;
        p--;
    }
    *format = p;
    return count;
}

/* Reads the next item, which lies from `end` on, and goes on behind it; false at the end, or where it is not understood. */
static bool next_item(const char **format, char *order, size_t *end, item *out) {
    const char *p = *format;
    *out = (item){.count = read_prefix(&p, order)};
    const bool is_complex = *p == 'Z';
    p += is_complex;
    const struct code *const code = find_code(*p);
    if (!code || (is_complex && !code->size))
        return false;
    out->code = is_complex ? 'Z' : *p;
    out->order = *order;
    if (*p++ == 'T') {
        item part;
        if (*p++ != '{')
            return false;
        while (*p && *p != '}')
            if (!next_item(&p, order, &out->size, &part))
                return false;
        p += *p == '}';
    } else {
        out->size = *order == '@' || *order == '^' ? code->native : code->size;
        if (*order == '@')
            *end = (*end + out->size - 1) / out->size * out->size;
        out->size *= is_complex ? 2 : 1;
    }
    if (*p == ':') {
        out->name = p + 1;
        out->name_length = strcspn(p + 1, ":");
        p += 1 + out->name_length;
        p += *p == ':';
    }
    out->offset = *end;
    *end += out->size * out->count;
    *format = p;
    return true;
}

static bool is_called(const item *field, const char *name, size_t length) {
    return field->name && field->name_length == length && memcmp(field->name, name, length) == 0;
}

bool find_item(const char *format, const char *member, item *out) {
    char order = '@';
    size_t end = 0;
    if (!format)
        format = "B";
    if (!member)
        return next_item(&format, &order, &end, out) && !*format && out->code != 'T';
    if (format[0] != 'T' || format[1] != '{')
        return false;
    const size_t length = strlen(member), which = (size_t)(member[length - 1] - 'x');
    const bool is_bare = length == 1, has_stem = length > 2 && member[length - 2] == '_';
    for (format += 2; next_item(&format, &order, &end, out);) {
        if (out->count == 1 && is_called(out, member, length))
            return true;
        if (out->count == 2 && which < 2 &&
            ((is_bare && is_called(out, "xy", 2)) || (has_stem && is_called(out, member, length - 2)))) {
            out->offset += which * out->size;
            return true;
        }
    }
    return false;
}
