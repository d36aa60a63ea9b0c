/* SPDX-License-Identifier: MIT
 *
 * narc_fit.h - from outlines (glyphs, SVG, PNG, points, Beziers) to arc shapes that bound or approximate them.
 *
 * The mental model
 *
 *   An outline is a PATH: closed contours made of lines, arcs and Bezier curves. A fit looks at its convex hull alone, so
 *   holes, several contours and contours that overlap are fine. A FIT is an arc shape (see narc_shapes.h) that bounds
 *   the path (it contains every point of the path, curves included) or approximates it, and it is the best one that
 *   was found for what is asked:
 *
 *       family      n-arc: arcs with continuous tangents   edges: arcs, straight edges between them where they help
 *                   polygon: straight edges only           paper: Algorithm 1 on a polygon, enlarged until it bounds
 *                   plain: a circle, capsule, box or regular polygon, if the outline is one
 *       goal        what is least: area, perimeter, largest distance to the hull, area between shape and hull
 *       arc count   given, or the fewest for a given largest distance
 *
 *   The distance of two convex shapes is the largest difference of their support functions. This is the Hausdorff
 *   distance: every point of one is that close to the other, and the same holds of the outlines.
 *
 *   With fixed normals at the junctions everything is linear in the radii and the edges' lengths (support function,
 *   closure, perimeter): the best shape with given normals is a linear programme. From many such shapes a search by
 *   quadratic programming goes on in all variables. See fit/README.md for the algorithms and how good they are.
 *
 * This library is meant for tools and load time, not for the inner loop of a game. It allocates memory, keeps no
 * globals, and prints nothing. All functions may be called from several threads, each with paths of its own. On an
 * error the outputs are untouched. Where memory runs out it is NARC_ERROR_MEMORY, except in narc_read_svg(): librsvg
 * and GLib end the process. Units and directions are those of narc_shapes.h: y points up, counter-clockwise.
 *
 * Example
 *
 *     narc_path *path = NULL;
 *     narc_fit_result fit;
 *     narc_create_path(&path);
 *     narc_read_svg(text, size, NULL, path, &error);
 *     narc_fit_path(path, &(narc_fit_request){.arc_count = 8, .goal = NARC_FIT_BOUND_AREA}, &fit, &error);
 *     narc_add_shape(shapes, fit.arcs, fit.arc_count, &shape, &error);
 */
#ifndef NARC_FIT_H
#define NARC_FIT_H

#include "narc_shapes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------ paths */

/* The largest absolute coordinate of a path. */
#define NARC_MAX_COORDINATE 1e9

/* How far a chord may be from its curve if nothing else is asked for, relative to the path's extent (the larger side
 * of its bounding box). */
#define NARC_FLATNESS 2e-5

typedef struct narc_path narc_path;

/* An empty path. NARC_ERROR_MEMORY. */
NARC_API narc_status narc_create_path(narc_path **out_path);

/* Frees a path; NULL is fine. */
NARC_API void narc_destroy_path(narc_path *path);

/* The pen: move_to begins a contour, the others draw a line, a Bezier curve or an arc from where the pen is. A contour closes
 * by itself with a line to its start. Errors: NARC_ERROR_ARGUMENT (NULL, no contour was begun), NARC_ERROR_NOT_FINITE,
 * NARC_ERROR_SIZE (beyond NARC_MAX_COORDINATE), NARC_ERROR_MEMORY. */
NARC_API narc_status narc_move_to(narc_path *path, const narc_point *point, narc_error *error);
NARC_API narc_status narc_line_to(narc_path *path, const narc_point *point, narc_error *error);
NARC_API narc_status narc_quadratic_to(narc_path *path, const narc_point *control, const narc_point *point,
                                       narc_error *error);
NARC_API narc_status narc_cubic_to(narc_path *path, const narc_point *control_1, const narc_point *control_2,
                                   const narc_point *point, narc_error *error);

/* An arc of a circle through `middle`, which is best halfway, to `point`: exact up to rounding. Three points on a line are
 * a line. A full circle is two arcs. */
NARC_API narc_status narc_arc_to(narc_path *path, const narc_point *middle, const narc_point *point, narc_error *error);

/* The part of the ellipse center + cos t u + sin t v between two parameters, at most a turn apart, from where the pen is to
 * `point`: a circle as arcs, others within 1e-11 of their size. On an error nothing is drawn. */
NARC_API narc_status narc_ellipse_to(narc_path *path, const narc_point *center, const narc_point *u,
                                     const narc_point *v, double from, double to, const narc_point *point,
                                     narc_error *error);

/* Contours flattened to polygons: contour k has points[ends[k - 1] .. ends[k] - 1] (0 for ends[-1]), the first not
 * repeated at the end. No curve is further than `flatness` from its chords, and no drawing from contours that were
 * traced: those of SVG files add a pixel to it. */
typedef struct narc_contours {
    narc_point *points;
    size_t point_count;
    size_t *ends;
    size_t count;
    double flatness; /* a length; 0 if there are no curves, and nothing from SVG files */
} narc_contours;

/* Flattens a path; `flatness` is a length > 0, or 0 for NARC_FLATNESS. Free the result with
 * narc_release_contours(). NARC_ERROR_MEMORY, NARC_ERROR_SIZE (negative or NaN). */
NARC_API narc_status narc_flatten_path(const narc_path *path, double flatness, narc_contours *out_contours,
                                       narc_error *error);
NARC_API void narc_release_contours(narc_contours *contours);

/* The convex hull of `points[0 .. count-1]`: its corners, counter-clockwise, no three in line, none twice: of those
 * closer than 1e-10 of the hull's extent one is taken. `out_corners` has room for `count` points and may be `points`.
 * Andrew's monotone chain. NARC_ERROR_COUNT: no points. NARC_ERROR_NOT_CONVEX: all points lie on a line.
 * NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_MEMORY. */
NARC_API narc_status narc_compute_hull(const narc_point *points, size_t count, narc_point *out_corners,
                                       size_t *out_count, narc_error *error);

/* ------------------------------------------------------------------------------------------------ readers */

/* Each adds what it reads to a path; on error the path is as before. They read from memory, so that nothing
 * depends on files. For text formats error->index is the line, from 1 (0: no particular one); messages name line and
 * value. Errors: NARC_ERROR_ARGUMENT (NULL; a silhouette that does not exist), NARC_ERROR_FORMAT (not in that format,
 * damaged, or without an outline), NARC_ERROR_NOT_FINITE, NARC_ERROR_SIZE, NARC_ERROR_MEMORY. Inputs may come from
 * strangers: any bytes end in a path or an error. */

/* A font that FreeType reads (TrueType, OpenType, Type 1 ...). The data must stay until it is closed. */
typedef struct narc_font narc_font;
NARC_API narc_status narc_open_font(const void *data, size_t size, narc_font **out_font, narc_error *error);
NARC_API void narc_close_font(narc_font *font);

/* The glyph of a Unicode character; lengths in em (font units / units per em). NARC_ERROR_INDEX: the font has no glyph
 * for it. A blank (a space) is NARC_ERROR_FORMAT, since it has no outline. */
NARC_API narc_status narc_read_glyph(narc_font *font, uint32_t character, narc_path *path, narc_error *error);

/* The characters a font has glyphs for: the first of them above `after` (start with 0; character 0 is never told).
 * 0: no more. */
NARC_API uint32_t narc_next_character(narc_font *font, uint32_t after);

/* Which part of an image or drawing is its silhouette: what is not transparent; or what is dark, or light, of it.
 * Darkness is 1 - luminance, of what is transparent as much less. */
typedef enum narc_silhouette {
    NARC_SILHOUETTE_ALPHA = 0,
    NARC_SILHOUETTE_DARK = 1,
    NARC_SILHOUETTE_LIGHT = 2
} narc_silhouette;

/* How images and drawings are read; NULL in its place or zeros: as usual. */
typedef struct narc_image_request {
    narc_silhouette silhouette;
    double threshold; /* of alpha, darkness or lightness, above 0 and below 1; 0: 0.5 of PNG, 0.25 of SVG */
    bool *out_whole;  /* NULL, or set on success: all of the image or page counts, and the outline is its rectangle */
    const char *element; /* of SVG: the id of the one element, such as a layer, that counts; NULL: all. One that is not
                            there is NARC_ERROR_INDEX */
    bool trace;          /* of SVG: draw and trace it even if it is plain */
    bool *out_exact;     /* NULL, or of SVG set on success: it is plain, and was read by its geometry */
} narc_image_request;

/* What is seen of an SVG file. A plain drawing is read by its geometry: filled circles, ellipses, rectangles, polygons and
 * paths, with transforms, and strokes of circles, rectangles and lines, where outlines do not cross or touch each other and
 * nothing goes beyond the page. Lines, curves and arcs of circles are then exact, ellipses are curves within 1e-11 of
 * them. Of any other librsvg draws what is seen, whatever it uses (strokes, clipping, text, style sheets, filters), and
 * the outline of all ink above the threshold is traced. Fainter ink within 8 pixels of it along rows and columns counts
 * too, so that antialiased edges and tips keep their place. The ink's longer side is 4096 pixels or more, less only
 * where the page, at 8192 pixels, is more than twice as large as the ink. Outline and ink that counts are within one
 * pixel of each other; contours tell that as their flatness, and fits count it, so that a bounding fit bounds the ink.
 * What is thinner than a pixel counts with as much less alpha; tips of needles, below 8 degrees (at thresholds above 0.5
 * below 15), end where they become so thin. Circles are librsvg's: too large by up to 2.8e-4 of the radius.
 *
 * Units are the SVG's user units, those of the viewBox if there is one, y turned up. The page, which is the viewBox or
 * else from 0 to width and height, cuts off what is outside, as in any viewer; without either all is drawn (but for
 * the parts at negative coordinates of groups with opacity, masks or filters), and percentages are of 300 x 150. Text
 * is drawn with the fonts that are installed. No other file is read, and nothing from a network. Path data and
 * attributes that are wrong are as in any viewer: a path ends before the first error. Pango warns through GLib's log,
 * which without a handler of the program's goes to standard error, of text that it cannot draw. If memory runs out, or a
 * drawing is beyond what librsvg takes (text larger than 1e6 units), the process ends, which librsvg and GLib do. It takes
 * a tenth of a second to a few seconds, and up to 300 MB (500 MB for darkness or lightness) or, where groups with opacity,
 * masks or filters are inside each other, more. */
NARC_API narc_status narc_read_svg(const void *data, size_t size, const narc_image_request *request, narc_path *path,
                                   narc_error *error);

/* The silhouette in a PNG image: contours at the threshold, interpolated between the centres of pixels, so that
 * antialiased edges keep their place. An image that is full throughout, such as an opaque one, is its rectangle. Units
 * are pixels, y up, the origin at the lower left corner of the image. */
NARC_API narc_status narc_read_png(const void *data, size_t size, const narc_image_request *request, narc_path *path,
                                   narc_error *error);

/* How DXF drawings are read; NULL in its place or zeros: as usual. */
typedef struct narc_dxf_request {
    const char *layer; /* what is drawn on it counts; NULL: all. One without anything is NARC_ERROR_INDEX */
    double *out_unit;  /* NULL, or set on success: the drawing's unit in metres; 0: it tells none */
    size_t *out_open;  /* NULL, or set on success: how many contours are open, such as strokes */
    void *reserved[2];
} narc_dxf_request;

/* What is drawn in model space of a DXF file in ASCII, R12 to 2018: LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE and POLYLINE with
 * bulges, SPLINE (degree 1 to 3, without weights), INSERT of blocks. Lines and arcs are exact but for roundings, of the order of
 * 1e-16 of the coordinates, ellipses are curves within 1e-11. Strokes of one layer whose ends are within 1e-6 of the drawing's
 * extent are joined; a line then ends where the next stroke begins. In blocks layer 0 is that of the block. Texts, measures,
 * hatches and what else has no outline are left out. Lengths are in the drawing's units, y points up. Errors tell line and value.
 * A build without dxflib reads none: NARC_ERROR_FORMAT. */
NARC_API narc_status narc_read_dxf(const void *data, size_t size, const narc_dxf_request *request, narc_path *path,
                                   narc_error *error);

/* The names of the layers that something is drawn on, in the order of the drawing, a newline behind each; to be freed with
 * free(). Errors as above. */
NARC_API narc_status narc_list_dxf_layers(const void *data, size_t size, char **out_names, narc_error *error);

/* Points, blank lines between contours: CSV as spreadsheets write it, UTF-8. The first row tells what separates fields:
 * semicolons, or else tabs, commas, blanks; fields may be in quotes, and numbers have a decimal comma where semicolons or
 * tabs separate them. A header names the columns "x" and "y", in any order among others, which are not looked at. Without
 * a header a row is x,y or x,y,z, with the same z in all rows. JSON: [[x, y], ...], or a list of such lists (contours), or
 * an object whose key "points" or "contours" has that. */
NARC_API narc_status narc_read_csv(const void *data, size_t size, narc_path *path, narc_error *error);
NARC_API narc_status narc_read_json(const void *data, size_t size, narc_path *path, narc_error *error);

/* ------------------------------------------------------------------------------------------------ fits */

typedef enum narc_fit_family {
    NARC_FIT_N_ARC = 0,   /* arcs with continuous tangents; an arc of radius 0 is a corner */
    NARC_FIT_EDGES = 1,   /* arcs, with straight edges between them where they help */
    NARC_FIT_POLYGON = 2, /* straight edges only: corners are arcs of radius 0 */
    NARC_FIT_PAPER = 3,   /* yardstick: the least-area bounding polygon, Algorithm 1, enlarged until it bounds */
    NARC_FIT_PLAIN = 4 /* the first within `tolerance` of circle, capsule, box, box with round corners, regular polygon
                             of 3 to 16 sides; what lies along the axes has the arcs of narc_build_circle() and its
                             neighbours. No search; arc_count must be 0 */
} narc_fit_family;

typedef enum narc_fit_goal {
    NARC_FIT_BOUND_AREA = 0,      /* bounds; least area */
    NARC_FIT_BOUND_PERIMETER = 1, /* bounds; least perimeter */
    NARC_FIT_BOUND_DISTANCE = 2,  /* bounds; least largest distance from the hull */
    NARC_FIT_DISTANCE = 3,        /* least largest distance from the hull, to either side */
    NARC_FIT_DIFFERENCE = 4       /* least area of the symmetric difference with the hull */
} narc_fit_goal;

/* Most arcs of a fit. */
#define NARC_MAX_FIT_ARCS 32

typedef struct narc_fit_request {
    size_t arc_count; /* at most that many arcs, 1 .. NARC_MAX_FIT_ARCS (polygons: from 3); 0: the fewest that keep
                         `tolerance`. Arcs that would be one circle are merged, so fewer may come out: an n-arc with up
                         to 3 arcs is a circle. */
    double tolerance; /* with arc_count 0: the largest distance from the hull that is allowed */
    narc_fit_family family;
    narc_fit_goal goal; /* with arc_count 0: of the BOUND goals any makes the fit bound; the others do not */
    double flatness;    /* of curves, as in narc_flatten_path(); 0: NARC_FLATNESS, or with a tolerance 2 % of that, of
                           plain shapes 0.02 % */
    double min_radius;  /* of every arc, a length in the path's unit, which keeps the outline smooth; 0: none, and a
                           corner is an arc of radius 0. Not for polygons and the paper's route */
    bool keep_origin;   /* arcs keep the path's coordinates, in double precision, and result.origin is 0, 0. A store
                           rounds them more far from there; a bounding shape is larger by that */
    bool quick; /* a short search, for editors: areas are mostly within 1 % of the usual ones. `starts` must be 0 */
    unsigned starts; /* of the local search; 0: the usual number, 56 or less. The best is kept of searches from 1, 2,
                           4, 8, 16 and 32 starts, as far as that is not more than `starts`, and from 56 on of the usual
                           one and others of its size, starts / 56 in all. So more take longer, often find better, and
                           never worse; 56 or more never find worse than 0 does */
    /* Called now and then with the work done and in all, if not NULL; returning false ends the fit with the best so
     * far, or NARC_ERROR_CANCELLED if there is none. */
    bool (*progress)(size_t done, size_t total, void *context);
    void *context;
} narc_fit_request;

typedef struct narc_fit_result {
    narc_arc arcs[NARC_MAX_ARCS]; /* centres relative to `origin`; centres and radii are single-precision numbers */
    size_t arc_count;
    size_t edge_count; /* straight edges with a length */
    narc_point origin; /* where the shape's origin, its centroid, is in the path's coordinates */
    double area, perimeter;
    double hull_area, hull_perimeter; /* of the path's convex hull */
    double max_distance;              /* to the hull: the largest difference of the support functions */
    double mean_distance;             /* mean over the shape's outline of the distance to the hull's outline */
    double difference_area;           /* of the symmetric difference with the hull */
    double clearance; /* BOUND goals: the least of (support function - that of the path's flattened points, as
                               they are), certified > 0 for the shape as the store keeps it, in single precision,
                               with the flatness counted */
    double flatness;  /* how far the outline may be from the hull that was fitted to, a length: that of the
                               curves and of SVG files, and of the corners left out of hulls with thousands of them */
    double seconds;   /* time the fit took */
} narc_fit_result;

/* Fits an arc shape. Deterministic: equal input gives equal bits on one machine (but for `seconds`). The shape passes
 * narc_add_shape(). With arc_count 0 the fit is that of least largest distance, bounding or not, and what is compared
 * with the tolerance is max_distance + flatness. Errors: NARC_ERROR_ARGUMENT (NULL; a family or goal that does not
 * exist; the paper's route with another goal than BOUND_AREA; polygons, or that route, with a least radius; plain shapes
 * with a number of arcs),
 * NARC_ERROR_COUNT (arc_count; an outline without points), NARC_ERROR_NOT_CONVEX (all points on a line, or nearly: an
 * area below 1e-5 of the radius squared), NARC_ERROR_SIZE (tolerance not positive; least radius negative or more than
 * 16 times the hull's from its centroid; outline too small or too large), NARC_ERROR_NO_SOLUTION (the tolerance is not
 * reached with NARC_MAX_FIT_ARCS arcs, the message tells what was, or by a plain shape; the paper's route finds no n-arc; or single
 * precision rounds by more than 1/16 of the outline's radius where its origin is to be kept), NARC_ERROR_MEMORY,
 * NARC_ERROR_CANCELLED. Refused before any search are tolerances below 2^-24 of the outline's radius (single precision),
 * below the flatness (of bounding fits twice that) and, of n-arcs, below what arcs with the largest radius bulge on the
 * hull's longest side. */
NARC_API narc_status narc_fit_path(const narc_path *path, const narc_fit_request *request, narc_fit_result *out_result,
                                   narc_error *error);

/* ------------------------------------------------------------------------------------------------ parts */

/* Most parts of an outline. */
#define NARC_MAX_PARTS 256

/* No part reaches further into its neighbours than this many times the lap. */
#define NARC_LAP_REACH 1.04

typedef struct narc_parts_request {
    size_t most;      /* at most so many parts, 1 .. NARC_MAX_PARTS */
    double tolerance; /* few parts that no point of is further than this from the outline; 0: the
                         nearest that are found, at most `most` */
    double lap;       /* 0, or how far each part goes on into its neighbours, a length, so that shapes which only
                         approximate parts leave no seam between them: twice their tolerance is enough. The tolerance
                         holds with laps: they take NARC_LAP_REACH times this of it */
    double flatness;  /* of curves, as in narc_flatten_path(); 0: NARC_FLATNESS */
    void *reserved[2];
} narc_parts_request;

/* Convex polygons, whose union holds the outline's inside. narc_fit_path() makes a shape of each; of goals that bound,
 * the shapes hold it too. */
typedef struct narc_parts {
    narc_path **paths;
    size_t count;
    double distance; /* no point of the parts is further than that from the outline's inside; flatness is counted */
    double area;     /* of the outline's inside, of contours that cross that of their union */
} narc_parts;

/* Cuts an outline into convex parts, which may overlap: approximate convex decomposition (Lien and Amato 2006). Inside
 * is what an odd number of contours is around; contours that cross are outlines each, but for holes that cross, and one that
 * crosses itself is the loops between its crossings. A bay or hole stays where no point of it is further from the inside than
 * the tolerance, so narrow ones may be as deep as they like. Cuts go from the deepest bays to where that leaves least, and
 * parts are joined again as far as the tolerance lets them be, across others only where there are more than `most`: a search,
 * no proof that fewer do not serve. Where the outline is as thin as a line, so is a part, with 0.1 % of its length in width.
 * Takes some hundredths of a second with a tolerance, ten times as long without. Free the result with
 * narc_release_parts(). Errors: NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_COUNT (`most`; an outline without points),
 * NARC_ERROR_SIZE (no length; all points in one place), NARC_ERROR_NO_SOLUTION (the tolerance is not reached with so many
 * parts, or without laps and flatness is below a 1024th of the extent: error->value is the least possible one then, or the
 * distance of the parts that were found), NARC_ERROR_MEMORY. */
NARC_API narc_status narc_cut_path(const narc_path *path, const narc_parts_request *request, narc_parts *out_parts,
                                   narc_error *error);
NARC_API void narc_release_parts(narc_parts *parts);

/* Cuts an outline of straight lines and convex arcs into convex parts that are just it, but for single precision: no
 * tolerance, no laps, arcs stay whole or become arcs of their circles. An L is two boxes. Inside is what an odd number of
 * contours is around. With c corners that turn inwards and h holes there are at most c + 1 - h parts, and one less for each cut
 * that serves two corners; not always the fewest. Of a part's fit areas, perimeter, edges and origin are set, distances are 0.
 * *out_count is also set if `capacity` is less. Errors: NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_COUNT (no points),
 * NARC_ERROR_NO_SOLUTION (a curve, a concave arc, which no convex part has, or an outline traced in an image: error->index is the
 * contour, from 0, and error->value the number of the line, arc or curve in it), NARC_ERROR_NOT_SIMPLE (contours that cross or
 * touch; as before), NARC_ERROR_CAPACITY, NARC_ERROR_MEMORY, and those of narc_add_shape(): a part is too thin or small. */
NARC_API narc_status narc_cut_exactly(const narc_path *path, narc_fit_result *out_parts, size_t capacity,
                                      size_t *out_count, narc_error *error);

/* ------------------------------------------------------------------------------------------------ biarcs */

/* One piece of an open, tangent-continuous arc spline. */
typedef struct narc_curve_arc {
    narc_point start, end;
    narc_point center; /* of its circle; of no meaning for a line */
    double radius;     /* infinity: a straight line */
    double turn;       /* signed angle from the tangent at the start to that at the end, counter-clockwise positive;
                          0 for a line */
} narc_curve_arc;

/* A Bezier curve of degree 1 to 3, `controls[0 .. degree]`, as arcs that join with a common tangent and have the
 * curve's end points and end tangents: biarcs (Bolton 1975; Riskus 2006), as long as the tolerance lets them be.
 * `out_distance` is a bound, not a sample, of the distance of any point of the curve from the arcs and of the arcs from
 * the curve; it is at most `tolerance`. A cusp or a doubling back is a corner: there the tangent may jump, as that of
 * the curve does. With out_arcs NULL and capacity 0 only the count and the distance are told. NARC_ERROR_ARGUMENT
 * (NULL, degree), NARC_ERROR_NOT_FINITE, NARC_ERROR_SIZE (tolerance not positive, or below 1e-9 of the curve's extent;
 * coordinates beyond NARC_MAX_COORDINATE), NARC_ERROR_CAPACITY (`out_count` is set to the number needed),
 * NARC_ERROR_MEMORY. A curve that is a point has no arcs. */
NARC_API narc_status narc_fit_bezier(const narc_point *controls, size_t degree, double tolerance,
                                     narc_curve_arc *out_arcs, size_t capacity, size_t *out_count, double *out_distance,
                                     narc_error *error);

/* The contours of a path as chains of arcs and lines: chain k has arcs[ends[k - 1] .. ends[k] - 1] (0 for ends[-1]); each
 * begins where the one before it ends, and the first of a closed chain where the last ends. */
typedef struct narc_arc_chains {
    narc_curve_arc *arcs;
    size_t arc_count;
    size_t *ends;
    size_t count;
    double distance; /* between path and arcs, both ways; at most the tolerance */
} narc_arc_chains;

/* The curves of a path, and lines alone, by narc_fit_bezier(). Of lines one after the other, such as those of traced
 * outlines, as many as the tolerance lets be become one line or two arcs; pieces join with a common tangent but at
 * corners: where the lines turn by more than half a radian within some tolerances. Contours whose arcs would meet, those of
 * another one or their own, are fitted nearer; if they still do, by lines alone. A chain of lines that is a whole
 * contour may begin at another of its points. Arcs that a store would not take because they are flat become lines.
 * narc_add_chain() takes each chain as narc_describe_chain() gives it, with default options. Contours are closed by a
 * line where they are open, unless `open`, and those that are a point are left out. Closed chains have the inside on their
 * left: what an odd number of chains is around; open ones go as they were drawn. Free the result with
 * narc_release_chains(). Errors: those of narc_fit_bezier() and
 * narc_add_chain(), with the contour, of those that are drawn, in error->index; NARC_ERROR_NOT_SIMPLE (lines cross, of one
 * contour or of two: the message names both, counted from 0), NARC_ERROR_ARGUMENT (NULL), NARC_ERROR_COUNT (nothing is
 * drawn), NARC_ERROR_MEMORY. */
NARC_API narc_status narc_fit_chains(const narc_path *path, double tolerance, bool open, narc_arc_chains *out_chains,
                                     narc_error *error);

/* The same with the fewest pieces that are found (after Maier and Pisinger 2013): at joints the tangent may turn, by as
 * much as the tolerance allows. Lines are preferred to arcs where as many of both serve. A rectangle with round corners is
 * four lines and four arcs, a circle two arcs; arcs of the path are met exactly. */
NARC_API narc_status narc_fit_fewest_chains(const narc_path *path, double tolerance, bool open,
                                            narc_arc_chains *out_chains, narc_error *error);
NARC_API void narc_release_chains(narc_arc_chains *chains);

/* One chain, `pieces[0 .. count-1]`, as arcs in the form of shapes, for ground: with the inside on its left, normals that
 * point to the right, and radii below 0 where it is concave (narc_files.h has it exactly). Straight pieces are the edges
 * between arcs; where they meet with an angle above half of NARC_TOLERANCE there is an arc of radius 0, or -0.0 in a valley,
 * and plain points at the ends of an open chain that are ends of lines. Arcs of more than half a turn become two.
 * `out_arcs` has room for 3 count + 1. NARC_ERROR_ARGUMENT
 * (NULL), NARC_ERROR_COUNT (no pieces). */
NARC_API narc_status narc_describe_chain(const narc_curve_arc *pieces, size_t count, bool closed, narc_arc *out_arcs,
                                         size_t *out_count, narc_error *error);

#ifdef __cplusplus
}
#endif

#endif
