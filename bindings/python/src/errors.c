/* SPDX-License-Identifier: MIT
 *
 * errors.c - what the library refuses, as Python's exceptions.
 */
#include "errors.h"

#include <stdbool.h>

PyObject *error_class, *index_error_class;

PyObject *raise_error(const narc_error *error, narc_status status) {
    if (status == NARC_ERROR_MEMORY)
        return PyErr_NoMemory();
    PyObject *const of = status == NARC_ERROR_INDEX ? index_error_class : error_class;
    PyObject *const raised =
        PyObject_CallFunction(of, "s", error->message[0] ? error->message : narc_status_name(status));
    PyObject *const values[] = {PyUnicode_FromString(narc_status_name(status)), PyLong_FromSize_t(error->index),
                                PyFloat_FromDouble(error->value)};
    static const char *const names[] = {"status", "index", "value"};
    bool ok = raised != NULL;
    for (int k = 0; k < 3; k++) {
        ok = ok && values[k] && PyObject_SetAttrString(raised, names[k], values[k]) == 0;
        Py_XDECREF(values[k]);
    }
    if (ok)
        PyErr_SetObject(of, raised);
    Py_XDECREF(raised);
    return NULL;
}
