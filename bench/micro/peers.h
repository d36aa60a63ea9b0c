/* SPDX-License-Identifier: MIT
 *
 * peers.h - what this library is compared with, behind one C interface.
 */
#ifndef NARC_BENCH_PEERS_H
#define NARC_BENCH_PEERS_H

#include "workload.h"

#ifdef __cplusplus
extern "C" {
#endif

struct peer {
    const char *name;    /* of its rows: "overlap/n8/mixed/unique/random/NAME" */
    const char *query;   /* "overlap": one bit; "contact": points and normal as well */
    const char *missing; /* NULL, or why it can't run */
    bool polygons;       /* it answers for the polygon of the junctions, not for the n-arc */
    bool capsules;       /* it has capsules; else boxes as large stand for them */
    unsigned max_edges;
    void *(*create)(const struct workload *workload); /* shapes and poses in the form it wants them */
    void (*run)(void *context, const struct pair *pairs, size_t count, uint8_t *out_colliding);
};

/* A library that keeps bodies and their pairs itself. */
struct world_peer {
    const char *name;    /* of its rows: "step/n8/settled/few/sorted/NAME" */
    const char *missing; /* NULL, or why it can't run */
    bool own_clock;      /* step() does more than find pairs and contacts, and returns the seconds of these alone */
    unsigned max_edges;
    void *(*create)(const struct workload *workload); /* the bodies of a pile, at rest */
    double (*step)(void *context);                    /* its boxes, pairs and contacts */
    size_t (*count_touching)(void *context);
};

extern const struct peer plain_paper, plain_exact; /* plain.c */
extern const struct peer box2d_collide, box2d_overlap;
const char *box2d_name(void); /* with its version */
extern const struct peer chipmunk_collide;
extern const struct peer ccd_gjk, ccd_mpr;

extern const struct world_peer box2d_world, chipmunk_space;

/* The row of a peer; `key` is that of the n-arcs. */
struct bench_row *make_peer_row(const char *name, const struct peer *peer, const struct workload_key *key);

struct bench_row *make_world_row(const char *name, const struct world_peer *peer, const struct workload_key *key);

/* All peers, those that are not in this build as well; NULL behind the last. */
extern const struct peer *const all_peers[];
extern const struct world_peer *const all_world_peers[];

#ifdef __cplusplus
}
#endif

#endif
