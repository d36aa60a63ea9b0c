/* SPDX-License-Identifier: MIT
 *
 * csv.c - tables as spreadsheets write them, row by row.
 */
#include "csv.h"

#include <string.h>

#include "error.h"
#include "number.h"

static const char BLANKS[] = " \t\r";

static char find_separator(const char *row) {
    static const char separators[] = ";\t,";
    for (const char *s = separators; *s; s++) {
        bool is_quoted = false;
        for (const char *c = row; *c; c++) {
            is_quoted ^= *c == '"';
            if (*c == *s && !is_quoted)
                return *s;
        }
    }
    return ' ';
}

/* Copies what is between quotes to `field`; returns the text behind the closing quote, NULL if there is none. */
static char *unquote(char *field, char **out_end) {
    char *c = field + 1;
    for (; *c && (*c != '"' || c[1] == '"'); c++) {
        c += *c == '"';
        *field++ = *c;
    }
    *out_end = field;
    return *c ? c + 1 : NULL;
}

/* Cuts a row into fields; false where quotes are wrong. */
static bool split(narc_csv *csv, char *c) {
    const char separator[2] = {csv->separator, 0};
    const bool by_blanks = csv->separator == ' ';
    const char *blanks = csv->separator == '\t' ? " \r" : BLANKS;
    bool is_empty = true;
    csv->count = 0;
    for (bool more = true; more; csv->count++) {
        char *field = c += strspn(c, blanks), *end;
        if (*c == '"') {
            c = unquote(field, &end);
            if (!c || !(*c == 0 || strchr(blanks, *c) || *c == csv->separator))
                return false;
        } else {
            end = c += strcspn(c, by_blanks ? blanks : separator);
            while (end > field && strchr(blanks, end[-1]))
                end--;
        }
        c += strspn(c, blanks);
        more = *c;
        if (more && !by_blanks && *c++ != csv->separator)
            return false;
        *end = 0;
        is_empty = is_empty && end == field;
        if (csv->count < NARC_CSV_COLUMNS)
            csv->fields[csv->count] = field;
    }
    csv->count = is_empty ? 0 : csv->count;
    return true;
}

narc_status narc_read_row(narc_csv *csv, bool *out_found, narc_error *error) {
    char *row = csv->rest, *end = strchr(row, '\n');
    *out_found = *row;
    if (!*row)
        return NARC_OK;
    csv->rest = end ? end + 1 : row + strlen(row);
    csv->line++;
    csv->row = narc_make_excerpt(row + strspn(row, BLANKS));
    if (end)
        *end = 0;
    csv->count = 0;
    if (!row[strspn(row, BLANKS)])
        return NARC_OK;
    if (!csv->separator)
        csv->separator = find_separator(row);
    return split(csv, row) ? NARC_OK
                           : narc_fail(error, NARC_ERROR_FORMAT, csv->line, 0,
                                       "line %zu: a field in quotes does not end, or more follows it: '%s'", csv->line,
                                       csv->row.text);
}

static bool is_name(const char *field, const char *name) {
    for (; *field && *name; field++, name++)
        if ((*field >= 'A' && *field <= 'Z' ? *field - 'A' + 'a' : *field) != *name)
            return false;
    return !*field && !*name;
}

narc_status narc_find_column(const narc_csv *csv, const char *name, bool is_required, size_t *out_column,
                             narc_error *error) {
    size_t found = csv->count;
    for (size_t k = 0; k < csv->count && k < NARC_CSV_COLUMNS; k++) {
        if (is_name(csv->fields[k], name)) {
            if (found < csv->count)
                return narc_fail(error, NARC_ERROR_FORMAT, csv->line, 0,
                                 "line %zu: the header has two columns '%s': '%s'", csv->line, name, csv->row.text);
            found = k;
        }
    }
    if (is_required && found == csv->count)
        return narc_fail(error, NARC_ERROR_FORMAT, csv->line, 0, "line %zu: the header has no column '%s': '%s'",
                         csv->line, name, csv->row.text);
    *out_column = found;
    return NARC_OK;
}

const char *narc_read_number(narc_csv *csv, size_t column, double *out_value) {
    char *field = csv->fields[column], *comma = strchr(field, ',');
    const char point = comma ? ',' : strchr(field, '.') ? '.' : 0;
    if (comma)
        *comma = '.';
    const bool is_number = narc_parse_number(field, strlen(field), out_value);
    if (comma)
        *comma = ',';
    if (!is_number)
        return "is not a number";
    if (comma && csv->separator != ';' && csv->separator != '\t')
        return "has a decimal comma, but fields are not separated by semicolons or tabs";
    if (point && csv->point && point != csv->point)
        return "has a decimal point, others before it a comma, or the other way round";
    csv->point = point ? point : csv->point;
    return NULL;
}
