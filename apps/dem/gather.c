/* SPDX-License-Identifier: MIT
 *
 * gather.c - from the forces of contacts to those of bodies.
 *
 * A body's forces are added in the order of its contacts: first those where it is B, then those where it is A, for
 * a < b and pairs are in the order of (a, b). A single thread adds each contact's forces as it finds them (laws.c),
 * which is the same order; several threads take a body each and look up its contacts.
 */
#include <string.h>

#include "internal.h"

void dem_clear_forces(dem *d) {
    const size_t size = d->bodies.count * sizeof *d->bodies.fx;
    memset(d->bodies.fx, 0, size);
    memset(d->bodies.fy, 0, size);
    memset(d->bodies.torque, 0, size);
}

/* The contact of a pair, or the count if it has none. */
static size_t find_contact(const dem *d, size_t pair) {
    const size_t k = d->scratch->slot[pair];
    return k < d->contacts.count && d->contacts.rows[k].pair == pair ? k : d->contacts.count;
}

static void gather_body(const dem *d, size_t body) {
    const dem_contacts c = d->contacts;
    const dem_incidence n = d->incidence;
    double fx = 0, fy = 0, torque = 0;
    for (size_t i = n.first_b[body]; i < n.first_b[body + 1]; i++) {
        const size_t k = find_contact(d, n.of_b[i]);
        if (k < c.count) {
            fx += c.rows[k].force.x;
            fy += c.rows[k].force.y;
            torque += c.rows[k].force.torque_b;
        }
    }
    for (size_t p = n.first_a[body]; p < n.first_a[body + 1]; p++) {
        const size_t k = find_contact(d, p);
        if (k < c.count) {
            fx -= c.rows[k].force.x;
            fy -= c.rows[k].force.y;
            torque += c.rows[k].force.torque_a;
        }
    }
    d->bodies.fx[body] = fx;
    d->bodies.fy[body] = fy;
    d->bodies.torque[body] = torque;
}

void dem_gather_forces(dem *d) {
    const size_t count = d->bodies.count;
    if (d->scratch->adds)
        return;
#pragma omp parallel for schedule(static) num_threads(dem_team(d))
    for (size_t k = 0; k < count; k++)
        gather_body(d, k);
}
