/* SPDX-License-Identifier: MIT
 *
 * module.c - the module narc._narc: a table of the library's calls, objects that hold what it creates, errors.
 *
 * Compiled once for all versions of Python from 3.11 on (Py_LIMITED_API), without NumPy: arrays come and go by the buffer
 * protocol. narc/ makes of it what people use.
 */
#include "frame.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <narc_broad_phase.h>
#include <narc_chains.h>
#include <narc_contacts.h>
#include <narc_scene.h>

#include "errors.h"
#include "threads.h"

static PyObject *warning_class;

/* ------------------------------------------------------------------------------------------------ objects */

/* What the library creates. Calls may read it at a time, or one may change it: what would disturb another call, which is
 * under way without Python's lock, is an error. */
enum { ROOMS = 7 };
typedef struct handle {
    PyObject_HEAD void *pointer;
    const narc_step_result *step; /* of contacts: the last one, if it can still be read */
    PyObject *rooms[2][ROOMS];    /* bytes of the last two: they are filled again when nobody has them any more */
    int room;
    size_t user_size;
    int kind, readers;
    bool is_changed;
    unsigned forks; /* of this process, when it was last used */
} handle;

/* How many forks this process is away from the first one. Threads that were reading in the parent are not here. */
static unsigned fork_count;

enum { SHAPES, INDEX, CONTACTS, BROAD_PHASE, KINDS };
static const char *const kinds[KINDS] = {"Shapes", "Index", "Contacts", "BroadPhase"};
static PyTypeObject *handle_type;

static int find_kind(const char *name, size_t length) {
    for (int kind = 0; kind < KINDS; kind++)
        if (strlen(kinds[kind]) == length && memcmp(kinds[kind], name, length) == 0)
            return kind;
    return -1;
}

/* Handle(kind, rows, user_size): of contacts, NARC_MANIFOLD_ROWS or NARC_CONTACT_ROWS, and the caller's bytes of a slot. */
static PyObject *handle_new(PyTypeObject *type, PyObject *arguments, PyObject *keywords) {
    const char *name;
    unsigned rows = 0;
    Py_ssize_t user_size = 0;
    (void)keywords;
    if (!PyArg_ParseTuple(arguments, "s|In:Handle", &name, &rows, &user_size))
        return NULL;
    const int kind = find_kind(name, strlen(name));
    if (kind < 0)
        return PyErr_Format(PyExc_ValueError, "there is no kind %s", name);
    const allocfunc allocate = (allocfunc)PyType_GetSlot(type, Py_tp_alloc);
    handle *const self = (handle *)allocate(type, 0);
    if (!self)
        return NULL;
    self->kind = kind;
    self->user_size = (size_t)user_size;
    narc_error error = {0};
    const narc_contacts_settings settings = {.rows = rows, .user_size = self->user_size};
    const narc_status status = kind == SHAPES  ? narc_create_shapes(NULL, (narc_shapes **)&self->pointer)
                               : kind == INDEX ? narc_create_index(NULL, (narc_index **)&self->pointer)
                               : kind == CONTACTS
                                   ? narc_create_contacts(&settings, (narc_contacts **)&self->pointer, &error)
                                   : narc_create_broad_phase(NULL, (narc_broad_phase **)&self->pointer);
    if (status != NARC_OK) {
        Py_DECREF(self);
        return raise_error(&error, status);
    }
    return (PyObject *)self;
}

static void handle_dealloc(PyObject *object) {
    handle *const self = (handle *)object;
    PyTypeObject *const type = Py_TYPE(object);
    for (int k = 0; k < 2 * ROOMS; k++)
        Py_XDECREF(self->rooms[k / ROOMS][k % ROOMS]);
    switch (self->kind) {
    case SHAPES:
        narc_destroy_shapes(self->pointer);
        break;
    case INDEX:
        narc_destroy_index(self->pointer);
        break;
    case CONTACTS:
        narc_destroy_contacts(self->pointer);
        break;
    default:
        narc_destroy_broad_phase(self->pointer);
    }
    ((freefunc)PyType_GetSlot(type, Py_tp_free))(object);
    Py_DECREF(type);
}

static PyType_Slot handle_slots[] = {
    {Py_tp_new, (void *)handle_new}, {Py_tp_dealloc, (void *)handle_dealloc}, {0, NULL}};
static PyType_Spec handle_spec = {"narc._narc.Handle", sizeof(handle), 0, Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE,
                                  handle_slots};

/* ------------------------------------------------------------------------------------------------ calls */

/* What a call returns: how many rows there are, if more than there was room for, too; pairs that the library owns, or the last
 * step, as copies; bytes. */
typedef enum result { COUNT, PAIRS, SLOTS, STEP } result;

typedef struct call {
    const char *name;
    /* name:type of each argument, in the order of slots.
     *   Shapes, Shapes!      a handle of this kind; it is changed. Index!@B: as many boxes are a length
     *   narc_query@P         a structure, and what its columns have the length of
     *   narc_index_column@P  a column
     *   <narc_arc, >narc_arc rows that are read, or filled; <8, >8: items of so many bytes; >narc_arc*64: at least so many
     *   double, size, flag   a number
     *   bytes, threads */
    const char *arguments;
    result result;
    narc_status (*run)(frame *f, void **p, const size_t *n, const double *d, narc_error *e);
} call;

/* Of calls that say no more than that they have no answer. */
static narc_status must(bool is, narc_error *error) {
    if (!is)
        snprintf(error->message, sizeof error->message,
                 "there is no answer: a number is not finite, or it is not 1 to %d arcs (narc.validate_arcs())",
                 NARC_MAX_ARCS);
    return is ? NARC_OK : NARC_ERROR_ARGUMENT;
}
#define MUST(expression) must(expression, e)

static narc_status load_shapes(void *object, const void *bytes, size_t size, narc_error *error) {
    handle *const self = object;
    narc_shapes *loaded;
    const narc_status status = narc_load_shapes(NULL, bytes, size, &loaded, error);
    if (status == NARC_OK) {
        narc_destroy_shapes(self->pointer);
        self->pointer = loaded;
    }
    return status;
}

/* The number of a shape or body: too large a one is none. */
static uint32_t number(size_t n) { return n < UINT32_MAX ? (uint32_t)n : UINT32_MAX; }

static bool find_depths(const narc_arc *arcs, size_t count, const narc_point *points, size_t point_count, double *out) {
    for (size_t k = 0; k < point_count; k++)
        if (!narc_compute_distance(arcs, count, &points[k], &out[k]))
            return false;
    return true;
}

static bool find_inside(const narc_arc *arcs, size_t count, const narc_point *points, size_t point_count, bool *out) {
    bool are = count > 0 && count <= NARC_MAX_ARCS;
    for (size_t k = 0; k < point_count; k++) {
        out[k] = narc_contains_point(arcs, count, &points[k]);
        are = are && isfinite(points[k].x) && isfinite(points[k].y);
    }
    return are;
}

static narc_status update_contacts(void **p, handle *contacts, const narc_step_result **out_step, narc_error *error) {
    narc_step step = {0};
    if (p[3])
        step = *(const narc_step *)p[3];
    step.bodies = p[2];
    contacts->step = NULL;
    const narc_status status = narc_update_contacts(p[0], p[1], &step, out_step, error);
    contacts->step = status == NARC_OK ? *out_step : NULL;
    return status;
}

static narc_status load_contacts(void **p, size_t size, handle *contacts, const narc_step_result **out_step,
                                 narc_error *error) {
    contacts->step = NULL;
    const narc_status status = narc_load_contacts(p[0], p[1], p[2], size, out_step, error);
    contacts->step = status == NARC_OK ? *out_step : NULL;
    return status;
}

/* The caller's bytes of slots, read or written: user_size of each. */
static narc_status copy_user(const handle *contacts, const uint32_t *slots, size_t count, char *rows, size_t size,
                             bool writes, narc_error *error) {
    const narc_step_result *const step = contacts->step;
    const size_t bytes = contacts->user_size;
    if (!step || size != count * bytes) {
        snprintf(error->message, sizeof error->message,
                 step ? "rows have %zu bytes, not %zu for each slot" : "there is no step whose slots have rows", size,
                 bytes);
        return NARC_ERROR_ARGUMENT;
    }
    for (size_t k = 0; k < count; k++)
        if (slots[k] >= step->pairs.count) {
            snprintf(error->message, sizeof error->message, "there is no slot %u", slots[k]);
            error->index = k;
            error->value = slots[k];
            return NARC_ERROR_INDEX;
        }
    for (size_t k = 0; k < count && bytes; k++) {
        char *const own = (char *)step->user + bytes * slots[k], *const row = rows + bytes * k;
        memcpy(writes ? own : row, writes ? row : own, bytes);
    }
    return NARC_OK;
}

static narc_status get_arcs(const narc_shapes *shapes, size_t shape, narc_arc *out, size_t *out_count,
                            narc_error *error) {
    *out_count = narc_get_arcs(shapes, number(shape), out);
    if (*out_count || narc_shape_flags(shapes, number(shape)) & NARC_SHAPE_HALF_PLANE)
        return NARC_OK;
    snprintf(error->message, sizeof error->message, "there is no shape %zu", shape);
    error->index = shape;
    error->value = (double)shape;
    return NARC_ERROR_INDEX;
}

static narc_status forget(void *object) {
    ((handle *)object)->step = NULL;
    return NARC_OK;
}

#define CALL(name, arguments, result, expression)                                                                      \
    static narc_status run_##name(frame *f, void **p, const size_t *n, const double *d, narc_error *e) {               \
        (void)f, (void)p, (void)n, (void)d, (void)e;                                                                   \
        return expression;                                                                                             \
    }
#include "calls.inl"
#undef CALL

static const call calls[] = {
#define CALL(name, arguments, result, expression) {#name, arguments, result, run_##name},
#include "calls.inl"
#undef CALL
};
enum { CALLS = sizeof calls / sizeof *calls };

/* ------------------------------------------------------------------------------------------------ arguments */

/* What stands behind a name in call.arguments. */
typedef enum type { HANDLE, CHANGED_HANDLE, STRUCTURE, COLUMN, ROWS_IN, ROWS_OUT, DOUBLE, SIZE, THREADS } type;

typedef struct argument {
    char name[24];
    type type;
    unsigned char group;
    int kind;                  /* of a handle */
    const narc_layout *layout; /* of a structure or of rows */
    size_t size, alignment;    /* of rows */
    Py_ssize_t least;          /* rows to be filled, whatever the call */
    bool is_bits;              /* words of 64 bits, one bit for each item of the group */
    char column[32];
} argument;

typedef struct signature {
    const call *call;
    int count;
    argument arguments[MOST_ARGUMENTS];
} signature;

static signature signatures[CALLS];

/* Of the widest number in a structure. */
static size_t find_alignment(const narc_layout *layout) {
    size_t widest = 1;
    for (size_t k = 0; k < layout->member_count; k++) {
        const narc_layout *const inner = narc_find_layout(layout->members[k].type);
        const size_t here = inner ? find_alignment(inner) : layout->members[k].size;
        widest = here > widest ? here : widest;
    }
    return widest;
}

static bool read_argument(const char *text, argument *out) {
    char kind[48];
    const size_t name = strcspn(text, ":"), end = strcspn(text, " ");
    const char *const at = memchr(text, '@', end), *const star = memchr(text, '*', end), *const mark = at ? at : star;
    const size_t length = (mark ? (size_t)(mark - text) : end) - name - 1;
    PyOS_snprintf(out->name, sizeof out->name, "%.*s", (int)name, text);
    PyOS_snprintf(kind, sizeof kind, "%.*s", (int)length, text + name + 1);
    out->group = at ? group_number(at[1]) : 0;
    out->least = star ? (Py_ssize_t)strtol(star + 1, NULL, 10) : 0;
    const bool rows = kind[0] == '<' || kind[0] == '>', changed = kind[length - 1] == '!';
    if (rows) {
        out->type = kind[0] == '<' ? ROWS_IN : ROWS_OUT;
        out->layout = narc_find_layout(kind + 1);
        out->is_bits = strcmp(kind + 1, "bits") == 0;
        out->size = out->layout ? out->layout->size : out->is_bits ? sizeof(uint64_t) : (size_t)(kind[1] - '0');
        out->alignment = out->layout ? find_alignment(out->layout) : out->size;
        return out->layout || out->is_bits || (kind[1] >= '1' && kind[1] <= '8');
    }
    if ((out->kind = find_kind(kind, length - changed)) >= 0) {
        out->type = changed ? CHANGED_HANDLE : HANDLE;
        return true;
    }
    static const char *const words[] = {"double", "size", "threads"};
    static const type types[] = {DOUBLE, SIZE, THREADS};
    for (int k = 0; k < 3; k++)
        if (strcmp(kind, words[k]) == 0) {
            out->type = types[k];
            return true;
        }
    out->layout = narc_find_layout(kind);
    out->type = length > 7 && strcmp(kind + length - 7, "_column") == 0 ? COLUMN : STRUCTURE;
    PyOS_snprintf(out->column, sizeof out->column, "%s", kind);
    return out->layout != NULL;
}

static bool read_signature(const call *of, signature *out) {
    out->call = of;
    for (const char *text = of->arguments; *text; text += *text == ' ') {
        if (out->count == MOST_ARGUMENTS || !read_argument(text, &out->arguments[out->count]))
            return false;
        out->count++;
        text += strcspn(text, " ");
    }
    return true;
}

static bool take_handle(frame *f, const argument *a, PyObject *given, int slot) {
    if (!PyObject_TypeCheck(given, handle_type) || ((handle *)given)->kind != a->kind) {
        PyErr_Format(PyExc_TypeError, "%s: a narc.%s is wanted, not %R", a->name, kinds[a->kind],
                     (PyObject *)Py_TYPE(given));
        return false;
    }
    handle *const h = (handle *)given;
    if (h->forks != fork_count)
        h->readers = 0;
    h->forks = fork_count;
    if (h->is_changed || (a->type == CHANGED_HANDLE && h->readers > 0)) {
        PyErr_Format(PyExc_RuntimeError, "%s is in use by another call", a->name);
        return false;
    }
    if (a->type == CHANGED_HANDLE)
        h->is_changed = true;
    else
        h->readers++;
    f->handles[slot] = h;
    f->p[slot] = h->pointer;
    narc_index_statistics index;
    if (a->group && narc_describe_index(h->pointer, &index, NULL) == NARC_OK)
        f->lengths[a->group] = (Py_ssize_t)index.boxes;
    return true;
}

static void give_handles_back(const frame *f, const signature *s) {
    for (int k = 0; k < s->count; k++) {
        handle *const h = f->handles[k];
        if (h && s->arguments[k].type == CHANGED_HANDLE)
            h->is_changed = false;
        else if (h)
            h->readers--;
    }
}

static bool take_argument(frame *f, const argument *a, PyObject *given, int k) {
    f->names[0] = a->name;
    f->depth = 1;
    switch (a->type) {
    case HANDLE:
    case CHANGED_HANDLE:
        return take_handle(f, a, given, k);
    case STRUCTURE:
    case COLUMN:
        if (given == Py_None && a->type == COLUMN)
            return true;
        f->p[k] = frame_allocate(f, a->layout->size);
        if (!f->p[k])
            return false;
        return a->type == COLUMN ? frame_column(f, a->column, f->p[k], &f->n[k], given, a->group)
                                 : frame_fill(f, a->layout, f->p[k], given, a->group);
    case ROWS_IN:
    case ROWS_OUT:
        if (!frame_rows(f, a->layout, a->size, a->alignment, a->type == ROWS_OUT, given, &f->p[k], &f->n[k]))
            return false;
        break;
    case DOUBLE:
        f->d[k] = PyFloat_AsDouble(given);
        return !PyErr_Occurred() || frame_refuse(f, "a number", given);
    case SIZE: {
        PyObject *const whole = PyNumber_Index(given);
        f->n[k] = whole ? PyLong_AsSize_t(whole) : 0;
        Py_XDECREF(whole);
        if (!whole)
            return frame_refuse(f, "a whole number", given);
        if (PyErr_Occurred())
            PyErr_Format(index_error_class, "%s is %R, which no number of one is", a->name, given);
        return !PyErr_Occurred();
    }
    default:
        return frame_workers(f, given, (const narc_workers **)&f->p[k]);
    }
    /* rows for each item of a group */
    const Py_ssize_t rows = (Py_ssize_t)f->n[k];
    if (rows < a->least) {
        PyErr_Format(PyExc_ValueError, "%s has %zd rows, %zd are needed", a->name, rows, a->least);
        return false;
    }
    if (!a->group || (a->type == ROWS_IN && f->lengths[a->group] < 0)) {
        f->lengths[a->group] = a->group ? rows : -1;
        return true;
    }
    const Py_ssize_t length = f->lengths[a->group] < 0 ? 1 : f->lengths[a->group];
    const Py_ssize_t wanted = a->is_bits ? (length + 63) / 64 : length;
    if (rows >= wanted && (a->type == ROWS_OUT || rows == wanted))
        return true;
    PyErr_Format(PyExc_ValueError, "%s has %zd rows, where there are %zd", a->name, rows, wanted);
    return false;
}

/* ------------------------------------------------------------------------------------------------ results */

/* Bytes to fill: in the room, if it has some that nobody else has, and then it keeps them. Fresh memory takes longer than what is
 * written there. */
static PyObject *make_bytes(PyObject **room, size_t size) {
    if (room && *room && Py_REFCNT(*room) == 1) {
        if (PyByteArray_Resize(*room, (Py_ssize_t)size) == 0) {
            Py_INCREF(*room);
            return *room;
        }
        PyErr_Clear();
    }
    PyObject *const made = PyByteArray_FromStringAndSize(NULL, (Py_ssize_t)size);
    if (room) {
        Py_XINCREF(made);
        Py_XDECREF(*room);
        *room = made;
    }
    return made;
}

static PyObject *copy_pairs(PyObject **room, const narc_pairs *pairs, const uint32_t *slots, size_t count) {
    PyObject *const made = make_bytes(room, count * 8);
    narc_error error = {0};
    if (!made)
        return NULL;
    uint32_t *const out = (uint32_t *)(void *)PyByteArray_AsString(made);
    const narc_status status = narc_copy_pairs(pairs, slots, count, out, count ? out + 1 : NULL, 8, &error);
    if (status == NARC_OK)
        return made;
    Py_DECREF(made);
    return raise_error(&error, status);
}

/* Rows of slots, or the first ones. */
static PyObject *copy_rows(PyObject **room, const void *rows, size_t size, const uint32_t *slots, size_t count) {
    PyObject *const made = make_bytes(room, count * size);
    if (!made)
        return NULL;
    char *const out = PyByteArray_AsString(made);
    if (!slots && count)
        memcpy(out, rows, count * size);
    else if (size == sizeof(narc_contact)) /* as structures they are copied without a call for each */
        for (size_t k = 0; k < count; k++)
            ((narc_contact *)(void *)out)[k] = ((const narc_contact *)rows)[slots[k]];
    else
        for (size_t k = 0; k < count; k++)
            ((narc_manifold *)(void *)out)[k] = ((const narc_manifold *)rows)[slots[k]];
    return made;
}

/* (pairs, slots, rows of what touches, further rows, began, ended, slots of sensors, all pairs, skipped, asked) */
static PyObject *copy_step(handle *contacts, const narc_step_result *r) {
    const size_t row = r->manifolds ? sizeof *r->manifolds : sizeof *r->contacts;
    const void *const rows = r->manifolds ? (const void *)r->manifolds : r->contacts;
    PyObject **const rooms = contacts->rooms[contacts->room ^= 1];
    PyObject *const parts[] = {copy_pairs(&rooms[0], &r->pairs, r->touching, r->touching_count),
                               copy_rows(&rooms[1], r->touching, 4, NULL, r->touching_count),
                               copy_rows(&rooms[2], rows, row, r->touching, r->touching_count),
                               copy_rows(&rooms[3], r->more, row, NULL, r->more_count),
                               copy_rows(&rooms[4], r->began, sizeof *r->began, NULL, r->began_count),
                               copy_rows(&rooms[5], r->ended, sizeof *r->ended, NULL, r->ended_count),
                               copy_rows(&rooms[6], r->sensors, 4, NULL, r->sensor_count),
                               PyLong_FromSize_t(r->count),
                               PyLong_FromSize_t(r->skipped),
                               PyLong_FromSize_t(r->asked_count)};
    enum { PARTS = sizeof parts / sizeof *parts };
    PyObject *made = PyTuple_New(PARTS);
    for (int k = 0; k < PARTS; k++)
        if (made && parts[k])
            PyTuple_SetItem(made, k, parts[k]);
        else {
            Py_XDECREF(parts[k]);
            Py_CLEAR(made);
        }
    return made;
}

/* The warning, at the line outside this package; false if it is an exception there. */
static bool warn_of_skipped(size_t skipped) {
    PyObject *const tables = PyImport_ImportModule("narc._tables");
    PyObject *const told = tables ? PyObject_CallMethod(tables, "warn_of_skipped", "n", (Py_ssize_t)skipped) : NULL;
    Py_XDECREF(told);
    Py_XDECREF(tables);
    return told != NULL;
}

static PyObject *make_result(const frame *f, const signature *s, narc_status status) {
    if (status != NARC_OK && status != NARC_ERROR_CAPACITY)
        return raise_error(&f->error, status);
    if (status == NARC_ERROR_CAPACITY && f->count == 0)
        return raise_error(&f->error, status);
    if (f->skipped > 0 && !warn_of_skipped(f->skipped))
        return NULL;
    switch (s->call->result) {
    case PAIRS:
        return copy_pairs(NULL, &f->pairs, NULL, f->pairs.count);
    case SLOTS:
        return copy_rows(NULL, f->slots, sizeof *f->slots, NULL, f->count);
    case STEP:
        return copy_step(f->handles[0], f->step);
    default:
        return PyLong_FromSize_t(f->count);
    }
}

/* Long enough that other threads should run meanwhile. */
enum { MANY = 256 };

static PyObject *invoke(PyObject *self, PyObject *const *given, Py_ssize_t count) {
    const signature *const s = PyCapsule_GetPointer(self, NULL);
    frame f;
    PyObject *made = NULL;
    if (!s)
        return NULL;
    if (count != s->count)
        return PyErr_Format(PyExc_TypeError, "%s() takes %d arguments: %s", s->call->name, s->count,
                            s->call->arguments);
    frame_begin(&f);
    int k = 0;
    while (k < s->count && take_argument(&f, &s->arguments[k], given[k], k))
        k++;
    if (k == s->count) {
        narc_status status;
        if (f.largest < MANY) {
            status = s->call->run(&f, f.p, f.n, f.d, &f.error);
            made = make_result(&f, s, status);
        } else {
            PyThreadState *const state = PyEval_SaveThread();
            status = s->call->run(&f, f.p, f.n, f.d, &f.error);
            PyEval_RestoreThread(state);
            made = make_result(&f, s, status);
        }
    } else if (!PyErr_Occurred())
        raise_error(&f.error, f.error.status);
    give_handles_back(&f, s);
    frame_end(&f);
    return made;
}

/* ------------------------------------------------------------------------------------------------ the module */

/* Puts a value that is given away into a mapping, which goes with the first that is none. */
static void put(PyObject **mapping, const char *name, PyObject *value) {
    if (*mapping && (!value || PyDict_SetItemString(*mapping, name, value)))
        Py_CLEAR(*mapping);
    Py_XDECREF(value);
}

/* {structure: (bytes, {member: (type, offset, bytes, count), ...})} */
static PyObject *list_layouts(PyObject *self, PyObject *unused) {
    PyObject *layouts = PyDict_New();
    (void)self, (void)unused;
    for (size_t k = 0; narc_get_layout(k); k++) {
        const narc_layout *const layout = narc_get_layout(k);
        PyObject *members = PyDict_New();
        for (size_t i = 0; i < layout->member_count; i++) {
            const narc_member *const m = &layout->members[i];
            put(&members, m->name,
                Py_BuildValue("(snnn)", m->type, (Py_ssize_t)m->offset, (Py_ssize_t)m->size, (Py_ssize_t)m->count));
        }
        put(&layouts, layout->name, members ? Py_BuildValue("(nN)", (Py_ssize_t)layout->size, members) : NULL);
    }
    return layouts;
}

/* {constant: number} */
static PyObject *list_constants(PyObject *self, PyObject *unused) {
    PyObject *constants = PyDict_New();
    (void)self, (void)unused;
    for (size_t k = 0; narc_get_constant(k); k++) {
        const narc_constant *const c = narc_get_constant(k);
        const bool whole = c->value < 1e15 && c->value == (double)(long long)c->value;
        put(&constants, c->name, whole ? PyLong_FromLongLong((long long)c->value) : PyFloat_FromDouble(c->value));
    }
    return constants;
}

static PyObject *get_isa(PyObject *self, PyObject *unused) {
    (void)self, (void)unused;
    return Py_BuildValue("z", narc_get_isa());
}

static PyObject *set_isa(PyObject *self, PyObject *name) {
    narc_error error = {0};
    const char *const text = name == Py_None ? NULL : PyUnicode_AsUTF8AndSize(name, NULL);
    (void)self;
    if (!text && name != Py_None)
        return NULL;
    const narc_status status = narc_set_isa(text, &error);
    if (status != NARC_OK)
        return raise_error(&error, status);
    Py_RETURN_NONE;
}

/* {"isa": names, "kernel": names, "cpu": names}; of instruction sets those that can be had */
static PyObject *list_names(PyObject *self, PyObject *unused) {
    static const struct {
        const char *key, *(*name)(size_t index);
    } lists[] = {{"isa", narc_isa_name}, {"kernel", narc_kernel_name}, {"cpu", narc_cpu_feature}};
    PyObject *names = PyDict_New();
    (void)self, (void)unused;
    for (int list = 0; list < 3; list++) {
        PyObject *const made = PyList_New(0);
        const char *name;
        for (size_t k = 0; made && (name = lists[list].name(k)); k++) {
            PyObject *const text = list > 0 || narc_isa_supported(name) ? PyUnicode_FromString(name) : NULL;
            if (text && PyList_Append(made, text))
                PyErr_Clear();
            Py_XDECREF(text);
        }
        put(&names, lists[list].key, made);
    }
    return names;
}

/* know(structure or format, dtype) */
static PyObject *know(PyObject *self, PyObject *given) {
    const char *name;
    PyObject *dtype;
    (void)self;
    if (!PyArg_ParseTuple(given, "sO", &name, &dtype))
        return NULL;
    if (!frame_know(dtype, name))
        return PyErr_Format(PyExc_ValueError, "%s can't be known", name);
    Py_RETURN_NONE;
}

/* _fork(when): 0 before a fork, 1 behind it in the parent, 2 in the child */
static PyObject *hear_of_fork(PyObject *self, PyObject *given) {
    const long when = PyLong_AsLong(given);
    (void)self;
    if (when == 0)
        before_fork();
    else if (when > 0)
        fork_count += after_fork(when == 2);
    if (PyErr_Occurred())
        return NULL;
    Py_RETURN_NONE;
}

static PyMethodDef functions[] = {
    {"layouts", list_layouts, METH_NOARGS, NULL},
    {"constants", list_constants, METH_NOARGS, NULL},
    {"get_isa", get_isa, METH_NOARGS, "The name of the instruction set in use."},
    {"set_isa", set_isa, METH_O,
     "Chooses the instruction set for all later calls, such as \"avx2\" or \"scalar\"; None: the best."},
    {"know", know, METH_VARARGS, NULL},
    {"names", list_names, METH_NOARGS, NULL},
    {"_fork", hear_of_fork, METH_O, NULL},
    {NULL, NULL, 0, NULL}};

static bool add(PyObject *module, const char *name, PyObject *value) {
    return value && PyModule_AddObjectRef(module, name, value) == 0;
}

/* Each call is a function whose `self` is its signature. */
static bool add_calls(PyObject *module) {
    static PyMethodDef methods[CALLS];
    for (int k = 0; k < CALLS; k++) {
        if (!signatures[k].call && !read_signature(&calls[k], &signatures[k])) {
            PyErr_Format(PyExc_ImportError, "%s: %s", calls[k].name, calls[k].arguments);
            return false;
        }
        methods[k] =
            (PyMethodDef){calls[k].name, (PyCFunction)(void (*)(void))invoke, METH_FASTCALL, calls[k].arguments};
        PyObject *const capsule = PyCapsule_New(&signatures[k], NULL, NULL);
        PyObject *const function = capsule ? PyCFunction_NewEx(&methods[k], capsule, NULL) : NULL;
        const bool added = add(module, calls[k].name, function);
        Py_XDECREF(function);
        Py_XDECREF(capsule);
        if (!added)
            return false;
    }
    return true;
}

/* With a status, the error's as long as none is set, it has the library's members. */
static PyObject *make_error(const char *name, const char *doc, PyObject *base, PyObject *other, narc_status status) {
    PyObject *const bases = other ? PyTuple_Pack(2, base, other) : PyTuple_Pack(1, base);
    PyObject *const members =
        status ? Py_BuildValue("{sssisd}", "status", narc_status_name(status), "index", 0, "value", 0.0) : PyDict_New();
    PyObject *const made = bases && members ? PyErr_NewExceptionWithDoc(name, doc, bases, members) : NULL;
    Py_XDECREF(members);
    Py_XDECREF(bases);
    return made;
}

static int prepare(PyObject *module) {
    if (PyInterpreterState_GetID(PyInterpreterState_Get()) != 0) {
        PyErr_SetString(PyExc_ImportError, "narc does not run in subinterpreters");
        return -1;
    }
    if (!handle_type) {
        handle_type = (PyTypeObject *)PyType_FromSpec(&handle_spec);
        error_class = make_error(
            "narc.Error", "What the library refuses: `status` is its name, `index` which item, `value` the number.",
            PyExc_ValueError, NULL, NARC_ERROR_ARGUMENT);
        index_error_class = error_class ? make_error("narc.OutOfRange", "A body, shape or pair that there is not.",
                                                     error_class, PyExc_IndexError, NARC_ERROR_INDEX)
                                        : NULL;
        warning_class = make_error("narc.NoAnswer", "Some of what was asked has no answer: narc.validate() says why.",
                                   PyExc_RuntimeWarning, NULL, NARC_OK);
    }
    PyObject *const version = PyUnicode_FromString(narc_version());
    const bool added = add(module, "Handle", (PyObject *)handle_type) && add(module, "Error", error_class) &&
                       add(module, "OutOfRange", index_error_class) && add(module, "NoAnswer", warning_class) &&
                       add(module, "version", version) && add_calls(module);
    Py_XDECREF(version);
    return added ? 0 : -1;
}

static PyModuleDef_Slot slots[] = {{Py_mod_exec, (void *)prepare}, {0, NULL}};
static PyModuleDef definition = {PyModuleDef_HEAD_INIT, .m_name = "narc._narc", .m_methods = functions,
                                 .m_slots = slots};

PyMODINIT_FUNC PyInit__narc(void) { return PyModuleDef_Init(&definition); }
