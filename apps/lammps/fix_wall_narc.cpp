/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * fix_wall_narc.cpp - walls: half planes in closed form, boxes and chains by the library.
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

/* ---------------------------------------------------------------------------- the command */

FixWallNarc::FixWallNarc(LAMMPS *lammps, int count, char **arguments) : Fix(lammps, count, arguments) {
    if (count < 11)
        error->all(FLERR, std::string("fix wall/narc: LAW kn kt gamma_n gamma_t xmu dampflag WALL is wanted"));
    shapes = FixNarcShapes::find(lmp, "fix wall/narc");
    const std::string kind = arguments[3];
    if (kind != "hooke/history" && kind != "hertz/history" && kind != "mindlin/rescale")
        error->all(FLERR, "fix wall/narc: no such law: " + kind);
    const auto number = [this](const char *text) { return utils::numeric(FLERR, text, false, lmp); };
    int i = narc_lammps::read_law(law, kind != "hooke/history", kind == "mindlin/rescale", force->nktv2p, count - 4,
                                  arguments + 4, number);
    if (i == 0 || 4 + i >= count)
        error->all(FLERR, std::string("fix wall/narc: a coefficient is negative or out of range, or no wall is named"));
    i = read_wall(4 + i, count, arguments);
    while (i < count)
        i = read_motion(i, count, arguments);
    if (every < 1)
        error->all(FLERR, std::string("fix wall/narc: every is less than 1"));

    scalar_flag = vector_flag = 1;
    size_vector = 6;
    virial_global_flag = virial_peratom_flag = 1;
    global_freq = 1;
    extscalar = extvector = 0;
    restart_global = restart_peratom = 1;
    create_attribute = 1;
    maxexchange = static_cast<int>(memory_size * most_memories());
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
    const bool chain = !std::strcmp(arguments[i], "chain");
    if (!plate && !chain && std::strcmp(arguments[i], "box") != 0)
        error->all(FLERR, std::string("fix wall/narc: no such wall: ") + arguments[i]);
    const int end = i + (plate ? 5 : 6);
    if (count < end)
        error->all(FLERR, std::string("fix wall/narc: numbers are missing after ") + arguments[i]);
    forms = narc_count_shapes(shapes->store);
    place_x = number(i + (chain ? 3 : 1));
    place_y = number(i + (chain ? 4 : 2));
    if (plate) {
        const double length = std::hypot(number(i + 3), number(i + 4));
        if (!(length > 0))
            error->all(FLERR, std::string("fix wall/narc: the normal of a plate is 0"));
        normal_x = number(i + 3) / length;
        normal_y = number(i + 4) / length;
        const double half = std::acos(-1.0) / 2;
        const narc_arc ends[] = {{-1, 0, 0, half, 3 * half}, {1, 0, 0, -half, half}}; /* edge 0 looks up */
        pieces.push_back({0, 0, 0, std::vector<touch_side>(2)});
        make_touch_sides(ends, 2, pieces[0].sides.data());
        return end;
    }
    const double angle = number(i + 5) * std::acos(-1.0) / 180;
    normal_x = std::cos(angle);
    normal_y = std::sin(angle);
    const uint32_t next = narc_lammps::store_parts(shapes->forms, &store);
    if (chain) {
        read_chain(arguments[i + 1], arguments[i + 2]);
        return end;
    }
    const double width = number(i + 3), height = number(i + 4);
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count;
    narc_error failure = {};
    if (narc_build_box(width, height, 0, arcs, &arc_count, &failure) != NARC_OK ||
        narc_add_shape_at(store, next, arcs, arc_count, &failure) != NARC_OK)
        error->all(FLERR, std::string("fix wall/narc: box: ") + failure.message);
    pieces.push_back({next, 0, 0, std::vector<touch_side>(arc_count)});
    make_touch_sides(arcs, arc_count, pieces[0].sides.data());
    reach = std::hypot(0.5 * width, 0.5 * height);
    return end;
}

/* Each piece in the chain's coordinates. */
void FixWallNarc::read_chain(const char *path, const char *name) {
    try {
        const std::vector<narc_lammps::ChainPiece> entries = narc_lammps::read_chain(path, name, store, reach);
        for (const narc_lammps::ChainPiece &e : entries)
            pieces.push_back({e.shape, e.x, e.y, e.sides});
    } catch (const std::runtime_error &wrong) {
        error->all(FLERR, std::string("fix wall/narc: ") + wrong.what());
    }
}

/* Reads a keyword of how the wall moves; the number of the argument behind it. */
int FixWallNarc::read_motion(int i, int count, char **arguments) {
    const std::string word = arguments[i];
    const auto read = [&](int axis, const char *text) {
        if (!std::strncmp(text, "v_", 2))
            variables[axis] = text + 2;
        else
            velocity[axis] = utils::numeric(FLERR, text, false, lmp);
    };
    if (word == "velocity" && i + 2 < count) {
        read(0, arguments[i + 1]);
        read(1, arguments[i + 2]);
        return i + 3;
    }
    if (word == "spin" && i + 3 < count && !plate) {
        read(2, arguments[i + 1]);
        pivot[0] = utils::numeric(FLERR, arguments[i + 2], false, lmp);
        pivot[1] = utils::numeric(FLERR, arguments[i + 3], false, lmp);
        return i + 4;
    }
    if (word != "every" || i + 1 >= count)
        error->all(FLERR, "fix wall/narc: not understood: " + word);
    every = utils::inumeric(FLERR, arguments[i + 1], false, lmp);
    return i + 2;
}

int FixWallNarc::setmask() { return FixConst::INITIAL_INTEGRATE | FixConst::POST_FORCE; }

void FixWallNarc::init() {
    shapes = FixNarcShapes::find(lmp, "fix wall/narc");
    for (const std::string &name : variables) {
        const int variable = name.empty() ? 0 : input->variable->find(const_cast<char *>(name.c_str()));
        if (variable < 0 || (!name.empty() && !input->variable->equalstyle(variable)))
            error->all(FLERR, "fix wall/narc: there is no equal-style variable " + name);
    }
    if (maxexchange != static_cast<int>(memory_size * most_memories()) || forms != narc_count_shapes(shapes->store))
        error->all(FLERR, std::string("fix wall/narc: fix narc/shapes has changed since this wall was made"));
}

void FixWallNarc::setup(int virial_kind) { post_force(virial_kind); }

void FixWallNarc::initial_integrate(int) {
    const bool varies = !variables[0].empty() || !variables[1].empty() || !variables[2].empty();
    if (varies && update->ntimestep % every == 0) {
        modify->clearstep_compute();
        for (int axis = 0; axis < 3; axis++)
            if (!variables[axis].empty())
                velocity[axis] =
                    input->variable->compute_equal(input->variable->find(const_cast<char *>(variables[axis].c_str())));
        modify->addstep_compute(update->ntimestep + every);
    }
    for (int axis = 0; axis < 3; axis++)
        moved[axis] += velocity[axis] * update->dt;
}

/* ---------------------------------------------------------------------------- contacts */

/* A half plane: the grain's deepest point is that of its support against the normal. What lies under it is a segment of
 * the border, four times as long as the grain. */
void FixWallNarc::find_plate_contacts() {
    const double border = normal_x * (place_x + moved[0]) + normal_y * (place_y + moved[1]);
    for (int i = 0; i < atom->nlocal; i++) {
        const double height = normal_x * atom->x[i][0] + normal_y * atom->x[i][1] - border;
        if (!(atom->mask[i] & groupbit) || height >= atom->radius[i] + law.range)
            continue;
        const narc_lammps::Form &form = shapes->form(i);
        const double c = atom->mu[i][0], s = atom->mu[i][1];
        const std::vector<touch_side> &sides = pieces[0].sides;
        const touch_grain under = {sides.data(), sides.size(), normal_y, -normal_x, 4 * (atom->radius[i] + law.range)};
        for (size_t part = 0; part < form.parts.size(); part++) {
            const std::vector<narc_arc> &arcs = form.parts[part].arcs;
            narc_point deepest;
            size_t arc;
            narc_find_support(arcs.data(), arcs.size(), -(c * normal_x + s * normal_y), -(c * normal_y - s * normal_x),
                              &deepest, &arc);
            add_contact(i, part, 0, under, -height * normal_x, -height * normal_y,
                        static_cast<unsigned>(arc) | NARC_FEATURE_EDGE << 8);
        }
    }
}

void FixWallNarc::add_contact(int i, size_t part, size_t piece, const touch_grain &wall, double way_x, double way_y,
                              unsigned feature) {
    Contact contact = {i, {shapes->outline(i, part), wall, way_x, way_y, part, piece, {}}, 0};
    find_touch(&contact.parts.a, &contact.parts.b, way_x, way_y, feature, &contact.parts.at);
    if (contact.parts.at.depth > -law.range)
        contacts.push_back(contact);
}

/* Turned about the pivot, which moves. */
void FixWallNarc::place_pieces() {
    const double c = std::cos(moved[2]), s = std::sin(moved[2]), x = place_x - pivot[0], y = place_y - pivot[1];
    cosine = c * normal_x - s * normal_y;
    sine = s * normal_x + c * normal_y;
    const double arm_x = c * x - s * y, arm_y = s * x + c * y;
    wall_x = pivot[0] + moved[0] + arm_x;
    wall_y = pivot[1] + moved[1] + arm_y;
    motion = {velocity[0] - velocity[2] * arm_y, velocity[1] + velocity[2] * arm_x, velocity[2]};
}

void FixWallNarc::find_piece_contacts() {
    std::vector<Contact> asked;    /* which part meets which piece */
    std::vector<narc_body> bodies; /* both */
    for (int i = 0; i < atom->nlocal; i++) {
        const double most = reach + atom->radius[i] + law.range;
        if (!(atom->mask[i] & groupbit) || std::hypot(atom->x[i][0] - wall_x, atom->x[i][1] - wall_y) >= most)
            continue;
        for (size_t part = 0; part < shapes->form(i).parts.size(); part++)
            for (size_t k = 0; k < pieces.size(); k++) {
                asked.push_back({i, {{}, {}, 0, 0, part, k, {}}, 0});
                bodies.push_back(shapes->body(i, part));
                bodies.push_back({wall_x + cosine * pieces[k].x - sine * pieces[k].y,
                                  wall_y + sine * pieces[k].x + cosine * pieces[k].y, static_cast<float>(cosine),
                                  static_cast<float>(sine), 1, pieces[k].shape});
            }
    }
    narc_bodies view;
    narc_view_bodies(bodies.data(), bodies.size(), &view);
    narc_pairs pairs = {};
    pairs.count = asked.size();
    std::vector<narc_contact> found_rows(asked.size());
    size_t found = 0;
    narc_error failure = {};
    narc_query query = {};
    query.margin = static_cast<float>(law.range + 16 * NARC_ERROR_BOUND * reach);
    if (narc_find_contacts(store, &view, &pairs, &query, found_rows.data(), found_rows.size(), &found, &failure) !=
        NARC_OK)
        error->one(FLERR, std::string("fix wall/narc: ") + failure.message);
    found_rows.resize(found);
    for (const narc_contact &row : found_rows) {
        const Contact &of = asked[row.pair];
        const Piece &piece = pieces[of.parts.part_b];
        const touch_grain wall = {piece.sides.data(), std::signbit(piece.sides[0].radius) ? 1 : piece.sides.size(),
                                  cosine, sine, 1};
        add_contact(of.grain, of.parts.part_a, of.parts.part_b, wall, wall_x - atom->x[of.grain][0],
                    wall_y - atom->x[of.grain][1], row.feature);
    }
}

/* That of this piece, or a free one. */
size_t FixWallNarc::find_memory(const Contact &contact) {
    const size_t each = most_memories() / shapes->most_parts;
    Memory *first = memories_of(contact.grain) + contact.parts.part_a * each;
    const double name = 1 + static_cast<double>(contact.parts.part_b);
    for (int free = 0; free < 2; free++)
        for (Memory *m = first; m < first + each; m++)
            if (m->piece == (free ? 0 : name)) {
                m->piece = name;
                return static_cast<size_t>(m - memories.data());
            }
    error->one(FLERR, std::string("fix wall/narc: a part of a grain touches more than 4 pieces of a chain"));
    return 0;
}

/* Those of one grain follow each other, and those of one surface are one. */
void FixWallNarc::join_contacts() {
    std::vector<touch_parts> parts;
    for (size_t k = 0, next; k < contacts.size(); k = next) {
        parts.clear();
        for (next = k; next < contacts.size() && contacts[next].grain == contacts[k].grain; next++)
            parts.push_back(contacts[next].parts);
        if (parts.size() < 2)
            continue;
        narc_lammps::join_contacts(parts, [&](size_t i) { return &memories[contacts[k + i].memory].springs; });
        for (size_t i = 0; i < parts.size(); i++)
            contacts[k + i].parts.at = parts[i].at;
    }
    contacts.erase(std::remove_if(contacts.begin(), contacts.end(), [](const Contact &c) { return !c.parts.at.count; }),
                   contacts.end());
}

void FixWallNarc::apply_contact(const Contact &contact, double step) {
    const int i = contact.grain;
    const touch &t = contact.parts.at;
    /* Grains have the velocities of half a step ago. Those of a wall that turns have changed by its acceleration. */
    const double late = step > 0 ? 0.5 * update->dt * velocity[2] * velocity[2] : 0;
    narc_lammps::Motion then = motion;
    then.x += late * (atom->x[i][0] + t.end[0].x - pivot[0] - moved[0]);
    then.y += late * (atom->x[i][1] + t.end[0].y - pivot[1] - moved[1]);
    const narc_lammps::Contact at = {t.end[0],
                                     t.depth,
                                     t.part,
                                     t.leads,
                                     t.count == 2 ? &t : nullptr,
                                     contact.parts.x,
                                     contact.parts.y,
                                     {atom->v[i][0], atom->v[i][1], atom->omega[i][2]},
                                     then,
                                     atom->rmass[i],
                                     shapes->equal_radius(i)};
    const narc_lammps::Force on_grain = narc_lammps::compute_force(law, at, step, memories[contact.memory].springs);
    atom->f[i][0] += on_grain.x;
    atom->f[i][1] += on_grain.y;
    atom->torque[i][2] += on_grain.torque_a;
    mine[0] -= on_grain.x;
    mine[1] -= on_grain.y;
    mine[3] += on_grain.energy;
    const narc_lammps::ContactRow row =
        narc_lammps::make_row(on_grain, at.depth, static_cast<double>(atom->tag[i]), 0, atom->x[i]);
    mine[2] += (row.x - pivot[0] - moved[0]) * row.force_y - (row.y - pivot[1] - moved[1]) * row.force_x;
    if (keeps_rows)
        rows.push_back(row);
    if (evflag) {
        const double x = -on_grain.point_x, y = -on_grain.point_y; /* from the contact to the grain */
        double by_arm[6] = {x * on_grain.x, y * on_grain.y, 0, x * on_grain.y, 0, 0};
        v_tally(i, by_arm);
    }
}

void FixWallNarc::post_force(int virial_kind) {
    v_init(virial_kind);
    contacts.clear();
    rows.clear();
    if (plate) {
        motion = {velocity[0], velocity[1], 0};
        find_plate_contacts();
    } else {
        place_pieces();
        find_piece_contacts();
    }
    std::fill(mine, mine + 4, 0.0);
    summed = false;
    for (Contact &contact : contacts)
        contact.memory = find_memory(contact);
    join_contacts();
    std::fill(touched.begin(), touched.end(), 0);
    for (const Contact &contact : contacts)
        touched[contact.memory] = 1;
    for (size_t k = 0; k < static_cast<size_t>(atom->nlocal) * most_memories(); k++)
        if (!touched[k])
            memories[k] = {};
    const double step = update->setupflag ? 0 : update->dt;
    for (const Contact &contact : contacts)
        apply_contact(contact, step);
}

/* ---------------------------------------------------------------------------- output */

void FixWallNarc::sum_ranks() {
    if (!summed)
        MPI_Allreduce(mine, total, 4, MPI_DOUBLE, MPI_SUM, world);
    summed = true;
}

double FixWallNarc::compute_scalar() {
    sum_ranks();
    return total[3];
}

double FixWallNarc::compute_vector(int k) {
    if (k == 2 || k == 3 || k == 5)
        return moved[k == 5 ? 2 : k - 2];
    sum_ranks();
    return total[k == 4 ? 2 : k];
}

/* ---------------------------------------------------------------------------- memory that goes with the atoms */

void FixWallNarc::grow_arrays(int most) {
    memories.resize(static_cast<size_t>(most) * most_memories());
    touched.resize(memories.size(), 0);
}

void FixWallNarc::copy_arrays(int from, int to, int) {
    std::copy_n(memories_of(from), most_memories(), memories_of(to));
}

void FixWallNarc::set_arrays(int i) { std::fill_n(memories_of(i), most_memories(), Memory{}); }

int FixWallNarc::pack_exchange(int i, double *buffer) {
    std::memcpy(buffer, memories_of(i), static_cast<size_t>(maxexchange) * sizeof *buffer);
    return maxexchange;
}

int FixWallNarc::unpack_exchange(int i, double *buffer) {
    std::memcpy(memories_of(i), buffer, static_cast<size_t>(maxexchange) * sizeof *buffer);
    return maxexchange;
}

/* The velocity too: variables may be looked at some steps later. */
void FixWallNarc::write_restart(FILE *file) {
    if (comm->me == 0) {
        const double state[] = {moved[0], moved[1], moved[2], velocity[0], velocity[1], velocity[2]};
        const int size = sizeof state;
        fwrite(&size, sizeof size, 1, file);
        fwrite(state, sizeof state, 1, file);
    }
}

void FixWallNarc::restart(char *buffer) {
    double state[6];
    std::memcpy(state, buffer, sizeof state);
    for (int axis = 0; axis < 3; axis++) {
        moved[axis] = state[axis];
        if (!variables[axis].empty())
            velocity[axis] = state[3 + axis];
    }
}

int FixWallNarc::pack_restart(int i, double *buffer) {
    buffer[0] = size_restart(i);
    pack_exchange(i, buffer + 1);
    return size_restart(i);
}

void FixWallNarc::unpack_restart(int i, int nth) {
    double *extra = atom->extra[i];
    for (int k = 0; k < nth; k++)
        extra += static_cast<int>(*extra);
    unpack_exchange(i, extra + 1);
}
