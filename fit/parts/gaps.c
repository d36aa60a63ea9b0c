/* SPDX-License-Identifier: MIT
 *
 * gaps.c - how far convex polygons reach out of a region. A grid knows it roughly (Felzenszwalb and Huttenlocher's
 * distance transform); where that does not decide, cells are halved until distances that are computed exactly do: no
 * point of a cell is further from the region than its centre by more than the cell's half diagonal.
 */
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/vector.h"
#include "parts/region.h"

/* Cells along the longer side, and in a bucket's; a cell more around all. */
enum { CELLS = 384, BUCKET = 8, MARGIN = 1 };

/* What is told of the largest distance, in parts of the extent. */
static const double PRECISION = 1.0 / 2048;

/* Half of a cell's diagonal, in cells. */
static const double REACH = 0.7072;

static size_t count_lines(const narc_region *region) { return region->kept_ends[region->count - 1]; }

static bool list_lines(narc_region *region) {
    region->lines = malloc(count_lines(region) * sizeof *region->lines);
    for (size_t k = 0, begin = 0; region->lines && k < region->count; begin = region->kept_ends[k++]) {
        for (size_t i = begin; i < region->kept_ends[k]; i++) {
            const size_t next = i + 1 < region->kept_ends[k] ? i + 1 : begin;
            region->lines[i] = (narc_line){region->points[region->kept[i]], region->points[region->kept[next]]};
        }
    }
    return region->lines;
}

/* ---------------------------------------------------------------------------- buckets */

static size_t clamp(double value, size_t count) {
    return value < 0 ? 0 : value >= (double)count ? count - 1 : (size_t)value;
}

static size_t bucket_columns(const narc_region *region) { return (region->columns + BUCKET - 1) / BUCKET; }
static size_t bucket_rows(const narc_region *region) { return (region->rows + BUCKET - 1) / BUCKET; }

struct bucket_range {
    size_t left, right, low, high;
};

static struct bucket_range find_buckets(const narc_region *region, narc_point a, narc_point b) {
    const double size = BUCKET * region->cell;
    return (struct bucket_range){clamp((fmin(a.x, b.x) - region->corner.x) / size, bucket_columns(region)),
                                 clamp((fmax(a.x, b.x) - region->corner.x) / size, bucket_columns(region)),
                                 clamp((fmin(a.y, b.y) - region->corner.y) / size, bucket_rows(region)),
                                 clamp((fmax(a.y, b.y) - region->corner.y) / size, bucket_rows(region))};
}

/* Counts lines (items NULL) or lists them, which moves each end to where it belongs. */
static void fill_buckets(const narc_region *region, uint32_t *ends, uint32_t *items, uint32_t *row_ends,
                         uint32_t *row_items) {
    for (size_t k = count_lines(region); k-- > 0;) {
        const narc_point a = region->lines[k].a, b = region->lines[k].b;
        const struct bucket_range at = find_buckets(region, a, b);
        for (size_t row = at.low; row <= at.high; row++) {
            if (items)
                row_items[--row_ends[row]] = (uint32_t)k;
            else
                row_ends[row]++;
            for (size_t column = at.left; column <= at.right; column++) {
                uint32_t *end = &ends[row * bucket_columns(region) + column];
                if (items)
                    items[--*end] = (uint32_t)k;
                else
                    ++*end;
            }
        }
    }
}

static uint32_t sum_up(uint32_t *counts, size_t count) {
    for (size_t k = 1; k < count; k++)
        counts[k] += counts[k - 1];
    return counts[count - 1];
}

/* Afterwards the items of bucket k are those from ends[k] to ends[k + 1]. */
static bool make_buckets(narc_region *region) {
    const size_t rows = bucket_rows(region), count = rows * bucket_columns(region);
    region->bucket_ends = calloc(count + 1, sizeof *region->bucket_ends);
    region->row_ends = calloc(rows + 1, sizeof *region->row_ends);
    if (!region->bucket_ends || !region->row_ends)
        return false;
    fill_buckets(region, region->bucket_ends, NULL, region->row_ends, NULL);
    region->bucket_items = malloc(sum_up(region->bucket_ends, count + 1) * sizeof *region->bucket_items);
    region->row_items = malloc(sum_up(region->row_ends, rows + 1) * sizeof *region->row_items);
    if (!region->bucket_items || !region->row_items)
        return false;
    fill_buckets(region, region->bucket_ends, region->bucket_items, region->row_ends, region->row_items);
    return true;
}

static bool is_in_region(const narc_region *region, narc_point p) {
    const size_t row = clamp((p.y - region->corner.y) / (BUCKET * region->cell), bucket_rows(region));
    int winding = 0;
    for (uint32_t i = region->row_ends[row]; i < region->row_ends[row + 1]; i++) {
        const narc_point a = region->lines[region->row_items[i]].a, b = region->lines[region->row_items[i]].b;
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
            winding += b.y > a.y ? 1 : -1;
    }
    return winding != 0;
}

/* The squared distance to the lines of one bucket, or `best` if that is less. */
static double search_bucket(const narc_region *region, narc_point p, size_t bucket, double best) {
    for (uint32_t i = region->bucket_ends[bucket]; i < region->bucket_ends[bucket + 1]; i++) {
        const narc_line *line = &region->lines[region->bucket_items[i]];
        best = fmin(best, side_distance(p, line->a, line->b));
    }
    return best;
}

/* Rings of buckets, until what is left is further away than the best. */
static double find_distance(const narc_region *region, narc_point p) {
    if (is_in_region(region, p))
        return 0;
    const double size = BUCKET * region->cell;
    const ptrdiff_t columns = (ptrdiff_t)bucket_columns(region), rows = (ptrdiff_t)bucket_rows(region);
    const ptrdiff_t x = (ptrdiff_t)clamp((p.x - region->corner.x) / size, (size_t)columns);
    const ptrdiff_t y = (ptrdiff_t)clamp((p.y - region->corner.y) / size, (size_t)rows);
    double best = INFINITY;
    for (ptrdiff_t ring = 0; ring <= columns + rows; ring++) {
        if (ring && best <= ((double)ring - 1) * size * ((double)ring - 1) * size)
            break;
        for (ptrdiff_t row = y - ring; row <= y + ring; row++) {
            const ptrdiff_t step = row == y - ring || row == y + ring || ring == 0 ? 1 : 2 * ring;
            for (ptrdiff_t column = x - ring; column <= x + ring; column += step)
                if (row >= 0 && row < rows && column >= 0 && column < columns)
                    best = search_bucket(region, p, (size_t)(row * columns + column), best);
        }
    }
    return sqrt(best);
}

/* ---------------------------------------------------------------------------- the grid */

static narc_point center_of(const narc_region *region, size_t row, size_t column) {
    return (narc_point){region->corner.x + ((double)column + 0.5) * region->cell,
                        region->corner.y + ((double)row + 0.5) * region->cell};
}

/* Winding numbers of centres, as differences along rows; then cells that a line passes. */
static void draw_region(const narc_region *region, int *windings, float *squares) {
    for (size_t k = 0, count = count_lines(region); k < count; k++) {
        const narc_point a = region->lines[k].a, b = region->lines[k].b;
        const double low = (fmin(a.y, b.y) - region->corner.y) / region->cell - 0.5;
        const double high = (fmax(a.y, b.y) - region->corner.y) / region->cell - 0.5;
        for (double row = ceil(low); row < high; row++) {
            const double y = region->corner.y + (row + 0.5) * region->cell;
            const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            const size_t column = clamp(ceil((x - region->corner.x) / region->cell - 0.5), region->columns);
            windings[(size_t)row * region->columns + column] += b.y > a.y ? -1 : 1;
        }
        const double steps = ceil(2 * length(minus(b, a)) / region->cell) + 1;
        for (double step = 0; step <= steps; step++) {
            const narc_point p = along(a, step / steps, minus(b, a));
            const size_t column = clamp((p.x - region->corner.x) / region->cell, region->columns);
            const size_t row = clamp((p.y - region->corner.y) / region->cell, region->rows);
            squares[row * region->columns + column] = 0;
        }
    }
    for (size_t row = 0; row < region->rows; row++) {
        int winding = 0;
        for (size_t k = row * region->columns; k < (row + 1) * region->columns; k++) {
            winding += windings[k];
            squares[k] = winding ? 0 : squares[k];
        }
    }
}

/* One pass of the transform along a line of samples: the lowest of parabolas over them. */
static void transform_line(float *samples, size_t count, size_t step, float *values, size_t *apexes, double *borders) {
    size_t last = 0;
    for (size_t k = 0; k < count; k++)
        values[k] = samples[k * step];
    apexes[0] = 0;
    borders[0] = -INFINITY;
    for (size_t k = 1; k < count; k++) {
        double border;
        for (;; last--) {
            const double a = (double)apexes[last], b = (double)k;
            border = (((double)values[k] + b * b) - ((double)values[apexes[last]] + a * a)) / (2 * (b - a));
            if (border > borders[last] || last == 0)
                break;
        }
        if (border > borders[last])
            last++;
        apexes[last] = k;
        borders[last] = last ? border : -INFINITY;
    }
    for (size_t k = 0, at = 0; k < count; k++) {
        while (at < last && borders[at + 1] < (double)k)
            at++;
        const double away = (double)k - (double)apexes[at];
        samples[k * step] = (float)(away * away + (double)values[apexes[at]]);
    }
}

narc_status narc_survey_region(narc_region *region, narc_error *error) {
    /* More than any square of a distance. */
    static const float NEVER = 4.0f * CELLS * CELLS;
    region->cell = region->extent / CELLS;
    const narc_point old = region->corner;
    const narc_aabb box = bound_points(region->points, region->point_count);
    region->columns = (size_t)ceil((box.max_x - old.x) / region->cell) + 2 * MARGIN;
    region->rows = (size_t)ceil((box.max_y - old.y) / region->cell) + 2 * MARGIN;
    region->corner = (narc_point){old.x - MARGIN * region->cell, old.y - MARGIN * region->cell};
    const size_t count = region->rows * region->columns;
    const size_t longer = region->rows > region->columns ? region->rows : region->columns;
    int *windings = calloc(count, sizeof *windings);
    float *values = malloc(longer * sizeof *values);
    size_t *apexes = malloc(longer * sizeof *apexes);
    double *borders = malloc(longer * sizeof *borders);
    region->distances = malloc(count * sizeof *region->distances);
    region->sums = malloc(region->rows * (region->columns + 1) * sizeof *region->sums);
    const bool done = windings && values && apexes && borders && region->distances && region->sums &&
                      list_lines(region) && make_buckets(region);
    if (done) {
        float *squares = region->distances;
        for (size_t k = 0; k < count; k++)
            squares[k] = NEVER;
        draw_region(region, windings, squares);
        for (size_t column = 0; column < region->columns; column++)
            transform_line(squares + column, region->rows, region->columns, values, apexes, borders);
        for (size_t row = 0; row < region->rows; row++)
            transform_line(squares + row * region->columns, region->columns, 1, values, apexes, borders);
        for (size_t k = 0; k < count; k++)
            squares[k] = (float)(sqrt((double)squares[k]) * region->cell);
    }
    free(windings);
    free(values);
    free(apexes);
    free(borders);
    return done ? NARC_OK : narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for the grid of an outline");
}

void narc_limit_region(narc_region *region, double limit) {
    const double reach = REACH * region->cell;
    region->limit = limit;
    for (size_t row = 0; row < region->rows; row++) {
        const float *distances = region->distances + row * region->columns;
        narc_cell_sums *sums = region->sums + row * (region->columns + 1);
        sums[0] = (narc_cell_sums){0};
        for (size_t k = 0; k < region->columns; k++) {
            const double distance = (double)distances[k], over = fmax(0, distance - 0.5 * limit) / region->cell;
            sums[k + 1] = sums[k];
            sums[k + 1].emptiness += over * over;
            sums[k + 1].far += distance > limit + 3 * reach;
            sums[k + 1].unsure += distance > limit - 2 * reach;
            sums[k + 1].inside += distance == 0;
        }
    }
}

/* ---------------------------------------------------------------------------- polygons on the grid */

/* The columns that a polygon has in each row, or more by one: none where left > right. */
struct spans {
    size_t low, high; /* rows */
    double left[CELLS + 2 * MARGIN + 2], right[CELLS + 2 * MARGIN + 2];
};

static void widen_span(struct spans *spans, size_t row, double x) {
    spans->left[row] = x < spans->left[row] ? x : spans->left[row];
    spans->right[row] = x > spans->right[row] ? x : spans->right[row];
}

static void find_spans(const narc_region *region, const narc_point *corners, size_t count, struct spans *out_spans) {
    double low = INFINITY, high = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        low = fmin(low, corners[k].y);
        high = fmax(high, corners[k].y);
    }
    out_spans->low = clamp((low - region->corner.y) / region->cell, region->rows);
    out_spans->high = clamp((high - region->corner.y) / region->cell, region->rows);
    for (size_t row = out_spans->low; row <= out_spans->high; row++) {
        out_spans->left[row] = INFINITY;
        out_spans->right[row] = -INFINITY;
    }
    for (size_t k = 0; k < count; k++) {
        const narc_point p = corners[k], q = corners[k + 1 < count ? k + 1 : 0];
        const narc_point a = p.y <= q.y ? p : q, b = p.y <= q.y ? q : p;
        const double ax = (a.x - region->corner.x) / region->cell, ay = (a.y - region->corner.y) / region->cell;
        const double bx = (b.x - region->corner.x) / region->cell, by = (b.y - region->corner.y) / region->cell;
        const double slope = by > ay ? (bx - ax) / (by - ay) : 0;
        const size_t first = clamp(ay, region->rows), last = clamp(by, region->rows);
        widen_span(out_spans, first, ax);
        widen_span(out_spans, last, bx);
        for (size_t row = first; row < last; row++) {
            const double x = ax + ((double)row + 1 - ay) * slope;
            widen_span(out_spans, row, x);
            widen_span(out_spans, row + 1, x);
        }
    }
}

/* What a row has in its span. */
static narc_cell_sums sum_row(const narc_region *region, const struct spans *spans, size_t row) {
    const narc_cell_sums *sums = region->sums + row * (region->columns + 1);
    if (spans->left[row] > spans->right[row])
        return (narc_cell_sums){0};
    const narc_cell_sums *a = sums + clamp(spans->left[row], region->columns),
                         *b = sums + clamp(spans->right[row], region->columns) + 1;
    return (narc_cell_sums){b->emptiness - a->emptiness, b->far - a->far, b->unsure - a->unsure, b->inside - a->inside};
}

double narc_measure_emptiness(const narc_region *region, const narc_point *corners, size_t count, double *out_ground) {
    struct spans spans;
    double sum = 0, ground = 0;
    find_spans(region, corners, count, &spans);
    for (size_t row = spans.low; row <= spans.high; row++) {
        const narc_cell_sums of = sum_row(region, &spans, row);
        sum += of.emptiness;
        ground += of.inside;
    }
    if (out_ground)
        *out_ground = ground;
    return sum;
}

/* ---------------------------------------------------------------------------- distances that decide */

struct search {
    const narc_region *region;
    const narc_point *corners, *normals; /* of the polygon, its sides' */
    size_t count;
    double allowed; /* the search ends where a point is further away */
    double best;    /* largest distance of a point of the polygon that was met */
    double precision;
    bool over;
    bool is_whole; /* no side is left out */
};

/* How far a point is outside the polygon: less than 0 inside, and perhaps less than its distance if that is `enough` or
 * if sides are left out. */
static double find_outside(const struct search *s, narc_point p, double enough) {
    double outside = -INFINITY, square = INFINITY;
    for (size_t k = 0; k < s->count && outside < enough; k++)
        outside = fmax(outside, dot(minus(p, s->corners[k]), s->normals[k]));
    if (outside <= 0 || outside >= enough || !s->is_whole) /* beyond a sharp tip no side is far */
        return outside;
    for (size_t k = 0; k < s->count; k++)
        square = fmin(square, side_distance(p, s->corners[k], s->corners[k + 1 < s->count ? k + 1 : 0]));
    return sqrt(square);
}

static void search_cell(struct search *s, narc_point center, double half) {
    const double reach = 1.4143 * half, outside = find_outside(s, center, reach);
    if (s->over || outside >= reach)
        return;
    const double distance = find_distance(s->region, center);
    if (outside <= 0)
        s->best = fmax(s->best, distance);
    if (distance + reach <= fmax(s->allowed, s->best + s->precision))
        return;
    if (s->allowed > 0 && (s->best > s->allowed || reach < s->precision)) {
        s->over = true;
        return;
    }
    if (reach < s->precision) {
        s->best = fmax(s->best, distance + reach - s->precision);
        return;
    }
    for (int k = 0; k < 4; k++)
        search_cell(s, (narc_point){center.x + (k & 1 ? 0.5 : -0.5) * half, center.y + (k & 2 ? 0.5 : -0.5) * half},
                    0.5 * half);
}

/* Looks into cells that may have a point further away than what is allowed or known. */
static void search_cells(struct search *s, const struct spans *spans) {
    const narc_region *region = s->region;
    for (size_t row = spans->low; row <= spans->high && !s->over; row++) {
        if (spans->left[row] > spans->right[row] || (s->allowed > 0 && !sum_row(region, spans, row).unsure))
            continue;
        const size_t last = clamp(spans->right[row], region->columns);
        for (size_t column = clamp(spans->left[row], region->columns); column <= last && !s->over; column++)
            if ((double)region->distances[row * region->columns + column] + 2 * REACH * region->cell >
                fmax(s->allowed, s->best + s->precision))
                search_cell(s, center_of(region, row, column), 0.5 * region->cell);
    }
}

bool narc_may_be_within_limit(const narc_region *region, const narc_point *corners, size_t count) {
    struct spans spans;
    find_spans(region, corners, count, &spans);
    for (size_t row = spans.low; row <= spans.high; row++)
        if (sum_row(region, &spans, row).far)
            return false;
    return true;
}

/* The sides of a large polygon are too many to look at for each cell: of these some are left out, which only makes it
 * larger. */
enum { MOST_SIDES = 64 };

/* The largest distance of a point of the polygon from the region, or a little more; infinity if it is above what is
 * allowed. */
static double search_polygon(const narc_region *region, const narc_point *corners, size_t count, double allowed,
                             double precision) {
    const size_t step = (count + MOST_SIDES - 1) / MOST_SIDES;
    narc_point points[MOST_SIDES], normals[MOST_SIDES];
    struct search s = {region, points, normals, 0, allowed, 0, precision * region->extent, false, step == 1};
    struct spans spans;
    for (size_t k = 0; k < count; k += step, s.count++) {
        const narc_point side = minus(corners[k + 1 < count ? k + 1 : 0], corners[k]);
        const double size = length(side);
        points[s.count] = corners[k];
        normals[s.count] = size > 0 ? (narc_point){side.y / size, -side.x / size} : (narc_point){0, 0};
    }
    find_spans(region, corners, count, &spans);
    search_cells(&s, &spans);
    return s.over ? INFINITY : s.best + s.precision;
}

bool narc_is_within_limit(const narc_region *region, const narc_point *corners, size_t count) {
    return narc_may_be_within_limit(region, corners, count) &&
           isfinite(search_polygon(region, corners, count, region->limit, PRECISION));
}

double narc_measure_gap(const narc_region *region, const narc_point *corners, size_t count) {
    return search_polygon(region, corners, count, 0, 0.5 * PRECISION);
}
