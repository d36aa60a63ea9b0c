/* SPDX-License-Identifier: MIT
 *
 * narc_layouts.h - where the members of public structures lie, and what constants are: for other languages, which read rows
 * and fill options by these tables instead of numbers typed by hand.
 *
 * The tables are made from the headers when the library is compiled, for the processor that it is compiled for. They hold
 * all headers of narc, also those of the other libraries.
 *
 * Example: where narc_contact.separation lies
 *
 *     const narc_layout *contact = narc_find_layout("narc_contact");
 *     for (size_t k = 0; k < contact->member_count; k++)
 *         if (strcmp(contact->members[k].name, "separation") == 0)
 *             offset = contact->members[k].offset;
 *
 * All is constant and may be read by any number of threads.
 */
#ifndef NARC_LAYOUTS_H
#define NARC_LAYOUTS_H

#include <stddef.h>

#include "narc_export.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A member of a structure.
 *   type    as the header has it: "float", "uint32_t", "narc_point"; "const narc_body *" for what is pointed to, "function *"
 *           for a function
 *   offset  bytes from the start of the structure
 *   size    bytes in all
 *   count   items of an array, 1 of all else */
typedef struct narc_member {
    const char *name, *type;
    size_t offset, size, count;
} narc_member;

/* A structure, or an enumeration, which has no members and whose size is that of its values. */
typedef struct narc_layout {
    const char *name;
    size_t size, alignment;
    const narc_member *members;
    size_t member_count;
} narc_layout;

/* A value of an enumeration, or a macro that is a number. */
typedef struct narc_constant {
    const char *name;
    double value;
} narc_constant;

/* Layout and constant number `index`, in the order of the headers' names and of what they declare; NULL behind the last. */
NARC_API const narc_layout *narc_get_layout(size_t index);
NARC_API const narc_constant *narc_get_constant(size_t index);

/* The layout with this name, NULL if there is none. */
NARC_API const narc_layout *narc_find_layout(const char *name);

/* All of it as JSON, a NUL behind it: as much as fits is written to the caller's `out_text`, which has room for `capacity`
 * bytes (0: it may be NULL). Returns how many bytes there are, without the NUL.
 *     {"version": "0.3.0", "little_endian": true,
 *      "layouts": {"narc_point": {"size": 16, "alignment": 8, "members": [
 *          {"name": "x", "type": "double", "offset": 0, "size": 8, "count": 1}, ...]}, ...},
 *      "constants": {"NARC_MAX_ARCS": 64, ...}} */
NARC_API size_t narc_write_layouts(char *out_text, size_t capacity);

/* Nothing of this header is in the modules for WebAssembly. */

#ifdef __cplusplus
}
#endif

#endif
