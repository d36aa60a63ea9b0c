/* SPDX-License-Identifier: MIT
 *
 * targets.c - the targets: the time of one row divided by that of another, of the same run.
 */
#include <math.h>
#include <string.h>

#include "bench.h"
#include "lists.h"
#include "report.h"

enum bound { AT_LEAST, AT_MOST };

/* The time of `above` divided by that of `below`. "KIND" stands for all kinds of shapes, "SCENE" for all scenes but
 * piles: the one farthest from the target counts, and is named. */
struct target {
    const char *what, *above, *below;
    enum bound bound;
    double limit;
};

static const char *const kinds[] = {"n4", "n8", "n12", "rounded", "boxes", "discs", "capsules", "kinds", NULL};
static const char *const scenes[] = {"n8/mixed",    "n8/mixed-templates", "n8/mixed-sorted",
                                     "kinds/mixed", "general/mixed",      NULL};

/* Piles of 30,000 bodies with 64 shapes, one thread, unless said otherwise. */
static const struct target targets[] = {
    {"contact, 8 arcs, against Box2D", "contact/n8/pile/box2d", "contact/n8/pile/BEST", AT_LEAST, 10},
    {"4 arcs", "contact/n4/pile/box2d", "contact/n4/pile/BEST", AT_LEAST, 5},
    {"8 arcs, 4,096 shapes", "contact/n8/pile-unlike/box2d", "contact/n8/pile-unlike/BEST", AT_LEAST, 7},
    {"4 arcs, 4,096 shapes", "contact/n4/pile-unlike/box2d", "contact/n4/pile-unlike/BEST", AT_LEAST, 3.5},
    {"contact, capsules, against Box2D", "contact/capsules/pile/box2d", "contact/capsules/pile/BEST", AT_LEAST, 6},
    {"AVX2", "contact/capsules/pile/box2d", "contact/capsules/pile/avx2", AT_LEAST, 6},
    {"manifolds, capsules, against Box2D", "contact/capsules/pile/box2d", "manifold/capsules/pile/BEST", AT_LEAST, 6},
    {"AVX2", "contact/capsules/pile/box2d", "manifold/capsules/pile/avx2", AT_LEAST, 6},
    {"4,096 shapes", "contact/capsules/pile-unlike/box2d", "manifold/capsules/pile-unlike/BEST", AT_LEAST, 6},
    {"overlap, time against contact, KIND", "overlap/KIND/pile/BEST", "contact/KIND/pile/BEST", AT_MOST, 0.75},
    {"4,096 shapes, KIND", "overlap/KIND/pile-unlike/BEST", "contact/KIND/pile-unlike/BEST", AT_MOST, 0.75},
    {"other scenes, SCENE", "overlap/SCENE/BEST", "contact/SCENE/BEST", AT_MOST, 0.75},
    {"contact of discs, against a plain loop", "contact/discs/pile/loop", "contact/discs/pile/BEST", AT_LEAST, 1},
    {"manifolds, time against contacts, KIND", "manifold/KIND/pile/BEST", "contact/KIND/pile/BEST", AT_MOST, 1.25},
    {"whole step, all move, 8 arcs, against Box2D", "stay-moving/n8/pile/box2d", "stay-moving/n8/pile/BEST", AT_LEAST,
     9},
    {"a shape a body", "stay-moving/n8/pile-each/box2d", "stay-moving/n8/pile-each/BEST", AT_LEAST, 9},
    {"KIND", "stay-moving/KIND/pile/box2d", "stay-moving/KIND/pile/BEST", AT_LEAST, 6},
    {"all settle, recycled, KIND", "stay-settled-recycled/KIND/pile/box2d", "stay-settled-recycled/KIND/pile/BEST",
     AT_LEAST, 5},
    {"all move, time against AVX2, KIND", "stay-moving/KIND/pile/BEST", "stay-moving/KIND/pile/avx2", AT_LEAST, 0.8},
    {"10,000 boxes of which 1 % move, time against all", "stay-moving/boxes/pile-10000/BEST/1of100",
     "stay-moving/boxes/pile-10000/BEST", AT_MOST, 0.15},
    {"all pairs new, time against plain calls, 8 arcs", "stay-rain/n8/pile/BEST", "plain/n8/pile/BEST", AT_MOST, 1},
    {"boxes and pairs, a million bodies, time against manifolds",
     "boxes/n8/pile-1000000/BEST + pairs/n8/pile-1000000/BEST", "manifold/n8/pile-1000000/BEST", AT_MOST, 1},
    {"whole step, a million bodies, 2 threads against 1", "stay-moving/n8/pile-1000000/BEST",
     "stay-moving/n8/pile-1000000/BEST/2threads", AT_LEAST, 1.8},
    {"contact, batches of 16, time against 65,536", "contact/n8/pile/BEST/by16", "contact/n8/pile/BEST/by65536",
     AT_MOST, 2},
    {"batches of 64", "contact/n8/pile/BEST/by64", "contact/n8/pile/BEST/by65536", AT_MOST, 1.3},
    {"batches of 256", "contact/n8/pile/BEST/by256", "contact/n8/pile/BEST/by65536", AT_MOST, 1.1},
    {"mixed scene: overlap, n = 8, against Box2D", "contact/n8/mixed/box2d", "overlap/n8/mixed/BEST", AT_LEAST, 12},
    {"n = 4", "contact/n4/mixed/box2d", "overlap/n4/mixed/BEST", AT_LEAST, 12},
    {"contact, n = 8", "contact/n8/mixed/box2d", "contact/n8/mixed/BEST", AT_LEAST, 8},
    {"overlap, n = 8, AVX2", "contact/n8/mixed/box2d", "overlap/n8/mixed/avx2", AT_LEAST, 8},
    {"overlap, n = 4, AVX2", "contact/n4/mixed/box2d", "overlap/n4/mixed/avx2", AT_LEAST, 8},
    {"contact, n = 8, AVX2", "contact/n8/mixed/box2d", "contact/n8/mixed/avx2", AT_LEAST, 6},
    {"overlap, 16 shapes, time against their bounding circles", "overlap/n8/mixed-templates/BEST",
     "overlap/bounds8/mixed-templates/BEST", AT_MOST, 4},
    {"overlap, time of n = 16 against n = 4", "overlap/n16/mixed/BEST", "overlap/n4/mixed/BEST", AT_MOST, 2.5},
    {"overlap, a million bodies, 2 threads against 1", "overlap/n8/pile-1000000/BEST",
     "overlap/n8/pile-1000000/BEST/2threads", AT_LEAST, 1.85},
    {"overlap, 8-gons against 8-arcs, time against 8-arcs", "overlap/general/mixed/BEST", "overlap/n8/mixed/BEST",
     AT_MOST, 2},
    {"contact", "contact/general/mixed/BEST", "contact/n8/mixed/BEST", AT_MOST, 2},
};

struct reached {
    double above, below, ratio; /* NaN: none ran */
    const char *which;          /* what stood for KIND or SCENE */
};

/* The least (AT_LEAST) or the largest ratio of all that the word stands for. */
static struct reached find_reached(const struct target *target, const char *best_isa) {
    static const char *const itself[] = {"", NULL};
    const char *key = strstr(target->what, "KIND") ? "KIND" : "SCENE";
    const bool one = !strstr(target->what, key);
    struct reached worst = {NAN, NAN, NAN, NULL};
    for (const char *const *value = one ? itself : *key == 'K' ? kinds : scenes; *value; value++) {
        char above[BENCH_NAME], below[BENCH_NAME];
        replace_word(target->above, key, *value, above, sizeof above);
        replace_word(target->below, key, *value, below, sizeof below);
        struct reached now = {time_of(above, best_isa), time_of(below, best_isa), 0, one ? NULL : *value};
        now.ratio = now.above / now.below;
        if (!isnan(now.ratio) && !(target->bound == AT_LEAST ? now.ratio >= worst.ratio : now.ratio <= worst.ratio))
            worst = now;
    }
    return worst;
}

void print_targets(const char *best_isa, FILE *out) {
    static const char *const bounds[] = {"at least", "at most"};
    bool any = false;
    for (size_t k = 0; k < sizeof targets / sizeof targets[0]; k++) {
        const struct target *target = &targets[k];
        const struct reached reached = find_reached(target, best_isa);
        char what[128], worst[64];
        if (isnan(reached.ratio))
            continue;
        if (!any)
            fprintf(out, "| pile of 30,000 bodies, 64 shapes, one thread | target | reached | | ns |\n"
                         "| --- | --- | --- | --- | --- |\n");
        any = true;
        snprintf(what, sizeof what, "%s", target->what);
        if (reached.which) {
            snprintf(worst, sizeof worst, "worst: %s", reached.which);
            replace_word(target->what, strstr(what, "KIND") ? "KIND" : "SCENE", worst, what, sizeof what);
        }
        fprintf(out, "| %s | %s %g | %.2f | %s | %.2f / %.2f |\n", what, bounds[target->bound], target->limit,
                reached.ratio,
                (target->bound == AT_LEAST ? reached.ratio >= target->limit : reached.ratio <= target->limit) ? "yes"
                                                                                                              : "no",
                reached.above, reached.below);
    }
    if (any)
        fputc('\n', out);
}
