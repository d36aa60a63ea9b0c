/* SPDX-License-Identifier: MIT
 *
 * dem.h - a small discrete element program in two dimensions: grains that are arc shapes, walls, contact laws.
 *
 * The mental model
 *
 *   A step goes from positions to forces and back. narc answers which grains touch, where and how deep; all else is
 *   here, a file for each part:
 *
 *       main.c        the command line, stages, progress, signals
 *       input.c       the JSON file; input_bodies.c: its shapes, walls and grains
 *       schema.c      what it may hold, by tables of keys, with messages
 *       model.c       memory, shapes, bodies
 *       place.c       where grains start
 *       neighbours.c  boxes, pairs with a skin, history
 *       boundary.c    periodic images, wrapping, shear
 *       step.c        velocity Verlet, the narrow phase
 *       laws.c        forces of contacts and bodies
 *       walls.c       motion of walls, servo control
 *       measures.c    energies, stress, counts
 *       csv.c         tables of measures, and of grains
 *       restart.c     the state in a file, bit for bit
 *       files.c       files that are read, or appear, as a whole
 *       vtk.c         files for ParaView
 *
 * Conventions
 *
 *   Grains are bodies 0 .. grain_count - 1, walls follow. All state is double. narc reads positions as doubles in place
 *   (it subtracts them before it rounds) and rotations as floats, which are rounded copies of the doubles here. So the
 *   narc tells what touches within NARC_ERROR_BOUND times a few sizes; depth, normal and point are then computed in
 *   double (touch.h).
 *
 *   A contact's normal points from A to B, and A < B. Its tangent is the normal turned by a quarter turn. In two
 *   dimensions the tangential spring is one number along the tangent, so it turns with the contact by itself.
 *
 *   Every sum is taken in an order that does not depend on threads, and no operation but + - * / sqrt touches the
 *   state: a run has the same bits on every instruction set and with any number of threads.
 */
#ifndef DEM_H
#define DEM_H

#include <narc.h>
#include <narc_broad_phase.h>

#include <stdio.h>

#include "touch.h"

#define DEM_PI 3.14159265358979323846
enum { DEM_MAX_MATERIALS = 16, DEM_NAME_SIZE = 64, DEM_PATH_SIZE = 1024 };

typedef struct dem_vec {
    double x, y;
} dem_vec;

/* ---------------------------------------------------------------------------------------- what it is made of */

typedef struct dem_material {
    char name[DEM_NAME_SIZE];
    double density;
    double young, poisson; /* of the Hertz law; else 0 */
} dem_material;

/* A convex outline, for touch.h: that of the store's shape with the same index. */
typedef struct dem_outline {
    touch_side *sides; /* `side_count` of them */
    size_t side_count;
} dem_outline;

/* What a body is: one convex outline, or several that move as one, which may lie over each other. The centroid of what
 * they cover is the origin; for scale 1 and density * thickness 1. */
typedef struct dem_shape {
    char name[DEM_NAME_SIZE];
    double area, second_moment;
    double reach;  /* the largest distance of a point from the origin */
    double extent; /* the diameter of the disc of equal area */
    uint32_t first_outline, outline_count;
} dem_shape;

typedef enum dem_law { DEM_LINEAR, DEM_HERTZ } dem_law;

/* What two materials do to each other; see laws.c for the formulae. */
typedef struct dem_contact_law {
    double kn, kt;           /* stiffness; of the Hertz law 4/3 E* and 8 G* */
    double gamma_n, gamma_t; /* damping per effective mass; not used where there is a damping ratio */
    double damping_ratio;    /* of a restitution: damping is this times sqrt(stiffness * effective mass); below 0: gamma
                                counts */
    double tangential_share; /* with a damping ratio: tangential damping, as a share of the normal one */
    double friction;
    double rolling_friction; /* 0: none. Torque at most this times Reff |Fn| */
} dem_contact_law;

typedef struct dem_settings {
    double time_step;
    double skin;      /* pairs are kept while nothing has moved half of it */
    double thickness; /* of the grains, across the plane */
    dem_vec gravity;
    dem_law law;
    double max_overlap; /* a deeper contact stops the run; a share of the smaller body's extent */
    bool periodic_x, periodic_y;
    double low_x, high_x, low_y, high_y; /* the periodic cell; where it is periodic */
    bool sheared;                        /* a Lees-Edwards cell: periodic in x and y, without walls and gravity */
    double shear;                        /* its rate: how vx grows with y */
    unsigned threads;                    /* 0: one */
} dem_settings;

/* Bodies: `count` of each array, grains first. */
typedef struct dem_bodies {
    size_t count, capacity;
    double *x, *y;                          /* of the centre of mass, the shape's origin */
    double *cosine, *sine;                  /* the rotation, a unit vector */
    double *vx, *vy, *spin;                 /* velocities */
    double *fx, *fy, *torque;               /* of contacts alone; gravity is added where velocities change */
    double *inverse_mass, *inverse_inertia; /* 0 for walls */
    double *mass, *inertia;
    double *list_x, *list_y, *list_cosine, *list_sine; /* where they were when the pairs were found */
    double *reach, *extent;                            /* of the scaled shape */
    double *disc;                                      /* its radius, of a disc; 0: it is none */
    float *scale;
    uint32_t *shape, *first_part;
    uint8_t *material, *still; /* still: a wall. Two of them form no pair */
    int32_t *cell_x, *cell_y;  /* how often it crossed the periodic border, for true displacements */
} dem_bodies;

/* The convex parts of all bodies, in their order: what narc is asked about, with the place of their body. Parts of one
 * body form no pair. A body of one outline has one, so without others part k is body k. */
typedef struct dem_parts {
    size_t count, capacity;
    uint32_t *body, *outline;
} dem_parts;

typedef enum dem_wall_kind { DEM_BOX, DEM_PLATE } dem_wall_kind;

/* Holds a wall's force along one axis at a target. */
typedef struct dem_servo {
    bool on;
    dem_vec direction;      /* unit; the wall moves along it */
    double force;           /* the target: what grains press against the direction with. Used if `between` is empty */
    double stress;          /* times the distance of the two walls of `between` times the thickness */
    int between[2];         /* walls, or -1 */
    double gain, max_speed; /* its speed is the gain times the force that is missing */
    double travel; /* the run ends if the wall moves further without touching a grain; 0: the world's diagonal */
} dem_servo;

/* A wall is body grain_count + its index. A box (any convex arc shape) is where it is; a plate is a half plane: its
 * body is a block that goes along with each grain it may touch (the pair's shift), so that it is precise at any
 * length. */
typedef struct dem_wall {
    char name[DEM_NAME_SIZE];
    dem_wall_kind kind;
    uint32_t shape; /* as it begins: dem_start() makes it a body */
    uint8_t material;
    double scale;
    dem_vec place;
    double angle;
    dem_vec normal;   /* a plate's, into the grains' half plane */
    dem_vec velocity; /* prescribed */
    double spin;      /* about the pivot, which moves with the velocity */
    dem_vec pivot;
    dem_servo servo;
    double work;     /* done on the grains since the start */
    double idle_way; /* how far servo control has moved it since it touched a grain */
} dem_wall;

/* The memory of a pair that touches. It counts only if `step` is the step before. */
typedef struct dem_memory {
    double slide;   /* of the tangential spring */
    double spring;  /* its force */
    double damping; /* the normal damping force */
    uint64_t step;
} dem_memory;

typedef struct dem_rolling {
    double angle, torque;
} dem_rolling;

/* Pairs of parts whose boxes, half the skin larger, overlap, in the order of (a, b). No pair stands there twice. */
typedef struct dem_pairs {
    size_t count, capacity;
    uint32_t *a, *b;          /* parts */
    float *shift_x, *shift_y; /* added to B's position */
    uint32_t *hints;          /* narc's */
    dem_memory *memory;
    dem_rolling *rolling; /* used only if there is rolling friction */
} dem_pairs;

/* The force of a contact on B, on A the opposite, and its torques. */
typedef struct dem_force {
    double x, y;
    double torque_a, torque_b;
} dem_force;

/* A contact as its law takes it. Two flat sides touch at two ends (see touch.h): the normal and the point are then
 * those of both together. */
typedef struct dem_contact {
    uint64_t pair;
    dem_vec normal; /* unit, from A to B */
    dem_vec point;  /* halfway between both surfaces, from the centre of A */
    double depth;
    dem_force force;
} dem_contact;

/* The contacts of the last step, in the order of the pairs. */
typedef struct dem_contacts {
    size_t count, capacity;
    dem_contact *rows;
    narc_contact *found; /* what may touch */
    size_t found_count;
} dem_contacts;

/* Energies, and what was dissipated since the start. kinetic + potential + elastic + damping + friction - walls stays
 * what it was. */
typedef struct dem_energies {
    double kinetic, potential;
    double elastic;           /* of normal, tangential and rolling springs */
    double damping, friction; /* dissipated; friction with what tangential springs hold when their contact opens */
    double walls;             /* work of moving walls on the grains */
} dem_energies;

typedef struct dem_measures {
    dem_energies energy;
    size_t contacts;     /* of grains with grains and walls */
    double coordination; /* contacts of a grain: with grains count twice, with walls once, over the grains */
    double stress_xx, stress_xy, stress_yx,
        stress_yy;  /* compression is positive; contacts whose point is in the region */
    double deepest; /* the largest overlap, as a share of the smaller body's extent */
    double fastest; /* the largest speed of a grain */
} dem_measures;

/* A region of the plane: that of stresses. */
typedef struct dem_region {
    bool given;
    double low_x, high_x, low_y, high_y;
} dem_region;

/* Contacts are worked on in blocks of this many. A block's sums do not depend on who makes them. */
enum { DEM_BLOCK = 256 };

/* What a block of contacts adds up to. */
typedef struct dem_sums {
    size_t count; /* of contacts */
    double normal_energy, tangential_energy, rolling_energy;
    double old_springs; /* what the springs of these contacts held in the last step */
    double damping, friction;
    size_t too_deep; /* the first pair that is, or SIZE_MAX */
} dem_sums;

/* A pair that narc does not find: across a periodic border, or with a plate. */
typedef struct dem_extra {
    uint32_t a, b;
    float shift_x, shift_y;
} dem_extra;

/* What a box is of: a part, or its image, which is some way from it. */
typedef struct dem_image {
    uint32_t part, group; /* the body + 1 */
    float x, y;
    uint8_t still;
} dem_image;

typedef struct dem_scratch {
    narc_box *boxes; /* parts, then images of parts */
    dem_image *images;
    size_t box_capacity, image_capacity, image_count;
    const uint32_t *found_a, *found_b; /* pairs of boxes; the broad phase owns them */
    size_t found_count;
    uint32_t *match;
    dem_extra *extra;
    size_t extra_count, extra_capacity;
    bool adds; /* a single thread adds forces to bodies as it finds them, several do when all are found */
    dem_sums *sums;
    size_t sums_capacity;
    narc_body *poses; /* of all parts, when narc was last asked */
    size_t pose_capacity;
} dem_scratch;

typedef struct dem {
    dem_settings settings;
    dem_material materials[DEM_MAX_MATERIALS];
    size_t material_count;
    dem_contact_law laws[DEM_MAX_MATERIALS][DEM_MAX_MATERIALS];

    narc_shapes *store;
    dem_outline *outlines; /* outline k is shape k of the store */
    size_t outline_count, outline_capacity;
    dem_shape *shapes;
    size_t shape_count, shape_capacity;

    dem_bodies bodies;
    dem_parts parts;
    size_t grain_count;
    dem_wall *walls;
    size_t wall_count, wall_capacity;
    double grain_reach, grain_extent; /* the largest */
    double safe_depth;                /* a contact that is not deeper is allowed for all grains */
    double diagonal;                  /* of the box around all grains and the places of walls, at the start */

    uint64_t step;
    double time; /* step * time_step, summed over stages with their own steps */
    uint64_t list_builds;
    dem_pairs pairs, last_pairs;
    dem_contacts contacts;

    /* Summed up since the start. */
    double damping, friction;
    double normal_energy, tangential_energy, rolling_energy; /* of the springs now */

    /* Of a sheared cell: how far the cell above is to the right of this one, and was when the pairs were found; what
     * that cell's contacts pull; and the work done so. */
    double offset, list_offset, pull, shear_work;

    narc_broad_phase *broad;
    dem_scratch *scratch; /* memory of the neighbour list and of sums */
    char error[512];      /* what went wrong, when a function here says that something did */
} dem;

/* Everything below that returns bool tells of an error by false, and says what in d->error. */

/* ------------------------------------------------------------------------------------------------ model.c */

extern const dem_settings dem_defaults;

/* An empty world. dem_destroy() frees what there is, after an error too. */
bool dem_create(dem *d, dem_settings settings);
void dem_destroy(dem *d);

/* Adds a shape, moved so that its centroid is its origin: of one outline; of `part_count`, whose arcs, counts[i] each,
 * stand one behind the other in common coordinates. */
bool dem_add_shape(dem *d, const char *name, const narc_arc *arcs, size_t count, uint32_t *out_shape);
bool dem_add_compound(dem *d, const char *name, const narc_arc *arcs, const size_t *counts, size_t part_count,
                      uint32_t *out_shape);

/* A grain as it is added. */
typedef struct dem_grain {
    uint32_t shape;
    uint8_t material;
    double x, y, angle, scale; /* the scale is rounded to float */
    double vx, vy, spin;
} dem_grain;

/* All grains, then dem_start(). A wall as it is added: {.name, .kind, .material, .place}, and of a box .shape, .scale
 * and .angle, of a plate .normal (of any length); its place is a point of its border. */
bool dem_add_grain(dem *d, dem_grain grain);
bool dem_add_wall(dem *d, dem_wall wall);

/* Checks the whole, makes room. To be called once, before the first step. */
bool dem_start(dem *d);

/* Report an error; return false. */
bool dem_fail(dem *d, const char *format, ...);
bool dem_fail_narc(dem *d, const char *what, const narc_error *error);
bool dem_find_broken_body(dem *d);

/* An array of `count` items; one with room for `needed`, which grows by halves. The items that there are stay. */
bool dem_resize(dem *d, void *array_pointer, size_t count, size_t size);
bool dem_reserve(dem *d, void *array_pointer, size_t *capacity, size_t needed, size_t size);
bool dem_grow_pairs(dem *d, dem_pairs *pairs, size_t needed);

/* The arrays of bodies, as bytes: for the restart and the hash. NULL behind the last. */
void *dem_body_column(const dem *d, size_t index, size_t *out_item_size);

/* All parts where they are now, for narc, until the next call. */
bool dem_make_poses(dem *d, narc_bodies *out);

/* The box around all grains: squares as large as they reach. */
dem_region dem_bound_grains(const dem *d);

unsigned dem_team(const dem *d); /* threads */
narc_workers dem_workers(const dem *d);
double dem_cell_width(const dem *d);
double dem_cell_height(const dem *d);

/* The bodies of a pair. */
static inline size_t dem_body_a(const dem *d, size_t pair) { return d->parts.body[d->pairs.a[pair]]; }
static inline size_t dem_body_b(const dem *d, size_t pair) { return d->parts.body[d->pairs.b[pair]]; }

/* By how many cells the B of a pair is above A: its image. */
static inline int dem_find_lift(const dem *d, size_t pair) {
    return (d->pairs.shift_y[pair] > 0) - (d->pairs.shift_y[pair] < 0);
}

/* A rotation is a unit vector, and turns within a step by 2 atan(angle / 2), which is the angle to the third order and
 * needs no sine. What rounding takes from its length is given back each time. */
static inline dem_vec dem_find_turn(double angle) {
    const double half = 0.5 * angle, share = 1 / (1 + half * half);
    return (dem_vec){(1 - half * half) * share, 2 * half * share};
}

static inline void dem_turn(double *cosine, double *sine, dem_vec by) {
    const double c = *cosine * by.x - *sine * by.y, s = *sine * by.x + *cosine * by.y;
    const double unit = 1.5 - 0.5 * (c * c + s * s);
    *cosine = c * unit;
    *sine = s * unit;
}

/* ------------------------------------------------------------------------------------------------ place.c */

enum { DEM_MAX_CHOICES = 64 };

/* A size is the diameter of the disc of equal area. */
typedef enum dem_distribution { DEM_FIXED, DEM_UNIFORM, DEM_NORMAL, DEM_LOGNORMAL } dem_distribution;

typedef struct dem_sizes {
    dem_distribution kind;
    double mean, deviation; /* of the lognormal distribution: the median, and the deviation of the logarithm */
    double low, high;       /* sizes outside are drawn again */
} dem_sizes;

typedef struct dem_filling {
    uint64_t count; /* of a lattice: at most, 0: as many as it has places */
    dem_region region;
    uint32_t shapes[DEM_MAX_CHOICES]; /* one of them, all alike in chance */
    size_t shape_count;
    uint8_t material;
    dem_sizes sizes;
    double gap;      /* grains start at least this far apart, and from walls */
    double speed;    /* each component of the velocity is drawn up to this */
    double spin;     /* as well */
    dem_vec spacing; /* of a lattice */
    double jitter;   /* of a lattice: up to this share of half the spacing, in both directions */
    bool upright;    /* angle 0, else a random one */
    uint64_t tries;  /* for one grain, before a random filling gives up */
} dem_filling;

/* `random` is the state of a generator. Walls must have been added before. */
double dem_draw_size(const dem_sizes *sizes, uint64_t *random);
bool dem_fill_randomly(dem *d, const dem_filling *filling, uint64_t *random);
bool dem_fill_lattice(dem *d, const dem_filling *filling, uint64_t *random);

/* ------------------------------------------------------------------------------------------------ neighbours.c */

bool dem_renew_lists(dem *d);
bool dem_make_room_for_boxes(dem *d, size_t count);

/* ------------------------------------------------------------------------------------------------ boundary.c */

/* Another rate of shear, from now on: all grains get the velocities that go with it. */
void dem_set_shear(dem *d, double rate);

void dem_wrap_bodies(dem *d);
bool dem_add_images(dem *d);
bool dem_take_image_pairs(dem *d);                 /* adds the found pairs with images to the extra ones */
void dem_shear_cell(dem *d);                       /* the way of a step */
void dem_count_shear_work(dem *d);                 /* of half a step, with the forces as they are */
dem_vec dem_find_shift(const dem *d, size_t pair); /* of B, exactly */
double dem_find_drift(const dem *d);               /* the speed of the cell above */

/* ------------------------------------------------------------------------------------------------ step.c */

bool dem_step(dem *d);
bool dem_find_first_forces(dem *d);      /* of where bodies begin */
bool dem_make_room_for_contacts(dem *d); /* as many as there is room for pairs */

/* ------------------------------------------------------------------------------------------------ laws.c */

/* The damping ratio that gives a restitution, above 0 and at most 1. */
double dem_damping_ratio(dem_law law, double restitution);

/* The law between two materials, in both orders. With the Hertz law kn and kt come from the materials. */
void dem_set_law(dem *d, uint8_t a, uint8_t b, dem_contact_law law);

/* What the shortest contact lasts that there can be: pi sqrt(m / K) of the lightest grains of each material, with the
 * Hertz law at the deepest overlap that is allowed. Infinite without grains. */
double dem_find_shortest_contact(const dem *d);

bool dem_apply_laws(dem *d);

/* ------------------------------------------------------------------------------------------------ walls.c */

bool dem_steer_walls(dem *d);
void dem_move_walls(dem *d);
void dem_count_wall_work(dem *d); /* of half a step, with the forces as they are */
bool dem_add_plate_pairs(dem *d);

/* The force of the grains on a wall. */
dem_vec dem_wall_force(const dem *d, size_t wall);

/* How far the face of a plate is from its body's place: half the side of its block. */
double dem_half_block(const dem *d, const dem_wall *plate);

/* ------------------------------------------------------------------------------------------------ measures.c */

/* Stresses of a region, or NULL for all. */
void dem_measure(const dem *d, const dem_region *region, dem_measures *out_measures);

/* A body's contacts of the last step. Its stress is the sum of force times arm over its contacts, by its volume:
 * compression is positive. Walls have contacts, and no stress.
 *
 * Grains with too few contacts to be held are rattlers, and so are those that are held by them: a grain is held by two
 * contacts that press, or, where no pair of materials has friction, three. */
typedef struct dem_load {
    uint32_t contacts;
    uint32_t bearing; /* contacts that press, with walls and grains that are no rattlers; of a rattler 0 */
    uint32_t count;   /* while they are counted */
    double stress_xx, stress_xy, stress_yx, stress_yy;
} dem_load;

/* Of all bodies, in memory that the caller frees; NULL, with an error, if there is none left. */
dem_load *dem_find_loads(dem *d);

/* How hard the bodies of a contact press each other. */
double dem_normal_force(const dem_contact *contact);

/* FNV-1a, 64 bits, continued; and over the whole state. */
#define DEM_HASH_START 0xcbf29ce484222325u
uint64_t dem_hash_bytes(uint64_t hash, const void *bytes, size_t size);
uint64_t dem_hash(const dem *d);

/* ------------------------------------------------------------------------------------------------ files.c */

/* All bytes of a file, and a NUL behind them: memory that the caller frees. NULL, with an error. */
char *dem_read_file(const char *path, size_t *out_size, char *error);

/* A file that is written under a temporary name and gets its own when it is closed. */
typedef struct dem_file {
    FILE *file;
    const char *path; /* as it was given: must last as long */
    char *target;
    char *temporary;
} dem_file;

/* Errors, with the system's reason, go to `error` (512 bytes). dem_close_file() with ok = false removes what was
 * written. */
bool dem_open_file(dem_file *out, const char *path, char *error);
bool dem_close_file(dem_file *out, bool ok, char *error);

/* ------------------------------------------------------------------------------------------------ vtk.c, csv.c */

/* Writes the state for ParaView: frame 12 of "out/pile" is out/pile-000012.vtk and out/pile-contacts-000012.vtk. */
bool dem_write_vtk(dem *d, const char *stem, uint64_t frame);

/* The table of measures, a line for each time, which grows while the run goes on. A new one; or, if the position is
 * above 0 and the file is there, an old one, cut off there: if it is one of this input, and the line that ends there is
 * not of a later step than the world's. Sets the position to its end. */
FILE *dem_open_csv(dem *d, const char *path, uint64_t *position);

/* Adds a line; false if it cannot be written. */
bool dem_write_csv(FILE *csv, const dem *d, const dem_measures *m);

/* A line of CSV for each grain. */
bool dem_write_grains(dem *d, const char *path);

/* ------------------------------------------------------------------------------------------------ restart.c */

/* What a run is beside the state: kept in a restart file, so that it goes on where it was. */
typedef struct dem_place {
    uint64_t input;        /* hash of what the input says of bodies, laws and boundaries */
    uint64_t stage;        /* index */
    uint64_t stage_step;   /* steps done in it */
    uint64_t csv_position; /* bytes */
    uint64_t frame;        /* number of the next VTK file or picture */
    uint64_t random;       /* the generator's state */
} dem_place;

bool dem_write_restart(dem *d, const dem_place *place, const char *path);

/* Into a world with the same input, after dem_start(). */
bool dem_read_restart(dem *d, dem_place *place, const char *path);

#endif
