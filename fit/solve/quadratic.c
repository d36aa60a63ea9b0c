/* SPDX-License-Identifier: MIT
 *
 * quadratic.c - quadratic programmes by the dual method of Goldfarb and Idnani (1983): from the least value without any
 * rows, rows that are violated become active one by one, and active ones whose multipliers fall to 0 are let go.
 *
 * With the normals N of the active rows as columns, and the hessian's factor L, transform is L^-T Q and triangle is R,
 * where Q'L^-1 N = [R; 0]; both are kept by columns. A step towards a row with normal a has the direction transform d2,
 * where d = transform'a and d2 is d without its first active_count items; the multipliers change along R^-1 d1.
 */
#include "solve/quadratic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows hold to this, in their own units. */
static const double FEASIBLE = 1e-10;

/* A normal depends on the active ones if less than this part of its square is left beside them. */
static const double DEPENDENT = 1e-14;

/* A multiplier that is 0 but for roundings. */
static const double LEAST_MULTIPLIER = 1e-9;

bool narc_open_quadratic(narc_quadratic *q, size_t count, size_t row_capacity) {
    const size_t all = row_capacity + 2 * count, square = count * count;
    *q = (narc_quadratic){.count = count, .row_capacity = row_capacity};
    double **const arrays[] = {&q->hessian,  &q->gradient,  &q->lower,    &q->upper,      &q->entries, &q->offset,
                               &q->solution, &q->transform, &q->triangle, &q->multiplier, &q->room};
    const size_t sizes[] = {square, count,  count,     count,    row_capacity * count, row_capacity, count,
                            square, square, count + 1, 3 * count};
    size_t sum = 0;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        sum += sizes[k];
    double *next = q->memory = malloc(sum * sizeof *next + (count + 1) * sizeof *q->active + all);
    if (!next)
        return false;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; next += sizes[k++])
        *arrays[k] = next;
    q->active = (size_t *)next;
    q->is_active = (unsigned char *)(q->active + count + 1);
    return true;
}

void narc_close_quadratic(narc_quadratic *q) {
    free(q->memory);
    *q = (narc_quadratic){0};
}

double *narc_add_quadratic_row(narc_quadratic *q, double offset) {
    if (q->rows == q->row_capacity)
        return NULL;
    q->offset[q->rows] = offset;
    return q->entries + q->rows++ * q->count;
}

/* In four sums, which a processor adds at the same time. */
static inline double dot(const double *a, const double *b, size_t count) {
    double sum[4] = {0};
    size_t k = 0;
    for (; k + 4 <= count; k += 4)
        for (size_t lane = 0; lane < 4; lane++)
            sum[lane] += a[k + lane] * b[k + lane];
    for (; k < count; k++)
        sum[0] += a[k] * b[k];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static inline void add_scaled(double *out, double factor, const double *a, size_t count) {
    for (size_t k = 0; k < count; k++)
        out[k] += factor * a[k];
}

/* transform = L^-T for the hessian L L'. The triangle's memory holds L until then. */
static bool factor(narc_quadratic *q) {
    const size_t n = q->count;
    double *const l = q->triangle;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j <= i; j++) {
            const double sum = q->hessian[i * n + j] - dot(l + i * n, l + j * n, j);
            if (i == j && !(sum > 0))
                return false;
            l[i * n + j] = i == j ? sqrt(sum) : sum / l[j * n + j];
        }
    }
    /* Column k of L^-T is row k of L^-1. */
    for (size_t k = 0; k < n; k++) {
        double *const column = q->transform + k * n;
        memset(column, 0, n * sizeof *column);
        column[k] = 1;
        for (size_t j = 0; j < k; j++)
            add_scaled(column, -l[k * n + j], q->transform + j * n, j + 1);
        for (size_t i = 0; i <= k; i++)
            column[i] /= l[k * n + k];
    }
    return true;
}

/* A place among all that a solution keeps: the two bounds of each variable, then the rows, which may become more. */
static size_t place_of(const narc_quadratic *q, size_t row) { return 2 * q->count + row; }

static bool is_equation(const narc_quadratic *q, size_t place) {
    return place >= 2 * q->count && place - 2 * q->count < q->equations;
}

/* out = transform'a. */
static void project(const narc_quadratic *q, const double *a, double *out) {
    for (size_t k = 0; k < q->count; k++)
        out[k] = dot(q->transform + k * q->count, a, q->count);
}

/* The same for the normal of a row or a bound, times a sign. */
static void project_normal(const narc_quadratic *q, size_t place, double sign, double *out) {
    const size_t n = q->count;
    if (place >= 2 * n)
        project(q, q->entries + (place - 2 * n) * n, out);
    for (size_t k = 0; k < n; k++)
        out[k] = place >= 2 * n ? sign * out[k] : (place % 2 ? -sign : sign) * q->transform[k * n + place / 2];
}

/* out = transform d, of the columns from `first` on. */
static void move_by(const narc_quadratic *q, size_t first, const double *d, double *out) {
    memset(out, 0, q->count * sizeof *out);
    for (size_t k = first; k < q->count; k++)
        add_scaled(out, d[k], q->transform + k * q->count, q->count);
}

static double read_slack(const narc_quadratic *q, size_t place) {
    const size_t n = q->count, c = place / 2, row = place - 2 * n;
    return place >= 2 * n   ? q->offset[row] + dot(q->entries + row * n, q->solution, n)
           : place % 2 == 0 ? q->solution[c] - q->lower[c]
                            : q->upper[c] - q->solution[c];
}

struct rotation {
    double cosine, sine;
};

/* The one that makes b of (a, b) 0; returns a then. */
static double make_rotation(double a, double b, struct rotation *out) {
    const double size = sqrt(a * a + b * b);
    *out = (struct rotation){a / size, b / size};
    return size;
}

static void rotate(struct rotation r, double *a, double *b) {
    const double was = *a;
    *a = r.cosine * was + r.sine * *b;
    *b = r.cosine * *b - r.sine * was;
}

/* Turns two neighbouring columns of the transform. */
static void rotate_transform(narc_quadratic *q, size_t column, struct rotation r) {
    double *const a = q->transform + column * q->count, *const b = a + q->count;
    for (size_t i = 0; i < q->count; i++)
        rotate(r, &a[i], &b[i]);
}

static double *column_of(const narc_quadratic *q, size_t c) { return q->triangle + c * q->count; }

/* d = transform'a of the row that becomes active. */
static void activate(narc_quadratic *q, size_t place, double multiplier, double *d) {
    const size_t at = q->active_count++;
    for (size_t k = q->count - 1; k > at; k--) {
        if (d[k] == 0)
            continue;
        struct rotation r;
        d[k - 1] = make_rotation(d[k - 1], d[k], &r);
        rotate_transform(q, k - 1, r);
    }
    memcpy(column_of(q, at), d, (at + 1) * sizeof *d);
    q->active[at] = place;
    q->multiplier[at] = multiplier;
    q->is_active[place] = 1;
}

/* Columns behind the one that goes have an item below the diagonal then, which rotations take away. */
static void let_go(narc_quadratic *q, size_t gone) {
    q->is_active[q->active[gone]] = 0;
    const size_t last = --q->active_count;
    for (size_t k = gone; k < last; k++) {
        q->active[k] = q->active[k + 1];
        q->multiplier[k] = q->multiplier[k + 1];
        memcpy(column_of(q, k), column_of(q, k + 1), (k + 2) * sizeof *q->triangle);
    }
    for (size_t k = gone; k < last; k++) {
        struct rotation r;
        double *const here = column_of(q, k);
        if (here[k + 1] == 0)
            continue;
        here[k] = make_rotation(here[k], here[k + 1], &r);
        here[k + 1] = 0;
        for (size_t c = k + 1; c < last; c++)
            rotate(r, &column_of(q, c)[k], &column_of(q, c)[k + 1]);
        rotate_transform(q, k, r);
    }
}

/* How the multipliers of active rows fall: triangle^-1 d1. */
static void find_falls(const narc_quadratic *q, const double *d, double *out) {
    for (size_t k = q->active_count; k-- > 0;) {
        double sum = d[k];
        for (size_t c = k + 1; c < q->active_count; c++)
            sum -= column_of(q, c)[k] * out[c];
        out[k] = sum / column_of(q, k)[k];
    }
}

/* The active row whose multiplier is the first to reach 0, and after how much; active_count if none is. */
static size_t find_first_zero(const narc_quadratic *q, const double *falls, double *out_step) {
    size_t first = q->active_count;
    *out_step = INFINITY;
    for (size_t k = 0; k < q->active_count; k++) {
        if (is_equation(q, q->active[k]) || !(falls[k] > 0) || !(q->multiplier[k] / falls[k] < *out_step))
            continue;
        *out_step = q->multiplier[k] / falls[k];
        first = k;
    }
    return first;
}

/* Steps until a row or a bound holds. False if it can't hold with those that are active. `budget` counts steps. */
static bool enforce(narc_quadratic *q, size_t place, size_t *budget) {
    const size_t n = q->count;
    double *const d = q->room, *const way = d + n, *const falls = way + n;
    double multiplier = 0, slack = read_slack(q, place);
    const double sign = is_equation(q, place) && slack > 0 ? -1 : 1;
    for (slack *= sign; *budget > 0; --*budget) {
        project_normal(q, place, sign, d);
        double whole = 0, left = 0;
        for (size_t k = 0; k < n; k++)
            *(k < q->active_count ? &whole : &left) += d[k] * d[k];
        const bool moves = left > DEPENDENT * (whole + left);
        find_falls(q, d, falls);
        double until;
        const size_t gone = find_first_zero(q, falls, &until);
        const double full = moves ? fmax(0, -slack / left) : INFINITY, step = fmin(full, until);
        if (!isfinite(step))
            return false;
        for (size_t k = 0; k < q->active_count; k++)
            q->multiplier[k] -= step * falls[k];
        multiplier += step;
        if (moves) {
            move_by(q, q->active_count, d, way);
            for (size_t c = 0; c < n; c++)
                q->solution[c] += step * way[c];
            slack += step * left;
        }
        if (full <= until) {
            activate(q, place, sign * multiplier, d);
            if (sign < 0) /* the normal was turned round */
                for (size_t k = 0; k < q->active_count; k++)
                    column_of(q, q->active_count - 1)[k] *= -1;
            return true;
        }
        let_go(q, gone);
    }
    return false;
}

/* The row or bound that is violated most; `all` if none is. */
static size_t find_violated(const narc_quadratic *q, size_t all) {
    double least = -FEASIBLE;
    size_t worst = all;
    for (size_t place = 0; place < all; place++) {
        const double slack = q->is_active[place] ? 0 : read_slack(q, place);
        if (slack < least) {
            least = slack;
            worst = place;
        }
    }
    return worst;
}

/* Roundings carry the solution off rows that are active, far off where the hessian is ill-conditioned: it goes back along
 * the shortest way in the hessian's measure. False if it lies on all of them. */
static bool settle_active(narc_quadratic *q) {
    double *const way = q->room, most = 0;
    for (size_t k = 0; k < q->active_count; k++) {
        const double slack = read_slack(q, q->active[k]);
        most = fmax(most, fabs(slack));
        way[k] = (-slack - dot(column_of(q, k), way, k)) / column_of(q, k)[k];
    }
    if (!(most > FEASIBLE))
        return false;
    for (size_t k = 0; k < q->active_count; k++)
        add_scaled(q->solution, way[k], q->transform + k * q->count, q->count);
    return true;
}

enum { MOST_SETTLINGS = 3 };

bool narc_solve_more_rows(narc_quadratic *q) {
    const size_t all = place_of(q, q->rows);
    size_t budget = 40 + 8 * q->count;
    for (unsigned round = 0;; round++) {
        for (size_t place; (place = find_violated(q, all)) < all;)
            if (!enforce(q, place, &budget))
                return false;
        if (!q->settles || round == MOST_SETTLINGS || !settle_active(q))
            return true;
    }
}

bool narc_solve_quadratic(narc_quadratic *q) {
    const size_t n = q->count;
    double *const way = q->room;
    if (!factor(q))
        return false;
    memset(q->is_active, 0, place_of(q, q->row_capacity));
    q->active_count = 0;
    project(q, q->gradient, way);
    move_by(q, 0, way, q->solution);
    for (size_t c = 0; c < n; c++)
        q->solution[c] = -q->solution[c];
    size_t budget = q->equations + n;
    for (size_t row = 0; row < q->equations; row++)
        if (!enforce(q, place_of(q, row), &budget))
            return false;
    return narc_solve_more_rows(q);
}

bool narc_is_linear_optimum(narc_quadratic *q) {
    double *const d = q->room, *const falls = d + 2 * q->count;
    if (q->active_count < q->count)
        return false;
    project(q, q->gradient, d);
    find_falls(q, d, falls); /* multipliers */
    for (size_t k = 0; k < q->active_count; k++)
        if (!is_equation(q, q->active[k]) && falls[k] < -LEAST_MULTIPLIER)
            return false;
    return true;
}
