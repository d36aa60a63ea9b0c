/* SPDX-License-Identifier: MIT
 *
 * objects.h - collision objects in the files of editors: Tiled's maps and tilesets, R.U.B.E., PhysicsEditor.
 */
#ifndef NARC_TOOL_OBJECTS_H
#define NARC_TOOL_OBJECTS_H

#include "narc_fit.h"

/* Gives the path that an object of this name is to be drawn with, y up. */
typedef narc_path *begin_object(const char *name, void *context);

/* Draws each object: those of a body, a tile or a layer of several are NAME/1, NAME/2 ... False: it is no such file, and nothing
 * is told. Of XML only Tiled's is known. */
bool read_objects(const char *file, const char *bytes, size_t size, begin_object *begin, void *context);

#endif
