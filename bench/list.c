/* SPDX-License-Identifier: MIT
 *
 * list.c - which rows there are: each word of a group's queries with each of its shapes, scenes and who answers.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "rows.h"

enum { MAX_ROWS = 4096, WORD = 48 };

/* BEST: the best instruction set; EACH: each. */
struct group {
    const char *queries, *families, *layouts, *who;
};

#define QUERIES "overlap contact manifold"
#define KINDS   "n4 n8 n12 rounded boxes discs kinds capsules"
#define ALONE   "boxes capsules n8 gons8 rounded5 balls-boxes discs"
#define STEPS   "boxes pairs plain stay-moving"
#define STAY    "stay-moving stay-moving-recycled stay-settled stay-settled-recycled"
#define PARTLY  "BEST BEST/1of10 BEST/1of100 box2d/1of10 box2d/1of100"
#define SCENES  "pile pile-1000000"
#define FLIGHTS "impact-straight impact-turning impact-turning-6"
#define BOTH    "BEST BEST/by1 avx2 avx2/by1"

static const struct group groups[] = {
    {QUERIES, KINDS, "pile", "BEST"},
    {"contact manifold", KINDS, "pile", "avx2"},
    {"contact", KINDS, "pile", "box2d"},
    {"contact", "discs", "pile", "loop"},
    {"contact manifold", ALONE, "pile", "BEST/alone avx2/alone BEST/by1 avx2/by1"},
    {"contact", ALONE, "pile", "box2d"},
    {"contact", "n8", "pile", "BEST/by4 BEST/by16 BEST/by64 BEST/by256 BEST/by65536"},
    {STEPS, "n8", "pile-2000 pile pile-1000000", "BEST"},
    {"manifold", "n8", "pile-1000000", "BEST"},
    {STAY, "n4 n8 gons8 boxes capsules kinds", "pile", "BEST avx2 box2d"},
    {STAY, "n8", "pile-each", "BEST box2d"},
    {STAY, "squares", "pyramid-templates", "BEST box2d"},
    {"stay-moving stay-moving-recycled", "n8", "pile", PARTLY},
    {"stay-moving stay-moving-recycled", "boxes", "pile-10000", PARTLY},
    {"stay-moving stay-moving-recycled", "squares", "pyramid-templates", PARTLY},
    {"plain stay-rain", "n8 boxes kinds", "pile", "BEST"},
    {"worlds", "boxes", "pile", "BEST"},
    {"stay-rain", "n8 boxes kinds", "pile", "box2d"},
    {QUERIES, "squares", "pyramid pyramid-templates", "BEST"},
    {"contact", "squares", "pyramid pyramid-templates", "box2d"},
    {"overlap contact", "n4 n6 n8 n12 n16", "pile", "BEST avx2"},
    {"overlap contact", "boxes n8", "pile", "EACH"},
    {"overlap", "n4 n6 n8", "pile", "box2d"},
    {"contact", "n6", "pile", "box2d"},
    {"overlap", "n4 n6 n8 n12 n16", "pile", "ccd-gjk ccd-mpr"},
    {"ray-fan ray-long ray-short", "gons8", SCENES, BOTH " box2d"},
    {"ray-fan ray-long ray-short", "n8", SCENES, "BEST"},
    {"region-48 region-3", "gons8", SCENES, "BEST BEST/by1 box2d geos"},
    {"nearest", "gons8", SCENES, "BEST BEST/by1"},
    {"nearest", "n8", SCENES, "BEST BEST/by1"},
    {"distance", "n8", SCENES, "BEST"},
    {"named-ray", "gons8", "pile", BOTH " box2d"},
    {"distance inside inside-one", "gons8", "pile", "BEST avx2 box2d"},
    {"distance", "gons8", "pile", "BEST/by1 avx2/by1"},
    {"hull-8", "points", "clouds", "BEST box2d"},
    {"hull-200", "points", "clouds", "BEST"},
    {"polyline", "n8 gons8", "pile", "BEST"},
    {FLIGHTS, "squares slabs gons8 n8", "flights", "BEST BEST/alone avx2 avx2/alone box2d"},
    {"index-good index-fast", "gons8", SCENES, "BEST"},
    {"move-1 move-100 move-2000 move-near-2000", "gons8", SCENES, "BEST box2d"},
    {"ground-none ground-among", "boxes", "hills short-hills", "BEST avx2"},
    {"ground-among ground-pairs", "balls boxes", "few-hills plane", "BEST avx2 box2d"},
};

static struct row *rows[MAX_ROWS];
static size_t row_count;
static const char *best;
static unsigned threads;

const struct row *get_row(size_t index) { return index < row_count ? rows[index] : NULL; }

size_t batch_of(const struct row *row, size_t done) {
    const size_t left = row->bench.count - done;
    return row->batch > 0 && row->batch < left ? row->batch : left;
}

/* ------------------------------------------------------------------------------------------------ rows */

static const struct question *find_question(const char *query) {
    static const struct question *const lists[] = {pair_questions,   step_questions,   scene_questions,
                                                   impact_questions, ground_questions, outline_questions};
    for (size_t k = 0; k < sizeof lists / sizeof lists[0]; k++)
        for (const struct question *question = lists[k]; question->name; question++)
            if (strcmp(question->name, query) == 0)
                return question;
    fail("no query is called %s", query);
}

static void prepare(struct bench_row *bench_row) {
    struct row *row = (struct row *)bench_row;
    narc_error error;
    if (!row->peer)
        must(narc_set_isa(row->isa, &error), &error);
    if (row->state)
        return;
    row->scene = row->layout ? get_scene(row->family, row->layout, false) : NULL;
    row->question->prepare(row);
}

static void run(struct bench_row *bench_row) {
    struct row *row = (struct row *)bench_row;
    row->question->run(row);
}

/* What stands behind who answers. */
static void read_suffix(struct row *row, const char *suffix) {
    size_t number;
    row->one_of = 1;
    for (; *suffix; suffix += strcspn(suffix, "/")) {
        suffix++;
        if (sscanf(suffix, "by%zu", &number) == 1)
            row->batch = number;
        else if (sscanf(suffix, "1of%zu", &number) == 1)
            row->one_of = number;
        else
            row->alone = true;
    }
}

/* The shapes that a peer has in the place of these. */
static const struct family *family_for(const struct peer *peer, const struct family *family) {
    char polygons[WORD];
    if (family->form != FORM_N_ARC || peer->arcs)
        return family;
    snprintf(polygons, sizeof polygons, "gons%u", family->edges);
    return find_family(polygons);
}

/* Whatever the row lacks to run here, or NULL. */
static const char *find_missing(const struct row *row) {
    if (row->peer && row->peer->missing)
        return row->peer->missing;
    return !row->peer && !narc_isa_supported(row->isa) ? "not supported here" : NULL;
}

static bool is_listed(const char *name) {
    for (size_t k = 0; k < row_count; k++)
        if (strcmp(rows[k]->bench.name, name) == 0)
            return true;
    return false;
}

static void add_row(const char *query, const char *family, const char *layout, const char *who) {
    const char *const suffix = who + strcspn(who, "/");
    char answers[WORD], name[BENCH_NAME];
    snprintf(answers, sizeof answers, "%.*s", (int)(suffix - who), who);
    if (strcmp(answers, "BEST") == 0)
        snprintf(answers, sizeof answers, "%s", best);
    snprintf(name, sizeof name, "%s/%s/%s/%s%s", query, family, layout, answers, suffix);
    struct row row = {.question = find_question(query),
                      .family = find_family(family),
                      .layout = find_layout(layout),
                      .peer = find_peer(query, answers)};
    for (size_t k = 0; !row.peer && narc_isa_name(k); k++)
        if (strcmp(narc_isa_name(k), answers) == 0)
            row.isa = narc_isa_name(k);
    read_suffix(&row, suffix);
    const char *missing = find_missing(&row);
    if (!row.peer && !row.isa)
        fail("nobody is called %s", answers);
    if (is_listed(name) || (row.peer && row.family && row.family->edges > row.peer->max_edges && !missing))
        return;
    if (missing) {
        bench_skip(name, missing);
        return;
    }
    if (row.peer && row.family)
        row.family = family_for(row.peer, row.family);
    narc_openmp_workers(threads, &row.workers);
    row.bench = (struct bench_row){.prepare = prepare,
                                   .run = run,
                                   .threaded = threads > 1,
                                   .own_clock = row.question->own_clock || (row.peer && row.peer->own_clock),
                                   .must_be_right = !row.peer};
    memcpy(row.bench.name, name, sizeof name);
    if (row_count == MAX_ROWS)
        fail("more than %d rows", MAX_ROWS);
    rows[row_count] = allocate(1, sizeof row);
    *rows[row_count] = row;
    bench_add(&rows[row_count++]->bench);
}

/* ------------------------------------------------------------------------------------------------ groups */

/* The first word; false behind the last one. */
static bool next_word(const char **words, char out[WORD]) {
    *words += strspn(*words, " ");
    const size_t length = strcspn(*words, " ");
    snprintf(out, WORD, "%.*s", (int)length, *words);
    *words += length;
    return length > 0;
}

static void add_group(const struct group *group) {
    char query[WORD], family[WORD], layout[WORD], who[WORD];
    for (const char *q = group->queries; next_word(&q, query);)
        for (const char *f = group->families; next_word(&f, family);)
            for (const char *l = group->layouts; next_word(&l, layout);)
                for (const char *w = group->who; next_word(&w, who);) {
                    if (strcmp(who, "EACH") != 0)
                        add_row(query, family, layout, who);
                    else
                        for (size_t k = 0; narc_isa_name(k); k++)
                            add_row(query, family, layout, narc_isa_name(k));
                }
}

void list_rows(const char *best_isa, unsigned on_threads) {
    threads = on_threads;
    best = best_isa;
    for (size_t k = 0; k < sizeof groups / sizeof groups[0]; k++)
        add_group(&groups[k]);
}
