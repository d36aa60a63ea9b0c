/* SPDX-License-Identifier: MIT
 *
 * read_svg.c - SVG files: the tree of elements, which of them are drawn, and in which coordinates.
 */
#include <string.h>

#include "error.h"
#include "path.h"
#include "svg_document.h"
#include "svg_shapes.h"

/* How deep elements may be inside each other, with all that `use` shows: each level takes some of the stack. */
enum { DEPTH_LIMIT = 512 };

/* How many elements, lines and curves may come of repeated use, beyond those that the file's size has room for. */
enum { REPEAT_LIMIT = 1000000 };

/* The elements that uses show at the moment, to see when one shows itself. */
struct shown {
    const xmlNode *node;
    const struct shown *outer;
};

struct reader {
    const narc_svg_document *document;
    narc_svg_pen pen;
    narc_error *error;
    const struct shown *shown;
    size_t depth;
    size_t budget; /* elements */
};

/* What an element takes from those around it. */
struct state {
    narc_affine map;
    narc_svg_view view;
    narc_svg_look look;
};

static narc_status walk(struct reader *r, const xmlNode *node, const struct state *outer, const xmlNode *use);

/* The beginning of a value, in one line; of UTF-8 characters that are cut, nothing. */
static void excerpt(const char *text, char out[33]) {
    size_t size = 0;
    for (; size < 32 && text[size]; size++) {
        out[size] = (unsigned char)text[size] < ' ' ? ' ' : text[size];
    }
    while (size && text[size] && ((unsigned char)text[size] & 0xc0) == 0x80) {
        size--;
    }
    out[size] = 0;
}

static narc_status fail_at(const struct reader *r, const xmlNode *node, const narc_svg_fault *fault) {
    const size_t line = narc_get_line(node);
    char text[33] = "", name[33];
    excerpt((const char *)node->name, name);
    excerpt(fault->at ? fault->at : "", text);
    return narc_fail(r->error, fault->status, line, fault->value, "line %zu, <%s>%s%s: %s%s%s%s", line, name,
                     fault->attribute ? ", " : "", fault->attribute ? fault->attribute : "", fault->problem,
                     fault->at ? " at \"" : "", text, fault->at ? "\"" : "");
}

static narc_status fail_with(const struct reader *r, const xmlNode *node, narc_status status, const char *attribute,
                             const char *problem, const char *value) {
    return fail_at(r, node, &(narc_svg_fault){status, problem, attribute, value, 0});
}

static narc_status walk_children(struct reader *r, const xmlNode *node, const struct state *state) {
    narc_status status = NARC_OK;
    for (const xmlNode *child = node->children; child && !status; child = child->next) {
        status = walk(r, child, state, NULL);
    }
    return status;
}

/* Of a switch's children the first that asks for nothing special and speaks English, if it speaks at all. */
static narc_status walk_switch(struct reader *r, const xmlNode *node, const struct state *state) {
    for (const xmlNode *child = node->children; child; child = child->next) {
        if (*narc_get_svg_name(child)) {
            const char *extensions = narc_get_attribute(child, "requiredExtensions");
            const char *language = narc_get_attribute(child, "systemLanguage");
            if (!extensions && (!language || strstr(language, "en"))) {
                return walk(r, child, state, NULL);
            }
        }
    }
    return NARC_OK;
}

static narc_status walk_view(struct reader *r, const xmlNode *node, const struct state *outer, const xmlNode *use) {
    struct state state = *outer;
    narc_affine map;
    bool empty;
    narc_svg_fault fault = {0};
    if (narc_read_view(node, use, &outer->view, &state.view, &map, &empty, &fault)) {
        return fail_at(r, node, &fault);
    }
    state.map = narc_multiply_affine(&outer->map, &map);
    return empty ? NARC_OK : walk_children(r, node, &state);
}

/* What a use shows; nothing (*out_target is NULL) if there is no such element, as in any viewer. */
static narc_status find_target(const struct reader *r, const xmlNode *use, const xmlNode **out_target) {
    const char *link = narc_get_link(use);
    *out_target = NULL;
    if (!link || !*link) {
        return NARC_OK;
    }
    if (*link != '#') {
        return fail_with(r, use, NARC_ERROR_FORMAT, "href", "other files are not read", link);
    }
    *out_target = narc_find_element(r->document, link + 1);
    for (const struct shown *s = r->shown; s && *out_target; s = s->outer) {
        if (s->node == *out_target) {
            return fail_with(r, use, NARC_ERROR_FORMAT, "href", "an element that shows itself", link);
        }
    }
    return NARC_OK;
}

static narc_status walk_use(struct reader *r, const xmlNode *node, const struct state *outer) {
    const xmlNode *target;
    struct state state = *outer;
    narc_svg_fault fault = {0};
    narc_point offset;
    if (narc_get_length(node, "x", outer->view.width, 0, &offset.x, &fault) ||
        narc_get_length(node, "y", outer->view.height, 0, &offset.y, &fault)) {
        return fail_at(r, node, &fault);
    }
    narc_status status = find_target(r, node, &target);
    if (status || !target) {
        return status;
    }
    const narc_affine map = {1, 0, 0, 1, offset.x, offset.y};
    state.map = narc_multiply_affine(&outer->map, &map);
    const struct shown shown = {target, r->shown};
    r->shown = &shown;
    status = walk(r, target, &state, node);
    r->shown = shown.outer;
    return status;
}

static narc_status draw_shape(struct reader *r, const xmlNode *node, const struct state *state) {
    const narc_svg_look *look = &state->look;
    const bool stroke = look->stroke && look->stroke_opaque && look->stroke_wide;
    narc_svg_fault fault = {0};
    if (!look->visible || !(stroke || (look->fill && look->fill_opaque))) {
        return NARC_OK;
    }
    r->pen.map = state->map;
    r->pen.lines = stroke;
    r->pen.dots = stroke && look->stroke_caps;
    narc_pen_move(&r->pen, (narc_point){0, 0});
    const narc_status status = narc_draw_svg_shape(node, &state->view, &r->pen, &fault);
    narc_pen_close(&r->pen);
    return status ? fail_at(r, node, &fault) : NARC_OK;
}

/* Unknown elements, and those that are drawn only by reference, are nothing here. */
static narc_status walk_inside(struct reader *r, const xmlNode *node, const struct state *state, const xmlNode *use) {
    const char *name = narc_get_svg_name(node);
    if (strcmp(name, "g") == 0 || strcmp(name, "a") == 0 || node == r->document->root) {
        return walk_children(r, node, state);
    }
    if (strcmp(name, "svg") == 0 || (use && strcmp(name, "symbol") == 0)) {
        return walk_view(r, node, state, use);
    }
    if (strcmp(name, "switch") == 0) {
        return walk_switch(r, node, state);
    }
    if (strcmp(name, "use") == 0) {
        return walk_use(r, node, state);
    }
    return draw_shape(r, node, state);
}

static narc_status walk(struct reader *r, const xmlNode *node, const struct state *outer, const xmlNode *use) {
    if (!*narc_get_svg_name(node)) {
        return NARC_OK;
    }
    if (r->depth == DEPTH_LIMIT || r->budget == 0) {
        return fail_with(r, node, NARC_ERROR_SIZE, NULL,
                         r->budget ? "elements inside each other, too deep" : "elements are used again too often",
                         NULL);
    }
    struct state state = *outer;
    const narc_svg_values properties = narc_get_properties(node, &r->document->sheet);
    if (!narc_update_look(&properties, &state.look)) {
        return NARC_OK;
    }
    const narc_span transform = properties.values[NARC_SVG_TRANSFORM];
    if (transform.size) {
        narc_svg_fault fault = {.attribute = "transform"};
        narc_affine map;
        if (narc_parse_transform(transform.text, transform.size, &map, &fault)) {
            return fail_at(r, node, &fault);
        }
        state.map = narc_multiply_affine(&outer->map, &map);
    }
    r->depth++;
    r->budget--;
    const narc_status status = walk_inside(r, node, &state, use);
    r->depth--;
    return status;
}

static narc_status draw_document(const narc_svg_document *document, size_t size, narc_path *path, narc_error *error) {
    struct reader r = {.document = document,
                       .pen = {.path = path, .budget = size + REPEAT_LIMIT},
                       .budget = size + REPEAT_LIMIT,
                       .error = error};
    const struct state state = {
        .map = {1, 0, 0, -1, 0, 0}, /* y up */
        .view = narc_read_root_view(document->root),
        .look = {.visible = true, .fill = true, .fill_opaque = true, .stroke_opaque = true, .stroke_wide = true}};
    const narc_path_mark mark = narc_mark_path(path);
    narc_status status = walk(&r, document->root, &state, NULL);
    if (!status && !narc_is_drawn_since(path, mark)) {
        status = narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the SVG file has no outline that is seen");
    }
    if (status) {
        narc_rewind_path(path, mark);
    }
    return status;
}

narc_status narc_read_svg(const void *data, size_t size, narc_path *path, narc_error *error) {
    if (!data || !path) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, data ? "path is NULL" : "data is NULL");
    }
    narc_svg_document document;
    narc_status status = narc_open_svg(data, size, &document, error);
    if (!status) {
        status = draw_document(&document, size, path, error);
    }
    narc_close_svg(&document);
    return status;
}
