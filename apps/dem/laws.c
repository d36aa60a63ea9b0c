/* SPDX-License-Identifier: MIT
 *
 * laws.c - the forces of contacts.
 *
 * Of a contact with depth h > 0, normal n from A to B and tangent t, whose surfaces move with the relative velocity v
 * of B against A at its point, the force on B is, with 1 / m = 1 / m_A + 1 / m_B,
 *
 *       normal        F_n =  K_n h - C_n v.n
 *       tangential    F_t = -K_t s - C_t v.t,    ds/dt = v.t,    |F_t| <= friction |F_n|, s cut back to what bears it
 *       rolling       M   = -K_r a,              da/dt = spin_B - spin_A,    |M| <= rolling friction R |F_n|
 *
 *   linear            K_n = kn            K_t = kt            C = gamma m
 *   Hertz-Mindlin     K_n = kn sqrt(R h)  K_t = kt sqrt(R h)  C = gamma m sqrt(R h)
 *   with restitution  C_n = ratio sqrt(K_n m), C_t a share of it
 *
 * Two flat sides have two normal forces, each a share of F_n (see touch.h), and one tangential force between them.
 *
 * These are the formulae of LAMMPS's gran/hooke/history and gran/hertz/history (Cundall and Strack 1979; Mindlin 1949;
 * Brilliantov and others 1996). 1 / R = 1 / R_A + 1 / R_B, the radii of the discs of equal area, whatever touches: a
 * stiffness that followed the curvature would jump from arc to arc, and so would the energy. K_r = K_t R^2.
 *
 * The ratio that gives a restitution e. Linear: h'' + gamma h' + (kn / m) h = 0 from h = 0 to h = 0 has e = exp(-gamma
 * T / 2) with T = pi / sqrt(kn / m - gamma^2 / 4), so gamma = 2 b sqrt(kn / m) with b = -ln e / sqrt(pi^2 + ln^2 e).
 * Hertz: with C_n in proportion to h^(1/4) e does not depend on the speed (Tsuji and others 1992), and the ratio is
 * sqrt(5) b (Antypov and Elliott 2011).
 *
 * Energies. Velocity Verlet changes the kinetic energy by (F before + F after) / 2 times the way, so that is how work
 * is counted: a spring's is then the difference of its energies, and what is left of the tangential work is friction's.
 */
#include <math.h>
#include <string.h>

#include "dem.h"

/* Inlined wherever it is called, for the constants that it is called with. */
#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

double dem_damping_ratio(dem_law law, double restitution) {
    const double logarithm = -log(restitution), b = logarithm / sqrt(DEM_PI * DEM_PI + logarithm * logarithm);
    return (law == DEM_HERTZ ? sqrt(5.0) : 2) * b;
}

void dem_set_law(dem *d, uint8_t a, uint8_t b, dem_contact_law law) {
    if (d->settings.law == DEM_HERTZ) {
        const dem_material *m = &d->materials[a], *n = &d->materials[b];
        law.kn = 4.0 / 3 / ((1 - m->poisson * m->poisson) / m->young + (1 - n->poisson * n->poisson) / n->young);
        law.kt = 8 / (2 * (2 - m->poisson) * (1 + m->poisson) / m->young +
                      2 * (2 - n->poisson) * (1 + n->poisson) / n->young);
    }
    d->laws[a][b] = d->laws[b][a] = law;
}

double dem_find_shortest_contact(const dem *d) {
    const double softness = d->settings.law == DEM_HERTZ ? sqrt(d->settings.max_overlap) : 0;
    double mass[DEM_MAX_MATERIALS], size[DEM_MAX_MATERIALS], shortest = INFINITY; /* of the lightest */
    for (size_t a = 0; a < d->material_count; a++)
        mass[a] = size[a] = INFINITY; /* none: a wall */
    for (size_t k = 0; k < d->grain_count; k++) {
        const size_t a = d->bodies.material[k];
        size[a] = d->bodies.mass[k] < mass[a] ? 0.5 * d->bodies.extent[k] : size[a];
        mass[a] = fmin(mass[a], d->bodies.mass[k]);
    }
    for (size_t a = 0; a < d->material_count; a++)
        for (size_t b = 0; b < d->material_count && mass[a] < INFINITY; b++) {
            /* Of two grains R is half of the size, and their depth as much. */
            const double stiffness = d->laws[a][b].kn * (softness > 0 ? size[a] * softness : 1);
            shortest = fmin(shortest, DEM_PI * sqrt(mass[a] / (1 + mass[a] / mass[b]) / stiffness));
        }
    return shortest;
}

/* A contact, for its law. The tangent is (-normal.y, normal.x). */
typedef struct contact {
    size_t a, b;
    double depth;
    dem_vec normal, point; /* of all ends */
    dem_vec arm_b;         /* from the centre of B to the point */
    double drift;          /* what B's image is faster along x */
    double vn, vt, turn;   /* relative velocities: apart, along the tangent, rotation */
} contact;

/* 1 / R is the sum of 1 / R_i, of the discs of equal area. A wall's has no end. */
static double find_radius(const dem_bodies *b, size_t i, size_t j) {
    const double half_i = 0.5 * b->extent[i], half_j = 0.5 * b->extent[j];
    return b->inverse_mass[j] > 0 ? half_i * half_j / (half_i + half_j) : half_i;
}

INLINE touch_grain look_at(const dem *d, size_t part) {
    const dem_bodies *b = &d->bodies;
    const dem_outline *outline = &d->outlines[d->parts.outline[part]];
    const size_t k = d->parts.body[part];
    return (touch_grain){outline->sides, outline->side_count, b->cosine[k], b->sine[k], (double)b->scale[k]};
}

/* Of A and B's relative motion at a place: B's surface moves away with it. */
INLINE dem_vec find_velocity(const dem_bodies *b, const contact *c, dem_vec at_a, dem_vec at_b) {
    return (dem_vec){b->vx[c->b] - b->vx[c->a] + c->drift - (b->spin[c->b] * at_b.y - b->spin[c->a] * at_a.y),
                     b->vy[c->b] - b->vy[c->a] + (b->spin[c->b] * at_b.x - b->spin[c->a] * at_a.x)};
}

/* Where B is from A. A plate's shift is rounded: what of it is across the plate is left out. */
INLINE dem_vec find_way(const dem *d, size_t p, size_t i, size_t j) {
    const dem_bodies *b = &d->bodies;
    dem_vec shift = dem_find_shift(d, p);
    if (j >= d->grain_count) {
        const dem_vec n = d->walls[j - d->grain_count].normal; /* 0 of a box */
        const double across = shift.x * n.x + shift.y * n.y;
        shift = (dem_vec){shift.x - across * n.x, shift.y - across * n.y};
    }
    return (dem_vec){b->x[j] - b->x[i] + shift.x, b->y[j] - b->y[i] + shift.y};
}

/* The normal and the point of two ends are their means, by what each bears. */
INLINE void join_ends(const touch_end *end, contact *c) {
    const double first = end[0].share / (end[0].share + end[1].share), second = 1 - first;
    const double x = first * end[0].normal_x + second * end[1].normal_x;
    const double y = first * end[0].normal_y + second * end[1].normal_y, length = sqrt(x * x + y * y);
    c->normal = (dem_vec){x / length, y / length};
    c->point = (dem_vec){first * end[0].x + second * end[1].x, first * end[0].y + second * end[1].y};
}

/* Returns the count of ends; only of two of them, `t` is what they are. */
INLINE int load_contact(const dem *d, size_t k, contact *c, touch *t) {
    const narc_contact *row = &d->contacts.found[k];
    const dem_bodies *b = &d->bodies;
    const size_t p = row->pair, i = dem_body_a(d, p), j = dem_body_b(d, p);
    const dem_vec way = find_way(d, p, i, j);
    touch_end end;
    int count = 1;
    if (b->disc[i] > 0 && b->disc[j] > 0) {
        end = meet_discs(b->disc[i], b->disc[j], way.x, way.y);
        c->depth = end.depth;
    } else {
        const touch_grain of_a = look_at(d, d->pairs.a[p]), of_b = look_at(d, d->pairs.b[p]);
        find_touch(&of_a, &of_b, way.x, way.y, row->feature, t);
        end = t->end[0];
        c->depth = t->depth;
        count = t->count;
    }
    if (!(c->depth > 0))
        return 0;
    c->a = i;
    c->b = j;
    c->normal = (dem_vec){end.normal_x, end.normal_y};
    c->point = (dem_vec){end.x, end.y};
    if (count == 2)
        join_ends(t->end, c);
    c->drift = d->settings.sheared ? dem_find_lift(d, p) * dem_find_drift(d) : 0;
    c->arm_b = (dem_vec){c->point.x - way.x, c->point.y - way.y};
    const dem_vec v = find_velocity(b, c, c->point, c->arm_b);
    c->vn = v.x * c->normal.x + v.y * c->normal.y;
    c->vt = v.y * c->normal.x - v.x * c->normal.y;
    c->turn = b->spin[j] - b->spin[i];
    return count;
}

/* Adds to a slider's spring what moved in the step, and cuts it back to what friction bears. Returns the force, without
 * a sign; `bound` is the largest. What work is lost is damping's, or friction's in a step that slides. (Where the
 * dashpot alone is more than friction bears, cutting back stretches the spring the other way: LAMMPS's rule. The energy
 * that it gets so is taken from friction's account.) Where nothing is borne there is no spring. */
INLINE double slide(double *spring, double *spring_force, double stiffness, double dashpot, double way, double bound,
                    dem_sums *sums) {
    const double before = *spring, force_before = *spring_force;
    double stretch = before + way, pull = stiffness * stretch, force = pull + dashpot;
    const bool slides = fabs(force) > bound;
    if (slides) {
        force = force > 0 ? bound : -bound;
        pull = bound > 0 ? force - dashpot : 0;
        dashpot = force - pull;
        stretch = stiffness > 0 ? pull / stiffness : 0;
    }
    const double lost = (0.5 * (force_before + pull) + dashpot) * way - 0.5 * (pull * stretch - force_before * before);
    *spring = stretch;
    *spring_force = pull;
    sums->damping += slides ? 0 : lost;
    sums->friction += slides ? lost : 0;
    return force;
}

/* Returns the torque on A; that on B is opposite. */
static double apply_rolling(dem *d, const contact *c, size_t k, double stiffness, double bound, bool is_old,
                            dem_sums *sums) {
    dem_rolling *rolling = &d->pairs.rolling[d->contacts.found[k].pair];
    if (!is_old)
        *rolling = (dem_rolling){0, 0};
    sums->old_springs += 0.5 * rolling->torque * rolling->angle;
    const double torque =
        slide(&rolling->angle, &rolling->torque, stiffness, 0, c->turn * d->settings.time_step, bound, sums);
    sums->rolling_energy += 0.5 * rolling->torque * rolling->angle;
    return torque;
}

INLINE void add_to_bodies(const dem_bodies *b, size_t i, size_t j, dem_force force) {
    b->fx[i] -= force.x;
    b->fy[i] -= force.y;
    b->torque[i] += force.torque_a;
    b->fx[j] += force.x;
    b->fy[j] += force.y;
    b->torque[j] += force.torque_b;
}

/* Is the contact deeper than it may be? */
static bool is_too_deep(const dem *d, size_t i, size_t j, double depth) {
    const dem_bodies *b = &d->bodies;
    const double size_i = b->extent[i], size_j = b->inverse_mass[j] > 0 ? b->extent[j] : size_i;
    return !(depth <= d->settings.max_overlap * (size_i < size_j ? size_i : size_j));
}

/* A force on B, and the opposite one on A, where `at_a` is from A. */
INLINE void add_force(const contact *c, double fx, double fy, dem_vec at_a, dem_force *sum) {
    const dem_vec at_b = {at_a.x + (c->arm_b.x - c->point.x), at_a.y + (c->arm_b.y - c->point.y)};
    *sum = (dem_force){sum->x + fx, sum->y + fy, sum->torque_a - (at_a.x * fy - at_a.y * fx),
                       sum->torque_b + (at_b.x * fy - at_b.y * fx)};
}

/* The forces along the normals of two ends, and what slides them off each other: added to `sum`. Returns the whole
 * push, and in `out_dashpot` the dashpots' share of it. (Contacts go by value: those of one point stay in registers.)
 * */
static double push_ends(const dem_bodies *b, contact c, const touch *t, double stiffness, double dashpot,
                        dem_force *sum, double *out_dashpot, double *out_power) {
    double push = 0;
    *out_dashpot = *out_power = 0;
    for (int i = 0; i < 2; i++) {
        const touch_end *end = &t->end[i];
        const dem_vec at_a = {end->x, end->y};
        const dem_vec at_b = {at_a.x + (c.arm_b.x - c.point.x), at_a.y + (c.arm_b.y - c.point.y)};
        const dem_vec v = find_velocity(b, &c, at_a, at_b);
        const double vn = v.x * end->normal_x + v.y * end->normal_y, slow = -end->share * dashpot * vn;
        const double force = end->share * stiffness * t->depth + slow;
        add_force(&c, force * end->normal_x, force * end->normal_y, at_a, sum);
        push += force;
        *out_dashpot += slow;
        *out_power += slow * vn;
    }
    add_force(&c, stiffness * t->depth * t->slide_x, stiffness * t->depth * t->slide_y,
              (dem_vec){t->corner_x, t->corner_y}, sum);
    return push;
}

/* One contact, and its row. Where `hertz` and `rolls` are constants all that they do not want is left out. Returns
 * false if both are apart after all. */
INLINE bool apply_law(dem *d, size_t k, dem_contact *out_row, bool hertz, bool rolls, dem_sums *sums) {
    contact c;
    touch t;
    const int count = load_contact(d, k, &c, &t);
    if (count == 0)
        return false;
    const dem_bodies *b = &d->bodies;
    const size_t p = d->contacts.found[k].pair;
    const double dt = d->settings.time_step, depth = c.depth;
    const dem_contact_law *law = &d->laws[b->material[c.a]][b->material[c.b]];
    const double radius = hertz || rolls ? find_radius(b, c.a, c.b) : 0;
    const double size = hertz ? sqrt(radius * depth) : 1;
    const double kn = law->kn * size, kt = law->kt * size;
    const double mass = 1 / (b->inverse_mass[c.a] + b->inverse_mass[c.b]);
    const bool by_ratio = law->damping_ratio >= 0;
    const double damped = hertz ? (by_ratio ? sqrt(size) : size) : 1;
    const double dashpot_n = by_ratio ? law->damping_ratio * sqrt(law->kn * mass) : law->gamma_n * mass;
    const double dashpot_t = by_ratio ? law->tangential_share * dashpot_n : law->gamma_t * mass;

    dem_memory memory = d->pairs.memory[p];
    const bool is_old = memory.step + 1 == d->step;
    memory = is_old ? memory : (dem_memory){.slide = 0};
    memory.step = d->step;
    sums->old_springs += 0.5 * memory.spring * memory.slide;

    dem_force ends = {0, 0, 0, 0};
    double dashpot = -dashpot_n * damped * c.vn, power = dashpot * c.vn, push = kn * depth + dashpot;
    double along = push, before = memory.damping * c.vn; /* the dashpot's power at the step's beginning */
    if (count == 2) {                                    /* and of two ends as if it had been what it is */
        push = push_ends(b, c, &t, kn, dashpot_n * damped, &ends, &dashpot, &power);
        before = is_old ? power : 0;
        along = 0;
    }
    sums->damping -= 0.5 * (power + before) * dt;
    sums->normal_energy += (hertz ? 0.4 : 0.5) * kn * depth * depth;
    memory.damping = dashpot;
    const double drag = -slide(&memory.slide, &memory.spring, kt, dashpot_t * damped * c.vt, c.vt * dt,
                               law->friction * fabs(push), sums);
    sums->tangential_energy += 0.5 * memory.spring * memory.slide;
    d->pairs.memory[p] = memory;

    const double fx = along * c.normal.x - drag * c.normal.y, fy = along * c.normal.y + drag * c.normal.x;
    dem_force force = {fx, fy, -(c.point.x * fy - c.point.y * fx), c.arm_b.x * fy - c.arm_b.y * fx};
    if (count == 2)
        force = (dem_force){fx + ends.x, fy + ends.y, force.torque_a + ends.torque_a, force.torque_b + ends.torque_b};
    if (rolls) {
        const double bound = law->rolling_friction * radius * fabs(push);
        const double torque = apply_rolling(d, &c, k, kt * radius * radius, bound, is_old, sums);
        force.torque_a += torque;
        force.torque_b -= torque;
    }
    *out_row = (dem_contact){p, c.normal, c.point, depth, force};
    if (d->scratch->adds)
        add_to_bodies(b, c.a, c.b, force);
    if (!(depth <= d->safe_depth) && sums->too_deep == SIZE_MAX && is_too_deep(d, c.a, c.b, depth))
        sums->too_deep = p;
    return true;
}

/* Their rows follow each other, and what is apart in double precision has none. */
INLINE dem_sums apply_laws(dem *d, size_t first, size_t end, bool hertz, bool rolls) {
    dem_sums sums = {.too_deep = SIZE_MAX};
    for (size_t k = first; k < end; k++)
        sums.count += apply_law(d, k, &d->contacts.rows[first + sums.count], hertz, rolls, &sums);
    return sums;
}

static bool fail_depth(dem *d, size_t p) {
    const size_t a = dem_body_a(d, p), b = dem_body_b(d, p);
    const bool is_grain = b < d->grain_count;
    const dem_contact *row = d->contacts.rows;
    while (row->pair != p)
        row++;
    return dem_fail(d, "step %llu: grain %zu overlaps %s %zu by %g, more than %g of the smaller one's extent. %s",
                    (unsigned long long)d->step, a, is_grain ? "grain" : "wall", is_grain ? b : b - d->grain_count,
                    row->depth, d->settings.max_overlap,
                    d->step == 0 ? "They are placed so: the run has not begun"
                                 : "Use a shorter time step, or stiffer contacts");
}

/* The rows of all blocks, without gaps between them. */
static void join_blocks(dem *d, size_t blocks) {
    dem_contacts *c = &d->contacts;
    c->count = 0;
    for (size_t block = 0; block < blocks; block++) {
        const size_t first = block * DEM_BLOCK, count = d->scratch->sums[block].count;
        if (c->count < first)
            memmove(&c->rows[c->count], &c->rows[first], count * sizeof *c->rows);
        c->count += count;
    }
    for (size_t k = 0; !d->scratch->adds && k < c->count; k++)
        add_to_bodies(&d->bodies, dem_body_a(d, c->rows[k].pair), dem_body_b(d, c->rows[k].pair), c->rows[k].force);
}

bool dem_apply_laws(dem *d) {
    dem_scratch *s = d->scratch;
    const size_t count = d->contacts.found_count, blocks = (count + DEM_BLOCK - 1) / DEM_BLOCK;
    const bool hertz = d->settings.law == DEM_HERTZ;
    bool rolls = false;
    for (size_t i = 0; i < d->material_count * d->material_count; i++)
        rolls |= d->laws[i / d->material_count][i % d->material_count].rolling_friction > 0;
    const unsigned team = dem_team(d);
    const size_t size = d->bodies.count * sizeof *d->bodies.fx;
    s->adds = team == 1;
    memset(d->bodies.fx, 0, size);
    memset(d->bodies.fy, 0, size);
    memset(d->bodies.torque, 0, size);
    if (!dem_reserve(d, &s->sums, &s->sums_capacity, blocks, sizeof *s->sums))
        return false;
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
    for (size_t block = 0; block < blocks; block++) {
        const size_t first = block * DEM_BLOCK, end = block + 1 < blocks ? first + DEM_BLOCK : count;
        s->sums[block] = rolls   ? apply_laws(d, first, end, hertz, true)
                         : hertz ? apply_laws(d, first, end, true, false)
                                 : apply_laws(d, first, end, false, false);
    }
    join_blocks(d, blocks);
    d->pull = 0;
    for (size_t k = 0; d->settings.sheared && k < d->contacts.count; k++)
        d->pull += dem_find_lift(d, d->contacts.rows[k].pair) * d->contacts.rows[k].force.x;
    dem_sums all = {.too_deep = SIZE_MAX};
    for (size_t block = blocks; block-- > 0;) {
        const dem_sums *sums = &s->sums[block];
        all.normal_energy += sums->normal_energy;
        all.tangential_energy += sums->tangential_energy;
        all.rolling_energy += sums->rolling_energy;
        all.old_springs += sums->old_springs;
        all.damping += sums->damping;
        all.friction += sums->friction;
        all.too_deep = sums->too_deep < SIZE_MAX ? sums->too_deep : all.too_deep;
    }
    /* What springs held whose contact opened is lost to friction. */
    all.friction += d->tangential_energy + d->rolling_energy - all.old_springs;
    d->damping += all.damping;
    d->friction += all.friction;
    d->normal_energy = all.normal_energy;
    d->tangential_energy = all.tangential_energy;
    d->rolling_energy = all.rolling_energy;
    return all.too_deep == SIZE_MAX || fail_depth(d, all.too_deep);
}
