/* SPDX-License-Identifier: MIT
 *
 * vtk_xml.h - the XML of files for ParaView: a .vtp file is a tree whose arrays are base64, eight bytes that hold the
 * size and then the numbers, in this machine's order; a .pvd file lists the .vtp files of a run.
 */
#ifndef DEM_VTK_XML_H
#define DEM_VTK_XML_H

#include "dem.h"

/* An array of floats or integers that grows, of 4 bytes each. It begins with the size that the file wants. */
typedef struct vtk_column {
    uint32_t *words; /* the first two are the size */
    size_t count, capacity;
    bool failed;
} vtk_column;

void vtk_add_word(vtk_column *c, uint32_t word);
void vtk_add_number(vtk_column *c, double value);
void vtk_add_place(vtk_column *c, double x, double y); /* and z = 0 */

/* Writes the array and empties it. `type` is Float32 or Int32. */
void vtk_write_column(FILE *file, vtk_column *c, const char *type, const char *name, int components);

/* From the beginning to the first section, and behind the last. */
void vtk_write_head(FILE *file, const dem *d, size_t points, size_t vertices, size_t polygons);
void vtk_write_tail(FILE *file);
void vtk_open_section(FILE *file, const char *name);
void vtk_close_section(FILE *file, const char *name);

/* Adds a frame to the list `stem`.pvd. Frames from this one on belong to a run that was given up: they leave the
 * list. Errors, of 512 bytes. */
bool vtk_list_frame(const dem *d, const char *stem, uint64_t frame, char *error);

#endif
