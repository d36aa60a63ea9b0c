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
 * These are the formulae of LAMMPS's gran/hooke/history and gran/hertz/history (Cundall and Strack 1979; Mindlin 1949;
 * Brilliantov and others 1996). 1 / R = 1 / R_A + 1 / R_B: with the Hertz law the radii of curvature of the arcs that
 * touch, within limits; with the linear law, which needs it for rolling only, half the extents. K_r = K_t R^2.
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

#include "internal.h"

/* Inlined wherever it is called, for the constants that it is called with. */
#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

double dem_damping_ratio(dem_law law, double restitution) {
    const double pi = 3.14159265358979323846, logarithm = -log(restitution);
    const double b = logarithm / sqrt(pi * pi + logarithm * logarithm);
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

/* The dashpots of pairs do not change while a list lasts: for unit size of the contact (see apply_law()). */
void dem_find_dashpots(dem *d) {
    const dem_bodies *b = &d->bodies;
    for (size_t k = 0; k < d->pairs.count; k++) {
        const size_t i = d->pairs.a[k], j = d->pairs.b[k];
        const dem_contact_law *law = &d->laws[b->material[i]][b->material[j]];
        const double mass = 1 / (b->inverse_mass[i] + b->inverse_mass[j]);
        const double by_ratio = law->damping_ratio * sqrt(law->kn * mass);
        d->pairs.dashpot[k] = law->damping_ratio >= 0 ? (dem_dashpot){by_ratio, law->tangential_share * by_ratio}
                                                      : (dem_dashpot){law->gamma_n * mass, law->gamma_t * mass};
    }
}

/* A contact, for its law. The tangent is (-normal.y, normal.x). */
typedef struct contact {
    size_t a, b;
    dem_vec normal;
    dem_vec arm_a, arm_b; /* from both centres to the point */
    double depth;
    double vn, vt, turn; /* relative velocities: apart, along the tangent, rotation */
} contact;

static inline double clamp(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}

/* Half of the harmonic sum: R. Walls (inverse mass 0) have no limits above and take the grain's below. */
static double find_radius(const dem *d, const dem_bodies *b, size_t k, size_t i, size_t j) {
    const bool is_grain = b->inverse_mass[j] > 0;
    const double half_i = 0.5 * b->extent[i], half_j = is_grain ? 0.5 * b->extent[j] : half_i;
    if (d->settings.law == DEM_LINEAR)
        return is_grain ? half_i * half_j / (half_i + half_j) : half_i;
    const double low = d->settings.least_radius, high = d->settings.largest_radius;
    const double r_a = clamp((double)d->contacts.rows[k].radius_a, low * half_i, high * half_i);
    const double r_b = clamp((double)d->contacts.rows[k].radius_b, low * half_j, is_grain ? high * half_j : INFINITY);
    return r_b < INFINITY ? r_a * r_b / (r_a + r_b) : r_a;
}

INLINE contact load_contact(const dem *d, size_t k) {
    const narc_contact *row = &d->contacts.rows[k];
    const dem_bodies *b = &d->bodies;
    const size_t p = row->pair, i = d->pairs.a[p], j = d->pairs.b[p];
    contact c = {.a = i, .b = j, .normal = {(double)row->normal_x, (double)row->normal_y}};
    c.depth = -(double)row->separation;
    c.arm_a = (dem_vec){(double)row->point_x, (double)row->point_y};
    c.arm_b = (dem_vec){c.arm_a.x + (b->x[i] - b->x[j] - (double)d->pairs.shift_x[p]),
                        c.arm_a.y + (b->y[i] - b->y[j] - (double)d->pairs.shift_y[p])};
    if (j >= d->grain_count) { /* a plate's shift is rounded: what of it is across the plate is no depth */
        const dem_vec n = d->walls[j - d->grain_count].normal;
        c.depth -= (double)d->pairs.shift_x[p] * n.x + (double)d->pairs.shift_y[p] * n.y;
        c.depth = c.depth > 0 ? c.depth : 0;
    }
    const double x = b->vx[j] - b->vx[i] - (b->spin[j] * c.arm_b.y - b->spin[i] * c.arm_a.y);
    const double y = b->vy[j] - b->vy[i] + (b->spin[j] * c.arm_b.x - b->spin[i] * c.arm_a.x);
    c.vn = x * c.normal.x + y * c.normal.y;
    c.vt = y * c.normal.x - x * c.normal.y;
    c.turn = b->spin[j] - b->spin[i];
    return c;
}

/* Adds to a slider's spring what moved in the step, and cuts it back to what friction bears. Returns the force, without
 * a sign; `bound` is the largest. What work is lost is damping's, or friction's in a step that slides. (Where the
 * dashpot alone is more than friction bears, cutting back stretches the spring the other way: LAMMPS's rule. The energy
 * that it gets so is taken from friction's account.) */
INLINE double slide(double *spring, double *spring_force, double stiffness, double dashpot, double way, double bound,
                    dem_sums *sums) {
    const double before = *spring, force_before = *spring_force;
    double stretch = before + way, pull = stiffness * stretch, force = pull + dashpot;
    const bool slides = fabs(force) > bound;
    if (slides) {
        force = force > 0 ? bound : -bound;
        pull = force - dashpot;
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
    dem_rolling *rolling = &d->pairs.rolling[d->contacts.rows[k].pair];
    if (!is_old)
        *rolling = (dem_rolling){0, 0};
    sums->old_springs += 0.5 * rolling->torque * rolling->angle;
    const double torque =
        slide(&rolling->angle, &rolling->torque, stiffness, 0, c->turn * d->settings.time_step, bound, sums);
    sums->rolling_energy += 0.5 * rolling->torque * rolling->angle;
    return torque;
}

INLINE void add_to_body(const dem_bodies *b, size_t k, double fx, double fy, double torque) {
    b->fx[k] += fx;
    b->fy[k] += fy;
    b->torque[k] += torque;
}

/* Is the contact deeper than it may be? */
static bool is_too_deep(const dem *d, size_t i, size_t j, double depth) {
    const dem_bodies *b = &d->bodies;
    const double size_i = b->extent[i], size_j = b->inverse_mass[j] > 0 ? b->extent[j] : size_i;
    return !(depth <= d->settings.max_overlap * (size_i < size_j ? size_i : size_j));
}

/* One contact. Where `hertz` and `rolls` are constants all that they do not want is left out. */
INLINE void apply_law(dem *d, size_t k, bool hertz, bool rolls, dem_sums *sums) {
    const contact c = load_contact(d, k);
    const dem_bodies *b = &d->bodies;
    const size_t p = d->contacts.rows[k].pair;
    const double dt = d->settings.time_step;
    const dem_contact_law *law = &d->laws[b->material[c.a]][b->material[c.b]];
    const double radius = hertz || rolls ? find_radius(d, b, k, c.a, c.b) : 0;
    const double size = hertz ? sqrt(radius * c.depth) : 1;
    const double kn = law->kn * size, kt = law->kt * size;
    const double damped = hertz ? (law->damping_ratio >= 0 ? sqrt(size) : size) : 1;

    dem_memory memory = d->pairs.memory[p];
    const bool is_old = memory.step + 1 == d->step;
    memory = is_old ? memory : (dem_memory){.slide = 0};
    memory.step = d->step;
    sums->old_springs += 0.5 * memory.spring * memory.slide;

    const double dashpot = -d->pairs.dashpot[p].normal * damped * c.vn, push = kn * c.depth + dashpot;
    sums->damping -= 0.5 * (memory.damping + dashpot) * c.vn * dt;
    sums->normal_energy += (hertz ? 0.4 : 0.5) * kn * c.depth * c.depth;
    memory.damping = dashpot;
    const double drag = -slide(&memory.slide, &memory.spring, kt, d->pairs.dashpot[p].tangential * damped * c.vt,
                               c.vt * dt, law->friction * fabs(push), sums);
    sums->tangential_energy += 0.5 * memory.spring * memory.slide;
    d->pairs.memory[p] = memory;

    const double fx = push * c.normal.x - drag * c.normal.y, fy = push * c.normal.y + drag * c.normal.x;
    double torque_a = -(c.arm_a.x * fy - c.arm_a.y * fx), torque_b = c.arm_b.x * fy - c.arm_b.y * fx;
    if (rolls) {
        const double bound = law->rolling_friction * radius * fabs(push);
        const double torque = apply_rolling(d, &c, k, kt * radius * radius, bound, is_old, sums);
        torque_a += torque;
        torque_b -= torque;
    }
    d->contacts.forces[k] = (dem_force){fx, fy, torque_a, torque_b};
    if (d->scratch->adds) {
        add_to_body(b, c.a, -fx, -fy, torque_a);
        add_to_body(b, c.b, fx, fy, torque_b);
    } else {
        d->scratch->slot[p] = (uint32_t)k;
    }
    if (!(c.depth <= d->safe_depth) && sums->too_deep == SIZE_MAX && is_too_deep(d, c.a, c.b, c.depth))
        sums->too_deep = k;
}

INLINE dem_sums apply_laws(dem *d, size_t first, size_t end, bool hertz, bool rolls) {
    dem_sums sums = {.too_deep = SIZE_MAX};
    for (size_t k = first; k < end; k++)
        apply_law(d, k, hertz, rolls, &sums);
    return sums;
}

static dem_sums apply_block(dem *d, size_t first, size_t end, bool hertz, bool rolls) {
    return rolls   ? apply_laws(d, first, end, hertz, true)
           : hertz ? apply_laws(d, first, end, true, false)
                   : apply_laws(d, first, end, false, false);
}

static bool fail_depth(dem *d, size_t k) {
    const size_t p = d->contacts.rows[k].pair, a = d->pairs.a[p], b = d->pairs.b[p];
    const bool is_grain = b < d->grain_count;
    return dem_fail(
        d,
        "step %llu: grain %zu overlaps %s %zu by %g, more than %g of the smaller one's extent. Use a shorter "
        "time step, or stiffer contacts",
        (unsigned long long)d->step, a, is_grain ? "grain" : "wall", is_grain ? b : b - d->grain_count,
        -(double)d->contacts.rows[k].separation, d->settings.max_overlap);
}

bool dem_apply_laws(dem *d) {
    dem_scratch *s = d->scratch;
    const size_t count = d->contacts.count, blocks = (count + DEM_BLOCK - 1) / DEM_BLOCK;
    const bool hertz = d->settings.law == DEM_HERTZ, rolls = dem_has_rolling(d);
    const unsigned team = dem_team(d);
    s->adds = team == 1;
    if (s->adds)
        dem_clear_forces(d);
    if (!dem_reserve(d, &s->sums, &s->sums_capacity, blocks, sizeof *s->sums))
        return false;
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
    for (size_t block = 0; block < blocks; block++) {
        const size_t first = block * DEM_BLOCK, end = block + 1 < blocks ? first + DEM_BLOCK : count;
        s->sums[block] = apply_block(d, first, end, hertz, rolls);
    }
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
