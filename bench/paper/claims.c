/* SPDX-License-Identifier: MIT
 *
 * claims.c - the paper's statements about speed and storage against what was measured.
 */
#include <math.h>
#include <stdarg.h>

#include "measures.h"
#include "statements.h"

/* ------------------------------------------------------------------------------------------------ lines */

static void print_number(double value, FILE *out) {
    if (isinf(value))
        fprintf(out, "none");
    else
        fprintf(out, "%.2f", value);
}

static bool holds(const struct claim *claim, struct span span) {
    return span.least >= claim->range->low && span.most <= claim->range->high;
}

static void print_span(const struct claim *claim, struct span span, FILE *out) {
    if (isnan(span.least)) {
        fprintf(out, " |");
        return;
    }
    fputc(' ', out);
    print_number(span.least, out);
    if (span.most != span.least) {
        fprintf(out, " to ");
        print_number(span.most, out);
    }
    fprintf(out, ", %s |", holds(claim, span) ? "holds" : "**does not hold**");
}

static void print_range(const struct range *range, FILE *out) {
    if (isinf(range->high))
        fprintf(out, range->low == 0 ? "above %.3g" : "at least %.3g", range->low);
    else if (isinf(range->low) || range->low == 0)
        fprintf(out, "at most %.2g", range->high);
    else
        fprintf(out, "%.2g to %.3g", range->low, range->high);
}

/* Figures that an explanation rests on. */
struct evidence {
    char text[160];
};

__attribute__((format(printf, 1, 2))) static struct evidence cite(const char *format, ...) {
    struct evidence evidence;
    va_list list;
    va_start(list, format);
    vsnprintf(evidence.text, sizeof evidence.text, format, list);
    va_end(list);
    return evidence;
}

/* A line of the table; `subject` says what it is about. One explanation; where there are two the scalar one's. */
static void print_claim(const struct claim *claim, const char *subject, const struct span *spans,
                        struct evidence evidence, FILE *out) {
    const char *reason = "";
    fprintf(out, "| %s | %s%s%s | %s | ", claim->section, claim->text, *subject ? ": " : "", subject, claim->measure);
    print_range(claim->range, out);
    fprintf(out, " |");
    for (int isa = ISAS - 1; isa >= 0; isa--) {
        print_span(claim, spans[isa], out);
        if (!isnan(spans[isa].least) && !holds(claim, spans[isa]))
            reason = spans[isa].most > claim->range->high ? claim->above : claim->below;
    }
    fprintf(out, " %s%s%s |\n", reason, *reason && *evidence.text ? " " : "", *reason ? evidence.text : "");
}

/* ------------------------------------------------------------------------------------------------ the table */

#define CURVE(test, algorithm) ((struct curve){test, algorithm})
#define WITHOUT(algorithm)     CURVE(APART_OVERLAP, algorithm)
#define WITH(algorithm)        CURVE(COLLIDING_CONTACT, algorithm)
#define YES(algorithm)         CURVE(COLLIDING_OVERLAP, algorithm)

#define LINE(claim, subject, expression) LINE_CITING(claim, subject, expression, cite("%s", ""))
#define LINE_CITING(claim, subject, expression, evidence)                                                              \
    do {                                                                                                               \
        struct span spans[ISAS];                                                                                       \
        for (int isa = 0; isa < ISAS; isa++) {                                                                         \
            const struct view *view = &views[isa];                                                                     \
            spans[isa] = (expression);                                                                                 \
        }                                                                                                              \
        print_claim(&claim, subject, spans, evidence, out);                                                            \
    } while (0)

enum { IN_FIGURES = 12 };

static void print_figure_2(const struct view *views, FILE *out) {
    LINE(circles_fast, "circles", lane_ratio(view, LANE_CIRCLE, LANE_GON_SAT));
    LINE(circles_fast, "AABBs", lane_ratio(view, LANE_AABB, LANE_GON_SAT));
    LINE(order_of_figure_2, "AABBs over circles", lane_ratio(view, LANE_AABB, LANE_CIRCLE));
    LINE(order_of_figure_2, "OBBs over AABBs", lane_ratio(view, LANE_OBB, LANE_AABB));
    LINE(order_of_figure_2, "n-gon SAT over OBBs", lane_ratio(view, LANE_GON_SAT, LANE_OBB));
}

static void print_section_2(const struct view *views, FILE *out) {
    const struct steps *steps = views->results->steps;
    const size_t eight = index_of(views->results->paper, 8);
    LINE(nearly_constant, "n-arcs, yes or no", warm_exponent(view, QUESTION_OVERLAP));
    LINE(nearly_constant, "n-arcs, contacts", warm_exponent(view, QUESTION_CONTACT));
    const struct evidence cold =
        cite("(Support points of a cold start, n = 8: %.2f without, %.2f with a collision.)",
             steps->overlap[APART][KIND_ARC][eight].mean, steps->overlap[COLLIDING][KIND_ARC][eight].mean);
    LINE_CITING(warm_faster, "n-arcs, very slow motion (0.001)", warm_against_cold(view, VERY_SLOW_MOTION), cold);
    LINE_CITING(warm_faster, "n-arcs, slow motion (0.01)", warm_against_cold(view, SLOW_MOTION), cold);
    LINE(epa_linear, "", epa_exponent(view));
    LINE_CITING(threshold_claim, "", by_threshold(view, 4, 0),
                cite("(Support points, n = 4: %.2f at 1e-1, %.2f at 1e-5.)", steps->contact[KIND_ARC][0][0].mean,
                     steps->contact[KIND_ARC][4][0].mean));
    LINE(storage, "what the algorithms read", storage_ratios(view));
    LINE(not_normalising, "", perpendicular_ratios(view, COMPUTED_YES_NO, STORED_YES_NO));
    LINE(normalising, "", perpendicular_ratios(view, NORMALISED_DEPTH, STORED_DEPTH));
}

static void print_polygons(const struct view *views, FILE *out) {
    const struct steps *steps = views->results->steps;
    const struct evidence points = cite("(n = 4: %.2f and %.2f.)", steps->overlap[APART][KIND_GON][0].mean,
                                        steps->overlap[COLLIDING][KIND_GON][0].mean);
    LINE(sat_apart, "SAT, contacts with", time_ratios(view, WITHOUT(GON_SAT), WITH(GON_SAT), 0, IN_FIGURES));
    LINE(gjk_apart, "GJK, contacts with", time_ratios(view, WITHOUT(GON_GJK), WITH(GON_GJK), 0, IN_FIGURES));
    LINE(sat_apart, "SAT, yes or no", time_ratios(view, WITHOUT(GON_SAT), YES(GON_SAT), 0, IN_FIGURES));
    LINE_CITING(gjk_apart, "GJK, yes or no", time_ratios(view, WITHOUT(GON_GJK), YES(GON_GJK), 0, IN_FIGURES), points);
    LINE(few_edges, "no collision", time_ratios(view, WITHOUT(GON_SAT), WITHOUT(GON_GJK), 4, 4));
    LINE(few_edges, "collision", time_ratios(view, WITH(GON_SAT), WITH(GON_GJK), 4, 4));
    LINE(scales_worse, "no collision", exponent_difference(view, WITHOUT(GON_SAT), WITHOUT(GON_GJK)));
    LINE(scales_worse, "collision", exponent_difference(view, WITH(GON_SAT), WITH(GON_GJK)));
    LINE(apart_quadratic, "n-gons, no collision", time_exponent(view, WITHOUT(GON_SAT)));
    LINE(sat_quadratic, "n-gons, collision", time_exponent(view, WITH(GON_SAT)));
    LINE(gjk_linear, "n-gons, no collision", time_exponent(view, WITHOUT(GON_GJK)));
    LINE(gjk_linear, "n-gons, collision", time_exponent(view, WITH(GON_GJK)));
}

static void print_arcs(const struct view *views, FILE *out) {
    const struct steps *steps = views->results->steps;
    const size_t eight = index_of(views->results->paper, 8);
    LINE(sat_quadratic, "n-arcs, first pair, no collision", time_exponent(view, WITHOUT(ARC_FIRST)));
    LINE(sat_quadratic, "n-arcs, first pair, collision", time_exponent(view, WITH(ARC_FIRST)));
    LINE(exact_quadratic, "n-arcs, exact, no collision", time_exponent(view, WITHOUT(ARC_SAT)));
    LINE(exact_quadratic, "n-arcs, exact, collision", time_exponent(view, WITH(ARC_SAT)));
    LINE(gjk_linear, "n-arcs, no collision", time_exponent(view, WITHOUT(ARC_GJK)));
    LINE(gjk_linear, "n-arcs, collision", time_exponent(view, WITH(ARC_GJK)));
    LINE(similar_first, first_name, time_ratios(view, WITHOUT(ARC_FIRST), WITHOUT(GON_SAT), 0, IN_FIGURES));
    LINE(similar_exact, exact_name, time_ratios(view, WITHOUT(ARC_SAT), WITHOUT(GON_SAT), 0, IN_FIGURES));
    LINE_CITING(similar_gjk, "GJK", time_ratios(view, WITHOUT(ARC_GJK), WITHOUT(GON_GJK), 0, IN_FIGURES),
                cite("(n = 8: %.2f against %.2f.)", steps->overlap[APART][KIND_ARC][eight].mean,
                     steps->overlap[APART][KIND_GON][eight].mean));
    LINE(with_collision, first_name, against_polygons(view, ARC_FIRST));
    LINE(with_collision, exact_name, against_polygons(view, ARC_SAT));
    LINE(same_contact, first_name, time_ratios(view, WITH(ARC_FIRST), WITHOUT(ARC_FIRST), 0, IN_FIGURES));
    LINE(same_contact, exact_name, time_ratios(view, WITH(ARC_SAT), WITHOUT(ARC_SAT), 0, IN_FIGURES));
    LINE(same_overlap, first_name, time_ratios(view, YES(ARC_FIRST), WITHOUT(ARC_FIRST), 0, IN_FIGURES));
    LINE(same_overlap, exact_name, time_ratios(view, YES(ARC_SAT), WITHOUT(ARC_SAT), 0, IN_FIGURES));
    LINE(faster_with, "the paper's, contacts with",
         time_ratios(view, WITH(ARC_FIRST), WITHOUT(ARC_FIRST), 10, IN_FIGURES));
    LINE(faster_with, "the paper's, yes or no", time_ratios(view, YES(ARC_FIRST), WITHOUT(ARC_FIRST), 10, IN_FIGURES));
    LINE(overtakes, first_name, crossing(view, WITH(GON_GJK), WITH(ARC_FIRST)));
    LINE(overtakes, exact_name, crossing(view, WITH(GON_GJK), WITH(ARC_SAT)));
}

static void print_epa_claims(const struct view *views, FILE *out) {
    LINE(worst_at_four, "", least_size_against_others(view));
    LINE(fewer_points, "", support_points_to_next(view));
    LINE(very_poor, "", time_ratios(view, WITH(ARC_GJK), WITH(GON_GJK), 0, IN_FIGURES));
    LINE(few_arcs, "first pair, no collision", time_ratios(view, WITHOUT(ARC_FIRST), WITHOUT(ARC_GJK), 0, 8));
    LINE(few_arcs, "first pair, collision", time_ratios(view, WITH(ARC_FIRST), WITH(ARC_GJK), 0, 8));
    LINE(few_arcs, "exact, no collision", time_ratios(view, WITHOUT(ARC_SAT), WITHOUT(ARC_GJK), 0, 8));
    LINE(few_arcs, "exact, collision", time_ratios(view, WITH(ARC_SAT), WITH(ARC_GJK), 0, 8));
    LINE(few_arcs_more, "first pair", more_with_collisions(view, ARC_FIRST, ARC_GJK, 8));
    LINE(few_arcs_more, "exact", more_with_collisions(view, ARC_SAT, ARC_GJK, 8));
}

void print_claims(const struct results *results, FILE *out) {
    struct view views[ISAS];
    for (enum isa isa = 0; isa < ISAS; isa++)
        views[isa] = (struct view){results, isa};
    fprintf(out,
            "\n### What the paper says\n\n| section | the paper | measured as | holds in | %s | %s | if not: our "
            "explanation |\n| --- | --- | --- | --- | --- | --- | --- |\n",
            results->paper->isas[BEST], results->paper->isas[SCALAR]);
    print_figure_2(views, out);
    print_section_2(views, out);
    print_polygons(views, out);
    print_arcs(views, out);
    print_epa_claims(views, out);
}
