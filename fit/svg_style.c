/* SPDX-License-Identifier: MIT
 *
 * svg_style.c - what an SVG element says of itself: attributes, and the properties that decide whether it is drawn.
 */
#include "svg_style.h"

#include <string.h>

#include "svg_number.h"

bool narc_is_word(narc_span span, const char *word) {
    return span.size == strlen(word) && memcmp(span.text, word, span.size) == 0;
}

static bool is_space(const char *at) { return narc_skip_space(at) != at; }

narc_span narc_trim(narc_span span) {
    for (; span.size && is_space(span.text); span.text++) {
        span.size--;
    }
    while (span.size && is_space(span.text + span.size - 1)) {
        span.size--;
    }
    return span;
}

const char *narc_get_svg_name(const xmlNode *node) {
    const bool svg = node->type == XML_ELEMENT_NODE &&
                     (!node->ns || strcmp((const char *)node->ns->href, "http://www.w3.org/2000/svg") == 0);
    return svg ? (const char *)node->name : "";
}

/* The parser has replaced entities, so that a value is one text. */
static const char *attribute_text(const xmlAttr *attribute) {
    const xmlNode *text = attribute->children;
    return text && text->content ? (const char *)text->content : "";
}

const char *narc_get_attribute(const xmlNode *node, const char *name) {
    for (const xmlAttr *a = node->properties; a; a = a->next) {
        if (!a->ns && strcmp((const char *)a->name, name) == 0) {
            return attribute_text(a);
        }
    }
    return NULL;
}

const char *narc_get_link(const xmlNode *node) {
    const char *link = narc_get_attribute(node, "href");
    for (const xmlAttr *a = node->properties; a && !link; a = a->next) {
        /* A prefix that is not declared stays part of the name. */
        const char *name = (const char *)a->name;
        if (strcmp(name, "href") == 0 || strcmp(name, "xlink:href") == 0) {
            link = attribute_text(a);
        }
    }
    return link;
}

static const char *const property_names[NARC_SVG_PROPERTIES] = {
    "display", "visibility",     "opacity",      "fill",           "fill-opacity",
    "stroke",  "stroke-opacity", "stroke-width", "stroke-linecap", "transform"};

/* The end of a declaration: ';' outside quotes and parentheses, as data in url() may have it. */
static size_t find_end(narc_span span) {
    char quote = 0;
    size_t depth = 0;
    for (size_t k = 0; k < span.size; k++) {
        const char c = span.text[k];
        if (quote) {
            quote = c == quote ? 0 : quote;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '(') {
            depth++;
        } else if (c == ')' && depth) {
            depth--;
        } else if (c == ';' && !depth) {
            return k;
        }
    }
    return span.size;
}

static void add_declaration(narc_span text, narc_svg_values *values) {
    const char *colon = memchr(text.text, ':', text.size);
    if (!colon) {
        return;
    }
    const narc_span name = narc_trim((narc_span){text.text, (size_t)(colon - text.text)});
    narc_span value = {colon + 1, (size_t)(text.text + text.size - (colon + 1))};
    const char *mark = memchr(value.text, '!', value.size); /* "!important" */
    value.size = mark ? (size_t)(mark - value.text) : value.size;
    for (size_t k = 0; k < NARC_SVG_PROPERTIES; k++) {
        if (narc_is_word(name, property_names[k])) {
            values->values[k] = narc_trim(value);
        }
    }
}

void narc_add_declarations(narc_span text, narc_svg_values *values) {
    while (text.size) {
        const size_t end = find_end(text);
        add_declaration((narc_span){text.text, end}, values);
        const size_t step = end < text.size ? end + 1 : end;
        text.text += step;
        text.size -= step;
    }
}

narc_svg_values narc_get_properties(const xmlNode *node, const narc_svg_sheet *sheet) {
    narc_svg_values values = {0};
    for (const xmlAttr *a = node->properties; a; a = a->next) {
        const narc_span name = {(const char *)a->name, strlen((const char *)a->name)};
        for (size_t k = 0; k < NARC_SVG_PROPERTIES; k++) {
            if (!a->ns && narc_is_word(name, property_names[k])) {
                const char *text = attribute_text(a);
                values.values[k] = narc_trim((narc_span){text, strlen(text)});
            }
        }
    }
    narc_add_sheet(sheet, node, &values);
    const char *style = narc_get_attribute(node, "style");
    if (style) {
        narc_add_declarations((narc_span){style, strlen(style)}, &values);
    }
    return values;
}

/* A number that is not there or cannot be read counts as one above 0. */
static bool is_above_zero(narc_span span) {
    const char *at = span.text;
    double number = 1;
    return !span.size || !narc_take_number(&at, &number) || number > 0;
}

static void update_paint(narc_span value, bool *seen) {
    if (value.size && !narc_is_word(value, "inherit")) {
        *seen = !narc_is_word(value, "none") && !narc_is_word(value, "transparent");
    }
}

static void update_number(narc_span value, bool *above_zero) {
    if (value.size && !narc_is_word(value, "inherit")) {
        *above_zero = is_above_zero(value);
    }
}

bool narc_update_look(const narc_svg_values *properties, narc_svg_look *look) {
    const narc_span *values = properties->values, visibility = values[NARC_SVG_VISIBILITY];
    if (visibility.size && !narc_is_word(visibility, "inherit")) {
        look->visible = !narc_is_word(visibility, "hidden") && !narc_is_word(visibility, "collapse");
    }
    update_paint(values[NARC_SVG_FILL], &look->fill);
    update_paint(values[NARC_SVG_STROKE], &look->stroke);
    update_number(values[NARC_SVG_FILL_OPACITY], &look->fill_opaque);
    update_number(values[NARC_SVG_STROKE_OPACITY], &look->stroke_opaque);
    update_number(values[NARC_SVG_STROKE_WIDTH], &look->stroke_wide);
    const narc_span cap = values[NARC_SVG_STROKE_LINECAP];
    if (cap.size && !narc_is_word(cap, "inherit")) {
        look->stroke_caps = narc_is_word(cap, "round") || narc_is_word(cap, "square");
    }
    return !narc_is_word(values[NARC_SVG_DISPLAY], "none") && is_above_zero(values[NARC_SVG_OPACITY]);
}
