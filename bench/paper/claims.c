/* SPDX-License-Identifier: MIT
 *
 * claims.c - the paper's statements about speed and storage against what was measured.
 *
 * Each statement is made into a number and a range: it holds if the number lies in the range. Which reason is given
 * where it does not depends on the side on which the number lies outside.
 */
#include <math.h>

#include "paper.h"
#include "store.h"

struct claim {
    const char *number, *text, *measure;
    double low, high;
    const char *below, *above; /* why the value may lie there */
};

enum {
    SIMILAR_FIRST,
    SIMILAR_EXACT,
    SIMILAR_GJK,
    FASTER,
    SAME_CONTACT,
    SAME_OVERLAP,
    QUADRATIC,
    QUADRATIC_APART,
    QUADRATIC_EXACT,
    LINEAR,
    NEARLY_CONSTANT,
    WARM_FASTER,
    FEW_EDGES,
    WORST_AT_FOUR,
    VERY_POOR,
    THRESHOLD,
    STORAGE,
    CLAIMS
};

#define SIMILAR_TEXT                                                                                                   \
    "without collisions n-arcs are similar to polygons, slightly slower", "time over n-gons', mean over n up to 12",   \
        0.9, 1.5
#define EXPONENT "exponent of n from n = 8 on"

static const struct claim claims[CLAIMS] = {
    [SIMILAR_FIRST] = {"1", SIMILAR_TEXT,
                       "It ends with the first pair of arcs that passes; polygons look at all of an "
                       "edge's vertices.",
                       "A pair of arcs takes four cross products and a dot product, a vertex and an edge one dot "
                       "product."},
    [SIMILAR_EXACT] = {"1", SIMILAR_TEXT,
                       "The search starts with the direction between the inscribed circles and "
                       "mostly ends there: most arcs are never looked at.",
                       "A proof takes longer than an axis."},
    [SIMILAR_GJK] = {"1", SIMILAR_TEXT,
                     "Fewer support points (see there): beside the best direction the gap of smooth shapes falls with "
                     "the square of the angle, that of polygons in proportion to it, so a rough direction is enough.",
                     "Arcs take more support points."},
    [FASTER] = {"2", "with collisions n-arc SAT is considerably faster than both polygon algorithms",
                "contacts: time over the faster one's, worst n up to 12", 0, 2.0 / 3, "",
                "Polygons' SAT looks at more pairs, but each costs one dot product instead of four cross products and "
                "one; and a vector of pairs is done when the last of them has met its arcs."},
    [SAME_CONTACT] = {"3", "n-arc SAT costs the same with and without collisions",
                      "contacts with over overlaps without, furthest from 1, n up to 12", 0.8, 1.25,
                      "Colliding pairs are settled sooner.",
                      "Depth, normal, point and arcs are computed and written only for pairs that collide."},
    [SAME_OVERLAP] = {"3", "the same, yes or no in both scenes",
                      "overlaps with over without, furthest from 1, n up to 12", 0.8, 1.25,
                      "Colliding pairs are settled sooner.",
                      "One direction with a gap proves that bodies are apart; that they collide is proved by a common "
                      "point or by all directions."},
    [QUADRATIC] =
        {"4", "SAT grows quadratically", EXPONENT, 1.6, 2.4,
         "Reading the arcs and turning them into place grows linearly, and is a good part of the time for small n.",
         "Caches become too small."},
    [QUADRATIC_APART] = {"4", "SAT grows quadratically", EXPONENT, 1.6, 2.4,
                         "The test ends with the first edge that has a gap, and many edges have one.",
                         "Caches become too small."},
    [QUADRATIC_EXACT] = {"4", "SAT grows quadratically", EXPONENT, 1.6, 2.4,
                         "A directed search looks at the arcs of a few directions; where it finds no proof, the walk "
                         "around both outlines is linear.",
                         "Caches become too small."},
    [LINEAR] = {"4", "GJK grows about linearly", EXPONENT, 0.6, 1.4,
                "A support point's arc is looked up in a short list of angles; most of its cost does not depend on n.",
                "The number of support points grows too."},
    [NEARLY_CONSTANT] = {"4", "GJK from the last frame's simplex takes near constant time", EXPONENT ", slow motion",
                         -0.3, 0.3, "It becomes faster with n.",
                         "A support point costs more, the more arcs there are."},
    [WARM_FASTER] = {"4", "GJK is improved by starting from the last frame's simplex",
                     "overlaps: time over a cold start's, n = 8", 0, 0.95, "",
                     "A cold start needs few support points (see there), and for bodies that collide three are needed "
                     "to see that the last simplex still serves."},
    [FEW_EDGES] = {"5", "polygon SAT beats GJK for few edges", "time of n-gon SAT over n-gon GJK, n = 4", 0, 1, "",
                   "GJK ends after a few support points."},
    [WORST_AT_FOUR] = {"6", "n-arc GJK with EPA is worst at 4 arcs",
                       "contacts: time at 4 over the largest from 6 to 12", 1, INFINITY,
                       "4 arcs take the most support points, as the paper says, but each costs less than those of more "
                       "arcs.",
                       ""},
    [VERY_POOR] = {"6", "n-arc GJK with EPA is very poor", "contacts: time over n-gon GJK's, mean over n up to 12", 1.5,
                   INFINITY,
                   "Arcs take more support points than polygons (see there), but not all of the time goes to them.",
                   ""},
    [THRESHOLD] =
        {"6", "its cost depends strongly on the threshold", "time at 1e-5 over time at 1e-1, n = 4", 2, INFINITY,
         "A tenth of the threshold costs one to two support points more, as each divides the error of a curve "
         "by about four.",
         ""},
    [STORAGE] = {"7", "n-arcs need slightly more storage than polygons",
                 "bytes of an n-arc over those of an n-gon, largest up to n = 12", 1, 1.5, "", ""},
};

static bool holds(const struct claim *claim, double value) { return value >= claim->low && value <= claim->high; }

static void print_range(const struct claim *claim, FILE *out) {
    if (isinf(claim->high))
        fprintf(out, "at least %.3g", claim->low);
    else if (claim->low == 0)
        fprintf(out, "at most %.2g", claim->high);
    else
        fprintf(out, "%.3g to %.3g", claim->low, claim->high);
}

/* A line of the table; `subject` says what it is about. One reason, where there are two the scalar one's. */
static void print_claim(int which, const char *subject, const double *values, FILE *out) {
    const struct claim *claim = &claims[which];
    const char *reason = "";
    fprintf(out, "| %s | %s: %s | %s | ", claim->number, claim->text, subject, claim->measure);
    print_range(claim, out);
    fprintf(out, " |");
    for (int isa = ISAS - 1; isa >= 0; isa--) {
        fprintf(out, " %.2f, %s |", values[isa], holds(claim, values[isa]) ? "holds" : "**does not hold**");
        if (!holds(claim, values[isa]))
            reason = values[isa] < claim->low ? claim->below : claim->above;
    }
    fprintf(out, " %s |\n", reason);
}

/* ------------------------------------------------------------------------------------------------ values */

struct view {
    const struct paper *paper;
    const struct figures *figures;
    const struct epa *epa;
    const struct frames *frames;
    enum isa isa;
};

static double at(const struct view *view, enum test test, enum algorithm algorithm, size_t size) {
    return time_of(view->paper, view->figures, view->isa, test, algorithm, size);
}

/* Geometric mean over the sizes of the figures. */
static double mean_ratio(const struct view *view, enum test test, enum algorithm above, enum algorithm below) {
    const size_t count = view->paper->settings.figure_sizes;
    double sum = 0;
    for (size_t size = 0; size < count; size++)
        sum += log(at(view, test, above, size) / at(view, test, below, size));
    return exp(sum / (double)count);
}

static double against_polygons(const struct view *view, enum algorithm algorithm) {
    double most = 0;
    for (size_t size = 0; size < view->paper->settings.figure_sizes; size++) {
        const double faster =
            fmin(at(view, COLLIDING_CONTACT, GON_SAT, size), at(view, COLLIDING_CONTACT, GON_GJK, size));
        most = fmax(most, at(view, COLLIDING_CONTACT, algorithm, size) / faster);
    }
    return most;
}

static double with_collisions(const struct view *view, enum test test, enum algorithm algorithm) {
    double furthest = 1;
    for (size_t size = 0; size < view->paper->settings.figure_sizes; size++) {
        const double ratio = at(view, test, algorithm, size) / at(view, APART_OVERLAP, algorithm, size);
        if (fabs(log(ratio)) > fabs(log(furthest)))
            furthest = ratio;
    }
    return furthest;
}

static double exponent(const struct view *view, enum test test, enum algorithm algorithm) {
    double times[MAX_SIZES];
    for (size_t size = 0; size < view->paper->settings.size_count; size++)
        times[size] = at(view, test, algorithm, size);
    return slope_of(view->paper, times);
}

static double warm_exponent(const struct view *view, enum question question) {
    double times[MAX_SIZES];
    for (size_t size = 0; size < view->paper->settings.size_count; size++)
        times[size] = view->paper->rows.list[view->frames->size_rows[view->isa][question][GJK_WARM][size]].ns;
    return slope_of(view->paper, times);
}

static double first_against_most(const struct view *view) {
    double most = 0;
    for (size_t size = 1; size < view->paper->settings.figure_sizes; size++)
        most = fmax(most, at(view, COLLIDING_CONTACT, ARC_GJK, size));
    return at(view, COLLIDING_CONTACT, ARC_GJK, 0) / most;
}

static double warm_against_cold(const struct view *view, size_t motion) {
    const struct row *rows = view->paper->rows.list;
    const size_t(*starts)[MOTIONS] = view->frames->rows[view->isa][QUESTION_OVERLAP];
    return rows[starts[GJK_WARM][motion]].ns / rows[starts[GJK_COLD][motion]].ns;
}

static double by_threshold(const struct view *view, size_t small, size_t large) {
    const struct row *rows = view->paper->rows.list;
    return rows[view->epa->rows[view->isa][KIND_ARC][small][0]].ns /
           rows[view->epa->rows[view->isa][KIND_ARC][large][0]].ns;
}

/* ------------------------------------------------------------------------------------------------ the table */

static const char *const first_name = "SAT, first pair (the paper's)", *const exact_name = "SAT, exact";

static void print_speed(struct view *views, FILE *out) {
    double value[ISAS];
#define EACH(which, subject, expression)                                                                               \
    do {                                                                                                               \
        for (int isa = 0; isa < ISAS; isa++) {                                                                         \
            const struct view *view = &views[isa];                                                                     \
            value[isa] = (expression);                                                                                 \
        }                                                                                                              \
        print_claim(which, subject, value, out);                                                                       \
    } while (0)
    EACH(SIMILAR_FIRST, first_name, mean_ratio(view, APART_OVERLAP, ARC_FIRST, GON_SAT));
    EACH(SIMILAR_EXACT, exact_name, mean_ratio(view, APART_OVERLAP, ARC_SAT, GON_SAT));
    EACH(SIMILAR_GJK, "GJK", mean_ratio(view, APART_OVERLAP, ARC_GJK, GON_GJK));
    EACH(FASTER, first_name, against_polygons(view, ARC_FIRST));
    EACH(FASTER, exact_name, against_polygons(view, ARC_SAT));
    EACH(SAME_CONTACT, first_name, with_collisions(view, COLLIDING_CONTACT, ARC_FIRST));
    EACH(SAME_CONTACT, exact_name, with_collisions(view, COLLIDING_CONTACT, ARC_SAT));
    EACH(SAME_OVERLAP, first_name, with_collisions(view, COLLIDING_OVERLAP, ARC_FIRST));
    EACH(SAME_OVERLAP, exact_name, with_collisions(view, COLLIDING_OVERLAP, ARC_SAT));
    EACH(QUADRATIC, "n-arcs, first pair, no collision", exponent(view, APART_OVERLAP, ARC_FIRST));
    EACH(QUADRATIC, "n-arcs, first pair, collision", exponent(view, COLLIDING_CONTACT, ARC_FIRST));
    EACH(QUADRATIC_EXACT, "n-arcs, exact, no collision", exponent(view, APART_OVERLAP, ARC_SAT));
    EACH(QUADRATIC_EXACT, "n-arcs, exact, collision", exponent(view, COLLIDING_CONTACT, ARC_SAT));
    EACH(QUADRATIC_APART, "n-gons, no collision", exponent(view, APART_OVERLAP, GON_SAT));
    EACH(QUADRATIC, "n-gons, collision", exponent(view, COLLIDING_CONTACT, GON_SAT));
    EACH(LINEAR, "n-arcs, no collision", exponent(view, APART_OVERLAP, ARC_GJK));
    EACH(LINEAR, "n-arcs, collision", exponent(view, COLLIDING_CONTACT, ARC_GJK));
    EACH(LINEAR, "n-gons, no collision", exponent(view, APART_OVERLAP, GON_GJK));
    EACH(LINEAR, "n-gons, collision", exponent(view, COLLIDING_CONTACT, GON_GJK));
    EACH(NEARLY_CONSTANT, "n-arcs, overlaps", warm_exponent(view, QUESTION_OVERLAP));
    EACH(NEARLY_CONSTANT, "n-arcs, contacts", warm_exponent(view, QUESTION_CONTACT));
    EACH(WARM_FASTER, "n-arcs, very slow motion (0.001)", warm_against_cold(view, VERY_SLOW_MOTION));
    EACH(WARM_FASTER, "n-arcs, slow motion (0.01)", warm_against_cold(view, SLOW_MOTION));
    EACH(FEW_EDGES, "no collision", at(view, APART_OVERLAP, GON_SAT, 0) / at(view, APART_OVERLAP, GON_GJK, 0));
    EACH(FEW_EDGES, "collision, contacts",
         at(view, COLLIDING_CONTACT, GON_SAT, 0) / at(view, COLLIDING_CONTACT, GON_GJK, 0));
    EACH(WORST_AT_FOUR, "of 4 to 12", first_against_most(view));
    EACH(VERY_POOR, "against n-gons", mean_ratio(view, COLLIDING_CONTACT, ARC_GJK, GON_GJK));
    EACH(THRESHOLD, "4 arcs", by_threshold(view, 4, 0));
#undef EACH
}

/* What the paper's algorithms read, in bytes of single precision. SAT and GJK of n-arcs: n centres, directions and
 * radii, and the centroid. Polygons: n vertices and perpendiculars. */
static size_t arc_bytes(size_t n) { return sizeof(float) * (2 * n + 2 * n + n + 2); }
static size_t gon_bytes(size_t n) { return sizeof(float) * (2 * n + 2 * n); }

/* What this library stores, of whatever shape. */
static size_t store_bytes(size_t n) { return sizeof(narc_head) + sizeof(narc_record) * (narc_first_arc(n) + n + 1); }

static void print_storage_claims(const struct paper *paper, FILE *out) {
    double most = 0;
    for (size_t size = 0; size < paper->settings.figure_sizes; size++) {
        const size_t n = paper->settings.sizes[size];
        most = fmax(most, (double)arc_bytes(n) / (double)gon_bytes(n));
    }
    print_claim(STORAGE, "what the algorithms need", (const double[ISAS]){most, most}, out);
}

void print_claims(const struct paper *paper, const struct figures *figures, const struct epa *epa,
                  const struct frames *frames, FILE *out) {
    struct view views[ISAS];
    for (enum isa isa = 0; isa < ISAS; isa++)
        views[isa] = (struct view){paper, figures, epa, frames, isa};
    fprintf(out,
            "\n### What the paper says\n\n| | the paper | measured as | holds in | %s | %s | if not, why |\n"
            "| --- | --- | --- | --- | --- | --- | --- |\n",
            paper->isas[BEST], paper->isas[SCALAR]);
    print_speed(views, out);
    print_storage_claims(paper, out);
}

void print_storage(const struct paper *paper, FILE *out) {
    fprintf(out, "\n### Bytes of a shape, single precision\n\n| |");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        fprintf(out, size ? " %zu |" : " n = %zu |", paper->settings.sizes[size]);
    fprintf(out, "\n| --- |");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        fprintf(out, " ---: |");
    static size_t (*const counts[])(size_t) = {arc_bytes, gon_bytes, store_bytes};
    static const char *const titles[] = {
        "n-arc, SAT and GJK: centres, directions, radii, centroid",
        "n-gon, SAT (GJK: half of it): vertices, perpendiculars",
        "this library, n-arc or n-gon, all methods: circles around and inside, junction angles, arcs, box"};
    for (size_t what = 0; what < sizeof counts / sizeof counts[0]; what++) {
        fprintf(out, "\n| %s |", titles[what]);
        for (size_t size = 0; size < paper->settings.size_count; size++)
            fprintf(out, " %zu |", counts[what](paper->settings.sizes[size]));
    }
    fputc('\n', out);
}
