/* SPDX-License-Identifier: MIT
 *
 * list.c - which rows there are. Rows are named query/shapes/scene/distinct/order/who, such as
 * overlap/n8/mixed/unique/random/avx512; README.md in the folder above says what each part means.
 */
#include "list.h"

#include <stdio.h>
#include <string.h>

#include "common.h"
#include "peers.h"
#include "rows.h"

enum { MAX_ROWS = 4096 };

static const unsigned arc_counts[] = {4, 6, 8, 12, 16};
enum { ARC_COUNTS = sizeof arc_counts / sizeof arc_counts[0] };

static struct bench_row *rows[MAX_ROWS];
static size_t row_count;
static size_t pair_count, packing_count;

/* ------------------------------------------------------------------------------------------------ rows */

bool is_listed(const char *name) {
    for (size_t k = 0; k < row_count; k++)
        if (strcmp(rows[k]->name, name) == 0)
            return true;
    return false;
}

void list_row(struct bench_row *row) {
    if (row_count == MAX_ROWS)
        fail("more than %d rows", MAX_ROWS);
    rows[row_count++] = row;
    bench_add(row);
}

static struct workload_key n_arcs(unsigned n, enum scene scene) {
    return (struct workload_key){
        .edges = n, .scene = scene, .pair_count = scene == SCENE_PACKING ? packing_count : pair_count};
}

static struct workload_key templates(struct workload_key key) {
    key.variety = TEMPLATES;
    return key;
}

static struct workload_key sorted(struct workload_key key) {
    key.sorted = true;
    return key;
}

static struct workload_key of_family(enum family family, struct workload_key key) {
    key.family = family;
    return key;
}

static void add_narc(const char *title, enum query query, struct workload_key key, const char *isa, unsigned threads,
                     size_t part) {
    char workload[BENCH_NAME / 2], name[BENCH_NAME], suffix[32] = "";
    name_workload(&key, workload, sizeof workload);
    if (part < key.pair_count)
        snprintf(suffix, sizeof suffix, "/%zupairs", part);
    snprintf(name, sizeof name, "%s/%s/%s%s%s", title, workload, isa, threads == 2 ? "/2threads" : "", suffix);
    if (is_listed(name))
        return;
    const struct narc_job job = {.query = query, .key = key, .isa = isa, .threads = threads, .pair_count = part};
    if (threads > narc_openmp_workers(0).count)
        bench_skip(name, "fewer threads here");
    else
        list_row(make_narc_row(name, &job));
}

static void add_both(struct workload_key key, const char *isa, unsigned threads) {
    add_narc("overlap", QUERY_OVERLAP, key, isa, threads, key.pair_count);
    add_narc("contact", QUERY_CONTACT, key, isa, threads, key.pair_count);
}

static void add_peer(const struct peer *peer, struct workload_key key) {
    char workload[BENCH_NAME / 2], name[BENCH_NAME];
    name_workload(&key, workload, sizeof workload);
    snprintf(name, sizeof name, "%s/%s/%s", peer->query, workload, peer->name);
    if (is_listed(name))
        return;
    if (peer->missing)
        bench_skip(name, peer->missing);
    else if (key.edges <= peer->max_edges)
        list_row(make_peer_row(name, peer, &key));
}

/* ------------------------------------------------------------------------------------------------ which */

static void add_isa(const char *isa) {
    const struct workload_key mixed = n_arcs(8, SCENE_MIXED);
    for (size_t k = 0; k < ARC_COUNTS; k++)
        add_both(n_arcs(arc_counts[k], SCENE_MIXED), isa, 1);
    add_both(n_arcs(8, SCENE_DISJOINT), isa, 1);
    add_both(n_arcs(8, SCENE_COLLIDING), isa, 1);
    add_both(templates(mixed), isa, 1);
    add_both(sorted(mixed), isa, 1);
    add_both(sorted(templates(mixed)), isa, 1);
    add_both(of_family(FAMILY_KINDS, mixed), isa, 1);
    add_both(of_family(FAMILY_GENERAL, mixed), isa, 1);
    add_both(of_family(FAMILY_CAPSULES, mixed), isa, 1);
    add_narc("floor", QUERY_OVERLAP, of_family(FAMILY_BOUNDS, mixed), isa, 1, mixed.pair_count);
    add_narc("floor", QUERY_OVERLAP, of_family(FAMILY_BOUNDS, templates(mixed)), isa, 1, mixed.pair_count);
    add_narc("unhinted", QUERY_FRAMES, templates(mixed), isa, 1, mixed.pair_count);
    add_narc("hinted", QUERY_HINTED, templates(mixed), isa, 1, mixed.pair_count);
}

static void add_best(const char *isa) {
    const struct workload_key packing = sorted(n_arcs(8, SCENE_PACKING));
    for (unsigned threads = 1; threads <= 2; threads++) {
        add_both(n_arcs(8, SCENE_MIXED), isa, threads);
        add_both(packing, isa, threads);
        for (size_t part = 64; part < packing.pair_count; part *= 4)
            add_narc("overlap", QUERY_OVERLAP, packing, isa, threads, part);
    }
}

static void add_peers(void) {
    for (size_t p = 0; all_peers[p]; p++) {
        for (size_t k = 0; k < ARC_COUNTS; k++)
            add_peer(all_peers[p], n_arcs(arc_counts[k], SCENE_MIXED));
        add_peer(all_peers[p], n_arcs(8, SCENE_DISJOINT));
        add_peer(all_peers[p], n_arcs(8, SCENE_COLLIDING));
        add_peer(all_peers[p], templates(n_arcs(8, SCENE_MIXED)));
    }
}

/* Bit by bit: templates, sorted. */
static struct workload_key variant(unsigned n, enum scene scene, unsigned bits) {
    struct workload_key key = n_arcs(n, scene);
    key.variety = bits & 1 ? TEMPLATES : UNIQUE;
    key.sorted = bits & 2;
    return key;
}

static void add_everything(void) {
    for (size_t k = 0; k < ARC_COUNTS; k++) {
        for (enum scene scene = SCENE_DISJOINT; scene <= SCENE_PACKING; scene++) {
            for (unsigned bits = 0; bits < 4; bits++) {
                const struct workload_key key = variant(arc_counts[k], scene, bits);
                for (size_t isa = 0; narc_isa_name(isa); isa++)
                    for (unsigned threads = 1; threads <= 2 && narc_isa_supported(narc_isa_name(isa)); threads++)
                        add_both(key, narc_isa_name(isa), threads);
                for (size_t p = 0; all_peers[p]; p++)
                    add_peer(all_peers[p], key);
            }
        }
    }
}

static void skip_isa(const char *isa) {
    char name[BENCH_NAME];
    snprintf(name, sizeof name, "overlap/n8/mixed/unique/random/%s", isa);
    bench_skip(name, "not supported here");
    snprintf(name, sizeof name, "contact/n8/mixed/unique/random/%s", isa);
    bench_skip(name, "not supported here");
}

/* ------------------------------------------------------------------------------------------------ all */

struct row_list list_rows(const struct row_choice *choice) {
    pair_count = choice->pair_count;
    packing_count = choice->packing_count;
    list_settled(choice);
    for (size_t k = 0; narc_isa_name(k); k++)
        if (narc_isa_supported(narc_isa_name(k)))
            add_isa(narc_isa_name(k));
    add_best(choice->best_isa);
    add_peers();
    if (choice->all)
        add_everything();
    for (size_t k = 0; narc_isa_name(k); k++)
        if (!narc_isa_supported(narc_isa_name(k)))
            skip_isa(narc_isa_name(k));
    return (struct row_list){rows, row_count};
}
