/* SPDX-License-Identifier: MIT
 *
 * pairs.c - rows of pairs: a batch call of this library or a peer's loop, and the check of what it answers.
 */
#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "rows.h"

/* In a pile every run takes the other of two frames, whatever is asked. */
enum query {
    QUERY_OVERLAP,
    QUERY_CONTACT,
    QUERY_MANIFOLD,
};

struct pairs {
    struct scene *frames[2]; /* in one frame both are the same */
    size_t runs, found;
    uint64_t *bits;
    narc_contact *contacts;
    narc_body *bodies[2]; /* of the frames, for calls of two */
    uint8_t *colliding;   /* of a peer */
};

narc_manifold *share_manifolds(size_t count) {
    static narc_manifold *list;
    static size_t room;
    if (count > room) {
        free(list);
        list = allocate(count, sizeof *list);
        room = count;
    }
    return list;
}

float deepest_separation(const narc_manifold *manifold) {
    const float first = manifold->point[0].separation, second = manifold->point[1].separation;
    return manifold->count == 2 && second < first ? second : first;
}

/* ------------------------------------------------------------------------------------------------ this library */

/* All pairs in one call, or so many in each. */
static narc_status find_rows(const struct row *row, const struct scene *scene, const narc_bodies *bodies,
                             const narc_pairs *pairs, narc_query query, narc_error *error) {
    struct pairs *p = row->state;
    narc_status status = NARC_OK;
    narc_manifold *manifolds = row->question->what == QUERY_MANIFOLD ? share_manifolds(pairs->count) : NULL;
    for (p->found = 0; query.first < pairs->count && status == NARC_OK; query.first += query.count) {
        const size_t room = pairs->count - p->found;
        size_t found = 0;
        query.count = batch_of(row, query.first);
        status =
            manifolds
                ? narc_find_manifolds(scene->shapes, bodies, pairs, &query, manifolds + p->found, room, &found, error)
                : narc_find_contacts(scene->shapes, bodies, pairs, &query, p->contacts + p->found, room, &found, error);
        p->found += found;
    }
    return status;
}

/* Two bodies in each call. */
static narc_status find_alone(const struct row *row, const struct scene *scene, const narc_body *bodies,
                              narc_error *error) {
    struct pairs *p = row->state;
    narc_status status = NARC_OK;
    narc_manifold *manifolds = row->question->what == QUERY_MANIFOLD ? share_manifolds(row->bench.count) : NULL;
    p->found = 0;
    for (size_t k = 0; k < row->bench.count && status == NARC_OK; k++) {
        const narc_body *a = &bodies[scene->pairs[k].a], *b = &bodies[scene->pairs[k].b];
        if (manifolds) {
            narc_manifold *row_of = &manifolds[p->found];
            status = narc_find_manifold(scene->shapes, a, b, NULL, row_of, error);
            row_of->pair = (uint32_t)k;
            p->found += row_of->count > 0;
        } else {
            narc_contact *row_of = &p->contacts[p->found];
            status = narc_find_contact(scene->shapes, a, b, NULL, row_of, error);
            row_of->pair = (uint32_t)k;
            p->found += row_of->count > 0;
        }
    }
    return status;
}

static void run(struct row *row) {
    struct pairs *p = row->state;
    const size_t frame = p->runs++ % 2;
    const struct scene *scene = p->frames[frame];
    const narc_bodies bodies = bodies_of_scene(scene);
    const narc_pairs pairs = pairs_of_scene(scene);
    if (row->peer) {
        row->peer->ask(row->peer_state, &(struct asked){.count = pairs.count, .pairs = scene->pairs}, p->colliding);
        return;
    }
    const narc_query query = {.workers = &row->workers};
    narc_error error;
    narc_status status;
    if (row->question->what == QUERY_OVERLAP)
        status = narc_find_overlaps(scene->shapes, &bodies, &pairs, &query, p->bits, &error);
    else if (row->alone)
        status = find_alone(row, scene, p->bodies[frame], &error);
    else
        status = find_rows(row, scene, &bodies, &pairs, query, &error);
    if (status != NARC_OK)
        fail("%s: %s", row->bench.name, error.message);
}

/* Bits from a list of contacts. A separation that is not the exact one counts as a wrong answer. */
static size_t spread_contacts(const struct row *row, const double *gaps) {
    struct pairs *p = row->state;
    const bool manifolds = row->question->what == QUERY_MANIFOLD;
    const narc_manifold *list = share_manifolds(row->bench.count);
    size_t wrong = 0;
    for (size_t k = 0; k < NARC_BIT_WORDS(row->bench.count); k++)
        p->bits[k] = 0;
    for (size_t k = 0; k < p->found; k++) {
        const uint32_t pair = manifolds ? list[k].pair : p->contacts[k].pair;
        const double separation = manifolds ? deepest_separation(&list[k]) : p->contacts[k].separation;
        p->bits[pair / 64] |= (uint64_t)1 << pair % 64;
        wrong += !(fabs(separation - gaps[pair]) < TOUCHING);
    }
    return wrong;
}

static void check(struct row *row, const double *gaps, int frames) {
    struct pairs *p = row->state;
    for (size_t k = 0; k < row->bench.count; k++) {
        const int hit = row->peer ? p->colliding[k] : (int)(p->bits[k / 64] >> k % 64 & 1);
        row->bench.hits += hit / ((double)frames * (double)row->bench.count);
        row->bench.wrong += hit != (gaps[k] < 0) && fabs(gaps[k]) >= TOUCHING;
    }
}

static void prepare_peer(struct row *row) {
    struct pairs *p = row->state;
    const struct asked asked = {.count = row->bench.count, .checks = true, .pairs = row->scene->pairs};
    row->peer_state = row->peer->create(row->scene);
    p->colliding = allocate(row->bench.count, sizeof *p->colliding);
    row->peer->ask(row->peer_state, &asked, p->colliding);
    check(row, gaps_of(row->scene), 1);
}

static void prepare(struct row *row) {
    struct pairs *p = row->state = allocate(1, sizeof *p);
    const int what = row->question->what;
    const size_t count = row->bench.count = row->scene->pair_count;
    p->frames[0] = p->frames[1] = row->scene;
    if (row->peer) {
        prepare_peer(row);
        return;
    }
    if (is_pile(row->layout))
        p->frames[1] = get_scene(row->family, row->layout, true);
    p->bits = allocate(NARC_BIT_WORDS(count), sizeof *p->bits);
    if (what == QUERY_CONTACT)
        p->contacts = allocate(count, sizeof *p->contacts);
    for (int frame = 0; frame < 2 && row->alone; frame++) {
        p->bodies[frame] = allocate(row->scene->body_count, sizeof *p->bodies[frame]);
        for (size_t k = 0; k < row->scene->body_count; k++) {
            const struct body *at = &p->frames[frame]->bodies[k];
            p->bodies[frame][k] = (narc_body){(double)at->x, (double)at->y, at->cosine, at->sine, 1, at->shape};
        }
    }
    for (int frame = 0; frame < 2; frame++) {
        const double *gaps = gaps_of(p->frames[p->runs % 2]);
        run(row);
        if (what != QUERY_OVERLAP)
            row->bench.wrong += (double)spread_contacts(row, gaps);
        check(row, gaps, 2);
    }
}

const struct question pair_questions[] = {{"overlap", prepare, run, QUERY_OVERLAP, false},
                                          {"contact", prepare, run, QUERY_CONTACT, false},
                                          {"manifold", prepare, run, QUERY_MANIFOLD, false},
                                          {.name = NULL}};
