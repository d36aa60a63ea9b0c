/* SPDX-License-Identifier: MIT
 *
 * claims.c - what the paper says about speed and storage, and whether it holds.
 *
 * Each statement is made into numbers, one for each n that it covers, and a range: it holds if all of them lie in the
 * range. Where they do not, an explanation is chosen by the side on which they lie outside; what it rests on is
 * measured where it ends with figures, and else our reading of the algorithms.
 */
#include <math.h>
#include <string.h>

#include "lists.h"
#include "paper.h"

/* What the paper's words mean here. Times are those of the first thing named over those of the second. */
static const struct range {
    double low, high;
} slightly_slower = {1, 1.5}, slightly_faster = {2.0 / 3, 1}, much_faster = {0, 2.0 / 3}, the_same = {0.8, 1.25},
  faster = {0, 1}, slower = {1, INFINITY}, much_slower = {1.5, INFINITY}, very_fast = {0, 0.25},
  significant = {1.25, INFINITY}, linear = {0.6, 1.4}, quadratic = {1.6, 2.4}, constant = {-0.3, 0.3},
  at_most_linear = {-INFINITY, 1}, larger = {0, INFINITY}, beyond_figures = {12, 64}, strong = {2, INFINITY};

/* Lines are "subject = how name name least most": how the two make numbers of the n from the least to the most, up to 12
 * if there are none. "ratio": one over the other; "exponent": that of n of the first, from n = 8 on; "difference" of both
 * exponents; "crossing": the n from which on the first is less; "step": the first over that of the n before. Names go on
 * with "/ISA/N" where they do not say so themselves. `evidence` is "what = name name". */
struct claim {
    const char *section, *text, *measure;
    const struct range *range;
    const char *below, *above; /* why the numbers may lie there */
    const char *lines, *evidence;
};

#define FIRST      "n-arc SAT, first pair (the paper's)"
#define EXACT      "n-arc SAT, exact"
#define OVER_GONS  "time over n-gons', n up to 12"
#define EXPONENT_8 "exponent of n from n = 8 on"
#define LIKE_GONS  "without collision n-arcs are like polygons, but slightly slower"
#define SQUARE     "III", "SAT grows quadratically", EXPONENT_8, &quadratic
#define CACHES     "Caches become too small."
#define WRITTEN    "Depth, normal, point and arcs are computed and written only for pairs that collide"
#define PRODUCTS   "A pair of arcs takes four cross products and a dot product, a vertex and a side one dot product"
#define DIRECTED                                                                                                       \
    "A directed search looks at the arcs of a few directions; where it finds no proof, the walk around both outlines " \
    "is linear."

static const struct claim claims[] = {
    {"I", "circles and AABBs are very fast", "yes or no, n = 8: time over n-gon SAT's", &very_fast, "",
     "Reading the pair is a part of any time.",
     "circles = ratio apart/circle apart/gon-sat 8 8; AABBs = ratio apart/aabb apart/gon-sat 8 8", NULL},
    {"I", "the order of figure 2", "yes or no, n = 8: time over that of the other", &slower,
     "An AABB is made from the OBB, whose test costs little more.", "",
     "AABBs over circles = ratio apart/aabb apart/circle 8 8; OBBs over AABBs = ratio apart/obb apart/aabb 8 8;"
     "n-gon SAT over OBBs = ratio apart/gon-sat apart/obb 8 8",
     NULL},
    {"II", "GJK from the last frame's simplex takes near constant time", EXPONENT_8 ", slow motion", &constant,
     "It becomes faster with n.", "A support point costs more, the more arcs there are.",
     "n-arcs, yes or no = exponent moving/overlap/warm/0.01; n-arcs, contacts = exponent moving/contact/warm/0.01",
     NULL},
    {"II", "GJK is improved by starting from the last frame's simplex", "yes or no: time over a cold start's, n = 8",
     &faster, "",
     "A cold start needs few support points, and for bodies that collide three are needed to see that the last simplex "
     "still serves.",
     "n-arcs, very slow motion (0.001) = ratio moving/overlap/warm/0.001 moving/overlap/cold/0.001 8 8;"
     "n-arcs, slow motion (0.01) = ratio moving/overlap/warm/0.01 moving/overlap/cold/0.01 8 8",
     "Support points of a cold start, 8 arcs, without and with a collision = points/apart/arc/8 "
     "points/colliding/arc/8"},
    {"II", "EPA on polygons takes at most O(n) iterations",
     "exponent of n of the most support points of a pair, threshold 1e-6", &at_most_linear, "", "",
     " = exponent most-points/1e-06/gon/N", NULL},
    {"II", "EPA's cost on n-arcs depends strongly on the threshold", "contacts: time at 1e-5 over time at 1e-1, n = 4",
     &strong,
     "A tenth of the threshold costs one to two support points more, as each divides the error of a curve by about "
     "four.",
     "", " = ratio epa/arc/1e-05 epa/arc/1e-01 4 4",
     "Support points, 4 arcs, at 1e-1 and at 1e-5 = points/1e-01/arc/4 points/1e-05/arc/4"},
    {"II", "n-arcs need slightly more storage than polygons", "bytes of an n-arc over those of an n-gon, n up to 12",
     &slightly_slower, "", "", "what the algorithms read = ratio bytes/arc/N bytes/gon/N", NULL},
    {"II", "perpendiculars are easily computed",
     "plain C, yes or no, lengths left alone: time over that with stored normals, n up to 12", &the_same,
     "Stored normals must be rotated; sides of placed vertices are differences.", "",
     " = ratio perpendicular/computed perpendicular/stored", NULL},
    {"II", "to normalise computed perpendiculars is a significant cost",
     "plain C, depth: time over that with stored normals, n up to 12", &significant,
     "A root and a division for each side are few beside a product for each side and vertex.", "",
     " = ratio perpendicular/normalised-depth perpendicular/stored-depth", NULL},
    {"III", "polygon algorithms are faster without collision", "time without over time with, n up to 12", &faster, "",
     "Few sides have a gap: most are looked at before one is found.",
     "SAT, contacts with = ratio apart/gon-sat contact/gon-sat; SAT, yes or no = ratio apart/gon-sat overlap/gon-sat",
     NULL},
    {"III", "polygon algorithms are faster without collision", "time without over time with, n up to 12", &faster, "",
     "Vertices in place of a curve: to find a gap takes GJK as many support points as to find a collision.",
     "GJK, contacts with = ratio apart/gon-gjk contact/gon-gjk; GJK, yes or no = ratio apart/gon-gjk overlap/gon-gjk",
     "4-gons = points/apart/gon/4 points/colliding/gon/4"},
    {"III", "polygon SAT is slightly faster than GJK for few edges", "time of n-gon SAT over n-gon GJK, n = 4",
     &slightly_faster, "It is faster by more: GJK takes several support points, and each step is long.",
     "GJK ends after a few support points.",
     "no collision = ratio apart/gon-sat apart/gon-gjk 4 4; collision = ratio contact/gon-sat contact/gon-gjk 4 4",
     NULL},
    {"III", "polygon SAT does not scale as well as GJK", "difference of the exponents of n from n = 8 on", &larger, "",
     "",
     "no collision = difference apart/gon-sat apart/gon-gjk; collision = difference contact/gon-sat contact/gon-gjk",
     NULL},
    {SQUARE, "The test ends with the first side that has a gap, and many sides have one.", CACHES,
     "n-gons, no collision = exponent apart/gon-sat", NULL},
    {SQUARE, "Reading the arcs and turning them into place grows linearly, and is a good part of the time for small n.",
     CACHES,
     "n-gons, collision = exponent contact/gon-sat; n-arcs, first pair, no collision = exponent apart/first;"
     "n-arcs, first pair, collision = exponent contact/first",
     NULL},
    {SQUARE, DIRECTED, CACHES,
     "n-arcs, exact, no collision = exponent apart/sat; n-arcs, exact, collision = exponent contact/sat", NULL},
    {"III", "GJK grows about linearly", EXPONENT_8, &linear,
     "A support point's arc or vertex is looked up in a list of angles, where the paper tries all.",
     "The number of support points grows too.",
     "n-gons, no collision = exponent apart/gon-gjk; n-gons, collision = exponent contact/gon-gjk;"
     "n-arcs, no collision = exponent apart/gjk; n-arcs, collision = exponent contact/gjk",
     NULL},
    {"III, IV", LIKE_GONS, OVER_GONS, &slightly_slower,
     "It ends with the first pair of arcs that passes; polygons look at all of a side's vertices.", PRODUCTS ".",
     FIRST " = ratio apart/first apart/gon-sat", NULL},
    {"III, IV", LIKE_GONS, OVER_GONS, &slightly_slower,
     "The search starts with the direction between the inscribed circles and mostly ends there: most arcs are never "
     "looked at.",
     "A proof takes longer than an axis.", EXACT " = ratio apart/sat apart/gon-sat", NULL},
    {"III, IV", LIKE_GONS, OVER_GONS, &slightly_slower,
     "Fewer support points: beside the best direction the gap of smooth shapes falls with the square of the angle, "
     "that "
     "of polygons in proportion to it.",
     "More support points.", "GJK = ratio apart/gjk apart/gon-gjk",
     "8 arcs, 8-gons = points/apart/arc/8 points/apart/gon/8"},
    {"III, IV", "with collisions n-arc SAT is significantly faster than both polygon algorithms",
     "contacts: time over the faster one's, n up to 12", &much_faster, "",
     PRODUCTS "; and a vector of pairs is done when the last of them has met its arcs.",
     FIRST " = ratio contact/first contact/faster; " EXACT " = ratio contact/sat contact/faster", NULL},
    {"III, IV", "n-arc SAT costs the same with and without collisions",
     "contacts with over yes or no without, n up to 12", &the_same, "Colliding pairs are settled sooner.", WRITTEN ".",
     FIRST " = ratio contact/first apart/first; " EXACT " = ratio contact/sat apart/sat", NULL},
    {"III, IV", "the same, yes or no in both scenes", "yes or no with over without, n up to 12", &the_same,
     "Colliding pairs are settled sooner.",
     "One direction with a gap proves that bodies are apart; that they collide is proved by a common point or by all "
     "directions.",
     FIRST " = ratio overlap/first apart/first; " EXACT " = ratio overlap/sat apart/sat", NULL},
    {"III", "n-arc SAT is slightly faster with a collision for 10 and 12 arcs",
     "time with over time without, n = 10 and 12", &slightly_faster, "",
     WRITTEN "; and the first pair that passes comes no sooner.",
     "the paper's, contacts with = ratio contact/first apart/first 10 12;"
     "the paper's, yes or no = ratio overlap/first apart/first 10 12",
     NULL},
    {"III", "for more arcs than were tested polygon GJK overtakes n-arc SAT",
     "contacts: n from which on GJK on n-gons is faster", &beyond_figures, "It does so already at fewer.", DIRECTED,
     FIRST " = crossing contact/gon-gjk contact/first; " EXACT " = crossing contact/gon-gjk contact/sat", NULL},
    {"III", "n-arc GJK with EPA is worst at 4 arcs", "contacts: time at 4 over those at 6 to 12", &slower,
     "4 arcs take the most support points, but each costs less than those of more arcs.", "",
     " = ratio contact/gjk/ISA/4 contact/gjk 6 12", NULL},
    {"III", "with more arcs EPA needs fewer iterations", "support points over those of the n before, up to 12", &faster,
     "", "", " = step points/1e-04/arc/N", NULL},
    {"III", "n-arc GJK with EPA is very poor", "contacts: time over n-gon GJK's, n up to 12", &much_slower,
     "Arcs take more support points than polygons, but not all of the time goes to them.", "",
     " = ratio contact/gjk contact/gon-gjk", NULL},
    {"IV", "for few arcs n-arc SAT is faster than n-arc GJK", "time over n-arc GJK's, n up to 8", &faster, "",
     "All pairs of arcs are tried until one passes; GJK looks few support points up.",
     "first pair, no collision = ratio apart/first apart/gjk 0 8; first pair, collision = ratio contact/first "
     "contact/gjk "
     "0 8; exact, no collision = ratio apart/sat apart/gjk 0 8; exact, collision = ratio contact/sat contact/gjk 0 8",
     NULL},
    {"IV", "especially with a collision", "that ratio with collision over that without, n up to 8", &faster, "",
     "Of n-arc SAT the contacts cost more too.",
     "first pair = ratio contact-by-apart/first contact-by-apart/gjk 0 8;"
     "exact = ratio contact-by-apart/sat contact-by-apart/gjk 0 8",
     NULL},
};

/* ------------------------------------------------------------------------------------------------ numbers */

/* What statements take two numbers for: contacts by the faster polygon algorithm; contacts by yes or no without. */
static void put_combined(const struct settings *settings, const char *isa) {
    static const char *const methods[] = {"sat", "first", "gjk"};
    for (size_t size = 0; size < settings->size_count; size++) {
        const size_t n = settings->sizes[size];
        const double sat = value_at("contact/gon-sat/ISA/N", "", isa, n);
        put_value(fmin(sat, value_at("contact/gon-gjk/ISA/N", "", isa, n)), "contact/faster/%s/%zu", isa, n);
        for (int k = 0; k < 3; k++)
            put_value(value_at("contact/COL/ISA/N", methods[k], isa, n) /
                          value_at("apart/COL/ISA/N", methods[k], isa, n),
                      "contact-by-apart/%s/%s/%zu", methods[k], isa, n);
    }
}

/* The exponent of a power law: the slope of the least-squares line through the logarithms, n from 8 on. */
static double exponent_of(const struct settings *settings, const char *pattern, const char *isa) {
    double count = 0, x_sum = 0, y_sum = 0, xx_sum = 0, xy_sum = 0;
    for (size_t size = 0; size < settings->size_count; size++) {
        const double x = log((double)settings->sizes[size]);
        const double y = log(value_at(pattern, "", isa, settings->sizes[size]));
        if (settings->sizes[size] < 8)
            continue;
        count++;
        x_sum += x, y_sum += y, xx_sum += x * x, xy_sum += x * y;
    }
    return count < 2 ? NAN : (count * xy_sum - x_sum * y_sum) / (count * xx_sum - x_sum * x_sum);
}

/* Between sizes by interpolation of the logarithms; INFINITY if it is not less at the end, the first n if it is
 * everywhere. */
static double find_crossing(const struct settings *settings, const char *lower, const char *upper, const char *isa) {
    double logs[MAX_SIZES];
    size_t size = settings->size_count;
    for (size_t k = 0; k < size; k++)
        logs[k] = log(value_at(lower, "", isa, settings->sizes[k]) / value_at(upper, "", isa, settings->sizes[k]));
    while (size > 0 && logs[size - 1] < 0)
        size--;
    if (size == 0 || size == settings->size_count)
        return size == 0 ? (double)settings->sizes[0] : INFINITY;
    const double before = log((double)settings->sizes[size - 1]), behind = log((double)settings->sizes[size]);
    return exp(before + (behind - before) * logs[size - 1] / (logs[size - 1] - logs[size]));
}

/* The least and the largest of the numbers that a line covers. NaN: not measured on this instruction set. */
struct span {
    double least, most;
};

static struct span find_span(const struct settings *settings, const char *line, const char *isa) {
    char how[16], names[2][ITEM_VALUE], patterns[2][ITEM_VALUE];
    size_t least = 0, most = 12;
    struct span span = {NAN, NAN};
    names[1][0] = 0;
    sscanf(line, "%15s %95s %95s %zu %zu", how, names[0], names[1], &least, &most);
    for (int k = 0; k < 2; k++)
        snprintf(patterns[k], ITEM_VALUE, "%.80s%s", names[k],
                 strstr(names[k], "/N") || strstr(names[k], "ISA") ? "" : "/ISA/N");
    if (*how == 'c')
        span.least = span.most = find_crossing(settings, patterns[0], patterns[1], isa);
    if (*how == 'e' || *how == 'd')
        span.least = span.most =
            exponent_of(settings, patterns[0], isa) - (*how == 'd' ? exponent_of(settings, patterns[1], isa) : 0);
    for (size_t size = 0; (*how == 'r' || *how == 's') && size < settings->size_count; size++) {
        const size_t n = settings->sizes[size];
        if (n < least || n > most || (*how == 's' && size == 0))
            continue;
        const double below =
            *how == 'r' ? value_at(patterns[1], "", isa, n) : value_at(patterns[0], "", isa, settings->sizes[size - 1]);
        const double value = value_at(patterns[0], "", isa, n) / below;
        span = (struct span){fmin(span.least, value), fmax(span.most, value)};
    }
    return span;
}

/* ------------------------------------------------------------------------------------------------ lines */

static bool holds(const struct claim *claim, struct span span) {
    return span.least >= claim->range->low && span.most <= claim->range->high;
}

static void print_span(const struct claim *claim, struct span span, FILE *out) {
    if (isnan(span.least)) {
        fprintf(out, " |");
        return;
    }
    fprintf(out, isinf(span.least) ? " none" : " %.2f", span.least);
    if (span.most != span.least)
        fprintf(out, " to %.2f", span.most);
    fprintf(out, ", %s |", holds(claim, span) ? "yes" : "**no**");
}

/* The first line of a claim says what it is. One explanation; where there are two the scalar one's; each once. */
static void print_line(const struct paper *paper, const struct claim *claim, const struct item *line, bool first,
                       const char **explained, FILE *out) {
    const double low = claim->range->low, high = claim->range->high;
    const char *reason = "";
    if (first)
        fprintf(out, "| %s | %s%s%s | %s |", claim->section, claim->text, *line->title ? ": " : "", line->title,
                claim->measure);
    else
        fprintf(out, "| | %s | |", line->title);
    if (!first)
        fprintf(out, " |");
    else if (isinf(high))
        fprintf(out, low == 0 ? " above %.3g |" : " at least %.3g |", low);
    else if (isinf(low) || low == 0)
        fprintf(out, " at most %.2g |", high);
    else
        fprintf(out, " %.2g to %.3g |", low, high);
    for (int isa = 0; isa < 2; isa++) {
        const struct span span = find_span(&paper->settings, line->value, isa ? "scalar" : paper->best);
        print_span(claim, span, out);
        if (!isnan(span.least) && !holds(claim, span))
            reason = span.most > high ? claim->above : claim->below;
    }
    if (*reason && reason != *explained) {
        fprintf(out, " %s", reason);
        if (claim->evidence) {
            struct item evidence[MOST_ITEMS];
            char one[ITEM_VALUE], other[ITEM_VALUE];
            read_items(claim->evidence, evidence);
            sscanf(evidence->value, "%95s %95s", one, other);
            fprintf(out, " (%s: %.2f, %.2f.)", evidence->title, value_of(one), value_of(other));
        }
        *explained = reason;
    }
    fprintf(out, " |\n");
}

void print_claims(const struct paper *paper, FILE *out) {
    put_combined(&paper->settings, paper->best);
    put_combined(&paper->settings, "scalar");
    fprintf(out,
            "\n### What the paper says\n\n| section | the paper | measured as | holds in | %s | scalar | if not: our "
            "explanation |\n| --- | --- | --- | --- | --- | --- | --- |\n",
            paper->best);
    for (size_t k = 0; k < sizeof claims / sizeof claims[0]; k++) {
        struct item lines[MOST_ITEMS];
        const char *explained = "";
        const size_t count = read_items(claims[k].lines, lines);
        for (size_t line = 0; line < count; line++)
            print_line(paper, &claims[k], &lines[line], line == 0, &explained, out);
    }
}
