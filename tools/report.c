/* SPDX-License-Identifier: MIT
 *
 * report.c - reports as JSON, for programs.
 */
#include "report.h"

#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "fail.h"
#include "output.h"
#include "text.h"

bool wants_json(const option *given) {
    if (given->value && strcmp(given->value, "json") != 0)
        fail("--report must be json, not '%s'", narc_make_excerpt(given->value).text);
    return given->value;
}

static void put_told(FILE *file, const char *path, bool errors) {
    size_t count, shown = 0;
    const told *all = list_told(&count);
    for (size_t i = 0; i < count; i++) {
        if (all[i].is_error != errors || strcmp(all[i].path, path) != 0)
            continue;
        fputs(shown++ ? ", {" : "{", file);
        if (all[i].line)
            fprintf(file, "\"line\": %zu, ", all[i].line);
        fputs("\"text\": ", file);
        put_json_text(file, all[i].text);
        fputc('}', file);
    }
}

void put_input(FILE *file, const char *path) {
    fputs("{\"file\": ", file);
    put_json_text(file, path);
    fputs(", \"warnings\": [", file);
    put_told(file, path, false);
    fputs("], \"errors\": [", file);
    put_told(file, path, true);
    fputs("]", file);
}

static void put_collider(FILE *file, const collider *of) {
    size_t arcs = 0, edges = 0;
    for (size_t k = 0; k < of->count; k++) {
        arcs += of->fits[k].arc_count;
        edges += of->fits[k].edge_count;
    }
    const bool is_hull = of->outline_area == 0;
    fprintf(file,
            ", \"arcs\": %zu, \"edges\": %zu, \"area\": %.10g, \"%s\": %.10g, \"distance\": %.6g, \"seconds\": %.3f",
            arcs, edges, is_hull ? of->fits->area : of->area, is_hull ? "hull_area" : "outline_area",
            is_hull ? of->fits->hull_area : of->outline_area, of->distance, of->seconds);
}

void put_fits(FILE *file, const outline_list *outlines, const collider *fits, const narc_arc_chains *chains,
              char *const *kinds, const char *out) {
    size_t begun = 0, next = 0, count, told_count;
    const told *all = list_told(&told_count);
    fputs("{\"inputs\": [", file);
    for (size_t f = 0; f < outlines->file_count; f++) {
        const char *path = outlines->files[f];
        fputs(begun++ ? ",\n  " : "\n  ", file);
        put_input(file, path);
        fputs(", \"shapes\": [", file);
        bool any = false;
        for (size_t i = 0; i < outlines->count; i++) {
            const outline *of = &outlines->items[i];
            if (of->file != path)
                continue;
            count = fits ? fits[i].count : chains[i].count;
            fputs(any ? ",\n    {\"name\": " : "\n    {\"name\": ", file);
            put_json_text(file, of->name);
            fprintf(file, ", \"way\": \"%s\", \"kind\": \"%s\", \"parts\": %zu",
                    of->is_picture ? "picture" : "geometry",
                    count == 1 ? kinds[next]
                    : fits     ? "parts"
                               : "chains",
                    count);
            if (fits)
                put_collider(file, &fits[i]);
            else
                fprintf(file, ", \"arcs\": %zu, \"edges\": %zu, \"distance\": %.6g", count_curved(&chains[i]),
                        chains[i].arc_count - count_curved(&chains[i]), chains[i].distance);
            char *own = expand_pattern(out, of->name);
            fputs(", \"out\": ", file);
            put_json_text(file, own ? own : out);
            fputc('}', file);
            free(own);
            any = true;
            next += count;
        }
        fputs("]}", file);
    }
    for (size_t i = 0; i < told_count; i++) { /* of what is no input itself, such as a folder or a sheet's image */
        bool is_known = false;
        for (size_t f = 0; f < outlines->file_count; f++)
            is_known = is_known || strcmp(outlines->files[f], all[i].path) == 0;
        for (size_t k = 0; k < i; k++)
            is_known = is_known || strcmp(all[k].path, all[i].path) == 0;
        if (is_known)
            continue;
        fputs(begun++ ? ",\n  " : "\n  ", file);
        put_input(file, all[i].path);
        fputs(", \"shapes\": []}", file);
    }
    fputs("\n]}\n", file);
}
