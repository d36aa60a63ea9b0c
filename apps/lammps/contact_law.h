/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * contact_law.h - the force of a contact: a spring and a dashpot along the normal, and across it a spring with memory
 * that slides when it reaches the friction. The coefficients mean what they do for gran/hooke/history and
 * gran/hertz/history. With the law `rescaled` the tangential spring keeps its force where its stiffness grows, and its length
 * where that falls, as LAMMPS' mindlin/rescale does: no cycle of loads gives energy.
 */
#ifndef NARC_LAMMPS_CONTACT_LAW_H
#define NARC_LAMMPS_CONTACT_LAW_H

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "touch.h"

namespace narc_lammps {

struct ContactLaw {
    bool hertz = false, rescaled = false;
    double kn = 0, kt = 0;
    double gamma_n = 0, gamma_t = 0;
    double friction = 0;
    double damping =
        0; /* above 0: dashpots are this times sqrt(stiffness mass), and gamma_t the share of the tangential */
    double rolling = 0;             /* the torque against rolling is at most this times radius times force */
    bool limit_damping = false;     /* never pull */
    double cohesion = 0, range = 0; /* a force that falls to 0 over that distance */
};

/* What a contact remembers: the tangential spring, a vector; the angle by which it has rolled; and what kt was multiplied by. */
struct Springs {
    double x, y, angle, stiffening;
};

/* A contact as it is put out: IDs, of a wall a negative number; where it is; its normal from A to B, and the force on
 * B. */
struct ContactRow {
    double a, b, x, y, normal_x, normal_y, force_x, force_y, depth;
};

/* How a grain or a wall moves. */
struct Motion {
    double x, y, spin;
};

/* A contact of A with B in the plane. */
struct Contact {
    touch_end end;      /* of one; of two the deeper one */
    double depth, part; /* as of touch.h */
    bool leads;
    const touch *ends;   /* of two; else null */
    double way_x, way_y; /* from A to B */
    Motion a, b;
    double mass;   /* effective */
    double radius; /* 1 / (1 / R_a + 1 / R_b), of the discs of equal area, for Hertz and rolling */
};

struct Force {
    double x, y; /* on A, on B the opposite */
    double torque_a, torque_b;
    double energy;                               /* elastic: of all springs */
    double point_x, point_y, normal_x, normal_y; /* from the centre of A; from A to B */
};

/* How a command's arguments name the law: kn kt gamma_n gamma_t xmu dampflag [limit_damping] [rolling MU]
 * [restitution E] [cohesion F RANGE], NULL for kt (2/7 of kn) and gamma_t (half of gamma_n). With a restitution dashpots are such that
 * grains bounce so at any mass and speed; gamma_n says nothing, and gamma_t is the share of the normal dashpot that the
 * tangential one is. The number of arguments read, 0 if they are no law. `pressure_unit` is
 * LAMMPS' force->nktv2p, by which Hertz' stiffnesses are divided. `number` reads an argument. */
template <class Number>
int read_law(ContactLaw &law, bool hertz, bool rescaled, double pressure_unit, int count, char **arguments,
             Number number) {
    if (count < 6)
        return 0;
    const auto is_null = [](const char *text) { return std::string(text) == "NULL"; };
    law = {};
    law.hertz = hertz;
    law.rescaled = rescaled;
    law.kn = number(arguments[0]);
    law.kt = is_null(arguments[1]) ? law.kn * 2 / 7 : number(arguments[1]);
    law.gamma_n = number(arguments[2]);
    law.gamma_t = is_null(arguments[3]) ? law.gamma_n / 2 : number(arguments[3]);
    law.friction = number(arguments[4]);
    const double damped = number(arguments[5]);
    if (damped == 0)
        law.gamma_t = 0;
    if (hertz) {
        law.kn /= pressure_unit;
        law.kt /= pressure_unit;
    }
    int read = 6;
    double restitution = 1;
    for (; read < count; read++) {
        const std::string word = arguments[read];
        if (word == "rolling" && read + 1 < count)
            law.rolling = number(arguments[++read]);
        else if (word == "restitution" && read + 1 < count)
            restitution = number(arguments[++read]);
        else if (word == "cohesion" && read + 2 < count) {
            law.cohesion = number(arguments[++read]);
            law.range = number(arguments[++read]);
        } else if (word == "limit_damping")
            law.limit_damping = true;
        else
            break;
    }
    if (restitution > 0 && restitution < 1) {
        const double lost = -std::log(restitution), pi = std::acos(-1.0);
        law.damping = (hertz ? std::sqrt(5.0) : 2) * lost / std::sqrt(pi * pi + lost * lost);
        law.gamma_t = damped == 0 ? 0 : is_null(arguments[3]) ? 0.5 : law.gamma_t;
    }
    const bool good = restitution > 0 && restitution <= 1 && law.kn >= 0 && law.kt >= 0 && law.gamma_n >= 0 &&
                      law.gamma_t >= 0 && law.friction >= 0 && law.friction <= 10000 && law.rolling >= 0 &&
                      law.cohesion >= 0 && law.range >= 0 && (law.cohesion == 0 || law.range > 0) &&
                      (damped == 0 || damped == 1);
    return good ? read : 0;
}

/* The velocity of A's surface less that of B's, where the arms reach. */
inline void find_velocity(const Contact &c, const double arm_a[2], const double arm_b[2], double velocity[2]) {
    velocity[0] = c.a.x - c.a.spin * arm_a[1] - (c.b.x - c.b.spin * arm_b[1]);
    velocity[1] = c.a.y + c.a.spin * arm_a[0] - (c.b.y + c.b.spin * arm_b[0]);
}

/* Adds a force on A, and the opposite one on B. */
inline void add_force(Force &sum, double x, double y, const double arm_a[2], const double arm_b[2]) {
    sum.x += x;
    sum.y += y;
    sum.torque_a += arm_a[0] * y - arm_a[1] * x;
    sum.torque_b -= arm_b[0] * y - arm_b[1] * x;
}

/* Along the normals of two ends (see touch.h), and along the side that they are the ends of. The whole push. (Contacts
 * go by value, so that those of one point stay in registers.) */
[[gnu::noinline]] inline double push_ends(const ContactLaw &law, Contact c, double stiffening, double dashpot,
                                          Force &sum) {
    double whole = 0, velocity[2];
    const double spring = stiffening * law.kn * c.depth; /* where h is not above 0 there is one end */
    for (const touch_end &end : c.ends->end) {
        const double arm_a[2] = {end.x, end.y}, arm_b[2] = {end.x - c.way_x, end.y - c.way_y};
        find_velocity(c, arm_a, arm_b, velocity);
        const double approach = velocity[0] * end.normal_x + velocity[1] * end.normal_y;
        double push = end.share * (spring + stiffening * dashpot * approach);
        if (law.limit_damping)
            push = std::max(push, 0.0);
        add_force(sum, -push * end.normal_x, -push * end.normal_y, arm_a, arm_b);
        whole += push;
    }
    const double arm_a[2] = {c.ends->corner_x, c.ends->corner_y};
    const double arm_b[2] = {arm_a[0] - c.way_x, arm_a[1] - c.way_y};
    add_force(sum, -spring * c.ends->slide_x, -spring * c.ends->slide_y, arm_a, arm_b);
    return whole;
}

/* Against rolling: a spring with the stiffness of the tangential one at the arm R, cut back as friction is. */
inline void add_rolling(const ContactLaw &law, const Contact &c, double stiffening, double push, double step,
                        double &angle, Force &sum) {
    const double stiffness = stiffening * c.part * law.kt * c.radius * c.radius;
    const double most = law.rolling * c.radius * std::fabs(push);
    angle += (c.b.spin - c.a.spin) * step;
    const double torque = std::min(std::max(stiffness * angle, -most), most);
    if (torque != stiffness * angle)
        angle = torque / stiffness;
    sum.torque_a += torque;
    sum.torque_b -= torque;
    sum.energy += 0.5 * torque * angle;
}

/* At the deepest end. */
[[gnu::noinline]] inline Force add_cohesion(const ContactLaw &law, Contact c, Force sum) {
    const double beyond = std::min(c.end.depth, 0.0) + law.range, gap = beyond / law.range;
    const double arm_a[2] = {c.end.x, c.end.y}, arm_b[2] = {c.end.x - c.way_x, c.end.y - c.way_y};
    const double pull = law.cohesion * gap;
    add_force(sum, pull * c.end.normal_x, pull * c.end.normal_y, arm_a, arm_b);
    sum.energy -= law.cohesion * (0.5 * gap * beyond + std::max(c.end.depth, 0.0));
    return sum;
}

/* The force of a contact. `slip` is its memory; it moves on by `step` of time, and not at all if `step` is 0.
 * gran/hooke/history takes the velocities along the tangent, and lets that force act, where the surface of each grain
 * lies deepest in the other: for discs at the end of each radius. So does this, for any form; of two ends in their
 * mean. A call would cost as much as the force of a disc. */
[[gnu::always_inline]] inline Force compute_force(const ContactLaw &law, const Contact &c, double step, Springs &slip) {
    const touch_end deep = c.end;
    double normal_x = deep.normal_x, normal_y = deep.normal_y, x = deep.x, y = deep.y, half = 0.5 * deep.depth;
    if (c.ends) {
        const touch_end flat = c.ends->end[1];
        const double rest = flat.share / (deep.share + flat.share), first = 1 - rest;
        const double along_x = first * deep.normal_x + rest * flat.normal_x;
        const double along_y = first * deep.normal_y + rest * flat.normal_y;
        const double length = std::sqrt(along_x * along_x + along_y * along_y);
        normal_x = along_x / length;
        normal_y = along_y / length;
        half = 0.5 * (first * deep.depth + rest * flat.depth);
        x = first * deep.x + rest * flat.x;
        y = first * deep.y + rest * flat.y;
    }
    const double arm_a[2] = {x + half * normal_x, y + half * normal_y};
    const double arm_b[2] = {x - half * normal_x - c.way_x, y - half * normal_y - c.way_y};
    double velocity[2];
    find_velocity(c, arm_a, arm_b, velocity);
    const double approach = velocity[0] * normal_x + velocity[1] * normal_y;
    const double tangent_x = velocity[0] - approach * normal_x, tangent_y = velocity[1] - approach * normal_y;
    const double depth = std::max(c.depth, 0.0), stiffening = depth == 0  ? 0
                                                              : law.hertz ? std::sqrt(depth * c.radius)
                                                                          : 1;
    const double dashpot =
        law.damping > 0 && depth > 0 ? law.damping * std::sqrt(law.kn * c.mass / stiffening) : c.mass * law.gamma_n;
    Force sum = {};
    double push, along = 0; /* along: the part of it that acts here, and not at two ends */
    if (c.ends) {
        Force of_ends = {};
        push = push_ends(law, c, stiffening, dashpot, of_ends);
        sum = of_ends;
    } else {
        push = deep.share * stiffening * (law.kn * depth + dashpot * approach);
        along = push = law.limit_damping ? std::max(push, 0.0) : push;
    }

    const double across = stiffening * c.part;
    if ((law.rescaled || !law.hertz) && across > slip.stiffening) {
        slip.x *= slip.stiffening / across;
        slip.y *= slip.stiffening / across;
    }
    slip.stiffening = across;
    if (step > 0) {
        slip.x += tangent_x * step;
        slip.y += tangent_y * step;
        const double along_normal = slip.x * normal_x + slip.y * normal_y;
        slip.x -= along_normal * normal_x;
        slip.y -= along_normal * normal_y;
    }
    const double drag = (law.damping > 0 ? dashpot : c.mass) * law.gamma_t;
    double shear_x = -across * (law.kt * slip.x + drag * tangent_x);
    double shear_y = -across * (law.kt * slip.y + drag * tangent_y);
    const double shear = std::sqrt(shear_x * shear_x + shear_y * shear_y), most = law.friction * std::fabs(push);
    if (shear > most) {
        const double keep = most / shear;
        const bool memory = slip.x != 0 || slip.y != 0;
        shear_x = memory ? shear_x * keep : 0;
        shear_y = memory ? shear_y * keep : 0;
        if (!(most > 0)) {
            slip.x = slip.y = 0;           /* where nothing is borne there is no spring */
        } else if (law.kt > 0 && memory) { /* the spring is as long as what friction can hold */
            slip.x = keep * (slip.x + drag * tangent_x / law.kt) - drag * tangent_x / law.kt;
            slip.y = keep * (slip.y + drag * tangent_y / law.kt) - drag * tangent_y / law.kt;
        }
    }
    add_force(sum, shear_x - along * normal_x, shear_y - along * normal_y, arm_a, arm_b);
    /* The work of kn overlap is kn overlap^2 / 2, that of kn sqrt(R) overlap^(3/2) is 2/5 of force times overlap. */
    sum.energy = across * (law.kn * depth * depth * (law.hertz ? 0.4 : 0.5) +
                           0.5 * law.kt * (slip.x * slip.x + slip.y * slip.y));
    if (law.rolling > 0)
        add_rolling(law, c, stiffening, push, step, slip.angle, sum);
    if (law.cohesion > 0 && c.leads)
        sum = add_cohesion(law, c, sum);
    sum.point_x = x;
    sum.point_y = y;
    sum.normal_x = normal_x;
    sum.normal_y = normal_y;
    return sum;
}

/* The row of a contact whose A is there. */
inline ContactRow make_row(const Force &on_a, double depth, double a, double b, const double place_a[2]) {
    return {a,       b,    place_a[0] + on_a.point_x, place_a[1] + on_a.point_y, on_a.normal_x, on_a.normal_y, -on_a.x,
            -on_a.y, depth};
}

/* join_touches() of all contacts of two bodies; `spring(i)` is the memory of contact i. */
template <class Spring> void join_contacts(std::vector<touch_parts> &parts, Spring spring) {
    join_touches(parts.data(), parts.size());
    for (size_t now = 0; now < parts.size(); now++) {
        if (!(parts[now].at.count > 0 && parts[now].at.leads && spring(now)->stiffening == 0))
            continue;
        for (size_t old = 0; old < parts.size(); old++)
            if (parts[old].at.count == 0 && spring(old)->stiffening > 0) {
                *spring(now) = *spring(old);
                break;
            }
    }
}

} // namespace narc_lammps

#endif
