/* SPDX-License-Identifier: MIT
 *
 * quadratic.c - quadratic programmes: what is found keeps all rows, and the conditions of Karush, Kuhn and Tucker, which for
 * a convex programme only its solution has; programmes that no x keeps are told.
 */
#include "solve/quadratic.h"

#include <math.h>
#include <string.h>

#include "support.h"

enum { MOST = 24, ROWS = 60 };

/* A hessian whose eigenvalues spread over some orders of ten. */
static void make_hessian(struct test_random *random, narc_quadratic *q) {
    const size_t n = q->count;
    double factor[MOST * MOST];
    for (size_t k = 0; k < n * n; k++)
        factor[k] = random_between(random, -1, 1) * pow(10, random_between(random, -2, 1));
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            double sum = i == j ? 1e-3 : 0;
            for (size_t k = 0; k < n; k++)
                sum += factor[i * n + k] * factor[j * n + k];
            q->hessian[i * n + j] = sum;
        }
}

/* Rows that some x within all bounds keeps, now and then with no room. */
static void make_rows(struct test_random *random, narc_quadratic *q, size_t equations, size_t rows) {
    const size_t n = q->count;
    double inside[MOST];
    for (size_t c = 0; c < n; c++) {
        inside[c] = random_between(random, -1, 1);
        q->gradient[c] = random_between(random, -9, 9);
        q->lower[c] = random_below(random, 3) ? inside[c] - random_between(random, 0, 1) : -INFINITY;
        q->upper[c] = random_below(random, 3) ? inside[c] + random_between(random, 0, 1) : INFINITY;
    }
    q->rows = 0;
    q->equations = equations;
    for (size_t k = 0; k < rows; k++) {
        double sum = 0, *const row = narc_add_quadratic_row(q, 0);
        assert_non_null(row);
        for (size_t c = 0; c < n; c++) {
            /* Some rows are multiples of others. */
            row[c] = k > equations && random_below(random, 8) == 0 ? 0.5 * row[c - n] : random_between(random, -1, 1);
            sum += row[c] * inside[c];
        }
        q->offset[k] = (k < equations || random_below(random, 4) == 0 ? 0 : random_between(random, 0, 1)) - sum;
    }
}

/* Of a bound (q->active says which), or a row. */
static double find_slack(const narc_quadratic *q, size_t place) {
    const size_t n = q->count, c = place / 2, row = place - 2 * n;
    if (place < 2 * n)
        return place % 2 ? q->upper[c] - q->solution[c] : q->solution[c] - q->lower[c];
    double sum = q->offset[row];
    for (size_t k = 0; k < n; k++)
        sum += q->entries[row * n + k] * q->solution[k];
    return sum;
}

static bool is_equation(const narc_quadratic *q, size_t place) {
    return place >= 2 * q->count && place < 2 * q->count + q->equations;
}

static void expect_optimal(const narc_quadratic *q) {
    const size_t n = q->count;
    double left[MOST], scale = 1;
    for (size_t i = 0; i < n; i++) {
        left[i] = q->gradient[i];
        for (size_t k = 0; k < n; k++)
            left[i] += q->hessian[i * n + k] * q->solution[k];
        scale = fmax(scale, fabs(left[i]));
    }
    for (size_t place = 0; place < q->rows + 2 * n; place++) {
        const double slack = find_slack(q, place);
        assert_true(slack >= -1e-8 && !(is_equation(q, place) && slack > 1e-8));
    }
    for (size_t a = 0; a < q->active_count; a++) {
        const size_t place = q->active[a];
        assert_true(fabs(find_slack(q, place)) <= 1e-8 && (is_equation(q, place) || q->multiplier[a] >= 0));
        scale = fmax(scale, fabs(q->multiplier[a]));
        for (size_t c = 0; place >= 2 * n && c < n; c++)
            left[c] -= q->multiplier[a] * q->entries[(place - 2 * n) * n + c];
        if (place < 2 * n)
            left[place / 2] -= place % 2 ? -q->multiplier[a] : q->multiplier[a];
    }
    for (size_t c = 0; c < n; c++)
        assert_true(fabs(left[c]) <= 1e-7 * scale);
}

TEST(finds_what_is_least) {
    struct test_random random = test_random_named("quadratic programmes");
    const size_t trials = test_trials(3000);
    size_t missed = 0;
    for (size_t trial = 0; trial < trials; trial++) {
        AUTO(narc_close_quadratic) narc_quadratic q;
        const size_t count = 1 + random_below(&random, MOST);
        assert_true(narc_open_quadratic(&q, count, ROWS));
        make_hessian(&random, &q);
        make_rows(&random, &q, random_below(&random, count < 3 ? count : 3), 3 + random_below(&random, ROWS - 3));
        /* At once, or some rows after the others. */
        const size_t rows = q.rows,
                     early = random_below(&random, 2) ? q.equations + random_below(&random, rows - 2) : rows;
        q.rows = early < rows ? early : rows;
        bool solved = narc_solve_quadratic(&q);
        if (solved)
            expect_optimal(&q);
        q.rows = rows;
        solved = solved && narc_solve_more_rows(&q);
        if (solved)
            expect_optimal(&q);
        missed += !solved;
        assert_true(q.active_count <= count);
    }
    /* There is always an x: roundings may hide it where it is the only one. */
    assert_true(missed <= 1 + trials / 500);
}

/* Where curvatures differ by many orders of magnitude, roundings carry the solution off its rows. */
TEST(rows_hold_whatever_the_curvature) {
    struct test_random random = test_random_named("curvatures");
    size_t solved = 0;
    const size_t trials = test_trials(1000);
    for (size_t trial = 0; trial < trials; trial++) {
        AUTO(narc_close_quadratic) narc_quadratic q;
        const size_t count = 2 + random_below(&random, MOST - 1);
        assert_true(narc_open_quadratic(&q, count, ROWS));
        q.settles = true;
        make_hessian(&random, &q);
        for (size_t i = 0; i < count; i++) {
            const double factor = random_log_between(&random, 1e-3, 1e3);
            for (size_t k = 0; k < count; k++) {
                q.hessian[i * count + k] *= factor;
                q.hessian[k * count + i] *= factor;
            }
        }
        make_rows(&random, &q, 0, 3 + random_below(&random, ROWS - 3));
        if (narc_solve_quadratic(&q)) {
            solved++;
            for (size_t place = 0; place < q.rows + 2 * count; place++)
                assert_true(find_slack(&q, place) >= -1e-9);
            for (size_t a = 0; a < q.active_count; a++)
                assert_true(fabs(find_slack(&q, q.active[a])) <= 1e-9);
        }
    }
    assert_true(2 * solved > trials);
}

TEST(tells_what_no_one_keeps) {
    struct test_random random = test_random_named("infeasible programmes");
    for (size_t trial = 0; trial < test_trials(500); trial++) {
        AUTO(narc_close_quadratic) narc_quadratic q;
        const size_t count = 1 + random_below(&random, MOST);
        assert_true(narc_open_quadratic(&q, count, ROWS));
        make_hessian(&random, &q);
        make_rows(&random, &q, 0, 3 + random_below(&random, 20));
        /* The last row again, turned round, and out of reach of it. */
        const double *const last = q.entries + (q.rows - 1) * count, offset = -q.offset[q.rows - 1] - 0.01;
        double *const opposite = narc_add_quadratic_row(&q, offset);
        for (size_t c = 0; c < count; c++)
            opposite[c] = -last[c];
        assert_false(narc_solve_quadratic(&q));
    }
}

TEST(tells_a_hessian_that_is_not_definite) {
    AUTO(narc_close_quadratic) narc_quadratic q;
    assert_true(narc_open_quadratic(&q, 2, 1));
    memcpy(q.hessian, (const double[]){1, 2, 2, 1}, 4 * sizeof *q.hessian);
    memset(q.gradient, 0, 2 * sizeof *q.gradient);
    assert_false(narc_solve_quadratic(&q));
    assert_non_null(narc_add_quadratic_row(&q, 0));
    assert_null(narc_add_quadratic_row(&q, 0));
}

TEST_MAIN("quadratic programmes")
