/* SPDX-License-Identifier: MIT
 *
 * svg_document.h - the tree of an SVG file, its style sheet, and its elements by id. Internal.
 */
#ifndef NARC_SVG_DOCUMENT_H
#define NARC_SVG_DOCUMENT_H

#include "svg_style.h"

typedef struct narc_svg_document {
    xmlDoc *tree;
    const xmlNode *root; /* an svg element */
    xmlHashTable *ids;
    narc_svg_sheet sheet;
} narc_svg_document;

/* NARC_ERROR_FORMAT, NARC_ERROR_SIZE, NARC_ERROR_MEMORY. To be closed in any case. */
narc_status narc_open_svg(const void *data, size_t size, narc_svg_document *document, narc_error *error);
void narc_close_svg(narc_svg_document *document);

/* The first element with an id, or NULL. */
const xmlNode *narc_find_element(const narc_svg_document *document, const char *id);

/* The line on which an element's tag begins, from 1. */
size_t narc_get_line(const xmlNode *node);

/* The node after this one in the document's order, inside `root`; NULL behind the last. */
const xmlNode *narc_next_node(const xmlNode *root, const xmlNode *node);

#endif
