/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * pair_narc.cpp - from the neighbour list to one batch of the library, and from its contacts to forces.
 */
#include "pair_narc.h"

#include <algorithm>
#include <cstring>

#include <narc.h>

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"

using namespace LAMMPS_NS;

PairNarc::PairNarc(LAMMPS *lammps, bool hertz, bool rescaled) : Pair(lammps) {
    law.hertz = hertz;
    law.rescaled = rescaled;
    single_enable = 0;
    no_virial_fdotr_compute = 1; /* forces do not act along the line of the centres */
    centroidstressflag = CENTROID_NOTAVAIL;
    finitecutflag = 1;
}

PairNarc::~PairNarc() {
    if (shapes && !copymode)
        for (int i = 0; modify && i < modify->nfix; i++)
            if (modify->fix[i] == shapes)
                shapes->pair = nullptr;
    if (allocated) {
        memory->destroy(setflag);
        memory->destroy(cutsq);
    }
}

/* ---------------------------------------------------------------------------- commands */

void PairNarc::allocate() {
    allocated = 1;
    const int n = atom->ntypes + 1;
    memory->create(setflag, n, n, "pair:setflag");
    memory->create(cutsq, n, n, "pair:cutsq");
    for (int i = 0; i < n; i++)
        std::fill_n(setflag[i], n, 0);
    laws.assign(static_cast<size_t>(n) * static_cast<size_t>(n), law);
}

narc_lammps::ContactLaw PairNarc::read_law(int count, char **arguments) {
    narc_lammps::ContactLaw read;
    const auto number = [this](const char *text) { return utils::numeric(FLERR, text, false, lmp); };
    if (narc_lammps::read_law(read, law.hertz, law.rescaled, force->nktv2p, count, arguments, number) != count)
        error->all(FLERR,
                   std::string("pair_style narc: kn kt gamma_n gamma_t xmu dampflag [limit_damping] [rolling MU] "
                               "[restitution E] [cohesion F RANGE] are wanted, none of them negative or out of range"));
    return read;
}

void PairNarc::settings(int count, char **arguments) {
    law = read_law(count, arguments);
    std::fill(laws.begin(), laws.end(), law);
}

void PairNarc::coeff(int count, char **arguments) {
    if (count < 2)
        error->all(FLERR, std::string("pair_coeff of narc: two types are wanted"));
    if (!allocated)
        allocate();
    const narc_lammps::ContactLaw of_types = count > 2 ? read_law(count - 2, arguments + 2) : law;
    const int n = atom->ntypes + 1;
    int i_low, i_high, j_low, j_high, set = 0;
    utils::bounds(FLERR, arguments[0], 1, atom->ntypes, i_low, i_high, error);
    utils::bounds(FLERR, arguments[1], 1, atom->ntypes, j_low, j_high, error);
    for (int i = i_low; i <= i_high; i++)
        for (int j = std::max(j_low, i); j <= j_high; j++, set++) {
            setflag[i][j] = 1;
            laws[static_cast<size_t>(i * n + j)] = laws[static_cast<size_t>(j * n + i)] = of_types;
        }
    if (!set)
        error->all(FLERR, std::string("pair_coeff of narc: no pair of types is named"));
}

void PairNarc::init_style() {
    if (domain->dimension != 2)
        error->all(FLERR, std::string("pair_style narc wants dimension 2"));
    if (!atom->tag_enable)
        error->all(FLERR, std::string("pair_style narc wants atom IDs"));
    if (!comm->ghost_velocity)
        error->all(FLERR, std::string("pair_style narc wants comm_modify vel yes"));
    shapes = FixNarcShapes::find(lmp, "pair_style narc");
    shapes->pair = this;
    frozen = 0;
    for (int i = 0; i < modify->nfix; i++)
        if (!std::strcmp(modify->fix[i]->style, "freeze"))
            frozen = modify->fix[i]->groupbit;

    find_radii();
    range = find_range();
    Pair::init_style();
}

/* The largest of each type: of grains that there are, and of those that fix pour or deposit will make. */
void PairNarc::find_radii() {
    std::vector<double> mine(static_cast<size_t>(atom->ntypes) + 1, 0);
    for (int i = 0; i < atom->nlocal; i++) {
        double &most = mine[static_cast<size_t>(atom->type[i])];
        most = std::max(most, atom->radius[i]);
    }
    for (int i = 0; i < modify->nfix; i++)
        for (int type = 1; type <= atom->ntypes; type++) {
            Fix *fix = modify->fix[i];
            int asked = type;
            if (std::strncmp(fix->style, "pour", 4) != 0 && std::strncmp(fix->style, "deposit", 7) != 0)
                continue;
            if (const auto *radius = static_cast<const double *>(fix->extract("radius", asked)))
                mine[static_cast<size_t>(type)] = std::max(mine[static_cast<size_t>(type)], *radius);
        }
    type_radius.resize(mine.size());
    MPI_Allreduce(mine.data(), type_radius.data(), static_cast<int>(mine.size()), MPI_DOUBLE, MPI_MAX, world);
}

/* Neighbours are looked for by these radii, and as far as half a periodic box: what does not fit would go through. */
void PairNarc::check_atoms() const {
    for (int i = 0; i < atom->nlocal; i++)
        if (atom->radius[i] > type_radius[static_cast<size_t>(atom->type[i])])
            error->one(FLERR, "pair_style narc: atom " + std::to_string(atom->tag[i]) + " has radius " +
                                  std::to_string(atom->radius[i]) + ", more than any of its type when the run began");
    for (int axis = 0; axis < 2; axis++)
        if (domain->periodicity[axis] && domain->prd[axis] < 2 * neighbor->cutneighmax)
            error->one(FLERR, std::string("pair_style narc: the box is periodic in ") + "xy"[axis] + ", and " +
                                  std::to_string(domain->prd[axis]) + " wide: less than twice the neighbour cutoff, " +
                                  std::to_string(neighbor->cutneighmax));
}

double PairNarc::init_one(int i, int j) {
    if (!allocated)
        allocate();
    return type_radius[static_cast<size_t>(i)] + type_radius[static_cast<size_t>(j)] + find_range();
}

double PairNarc::find_range() const {
    double most = 0;
    for (const narc_lammps::ContactLaw &of_types : laws)
        most = std::max(most, of_types.range);
    return most;
}

/* ---------------------------------------------------------------------------- the list of pairs */

bool PairNarc::remembers_for_ghosts() const { return force->newton_pair; }

/* LAMMPS' list goes by the largest radius of each type; of its pairs those are kept whose own radii reach. */
void PairNarc::add_pairs(bool of_discs) {
    for (int n = 0; n < list->inum; n++) {
        const int i = list->ilist[n];
        const double *x = atom->x[i];
        for (int m = 0; m < list->numneigh[i]; m++) {
            const int j = list->firstneigh[i][m] & NEIGHMASK;
            if ((shapes->form(i).is_disc && shapes->form(j).is_disc) != of_discs)
                continue;
            const double reach = atom->radius[i] + atom->radius[j] + range + neighbor->skin;
            const double dx = atom->x[j][0] - x[0], dy = atom->x[j][1] - x[1];
            if (dx * dx + dy * dy >= reach * reach)
                continue;
            const bool ordered = atom->tag[i] < atom->tag[j] || (atom->tag[i] == atom->tag[j] && i < j);
            const int a = ordered ? i : j, b = ordered ? j : i;
            for (uint32_t p = 0; p < shapes->form(a).parts.size(); p++)
                for (uint32_t q = 0; q < shapes->form(b).parts.size(); q++) {
                    first.push_back(shapes->first_row[static_cast<size_t>(a)] + p);
                    second.push_back(shapes->first_row[static_cast<size_t>(b)] + q);
                }
        }
    }
}

void PairNarc::build_pairs() {
    check_atoms();
    shapes->number_rows();
    first.clear();
    second.clear();
    touching.clear();
    add_pairs(true);
    disc_pairs = first.size();
    add_pairs(false);
    springs.assign(first.size(), {0, 0, 0, 0});
    contacts.resize(first.size() - disc_pairs);
    const size_t local = static_cast<size_t>(atom->nlocal);
    for (size_t k = 0; k < first.size(); k++) {
        const uint32_t a = shapes->row_atom[first[k]], b = shapes->row_atom[second[k]];
        const tagint other = atom->tag[a < local ? b : a];
        for (const auto &kept : shapes->memories[a < local ? a : b]) {
            if (kept.other != other || kept.parts[0] != shapes->row_part(first[k]) ||
                kept.parts[1] != shapes->row_part(second[k]))
                continue;
            springs[k] = kept.springs;
            touching.push_back(static_cast<uint32_t>(k));
        }
    }
    valid = true;
}

void PairNarc::save_memories(std::vector<std::vector<FixNarcShapes::Memory>> &memories) const {
    const size_t local = static_cast<size_t>(atom->nlocal);
    const bool ghosts = remembers_for_ghosts();
    for (const uint32_t k : touching) {
        const uint32_t a = shapes->row_atom[first[k]], b = shapes->row_atom[second[k]];
        FixNarcShapes::Memory kept = {
            atom->tag[b],
            {static_cast<uint32_t>(shapes->row_part(first[k])), static_cast<uint32_t>(shapes->row_part(second[k]))},
            springs[k]};
        if (ghosts || a < local)
            memories[a].push_back(kept);
        kept.other = atom->tag[a];
        if (ghosts || b < local)
            memories[b].push_back(kept);
    }
}

/* ---------------------------------------------------------------------------- forces */

/* Of all pairs that are not two discs. */
void PairNarc::find_contacts() {
    found_count = 0;
    if (contacts.empty())
        return;
    const narc_bodies bodies = shapes->bodies();
    narc_pairs pairs = {};
    pairs.count = contacts.size();
    pairs.a = {&first[disc_pairs], sizeof first[0]};
    pairs.b = {&second[disc_pairs], sizeof second[0]};
    narc_workers workers;
    narc_openmp_workers(static_cast<unsigned>(comm->nthreads), &workers);
    size_t skipped = 0;
    narc_query query = {}; /* what touches by rounding is looked at again, in double precision */
    query.margin =
        static_cast<float>(range + 4 * NARC_ERROR_BOUND * *std::max_element(type_radius.begin(), type_radius.end()));
    query.workers = &workers;
    query.out_skipped = &skipped;
    narc_error failure = {};
    narc_status status = narc_find_contacts(shapes->store, &bodies, &pairs, &query, contacts.data(), contacts.size(),
                                            &found_count, &failure);
    if (status == NARC_OK && skipped > 0) /* a number that is none, or so */
        status = narc_validate_bodies(shapes->store, &bodies, &failure);
    if (status != NARC_OK)
        error->one(FLERR, std::string("pair_style narc: ") + failure.message);
}

/* Inline, so that a contact of discs stays in registers. */
[[gnu::always_inline]] inline void PairNarc::apply_contact(uint32_t pair, int a, int b, narc_lammps::Contact contact,
                                                           double step) {
    const narc_lammps::ContactLaw &by = laws[static_cast<size_t>(atom->type[a] * (atom->ntypes + 1) + atom->type[b])];
    if (!(contact.depth > -by.range))
        return;
    touching.push_back(pair);
    const double *x_a = atom->x[a], *v_a = atom->v[a], *v_b = atom->v[b];
    contact.a = {v_a[0], v_a[1], atom->omega[a][2]};
    contact.b = {v_b[0], v_b[1], atom->omega[b][2]};
    const double mass_a = atom->rmass[a], mass_b = atom->rmass[b];
    contact.mass = mass_a * mass_b / (mass_a + mass_b);
    if ((atom->mask[a] | atom->mask[b]) & frozen)
        contact.mass = atom->mask[b] & frozen ? mass_a : mass_b;
    contact.radius = 0;
    if (by.hertz || by.rolling > 0) {
        const double radius_a = shapes->equal_radius(a), radius_b = shapes->equal_radius(b);
        contact.radius = radius_a * radius_b / (radius_a + radius_b);
    }
    const narc_lammps::Force on_a = narc_lammps::compute_force(by, contact, step, springs[pair]);
    if (force->newton_pair || a < atom->nlocal) {
        atom->f[a][0] += on_a.x;
        atom->f[a][1] += on_a.y;
        atom->torque[a][2] += on_a.torque_a;
    }
    if (force->newton_pair || b < atom->nlocal) {
        atom->f[b][0] -= on_a.x;
        atom->f[b][1] -= on_a.y;
        atom->torque[b][2] += on_a.torque_b;
    }
    if (keeps_rows && (force->newton_pair || a < atom->nlocal))
        rows.push_back(narc_lammps::make_row(on_a, contact.depth, static_cast<double>(atom->tag[a]),
                                             static_cast<double>(atom->tag[b]), x_a));
    if (evflag)
        ev_tally_xyz(a, b, atom->nlocal, force->newton_pair, on_a.energy, 0.0, on_a.x, on_a.y, 0.0, -contact.way_x,
                     -contact.way_y, 0.0);
}

void PairNarc::apply_discs(double step) {
    for (uint32_t pair = 0; pair < disc_pairs; pair++) {
        const int a = static_cast<int>(shapes->row_atom[first[pair]]),
                  b = static_cast<int>(shapes->row_atom[second[pair]]);
        const double x = atom->x[b][0] - atom->x[a][0], y = atom->x[b][1] - atom->x[a][1];
        const double radius_a = atom->radius[a], radius_b = atom->radius[b], reach = radius_a + radius_b + range;
        if (x * x + y * y >= reach * reach)
            continue;
        const touch_end end = meet_discs(radius_a, radius_b, x, y);
        if (!std::isfinite(end.depth))
            error->one(FLERR, "pair_style narc: atoms " + std::to_string(atom->tag[a]) + " and " +
                                  std::to_string(atom->tag[b]) + ": the place of one is no number");
        apply_contact(pair, a, b, {end, end.depth, 1, true, nullptr, x, y, {}, {}, 0, 0}, step);
    }
}

/* What the library has found may be apart after all. The contacts of two grains follow each other: those of one surface are
 * one, and if what bears its load changes the spring goes along. */
void PairNarc::apply_others(double step) {
    const uint32_t *row_a = first.data() + disc_pairs, *row_b = second.data() + disc_pairs;
    const uint32_t *row_atom = shapes->row_atom.data();
    const touch_grain *outlines = shapes->row_outline.data();
    for (size_t k = 0, next; k < found_count; k = next) {
        const uint32_t pair = contacts[k].pair, p = row_a[pair], q = row_b[pair], a = row_atom[p], b = row_atom[q];
        const int i = static_cast<int>(a), j = static_cast<int>(b);
        const double x = atom->x[b][0] - atom->x[a][0], y = atom->x[b][1] - atom->x[a][1];
        for (next = k + 1; next < found_count; next++)
            if (row_atom[row_a[contacts[next].pair]] != a || row_atom[row_b[contacts[next].pair]] != b)
                break;
        touch_end end;
        if (next == k + 1 && find_point(&outlines[p], &outlines[q], x, y, contacts[k].feature, &end)) {
            apply_contact(static_cast<uint32_t>(disc_pairs) + pair, i, j,
                          {end, end.depth, 1, true, nullptr, x, y, {}, {}, 0, 0}, step);
            continue;
        }
        parts.clear();
        for (size_t m = k; m < next; m++) {
            const uint32_t r = row_a[contacts[m].pair], s = row_b[contacts[m].pair];
            parts.push_back({outlines[r], outlines[s], x, y, r, s, {}});
            touch_parts &now = parts.back();
            find_touch(&now.a, &now.b, x, y, contacts[m].feature, &now.at);
            if (!(now.at.depth > -range))
                now.at.count = 0;
        }
        narc_lammps::Springs *of_pairs = &springs[disc_pairs];
        if (parts.size() > 1)
            narc_lammps::join_contacts(parts, [&](size_t m) { return &of_pairs[contacts[k + m].pair]; });
        for (size_t m = 0; m < parts.size(); m++) {
            const touch &at = parts[m].at;
            if (at.count > 0)
                apply_contact(
                    static_cast<uint32_t>(disc_pairs) + contacts[k + m].pair, i, j,
                    {at.end[0], at.depth, at.part, at.leads, at.count == 2 ? &at : nullptr, x, y, {}, {}, 0, 0}, step);
        }
    }
}

void PairNarc::compute(int energy, int virial_kind) {
    ev_init(energy, virial_kind);
    if (!valid)
        build_pairs();
    find_contacts();

    /* Both lists rise. What touched and does so no more begins anew. */
    before.swap(touching);
    touching.clear();
    rows.clear();
    const double step = update->setupflag ? 0 : update->dt;
    apply_discs(step);
    apply_others(step);
    size_t next = 0;
    for (const uint32_t pair : before) {
        while (next < touching.size() && touching[next] < pair)
            next++;
        if (next == touching.size() || touching[next] != pair)
            springs[pair] = {0, 0, 0, 0};
    }
}

/* ---------------------------------------------------------------------------- restart */

void PairNarc::write_restart(FILE *file) {
    write_restart_settings(file);
    for (int i = 1; i <= atom->ntypes; i++)
        for (int j = 1; j <= atom->ntypes; j++)
            fwrite(&setflag[i][j], sizeof(int), 1, file);
    fwrite(laws.data(), sizeof law, laws.size(), file);
}

void PairNarc::read_restart(FILE *file) {
    read_restart_settings(file);
    allocate();
    for (int i = 1; i <= atom->ntypes; i++) {
        for (int j = 1; j <= atom->ntypes; j++) {
            if (comm->me == 0)
                utils::sfread(FLERR, &setflag[i][j], sizeof(int), 1, file, nullptr, error);
            MPI_Bcast(&setflag[i][j], 1, MPI_INT, 0, world);
        }
    }
    if (comm->me == 0)
        utils::sfread(FLERR, laws.data(), sizeof law, laws.size(), file, nullptr, error);
    MPI_Bcast(laws.data(), static_cast<int>(laws.size() * sizeof law), MPI_BYTE, 0, world);
}

void PairNarc::write_restart_settings(FILE *file) { fwrite(&law, sizeof law, 1, file); }

void PairNarc::read_restart_settings(FILE *file) {
    if (comm->me == 0)
        utils::sfread(FLERR, &law, sizeof law, 1, file, nullptr, error);
    MPI_Bcast(&law, sizeof law, MPI_BYTE, 0, world);
}

double PairNarc::memory_usage() {
    return Pair::memory_usage() +
           static_cast<double>(first.capacity() * (3 * sizeof(uint32_t) + sizeof(narc_lammps::Springs)) +
                               (touching.capacity() + before.capacity()) * sizeof(uint32_t) +
                               contacts.capacity() * sizeof(narc_contact));
}
