/* SPDX-License-Identifier: MIT
 *
 * broad_phase.h - the memory of a broad phase, kept from step to step. Internal.
 *
 * Boxes are sorted into STRIPS, rows that are as high as the highest box of their LEVEL: boxes of a level that overlap
 * lie in one strip or in two strips next to each other. A level holds boxes of similar heights and widths. In a strip
 * boxes lie in the order of min_x.
 */
#ifndef NARC_BROAD_PHASE_MEMORY_H
#define NARC_BROAD_PHASE_MEMORY_H

#include <stdatomic.h>

#include "narc_pairs.h"

/* A box on its way to its strip. */
typedef struct narc_box_entry {
    uint64_t strip; /* level and number of the strip, see dispatch/broad_phase/strips.c */
    float min_x;
    uint32_t body;
} narc_box_entry;

typedef struct narc_strip {
    uint64_t number;     /* that of its entries */
    uint32_t first, end; /* its boxes in the columns below */
    uint32_t level;      /* its index in the list of levels */
    float min_y, max_y;  /* what they reach */
    float width;         /* none of them is wider */
} narc_strip;

/* Boxes of one class of heights and one of widths; see dispatch/broad_phase/strips.c. */
typedef struct narc_level {
    uint64_t number;
    double scale;        /* one over the height of its strips */
    uint32_t first, end; /* its strips */
} narc_level;

/* Exponents of floats, and values of a digit that entries are sorted by. */
enum { NARC_EXPONENTS = 256, NARC_DIGITS = 2048 };

/* What one task finds out while boxes are sorted into strips, and then works by. */
typedef struct narc_strip_part {
    union {
        struct {
            float heights[NARC_EXPONENTS], widths[NARC_EXPONENTS]; /* of each power of two the largest, or -1 */
        };
        uint32_t place[NARC_DIGITS]; /* where the next entry with a digit goes */
    };
    size_t start, count;     /* its entries, or strips */
    int64_t lowest, highest; /* strips, if it has entries */
} narc_strip_part;

/* Boxes in columns, and the body of each. */
typedef struct narc_box_columns {
    float *min_x, *max_x, *min_y, *max_y;
    uint32_t *body;
} narc_box_columns;

/* All bits of a pose: two positions, cosine and sine, scale and shape. */
typedef struct narc_pose_bits {
    uint64_t word[4];
} narc_pose_bits;

/* All bits of what a body does in a step: motion, reach, how far ahead its contacts are told, its run; 0 where there is no
 * column. */
typedef struct narc_motion_bits {
    uint32_t word[5];
} narc_motion_bits;

/* What is another one than it was, or another body's: the pose; scale or shape, too. */
enum { NARC_CHANGED = 1, NARC_RESHAPED = 2, NARC_ALL_CHANGED = 3, NARC_HAS_NEW = 4 /* a pair, in this step */ };

/* The poses that boxes were computed from the last time, which serve again while all else is the same. */
typedef struct narc_known_poses {
    narc_pose_bits *poses;
    narc_motion_bits *motions; /* if there are columns of any */
    size_t count;              /* of the first bodies */
    float *slack;     /* so far a body may move and be in its box still: boxes_now are larger by this at first */
    uint8_t *moved;   /* 1: the box may be another one than the kept box was made from */
    uint8_t *changed; /* NARC_CHANGED, NARC_RESHAPED: since who keeps contacts set it to 0 */
    narc_precision precision;    /* of positions */
    bool has_motions, has_boxes; /* has_boxes: boxes_now are theirs */
    const narc_shapes *shapes;
    uint64_t history;   /* of the shapes */
    float margin, skin; /* the skin: for `moved`, `slack` */
} narc_known_poses;

/* Where a kernel puts the bodies whose boxes overlap, a and b in any order: room for some now, and more when it asks. */
typedef struct narc_found_pairs {
    uint32_t *a, *b;
    uint32_t room, count;
    void (*get_room)(struct narc_found_pairs *pairs); /* for another NARC_BOX_PADDING pairs at least */
    bool enough;                                      /* nobody wants more pairs: the kernel may stop */
    uint64_t steps;                                   /* vectors of boxes looked at, and steps of searches */
} narc_found_pairs;

/* What a block of pairs holds: the bodies `a` of its pairs are lowest_a .. highest_a. */
typedef struct narc_pair_block {
    uint32_t count, lowest_a, highest_a;
} narc_pair_block;

/* What a filter says of one body. */
typedef struct narc_body_filter {
    uint64_t category, mask;
    uint32_t owner;
    uint8_t kind, unused[3]; /* 0 */
} narc_body_filter;

enum { NARC_KINDS = NARC_STATIC | NARC_ASLEEP | NARC_SENSOR };

/* Beside kinds, a mark of pairs: the bodies stand in the other order than in the last list. */
enum { NARC_FLIPPED = 128 };

/* No pair of the old list, or no body. */
#define NARC_NO_MATCH UINT32_MAX

/* A pair of the last list that is not in this one. */
typedef struct narc_lost_pair {
    uint32_t pair;       /* its index in the last list */
    uint32_t a, b;       /* its bodies as they were numbered there */
    uint32_t marks;      /* kinds of both as they were then */
    uint64_t id_a, id_b; /* their ids; those numbers where there were none */
} narc_lost_pair;

/* The pairs of a step and how they differ from the last list's. All arrays belong to the broad phase. */
typedef struct narc_pair_list {
    narc_pairs pairs;         /* a < b, in the order of a and then b */
    const uint32_t *previous; /* for each pair: its index in the last list, or NARC_NO_MATCH if it is new */
    const uint8_t *marks;     /* for each pair: the kinds of both bodies together, and NARC_FLIPPED */
    const uint32_t *added;    /* the pairs that are new, rising */
    size_t added_count;
    const narc_lost_pair *lost; /* in the order of the last list */
    size_t lost_count;
    size_t skipped;  /* bodies without a box, in no pair: broken ones */
    bool kept;       /* these are the last list's pairs: previous[k] is k, none is new, none is lost */
    bool renumbered; /* bodies may have other numbers than in the last list */
} narc_pair_list;

/* A list of pairs that narc_update_pairs() made, and whose pairs they are. */
typedef struct narc_kept_list {
    narc_pair_list list; /* as others see it */
    void *pair_memory;
    size_t pair_capacity, lost_capacity, id_capacity;
    /* for each pair */
    uint32_t *a, *b, *previous, *added;
    uint8_t *marks;
    uint8_t *matched; /* 1: the next list has it */
    narc_lost_pair *lost;
    uint64_t *ids; /* of each body, if has_ids; else they are their numbers */
    uint8_t *gone; /* beside ids; 1: it was taken out since */
    bool has_ids, has_gone;
    size_t body_count;
} narc_kept_list;

struct narc_broad_phase {
    narc_allocator allocator;
    void *box_memory, *pair_memory, *match_memory, *body_memory;
    /* what narc_update_pairs() keeps */
    narc_kept_list lists[2]; /* the last one, and memory for the next */
    int last;
    bool is_current;      /* the last list holds all pairs of `kept_boxes` and `filters`, or the given ones */
    bool is_given;        /* its pairs were the caller's */
    bool is_sorted;       /* what is sorted below are the kept boxes, but for unsorted ones */
    bool has_filter;      /* `kinds` and `filters` are in use */
    bool has_sets;        /* `filters` may say other than that all bodies may form pairs */
    bool has_other_kinds; /* marks that were taken over may be wrong */
    bool marked;          /* the last call made marks anew */
    bool renewed;         /* lists may say more than that all is kept: new pairs, lost ones, flips */
    size_t body_capacity; /* for each body: */
    narc_box *boxes_now, *kept_boxes;
    narc_point origin;      /* of the coordinates of both, in the world */
    bool reframed;          /* it is another one than in the last call */
    narc_known_poses known; /* those of boxes_now */
    narc_body_filter *filters;
    uint8_t *kinds;
    uint32_t *last_index; /* its number in the last list */
    uint32_t *place;      /* of its box in the columns, NARC_NO_PLACE or NARC_UNSORTED */
    uint8_t *fresh;       /* 1: it gets a new kept box, or may form other pairs */
    uint8_t *taken;       /* for each body of the last list: it has a number in this one */
    /* what narc_find_pairs() sorts */
    size_t box_capacity, block_capacity, match_capacity; /* match_capacity: of uint32_t */
    /* for each box */
    narc_box_entry *entries, *spare;
    narc_box_columns boxes; /* in the order of their strips; unsorted ones and NARC_BOX_PADDING items behind them */
    narc_strip *strips;
    narc_level *levels;     /* those that have boxes, the highest strips first */
    uint32_t *ends;         /* of each body's list of partners; one more than boxes */
    narc_strip_part *parts; /* one for every NARC_PART_BOXES boxes, NARC_STRIP_PARTS at most */
    uint32_t *unsorted;     /* bodies whose kept boxes are others than when all were sorted */
    /* for each block of pairs */
    uint32_t *pair_a, *pair_b; /* NARC_PAIR_BLOCK each */
    narc_pair_block *blocks;
    /* of the last call */
    atomic_size_t block_count; /* blocks that tasks asked for, perhaps more than there are */
    size_t strip_count, level_count, sorted_count, unsorted_count;
    uint64_t steps;                   /* of the last sweep */
    int64_t lowest_strip, strip_span; /* of all levels; numbers of strips leave strip_span for each level */
};

/* A body that is not in the columns; an unsorted one, whose box there overlaps nothing. Neither is a place. */
#define NARC_NO_PLACE UINT32_MAX
#define NARC_UNSORTED (UINT32_MAX - 1)

/* So many boxes may be unsorted. */
static inline size_t narc_most_unsorted(size_t count) { return count / 8; }

/* What a kernel may read behind the last box: the widest vector. */
enum { NARC_BOX_PADDING = 16 };

/* Boxes that are worth a task, and the most parts that they are divided into for strips. */
enum { NARC_PART_BOXES = 1024, NARC_STRIP_PARTS = 16 };

/* Pairs that a task takes room for at a time. */
enum { NARC_PAIR_BLOCK = 4096 };

/* A block with fewer pairs is filled up before a task takes the next. */
enum { NARC_FULL_BLOCK = NARC_PAIR_BLOCK / 8 * 7 };

/* Make room for so many boxes, blocks of pairs, and numbers in two arrays of 32 bits; what was there is lost, unless
 * there is room already. NARC_ERROR_MEMORY: there is as much room as before. */
narc_status narc_reserve_boxes(narc_broad_phase *broad, size_t count);
narc_status narc_reserve_blocks(narc_broad_phase *broad, size_t count);
narc_status narc_reserve_matches(narc_broad_phase *broad, size_t first_count, size_t second_count);
narc_status narc_reserve_bodies(narc_broad_phase *broad, size_t count); /* what is lost makes is_current false */
narc_status narc_reserve_pairs(narc_broad_phase *broad, narc_kept_list *list, size_t count);
narc_status narc_reserve_lost(narc_broad_phase *broad, narc_kept_list *list, size_t count);
narc_status narc_reserve_ids(narc_broad_phase *broad, narc_kept_list *list, size_t count);

#endif
