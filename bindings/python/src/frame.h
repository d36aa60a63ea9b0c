/* SPDX-License-Identifier: MIT
 *
 * frame.h - one call from Python to the library: what its arguments are made into, and what is given back when it ends.
 *
 * What returns false, or NULL, has set an error: Python's, or the frame's own where the library has one for it.
 * Nothing here knows a structure by heart: the library's table of layouts (narc_layouts.h) says what a structure has, so that
 * a new member can be given from Python at once.
 */
#ifndef NARC_FRAME_H
#define NARC_FRAME_H

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <narc.h>
#include <narc_contacts.h>
#include <narc_layouts.h>

enum { MOST_ARGUMENTS = 10, MOST_BUFFERS = 48, MOST_GROUPS = 32, ARENA = 4096, MOST_NAMES = 8 };

/* A call that is under way. Each argument has a slot: a pointer, how many items are there, or a number. */
typedef struct frame {
    void *p[MOST_ARGUMENTS];
    void *handles[MOST_ARGUMENTS]; /* Python objects that are in use */
    size_t n[MOST_ARGUMENTS];
    double d[MOST_ARGUMENTS];
    size_t count, skipped; /* what the library tells */
    narc_pairs pairs;
    const narc_step_result *step;
    const uint32_t *slots;
    narc_error error;
    size_t largest;                /* the longest column: is it worth to let other threads of Python run? */
    const char *names[MOST_NAMES]; /* of what is read: an argument, a member of it, ... */
    int depth;
    Py_ssize_t lengths[MOST_GROUPS]; /* of columns that belong together; -1: not known yet */
    Py_buffer buffers[MOST_BUFFERS];
    int buffer_count;
    void *memory[MOST_BUFFERS]; /* of converted columns */
    int memory_count;
    char name[160]; /* of what frame_name() returned */
    size_t arena_used;
    _Alignas(16) char arena[ARENA]; /* structures that others point to, and single values */
} frame;

/* The number of a group that a letter stands for; 0 is none. */
static inline unsigned char group_number(char letter) { return (unsigned char)(letter - 'A' + 1); }

void frame_begin(frame *f);
void frame_end(frame *f);

/* What is read, for messages: "query.margins". */
const char *frame_name(frame *f);

/* In place of Python's error, which does not name what is read: `given` is a number that its place can't have, or is not what is
 * wanted. Returns false. */
bool frame_refuse(frame *f, const char *wanted, PyObject *given);

/* Room in the frame, all 0; NULL, with an error set: there is none. */
void *frame_allocate(frame *f, size_t size);

/* The buffer of an object, until the frame ends; NULL, with an error that names the argument. `flags`: PyBUF_... */
Py_buffer *frame_view(frame *f, PyObject *object, int flags);

/* Tells that arrays with this dtype hold rows of this structure, or numbers of this format: NumPy takes microseconds to write
 * down the format of records. */
bool frame_know(PyObject *dtype, const char *name);

/* Fills a structure: from None (nothing), a mapping of members, records with fields of the members' names, an array or list of two
 * columns, x and y or a and b, or a tuple of all numbers. Columns belong to `group`. False, with an error that names the member. */
bool frame_fill(frame *f, const narc_layout *layout, void *structure, PyObject *given, unsigned char group);

/* Threads for a call, NULL for one; false, with an error. */
bool frame_workers(frame *f, PyObject *given, const narc_workers **out_workers);

/* An array of rows without gaps, `size` bytes each: records of the layout's members, or an array with a column for each of them;
 * or, without a layout, any items. `writable`: rows that the call fills, which need to be as large alone. */
bool frame_rows(frame *f, const narc_layout *layout, size_t size, size_t alignment, bool writable, PyObject *given,
                void **out_rows, size_t *out_count);

/* A column by itself, and how long it is: its `type` is that of a member. */
bool frame_column(frame *f, const char *type, void *column, size_t *out_count, PyObject *given, unsigned char group);

#endif
