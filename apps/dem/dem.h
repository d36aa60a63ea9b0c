/* SPDX-License-Identifier: MIT
 *
 * dem.h - a small discrete element program in two dimensions: grains that are arc shapes, walls, contact laws.
 *
 * The mental model
 *
 *   A step goes from positions to forces and back. narc answers which grains touch, where and how deep; all else is
 *   here, a file for each part:
 *
 *       memory.c      errors, arrays that grow
 *       files.c       files that are read, or appear, as a whole
 *       shapes.c      outlines, shapes
 *       bodies.c      grains and walls, and as narc sees them
 *       boundary.c    wrapping, shear
 *       filling.c     where grains start
 *       neighbours.c  images, pairs that may touch, history
 *       walls.c       motion of walls, servo control
 *       laws.c        forces of contacts and bodies
 *       step.c        velocity Verlet
 *       world.c       a world's beginning and end
 *       measures.c    energies, stress, counts
 *       tables.c      tables of measures, and of grains; vtk.c: files for ParaView
 *       restart.c     the state in a file, bit for bit
 *       schema.c      tables of keys of JSON
 *       input_bodies.c  the input's shapes, walls and grains; input.c: all else
 *       main.c        the command line, stages, progress, signals
 *
 *   A file calls those above it, and none below.
 *
 * Conventions
 *
 *   Grains are bodies 0 .. grain_count - 1, walls follow. All state is double. narc reads positions as doubles (it
 *   subtracts them before it rounds) and rotations as floats, which are rounded copies of the doubles here. So narc
 *   tells what touches within NARC_ERROR_BOUND times a few sizes; depth, normal and point are then computed in double
 *   (touch.h).
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
#include <narc_contacts.h>

#include <stdio.h>

#include "touch.h"
#include "vec.h"

#define DEM_PI 3.14159265358979323846
enum { DEM_MAX_MATERIALS = 16, DEM_MAX_GROUPS = 64, DEM_NAME_SIZE = 64, DEM_PATH_SIZE = 1024 };

/* ---------------------------------------------------------------------------------------- what it is made of */

typedef struct dem_material {
    char name[DEM_NAME_SIZE];
    double density;
    double young, poisson; /* of the Hertz law; else 0 */
} dem_material;

/* A convex outline, or a piece of a chain, for touch.h; and as narc has it, with its origin at a place of its own. */
typedef struct dem_outline {
    touch_side sides[NARC_MAX_ARCS];
    size_t side_count;
    uint32_t stored; /* index in the store */
    vec at;          /* 0, 0 unless it is of a chain */
} dem_outline;

/* What a body is: one convex outline, or several that move as one, which may lie over each other. The centroid of what
 * they cover is the origin; for scale 1 and density * thickness 1. */
typedef struct dem_shape {
    char name[DEM_NAME_SIZE];
    double area, second_moment;
    double reach;  /* the largest distance of a point from the origin */
    double extent; /* the diameter of the disc of equal area */
    uint32_t first_outline, outline_count;
    bool is_chain; /* of a wall: ground, with neither area nor mass */
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
    double cohesion, range;  /* a force, and the distance beyond which it is 0 */
} dem_contact_law;

/* A part of the plane. */
typedef struct dem_region {
    bool given;
    vec low, high;
} dem_region;

/* How a periodic cell is deformed: how vx grows with y, vx with x, vy with y. */
typedef struct dem_rates {
    double shear, x, y;
} dem_rates;

/* The rate of a cell's width or height, if it shall hold a stress: the gain times what the stress is too large. */
typedef struct dem_side {
    int on;
    double stress, gain, max_rate;
} dem_side;

typedef struct dem_settings {
    double time_step;
    double skin;      /* images and pairs are kept while nothing has moved half of it */
    double thickness; /* of the grains, across the plane */
    vec gravity;
    dem_law law;
    double max_overlap; /* a deeper contact stops the run; a share of the smaller body's extent */
    bool periodic_x, periodic_y;
    vec low, high;    /* the periodic cell; where it is periodic */
    double drag;      /* of what grains move in, which is at rest: drag times mass times velocity, and of spin alike */
    bool sheared;     /* a Lees-Edwards cell: periodic in x and y, without walls and gravity */
    bool strained;    /* a cell whose sides move: alike */
    dem_rates rates;  /* of both */
    unsigned threads; /* 0: one */
} dem_settings;

/* What a step needs comes first: memory comes in lines. */
typedef struct dem_body {
    vec position; /* of the centre of mass, the shape's origin */
    vec turn;     /* the rotation, a unit vector */
    vec velocity;
    double spin;
    vec force; /* of contacts alone; gravity is added where velocities change */
    double torque;
    vec ahead; /* the velocity at the end of a step, as far as the forces at its beginning tell */
    double spin_ahead;
    double inverse_mass, inverse_inertia; /* 0 for walls */
    double extent, disc;                  /* of the scaled shape; the radius of a disc, 0: it is none */
    float scale;
    int joins; /* its contacts may be of one surface with others */
    uint32_t shape, material, first_part;
    int32_t cell_x, cell_y;       /* how often it crossed the periodic border, for true displacements */
    double reach;                 /* of the scaled shape */
    vec last_position, last_turn; /* where it was when the images were made */
    double mass, inertia;
} dem_body;

/* The convex parts of all bodies, in their order: what narc is asked about, with the position of their body. Parts of one
 * body form no pair. A body of one outline has one, so without others part k is body k. */
typedef struct dem_part {
    uint32_t body, outline;
} dem_part;

typedef enum dem_wall_kind { DEM_BOX, DEM_PLATE } dem_wall_kind;

/* Holds a wall's force along one axis at a target. */
typedef struct dem_servo {
    int on;                 /* from a restart file it may have any bits */
    vec direction;          /* unit; the wall moves along it */
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
    uint32_t group;           /* of walls that move as one: 1 + its index, or 0 */
    uint32_t shape, material; /* as it begins: dem_start() makes it a body */
    double scale;
    vec position;
    double angle;
    vec normal;   /* a plate's, into the grains' half plane */
    double half;  /* of the side of its block: how far its face is from its body's place */
    vec velocity; /* prescribed; of a wall with servo control across its direction */
    double speed; /* along it */
    double spin;  /* about the pivot, which moves with the velocity */
    vec pivot;
    dem_servo servo;
    double work;     /* done on the grains since the start */
    double idle_way; /* how far servo control has moved it since it touched a grain */
} dem_wall;

/* What narc is asked about: all parts where they are, each with its images behind it: a cell's width away, and blocks of
 * plates under a grain. An image meets only who is no image. */
typedef struct dem_image {
    uint64_t id; /* as narc knows it: the part; of an image also its direction, or the grain's part */
    uint32_t part;
    uint32_t only;     /* the part that it may meet alone, or UINT32_MAX */
    uint32_t owner;    /* two of the same form no pair: the body; of walls and images the number of grains */
    int16_t right, up; /* by how many cells */
    vec shift;         /* from the part */
} dem_image;

/* Two parts that may touch. */
typedef struct dem_pair {
    uint32_t a, b;  /* parts, a < b */
    uint32_t image; /* where B is */
    uint32_t slot;  /* narc's */
} dem_pair;

/* The memory of a pair that touches, in its slot. It counts only if `step` is the step before. */
typedef struct dem_memory {
    double slide;                /* of the tangential spring */
    double spring;               /* its force */
    double damping, power;       /* of the normal dashpot: its force, and that times the speed */
    double early;                /* how much more than once that force counted, for the contact was to end */
    double roll, rolling_spring; /* used only if there is rolling friction */
    uint64_t step;
} dem_memory;

/* The force of a contact on B, on A the opposite, and its torques. */
typedef struct dem_force {
    vec force;
    double torque_a, torque_b;
} dem_force;

/* A contact as its law takes it. Two flat sides touch at two ends (see touch.h): the normal and the point are then
 * those of both together. */
typedef struct dem_contact {
    uint64_t pair;
    vec normal; /* unit, from A to B */
    vec point;  /* halfway between both surfaces, from the centre of A */
    double depth;
    dem_force on;
} dem_contact;

/* What springs hold now, and what was dissipated since the start. */
typedef struct dem_account {
    double normal, tangential, rolling;
    double damping, friction; /* friction with what tangential springs hold when their contact opens */
    double power;             /* of all normal dashpots now */
} dem_account;

/* What the forces across borders pull on the cell at the right, and above. */
typedef struct dem_pull {
    vec right, up;
} dem_pull;

/* Contacts are worked on in blocks of this many. A block's sums do not depend on who makes them. */
enum { DEM_BLOCK = 256 };

typedef struct dem_block {
    size_t count; /* of contacts */
    dem_account account;
    dem_account old; /* what the springs of these contacts held in the last step, and their dashpots' power */
    size_t too_deep; /* the first pair that is, or SIZE_MAX */
} dem_block;

/* Arrays grow by dem_grow(). */
typedef struct dem dem;
struct dem {
    dem_settings settings;
    dem_material materials[DEM_MAX_MATERIALS];
    size_t material_count;
    dem_contact_law laws[DEM_MAX_MATERIALS][DEM_MAX_MATERIALS];

    narc_shapes *store;
    dem_outline *outlines; /* outline k is shape k of the store */
    dem_shape *shapes;
    size_t outline_count, shape_count;

    dem_body *bodies;
    dem_part *parts;
    dem_wall *walls;
    char groups[DEM_MAX_GROUPS][DEM_NAME_SIZE]; /* of walls: names */
    size_t body_count, part_count, wall_count, grain_count, group_count;
    double grain_reach, grain_extent; /* the largest */
    double diagonal;                  /* of the box around all grains and the places of walls, at the start */
    double range;                     /* the largest of all laws */
    double margin;                    /* narc tells of pairs so far apart; touch.h decides */
    bool joins, drifts;               /* some body's contacts join; the cell is sheared or strained */

    uint64_t step;
    double time;       /* step * time_step, summed over stages with their own steps */
    uint64_t renewals; /* how often images were made */
    dem_account account;
    /* Of a cell that is sheared or strained: how far the cell above is to the right of this one; what it was when the
     * images were made, and the size then; sides that hold a stress, and what it is; and the work done so. */
    double offset, last_offset;
    vec last_size;
    dem_side sides[2];
    vec stress;
    dem_pull pull;
    double shear_work;

    dem_image *images;         /* parts, too */
    uint32_t *near_a, *near_b; /* pairs of them that may touch before they are made anew */
    size_t image_count, near_count;
    narc_broad_phase *broad;
    narc_contacts *near;
    const narc_step_result *found; /* of the last step: its slots have a dem_memory */
    dem_pair *pairs;               /* what may touch, in the order of (a, b). No pair stands there twice */
    size_t pair_count;
    dem_contact *contacts; /* what does, in the order of the pairs */
    size_t contact_count;

    /* Memory of a step and of the search for images. */
    narc_body *poses; /* of all images, when narc was last asked */
    dem_block *blocks;
    narc_workers workers;
    narc_box *boxes; /* of parts */

    char input_path[256];     /* in the input, "pile.json: walls[0]: ", while it is read: for errors */
    char error[512];          /* what went wrong */
    void (*on_error)(dem *d); /* NULL: the program ends; it must not return */
};

/* --------------------------------------------------------------------------------------------------------- memory.c */

/* Ends the program with status 2: "dem: message", one line on standard error. */
__attribute__((format(printf, 1, 2), noreturn)) void dem_quit(const char *format, ...);

/* An error of the world: as dem_quit(), unless it has an on_error(). Functions below that find one do not return. */
__attribute__((format(printf, 2, 3), noreturn)) void dem_fail(dem *d, const char *format, ...);
void dem_demand(dem *d, narc_status status, const char *what, const narc_error *error); /* fails unless it is NARC_OK */

/* Room for `needed` items of an array, NULL at first; it grows by halves. The items that there are stay. Where memory
 * runs out the program ends. */
void dem_grow(void *array_pointer, size_t needed, size_t size);
void dem_release(void *array);

/* ---------------------------------------------------------------------------------------------------------- files.c */

/* All bytes of a file, and a NUL behind them: to be released. */
char *dem_read_file(const char *path, size_t *out_size);

/* A file that is written under a temporary name and gets its own when it is closed. */
typedef struct dem_file {
    FILE *file;
    const char *path; /* as it was given: must last as long */
    char *target, *temporary;
} dem_file;

/* Errors tell the system's reason. */
dem_file dem_open_file(dem *d, const char *path);
void dem_close_file(dem *d, dem_file *file);

/* --------------------------------------------------------------------------------------------------------- shapes.c */

/* Adds a shape, moved so that its centroid is its origin: of one outline; of `part_count`, whose arcs, counts[i] each,
 * stand one behind the other in common coordinates. Returns its index. */
uint32_t dem_add_shape(dem *d, const char *name, const narc_arc *arcs, size_t count);
uint32_t dem_add_compound(dem *d, const char *name, const narc_arc *arcs, const size_t *counts, size_t part_count);

/* Of a wall: a chain, which stays in its own coordinates. */
uint32_t dem_add_chain(dem *d, const char *name, const narc_arc *arcs, size_t count, bool closed);

/* --------------------------------------------------------------------------------------------------------- bodies.c */

/* A grain as it is added. */
typedef struct dem_grain {
    uint32_t shape, material;
    vec position;
    double angle, scale; /* the scale is rounded to float */
    vec velocity;
    double spin;
} dem_grain;

/* All grains, then dem_start(). A wall as it is added: {.name, .kind, .material, .position}, and of a box .shape, .scale
 * and .angle, of a plate .normal (of any length); its place is a point of its border. */
void dem_add_grain(dem *d, dem_grain grain);
void dem_add_wall(dem *d, dem_wall wall);

/* Makes walls bodies, behind all grains. */
void dem_add_walls(dem *d);

/* All images where they are now, or were when they were made, for narc, until the next call. */
narc_bodies dem_make_poses(dem *d, bool last);
vec dem_find_shift(const dem *d, const dem_image *of, bool last); /* of an image across a border */

/* The box around all grains: squares as large as they reach; and the places where walls start. */
dem_region dem_bound(const dem *d, bool with_walls);

/* "grain" or "wall", and its number: for messages. */
const char *dem_name_kind(const dem *d, size_t body);
size_t dem_number(const dem *d, size_t body);

unsigned dem_team(const dem *d); /* threads */
vec dem_cell_size(const dem *d);

/* The bodies of a pair. */
static inline dem_body *dem_body_a(const dem *d, size_t pair) { return &d->bodies[d->parts[d->pairs[pair].a].body]; }
static inline dem_body *dem_body_b(const dem *d, size_t pair) { return &d->bodies[d->parts[d->pairs[pair].b].body]; }
static inline const dem_image *dem_image_b(const dem *d, size_t pair) { return &d->images[d->pairs[pair].image]; }
static inline dem_memory *dem_memory_of(const dem *d, size_t pair) {
    return (dem_memory *)d->found->user + d->pairs[pair].slot;
}
static inline bool dem_is_wall(const dem_body *b) { return !(b->inverse_mass > 0); }

/* A rotation is a unit vector, and turns within a step by 2 atan(angle / 2), which is the angle to the third order and
 * needs no sine. What rounding takes from its length is given back each time. */
static inline vec dem_find_turn(double angle) {
    const double half = 0.5 * angle, share = 1 / (1 + half * half);
    return (vec){(1 - half * half) * share, 2 * half * share};
}

static inline vec dem_turn(vec turn, vec by) {
    const vec now = rotate(turn, by);
    return times(1.5 - 0.5 * dot(now, now), now);
}

/* Some body is broken, or so far away that nothing finds it: which? */
__attribute__((noreturn)) void dem_fail_lost(dem *d);

const char *dem_explain_depth(const dem *d); /* why bodies overlap too far */

/* ------------------------------------------------------------------------------------------------------- boundary.c */

/* Other rates, from now on: all grains get the velocities that go with them. */
void dem_set_rates(dem *d, dem_rates rates);

void dem_wrap_bodies(dem *d);
void dem_deform_cell(dem *d);                             /* by a step */
vec dem_find_drift(const dem *d, const dem_image *image); /* the velocity of the image's cell */

/* ---------------------------------------------------------------------------------------------------------- filling.c */

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
    uint32_t material;
    dem_sizes sizes;
    double gap;     /* grains start at least this far apart, and from walls */
    double speed;   /* each component of the velocity is drawn up to this */
    double spin;    /* as well */
    vec spacing;    /* of a lattice */
    double jitter;  /* of a lattice: up to this share of half the spacing, in both directions */
    bool upright;   /* angle 0, else a random one */
    uint64_t tries; /* for one grain, before a random filling gives up */
} dem_filling;

/* `random` is the state of a generator. Walls must have been added before. */
double dem_draw_size(const dem_sizes *sizes, uint64_t *random);
void dem_fill_randomly(dem *d, const dem_filling *filling, uint64_t *random);
void dem_fill_lattice(dem *d, const dem_filling *filling, uint64_t *random);

/* ----------------------------------------------------------------------------------------------------- neighbours.c */

/* Images, and who is near whom, from now on; and again, as they were found last. */
void dem_renew_images(dem *d);
void dem_find_images(dem *d);

/* What may touch where bodies are now. Have images been made since the last time? */
void dem_find_pairs(dem *d, bool renewed);

/* ---------------------------------------------------------------------------------------------------------- walls.c */

void dem_steer_walls(dem *d);
void dem_move_walls(dem *d);

/* Of walls and of shear in half a step, with the forces as they are. */
void dem_count_work(dem *d);

/* The force of the grains on a wall. */
vec dem_wall_force(const dem *d, size_t wall);

/* ----------------------------------------------------------------------------------------------------------- laws.c */

/* The damping ratio that gives a restitution, above 0 and at most 1. */
double dem_damping_ratio(dem_law law, double restitution);

/* The law between two materials, in both orders. With the Hertz law kn and kt come from the materials. */
void dem_set_law(dem *d, uint32_t a, uint32_t b, dem_contact_law law);

/* What the shortest contact lasts that there can be: pi sqrt(m / K) of the lightest grains of each material, with the
 * Hertz law at the deepest overlap that is allowed. Infinite without grains. */
double dem_find_shortest_contact(const dem *d);

void dem_apply_laws(dem *d);

/* ----------------------------------------------------------------------------------------------------------- step.c */

void dem_step(dem *d);
void dem_find_first_forces(dem *d); /* of where bodies begin */

/* ---------------------------------------------------------------------------------------------------------- world.c */

extern const dem_settings dem_defaults;

/* An empty world. dem_destroy() frees what there is, after an error too. */
void dem_create(dem *d, dem_settings settings);
void dem_destroy(dem *d);

/* Checks the whole, makes room. To be called once, before the first step. */
void dem_start(dem *d);

/* ------------------------------------------------------------------------------------------------------- measures.c */

/* Kinetic + potential + elastic + damping + friction - walls stays what it was. */
typedef struct dem_energies {
    double kinetic, potential;
    double elastic;           /* of normal, tangential and rolling springs */
    double damping, friction; /* dissipated */
    double walls;             /* work of moving walls on the grains */
} dem_energies;

/* Force times arm by volume: compression is positive. */
typedef struct dem_stress {
    double xx, xy, yx, yy;
} dem_stress;

typedef struct dem_measures {
    dem_energies energy;
    dem_stress stress;   /* of contacts whose point is in the region */
    size_t contacts;     /* of grains with grains and walls */
    double coordination; /* contacts of a grain: with grains count twice, with walls once, over the grains */
    double deepest;      /* the largest overlap, as a share of the smaller body's extent */
    double fastest;      /* the largest speed of a grain */
} dem_measures;

/* Stresses of a region, or NULL for all. */
void dem_measure(const dem *d, const dem_region *region, dem_measures *out_measures);

/* A body's contacts of the last step, and its stress. Walls have contacts, and no stress.
 *
 * Grains with too few contacts to be held are rattlers, and so are those that are held by them: a grain is held by two
 * contacts that press, or, where no pair of materials has friction, three. */
typedef struct dem_load {
    uint32_t contacts;
    uint32_t bearing; /* contacts that press, with walls and grains that are no rattlers; of a rattler 0 */
    uint32_t count;   /* while they are counted */
    dem_stress stress;
} dem_load;

/* Of all bodies, to be released. */
dem_load *dem_find_loads(const dem *d);

/* FNV-1a, 64 bits, continued; and over the whole state. */
#define DEM_HASH_START 0xcbf29ce484222325u
uint64_t dem_hash_bytes(uint64_t hash, const void *bytes, size_t size);
uint64_t dem_hash(const dem *d);

/* ---------------------------------------------------------------------------------------- tables.c, vtk.c */

/* The table of measures, a line for each time, which grows while the run goes on. A new one; or, if the position is
 * above 0 and the file is there, an old one, cut off there: if it is one of this input, and the line that ends there is
 * not of a later step than the world's. Sets the position to its end. */
FILE *dem_open_csv(dem *d, const char *path, uint64_t *position);

/* Adds a line; false if it cannot be written. */
bool dem_write_csv(FILE *csv, const dem *d, const dem_measures *m);

/* A line of CSV for each grain. */
void dem_write_grains(dem *d, const char *path);

/* Writes the state for ParaView: frame 12 of "out/pile" is out/pile-000012.vtk and out/pile-contacts-000012.vtk. */
void dem_write_vtk(dem *d, const char *stem, uint64_t number);

/* ------------------------------------------------------------------------------------------------ restart.c */

/* What a run is beside the state: kept in a restart file, so that it goes on where it was. */
typedef struct dem_progress {
    uint64_t input;        /* hash of what the input says of bodies, laws and boundaries */
    uint64_t stage;        /* index */
    uint64_t stage_step;   /* steps done in it */
    uint64_t csv_position; /* bytes */
    uint64_t frame;        /* number of the next frame */
} dem_progress;

void dem_write_restart(dem *d, const dem_progress *progress, const char *path);

/* Into a world with the same input, after dem_start(). */
void dem_read_restart(dem *d, dem_progress *progress, const char *path);

#endif
