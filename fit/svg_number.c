/* SPDX-License-Identifier: MIT
 *
 * svg_number.c - numbers and lengths in the attributes of an SVG file.
 */
#include "svg_number.h"

#include <math.h>
#include <string.h>

#include "number.h"

narc_status narc_set_fault(narc_svg_fault *fault, narc_status status, const char *problem, const char *at,
                           double value) {
    fault->status = status;
    fault->problem = problem;
    fault->at = at;
    fault->value = value;
    return status;
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

const char *narc_skip_space(const char *text) {
    while (*text == ' ' || (*text >= '\t' && *text <= '\r')) {
        text++;
    }
    return text;
}

const char *narc_skip_comma(const char *text) {
    text = narc_skip_space(text);
    return *text == ',' ? narc_skip_space(text + 1) : text;
}

static const char *skip_digits(const char *text) {
    while (is_digit(*text)) {
        text++;
    }
    return text;
}

static const char *skip_sign(const char *text) { return text + (*text == '+' || *text == '-'); }

/* Behind an exponent, if it has digits. */
static const char *skip_exponent(const char *text) {
    if (*text != 'e' && *text != 'E') {
        return text;
    }
    const char *digits = skip_sign(text + 1);
    return is_digit(*digits) ? skip_digits(digits) : text;
}

bool narc_take_number(const char **text, double *out_number) {
    const char *start = skip_sign(*text), *whole = skip_digits(start), *end = whole;
    if (*whole == '.') {
        end = skip_digits(whole + 1);
    }
    if (end - start - (*whole == '.') == 0) {
        return false; /* no digit */
    }
    end = skip_exponent(end);
    if (!narc_parse_number(*text, (size_t)(end - *text), out_number)) {
        return false;
    }
    *text = end;
    return true;
}

/* Lengths in pixels, 96 to the inch. */
static const struct unit {
    const char *name;
    double pixels;
} units[] = {{"", 1},    {"px", 1},         {"mm", 96 / 25.4}, {"cm", 96 / 2.54},
             {"in", 96}, {"pt", 96.0 / 72}, {"pc", 16},        {"Q", 96 / 101.6}};

narc_status narc_parse_length(const char *text, double whole, double *out_length, narc_svg_fault *fault) {
    const char *at = narc_skip_space(text);
    double number;
    if (!narc_take_number(&at, &number)) {
        return narc_set_fault(fault, NARC_ERROR_FORMAT, "a length is missing", at, 0);
    }
    size_t size = strlen(at);
    while (size && narc_skip_space(at + size - 1) == at + size) {
        size--;
    }
    double scale = 0;
    if (size == 1 && *at == '%') {
        if (isnan(whole)) {
            return narc_set_fault(fault, NARC_ERROR_FORMAT, "a percentage of a size that is not told", text, number);
        }
        scale = whole / 100;
    }
    for (size_t k = 0; k < sizeof(units) / sizeof(units[0]); k++) {
        if (size == strlen(units[k].name) && memcmp(at, units[k].name, size) == 0) {
            scale = units[k].pixels;
        }
    }
    if (scale == 0 && !(size == 1 && *at == '%')) {
        return narc_set_fault(fault, NARC_ERROR_FORMAT, "a length in a unit that is not known", text, number);
    }
    if (!isfinite(number * scale)) {
        return narc_set_fault(fault, NARC_ERROR_NOT_FINITE, "a length that is not finite", text, number);
    }
    *out_length = number * scale;
    return NARC_OK;
}
