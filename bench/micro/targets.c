/* SPDX-License-Identifier: MIT
 *
 * targets.c - the targets: the time of one row divided by that of another, of the same run.
 */
#include "report.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum bound { AT_LEAST, AT_MOST, WITHIN /* a factor, either way */ };

/* The time of `above` divided by that of `below`. "KIND" stands for all kinds of shapes, "SCENE" for all scenes but
 * the settled ones: the one furthest from the target counts, and is named. */
struct target {
    const char *what;
    const char *above, *below;
    enum bound bound;
    double limit;
};

static const char *const kinds[] = {"n4", "n8", "n12", "rounded", "boxes", "discs", "capsules", "kinds", NULL};
static const char *const scenes[] = {
    "n8/mixed/unique/random",    "n8/mixed/templates/random",   "n8/mixed/unique/sorted",
    "n8/disjoint/unique/random", "n8/colliding/unique/random",  "n8/packing/unique/sorted",
    "kinds/mixed/unique/random", "general/mixed/unique/random", NULL};

#define PILE(query, kind, who)        query "/" kind "/settled/few/sorted/" who
#define UNLIKE_PILE(query, kind, who) query "/" kind "/settled/unique/sorted/" who
#define SMALL_PILE(query, who)        query "/n8/settled-small/few/sorted/" who
#define LARGE_PILE(query, who)        query "/n8/settled-large/few/sorted/" who
#define BOX2D(n)                      "contact/n" #n "/mixed/unique/random/box2d-collide"

/* One thread and 64 shapes, unless said otherwise. */
static const struct target settled_targets[] = {
    {"contact, 8 arcs, against Box2D", PILE("contact", "n8", "box2d-collide"), PILE("contact", "n8", "BEST"), AT_LEAST,
     10},
    {"contact with hints, 8 arcs, against Box2D", PILE("contact", "n8", "box2d-collide"), PILE("hinted", "n8", "BEST"),
     AT_LEAST, 15},
    {"contact, 4 arcs, against Box2D", PILE("contact", "n4", "box2d-collide"), PILE("contact", "n4", "BEST"), AT_LEAST,
     5},
    {"contact with hints, 4 arcs, against Box2D", PILE("contact", "n4", "box2d-collide"), PILE("hinted", "n4", "BEST"),
     AT_LEAST, 7},
    {"contact, 8 arcs, 4,096 shapes, against Box2D", UNLIKE_PILE("contact", "n8", "box2d-collide"),
     UNLIKE_PILE("contact", "n8", "BEST"), AT_LEAST, 7},
    {"contact with hints, 8 arcs, 4,096 shapes, against Box2D", UNLIKE_PILE("contact", "n8", "box2d-collide"),
     UNLIKE_PILE("hinted", "n8", "BEST"), AT_LEAST, 10.5},
    {"contact, 4 arcs, 4,096 shapes, against Box2D", UNLIKE_PILE("contact", "n4", "box2d-collide"),
     UNLIKE_PILE("contact", "n4", "BEST"), AT_LEAST, 3.5},
    {"contact with hints, 4 arcs, 4,096 shapes, against Box2D", UNLIKE_PILE("contact", "n4", "box2d-collide"),
     UNLIKE_PILE("hinted", "n4", "BEST"), AT_LEAST, 4.9},
    {"contact, capsules, against Box2D's", PILE("contact", "capsules", "box2d-collide"),
     PILE("contact", "capsules", "BEST"), AT_LEAST, 6},
    {"manifolds, capsules, against Box2D's", PILE("contact", "capsules", "box2d-collide"),
     PILE("manifold", "capsules", "BEST"), AT_LEAST, 6},
    {"manifolds, capsules, 4,096 shapes, against Box2D's", UNLIKE_PILE("contact", "capsules", "box2d-collide"),
     UNLIKE_PILE("manifold", "capsules", "BEST"), AT_LEAST, 6},
    {"manifolds, capsules, AVX2, against Box2D's", PILE("contact", "capsules", "box2d-collide"),
     PILE("manifold", "capsules", "avx2"), AT_LEAST, 6},
    {"contact, capsules, AVX2, against Box2D's", PILE("contact", "capsules", "box2d-collide"),
     PILE("contact", "capsules", "avx2"), AT_LEAST, 6},
    {"overlap, time against contact, KIND", PILE("overlap", "KIND", "BEST"), PILE("contact", "KIND", "BEST"), AT_MOST,
     0.75},
    {"overlap, time against contact, 4,096 shapes, KIND", UNLIKE_PILE("overlap", "KIND", "BEST"),
     UNLIKE_PILE("contact", "KIND", "BEST"), AT_MOST, 0.75},
    {"overlap, time against contact, SCENE", "overlap/SCENE/BEST", "contact/SCENE/BEST", AT_MOST, 0.75},
    {"contact of discs, against a plain loop", PILE("contact", "discs", "scalar-loop"),
     PILE("contact", "discs", "BEST"), AT_LEAST, 1},
    {"contact of discs, time against a loop by hand in AVX2", PILE("contact", "discs", "BEST"),
     PILE("contact", "discs", "avx2-loop"), AT_MOST, 2},
    {"contact with hints, 8 arcs, time against contact of discs", PILE("hinted", "n8", "BEST"),
     PILE("contact", "discs", "BEST"), AT_MOST, 1.3},
    {"contact, time with hints against without, KIND", PILE("hinted", "KIND", "BEST"), PILE("contact", "KIND", "BEST"),
     AT_MOST, 1},
    {"contact, time with hints against without, rounded polygons", PILE("hinted", "rounded", "BEST"),
     PILE("contact", "rounded", "BEST"), AT_MOST, 0.7},
    {"manifolds with hints, time against contacts with hints, KIND", PILE("manifold", "KIND", "BEST"),
     PILE("hinted", "KIND", "BEST"), AT_MOST, 1.25},
    {"whole step, 2,000 bodies, against Box2D's", SMALL_PILE("step", "box2d-world"), SMALL_PILE("step", "BEST"),
     AT_LEAST, 3},
    {"whole step, 30,000 bodies, against Box2D's", PILE("step", "n8", "box2d-world"), PILE("step", "n8", "BEST"),
     AT_LEAST, 3},
    {"the same with pairs kept, 2,000 bodies", SMALL_PILE("step", "box2d-world"), SMALL_PILE("kept", "BEST"), AT_LEAST,
     5},
    {"the same with pairs kept, 30,000 bodies", PILE("step", "n8", "box2d-world"), PILE("kept", "n8", "BEST"), AT_LEAST,
     5},
    {"step at rest, 10,000 bodies of which 1 % move, time against a full search", PILE("update", "n8", "BEST/1of100"),
     PILE("update", "n8", "BEST/1of1"), AT_MOST, 0.15},
    {"step at rest, 10,000 bodies of which none moves, time against a full search", PILE("update", "n8", "BEST/1of0"),
     PILE("update", "n8", "BEST/1of1"), AT_MOST, 0.1},
    {"contacts of the example world, 10,000 bodies, time against manifolds",
     PILE("world-contact", "n8", "BEST/10000bodies"), PILE("world-manifold", "n8", "BEST/10000bodies"), AT_MOST, 1},
    {"contacts of the example world, 30,000 bodies, time against manifolds",
     PILE("world-contact", "n8", "BEST/30000bodies"), PILE("world-manifold", "n8", "BEST/30000bodies"), AT_MOST, 1},
    {"boxes and pairs, a million bodies, time against manifolds",
     LARGE_PILE("boxes", "BEST") " + " LARGE_PILE("pairs", "BEST"), LARGE_PILE("manifold", "BEST"), AT_MOST, 1},
    {"whole step, a million bodies, 2 threads against 1", LARGE_PILE("step", "BEST"),
     LARGE_PILE("step", "BEST/2threads"), AT_LEAST, 1.8},
    {"contact, batches of 16, time against 65,536", PILE("contact", "n8", "BEST/by16"),
     PILE("contact", "n8", "BEST/by65536"), AT_MOST, 2},
    {"contact, batches of 64, time against 65,536", PILE("contact", "n8", "BEST/by64"),
     PILE("contact", "n8", "BEST/by65536"), AT_MOST, 1.3},
    {"contact, batches of 256, time against 65,536", PILE("contact", "n8", "BEST/by256"),
     PILE("contact", "n8", "BEST/by65536"), AT_MOST, 1.1},
    {"contact, 8 arcs, AVX2 against AVX-512", PILE("contact", "n8", "avx512"), PILE("contact", "n8", "avx2"), AT_LEAST,
     0.8},
    {"contact with hints, 8 arcs, AVX2 against AVX-512", PILE("hinted", "n8", "avx512"), PILE("hinted", "n8", "avx2"),
     AT_LEAST, 0.8},
    {"contact, 4 arcs, AVX2 against AVX-512", PILE("contact", "n4", "avx512"), PILE("contact", "n4", "avx2"), AT_LEAST,
     0.8},
    {"contact with hints, 4 arcs, AVX2 against AVX-512", PILE("hinted", "n4", "avx512"), PILE("hinted", "n4", "avx2"),
     AT_LEAST, 0.8},
};

static const struct target targets[] = {
    {"overlap, n = 8, against Box2D", BOX2D(8), "overlap/n8/mixed/unique/random/BEST", AT_LEAST, 12},
    {"overlap, n = 4, against Box2D", BOX2D(4), "overlap/n4/mixed/unique/random/BEST", AT_LEAST, 12},
    {"contact, n = 8, against Box2D", BOX2D(8), "contact/n8/mixed/unique/random/BEST", AT_LEAST, 8},
    {"overlap, n = 8, AVX2, against Box2D", BOX2D(8), "overlap/n8/mixed/unique/random/avx2", AT_LEAST, 8},
    {"overlap, n = 4, AVX2, against Box2D", BOX2D(4), "overlap/n4/mixed/unique/random/avx2", AT_LEAST, 8},
    {"contact, n = 8, AVX2, against Box2D", BOX2D(8), "contact/n8/mixed/unique/random/avx2", AT_LEAST, 6},
    {"overlap, n = 8, templates, time against the circle floor", "overlap/n8/mixed/templates/random/BEST",
     "floor/n8/mixed/templates/random/BEST", AT_MOST, 4},
    {"contact with hints, templates, time against without", "hinted/n8/mixed/templates/random/BEST",
     "unhinted/n8/mixed/templates/random/BEST", AT_MOST, 0.5},
    {"overlap, time of n = 16 against n = 4", "overlap/n16/mixed/unique/random/BEST",
     "overlap/n4/mixed/unique/random/BEST", AT_MOST, 2.5},
    {"overlap, n = 8, time of colliding against disjoint", "overlap/n8/colliding/unique/random/BEST",
     "overlap/n8/disjoint/unique/random/BEST", WITHIN, 1.5},
    {"overlap, one million pairs, 2 threads against 1", "overlap/n8/packing/unique/sorted/BEST",
     "overlap/n8/packing/unique/sorted/BEST/2threads", AT_LEAST, 1.85},
    {"overlap, general pairs, n = 8, time against n-arcs", "overlap/general/mixed/unique/random/BEST",
     "overlap/n8/mixed/unique/random/BEST", AT_MOST, 2},
    {"contact, general pairs, n = 8, time against n-arcs", "contact/general/mixed/unique/random/BEST",
     "contact/n8/mixed/unique/random/BEST", AT_MOST, 2},
};

/* ------------------------------------------------------------------------------------------------ reached */

struct reached {
    double above, below;
    const char *which; /* what stood for KIND or SCENE */
};

static double ratio_of(const struct reached *reached) { return reached->above / reached->below; }

static bool is_reached(const struct target *target, double ratio) {
    switch (target->bound) {
    case AT_LEAST:
        return ratio >= target->limit;
    case AT_MOST:
        return ratio <= target->limit;
    default:
        return ratio <= target->limit && ratio >= 1 / target->limit;
    }
}

/* The least (AT_LEAST) or the largest ratio of all that the word `key` stands for. NaN: none ran. */
static struct reached find_worst(const struct report *report, const struct target *target, const char *key,
                                 const char *const *values) {
    struct reached worst = {NAN, NAN, NULL};
    for (; *values; values++) {
        char above[BENCH_NAME], below[BENCH_NAME];
        replace_word(target->above, key, *values, above, sizeof above);
        replace_word(target->below, key, *values, below, sizeof below);
        const struct reached one = {time_of(report, above), time_of(report, below), *values};
        const double ratio = ratio_of(&one);
        if (!isnan(ratio) && !(target->bound == AT_LEAST ? ratio >= ratio_of(&worst) : ratio <= ratio_of(&worst)))
            worst = one;
    }
    return worst;
}

static struct reached reach(const struct report *report, const struct target *target) {
    if (strstr(target->what, "KIND"))
        return find_worst(report, target, "KIND", kinds);
    if (strstr(target->what, "SCENE"))
        return find_worst(report, target, "SCENE", scenes);
    return (struct reached){time_of(report, target->above), time_of(report, target->below), NULL};
}

static void print_list(const struct report *report, const char *title, const struct target *list, size_t count,
                       FILE *out) {
    static const char *const bounds[] = {"at least", "at most", "within a factor of"};
    bool any = false;
    for (size_t k = 0; k < count; k++) {
        const struct target *target = &list[k];
        const struct reached reached = reach(report, target);
        const double ratio = ratio_of(&reached);
        char what[128];
        if (isnan(ratio))
            continue;
        if (!any)
            fprintf(out, "| %s | target | reached | | ns per pair |\n| --- | --- | --- | --- | --- |\n", title);
        any = true;
        snprintf(what, sizeof what, "%s", target->what);
        if (reached.which) {
            char place[64];
            snprintf(place, sizeof place, "worst: %s", reached.which);
            replace_word(target->what, strstr(what, "KIND") ? "KIND" : "SCENE", place, what, sizeof what);
        }
        fprintf(out, "| %s | %s %g | %.2f | %s | %.2f / %.2f |\n", what, bounds[target->bound], target->limit, ratio,
                is_reached(target, ratio) ? "yes" : "no", reached.above, reached.below);
    }
    if (any)
        fputc('\n', out);
}

void print_settled_targets(const struct report *report, FILE *out) {
    print_list(report, "settled pile, 64 shapes, one thread", settled_targets,
               sizeof settled_targets / sizeof settled_targets[0], out);
}

void print_targets(const struct report *report, FILE *out) {
    print_list(report, "other scenes", targets, sizeof targets / sizeof targets[0], out);
}
