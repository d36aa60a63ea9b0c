/* SPDX-License-Identifier: MIT
 *
 * vtk_xml.c - the XML of files for ParaView.
 */
#include "vtk_xml.h"

#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------ arrays */

static void write_base64(FILE *file, const unsigned char *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const size_t rest = size - i;
        const unsigned word = (unsigned)bytes[i] << 16 | (rest > 1 ? (unsigned)bytes[i + 1] << 8 : 0) |
                              (rest > 2 ? (unsigned)bytes[i + 2] : 0);
        const char four[4] = {digits[word >> 18], digits[word >> 12 & 63], rest > 1 ? digits[word >> 6 & 63] : '=',
                              rest > 2 ? digits[word & 63] : '='};
        fwrite(four, 1, 4, file);
    }
}

void vtk_add_word(vtk_column *c, uint32_t word) {
    if (c->count + 2 >= c->capacity) {
        const size_t capacity = 2 * c->capacity + 1024;
        uint32_t *larger = realloc(c->words, capacity * sizeof *larger);
        if (!larger) {
            c->failed = true;
            return;
        }
        c->words = larger;
        c->capacity = capacity;
    }
    c->words[2 + c->count++] = word;
}

void vtk_add_number(vtk_column *c, double value) {
    const float rounded = (float)value;
    uint32_t word;
    memcpy(&word, &rounded, sizeof word);
    vtk_add_word(c, word);
}

void vtk_write_column(FILE *file, vtk_column *c, const char *type, const char *name, int components) {
    const uint64_t size = c->count * sizeof *c->words;
    fprintf(file, "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">", type, name,
            components);
    if (c->words) {
        memcpy(c->words, &size, sizeof size);
        write_base64(file, (const unsigned char *)c->words, sizeof size + size);
    } else {
        write_base64(file, (const unsigned char *)&size, sizeof size);
    }
    fprintf(file, "</DataArray>\n");
    c->count = 0;
}

void vtk_add_place(vtk_column *c, double x, double y) {
    vtk_add_number(c, x);
    vtk_add_number(c, y);
    vtk_add_number(c, 0);
}

/* ------------------------------------------------------------------------------------------------ parts of a file */

void vtk_write_head(FILE *file, const dem *d, size_t points, size_t vertices, size_t polygons) {
    const uint16_t probe = 1;
    unsigned char first;
    memcpy(&first, &probe, 1);
    fprintf(file,
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n"
            "  <PolyData>\n"
            "    <FieldData>\n"
            "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">%.17g"
            "</DataArray>\n"
            "    </FieldData>\n"
            "    <Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
            "NumberOfPolys=\"%zu\">\n",
            first ? "LittleEndian" : "BigEndian", d->time, points, vertices, polygons);
}

void vtk_write_tail(FILE *file) { fprintf(file, "    </Piece>\n  </PolyData>\n</VTKFile>\n"); }

void vtk_open_section(FILE *file, const char *name) { fprintf(file, "      <%s>\n", name); }

void vtk_close_section(FILE *file, const char *name) { fprintf(file, "      </%s>\n", name); }

/* ------------------------------------------------------------------------------------------------ the list of frames */

static void write_escaped(FILE *file, const char *text) {
    for (; *text; text++) {
        const char *name = *text == '&' ? "&amp;" : *text == '<' ? "&lt;" : *text == '"' ? "&quot;" : NULL;
        if (name)
            fputs(name, file);
        else
            fputc(*text, file);
    }
}

static const char ENTRY[] = "    <DataSet timestep=\"";

/* Copies the lines of earlier frames from a list that is there. One that is not there is an empty one. */
static void copy_entries(FILE *to, const char *path, uint64_t frame) {
    FILE *old = fopen(path, "r");
    char line[2 * DEM_PATH_SIZE];
    while (old && fgets(line, sizeof line, old)) {
        const char *number = strrchr(line, '-');
        if (strncmp(line, ENTRY, sizeof ENTRY - 1) == 0 && number && strtoull(number + 1, NULL, 10) < frame)
            fputs(line, to);
    }
    if (old)
        fclose(old);
}

bool vtk_list_frame(const dem *d, const char *stem, uint64_t frame, char *error) {
    char path[DEM_PATH_SIZE];
    dem_file list;
    snprintf(path, sizeof path, "%.1000s.pvd", stem);
    if (!dem_open_file(&list, path, error))
        return false;
    const char *slash = strrchr(stem, '/');
    fprintf(list.file, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n");
    copy_entries(list.file, path, frame);
    fprintf(list.file, "%s%.17g\" part=\"0\" file=\"", ENTRY, d->time);
    write_escaped(list.file, slash ? slash + 1 : stem);
    fprintf(list.file, "-%06llu.vtp\"/>\n  </Collection>\n</VTKFile>\n", (unsigned long long)frame);
    return dem_close_file(&list, true, error);
}
