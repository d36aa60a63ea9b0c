/* SPDX-License-Identifier: MIT
 *
 * svg_style.h - what an SVG element says of itself: attributes, and the properties that decide whether it is drawn.
 * Internal.
 */
#ifndef NARC_SVG_STYLE_H
#define NARC_SVG_STYLE_H

#include <libxml/hash.h>
#include <libxml/tree.h>

#include "narc_fit.h"

/* Part of a text that ends with NUL. */
typedef struct narc_span {
    const char *text;
    size_t size;
} narc_span;

bool narc_is_word(narc_span span, const char *word);
narc_span narc_trim(narc_span span);

/* Is the node an SVG element (or in no namespace)? Its name, or "". */
const char *narc_get_svg_name(const xmlNode *node);

/* An attribute in no namespace, or NULL. */
const char *narc_get_attribute(const xmlNode *node, const char *name);

/* The target of a link: href, or xlink:href; NULL if there is none. */
const char *narc_get_link(const xmlNode *node);

/* The properties that matter here. */
typedef enum narc_svg_property {
    NARC_SVG_DISPLAY,
    NARC_SVG_VISIBILITY,
    NARC_SVG_OPACITY,
    NARC_SVG_FILL,
    NARC_SVG_FILL_OPACITY,
    NARC_SVG_STROKE,
    NARC_SVG_STROKE_OPACITY,
    NARC_SVG_STROKE_WIDTH,
    NARC_SVG_STROKE_LINECAP,
    NARC_SVG_TRANSFORM,
    NARC_SVG_PROPERTIES
} narc_svg_property;

/* Values of properties by narc_svg_property; size 0: not given. */
typedef struct narc_svg_values {
    narc_span values[NARC_SVG_PROPERTIES];
} narc_svg_values;

/* Adds what "name: value; name: value" declares; the last of a name counts. */
void narc_add_declarations(narc_span text, narc_svg_values *values);

/* The rules of all `style` elements whose selector is one name, class, id or '*'. All others, and whatever stands
 * inside @media and the like, are left out. */
typedef struct narc_svg_sheet {
    char *text;
    xmlHashTable *rules; /* by the selector as it is written, such as ".a" */
} narc_svg_sheet;

/* NARC_ERROR_MEMORY. To be released in any case. */
narc_status narc_read_sheet(const xmlNode *root, narc_svg_sheet *sheet);
void narc_release_sheet(narc_svg_sheet *sheet);

/* Adds what the sheet says of an element. */
void narc_add_sheet(const narc_svg_sheet *sheet, const xmlNode *node, narc_svg_values *values);

/* All properties of an element: from its style attribute, else from the sheet, else from the attribute of that name. */
narc_svg_values narc_get_properties(const xmlNode *node, const narc_svg_sheet *sheet);

/* Whether something is seen, as far as it is inherited. */
typedef struct narc_svg_look {
    bool visible;
    bool fill, fill_opaque;
    bool stroke, stroke_opaque, stroke_wide;
    bool stroke_caps; /* a stroke without length is a dot */
} narc_svg_look;

/* The look of an element, from that of its parent; false: nothing in it is seen. */
bool narc_update_look(const narc_svg_values *properties, narc_svg_look *look);

#endif
