/* SPDX-License-Identifier: MIT
 *
 * lanes.c - what many pairs per vector are worth: every method on every instruction set that the machine has.
 */
#include "paper.h"

static const struct {
    enum kind kind;
    narc_method method;
    const char *title;
} rows[LANE_ROWS] = {
    [LANE_ARC_SAT] = {KIND_ARC, NARC_METHOD_SAT, "n-arc SAT, exact"},
    [LANE_ARC_FIRST] = {KIND_ARC, NARC_METHOD_SAT_FIRST, "n-arc SAT, first pair"},
    [LANE_ARC_GJK] = {KIND_ARC, NARC_METHOD_GJK, "n-arc GJK"},
    [LANE_GON_SAT] = {KIND_GON, NARC_METHOD_POLYGON_SAT, "n-gon SAT"},
    [LANE_GON_GJK] = {KIND_GON, NARC_METHOD_GJK, "n-gon GJK"},
    [LANE_CIRCLE] = {KIND_ARC, NARC_METHOD_CIRCLE, "circles"},
    [LANE_AABB] = {KIND_ARC, NARC_METHOD_AABB, "axis-aligned boxes"},
    [LANE_OBB] = {KIND_ARC, NARC_METHOD_OBB, "oriented boxes"},
};

/* Filters have no contacts. */
static bool is_asked(size_t row, enum question question) {
    return question == QUESTION_OVERLAP || rows[row].method <= NARC_METHOD_GJK;
}

void add_lanes(struct paper *paper, struct lanes *lanes) {
    for (size_t k = 0; k < paper->settings.size_count; k++)
        if (paper->settings.sizes[k] == 8)
            lanes->size = k;
    for (size_t k = 0; narc_isa_name(k) && lanes->isa_count < MAX_LANE_ISAS; k++)
        if (narc_isa_supported(narc_isa_name(k)))
            lanes->isas[lanes->isa_count++] = narc_isa_name(k);
    for (enum question question = 0; question < QUESTIONS; question++)
        for (size_t k = 0; k < LANE_ROWS; k++)
            for (size_t isa = 0; isa < lanes->isa_count && is_asked(k, question); isa++) {
                const struct scene *scene =
                    &paper->scenes[lanes->size][question == QUESTION_OVERLAP ? APART : COLLIDING];
                struct row row = row_of(scene, rows[k].kind, question, rows[k].method, lanes->isas[isa]);
                if (rows[k].method > NARC_METHOD_GJK)
                    row.claim = -1;
                lanes->rows[question][k][isa] = add_row(&paper->rows, row);
            }
}

double lane_time(const struct paper *paper, const struct lanes *lanes, enum isa isa, enum lane_row row) {
    const size_t column = isa == BEST ? 0 : lanes->isa_count - 1;
    return paper->rows.list[lanes->rows[QUESTION_OVERLAP][row][column]].ns;
}

void print_lanes(const struct paper *paper, const struct lanes *lanes, FILE *out) {
    static const char *const titles[QUESTIONS] = {"no collision, overlap", "collision, contact"};
    const size_t last = lanes->isa_count - 1; /* scalar */
    fprintf(out,
            "\n### What vectors are worth, n = %zu: µs for 1,000 checks, and how many times as fast as scalar\n\n| |",
            paper->settings.sizes[lanes->size]);
    for (enum question question = 0; question < QUESTIONS; question++)
        for (size_t isa = 0; isa <= last; isa++)
            fprintf(out, " %s%s%s |", isa == 0 ? titles[question] : "", isa == 0 ? ": " : "", lanes->isas[isa]);
    fprintf(out, "\n| --- |");
    for (size_t k = 0; k < QUESTIONS * lanes->isa_count; k++)
        fprintf(out, " ---: |");
    for (size_t k = 0; k < LANE_ROWS; k++) {
        fprintf(out, "\n| %s |", rows[k].title);
        for (enum question question = 0; question < QUESTIONS; question++)
            for (size_t isa = 0; isa <= last; isa++) {
                const size_t *row = lanes->rows[question][k];
                if (!is_asked(k, question)) {
                    fprintf(out, " |");
                    continue;
                }
                const double ns = paper->rows.list[row[isa]].ns;
                fprintf(out, " %.1f", ns);
                if (isa < last)
                    fprintf(out, " (%.1f)", paper->rows.list[row[last]].ns / ns);
                fprintf(out, " |");
            }
    }
    fputc('\n', out);
}
