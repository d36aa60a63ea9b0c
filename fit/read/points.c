/* SPDX-License-Identifier: MIT
 *
 * points.c - points from CSV and JSON. Errors name the line, or the point and its contour, and what stands there.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "csv.h"
#include "error.h"
#include "json.h"
#include "outline/path.h"

/* ---------------------------------------------------------------------------- contours of points */

struct pen {
    narc_path *path;
    size_t count; /* points of the current contour */
    narc_point last;
};

static narc_status add_point(struct pen *pen, narc_point p, narc_error *error) {
    const narc_status status = pen->count ? narc_line_to(pen->path, &p, error) : narc_move_to(pen->path, &p, error);
    pen->count += !status;
    pen->last = p;
    return status;
}

/* A contour of one point has a line of no length, so that it counts as drawn. */
static narc_status end_contour(struct pen *pen, narc_error *error) {
    const narc_status status = pen->count == 1 ? narc_line_to(pen->path, &pen->last, error) : NARC_OK;
    pen->count = 0;
    return status;
}

/* Is a number that was read a coordinate? `where` names it, and `line` its line, if that is known. */
static narc_status check_value(double value, size_t line, const char *where, narc_error *error) {
    if (!isfinite(value))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, line, value, "%s is not finite", where);
    if (fabs(value) > NARC_MAX_COORDINATE) {
        return narc_fail(error, NARC_ERROR_SIZE, line, value, "%s is %.10g, coordinates reach up to %g", where, value,
                         NARC_MAX_COORDINATE);
    }
    return NARC_OK;
}

/* ---------------------------------------------------------------------------- CSV */

/* Where x, y and z are in the rows of a table. */
struct columns {
    size_t count, x, y, z; /* z == count: no column is looked at as z */
    double plane;          /* the z of the first row */
};

static narc_status read_field(narc_csv *csv, size_t column, const char *name, double *out_value, narc_error *error) {
    char where[32];
    snprintf(where, sizeof where, "line %zu: %s", csv->line, name);
    const char *wrong = narc_read_number(csv, column, out_value);
    const narc_excerpt shown = narc_make_excerpt(csv->fields[column]);
    if (wrong)
        return narc_fail(error, NARC_ERROR_FORMAT, csv->line, 0, "%s %s: '%s'", where, wrong, shown.text);
    if (!isfinite(*out_value)) {
        return narc_fail(error, NARC_ERROR_NOT_FINITE, csv->line, *out_value, "%s is not finite: '%s'", where,
                         shown.text);
    }
    return check_value(*out_value, csv->line, where, error);
}

/* A row with a column x or y, or without any number. */
static bool is_header(narc_csv csv) {
    bool has_number = false;
    for (size_t k = 0; k < csv.count && k < NARC_CSV_COLUMNS; k++) {
        double value;
        const char *name = csv.fields[k];
        if ((name[0] == 'x' || name[0] == 'X' || name[0] == 'y' || name[0] == 'Y') && !name[1])
            return true;
        has_number = has_number || !narc_read_number(&csv, k, &value);
    }
    return !has_number;
}

/* What the first row tells: its names, or else that there are x and y, or x, y and z. */
static narc_status find_columns(narc_csv *csv, bool has_names, struct columns *out_columns, narc_error *error) {
    *out_columns = (struct columns){.count = csv->count, .x = 0, .y = 1, .z = has_names ? csv->count : 2};
    if (has_names) {
        const narc_status status = narc_find_column(csv, "x", true, &out_columns->x, error);
        return status ? status : narc_find_column(csv, "y", true, &out_columns->y, error);
    }
    if (csv->count < 2 || csv->count > 3) {
        return narc_fail(error, NARC_ERROR_FORMAT, csv->line, 0, "line %zu: not numbers 'x,y' or 'x,y,z': '%s'",
                         csv->line, csv->row.text);
    }
    return out_columns->z < csv->count ? read_field(csv, 2, "z", &out_columns->plane, error) : NARC_OK;
}

static narc_status read_point(struct pen *pen, narc_csv *csv, const struct columns *columns, narc_error *error) {
    narc_point p;
    double z = columns->plane;
    if (csv->count != columns->count) {
        return narc_fail(error, NARC_ERROR_FORMAT, csv->line, 0,
                         "line %zu: %zu columns where the first row has %zu: '%s'", csv->line, csv->count,
                         columns->count, csv->row.text);
    }
    narc_status status = read_field(csv, columns->x, "x", &p.x, error);
    status = status ? status : read_field(csv, columns->y, "y", &p.y, error);
    if (!status && columns->z < columns->count)
        status = read_field(csv, columns->z, "z", &z, error);
    if (!status && z != columns->plane) {
        return narc_fail(error, NARC_ERROR_FORMAT, csv->line, z,
                         "line %zu: z changes, but without a header that names x and y all points lie in a plane: '%s'",
                         csv->line, csv->row.text);
    }
    return status ? status : add_point(pen, p, error);
}

static narc_status read_rows(struct pen *pen, char *text, narc_error *error) {
    narc_csv csv = {.rest = text};
    struct columns columns = {0};
    bool is_found;
    narc_status status = narc_read_row(&csv, &is_found, error);
    for (; !status && is_found; status = status ? status : narc_read_row(&csv, &is_found, error)) {
        const bool is_first = csv.count > 0 && columns.count == 0, has_names = is_first && is_header(csv);
        if (is_first)
            status = find_columns(&csv, has_names, &columns, error);
        if (!status && csv.count == 0)
            status = end_contour(pen, error);
        else if (!status && !has_names)
            status = read_point(pen, &csv, &columns, error);
    }
    return status ? status : end_contour(pen, error);
}

/* ---------------------------------------------------------------------------- JSON */

struct json_reader {
    size_t contour, point;
    struct pen pen;
    narc_error *error;
};

/* Reports a value that is not what it should be. */
static narc_status fail_value(const struct json_reader *reader, const cJSON *item, const char *what) {
    return narc_fail(reader->error, NARC_ERROR_FORMAT, 0, 0, "%s: '%s'", what, narc_show_json(item).text);
}

static narc_status read_coordinate(struct json_reader *reader, const cJSON *item, const char *axis, double *out_value) {
    char where[80], what[96];
    snprintf(where, sizeof where, "%s of point %zu of contour %zu", axis, reader->point, reader->contour);
    if (!cJSON_IsNumber(item)) {
        snprintf(what, sizeof what, "%s is not a number", where);
        return fail_value(reader, item, what);
    }
    *out_value = item->valuedouble;
    return check_value(*out_value, 0, where, reader->error);
}

static narc_status read_json_point(struct json_reader *reader, const cJSON *item) {
    const cJSON *x = cJSON_IsArray(item) ? item->child : NULL, *y = x ? x->next : NULL;
    if (!y || y->next) {
        char what[96];
        snprintf(what, sizeof what, "point %zu of contour %zu is not a list of two numbers", reader->point,
                 reader->contour);
        return fail_value(reader, item, what);
    }
    narc_point p = {0};
    narc_status status = read_coordinate(reader, x, "x", &p.x);
    status = status ? status : read_coordinate(reader, y, "y", &p.y);
    return status ? status : add_point(&reader->pen, p, reader->error);
}

static narc_status read_json_contour(struct json_reader *reader, const cJSON *list) {
    if (!cJSON_IsArray(list) || !list->child) {
        char what[96];
        snprintf(what, sizeof what, "contour %zu is not a list of points", reader->contour);
        return fail_value(reader, list, what);
    }
    narc_status status = NARC_OK;
    reader->point = 0;
    for (const cJSON *item = list->child; item && !status; item = item->next, reader->point++)
        status = read_json_point(reader, item);
    return status ? status : end_contour(&reader->pen, reader->error);
}

/* A list of points, or of contours: what the first element's first element is tells which. */
static narc_status read_json_list(struct json_reader *reader, const cJSON *list) {
    if (!cJSON_IsArray(list))
        return fail_value(reader, list, "not a list of points or contours");
    if (!list->child)
        return fail_value(reader, list, "a list without points");
    const cJSON *first = list->child;
    if (!cJSON_IsArray(first) || !cJSON_IsArray(first->child))
        return read_json_contour(reader, list);
    narc_status status = NARC_OK;
    for (const cJSON *item = first; item && !status; item = item->next, reader->contour++)
        status = read_json_contour(reader, item);
    return status;
}

/* The list may be the value of a key; other keys are not looked at. */
static narc_status read_json_value(struct json_reader *reader, const cJSON *root) {
    if (!cJSON_IsObject(root))
        return read_json_list(reader, root);
    const cJSON *found = NULL;
    for (const cJSON *item = root->child; item; item = item->next) {
        if (strcmp(item->string, "points") == 0 || strcmp(item->string, "contours") == 0) {
            if (found)
                return fail_value(reader, item, "a second key 'points' or 'contours'");
            found = item;
        }
    }
    return found ? read_json_list(reader, found)
                 : fail_value(reader, root, "an object without a key 'points' or 'contours'");
}

static narc_status read_json_text(struct pen *pen, char *text, narc_error *error) {
    cJSON *root;
    narc_status status = narc_parse_json(text, &root, error);
    if (!status) {
        struct json_reader reader = {.pen = *pen, .error = error};
        status = read_json_value(&reader, root);
        cJSON_Delete(root);
    }
    return status;
}

/* ---------------------------------------------------------------------------- both */

typedef narc_status text_reader(struct pen *pen, char *text, narc_error *error);

/* Reads a copy of the data, which is cut into fields; takes everything back on error. */
static narc_status read_points(text_reader *read, const void *data, size_t size, narc_path *path, narc_error *error) {
    if (!data || !path)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", data ? "path" : "data");
    char *text = malloc(size + 1);
    if (!text)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for a text of %zu bytes", size);
    memcpy(text, data, size);
    text[size] = 0;
    const narc_path_mark mark = narc_mark_path(path);
    narc_status status = narc_clean_text(text, size, error);
    status = status ? status : read(&(struct pen){.path = path}, text, error);
    if (!status && !narc_is_drawn_since(path, mark))
        status = narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "no points: there is a header only");
    if (status)
        narc_rewind_path(path, mark);
    free(text);
    return status;
}

narc_status narc_read_csv(const void *data, size_t size, narc_path *path, narc_error *error) {
    return read_points(read_rows, data, size, path, error);
}

narc_status narc_read_json(const void *data, size_t size, narc_path *path, narc_error *error) {
    return read_points(read_json_text, data, size, path, error);
}
