/* SPDX-License-Identifier: MIT
 *
 * statements.h - what the paper says about speed and storage, and what its words mean here. For claims.c.
 *
 * Each statement is made into numbers, one for each n that it covers, and a range: it holds if all of them lie in the
 * range. Where they do not, an explanation is chosen by the side on which they lie outside; what it rests on is
 * measured where it ends with figures, and else our reading of the algorithms.
 */
#ifndef NARC_PAPER_STATEMENTS_H
#define NARC_PAPER_STATEMENTS_H

#include <math.h>

struct range {
    double low, high;
};

/* What the paper's words mean here. Times are those of the first thing named over those of the second. */
static const struct range slightly_slower = {1, 1.5}, slightly_faster = {2.0 / 3, 1}, much_faster = {0, 2.0 / 3};
static const struct range the_same = {0.8, 1.25}, faster = {0, 1}, slower = {1, INFINITY},
                          much_slower = {1.5, INFINITY};
static const struct range very_fast = {0, 0.25}, significant = {1.25, INFINITY}, slightly_more = {1, 1.5};
static const struct range linear = {0.6, 1.4}, quadratic = {1.6, 2.4}, constant = {-0.3, 0.3};
static const struct range at_most_linear = {-INFINITY, 1}, larger = {0, INFINITY}, beyond_figures = {12, 64},
                          strong = {2, INFINITY};

struct claim {
    const char *section, *text, *measure;
    const struct range *range;
    const char *below, *above; /* why the numbers may lie there */
};

static const char first_name[] = "n-arc SAT, first pair (the paper's)", exact_name[] = "n-arc SAT, exact";

static const char linear_part[] = "Reading the arcs and turning them into place grows linearly, and is a good part of "
                                  "the time for small n.";
static const char directed[] = "A directed search looks at the arcs of a few directions; where it finds no proof, the "
                               "walk around both outlines is linear.";

static const struct claim circles_fast = {
    "I", "circles and AABBs are very fast",        "yes or no, n = 8: time over n-gon SAT's", &very_fast,
    "",  "Reading the pair is a part of any time."};
static const struct claim order_of_figure_2 = {"I",
                                               "the order of figure 2",
                                               "yes or no, n = 8: time over that of the other",
                                               &slower,
                                               "An AABB is made from the OBB, whose test costs little more.",
                                               ""};
static const struct claim sat_apart = {"III",
                                       "polygon algorithms are faster without collision",
                                       "time without over time with, n up to 12",
                                       &faster,
                                       "",
                                       "Few sides have a gap: most are looked at before one is found."};
static const struct claim gjk_apart = {"III",
                                       "polygon algorithms are faster without collision",
                                       "time without over time with, n up to 12",
                                       &faster,
                                       "",
                                       "Vertices in place of a curve: to find a gap takes GJK as many support "
                                       "points as to find a collision."};
static const struct claim few_edges = {"III",
                                       "polygon SAT is slightly faster than GJK for few edges",
                                       "time of n-gon SAT over n-gon GJK, n = 4",
                                       &slightly_faster,
                                       "It is faster by more: GJK takes several support points, and each step is long.",
                                       "GJK ends after a few support points."};
static const struct claim scales_worse = {
    "III", "polygon SAT does not scale as well as GJK", "difference of the exponents of n from n = 8 on", &larger, "",
    ""};
static const struct claim gjk_linear = {"III",
                                        "GJK grows about linearly",
                                        "exponent of n from n = 8 on",
                                        &linear,
                                        "A support point's arc or vertex is looked up in a list of angles, where the "
                                        "paper tries all.",
                                        "The number of support points grows too."};
static const struct claim sat_quadratic = {
    "III",       "SAT grows quadratically", "exponent of n from n = 8 on", &quadratic,
    linear_part, "Caches become too small."};
static const struct claim exact_quadratic = {
    "III", "SAT grows quadratically", "exponent of n from n = 8 on", &quadratic, directed, "Caches become too small."};
static const struct claim apart_quadratic = {
    "III",
    "SAT grows quadratically",
    "exponent of n from n = 8 on",
    &quadratic,
    "The test ends with the first side that has a gap, and many sides have one.",
    "Caches become too small."};
static const struct claim similar_first = {"III, IV",
                                           "without collision n-arcs are like polygons, but slightly slower",
                                           "time over n-gons', n up to 12",
                                           &slightly_slower,
                                           "It ends with the first pair of arcs that passes; polygons look at all of a "
                                           "side's vertices.",
                                           "A pair of arcs takes four cross products and a dot product, a vertex and a "
                                           "side one dot product."};
static const struct claim similar_exact = {"III, IV",
                                           "without collision n-arcs are like polygons, but slightly slower",
                                           "time over n-gons', n up to 12",
                                           &slightly_slower,
                                           "The search starts with the direction between the inscribed circles and "
                                           "mostly ends there: most arcs are never looked at.",
                                           "A proof takes longer than an axis."};
static const struct claim similar_gjk = {
    "III, IV",
    "without collision n-arcs are like polygons, but slightly slower",
    "time over n-gons', n up to 12",
    &slightly_slower,
    "Fewer support points: beside the best direction the gap of smooth shapes falls "
    "with the square of the angle, that of polygons in proportion to it.",
    "More support points."};
static const struct claim with_collision = {
    "III, IV",
    "with collisions n-arc SAT is significantly faster than both polygon algorithms",
    "contacts: time over the faster one's, n up to 12",
    &much_faster,
    "",
    "A pair of arcs takes four cross products and a dot product, a vertex and a "
    "side one dot product; and a vector of pairs is done when the last of them "
    "has met its arcs."};
static const struct claim same_contact = {"III, IV",
                                          "n-arc SAT costs the same with and without collisions",
                                          "contacts with over yes or no without, n up to 12",
                                          &the_same,
                                          "Colliding pairs are settled sooner.",
                                          "Depth, normal, point and arcs are computed and written only for pairs that "
                                          "collide."};
static const struct claim same_overlap = {"III, IV",
                                          "the same, yes or no in both scenes",
                                          "yes or no with over without, n up to 12",
                                          &the_same,
                                          "Colliding pairs are settled sooner.",
                                          "One direction with a gap proves that bodies are apart; that they collide is "
                                          "proved by a common point or by all directions."};
static const struct claim faster_with = {"III",
                                         "n-arc SAT is slightly faster with a collision for 10 and 12 arcs",
                                         "time with over time without, n = 10 and 12",
                                         &slightly_faster,
                                         "",
                                         "Depth, normal, point and arcs are computed and written only for pairs that "
                                         "collide; and the first pair that passes comes no sooner."};
static const struct claim overtakes = {"III",
                                       "for more arcs than were tested polygon GJK overtakes n-arc SAT",
                                       "contacts: n from which on GJK on n-gons is faster",
                                       &beyond_figures,
                                       "It does so already at fewer.",
                                       directed};
static const struct claim worst_at_four = {
    "III",
    "n-arc GJK with EPA is worst at 4 arcs",
    "contacts: time at 4 over those at 6 to 12",
    &slower,
    "4 arcs take the most support points, but each costs less than those of more "
    "arcs.",
    ""};
static const struct claim fewer_points = {"III",
                                          "with more arcs EPA needs fewer iterations",
                                          "support points over those of the n before, up to 12",
                                          &faster,
                                          "",
                                          ""};
static const struct claim very_poor = {"III",
                                       "n-arc GJK with EPA is very poor",
                                       "contacts: time over n-gon GJK's, n up to 12",
                                       &much_slower,
                                       "Arcs take more support points than polygons, but not all of the time goes to "
                                       "them.",
                                       ""};
static const struct claim epa_linear = {"II",
                                        "EPA on polygons takes at most O(n) iterations",
                                        "exponent of n of the most support points of a pair, threshold 1e-6",
                                        &at_most_linear,
                                        "",
                                        ""};
static const struct claim threshold_claim = {"II",
                                             "EPA's cost on n-arcs depends strongly on the threshold",
                                             "contacts: time at 1e-5 over time at 1e-1, n = 4",
                                             &strong,
                                             "A tenth of the threshold costs one to two support points more, as each "
                                             "divides the error of a curve by about four.",
                                             ""};
static const struct claim nearly_constant = {"II",
                                             "GJK from the last frame's simplex takes near constant time",
                                             "exponent of n from n = 8 on, slow motion",
                                             &constant,
                                             "It becomes faster with n.",
                                             "A support point costs more, the more arcs there are."};
static const struct claim warm_faster = {"II",
                                         "GJK is improved by starting from the last frame's simplex",
                                         "yes or no: time over a cold start's, n = 8",
                                         &faster,
                                         "",
                                         "A cold start needs few support points, and for bodies that collide three are "
                                         "needed to see that the last simplex still serves."};
static const struct claim few_arcs = {"IV",
                                      "for few arcs n-arc SAT is faster than n-arc GJK",
                                      "time over n-arc GJK's, n up to 8",
                                      &faster,
                                      "",
                                      "All pairs of arcs are tried until one passes; GJK looks few support points up."};
static const struct claim few_arcs_more = {"IV",
                                           "especially with a collision",
                                           "that ratio with collision over that without, n up to 8",
                                           &faster,
                                           "",
                                           "Of n-arc SAT the contacts cost more too."};
static const struct claim storage = {"II",
                                     "n-arcs need slightly more storage than polygons",
                                     "bytes of an n-arc over those of an n-gon, n up to 12",
                                     &slightly_more,
                                     "",
                                     ""};
static const struct claim normalising = {"II",
                                         "to normalise computed perpendiculars is a significant cost",
                                         "plain C, depth: time over that with stored normals, n up to 12",
                                         &significant,
                                         "A root and a division for each side are few beside a product for each side "
                                         "and vertex.",
                                         ""};
static const struct claim not_normalising = {
    "II",
    "perpendiculars are easily computed",
    "plain C, yes or no, lengths left alone: time over that with stored normals, "
    "n up to 12",
    &the_same,
    "Stored normals must be rotated; sides of placed vertices are "
    "differences.",
    ""};

#endif
