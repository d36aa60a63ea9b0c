/* SPDX-License-Identifier: MIT
 *
 * errors.h - what the library refuses, as Python's exceptions.
 */
#ifndef NARC_ERRORS_H
#define NARC_ERRORS_H

#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <narc_shapes.h>

/* narc.Error and narc.OutOfRange; the module that makes or finds them sets them. */
extern PyObject *error_class, *index_error_class;

/* Raises what a status says, with the error's message and numbers. Returns NULL. */
PyObject *raise_error(const narc_error *error, narc_status status);

#endif
