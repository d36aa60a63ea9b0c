/* SPDX-License-Identifier: MIT
 *
 * laws.c - the forces of contacts.
 *
 * Of a contact with depth h, normal n from A to B and tangent t, whose surfaces move with the relative velocity v
 * of B against A at its point, the force on B is, with 1 / m = 1 / m_A + 1 / m_B,
 *
 *       normal        F_n =  K_n h - C_n v.n - cohesion
 *       tangential    F_t = -K_t s - C_t v.t,    ds/dt = v.t,    |F_t| <= friction |F_n + cohesion|, s cut back to what
 *                                                                bears it
 *       rolling       M   = -K_r a,              da/dt = spin_B - spin_A,    |M| <= rolling friction R |F_n|
 *
 *   linear            K_n = kn            K_t = kt            C = gamma m
 *   Hertz-Mindlin     K_n = kn sqrt(R h)  K_t = kt sqrt(R h)  C = gamma m sqrt(R h)
 *   with restitution  C_n = ratio sqrt(K_n m), C_t a share of it
 *
 * Springs and dashpots are there where h > 0. Cohesion is a constant force, which goes on beyond: up to the distance
 * `range` it falls to 0 in proportion. So it is what pulls two grains apart, and cohesion * range / 2 the work of that.
 *
 * Two flat sides have two normal forces, each a share of F_n (see touch.h), and one tangential force between them.
 *
 * Where K_t changes, with the depth or with the contact's share of a surface, the spring keeps its force if K_t grows, and
 * its length s if it falls (as LAMMPS's mindlin/rescale does): so no cycle of loads gives energy. What that loses is
 * micro-slip: it is booked as friction.
 *
 * A dashpot begins and ends at once, within a step: of the step it gets the share q = h / (|v.n| dt) in which there was, or
 * will be, a contact. Its force at that end of the step stands for the whole next half step, too, so it counts (1/2 + q)
 * times. The Hertz law's dashpot grows with h^(1/4), whose mean is 4/5 of its last value. Dashpots see the velocities that
 * bodies will have at the step's end (step.c).
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

void dem_set_law(dem *d, uint32_t a, uint32_t b, dem_contact_law law) {
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
    for (const dem_body *b = d->bodies; b < d->bodies + d->grain_count; b++) {
        size[b->material] = b->mass < mass[b->material] ? 0.5 * b->extent : size[b->material];
        mass[b->material] = fmin(mass[b->material], b->mass);
    }
    for (size_t a = 0; a < d->material_count; a++)
        for (size_t b = 0; b < d->material_count && mass[a] < INFINITY; b++) {
            /* Of two grains R is half of the size, and their depth as much. */
            const double stiffness = d->laws[a][b].kn * (softness > 0 ? size[a] * softness : 1);
            shortest = fmin(shortest, DEM_PI * sqrt(mass[a] / (1 + mass[a] / mass[b]) / stiffness));
        }
    return shortest;
}

/* ------------------------------------------------------------------------------------------------ geometry */

/* Relative velocities: in the middle of the step, and at its end as far as it is known. */
typedef struct motion {
    vec now, ahead;
} motion;

/* A contact, for its law. The tangent is a quarter turn from the normal. */
typedef struct contact {
    dem_body *a, *b;
    double depth;
    vec normal, point;   /* of all ends */
    vec arm_b;           /* from the centre of B to the point */
    vec drift;           /* what B's image is faster */
    double vn, vt, turn; /* relative velocities: apart, along the tangent, rotation */
    double vn_ahead, vt_ahead;
    size_t before; /* the pair that bore this surface's load until now, or SIZE_MAX */
} contact;

/* 1 / R is the sum of 1 / R_i, of the discs of equal area. A wall's has no end. */
static double find_radius(const dem_body *a, const dem_body *b) {
    const double half_a = 0.5 * a->extent, half_b = 0.5 * b->extent;
    return dem_is_wall(b) ? half_a : half_a * half_b / (half_a + half_b);
}

INLINE touch_grain look_at(const dem *d, size_t part, const dem_body *b) {
    const dem_outline *outline = &d->outlines[d->parts[part].outline];
    return (touch_grain){outline->sides, outline->side_count, b->turn.x, b->turn.y, (double)b->scale};
}

/* Of A and B's relative motion at a place: B's surface moves away with it. */
INLINE motion find_motion(const contact *c, vec at_a, vec at_b) {
    const dem_body *a = c->a, *b = c->b;
    return (motion){{b->velocity.x - a->velocity.x + c->drift.x - (b->spin * at_b.y - a->spin * at_a.y),
                     b->velocity.y - a->velocity.y + c->drift.y + (b->spin * at_b.x - a->spin * at_a.x)},
                    {b->ahead.x - a->ahead.x + c->drift.x - (b->spin_ahead * at_b.y - a->spin_ahead * at_a.y),
                     b->ahead.y - a->ahead.y + c->drift.y + (b->spin_ahead * at_b.x - a->spin_ahead * at_a.x)}};
}

/* A place near the point, from the centre of B. */
INLINE vec find_arm_b(const contact *c, vec at_a) { return plus(at_a, minus(c->arm_b, c->point)); }

/* Where B is from A. A plate's shift is rounded: what of it is across the plate is left out. */
INLINE vec find_way(const dem *d, const dem_image *image, const dem_body *a, const dem_body *b) {
    vec shift = image->shift;
    if (dem_is_wall(b)) {
        const vec n = d->walls[b - d->bodies - (ptrdiff_t)d->grain_count].normal; /* 0 of a box */
        shift = minus(shift, times(dot(shift, n), n));
    }
    return plus(minus(b->position, a->position), shift);
}

/* The normal and the point of two ends are their means, by what each bears. */
INLINE void join_ends(const touch_end *end, contact *c) {
    const double first = end[0].share / (end[0].share + end[1].share), second = 1 - first;
    const vec sum = {first * end[0].normal_x + second * end[1].normal_x,
                     first * end[0].normal_y + second * end[1].normal_y};
    const double length = sqrt(dot(sum, sum));
    c->normal = (vec){sum.x / length, sum.y / length};
    c->point = (vec){first * end[0].x + second * end[1].x, first * end[0].y + second * end[1].y};
}

INLINE void find_pair_touch(const dem *d, size_t index, vec way, touch *t) {
    const dem_pair *pair = &d->pairs[index];
    const dem_body *a = dem_body_a(d, index), *b = dem_body_b(d, index);
    if (a->disc > 0 && b->disc > 0) {
        put_point(meet_discs(a->disc, b->disc, way.x, way.y), t);
    } else {
        const touch_grain of_a = look_at(d, pair->a, a), of_b = look_at(d, pair->b, b);
        find_touch(&of_a, &of_b, way.x, way.y, d->found->contacts[pair->slot].feature, t);
    }
}

/* Do both pairs tell of one surface: of the same bodies, or of walls with the same law? */
static bool is_same_surface(const dem *d, size_t pair, size_t other) {
    const dem_body *b = dem_body_b(d, pair), *c = dem_body_b(d, other);
    return b == c || (dem_is_wall(b) && dem_is_wall(c) && b->material == c->material);
}

enum { MOST_TOUCHES = 16 };

/* Pairs of one body A follow each other, so those of one surface are near. Joins them: what is left of this one goes to `t`.
 * Returns the pair whose place it takes, or SIZE_MAX: one that has just been left out. */
static size_t join_pairs(const dem *d, size_t index, touch *t) {
    touch_parts parts[MOST_TOUCHES];
    size_t pairs[MOST_TOUCHES], count = 0, own = 0, first = index;
    while (first > 0 && dem_body_a(d, first - 1) == dem_body_a(d, index))
        first--;
    for (size_t k = first; k < d->pair_count && dem_body_a(d, k) == dem_body_a(d, index); k++) {
        if (!is_same_surface(d, index, k) || (count == MOST_TOUCHES - 1 && k < index) || count == MOST_TOUCHES)
            continue;
        const dem_body *a = dem_body_a(d, k), *b = dem_body_b(d, k);
        const vec way = find_way(d, dem_image_b(d, k), a, b);
        own = k == index ? count : own;
        pairs[count] = k;
        parts[count] = (touch_parts){look_at(d, d->pairs[k].a, a),
                                     look_at(d, d->pairs[k].b, b),
                                     way.x,
                                     way.y,
                                     d->pairs[k].a,
                                     d->pairs[k].b,
                                     {0}};
        find_pair_touch(d, k, way, &parts[count].at);
        count += parts[count].at.depth > -d->range;
        if (k == index && count == own)
            return SIZE_MAX;
    }
    if (count < 2)
        return SIZE_MAX;
    join_touches(parts, count);
    *t = parts[own].at;
    for (size_t i = 0; i < count && t->count > 0 && t->leads; i++)
        if (parts[i].at.count == 0 && dem_memory_of(d, pairs[i])->step + 1 == d->step)
            return pairs[i];
    return SIZE_MAX;
}

/* Do both feel each other? Of two ends, `t` is what they are. */
INLINE bool load_contact(const dem *d, size_t index, contact *c, touch *t) {
    const dem_image *image = dem_image_b(d, index);
    c->a = dem_body_a(d, index);
    c->b = dem_body_b(d, index);
    const vec way = find_way(d, image, c->a, c->b);
    c->before = SIZE_MAX;
    find_pair_touch(d, index, way, t);
    if (!(t->depth > -d->range))
        return false;
    if (d->joins && (c->a->joins || c->b->joins))
        c->before = join_pairs(d, index, t);
    c->depth = t->depth;
    if (t->count == 0)
        return false;
    c->normal = (vec){t->end[0].normal_x, t->end[0].normal_y};
    c->point = (vec){t->end[0].x, t->end[0].y};
    if (t->count == 2)
        join_ends(t->end, c);
    c->drift = d->drifts ? dem_find_drift(d, image) : (vec){0, 0};
    c->arm_b = minus(c->point, way);
    const motion v = find_motion(c, c->point, c->arm_b);
    c->vn = dot(v.now, c->normal);
    c->vt = cross(c->normal, v.now);
    c->vn_ahead = dot(v.ahead, c->normal);
    c->vt_ahead = cross(c->normal, v.ahead);
    c->turn = c->b->spin - c->a->spin;
    return true;
}

/* ------------------------------------------------------------------------------------------------ forces */

/* Adds to a slider's spring what moved in the step, and cuts it back to what friction bears. Returns the force, without
 * a sign; `bound` is the largest. What work the dashpot takes is damping's, what else is lost, or all in a step that slides,
 * friction's. (Where the dashpot alone is more than friction bears, cutting back stretches the spring the other way: LAMMPS's
 * rule. The energy that it gets so is taken from friction's account.) Where nothing is borne there is no spring. */
INLINE double slide(double *spring, double *spring_force, double stiffness, double dashpot, double way, double bound,
                    dem_account *account) {
    const double old = *spring, force_before = *spring_force;
    const double before = fabs(stiffness * old) > fabs(force_before) ? force_before / stiffness : old;
    double stretch = before + way, pull = stiffness * stretch, force = pull + dashpot;
    const bool slides = fabs(force) > bound;
    const double damped = slides ? 0 : dashpot * way;
    if (slides) {
        force = force > 0 ? bound : -bound;
        pull = bound > 0 ? force - dashpot : 0;
        dashpot = force - pull;
        stretch = stiffness > 0 ? pull / stiffness : 0;
    }
    const double lost = (0.5 * (force_before + pull) + dashpot) * way - 0.5 * (pull * stretch - force_before * old);
    *spring = stretch;
    *spring_force = pull;
    account->damping += damped;
    account->friction += lost - damped;
    return force;
}

INLINE void add_to_bodies(dem_body *a, dem_body *b, dem_force on) {
    a->force = minus(a->force, on.force);
    a->torque += on.torque_a;
    b->force = plus(b->force, on.force);
    b->torque += on.torque_b;
}

/* Is the contact deeper than it may be? */
static bool is_too_deep(const dem *d, const contact *c) {
    const double a = c->a->extent, b = dem_is_wall(c->b) ? a : c->b->extent;
    return !(c->depth <= d->settings.max_overlap * (a < b ? a : b));
}

/* A force on B, and the opposite one on A. */
INLINE void add_force(const contact *c, vec force, vec at_a, dem_force *sum) {
    *sum = (dem_force){plus(sum->force, force), sum->torque_a - cross(at_a, force),
                       sum->torque_b + cross(find_arm_b(c, at_a), force)};
}

/* How often a dashpot's force counts whose contact begins in a step, or ends in the next one; see above. `vn` is then the
 * mean speed on that way. */
INLINE double find_ramp(double depth, double vn, double dt, bool is_old, bool hertz) {
    const double way = is_old ? vn * dt : -vn * dt * (1 + 1e-6);
    return depth < way ? 0.5 + (hertz ? 0.8 : 1) * depth / way : 1;
}

/* A dashpot's force, and its power now. */
typedef struct damper {
    double force, power;
} damper;

/* The forces along the normals of two ends, and what slides them off each other: added to `sum`. Returns the whole
 * push, and in `out` the dashpots' share of it. (Contacts go by value: those of one point stay in registers.) */
static double push_ends(contact c, const touch *t, double stiffness, double dashpot, double dt, bool is_old, bool hertz,
                        dem_force *sum, damper *out) {
    double push = 0;
    *out = (damper){0, 0};
    for (int i = 0; i < 2; i++) {
        const touch_end *end = &t->end[i];
        const vec at = {end->x, end->y}, normal = {end->normal_x, end->normal_y};
        const double vn = dot(find_motion(&c, at, find_arm_b(&c, at)).ahead, normal);
        const double slow = -end->share * dashpot * find_ramp(end->depth, vn, dt, is_old, hertz) * vn;
        const double force = end->share * stiffness * t->depth + slow;
        add_force(&c, times(force, normal), at, sum);
        push += force;
        out->force += slow;
        out->power += slow * vn;
    }
    add_force(&c, times(stiffness * t->depth, (vec){t->slide_x, t->slide_y}), (vec){t->corner_x, t->corner_y}, sum);
    return push;
}

/* At the deepest end: a force on B, against the normal. Its energy is added. */
static double pull_together(const contact *c, const touch_end *end, const dem_contact_law *law, dem_force *sum,
                            double *energy) {
    const double beyond = fmin(end->depth, 0) + law->range, gap = beyond / law->range;
    const vec at = {end->x, end->y}, normal = {end->normal_x, end->normal_y};
    if (!(beyond > 0))
        return 0;
    add_force(c, times(-law->cohesion * gap, normal), at, sum);
    *energy -= law->cohesion * (0.5 * gap * beyond + fmax(end->depth, 0));
    return law->cohesion * gap;
}

/* One contact, and its row. Where `hertz` and `rolls` are constants all that they do not want is left out. Returns
 * false if both are apart after all. */
INLINE bool apply_law(dem *d, size_t pair, dem_contact *out_row, bool hertz, bool rolls, dem_block *block) {
    contact c;
    touch t;
    if (!load_contact(d, pair, &c, &t))
        return false;
    const dem_contact_law *law = &d->laws[c.a->material][c.b->material];
    const double dt = d->settings.time_step, depth = fmax(c.depth, 0);
    if (depth == 0 && !(c.depth > -law->range))
        return false;
    const double radius = hertz || rolls ? find_radius(c.a, c.b) : 0;
    const double size = hertz ? sqrt(radius * depth) : 1;
    const double kn = law->kn * size, kt = law->kt * size * t.part;
    const double mass = 1 / (c.a->inverse_mass + c.b->inverse_mass);
    const bool by_ratio = law->damping_ratio >= 0;
    const double damped = depth == 0 ? 0 : hertz ? (by_ratio ? sqrt(size) : size) : 1;
    const double dashpot_n = (by_ratio ? law->damping_ratio * sqrt(law->kn * mass) : law->gamma_n * mass) * damped;
    const double dashpot_t = by_ratio ? law->tangential_share * dashpot_n : law->gamma_t * mass * damped;

    dem_account *account = &block->account;
    dem_memory memory = *dem_memory_of(d, pair);
    if (memory.step + 1 != d->step && c.before < SIZE_MAX)
        memory = *dem_memory_of(d, c.before);
    const bool is_old = memory.step + 1 == d->step;
    memory = is_old ? memory : (dem_memory){.slide = 0};
    memory.step = d->step;
    block->old.tangential += 0.5 * memory.spring * memory.slide;
    block->old.power += memory.power;

    dem_force ends = {{0, 0}, 0, 0};
    const double spring = t.end[0].share * kn * depth, brake = t.end[0].share * dashpot_n;
    const double mean = is_old ? c.vn + dt * (spring - brake * c.vn_ahead) / mass : c.vn_ahead;
    const double whole = find_ramp(t.end[0].depth, mean, dt, is_old, hertz), ramp = whole - memory.early;
    memory.early = is_old ? whole - 1 : 0; /* it goes on, perhaps, by what it is braked more */
    damper slow = {.force = -brake * ramp * c.vn_ahead};
    double push = spring + slow.force, along = push, work = 0.5 * (slow.force + memory.damping) * c.vn;
    slow.power = slow.force * c.vn_ahead;
    if (t.count == 2) {
        push = push_ends(c, &t, kn, dashpot_n, dt, is_old, hertz, &ends, &slow);
        work = 0.5 * (slow.power + memory.power);
        along = 0;
    }
    account->damping -= work * dt;
    account->power += slow.power;
    account->normal += (hertz ? 0.4 : 0.5) * kn * depth * depth * t.part;
    memory.damping = slow.force;
    memory.power = slow.power;
    const double drag = -slide(&memory.slide, &memory.spring, kt, t.part * dashpot_t * ramp * c.vt_ahead, c.vt * dt,
                               law->friction * fabs(push), account);
    account->tangential += 0.5 * memory.spring * memory.slide;
    double pull = 0;
    if (law->cohesion > 0 && t.leads)
        pull = pull_together(&c, &t.end[0], law, &ends, &account->normal);

    const vec f = rotate(c.normal, (vec){along, drag});
    dem_force on = {f, -cross(c.point, f), cross(c.arm_b, f)};
    if (t.count == 2 || pull > 0)
        on = (dem_force){plus(f, ends.force), on.torque_a + ends.torque_a, on.torque_b + ends.torque_b};
    if (rolls) {
        block->old.rolling += 0.5 * memory.rolling_spring * memory.roll;
        const double torque = slide(&memory.roll, &memory.rolling_spring, kt * radius * radius, 0, c.turn * dt,
                                    law->rolling_friction * radius * fabs(push), account);
        account->rolling += 0.5 * memory.rolling_spring * memory.roll;
        on.torque_a += torque;
        on.torque_b -= torque;
    }
    *dem_memory_of(d, pair) = memory;
    *out_row = (dem_contact){pair, c.normal, c.point, c.depth, on};
    if (dem_team(d) == 1) /* several threads add up when all is found */
        add_to_bodies(c.a, c.b, on);
    if (block->too_deep == SIZE_MAX && is_too_deep(d, &c))
        block->too_deep = pair;
    return true;
}

/* Their rows follow each other, and what is apart in double precision has none. */
INLINE dem_block apply_laws(dem *d, size_t first, size_t end, bool hertz, bool rolls) {
    dem_block block = {.too_deep = SIZE_MAX};
    for (size_t k = first; k < end; k++)
        block.count += apply_law(d, k, &d->contacts[first + block.count], hertz, rolls, &block);
    return block;
}

__attribute__((noreturn)) static void fail_depth(dem *d, size_t pair) {
    const size_t a = d->parts[d->pairs[pair].a].body, b = d->parts[d->pairs[pair].b].body;
    const dem_contact *row = d->contacts;
    while (row->pair != pair)
        row++;
    dem_fail(d, "step %llu: grain %zu overlaps %s %zu by %g, more than %g of the smaller one's extent. %s",
             (unsigned long long)d->step, a, dem_name_kind(d, b), dem_number(d, b), row->depth, d->settings.max_overlap,
             dem_explain_depth(d));
}

static dem_account add_accounts(dem_account a, dem_account b) {
    return (dem_account){a.normal + b.normal,   a.tangential + b.tangential, a.rolling + b.rolling,
                         a.damping + b.damping, a.friction + b.friction,     a.power + b.power};
}

/* The rows and sums of all blocks, without gaps between them. */
static void join_blocks(dem *d, size_t count) {
    size_t too_deep = SIZE_MAX;
    dem_account all = {0}, old = {0};
    d->contact_count = 0;
    for (size_t i = 0; i < count; i++) {
        const dem_block *block = &d->blocks[i];
        memmove(&d->contacts[d->contact_count], &d->contacts[i * DEM_BLOCK], block->count * sizeof *d->contacts);
        d->contact_count += block->count;
        too_deep = too_deep == SIZE_MAX ? block->too_deep : too_deep;
    }
    for (size_t i = count; i-- > 0;) {
        all = add_accounts(all, d->blocks[i].account);
        old = add_accounts(old, d->blocks[i].old);
    }
    /* What springs held whose contact opened is lost to friction; and its dashpot has acted for half a step more. */
    all.friction += d->account.friction + d->account.tangential + d->account.rolling - old.tangential - old.rolling;
    all.damping += d->account.damping - 0.5 * d->settings.time_step * (d->account.power - old.power);
    d->account = all;
    if (too_deep < SIZE_MAX)
        fail_depth(d, too_deep);
}

void dem_apply_laws(dem *d) {
    const size_t count = d->pair_count, block_count = (count + DEM_BLOCK - 1) / DEM_BLOCK;
    const bool hertz = d->settings.law == DEM_HERTZ;
    const unsigned team = dem_team(d);
    bool rolls = false;
    for (size_t i = 0; i < d->material_count * d->material_count; i++)
        rolls |= d->laws[i / d->material_count][i % d->material_count].rolling_friction > 0;
    dem_grow(&d->blocks, block_count, sizeof *d->blocks);
    for (dem_body *b = d->bodies; b < d->bodies + d->body_count; b++) {
        b->force = (vec){0, 0};
        b->torque = 0;
    }
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
    for (size_t i = 0; i < block_count; i++) {
        const size_t first = i * DEM_BLOCK, end = i + 1 < block_count ? first + DEM_BLOCK : count;
        d->blocks[i] = rolls   ? apply_laws(d, first, end, hertz, true)
                       : hertz ? apply_laws(d, first, end, true, false)
                               : apply_laws(d, first, end, false, false);
    }
    join_blocks(d, block_count);
    for (const dem_contact *c = d->contacts; c < d->contacts + d->contact_count && team > 1; c++)
        add_to_bodies(dem_body_a(d, c->pair), dem_body_b(d, c->pair), c->on);
    d->pull = (dem_pull){{0, 0}, {0, 0}};
    d->stress = (vec){0, 0};
    const double volume = dem_cell_size(d).x * dem_cell_size(d).y * d->settings.thickness;
    for (const dem_contact *c = d->contacts; c < d->contacts + d->contact_count && d->drifts; c++) {
        const dem_image *image = dem_image_b(d, c->pair);
        const vec way = find_way(d, image, dem_body_a(d, c->pair), dem_body_b(d, c->pair));
        d->pull.right = plus(d->pull.right, times(image->right, c->on.force));
        d->pull.up = plus(d->pull.up, times(image->up, c->on.force));
        d->stress = plus(d->stress, (vec){c->on.force.x * way.x / volume, c->on.force.y * way.y / volume});
    }
}
