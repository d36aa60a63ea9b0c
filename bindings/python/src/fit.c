/* SPDX-License-Identifier: MIT
 *
 * fit.c - the module narc._fit: outlines from drawings and points, fits, parts and chains of them, and shapes files.
 *
 * A module of its own, since it needs libraries that collision does not (fit/CMakeLists.txt, files/CMakeLists.txt). An outline is a
 * narc_path in a capsule. Arcs and points go to Python as bytes, of which narc/_fits.py makes arrays.
 */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <narc_files.h>
#include <narc_fit.h>

#include "errors.h"

static const char PATH[] = "narc.Outline";

static void free_path(PyObject *capsule) { narc_destroy_path(PyCapsule_GetPointer(capsule, PATH)); }

/* Takes the path, with an error too. */
static PyObject *wrap_path(narc_path *path, narc_status status, const narc_error *error) {
    PyObject *const made = status ? raise_error(error, status) : PyCapsule_New(path, PATH, free_path);
    if (!made)
        narc_destroy_path(path);
    return made;
}

static PyObject *make_bytes(const void *items, size_t size) {
    return PyBytes_FromStringAndSize(items, (Py_ssize_t)size);
}

/* ------------------------------------------------------------------------------------------------ outlines */

/* read(kind, data, silhouette, threshold, element): an outline of a file's bytes. */
static PyObject *read_outline(PyObject *self, PyObject *given) {
    const char *kind;
    Py_buffer data;
    narc_image_request request = {0};
    int silhouette;
    narc_path *path = NULL;
    narc_error error = {0};
    (void)self;
    if (!PyArg_ParseTuple(given, "sy*idz", &kind, &data, &silhouette, &request.threshold, &request.element))
        return NULL;
    request.silhouette = (narc_silhouette)silhouette;
    const size_t size = (size_t)data.len;
    PyThreadState *const state = PyEval_SaveThread();
    narc_status status = narc_create_path(&path);
    if (status == NARC_OK)
        status = strcmp(kind, "svg") == 0   ? narc_read_svg(data.buf, size, &request, path, &error)
                 : strcmp(kind, "png") == 0 ? narc_read_png(data.buf, size, &request, path, &error)
                 : strcmp(kind, "dxf") == 0
                     ? narc_read_dxf(data.buf, size, &(narc_dxf_request){.layer = request.element}, path, &error)
                 : strcmp(kind, "csv") == 0 ? narc_read_csv(data.buf, size, path, &error)
                                            : narc_read_json(data.buf, size, path, &error);
    PyEval_RestoreThread(state);
    PyBuffer_Release(&data);
    return wrap_path(path, status, &error);
}

/* read_glyph(font, character) */
static PyObject *read_glyph(PyObject *self, PyObject *given) {
    Py_buffer data;
    unsigned character;
    narc_font *font = NULL;
    narc_path *path = NULL;
    narc_error error = {0};
    (void)self;
    if (!PyArg_ParseTuple(given, "y*I", &data, &character))
        return NULL;
    narc_status status = narc_create_path(&path);
    status = status ? status : narc_open_font(data.buf, (size_t)data.len, &font, &error);
    status = status ? status : narc_read_glyph(font, character, path, &error);
    narc_close_font(font);
    PyBuffer_Release(&data);
    return wrap_path(path, status, &error);
}

/* draw(points, ends): contours of lines, points as pairs of doubles. */
static PyObject *draw(PyObject *self, PyObject *given) {
    Py_buffer points, ends;
    narc_path *path = NULL;
    narc_error error = {0};
    (void)self;
    if (!PyArg_ParseTuple(given, "y*y*", &points, &ends))
        return NULL;
    narc_status status = narc_create_path(&path);
    const narc_point *const point = points.buf;
    const uint64_t *const end = ends.buf;
    for (size_t k = 0, i = 0; k < (size_t)ends.len / sizeof *end && !status; k++)
        for (size_t first = i; i < end[k] && i < (size_t)points.len / sizeof *point && !status; i++)
            status = i == first ? narc_move_to(path, &point[i], &error) : narc_line_to(path, &point[i], &error);
    PyBuffer_Release(&points);
    PyBuffer_Release(&ends);
    return wrap_path(path, status, &error);
}

/* contours(outline, flatness): (points, ends, flatness) */
static PyObject *list_contours(PyObject *self, PyObject *given) {
    PyObject *outline;
    double flatness;
    narc_contours contours;
    narc_error error = {0};
    (void)self;
    if (!PyArg_ParseTuple(given, "Od", &outline, &flatness))
        return NULL;
    const narc_path *const path = PyCapsule_GetPointer(outline, PATH);
    const narc_status status = path ? narc_flatten_path(path, flatness, &contours, &error) : NARC_OK;
    if (!path || status)
        return path ? raise_error(&error, status) : NULL;
    PyObject *const made = Py_BuildValue("NNd", make_bytes(contours.points, contours.point_count * sizeof(narc_point)),
                                         make_bytes(contours.ends, contours.count * sizeof(size_t)), contours.flatness);
    narc_release_contours(&contours);
    return made;
}

/* ------------------------------------------------------------------------------------------------ fits */

/* Ctrl-C ends a fit. */
static bool go_on(size_t done, size_t total, void *context) {
    bool *const stopped = context;
    (void)done, (void)total;
    const PyGILState_STATE state = PyGILState_Ensure();
    *stopped = *stopped || PyErr_CheckSignals() != 0;
    PyGILState_Release(state);
    return !*stopped;
}

/* (arcs, numbers by name) */
static PyObject *describe_fit(const narc_fit_result *result) {
    return Py_BuildValue("N{s(dd)sdsdsdsdsdsdsdsdsdsdsn}",
                         make_bytes(result->arcs, result->arc_count * sizeof(narc_arc)), "origin", result->origin.x,
                         result->origin.y, "area", result->area, "perimeter", result->perimeter, "hull_area",
                         result->hull_area, "hull_perimeter", result->hull_perimeter, "max_distance",
                         result->max_distance, "mean_distance", result->mean_distance, "difference_area",
                         result->difference_area, "clearance", result->clearance, "flatness", result->flatness,
                         "seconds", result->seconds, "edge_count", (Py_ssize_t)result->edge_count);
}

/* fit(outline, arc_count, tolerance, family, goal, flatness, min_radius, keep_origin, quick, starts): (arcs, numbers by name) */
static PyObject *fit(PyObject *self, PyObject *given) {
    PyObject *outline;
    Py_ssize_t count;
    int family, goal, keep, quick;
    bool stopped = false;
    narc_fit_request request = {.progress = go_on, .context = &stopped};
    narc_error error = {0};
    (void)self;
    if (!PyArg_ParseTuple(given, "OndiiddppI", &outline, &count, &request.tolerance, &family, &goal, &request.flatness,
                          &request.min_radius, &keep, &quick, &request.starts))
        return NULL;
    const narc_path *const path = PyCapsule_GetPointer(outline, PATH);
    narc_fit_result *const result = path ? malloc(sizeof *result) : NULL;
    if (!result)
        return path ? PyErr_NoMemory() : NULL;
    request.arc_count = (size_t)count;
    request.family = (narc_fit_family)family;
    request.goal = (narc_fit_goal)goal;
    request.keep_origin = keep != 0;
    request.quick = quick != 0;
    PyThreadState *const state = PyEval_SaveThread();
    const narc_status status = narc_fit_path(path, &request, result, &error);
    PyEval_RestoreThread(state);
    PyObject *made = NULL;
    if (!stopped && status)
        made = raise_error(&error, status);
    else if (!stopped)
        made = describe_fit(result);
    free(result);
    return made;
}

/* cut(outline, most, tolerance, lap, flatness): (outlines, distance, area) */
static PyObject *cut(PyObject *self, PyObject *given) {
    PyObject *outline;
    Py_ssize_t most;
    narc_parts_request request = {0};
    narc_parts parts = {0};
    narc_error error = {0};
    (void)self;
    if (!PyArg_ParseTuple(given, "Onddd", &outline, &most, &request.tolerance, &request.lap, &request.flatness))
        return NULL;
    const narc_path *const path = PyCapsule_GetPointer(outline, PATH);
    if (!path)
        return NULL;
    request.most = (size_t)most;
    PyThreadState *const state = PyEval_SaveThread();
    const narc_status status = narc_cut_path(path, &request, &parts, &error);
    PyEval_RestoreThread(state);
    if (status)
        return raise_error(&error, status);
    PyObject *list = PyList_New(0);
    for (size_t k = 0; k < parts.count && list; k++) {
        PyObject *const part = wrap_path(parts.paths[k], NARC_OK, NULL);
        parts.paths[k] = NULL; /* the capsule's */
        if (!part || PyList_Append(list, part))
            Py_CLEAR(list);
        Py_XDECREF(part);
    }
    PyObject *const made = list ? Py_BuildValue("Ndd", list, parts.distance, parts.area) : NULL;
    narc_release_parts(&parts);
    return made;
}

/* cut_exactly(outline): what fit() returns, of each part */
static PyObject *cut_exactly(PyObject *self, PyObject *outline) {
    narc_fit_result *parts = NULL;
    size_t count = 0, room = 0;
    narc_error error = {0};
    narc_status status = NARC_ERROR_CAPACITY;
    (void)self;
    const narc_path *const path = PyCapsule_GetPointer(outline, PATH);
    if (!path)
        return NULL;
    for (room = 16; status == NARC_ERROR_CAPACITY; room = count) {
        free(parts);
        if (!(parts = malloc(room * sizeof *parts)))
            return PyErr_NoMemory();
        PyThreadState *const state = PyEval_SaveThread();
        status = narc_cut_exactly(path, parts, room, &count, &error);
        PyEval_RestoreThread(state);
    }
    PyObject *list = status ? raise_error(&error, status) : PyList_New(0);
    for (size_t k = 0; k < count && list; k++) {
        PyObject *const part = describe_fit(&parts[k]);
        if (!part || PyList_Append(list, part))
            Py_CLEAR(list);
        Py_XDECREF(part);
    }
    free(parts);
    return list;
}

/* A chain's arcs, of which there are at most 3 a piece and one more. */
static PyObject *describe(const narc_curve_arc *pieces, size_t count, bool closed) {
    narc_arc *const arcs = malloc((3 * count + 1) * sizeof *arcs);
    narc_error error = {0};
    size_t arc_count = 0;
    if (!arcs)
        return PyErr_NoMemory();
    const narc_status status = narc_describe_chain(pieces, count, closed, arcs, &arc_count, &error);
    PyObject *const made = status ? raise_error(&error, status) : make_bytes(arcs, arc_count * sizeof *arcs);
    free(arcs);
    return made;
}

/* chains(outline, tolerance, open, smooth): (arcs of each, distance) */
static PyObject *fit_chains(PyObject *self, PyObject *given) {
    PyObject *outline;
    double tolerance;
    int open, smooth;
    narc_arc_chains chains = {0};
    narc_error error = {0};
    (void)self;
    if (!PyArg_ParseTuple(given, "Odpp", &outline, &tolerance, &open, &smooth))
        return NULL;
    const narc_path *const path = PyCapsule_GetPointer(outline, PATH);
    if (!path)
        return NULL;
    PyThreadState *const state = PyEval_SaveThread();
    const narc_status status = smooth ? narc_fit_chains(path, tolerance, open != 0, &chains, &error)
                                      : narc_fit_fewest_chains(path, tolerance, open != 0, &chains, &error);
    PyEval_RestoreThread(state);
    if (status)
        return raise_error(&error, status);
    PyObject *list = PyList_New(0);
    for (size_t k = 0, first = 0; k < chains.count && list; first = chains.ends[k++]) {
        PyObject *const arcs = describe(chains.arcs + first, chains.ends[k] - first, !open);
        if (!arcs || PyList_Append(list, arcs))
            Py_CLEAR(list);
        Py_XDECREF(arcs);
    }
    PyObject *const made = list ? Py_BuildValue("Nd", list, chains.distance) : NULL;
    narc_release_chains(&chains);
    return made;
}

/* hull(points): its corners */
static PyObject *compute_hull(PyObject *self, PyObject *given) {
    Py_buffer points;
    narc_error error = {0};
    size_t count = 0;
    (void)self;
    if (!PyArg_ParseTuple(given, "y*", &points))
        return NULL;
    narc_point *const corners = malloc((size_t)points.len + 1);
    PyObject *made = NULL;
    const narc_status status =
        !corners ? NARC_ERROR_MEMORY
                 : narc_compute_hull(points.buf, (size_t)points.len / sizeof *corners, corners, &count, &error);
    made = status ? raise_error(&error, status) : make_bytes(corners, count * sizeof *corners);
    free(corners);
    PyBuffer_Release(&points);
    return made;
}

/* ------------------------------------------------------------------------------------------------ files */

/* read_shapes(data): (name, arcs, (x, y) of the origin, form) of each shape */
static PyObject *read_shapes(PyObject *self, PyObject *given) {
    Py_buffer data;
    narc_shape_list *shapes = NULL;
    narc_error error = {0};
    (void)self;
    if (!PyArg_ParseTuple(given, "y*", &data))
        return NULL;
    const narc_status status = narc_read_shapes(data.buf, (size_t)data.len, NULL, NULL, &shapes, &error);
    PyBuffer_Release(&data);
    if (status)
        return raise_error(&error, status);
    PyObject *list = PyList_New(0);
    for (size_t k = 0; k < shapes->count && list; k++) {
        const narc_named_shape *const s = &shapes->items[k];
        PyObject *const item = Py_BuildValue("sN(dd)i", s->name, make_bytes(s->arcs, s->arc_count * sizeof(narc_arc)),
                                             s->origin.x, s->origin.y, (int)s->form);
        if (!item || PyList_Append(list, item))
            Py_CLEAR(list);
        Py_XDECREF(item);
    }
    narc_destroy_shape_list(shapes);
    return list;
}

/* write_shapes(a list of what read_shapes() returns): the file's bytes */
static PyObject *write_shapes(PyObject *self, PyObject *given) {
    PyObject *list;
    narc_error error = {0};
    char *text = NULL;
    size_t size = 0;
    (void)self;
    if (!PyArg_ParseTuple(given, "O!", &PyList_Type, &list))
        return NULL;
    const size_t count = (size_t)PyList_Size(list);
    narc_named_shape *const items = calloc(count + 1, sizeof *items);
    bool ok = items != NULL;
    for (size_t k = 0; k < count && ok; k++) { /* the list keeps names and bytes */
        char *arcs;
        Py_ssize_t length;
        int form;
        PyObject *bytes, *const item = PyList_GetItem(list, (Py_ssize_t)k);
        ok = PyTuple_Check(item) &&
             PyArg_ParseTuple(item, "sS(dd)i", &items[k].name, &bytes, &items[k].origin.x, &items[k].origin.y, &form) &&
             PyBytes_AsStringAndSize(bytes, &arcs, &length) == 0;
        if (ok) {
            items[k].arcs = (const narc_arc *)(const void *)arcs;
            items[k].arc_count = (size_t)length / sizeof(narc_arc);
            items[k].form = (narc_form)form;
        }
    }
    PyObject *made = NULL;
    const narc_status status = ok ? narc_write_shapes(items, count, NULL, &text, &size, &error) : NARC_OK;
    if (ok)
        made = status ? raise_error(&error, status) : make_bytes(text, size);
    else if (!PyErr_Occurred())
        PyErr_SetString(items ? PyExc_TypeError : PyExc_MemoryError, "shapes are tuples of name, arcs, origin, form");
    free(text);
    free(items);
    return made;
}

static PyMethodDef functions[] = {{"read", read_outline, METH_VARARGS, NULL},
                                  {"read_glyph", read_glyph, METH_VARARGS, NULL},
                                  {"draw", draw, METH_VARARGS, NULL},
                                  {"contours", list_contours, METH_VARARGS, NULL},
                                  {"fit", fit, METH_VARARGS, NULL},
                                  {"cut", cut, METH_VARARGS, NULL},
                                  {"cut_exactly", cut_exactly, METH_O, NULL},
                                  {"chains", fit_chains, METH_VARARGS, NULL},
                                  {"hull", compute_hull, METH_VARARGS, NULL},
                                  {"read_shapes", read_shapes, METH_VARARGS, NULL},
                                  {"write_shapes", write_shapes, METH_VARARGS, NULL},
                                  {NULL, NULL, 0, NULL}};

/* The exceptions are those of the other module. */
static int prepare(PyObject *module) {
    (void)module;
    PyObject *const core = PyImport_ImportModule("narc._narc");
    if (core && !error_class) {
        error_class = PyObject_GetAttrString(core, "Error");
        index_error_class = PyObject_GetAttrString(core, "OutOfRange");
    }
    Py_XDECREF(core);
    return core && error_class && index_error_class ? 0 : -1;
}

static PyModuleDef_Slot slots[] = {{Py_mod_exec, (void *)prepare}, {0, NULL}};
static PyModuleDef definition = {PyModuleDef_HEAD_INIT, .m_name = "narc._fit", .m_methods = functions,
                                 .m_slots = slots};

PyMODINIT_FUNC PyInit__fit(void) { return PyModuleDef_Init(&definition); }
