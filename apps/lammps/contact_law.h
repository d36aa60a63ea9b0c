/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * contact_law.h - the force of a contact: a spring and a dashpot along the normal, and across it a spring with memory
 * that slides when it reaches the friction. The coefficients mean what they do for gran/hooke/history and
 * gran/hertz/history.
 */
#ifndef NARC_LAMMPS_CONTACT_LAW_H
#define NARC_LAMMPS_CONTACT_LAW_H

#include <algorithm>
#include <cmath>
#include <string>

namespace narc_lammps {

/* Hertz: the radius of curvature of a touching corner (0) or edge (infinite) is taken for this many times the
 * grain's own radius, and any other is kept between the two. */
constexpr double least_curvature_radius = 1.0 / 16;
constexpr double greatest_curvature_radius = 16;

inline double limit_curvature_radius(double radius, double grain_radius) {
    return std::clamp(radius, least_curvature_radius * grain_radius, greatest_curvature_radius * grain_radius);
}

struct ContactLaw {
    bool hertz = false;
    double kn = 0, kt = 0;
    double gamma_n = 0, gamma_t = 0;
    double friction = 0;
    bool limit_damping = false; /* never pull */
};

/* A contact of A with B in the plane. */
struct Touch {
    double normal_x, normal_y;     /* unit, from A to B */
    double overlap;                /* > 0 */
    double velocity_x, velocity_y; /* of A's surface there less that of B's */
    double mass;                   /* effective */
    double curvature_radius;       /* 1 / (1 / R_a + 1 / R_b), for Hertz */
};

struct Force {
    double x, y;   /* on A */
    double energy; /* elastic: of both springs */
};

/* How a style's arguments name the law: kn kt gamma_n gamma_t xmu dampflag, NULL for kt (2/7 of kn) and gamma_t (half
 * of gamma_n). False if they are no law. `pressure_unit` is LAMMPS' force->nktv2p, by which Hertz' stiffnesses are
 * divided. `number` reads an argument. */
template <class Number>
bool read_law(ContactLaw &law, bool hertz, double pressure_unit, char **arguments, Number number) {
    const auto is_null = [](const char *text) { return std::string(text) == "NULL"; };
    law.hertz = hertz;
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
    return law.kn >= 0 && law.kt >= 0 && law.gamma_n >= 0 && law.gamma_t >= 0 && law.friction >= 0 &&
           law.friction <= 10000 && (damped == 0 || damped == 1);
}

/* The force of a contact. `slip` is the memory of the tangential spring, a vector; it moves on by `step` of time, and
 * not at all if `step` is 0. */
inline Force compute_force(const ContactLaw &law, const Touch &at, double step, double slip[2]) {
    const double approach = at.velocity_x * at.normal_x + at.velocity_y * at.normal_y;
    const double tangent_x = at.velocity_x - approach * at.normal_x;
    const double tangent_y = at.velocity_y - approach * at.normal_y;
    const double stiffening = law.hertz ? std::sqrt(at.overlap * at.curvature_radius) : 1;
    double push = stiffening * (law.kn * at.overlap + at.mass * law.gamma_n * approach);
    if (law.limit_damping)
        push = std::max(push, 0.0);

    if (step > 0) {
        slip[0] += tangent_x * step;
        slip[1] += tangent_y * step;
        const double along_normal = slip[0] * at.normal_x + slip[1] * at.normal_y;
        slip[0] -= along_normal * at.normal_x;
        slip[1] -= along_normal * at.normal_y;
    }
    const double drag = at.mass * law.gamma_t;
    double shear_x = -stiffening * (law.kt * slip[0] + drag * tangent_x);
    double shear_y = -stiffening * (law.kt * slip[1] + drag * tangent_y);
    const double shear = std::hypot(shear_x, shear_y), most = law.friction * std::fabs(push);
    if (shear > most) {
        const double keep = most / shear;
        const bool memory = slip[0] != 0 || slip[1] != 0;
        shear_x = memory ? shear_x * keep : 0;
        shear_y = memory ? shear_y * keep : 0;
        if (law.kt > 0 && memory) { /* the spring is as long as what friction can hold */
            slip[0] = keep * (slip[0] + drag * tangent_x / law.kt) - drag * tangent_x / law.kt;
            slip[1] = keep * (slip[1] + drag * tangent_y / law.kt) - drag * tangent_y / law.kt;
        }
    }
    /* The work of kn overlap is kn overlap^2 / 2, that of kn sqrt(R) overlap^(3/2) is 2/5 of force times overlap. */
    const double energy = stiffening * (law.kn * at.overlap * at.overlap * (law.hertz ? 0.4 : 0.5) +
                                        0.5 * law.kt * (slip[0] * slip[0] + slip[1] * slip[1]));
    return {shear_x - push * at.normal_x, shear_y - push * at.normal_y, energy};
}

} // namespace narc_lammps

#endif
