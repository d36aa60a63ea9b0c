/* SPDX-License-Identifier: MIT
 *
 * frame.c - columns from buffers, and structures from what Python has.
 */
#include "frame.h"

#include <math.h>
#include <string.h>

#include "format.h"
#include "threads.h"

void frame_begin(frame *f) {
    memset(f, 0, offsetof(frame, lengths));
    for (int k = 0; k < MOST_GROUPS; k++)
        f->lengths[k] = -1;
    f->buffer_count = f->memory_count = 0;
    f->arena_used = 0;
}

void frame_end(frame *f) {
    for (int k = 0; k < f->buffer_count; k++)
        PyBuffer_Release(&f->buffers[k]);
    for (int k = 0; k < f->memory_count; k++)
        PyMem_Free(f->memory[k]);
}

void *frame_allocate(frame *f, size_t size) {
    const size_t rounded = (size + 15) / 16 * 16;
    if (rounded > ARENA - f->arena_used) {
        PyErr_Format(PyExc_ValueError, "%s: too many values", frame_name(f));
        return NULL;
    }
    void *const room = f->arena + f->arena_used;
    f->arena_used += rounded;
    return memset(room, 0, rounded);
}

const char *frame_name(frame *f) {
    size_t length = 0;
    f->name[0] = 0;
    for (int k = 0; k < f->depth && length < sizeof f->name; k++)
        length += (size_t)PyOS_snprintf(f->name + length, sizeof f->name - length, k ? ".%s" : "%s", f->names[k]);
    return f->name;
}

/* Something that is within what is read; there are few structures in structures. */
static void enter(frame *f, const char *name) {
    if (f->depth < MOST_NAMES)
        f->names[f->depth++] = name;
}

Py_buffer *frame_view(frame *f, PyObject *object, int flags) {
    if (f->buffer_count == MOST_BUFFERS) {
        PyErr_Format(PyExc_ValueError, "%s: too many columns", frame_name(f));
        return NULL;
    }
    Py_buffer *const view = &f->buffers[f->buffer_count];
    if (PyObject_GetBuffer(object, view, flags)) {
        PyObject *kind, *value, *trace;
        PyErr_Fetch(&kind, &value, &trace);
        PyErr_Format(flags & PyBUF_WRITABLE ? PyExc_ValueError : PyExc_TypeError, "%s: %S", frame_name(f),
                     value ? value : kind);
        Py_XDECREF(kind);
        Py_XDECREF(value);
        Py_XDECREF(trace);
        return NULL;
    }
    f->buffer_count++;
    return view;
}

/* ------------------------------------------------------------------------------------------------ known rows */

enum { MOST_KNOWN = 32, MOST_FIELDS = 16 };

/* Types whose format NumPy need not write down, which takes it long: rows of structures, and numbers. */
typedef struct kind {
    PyObject *dtype;
    const narc_layout *layout; /* NULL: one number */
    item item;
} kind;

static kind known[MOST_KNOWN];
static int known_count;
static PyObject *dtype_name;

bool frame_know(PyObject *dtype, const char *name) {
    kind new = {.dtype = dtype, .layout = narc_find_layout(name)};
    if (!dtype_name)
        dtype_name = PyUnicode_InternFromString("dtype");
    if (!dtype_name || (!new.layout && !find_item(name, NULL, &new.item)))
        return false;
    int k = 0; /* a module that is loaded again has types of its own */
    while (k < known_count && (known[k].layout != new.layout || known[k].item.code != new.item.code))
        k++;
    if (k == MOST_KNOWN)
        return false;
    known_count += k == known_count;
    PyObject *const old = known[k].dtype;
    Py_INCREF(dtype);
    known[k] = new;
    Py_XDECREF(old);
    return true;
}

/* What an array says that its items are, if that is known. */
static const kind *find_known(PyObject *array) {
    PyObject *const dtype = known_count ? PyObject_GetAttr(array, dtype_name) : NULL;
    const kind *found = NULL;
    if (!dtype)
        PyErr_Clear();
    for (int k = 0; dtype && !found && k < known_count; k++)
        if (known[k].dtype == dtype)
            found = &known[k];
    Py_XDECREF(dtype);
    return found;
}

/* ------------------------------------------------------------------------------------------------ columns */

/* Numbers in memory: from a buffer, or a single one with a stride of 0. */
typedef struct numbers {
    const char *base;
    Py_ssize_t stride, count; /* count -1: one for all */
    item item;
} numbers;

static bool is_member(const char *type, const char *of) { return strcmp(type, of) == 0; }

/* What a column is of, by the type's first letter after "narc_": floats, positions, bytes, words, or an index. */
static char column_code(const char *type) { return type[5]; }

/* A whole number of any size, which may not be aligned; below 0 as its complement. */
static uint64_t read_whole(const char *at, size_t size, bool with_sign) {
    uint8_t one;
    uint16_t two;
    uint32_t four;
    uint64_t eight;
    switch (size) {
    case 1:
        memcpy(&one, at, sizeof one);
        return with_sign ? (uint64_t)(int64_t)(int8_t)one : one;
    case 2:
        memcpy(&two, at, sizeof two);
        return with_sign ? (uint64_t)(int64_t)(int16_t)two : two;
    case 4:
        memcpy(&four, at, sizeof four);
        return with_sign ? (uint64_t)(int64_t)(int32_t)four : four;
    default:
        memcpy(&eight, at, sizeof eight);
        return eight;
    }
}

/* Whole numbers of another size, converted to a column's own. NULL, with an error: Python's, or the frame's own. */
static const void *convert(frame *f, const numbers *from, size_t size) {
    const Py_ssize_t count = from->count < 0 ? 1 : from->count;
    char *const made = f->memory_count < MOST_BUFFERS ? PyMem_Malloc((size_t)count * size + 1) : NULL;
    if (!made)
        return PyErr_NoMemory();
    f->memory[f->memory_count++] = made;
    const bool with_sign = is_signed(&from->item);
    for (Py_ssize_t k = 0; k < count; k++) {
        const uint64_t value = read_whole(from->base + k * from->stride, from->item.size, with_sign);
        if ((with_sign && value >> 63) || (size < 8 && value >> 8 * size)) {
            const char *const format = with_sign ? "%s: item %zd is %lld" : "%s: item %zd is %llu";
            f->error = (narc_error){.status = NARC_ERROR_INDEX,
                                    .index = (size_t)k,
                                    .value = with_sign ? (double)(int64_t)value : (double)value};
            PyOS_snprintf(f->error.message, sizeof f->error.message, format, frame_name(f), k,
                          (unsigned long long)value);
            return NULL;
        }
        const uint32_t four = (uint32_t)value;
        const uint8_t one = (uint8_t)value;
        memcpy(made + (size_t)k * size,
               size == 8   ? (const void *)&value
               : size == 4 ? (const void *)&four
                           : &one,
               size);
    }
    return made;
}

/* Makes a column of numbers, which belong to a group of columns of one length. */
static bool set_column(frame *f, const char *type, void *column, const numbers *from, unsigned char group) {
    const item *const i = &from->item;
    const char code = column_code(type), *wanted = "float32";
    bool fits = false, whole = false;
    size_t size = 4;
    if (code == 'f') {
        fits = i->code == 'f';
    } else if (code == 'p') {
        wanted = "float32 or float64";
        fits = i->code == 'f' || i->code == 'd';
        size = i->size;
    } else if (code == 'b') {
        wanted = "uint8 or bool";
        whole = is_integer(i);
        fits = i->code == 'B' || i->code == '?';
        size = 1;
    } else { /* whole numbers are converted */
        size = code == 'w' ? 8 : 4;
        wanted = size == 8 ? "uint64" : "uint32";
        whole = is_integer(i);
        fits = whole && i->size == size && !is_signed(i);
    }
    if (is_foreign(i) || !(fits || whole)) {
        PyErr_Format(PyExc_TypeError, "%s: %s is wanted, not %s%s", frame_name(f), wanted, describe_item(i),
                     is_foreign(i) ? " in another order of bytes" : "");
        return false;
    }
    if (from->count >= 0 && group) {
        if (f->lengths[group] < 0)
            f->lengths[group] = from->count;
        if (f->lengths[group] != from->count) {
            PyErr_Format(PyExc_ValueError, "%s has %zd items, where there are %zd", frame_name(f), from->count,
                         f->lengths[group]);
            return false;
        }
    }
    if (from->count > 0 && (size_t)from->count > f->largest)
        f->largest = (size_t)from->count;
    const char *base = from->base;
    Py_ssize_t stride = from->stride;
    if (!fits || ((uintptr_t)base | (size_t)stride) % size != 0) {
        if (!whole) {
            PyErr_Format(PyExc_ValueError, "%s: items of %s are not aligned", frame_name(f), describe_item(i));
            return false;
        }
        base = convert(f, from, size);
        stride = from->count < 0 ? 0 : (Py_ssize_t)size;
        if (!base)
            return false;
    }
    const narc_byte_column plain = {(const uint8_t *)base, stride};
    if (code == 'p')
        *(narc_position_column *)column =
            (narc_position_column){base, stride, i->code == 'd' ? NARC_FLOAT64 : NARC_FLOAT32};
    else /* all columns begin alike */
        memcpy(column, &plain, sizeof plain);
    return true;
}

/* Python's numbers, and NumPy's. */
static unsigned long long read_unsigned(PyObject *given) {
    PyObject *const whole = PyNumber_Index(given);
    const unsigned long long value = whole ? PyLong_AsUnsignedLongLong(whole) : 0;
    Py_XDECREF(whole);
    return value;
}

bool frame_refuse(frame *f, const char *wanted, PyObject *given) {
    const bool is_number = PyErr_ExceptionMatches(PyExc_OverflowError);
    PyErr_Clear();
    if (is_number)
        PyErr_Format(PyExc_ValueError, "%s: %R is out of range", frame_name(f), given);
    else
        PyErr_Format(PyExc_TypeError, "%s: %s is wanted, not %R", frame_name(f), wanted, given);
    return false;
}

/* One number for all: as the column's own type. */
static bool set_constant(frame *f, const char *type, void *column, PyObject *given) {
    numbers one = {.count = -1, .item = {.order = '@', .size = 8, .code = 'd'}};
    char *const room = frame_allocate(f, 8);
    if (!room)
        return false;
    const char code = column_code(type);
    if (code == 'f' || code == 'p') {
        const double value = PyFloat_AsDouble(given);
        const float narrow = (float)value;
        if (code == 'f') {
            one.item.code = 'f', one.item.size = 4;
            memcpy(room, &narrow, sizeof narrow);
        } else
            memcpy(room, &value, sizeof value);
    } else {
        const unsigned long long value = read_unsigned(given);
        one.item.code = 'Q';
        memcpy(room, &value, sizeof value);
        if (code == 'b') {
            const uint8_t byte = (uint8_t)value;
            if (value > UINT8_MAX)
                PyErr_SetNone(PyExc_OverflowError);
            one.item.code = 'B', one.item.size = 1;
            memcpy(room, &byte, 1);
        }
    }
    if (PyErr_Occurred())
        return frame_refuse(f, "a number or an array", given);
    one.base = room;
    return set_column(f, type, column, &one, 0);
}

/* An array that a list becomes: of numbers that a column of this type can have. */
static PyObject *make_array(frame *f, const char *type, PyObject *list) {
    const char code = column_code(type), *const dtype = code == 'f' ? "f4" : code == 'p' ? "f8" : "i8";
    PyObject *const tables = PyImport_ImportModule("narc._tables");
    PyObject *const made = tables ? PyObject_CallMethod(tables, "as_array", "Oss", list, dtype, frame_name(f)) : NULL;
    Py_XDECREF(tables);
    return made;
}

static bool is_list(PyObject *object) { return PyList_Check(object) || PyTuple_Check(object); }

/* The buffer of an array, or of a list that is made into one, and what its numbers are. */
static const Py_buffer *view_numbers(frame *f, const char *type, PyObject *given, item *out) {
    PyObject *const made = is_list(given) ? make_array(f, type, given) : NULL;
    if (is_list(given) && !made)
        return NULL;
    const kind *const known_as = find_known(made ? made : given);
    const bool is_known = known_as && !known_as->layout;
    const Py_buffer *const view = frame_view(f, made ? made : given, is_known ? PyBUF_STRIDED_RO : PyBUF_RECORDS_RO);
    Py_XDECREF(made); /* the view keeps it */
    if (!view)
        return NULL;
    if (is_known ? (size_t)view->itemsize == known_as->item.size
                 : find_item(view->format, NULL, out) && out->count == 1) {
        if (is_known)
            *out = known_as->item;
        return view;
    }
    PyErr_Format(PyExc_TypeError, "%s: an array of numbers is wanted, not of the format %s", frame_name(f),
                 view->format ? view->format : "B");
    return NULL;
}

/* Column `which` of an array of two, or of a plain one with 0. */
static bool take_column(frame *f, const char *type, void *column, const Py_buffer *view, const item *of, int width,
                        int which, unsigned char group) {
    numbers from = {.base = (const char *)view->buf, .count = -1, .item = *of};
    if (view->ndim == 0 && width == 1)
        return set_column(f, type, column, &from, group);
    if (view->ndim == 1 && view->shape[0] == 0) { /* a list of nothing */
        from.count = 0;
        return set_column(f, type, column, &from, group);
    }
    if (view->ndim == 2 && width == 2 && view->shape[1] != 2) {
        PyErr_Format(PyExc_ValueError, "%s: the shape is to be (n, 2), not (%zd, %zd)", frame_name(f), view->shape[0],
                     view->shape[1]);
        return false;
    }
    if (view->ndim != width) {
        PyErr_Format(PyExc_ValueError, "%s: the shape is to be %s, not one of %d dimensions", frame_name(f),
                     width == 1 ? "(n,)" : "(n, 2)", view->ndim);
        return false;
    }
    from.count = view->shape[0];
    from.stride = view->strides ? view->strides[0] : view->itemsize;
    if (width == 2)
        from.base += which * view->strides[1];
    return set_column(f, type, column, &from, group);
}

bool frame_column(frame *f, const char *type, void *column, size_t *out_count, PyObject *given, unsigned char group) {
    item one;
    *out_count = 1;
    if (given == Py_None)
        return true;
    if (!PyObject_CheckBuffer(given) && !is_list(given))
        return set_constant(f, type, column, given);
    const Py_buffer *const view = view_numbers(f, type, given, &one);
    if (view && view->ndim == 0 && column_code(type) == 'f' && one.code != 'f') /* as Python's own number */
        return set_constant(f, type, column, given);
    if (!view || !take_column(f, type, column, view, &one, 1, 0, group))
        return false;
    *out_count = view->ndim ? (size_t)view->shape[0] : 1;
    return true;
}

/* ------------------------------------------------------------------------------------------------ structures */

static const narc_member *find_member(const narc_layout *layout, const char *name) {
    for (size_t k = 0; k < layout->member_count; k++)
        if (layout->members[k].name[0] == name[0] && strcmp(layout->members[k].name, name) == 0)
            return &layout->members[k];
    return NULL;
}

static bool is_column(const narc_member *member) {
    const size_t length = strlen(member->type);
    return length > 7 && strcmp(member->type + length - 7, "_column") == 0;
}

/* The member that is the length of a column, such as narc_query.selection_count; NULL: it has that of a group. */
static const narc_member *find_count(const narc_layout *layout, const narc_member *column) {
    char name[64];
    PyOS_snprintf(name, sizeof name, "%s_count", column->name);
    return find_member(layout, name);
}

static unsigned char group_of(const narc_layout *layout, const narc_member *member, unsigned char group) {
    if (find_count(layout, member))
        return 0;
    return is_member(layout->name, "narc_owners") && is_member(member->name, "owner") ? group_number('B') : group;
}

static bool set_number(frame *f, void *place, const char *type, size_t size, PyObject *given) {
    if (is_member(type, "float")) {
        const double value = PyFloat_AsDouble(given);
        *(float *)place = (float)value;
        if (isfinite(value) && (isinf((float)value) || ((float)value == 0 && value != 0)) && !PyErr_Occurred())
            PyErr_SetNone(PyExc_OverflowError);
    } else if (is_member(type, "double")) {
        *(double *)place = PyFloat_AsDouble(given);
    } else {
        const unsigned long long value = read_unsigned(given);
        if (size == 4 && value <= UINT32_MAX)
            *(uint32_t *)place = (uint32_t)value;
        else if (size == 8)
            *(uint64_t *)place = value;
        else if (!PyErr_Occurred())
            PyErr_SetString(PyExc_OverflowError, "");
    }
    return !PyErr_Occurred() || frame_refuse(f, "a number", given);
}

static bool set_member(frame *f, const narc_layout *layout, const narc_member *m, char *structure, PyObject *given,
                       unsigned char group) {
    void *const place = structure + m->offset;
    if (given == Py_None)
        return true;
    if (is_column(m)) {
        const unsigned char own = group_of(layout, m, group);
        size_t count;
        const bool is_set = frame_column(f, m->type, place, &count, given, own);
        if (is_set && !own) /* its length is a member, too */
            *(size_t *)(structure + find_count(layout, m)->offset) = count;
        return is_set;
    }
    if (is_member(m->type, "const narc_workers *"))
        return frame_workers(f, given, place);
    const bool pointer = strncmp(m->type, "const narc_", 11) == 0;
    char name[64];
    PyOS_snprintf(name, sizeof name, "%s", pointer ? m->type + 6 : m->type);
    name[strcspn(name, " ")] = 0;
    const narc_layout *const inner = narc_find_layout(name);
    if (inner && inner->member_count) {
        void *const room = pointer ? frame_allocate(f, inner->size) : place;
        if (!room)
            return false;
        if (pointer)
            *(void **)place = room;
        /* pairs, and another set of bodies, have lengths of their own */
        const unsigned char own = is_member(m->name, "other_bodies") ? group_number('O')
                                  : is_member(m->name, "pairs")      ? group_number('P')
                                                                     : group;
        return frame_fill(f, inner, room, given, own);
    }
    /* rows lie where arrays have them */
    if (strchr(m->type, '*') || m->count > 1 || is_member(m->name, "row_stride")) {
        PyErr_Format(PyExc_TypeError, "%s can't be given", frame_name(f));
        return false;
    }
    return set_number(f, place, m->type, m->size, given);
}

/* Members x and y, or what is called `stem`_x and `stem`_y; or a and b. */
static bool find_two(const narc_layout *layout, const char *stem, const narc_member *two[2]) {
    const size_t length = strlen(stem);
    const bool is_bare = length == 2 && strchr("xa", stem[0]);
    char name[64];
    if (length + 3 > sizeof name)
        return false;
    memcpy(name, stem, length);
    for (int k = 0; k < 2; k++) {
        name[is_bare ? 0 : length] = is_bare ? stem[k] : '_';
        name[is_bare ? 1 : length + 1] = is_bare ? 0 : "xy"[k];
        name[is_bare ? 2 : length + 2] = 0;
        two[k] = find_member(layout, name);
        if (!two[k] || !is_column(two[k]))
            return false;
    }
    return true;
}

/* Two columns from an array (n, 2). */
static bool fill_two(frame *f, const narc_member *const two[2], char *structure, PyObject *given, unsigned char group) {
    item one;
    const Py_buffer *const view = view_numbers(f, two[0]->type, given, &one);
    for (int k = 0; view && k < 2; k++)
        if (!take_column(f, two[k]->type, structure + two[k]->offset, view, &one, 2, k, group))
            return false;
    return view != NULL;
}

static bool find_field(const char *format, const narc_layout *rows, const char *name, item *out) {
    if (!rows)
        return find_item(format, name, out);
    const narc_member *const m = find_member(rows, name);
    const bool is_number = m && strchr("fdu", m->type[0]) && m->count == 1;
    if (is_number)
        *out = (item){.code = m->type[0] == 'u' ? 'I' : m->type[0],
                      .order = '@',
                      .offset = m->offset,
                      .size = m->size,
                      .count = 1};
    return is_number;
}

/* Which fields of records the columns of a structure are, `rows` what the records are, if that is known, or else as `format`
 * says. False: there are none. */
typedef struct plan {
    const narc_layout *layout, *rows;
    size_t count;
    struct {
        const narc_member *member;
        item item;
    } fields[MOST_FIELDS];
} plan;

static void make_plan(plan *out, const char *format, const narc_layout *layout, const narc_layout *rows) {
    out->layout = layout;
    out->rows = rows;
    out->count = 0;
    for (size_t k = 0; k < layout->member_count && out->count < MOST_FIELDS; k++)
        if (is_column(&layout->members[k]) &&
            find_field(format, rows, layout->members[k].name, &out->fields[out->count].item))
            out->fields[out->count++].member = &layout->members[k];
}

/* That of known rows is made once. */
static const plan *find_plan(plan *own, const char *format, const narc_layout *layout, const narc_layout *rows) {
    static plan plans[16];
    const size_t most = sizeof plans / sizeof *plans;
    size_t k = 0;
    while (rows && k < most && plans[k].layout && (plans[k].layout != layout || plans[k].rows != rows))
        k++;
    plan *const found = rows && k < most ? &plans[k] : own;
    if (found == own || !found->layout)
        make_plan(found, format, layout, rows);
    return found;
}

static bool fill_records(frame *f, const narc_layout *layout, char *structure, const Py_buffer *view,
                         const narc_layout *rows, unsigned char group) {
    plan own;
    const plan *const fields = find_plan(&own, view->format, layout, rows);
    for (size_t k = 0; k < fields->count; k++) {
        const narc_member *const m = fields->fields[k].member;
        const numbers from = {.base = (const char *)view->buf + fields->fields[k].item.offset,
                              .stride = view->strides[0],
                              .count = view->shape[0],
                              .item = fields->fields[k].item};
        enter(f, m->name);
        const bool is_set = set_column(f, m->type, structure + m->offset, &from, group);
        f->depth--;
        if (!is_set)
            return false;
    }
    if (!fields->count)
        PyErr_Format(PyExc_TypeError, "%s: records have no field of %s, their format is %s", frame_name(f),
                     layout->name, rows ? rows->name : view->format);
    return fields->count > 0;
}

static bool fill_mapping(frame *f, const narc_layout *layout, char *structure, PyObject *given, unsigned char group) {
    Py_ssize_t at = 0;
    PyObject *key, *value;
    while (PyDict_Next(given, &at, &key, &value)) {
        const char *const name = PyUnicode_AsUTF8AndSize(key, NULL);
        const narc_member *two[2], *const m = name ? find_member(layout, name) : NULL;
        if (!name)
            return false;
        if (!m && !find_two(layout, name, two)) {
            PyErr_Format(PyExc_TypeError, "%s: there is no %s", frame_name(f), name);
            return false;
        }
        Py_INCREF(key); /* code of the value's own may change the mapping */
        Py_INCREF(value);
        enter(f, name);
        const bool is_set = value == Py_None || (m ? set_member(f, layout, m, structure, value, group)
                                                   : fill_two(f, two, structure, value, group));
        f->depth--;
        Py_DECREF(value);
        Py_DECREF(key);
        if (!is_set)
            return false;
    }
    return true;
}

/* All members, which are numbers: a place is (x, y). */
static bool fill_tuple(frame *f, const narc_layout *layout, char *structure, PyObject *given) {
    if (PyTuple_Size(given) != (Py_ssize_t)layout->member_count) {
        PyErr_Format(PyExc_TypeError, "%s: %zd numbers, where there are to be %zd", frame_name(f), PyTuple_Size(given),
                     (Py_ssize_t)layout->member_count);
        return false;
    }
    for (size_t k = 0; k < layout->member_count; k++) {
        const narc_member *const m = &layout->members[k];
        if (strchr(m->type, '*') || is_column(m) || m->count > 1 ||
            !set_number(f, structure + m->offset, m->type, m->size, PyTuple_GetItem(given, (Py_ssize_t)k))) {
            if (!PyErr_Occurred())
                PyErr_Format(PyExc_TypeError, "%s can't be a tuple", frame_name(f));
            return false;
        }
    }
    return true;
}

/* Bodies of which nothing is said but where they are. */
static void leave_unturned(narc_bodies *bodies) {
    static const float one = 1, zero = 0;
    static const uint32_t first = 0;
    if (!bodies->cosine.base && !bodies->sine.base) {
        bodies->cosine.base = &one;
        bodies->sine.base = &zero;
    }
    if (!bodies->shape.base)
        bodies->shape.base = &first;
}

/* Queries have it, at their end; and a lookup by name takes longer than all the rest. */
static const narc_member *find_skipped(const narc_layout *layout) {
    for (size_t k = layout->member_count; k-- > 0;)
        if (layout->members[k].name[0] == 'o' && is_member(layout->members[k].name, "out_skipped"))
            return &layout->members[k];
    return NULL;
}

bool frame_fill(frame *f, const narc_layout *layout, void *structure, PyObject *given, unsigned char group) {
    const narc_member *const skipped = find_skipped(layout), *two[2];
    if (skipped)
        *(size_t **)((char *)structure + skipped->offset) = &f->skipped;
    if (given == Py_None)
        return true;
    const kind *const known_as = is_list(given) || PyDict_Check(given) ? NULL : find_known(given);
    const narc_layout *const rows = known_as ? known_as->layout : NULL;
    const bool has_two = !rows && (find_two(layout, "ab", two) || find_two(layout, "xy", two));
    bool is_filled = false;
    if (PyDict_Check(given)) {
        is_filled = fill_mapping(f, layout, structure, given, group);
    } else if (has_two && (known_as ? !rows : is_list(given))) {
        is_filled = fill_two(f, two, structure, given, group);
    } else if (PyTuple_Check(given)) {
        is_filled = fill_tuple(f, layout, structure, given);
    } else {
        const Py_buffer *const view = frame_view(f, given, rows ? PyBUF_STRIDED_RO : PyBUF_RECORDS_RO);
        if (!view)
            return false;
        if (rows && (size_t)view->itemsize != rows->size)
            PyErr_Format(PyExc_TypeError, "%s: items of %zd bytes are no rows of %s", frame_name(f), view->itemsize,
                         rows->name);
        else if (view->ndim == 1 && (rows || (view->format && view->format[0] == 'T')))
            is_filled = fill_records(f, layout, structure, view, rows, group);
        else if (has_two)
            is_filled = fill_two(f, two, structure, given, group);
        else
            PyErr_Format(PyExc_TypeError, "%s: records or a mapping of columns are wanted", frame_name(f));
    }
    if (!is_filled)
        return false;
    if (is_member(layout->name, "narc_bodies"))
        leave_unturned(structure);
    if (layout->members[0].name[0] == 'c' && is_member(layout->members[0].name, "count"))
        *(size_t *)structure = f->lengths[group] < 0 ? 1 : (size_t)f->lengths[group];
    return true;
}

/* ------------------------------------------------------------------------------------------------ workers and rows */

bool frame_workers(frame *f, PyObject *given, const narc_workers **out_workers) {
    const unsigned long long count = given == Py_None ? 1 : read_unsigned(given);
    *out_workers = NULL;
    if (PyErr_Occurred() || count == 0 || count > MOST_THREADS) {
        PyErr_Clear();
        PyErr_Format(PyExc_ValueError, "threads is %R, it must be 1 to %d", given, (int)MOST_THREADS);
        return false;
    }
    if (count == 1)
        return true;
    narc_workers *const workers = frame_allocate(f, sizeof *workers);
    if (workers)
        *workers = (narc_workers){.count = (unsigned)count, .run = run_in_threads};
    *out_workers = workers;
    return workers != NULL;
}

/* Are the buffer's items rows of this layout? */
static bool are_rows(const Py_buffer *view, const narc_layout *layout) {
    item found;
    if (view->ndim == 2) { /* numbers of one type */
        bool all = (size_t)(view->shape[1] * view->itemsize) == layout->size && find_item(view->format, NULL, &found) &&
                   !is_foreign(&found) && strchr("df", found.code);
        for (size_t k = 0; all && k < layout->member_count; k++)
            all = is_member(layout->members[k].type, found.code == 'd' ? "double" : "float");
        return all;
    }
    bool are = view->ndim <= 1 && (size_t)view->itemsize == layout->size;
    for (size_t k = 0; are && k < layout->member_count; k++)
        are = find_item(view->format, layout->members[k].name, &found) && !is_foreign(&found) &&
              found.offset == layout->members[k].offset && found.size == layout->members[k].size;
    return are;
}

/* The type of a column of the numbers that rows begin with. */
static const char *first_column(const narc_layout *layout) {
    return is_member(layout->members[0].type, "double") ? "narc_position_column" : "narc_float_column";
}

bool frame_rows(frame *f, const narc_layout *layout, size_t size, size_t alignment, bool writable, PyObject *given,
                void **out_rows, size_t *out_count) {
    *out_rows = NULL;
    *out_count = 0;
    if (given == Py_None)
        return true;
    const bool is_made = layout && !writable && is_list(given);
    PyObject *const made = is_made ? make_array(f, first_column(layout), given) : NULL;
    if (is_made && !made)
        return false;
    const kind *const known_as = made || !layout ? NULL : find_known(given);
    const bool is_known = known_as && known_as->layout == layout;
    const Py_buffer *const view = frame_view(
        f, made ? made : given, PyBUF_C_CONTIGUOUS | (is_known ? 0 : PyBUF_FORMAT) | (writable ? PyBUF_WRITABLE : 0));
    Py_XDECREF(made); /* the view keeps it */
    if (!view)
        return false;
    const Py_ssize_t row = (Py_ssize_t)size;
    const Py_ssize_t rows = view->ndim ? view->shape[0] : 1;
    if (rows > 0 && (layout && !writable && !is_known ? !are_rows(view, layout) : view->len != rows * row)) {
        PyErr_Format(PyExc_TypeError, "%s: rows of %s are wanted, %zd bytes each", frame_name(f),
                     layout ? layout->name : "numbers", row);
        return false;
    }
    if (rows > 0 && (uintptr_t)view->buf % alignment != 0) {
        PyErr_Format(PyExc_ValueError, "%s: its rows lie where no number of theirs may", frame_name(f));
        return false;
    }
    *out_rows = view->buf;
    *out_count = (size_t)rows;
    if (*out_count > f->largest)
        f->largest = *out_count;
    return true;
}
