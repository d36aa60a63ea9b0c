/* SPDX-License-Identifier: MIT
 *
 * read_points.c - points from CSV and JSON. Errors name the line and what stands there.
 */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "json_place.h"
#include "number.h"
#include "path.h"

static const char byte_order_mark[] = "\xef\xbb\xbf";

/* ---------------------------------------------------------------------------- what messages show */

/* A piece of the input, fit to be shown: not all of a long one, no half characters, nothing that is not printed. */
typedef struct excerpt {
    char text[48];
} excerpt;

static excerpt make_excerpt(const char *text, size_t size) {
    enum { LONGEST = 40 };
    excerpt made;
    size_t shown = size;
    if (size > LONGEST) {
        for (shown = LONGEST; shown > 0 && ((unsigned char)text[shown] & 0xc0) == 0x80;) {
            shown--;
        }
    }
    for (size_t i = 0; i < shown; i++) {
        const unsigned char c = (unsigned char)text[i];
        made.text[i] = c < 0x20 || c == 0x7f ? '?' : text[i];
    }
    strcpy(made.text + shown, shown < size ? "..." : "");
    return made;
}

static size_t line_of(const char *text, const char *place) {
    size_t line = 1;
    while ((text = memchr(text, '\n', (size_t)(place - text)))) {
        line++;
        text++;
    }
    return line;
}

/* ---------------------------------------------------------------------------- contours of points */

typedef struct pen {
    narc_path *path;
    size_t count; /* points of the current contour */
    narc_point last;
} pen;

static narc_status add_point(pen *with, narc_point p, narc_error *error) {
    const narc_status status = with->count ? narc_line_to(with->path, p, error) : narc_move_to(with->path, p, error);
    with->count += !status;
    with->last = p;
    return status;
}

/* A contour of one point has a line of no length, so that it counts as drawn. */
static narc_status end_contour(pen *with, narc_error *error) {
    const narc_status status = with->count == 1 ? narc_line_to(with->path, with->last, error) : NARC_OK;
    with->count = 0;
    return status;
}

/* Is a number that was read a coordinate? `name` says which, `text` is what stood there. */
static narc_status check_value(double value, size_t line, const char *name, excerpt text, narc_error *error) {
    if (!isfinite(value)) {
        return narc_fail(error, NARC_ERROR_NOT_FINITE, line, value, "line %zu: %s is not finite: '%s'", line, name,
                         text.text);
    }
    if (fabs(value) > NARC_MAX_COORDINATE) {
        return narc_fail(error, NARC_ERROR_SIZE, line, value, "line %zu: %s is '%s', coordinates reach up to %g", line,
                         name, text.text, NARC_MAX_COORDINATE);
    }
    return NARC_OK;
}

/* ---------------------------------------------------------------------------- CSV */

/* A stretch of the text. */
typedef struct span {
    const char *text;
    size_t size;
} span;

static span trim(span s) {
    while (s.size > 0 && strchr(" \t\r", s.text[0]) && s.text[0]) {
        s.text++;
        s.size--;
    }
    while (s.size > 0 && strchr(" \t\r", s.text[s.size - 1]) && s.text[s.size - 1]) {
        s.size--;
    }
    return s;
}

/* Letters of `word` are small ones; case does not count. */
static bool is_word(span s, const char *word) {
    if (s.size != strlen(word)) {
        return false;
    }
    for (size_t i = 0; i < s.size; i++) {
        const char c = s.text[i];
        if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != word[i]) {
            return false;
        }
    }
    return true;
}

/* What other programs write for numbers that are none. */
static bool is_not_finite(span s, double *out_value) {
    const bool is_signed = s.size > 0 && (s.text[0] == '-' || s.text[0] == '+');
    const span bare = {s.text + is_signed, s.size - is_signed};
    *out_value = is_word(bare, "nan") ? NAN : is_signed && s.text[0] == '-' ? -INFINITY : INFINITY;
    return isnan(*out_value) || is_word(bare, "inf") || is_word(bare, "infinity");
}

static narc_status read_field(span field, size_t line, const char *name, double *out_value, narc_error *error) {
    const excerpt shown = make_excerpt(field.text, field.size);
    if (!narc_parse_number(field.text, field.size, out_value) && !is_not_finite(field, out_value)) {
        return narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: %s is not a number: '%s'", line, name,
                         shown.text);
    }
    return check_value(*out_value, line, name, shown, error);
}

/* Splits "x,y". False if there is not exactly one comma. */
static bool split_line(span row, span *out_x, span *out_y) {
    const char *comma = memchr(row.text, ',', row.size);
    if (!comma) {
        return false;
    }
    const size_t before = (size_t)(comma - row.text), after = row.size - before - 1;
    *out_x = trim((span){row.text, before});
    *out_y = trim((span){comma + 1, after});
    return !memchr(comma + 1, ',', after);
}

/* One line that is not blank. */
static narc_status read_row(pen *with, span row, size_t line, bool may_be_header, narc_error *error) {
    span x, y;
    narc_point p;
    if (!split_line(row, &x, &y)) {
        return narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: not two numbers 'x,y': '%s'", line,
                         make_excerpt(row.text, row.size).text);
    }
    if (may_be_header && is_word(x, "x") && is_word(y, "y")) {
        return NARC_OK;
    }
    narc_status status = read_field(x, line, "x", &p.x, error);
    status = status ? status : read_field(y, line, "y", &p.y, error);
    return status ? status : add_point(with, p, error);
}

static narc_status read_rows(pen *with, span rest, narc_error *error) {
    bool may_be_header = true;
    narc_status status = NARC_OK;
    for (size_t line = 1; rest.size > 0 && !status; line++) {
        const char *end = memchr(rest.text, '\n', rest.size);
        const span whole = {rest.text, end ? (size_t)(end - rest.text) : rest.size}, row = trim(whole);
        const size_t used = whole.size + (end != NULL);
        rest = (span){rest.text + used, rest.size - used};
        if (row.size == 0) {
            status = end_contour(with, error);
        } else {
            status = read_row(with, row, line, may_be_header, error);
            may_be_header = false;
        }
    }
    return status ? status : end_contour(with, error);
}

/* ---------------------------------------------------------------------------- JSON */

typedef struct json_reader {
    const char *text;
    size_t steps[4]; /* to the value that is read: member, contour, point, coordinate, as far as they are there */
    size_t depth;
    bool has_contours; /* the contours are elements of a list */
    size_t contour, point;
    pen with;
    narc_error *error;
} json_reader;

/* Reports the value that is read. */
static narc_status fail_value(const json_reader *in, const char *what) {
    const char *place = narc_find_json_value(in->text, in->steps, in->depth);
    const size_t line = line_of(in->text, place);
    return narc_fail(in->error, NARC_ERROR_FORMAT, line, 0, "line %zu: %s: '%s'", line, what,
                     make_excerpt(place, narc_measure_json_value(place)).text);
}

static narc_status read_coordinate(json_reader *in, const cJSON *item, const char *axis, double *out_value) {
    char what[96];
    snprintf(what, sizeof what, "%s of point %zu of contour %zu", axis, in->point, in->contour);
    if (!cJSON_IsNumber(item)) {
        snprintf(what, sizeof what, "%s of point %zu of contour %zu is not a number", axis, in->point, in->contour);
        return fail_value(in, what);
    }
    *out_value = item->valuedouble;
    if (fabs(*out_value) <= NARC_MAX_COORDINATE) { /* looking for the line takes time */
        return NARC_OK;
    }
    const char *place = narc_find_json_value(in->text, in->steps, in->depth);
    return check_value(*out_value, line_of(in->text, place), what, make_excerpt(place, narc_measure_json_value(place)),
                       in->error);
}

static narc_status read_json_point(json_reader *in, const cJSON *item) {
    const cJSON *x = cJSON_IsArray(item) ? item->child : NULL, *y = x ? x->next : NULL;
    if (!y || y->next) {
        char what[96];
        snprintf(what, sizeof what, "point %zu of contour %zu is not a list of two numbers", in->point, in->contour);
        return fail_value(in, what);
    }
    narc_point p;
    in->steps[in->depth++] = 0;
    narc_status status = read_coordinate(in, x, "x", &p.x);
    in->steps[in->depth - 1] = 1;
    status = status ? status : read_coordinate(in, y, "y", &p.y);
    in->depth--;
    return status ? status : add_point(&in->with, p, in->error);
}

static narc_status read_json_contour(json_reader *in, const cJSON *list) {
    if (!cJSON_IsArray(list) || !list->child) {
        char what[96];
        snprintf(what, sizeof what, "contour %zu is not a list of points", in->contour);
        return fail_value(in, what);
    }
    narc_status status = NARC_OK;
    in->point = 0;
    in->depth++;
    for (const cJSON *item = list->child; item && !status; item = item->next, in->point++) {
        in->steps[in->depth - 1] = in->point;
        status = read_json_point(in, item);
    }
    in->depth--;
    return status ? status : end_contour(&in->with, in->error);
}

/* A list of points, or of contours: what the first element's first element is tells which. */
static narc_status read_json_list(json_reader *in, const cJSON *list) {
    if (!cJSON_IsArray(list)) {
        return fail_value(in, "not a list of points or contours");
    }
    if (!list->child) {
        return fail_value(in, "a list without points");
    }
    const cJSON *first = list->child;
    if (!cJSON_IsArray(first) || !cJSON_IsArray(first->child)) {
        return read_json_contour(in, list);
    }
    narc_status status = NARC_OK;
    in->depth++;
    for (const cJSON *item = first; item && !status; item = item->next, in->contour++) {
        in->steps[in->depth - 1] = in->contour;
        status = read_json_contour(in, item);
    }
    in->depth--;
    return status;
}

/* The list may be the value of a key; other keys are not looked at. */
static narc_status read_json_value(json_reader *in, const cJSON *root) {
    if (!cJSON_IsObject(root)) {
        return read_json_list(in, root);
    }
    const cJSON *found = NULL;
    size_t step = 0;
    for (const cJSON *item = root->child; item; item = item->next, step++) {
        if (strcmp(item->string, "points") == 0 || strcmp(item->string, "contours") == 0) {
            in->depth = 1;
            in->steps[0] = step;
            if (found) {
                return fail_value(in, "a second key 'points' or 'contours'");
            }
            found = item;
        }
    }
    return found ? read_json_list(in, found) : fail_value(in, "an object without a key 'points' or 'contours'");
}

static narc_status fail_syntax(const char *text, const char *place, narc_error *error) {
    const size_t line = line_of(text, place);
    return *place ? narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: not valid JSON here: '%s'", line,
                              make_excerpt(place, strcspn(place, "\r\n")).text)
                  : narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: not valid JSON: it ends too early", line);
}

/* `text` ends with a NUL byte behind its `size` bytes. */
static narc_status parse_json(const char *text, size_t size, pen with, narc_error *error) {
    const char *nul = memchr(text, 0, size), *end = text;
    if (nul) {
        const size_t line = line_of(text, nul);
        return narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: a NUL byte", line);
    }
    cJSON *root = cJSON_ParseWithLengthOpts(text, size + 1, &end, true);
    if (!root) {
        return fail_syntax(text, end, error);
    }
    json_reader in = {.text = text, .with = with, .error = error};
    const narc_status status = read_json_value(&in, root);
    cJSON_Delete(root);
    return status;
}

/* ---------------------------------------------------------------------------- both */

/* The text without a byte order mark and with a NUL byte behind it, or NULL. To be freed. */
static char *copy_text(span s) {
    char *text = malloc(s.size + 1);
    if (text) {
        memcpy(text, s.text, s.size);
        text[s.size] = 0;
    }
    return text;
}

static narc_status check_input(const void *data, const narc_path *path, span *out_text, narc_error *error) {
    const size_t mark = sizeof byte_order_mark - 1;
    if (!data || !path) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", data ? "path" : "data");
    }
    if (out_text->size >= mark && memcmp(data, byte_order_mark, mark) == 0) {
        *out_text = (span){(const char *)data + mark, out_text->size - mark};
    }
    for (size_t i = 0; i < out_text->size; i++) {
        if (!strchr(" \t\r\n", out_text->text[i]) || !out_text->text[i]) {
            return NARC_OK;
        }
    }
    return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "no points: the text is empty");
}

narc_status narc_read_csv(const void *data, size_t size, narc_path *path, narc_error *error) {
    span text = {data, size};
    narc_status status = check_input(data, path, &text, error);
    if (status) {
        return status;
    }
    const narc_path_mark mark = narc_mark_path(path);
    status = read_rows(&(pen){.path = path}, text, error);
    if (!status && !narc_is_drawn_since(path, mark)) {
        status = narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "no points: there is a header only");
    }
    if (status) {
        narc_rewind_path(path, mark);
    }
    return status;
}

narc_status narc_read_json(const void *data, size_t size, narc_path *path, narc_error *error) {
    span text = {data, size};
    narc_status status = check_input(data, path, &text, error);
    if (status) {
        return status;
    }
    char *copy = copy_text(text);
    if (!copy) {
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for a text of %zu bytes", size);
    }
    const narc_path_mark mark = narc_mark_path(path);
    status = parse_json(copy, text.size, (pen){.path = path}, error);
    if (status) {
        narc_rewind_path(path, mark);
    }
    free(copy);
    return status;
}
