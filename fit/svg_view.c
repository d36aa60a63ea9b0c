/* SPDX-License-Identifier: MIT
 *
 * svg_view.c - the coordinate systems of nested svg elements and symbols: their place, size and view box.
 */
#include <math.h>
#include <string.h>

#include "svg_shapes.h"

/* The four numbers of a view box. */
struct box {
    double x, y, width, height;
};

static bool parse_box(const char *text, struct box *out_box) {
    double numbers[4];
    for (int k = 0; k < 4; k++) {
        text = narc_skip_comma(text);
        if (!narc_take_number(&text, &numbers[k]) || !isfinite(numbers[k])) {
            return false;
        }
    }
    *out_box = (struct box){numbers[0], numbers[1], numbers[2], numbers[3]};
    return !*narc_skip_space(text) && out_box->width >= 0 && out_box->height >= 0;
}

narc_svg_view narc_read_root_view(const xmlNode *root) {
    narc_svg_view view = {NAN, NAN};
    narc_svg_fault fault;
    struct box box;
    const char *text = narc_get_attribute(root, "viewBox");
    if (text && parse_box(text, &box)) {
        return (narc_svg_view){box.width, box.height};
    }
    if (narc_get_length(root, "width", NAN, NAN, &view.width, &fault)) {
        view.width = NAN;
    }
    if (narc_get_length(root, "height", NAN, NAN, &view.height, &fault)) {
        view.height = NAN;
    }
    return view;
}

/* preserveAspectRatio: how a view box lies in a view of other proportions. */
struct aspect {
    bool stretch, slice; /* none; slice: the view is filled, not only touched */
    double x, y;         /* which part of the space left is before the box */
};

static bool parse_aspect(const char *text, struct aspect *out_aspect) {
    static const char *const places[] = {"Min", "Mid", "Max"};
    struct aspect aspect = {.x = -1, .y = -1};
    text = narc_skip_space(text);
    text = strncmp(text, "defer", 5) == 0 ? narc_skip_space(text + 5) : text;
    if (strncmp(text, "none", 4) == 0) {
        aspect = (struct aspect){.stretch = true};
        text += 4;
    } else {
        for (int k = 0; k < 9; k++) {
            if (text[0] == 'x' && strncmp(text + 1, places[k % 3], 3) == 0 && text[4] == 'Y' &&
                strncmp(text + 5, places[k / 3], 3) == 0) {
                aspect.x = 0.5 * (k % 3);
                aspect.y = 0.5 * (k / 3);
            }
        }
        text += aspect.x < 0 ? 0 : 8;
    }
    text = narc_skip_space(text);
    aspect.slice = strncmp(text, "slice", 5) == 0;
    text += aspect.slice ? 5 : strncmp(text, "meet", 4) == 0 ? 4 : 0;
    *out_aspect = aspect;
    return aspect.x >= 0 && !*narc_skip_space(text);
}

/* The map from a view box to the view. */
static narc_affine fit_box(const struct box *box, const struct box *view, const struct aspect *aspect) {
    double sx = view->width / box->width, sy = view->height / box->height;
    if (!aspect->stretch) {
        sx = sy = aspect->slice ? fmax(sx, sy) : fmin(sx, sy);
    }
    return (narc_affine){sx,
                         0,
                         0,
                         sy,
                         view->x + aspect->x * (view->width - sx * box->width) - sx * box->x,
                         view->y + aspect->y * (view->height - sy * box->height) - sy * box->y};
}

/* Width or height: the use's, else the element's own, else all of the outer view. */
static narc_status get_extent(const xmlNode *node, const xmlNode *use, const char *name, double whole,
                              double *out_extent, narc_svg_fault *fault) {
    const xmlNode *sources[2] = {use, node};
    *out_extent = whole;
    for (int k = 0; k < 2; k++) {
        const char *text = sources[k] ? narc_get_attribute(sources[k], name) : NULL;
        if (text && strcmp(text, "auto") != 0) {
            const narc_status status = narc_get_length(sources[k], name, whole, whole, out_extent, fault);
            if (!status && *out_extent < 0) {
                return narc_set_fault(fault, NARC_ERROR_SIZE, "a negative length", text, *out_extent);
            }
            return status;
        }
    }
    return NARC_OK;
}

/* Place and size of the element's view in the outer one. */
static narc_status read_place(const xmlNode *node, const xmlNode *use, const narc_svg_view *outer,
                              struct box *out_place, narc_svg_fault *fault) {
    narc_status status = narc_get_length(node, "x", outer->width, 0, &out_place->x, fault);
    if (!status) {
        status = narc_get_length(node, "y", outer->height, 0, &out_place->y, fault);
    }
    if (!status) {
        status = get_extent(node, use, "width", outer->width, &out_place->width, fault);
    }
    return status ? status : get_extent(node, use, "height", outer->height, &out_place->height, fault);
}

narc_status narc_read_view(const xmlNode *node, const xmlNode *use, const narc_svg_view *outer, narc_svg_view *out_view,
                           narc_affine *out_map, bool *out_empty, narc_svg_fault *fault) {
    struct box place, box = {0};
    const narc_status status = read_place(node, use, outer, &place, fault);
    if (status) {
        return status;
    }
    const char *box_text = narc_get_attribute(node, "viewBox");
    const char *aspect_text = narc_get_attribute(node, "preserveAspectRatio");
    struct aspect aspect = {.x = 0.5, .y = 0.5};
    if (box_text && !parse_box(box_text, &box)) {
        fault->attribute = "viewBox";
        return narc_set_fault(fault, NARC_ERROR_FORMAT, "not four numbers, the last two positive", box_text, 0);
    }
    if (aspect_text && !parse_aspect(aspect_text, &aspect)) {
        fault->attribute = "preserveAspectRatio";
        return narc_set_fault(fault, NARC_ERROR_FORMAT, "not such as xMidYMid meet", aspect_text, 0);
    }
    if (box_text && (isnan(place.width) || isnan(place.height))) {
        fault->attribute = "viewBox";
        return narc_set_fault(fault, NARC_ERROR_FORMAT, "of an element whose size is not told", box_text, 0);
    }
    *out_empty = place.width == 0 || place.height == 0 || (box_text && (box.width == 0 || box.height == 0));
    *out_view = box_text ? (narc_svg_view){box.width, box.height} : (narc_svg_view){place.width, place.height};
    *out_map = box_text ? fit_box(&box, &place, &aspect) : (narc_affine){1, 0, 0, 1, place.x, place.y};
    return NARC_OK;
}
