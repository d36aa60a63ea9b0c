/* SPDX-License-Identifier: MIT
 *
 * view.c - narc view: a page that shows shapes over the drawings that they were made of.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "export.h"
#include "fail.h"
#include "fit_inputs.h"
#include "output.h"
#include "text.h"

enum { READING, OUT = READING + READING_OPTIONS, OPTIONS };

/* view.html, up to where its data begins. */
static const char page[] = {
#include "view_page.inc"
};

static void put_base64(FILE *file, const unsigned char *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const size_t count = size - i < 3 ? size - i : 3;
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (k < count ? bytes[i + k] : 0);
        for (size_t k = 0; k < 4; k++)
            fputc(k <= count ? digits[bits >> (18 - 6 * k) & 63] : '=', file);
    }
}

static void put_part(FILE *file, const narc_named_shape *part) {
    fputs("{\"name\":", file);
    put_json_text(file, part->name);
    fprintf(file, ",\"closed\":%s,\"chain\":%s,\"arcs\":[", part->form == NARC_FORM_OPEN_CHAIN ? "false" : "true",
            part->form == NARC_FORM_SHAPE ? "false" : "true");
    for (size_t i = 0; i < part->arc_count; i++) {
        const narc_arc *a = &part->arcs[i];
        fprintf(file, "%s[%.17g,%.17g,%.17g,%.17g,%.17g]", i ? "," : "", a->center_x + part->origin.x,
                a->center_y + part->origin.y, a->radius, a->start, find_turn(a));
    }
    fputs("]}", file);
}

/* The area that all shapes cover, measured near the first one's origin; 0 where any is a chain. */
static double measure_area(const narc_shape_list *shapes, const size_t *parts, size_t count) {
    size_t *counts = allocate(count, sizeof *counts), total = 0, capacity = 0;
    narc_arc *arcs = NULL;
    const narc_point around = shapes->items[parts[0]].origin;
    narc_mass mass = {0};
    bool solid = true;
    for (size_t k = 0; k < count; k++) {
        const narc_named_shape *part = &shapes->items[parts[k]];
        solid = solid && part->form == NARC_FORM_SHAPE;
        arcs = grow(arcs, &capacity, total + part->arc_count, sizeof *arcs);
        counts[k] = part->arc_count;
        for (size_t i = 0; i < part->arc_count; i++, total++) {
            arcs[total] = part->arcs[i];
            arcs[total].center_x += part->origin.x - around.x;
            arcs[total].center_y += part->origin.y - around.y;
        }
    }
    if (!solid || narc_compute_union_mass(arcs, counts, count, NULL, &mass, NULL) != NARC_OK)
        mass.area = 0;
    free(arcs);
    free(counts);
    return mass.area;
}

/* The outline, and its image. */
static void put_drawing(FILE *file, const outline *of) {
    narc_contours contours;
    narc_error error;
    if (narc_flatten_path(of->path, 0, &contours, &error) != NARC_OK)
        fail_at(of->file, 0, "%s", error.message);
    for (size_t k = 0, i = 0; k < contours.count; k++) {
        for (const char *before = k ? ",[" : "["; i < contours.ends[k]; i++, before = ",")
            fprintf(file, "%s%.9g,%.9g", before, contours.points[i].x, contours.points[i].y);
        fputc(']', file);
    }
    narc_release_contours(&contours);
    fputc(']', file);
    if (of->image) {
        fprintf(file, ",\"image\":\"data:image/%s;base64,", of->is_svg ? "svg+xml" : "png");
        put_base64(file, (const unsigned char *)of->image, of->image_size);
        fputc('"', file);
    }
}

static void write_page(FILE *file, const narc_shape_list *shapes, const outline_list *outlines) {
    size_t *parts = allocate(shapes->count, sizeof *parts), bodies = 0;
    bool *shown = allocate(outlines->count, sizeof *shown);
    memset(shown, 0, outlines->count * sizeof *shown);
    fwrite(page, 1, sizeof page, file);
    fputs("{\"bodies\":[", file);
    for (size_t k = 0; k < shapes->count; k++) {
        char *name;
        const size_t count = list_parts(shapes, k, parts, &name);
        if (count == 0)
            continue;
        if (shapes->items[k].form == NARC_FORM_HALF_PLANE) { /* of which a page has no outline */
            free(name);
            continue;
        }
        fputs(bodies++ ? ",\n{\"name\":" : "\n{\"name\":", file);
        put_json_text(file, name);
        fprintf(file, ",\"area\":%.17g,\"parts\":[", measure_area(shapes, parts, count));
        for (size_t i = 0; i < count; i++) {
            fputs(i ? "," : "", file);
            put_part(file, &shapes->items[parts[i]]);
        }
        fputs("],\"outline\":[", file);
        size_t drawn = 0;
        while (drawn < outlines->count && strcmp(outlines->items[drawn].name, name) != 0)
            drawn++;
        if (drawn < outlines->count) {
            put_drawing(file, &outlines->items[drawn]);
            shown[drawn] = true;
        } else {
            fputc(']', file);
        }
        fputc('}', file);
        free(name);
    }
    fputs("\n]}\n</script>\n</html>\n", file);
    for (size_t i = 0; i < outlines->count; i++)
        if (!shown[i])
            warn_at(outlines->items[i].file, "it is not shown: no body is named '%s'",
                    narc_make_excerpt(outlines->items[i].name).text);
    free(shown);
    free(parts);
}

static void run(int argc, char **argv) {
    option options[OPTIONS] = {[OUT] = {"--out", OUTPUT_FILE, NULL}};
    name_reading_options(&options[READING]);
    const char **files = allocate((size_t)argc + 1, sizeof *files);
    const size_t count = parse_options(argc, argv, options, OPTIONS, "SHAPES", files);
    reading how = take_reading(&options[READING]);
    how.keep_images = true;
    narc_shape_list *shapes = read_shapes(files[0], NULL);
    outline_list outlines = {0};
    read_outlines(files + 1, count - 1, &how, &outlines);
    write_page(open_output(options[OUT].value ? options[OUT].value : "-"), shapes, &outlines);
    finish_report(finish_outputs());
    commit_outputs();
    free_outlines(&outlines);
    narc_destroy_shape_list(shapes);
    free(files);
}

const command view_command = {"view", "shapes over their drawings, as a page", run};
