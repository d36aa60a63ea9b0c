/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * fix_wall_narc.cpp - walls: half planes in closed form, boxes by the library.
 */
#include "fix_wall_narc.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix_narc_shapes.h"
#include "force.h"
#include "input.h"
#include "modify.h"
#include "update.h"
#include "variable.h"

using namespace LAMMPS_NS;

namespace {
constexpr int arguments_before_wall = 10; /* ID group wall/narc LAW and six coefficients */
}

/* ---------------------------------------------------------------------------- the command */

FixWallNarc::FixWallNarc(LAMMPS *lammps, int count, char **arguments) : Fix(lammps, count, arguments) {
    if (count <= arguments_before_wall)
        error->all(FLERR, std::string("fix wall/narc: LAW kn kt gamma_n gamma_t xmu dampflag WALL is wanted"));
    const std::string kind = arguments[3];
    if (kind != "hooke/history" && kind != "hertz/history")
        error->all(FLERR, "fix wall/narc: no such law: " + kind);
    const auto number = [this](const char *text) { return utils::numeric(FLERR, text, false, lmp); };
    if (!narc_lammps::read_law(law, kind == "hertz/history", force->nktv2p, arguments + 4, number))
        error->all(FLERR, std::string("fix wall/narc: a coefficient is negative or out of range"));
    int i = read_wall(arguments_before_wall, count, arguments);
    if (i + 3 <= count && !std::strcmp(arguments[i], "velocity")) {
        for (int axis = 0; axis < 2; axis++) {
            const char *text = arguments[i + 1 + axis];
            if (std::strncmp(text, "v_", 2) != 0)
                velocity[axis] = number(text);
            else
                velocity_variable[axis] = text + 2;
        }
        i += 3;
        if (i + 2 == count && !std::strcmp(arguments[i], "every")) {
            every = utils::inumeric(FLERR, arguments[i + 1], false, lmp);
            i += 2;
        }
    }
    if (every < 1)
        error->all(FLERR, std::string("fix wall/narc: every is less than 1"));
    if (i != count)
        error->all(FLERR, std::string("fix wall/narc: not understood: ") + arguments[i]);

    scalar_flag = vector_flag = 1;
    size_vector = 4;
    global_freq = 1;
    extscalar = extvector = 0;
    restart_global = restart_peratom = 1;
    create_attribute = 1;
    maxexchange = 2;
    grow_arrays(atom->nmax);
    atom->add_callback(Atom::GROW);
    atom->add_callback(Atom::RESTART);
}

FixWallNarc::~FixWallNarc() {
    atom->delete_callback(id, Atom::GROW);
    atom->delete_callback(id, Atom::RESTART);
    narc_destroy_shapes(store);
}

/* Reads the wall from argument i on; the number of the argument behind it. */
int FixWallNarc::read_wall(int i, int count, char **arguments) {
    const auto number = [&](int k) { return utils::numeric(FLERR, arguments[k], false, lmp); };
    plate = !std::strcmp(arguments[i], "plate");
    if (!plate && std::strcmp(arguments[i], "box") != 0)
        error->all(FLERR, std::string("fix wall/narc: no such wall: ") + arguments[i]);
    const int end = i + (plate ? 5 : 6);
    if (count < end)
        error->all(FLERR, std::string("fix wall/narc: numbers are missing after ") + arguments[i]);
    place_x = number(i + 1);
    place_y = number(i + 2);
    if (plate) {
        const double length = std::hypot(number(i + 3), number(i + 4));
        if (!(length > 0))
            error->all(FLERR, std::string("fix wall/narc: the normal of a plate is 0"));
        normal_x = number(i + 3) / length;
        normal_y = number(i + 4) / length;
        const double half = std::acos(-1.0) / 2;
        const narc_arc ends[] = {{-1, 0, 0, half, 3 * half}, {1, 0, 0, -half, half}}; /* edge 0 looks up */
        sides.resize(2);
        make_touch_sides(ends, 2, sides.data());
        return end;
    }
    const double width = number(i + 3), height = number(i + 4), angle = number(i + 5) * std::acos(-1.0) / 180;
    normal_x = std::cos(angle);
    normal_y = std::sin(angle);
    reach = 0.5 * std::hypot(width, height);
    shapes = FixNarcShapes::find(lmp, "fix wall/narc");
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count;
    narc_error failure = {};
    if (narc_build_box(width, height, 0, arcs, &arc_count, &failure) != NARC_OK)
        error->all(FLERR, std::string("fix wall/narc: box: ") + failure.message);
    sides.resize(arc_count);
    make_touch_sides(arcs, arc_count, sides.data());
    narc_status status = narc_create_shapes(nullptr, &store);
    uint32_t next = 0; /* the shapes' own indices, also of equal ones, and behind them the box */
    for (const narc_lammps::Form &form : shapes->forms)
        if (status == NARC_OK)
            status = narc_add_shape_at(store, next++, form.arcs.data(), form.arcs.size(), &failure);
    if (status != NARC_OK || narc_add_shape_at(store, next, arcs, arc_count, &failure) != NARC_OK)
        error->all(FLERR, std::string("fix wall/narc: box: ") + failure.message);
    return end;
}

int FixWallNarc::setmask() { return FixConst::INITIAL_INTEGRATE | FixConst::POST_FORCE; }

void FixWallNarc::init() {
    shapes = FixNarcShapes::find(lmp, "fix wall/narc");
    for (const std::string &name : velocity_variable) {
        const int variable = name.empty() ? 0 : input->variable->find(const_cast<char *>(name.c_str()));
        if (variable < 0 || (!name.empty() && !input->variable->equalstyle(variable)))
            error->all(FLERR, "fix wall/narc: there is no equal-style variable " + name);
    }
    if (store && narc_count_shapes(store) != shapes->forms.size() + 1)
        error->all(FLERR, std::string("fix wall/narc: fix narc/shapes has changed since this wall was made"));
}

void FixWallNarc::setup(int virial_kind) { post_force(virial_kind); }

void FixWallNarc::initial_integrate(int) {
    const bool varies = !velocity_variable[0].empty() || !velocity_variable[1].empty();
    if (varies && update->ntimestep % every == 0) {
        modify->clearstep_compute();
        for (int axis = 0; axis < 2; axis++)
            if (!velocity_variable[axis].empty())
                velocity[axis] = input->variable->compute_equal(
                    input->variable->find(const_cast<char *>(velocity_variable[axis].c_str())));
        modify->addstep_compute(update->ntimestep + every);
    }
    moved[0] += velocity[0] * update->dt;
    moved[1] += velocity[1] * update->dt;
}

/* ---------------------------------------------------------------------------- contacts */

/* A half plane: the grain's deepest point is that of its support against the normal. What lies under it is a segment of
 * the border, four times as long as the grain. */
void FixWallNarc::find_plate_contacts() {
    const double border = normal_x * (place_x + moved[0]) + normal_y * (place_y + moved[1]);
    for (int i = 0; i < atom->nlocal; i++) {
        const double height = normal_x * atom->x[i][0] + normal_y * atom->x[i][1] - border;
        if (!(atom->mask[i] & groupbit) || height >= atom->radius[i])
            continue;
        const narc_lammps::Form &form = shapes->form(i);
        const double c = atom->mu[i][0], s = atom->mu[i][1];
        narc_point deepest;
        size_t arc;
        narc_find_support(form.arcs.data(), form.arcs.size(), -(c * normal_x + s * normal_y),
                          -(c * normal_y - s * normal_x), &deepest, &arc);
        const touch_grain outline = shapes->outline(i);
        const touch_grain under = {sides.data(), sides.size(), normal_y, -normal_x, 4 * atom->radius[i]};
        const double way_x = -height * normal_x, way_y = -height * normal_y;
        const unsigned feature = static_cast<unsigned>(arc) | NARC_FEATURE_EDGE << 8;
        contacts.push_back({i, {}, way_x, way_y});
        find_touch(&outline, &under, way_x, way_y, feature, &contacts.back().at);
    }
}

void FixWallNarc::find_box_contacts() {
    const narc_body box = {place_x + moved[0],
                           place_y + moved[1],
                           static_cast<float>(normal_x),
                           static_cast<float>(normal_y),
                           1,
                           static_cast<uint32_t>(shapes->forms.size())};
    std::vector<int> grains;
    std::vector<narc_body> bodies; /* each grain that may touch, and the box */
    for (int i = 0; i < atom->nlocal; i++) {
        if (!(atom->mask[i] & groupbit) ||
            std::hypot(atom->x[i][0] - box.x, atom->x[i][1] - box.y) >= reach + atom->radius[i])
            continue;
        grains.push_back(i);
        bodies.push_back(shapes->body(i));
        bodies.push_back(box);
    }
    const narc_bodies view = narc_view_bodies(bodies.data(), bodies.size());
    narc_pairs pairs = {};
    pairs.count = grains.size();
    std::vector<narc_contact> rows(grains.size());
    size_t found = 0;
    narc_error failure = {};
    narc_query query = {};
    query.margin = static_cast<float>(8 * NARC_ERROR_BOUND * reach);
    if (narc_find_contacts(store, &view, &pairs, &query, rows.data(), rows.size(), &found, &failure) != NARC_OK)
        error->one(FLERR, std::string("fix wall/narc: ") + failure.message);
    rows.resize(found);
    const touch_grain wall = {sides.data(), sides.size(), normal_x, normal_y, 1};
    for (const narc_contact &row : rows) {
        const int i = grains[row.pair];
        const touch_grain outline = shapes->outline(i);
        const double way_x = box.x - atom->x[i][0], way_y = box.y - atom->x[i][1];
        contacts.push_back({i, {}, way_x, way_y});
        find_touch(&outline, &wall, way_x, way_y, row.feature, &contacts.back().at);
    }
}

void FixWallNarc::apply_contact(const Contact &contact, double step) {
    const int i = contact.grain;
    const narc_lammps::Contact at = {contact.at.end[0],
                                     contact.at.depth,
                                     contact.at.count == 2 ? &contact.at : nullptr,
                                     contact.way_x,
                                     contact.way_y,
                                     {atom->v[i][0], atom->v[i][1], atom->omega[i][2]},
                                     {velocity[0], velocity[1], 0},
                                     atom->rmass[i],
                                     shapes->equal_radius(i)};
    const narc_lammps::Force on_grain = narc_lammps::compute_force(law, at, step, &slips[2 * static_cast<size_t>(i)]);
    atom->f[i][0] += on_grain.x;
    atom->f[i][1] += on_grain.y;
    atom->torque[i][2] += on_grain.torque_a;
    mine[0] -= on_grain.x;
    mine[1] -= on_grain.y;
    mine[2] += on_grain.energy;
}

void FixWallNarc::post_force(int) {
    contacts.clear();
    if (plate)
        find_plate_contacts();
    else
        find_box_contacts();
    contacts.erase(std::remove_if(contacts.begin(), contacts.end(), [](const Contact &c) { return !c.at.count; }),
                   contacts.end());
    std::fill(mine, mine + 3, 0.0);
    summed = false;
    std::fill(touched.begin(), touched.end(), 0);
    for (const Contact &contact : contacts)
        touched[static_cast<size_t>(contact.grain)] = 1;
    for (size_t i = 0; i < static_cast<size_t>(atom->nlocal); i++)
        if (!touched[i])
            slips[2 * i] = slips[2 * i + 1] = 0;
    const double step = update->setupflag ? 0 : update->dt;
    for (const Contact &contact : contacts)
        apply_contact(contact, step);
}

/* ---------------------------------------------------------------------------- output */

void FixWallNarc::sum_ranks() {
    if (!summed)
        MPI_Allreduce(mine, total, 3, MPI_DOUBLE, MPI_SUM, world);
    summed = true;
}

double FixWallNarc::compute_scalar() {
    sum_ranks();
    return total[2];
}

double FixWallNarc::compute_vector(int k) {
    if (k >= 2)
        return moved[k - 2];
    sum_ranks();
    return total[k];
}

/* ---------------------------------------------------------------------------- memory that goes with the atoms */

void FixWallNarc::grow_arrays(int most) {
    slips.resize(2 * static_cast<size_t>(most), 0);
    touched.resize(static_cast<size_t>(most), 0);
}

void FixWallNarc::copy_arrays(int from, int to, int) {
    std::copy_n(&slips[2 * static_cast<size_t>(from)], 2, &slips[2 * static_cast<size_t>(to)]);
}

void FixWallNarc::set_arrays(int i) { std::fill_n(&slips[2 * static_cast<size_t>(i)], 2, 0.0); }

int FixWallNarc::pack_exchange(int i, double *buffer) {
    std::copy_n(&slips[2 * static_cast<size_t>(i)], 2, buffer);
    return 2;
}

int FixWallNarc::unpack_exchange(int i, double *buffer) {
    std::copy_n(buffer, 2, &slips[2 * static_cast<size_t>(i)]);
    return 2;
}

/* The velocity too: variables may be looked at some steps later. */
void FixWallNarc::write_restart(FILE *file) {
    if (comm->me == 0) {
        const double state[] = {moved[0], moved[1], velocity[0], velocity[1]};
        const int size = sizeof state;
        fwrite(&size, sizeof size, 1, file);
        fwrite(state, sizeof state, 1, file);
    }
}

void FixWallNarc::restart(char *buffer) {
    double state[4];
    std::memcpy(state, buffer, sizeof state);
    for (int axis = 0; axis < 2; axis++) {
        moved[axis] = state[axis];
        if (!velocity_variable[axis].empty())
            velocity[axis] = state[2 + axis];
    }
}

int FixWallNarc::pack_restart(int i, double *buffer) {
    buffer[0] = 3;
    pack_exchange(i, buffer + 1);
    return 3;
}

void FixWallNarc::unpack_restart(int i, int nth) {
    double *extra = atom->extra[i];
    for (int k = 0; k < nth; k++)
        extra += static_cast<int>(*extra);
    unpack_exchange(i, extra + 1);
}
