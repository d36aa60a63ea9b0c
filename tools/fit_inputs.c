/* SPDX-License-Identifier: MIT
 *
 * fit_inputs.c - files of any kind: which kind, which reader, which names.
 */
#include "fit_inputs.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "names.h"
#include "objects.h"
#include "progress.h"
#include "system.h"
#include "text.h"

#if NARC_SVG
#include <glib.h>
#endif

/* ---------------------------------------------------------------------------- options */

void name_reading_options(option *first) {
    static const option all[READING_OPTIONS] = {
        [CHARACTERS_OPTION] = {"--characters", true, NULL}, [IDS_OPTION] = {"--ids", true, NULL},
        [SILHOUETTE_OPTION] = {"--silhouette", true, NULL}, [THRESHOLD_OPTION] = {"--threshold", true, NULL},
        [TRACE_OPTION] = {"--trace", false, NULL},          [GRID_OPTION] = {"--grid", true, NULL}};
    memcpy(first, all, sizeof all);
}

reading take_reading(const option *first) {
    return (reading){.characters = first[CHARACTERS_OPTION].value,
                     .ids = first[IDS_OPTION].value,
                     .silhouette = first[SILHOUETTE_OPTION].value,
                     .trace = first[TRACE_OPTION].value,
                     .cells = parse_grid(first[GRID_OPTION].value),
                     .threshold = number_option(&first[THRESHOLD_OPTION], DBL_MIN, 1 - DBL_EPSILON / 2,
                                                "more than 0 and less than 1", 0)};
}

/* ---------------------------------------------------------------------------- kinds of files */

typedef enum file_kind { FONT, SVG, PNG, DXF, CSV, JSON, KIND_COUNT, UNKNOWN = KIND_COUNT } file_kind;

/* What is often given instead, how it begins, and what to do. */
static const struct {
    const char *bytes, *what;
} others[] = {
    {"GIF8", "a GIF image: save it as PNG, an animation as a sheet for --grid"},
    {"\xff\xd8\xff", "a JPEG image, which has no transparency: save it as PNG"},
    {"RIFF", "a WebP image: save it as PNG"},
    {"BM", "a BMP image: save it as PNG"},
    {"II*", "a TIFF image: save it as PNG"},
    {"MM", "a TIFF image: save it as PNG"},
    {"8BPS", "a Photoshop document: save it as PNG"},
    {"%PDF", "a PDF document: save its drawing as SVG"},
    {"AC10", "a DWG drawing: save it as DXF"},
    {"\x1f\x8b", "compressed: unpack it, of .svgz comes .svg"},
    {"PK", "an archive: unpack it"},
    {"", "neither its beginning nor its suffix is that of a font, or of SVG, PNG, DXF, CSV or JSON"},
};

/* How files begin. Fonts: TrueType, OpenType, Apple's two, collections, WOFF, Type 1 as text and in segments. XML may
 * be in UTF-16. */
static const struct {
    const char *bytes;
    size_t length;
    file_kind kind;
} beginnings[] = {
    {"\x89PNG\r\n\x1a\n", 8, PNG},
    {"\0\1\0\0", 4, FONT},
    {"OTTO", 4, FONT},
    {"true", 4, FONT},
    {"typ1", 4, FONT},
    {"ttcf", 4, FONT},
    {"wOFF", 4, FONT},
    {"wOF2", 4, FONT},
    {"%!PS-AdobeFont", 14, FONT},
    {"%!FontType1", 11, FONT},
    {"\x80\1", 2, FONT},
    {"\xff\xfe<\0", 4, SVG},
    {"\xfe\xff\0<", 4, SVG},
};
enum { BEGINNING_COUNT = sizeof beginnings / sizeof beginnings[0] };

static const struct {
    const char *suffix;
    file_kind kind;
} suffixes[] = {
    {".dxf", DXF},  {".svg", SVG},   {".xml", SVG},  {".png", PNG},   {".csv", CSV},    {".txt", CSV},
    {".tsv", CSV},  {".json", JSON}, {".ttf", FONT}, {".otf", FONT},  {".ttc", FONT},   {".otc", FONT},
    {".pfb", FONT}, {".pfa", FONT},  {".cff", FONT}, {".woff", FONT}, {".woff2", FONT},
};
enum { SUFFIX_COUNT = sizeof suffixes / sizeof suffixes[0] };

/* The part of a path that names the file, and how much of that stands before its suffix; a first dot begins none. */
static const char *base_name(const char *path, size_t *out_stem) {
    path = strcmp(path, "-") == 0 ? "stdin" : path;
    const char *base = path + folder_length(path), *dot = strrchr(base, '.');
    *out_stem = dot && dot != base ? (size_t)(dot - base) : strlen(base);
    return base;
}

static bool is_suffix(const char *text, const char *suffix) {
    for (; *text && *suffix; text++, suffix++) {
        const char lower = *text >= 'A' && *text <= 'Z' ? (char)(*text - 'A' + 'a') : *text;
        if (lower != *suffix)
            return false;
    }
    return !*text && !*suffix;
}

static file_kind kind_of_suffix(const char *file) {
    size_t stem;
    const char *base = base_name(file, &stem);
    for (size_t i = 0; i < SUFFIX_COUNT; i++)
        if (is_suffix(base + stem, suffixes[i].suffix))
            return suffixes[i].kind;
    return UNKNOWN;
}

/* A DXF file begins with a section or comments: 0 or 999, and the value on the next line. */
static bool is_dxf(const char *text) {
    const size_t digits = strspn(text, "09"), end = digits + strspn(text + digits, " \t\r\n");
    return (digits == 3 && strncmp(text, "999", 3) == 0 && end > digits) ||
           (digits == 1 && text[0] == '0' && strncmp(text + end, "SECTION", 7) == 0) ||
           strncmp(text, "AutoCAD Binary DXF", 18) == 0;
}

static file_kind kind_of(const char *file, const char *bytes, size_t size) {
    for (size_t i = 0; i < BEGINNING_COUNT; i++)
        if (size >= beginnings[i].length && memcmp(bytes, beginnings[i].bytes, beginnings[i].length) == 0)
            return beginnings[i].kind;
    const char *text = bytes + (strncmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);
    text += strspn(text, " \t\r\n");
    if (*text == '<')
        return SVG;
    if (*text == '[' || *text == '{')
        return JSON;
    const file_kind suffix = kind_of_suffix(file);
    if (is_dxf(text) || suffix == DXF)
        return DXF;
    if (*text && strchr("+-.0123456789\"", *text))
        return CSV;
    return suffix;
}

/* ---------------------------------------------------------------------------- outlines */

static outline *find_name(const outline_list *outlines, const char *name) {
    for (size_t i = 0; i < outlines->count; i++)
        if (strcmp(outlines->items[i].name, name) == 0)
            return &outlines->items[i];
    return NULL;
}

/* Takes `name`, or a copy with -2, -3 ... behind it if another outline has it. */
static char *choose_name(const outline_list *outlines, char *name) {
    enum { DIGITS = 24 };
    outline *const first = find_name(outlines, name);
    const size_t size = strlen(name) + DIGITS;
    char *chosen = strcpy(allocate(size, 1), name);
    for (size_t number = first && first->copies ? first->copies : 1; find_name(outlines, chosen);) {
        snprintf(chosen, size, "%s-%zu", name, ++number);
        first->copies = number;
    }
    free(name);
    return chosen;
}

/* Adds an empty outline; takes `name`. */
static outline *add_outline(outline_list *outlines, const char *file, uint32_t character, char *name) {
    outlines->items = grow(outlines->items, &outlines->capacity, outlines->count + 1, sizeof *outlines->items);
    outline *added = &outlines->items[outlines->count];
    *added = (outline){.name = choose_name(outlines, name), .file = file, .character = character};
    if (narc_create_path(&added->path) != NARC_OK)
        fail("not enough memory for an outline");
    outlines->count++;
    return added;
}

void report_outline(const outline *at, const char *message) {
    if (at->character)
        report_at(at->file, 0, "U+%04X: %s", (unsigned)at->character, message);
    else if (at->is_object)
        report_at(at->file, 0, "'%s': %s", narc_make_excerpt(at->name).text, message);
    else
        report_at(at->file, 0, "%s", message);
}

static void free_outline(outline *removed) {
    free(removed->name);
    free(removed->image);
    narc_destroy_path(removed->path);
}

void keep_outline(outline_list *outlines, size_t from, size_t to) {
    if (to < from) {
        const outline kept = outlines->items[from];
        outlines->items[from] = (outline){0};
        free_outline(&outlines->items[to]);
        outlines->items[to] = kept;
    }
}

void cut_outlines(outline_list *outlines, size_t count) {
    while (outlines->count > count)
        free_outline(&outlines->items[--outlines->count]);
}

/* The characters of a name: bytes that continue one begin with the bits 10. */
static size_t name_length(const char *name) {
    size_t length = 0;
    for (; *name; name++)
        length += ((unsigned char)*name & 0xc0) != 0x80;
    return length;
}

int print_name(FILE *file, const outline_list *outlines, const char *name, int width) {
    if (width == 0) {
        width = (int)name_length(name);
        for (size_t i = 0; i < outlines->count; i++) {
            const int length = (int)name_length(outlines->items[i].name);
            width = length > width ? length : width;
        }
    }
    fprintf(file, "%s%*s", name, width - (int)name_length(name), "");
    return width;
}

void print_ways(FILE *file, const outline_list *outlines) {
    for (int picture = 0; picture <= 1; picture++) {
        bool any = false;
        for (size_t i = 0; i < outlines->count; i++) {
            const outline *of = &outlines->items[i];
            if (!of->is_svg || of->is_picture != picture)
                continue;
            if (any)
                fprintf(file, ", %s", of->name);
            else
                fprintf(file, "SVG read %s: %s", picture ? "as a picture" : "exactly", of->name);
            any = true;
        }
        if (any)
            fputc('\n', file);
    }
}

char *name_part(const outline *of, size_t index, size_t count) {
    enum { DIGITS = 24 };
    const size_t size = strlen(of->name) + DIGITS;
    char *name = allocate(size, 1);
    if (count > 1)
        snprintf(name, size, "%s/%zu", of->name, index + 1);
    else
        strcpy(name, of->name);
    return name;
}

void free_outlines(outline_list *outlines) {
    cut_outlines(outlines, 0);
    free(outlines->items);
    while (outlines->file_count)
        free(outlines->files[--outlines->file_count]);
    free(outlines->files);
    *outlines = (outline_list){0};
}

/* ---------------------------------------------------------------------------- fonts */

/* Variation selectors choose between glyphs of the character before them; they are none themselves. */
static bool is_selector(uint32_t code) {
    return (code >= 0xfe00 && code <= 0xfe0f) || (code >= 0xe0100 && code <= 0xe01ef);
}

/* The characters to use, each once, in order. */
static uint32_t *list_characters(const char *text, size_t *out_count) {
    uint32_t *codes = allocate(strlen(text), sizeof *codes);
    enum { CODES = 0x110000 };
    unsigned char *seen = allocate(CODES, 1);
    memset(seen, 0, CODES);
    size_t count = 0;
    for (const char *c = text; *c;) {
        uint32_t code;
        if (!narc_next_code_point(&c, &code))
            fail("--characters is not valid UTF-8 at byte %td", c - text);
        if (!is_selector(code) && !seen[code]) {
            seen[code] = 1;
            codes[count++] = code;
        }
    }
    free(seen);
    if (count == 0)
        fail("--characters has variation selectors only");
    *out_count = count;
    return codes;
}

/* ASCII letters name themselves. Others are named by their code points: not every program shows them, and a digit would
 * be taken for an index. */
static char *glyph_name(uint32_t code) {
    const bool plain = (code >= 'A' && code <= 'Z') || (code >= 'a' && code <= 'z');
    enum { SIZE = 16 };
    char *name = allocate(SIZE, 1);
    snprintf(name, SIZE, plain ? "%c" : "U+%04X", (unsigned)code);
    return name;
}

static void read_glyphs(const char *file, const char *bytes, size_t size, const char *characters,
                        outline_list *outlines) {
    narc_error error;
    narc_font *font;
    if (!characters)
        fail_at(file, 0, "a font: --characters must tell which of its glyphs to fit");
    if (narc_open_font(bytes, size, &font, &error) != NARC_OK) {
        report_at(file, 0, "%s", error.message);
        return;
    }
    size_t count;
    uint32_t *codes = list_characters(characters, &count);
    for (size_t i = 0; i < count; i++) {
        outline *added = add_outline(outlines, file, codes[i], glyph_name(codes[i]));
        if (narc_read_glyph(font, codes[i], added->path, &error) != NARC_OK) {
            report_at(file, 0, "%s", error.message);
            cut_outlines(outlines, outlines->count - 1);
        }
    }
    narc_close_font(font);
    free(codes);
}

/* ---------------------------------------------------------------------------- what is below librsvg */

#if NARC_SVG
/* The first warning of Pango and others below librsvg, which they would print themselves. */
static char warning[256];

static GLogWriterOutput keep_warning(GLogLevelFlags level, const GLogField *fields, gsize count, gpointer context) {
    (void)context;
    for (gsize i = 0; i < count && level <= G_LOG_LEVEL_WARNING && !warning[0]; i++)
        if (strcmp(fields[i].key, "MESSAGE") == 0)
            snprintf(warning, sizeof warning, "%s", (const char *)fields[i].value);
    return G_LOG_WRITER_HANDLED;
}

static void watch_warnings(void) { g_log_set_writer_func(keep_warning, NULL, NULL); }

/* Notes the id of an element that a drawing itself holds, if it shows something. */
static void note_id(GMarkupParseContext *context, const char *element, const char **names, const char **values,
                    gpointer ids, GError **error) {
    static const char *const seen[] = {"a",        "circle", "ellipse", "g",      "image", "line", "path", "polygon",
                                       "polyline", "rect",   "svg",     "switch", "text",  "use",  NULL};
    (void)error;
    if (g_slist_length((GSList *)g_markup_parse_context_get_element_stack(context)) != 2 ||
        !g_strv_contains(seen, element))
        return;
    for (size_t k = 0; names[k]; k++)
        if (strcmp(names[k], "id") == 0)
            g_string_append_printf(ids, ",%s", values[k]);
}

/* The ids of all elements that a drawing itself holds, with commas between them; NULL, and an error is told. */
static char *list_ids(const char *file, const char *bytes, size_t size) {
    const GMarkupParser parser = {.start_element = note_id};
    GString *ids = g_string_new(NULL);
    GError *error = NULL;
    GMarkupParseContext *context = g_markup_parse_context_new(&parser, G_MARKUP_DEFAULT_FLAGS, ids, NULL);
    if (!g_markup_parse_context_parse(context, bytes, (gssize)size, &error))
        report_at(file, 0, "its ids cannot be listed, name them: %s", error->message);
    else if (ids->len == 0)
        report_at(file, 0, "no element of the drawing itself has an id");
    char *list = ids->len > 0 && !error ? strcpy(allocate(ids->len, 1), ids->str + 1) : NULL;
    g_clear_error(&error);
    g_markup_parse_context_free(context);
    g_string_free(ids, TRUE);
    return list;
}
/* What a drawing has that does not come into its outline as an artist may think. */
typedef struct surprises {
    const char *moves; /* the element, or what a style sheet has */
    bool image;
    char link[64];
} surprises;

/* Does a text begin so, in capitals or not? */
static bool begins(const char *text, const char *with) { return g_ascii_strncasecmp(text, with, strlen(with)) == 0; }

/* Notes the first place behind `mark` where a text names another file. */
static void note_link(surprises *found, const char *text, const char *mark) {
    for (const char *at = text; !found->link[0] && *at; at++) {
        if (!begins(at, mark))
            continue;
        const char *to = at + strlen(mark);
        to += strspn(to, " '\"");
        if (*to && *to != '#' && !begins(to, "data:") && !begins(to, "url("))
            snprintf(found->link, sizeof found->link, "%.*s", (int)strcspn(to, " '\");"), to);
    }
}

static void note_element(GMarkupParseContext *context, const char *element, const char **names, const char **values,
                         gpointer data, GError **error) {
    static const char *const linking[] = {"style",  "fill",         "stroke",     "clip-path",  "mask", "filter",
                                          "marker", "marker-start", "marker-mid", "marker-end", NULL};
    surprises *found = data;
    (void)context, (void)error;
    if (strncmp(element, "animate", 7) == 0 || strcmp(element, "set") == 0)
        found->moves = "animate";
    for (size_t k = 0; names[k]; k++) {
        const bool is_link = strcmp(names[k], "href") == 0 || strcmp(names[k], "xlink:href") == 0;
        const char *value = values[k] + strspn(values[k], " ");
        if (g_strv_contains(linking, names[k]))
            note_link(found, value, "url(");
        else if (is_link && begins(value, "data:"))
            found->image = found->image || strcmp(element, "image") == 0;
        else if (is_link && value[0] && value[0] != '#' && strcmp(element, "a") != 0 && !found->link[0])
            snprintf(found->link, sizeof found->link, "%s", value);
    }
}

static void note_style(GMarkupParseContext *context, const char *text, gsize size, gpointer data, GError **error) {
    surprises *found = data;
    (void)error;
    if (strcmp(g_markup_parse_context_get_element(context), "style") != 0)
        return;
    char *style = join_text(text, size, "");
    note_link(found, style, "url(");
    note_link(found, style, "@import");
    if (strstr(style, "@keyframes"))
        found->moves = "@keyframes";
    free(style);
}

/* Warns of them; what is no XML its reader tells. */
static void glance(const char *file, const char *bytes, size_t size) {
    const GMarkupParser parser = {.start_element = note_element, .text = note_style};
    surprises found = {0};
    GMarkupParseContext *context = g_markup_parse_context_new(&parser, G_MARKUP_TREAT_CDATA_AS_TEXT, &found, NULL);
    g_markup_parse_context_parse(context, bytes, (gssize)size, NULL);
    g_markup_parse_context_free(context);
    if (found.moves)
        warn_at(file, "it moves (%s): what it is before counts; save other moments as drawings of their own",
                found.moves);
    if (found.link[0])
        warn_at(file, "'%s' is another file, which is never loaded: embed it", found.link);
    if (found.image)
        warn_at(file,
                "it holds an image of pixels, which is traced with all else; a PNG file of it has its own pixels");
}
#else /* narc_read_svg() tells what is wrong */
static void glance(const char *file, const char *bytes, size_t size) { (void)file, (void)bytes, (void)size; }

static char warning[1];

static void watch_warnings(void) {}

static char *list_ids(const char *file, const char *bytes, size_t size) {
    (void)file, (void)bytes, (void)size;
    return strcpy(allocate(2, 1), "*");
}
#endif

/* ---------------------------------------------------------------------------- other files */

static narc_silhouette choose_silhouette(const char *name) {
    static const char *const names[] = {"alpha", "dark", "light"};
    for (int k = NARC_SILHOUETTE_ALPHA; name && k <= NARC_SILHOUETTE_LIGHT; k++)
        if (strcmp(name, names[k]) == 0)
            return (narc_silhouette)k;
    if (name)
        fail("--silhouette must be one of alpha, dark, light, not '%s'", narc_make_excerpt(name).text);
    return NARC_SILHOUETTE_ALPHA;
}

static narc_status call_reader(file_kind kind, const char *bytes, size_t size, const narc_image_request *how,
                               outline *out, narc_error *error) {
    narc_path *path = out->path;
    switch (kind) {
    case DXF:
        return narc_read_dxf(
            bytes, size,
            &(narc_dxf_request){.layer = how->element, .out_unit = &out->unit, .out_open = &out->open_count}, path,
            error);
    case SVG:
        return narc_read_svg(bytes, size, how, path, error);
    case PNG:
        return narc_read_png(bytes, size, how, path, error);
    case CSV:
        return narc_read_csv(bytes, size, path, error);
    default:
        return narc_read_json(bytes, size, path, error);
    }
}

/* Drawings of this size, in KB, may take long, and librsvg draws them without a report. Paths that cross themselves take
 * longest: 2,000 long curves, some 80 KB, take seconds. */
enum { KB = 1024, LARGE_DRAWING = 64 };

/* A name made of the first `length` bytes of any text: what cannot be in a name becomes '_', blanks at the ends go, and
 * digits alone, which would be an index, get "shape-" in front; of nothing it makes "shape". To be freed. */
static char *make_shape_name(const char *text, size_t length) {
    static const char prefix[] = "shape-";
    for (; length && text[0] == ' '; length--)
        text++;
    while (length && text[length - 1] == ' ')
        length--;
    char *name = allocate(length + sizeof prefix, 1);
    memcpy(name, text, length);
    name[length] = 0;
    for (char *c = name; *c;) {
        const char *next = c;
        if (narc_next_of_name(&next))
            c += next - c;
        else
            *c++ = '_';
    }
    if (length == 0) {
        strcpy(name, "shape");
    } else if (!name[strspn(name, "0123456789")]) {
        memmove(name + strlen(prefix), name, length + 1);
        memcpy(name, prefix, strlen(prefix));
    }
    return name;
}

/* The outline of a file, or of an element or a frame of it, which then gives the name. */
static void read_outline(const char *file, file_kind kind, const char *bytes, size_t size, const reading *how,
                         const char *element, outline_list *outlines) {
    size_t stem;
    const char *base = base_name(file, &stem);
    outline *added = add_outline(outlines, file, 0,
                                 element ? make_shape_name(element, strlen(element)) : make_shape_name(base, stem));
    narc_error error;
    added->is_object = element;
    if (kind == SVG)
        show_stage("drawing", size / KB, "KB of SVG", size >= LARGE_DRAWING * KB);
    bool whole = false, exact = false;
    const narc_image_request image = {choose_silhouette(how->silhouette),          how->threshold, &whole,
                                      kind == SVG || kind == DXF ? element : NULL, how->trace,     &exact};
    warning[0] = 0;
    if (call_reader(kind, bytes, size, &image, added, &error) != NARC_OK) {
        if (kind == PNG && element)
            report_at(file, 0, "frame '%s': %s", narc_make_excerpt(element).text, error.message);
        else
            report_text(file, &error);
        cut_outlines(outlines, outlines->count - 1);
        return;
    }
    if (how->keep_images && (kind == SVG || kind == PNG)) {
        added->image = memcpy(allocate(size, 1), bytes, size);
        added->image_size = size;
    }
    if (added->open_count && !how->open)
        warn_at(file,
                "%zu of its lines are open, and closed by a straight line each; narc fit --chain --open keeps them as "
                "strokes",
                added->open_count);
    added->is_svg = kind == SVG;
    added->is_picture = kind == PNG || (kind == SVG && !exact);
    if (warning[0])
        warn_at(file, "a part of it, perhaps some text, may be missing: %s", warning);
    if (whole && kind == PNG && element) /* a wall of a tileset */
        return;
    if (whole && image.silhouette == NARC_SILHOUETTE_ALPHA)
        warn_at(file, "opaque throughout, its outline is a rectangle; --silhouette dark or light traces what it shows");
    else if (whole)
        warn_at(file, "%s throughout, its outline is a rectangle", how->silhouette);
}

/* The names of a DXF drawing's layers, with commas between them; NULL, and an error is told. */
static char *list_layers(const char *file, const char *bytes, size_t size) {
    narc_error error;
    char *names = NULL;
    if (narc_list_dxf_layers(bytes, size, &names, &error) != NARC_OK)
        report_text(file, &error);
    for (char *c = names; c && *c; c++)
        *c = *c != '\n' ? *c : c[1] ? ',' : 0;
    return names;
}

static void read_elements(const char *file, file_kind kind, const char *bytes, size_t size, const reading *how,
                          outline_list *outlines) {
    const bool all = strcmp(how->ids, "*") == 0;
    char *ids = !all          ? strcpy(allocate(strlen(how->ids) + 1, 1), how->ids)
                : kind == DXF ? list_layers(file, bytes, size)
                              : list_ids(file, bytes, size);
    char *rest = ids;
    while (rest) {
        char *comma = strchr(rest, ',');
        if (comma)
            *comma = 0;
        read_outline(file, kind, bytes, size, how, rest, outlines);
        rest = comma ? comma + 1 : NULL;
    }
    free(ids);
}

typedef struct sheet_reading {
    const char *file;
    const reading *how;
    outline_list *outlines;
} sheet_reading;

static void take_outline(const char *name, const char *png, size_t size, void *context) {
    const sheet_reading *at = context;
    read_outline(at->file, PNG, png, size, at->how, name, at->outlines);
}

static narc_path *begin_outline(const char *name, void *context) {
    const sheet_reading *at = context;
    outline *added = add_outline(at->outlines, at->file, 0, make_shape_name(name, strlen(name)));
    added->is_object = true;
    return added->path;
}

static void read_cells(const char *file, const char *bytes, size_t size, sheet_reading *at) {
    size_t stem;
    const char *base = base_name(file, &stem);
    char *name = join_text(base, stem, "");
    read_grid(file, bytes, size, at->how->cells, name, take_outline, at);
    free(name);
}

/* Its control chunk stands before the first image. */
static bool is_animation(const char *bytes, size_t size) {
    for (size_t at = 8; at + 8 <= size && memcmp(bytes + at + 4, "IDAT", 4) != 0;) {
        const unsigned char *length = (const unsigned char *)bytes + at;
        if (memcmp(bytes + at + 4, "acTL", 4) == 0)
            return true;
        at += 12 + ((size_t)length[0] << 24 | (size_t)length[1] << 16 | (size_t)length[2] << 8 | length[3]);
    }
    return false;
}

static void read_file(const char *path, const reading *how, bool *met, outline_list *outlines) {
    size_t size;
    char *file = join_text(path, strlen(path), "");
    outlines->files =
        grow(outlines->files, &outlines->file_capacity, outlines->file_count + 1, sizeof *outlines->files);
    outlines->files[outlines->file_count++] = file;
    char *bytes = try_read_bytes(file, &size);
    if (!bytes)
        return;
    const file_kind kind = kind_of(file, bytes, size);
    sheet_reading at = {file, how, outlines};
    if (kind < KIND_COUNT)
        met[kind] = true;
    size_t other = 0;
    while (strncmp(bytes, others[other].bytes, strlen(others[other].bytes)) != 0)
        other++;
    if (kind == SVG)
        glance(file, bytes, size);
    else if (kind == PNG && is_animation(bytes, size))
        warn_at(file, "an animation (APNG): its first image counts; save all as a sheet for --grid");
    const bool may_be = kind == SVG || kind == PNG || kind == DXF || (kind == CSV && kind_of_suffix(file) != CSV);
    if (kind == UNKNOWN || (may_be && others[other].bytes[0]))
        report_at(file, 0, "%s", others[other].what);
    else if (kind == FONT)
        read_glyphs(file, bytes, size, how->characters, outlines);
    else if ((kind == SVG || kind == DXF) && how->ids)
        read_elements(file, kind, bytes, size, how, outlines);
    else if (kind == PNG && how->cells.width)
        read_cells(file, bytes, size, &at);
    else if ((kind != JSON && kind != SVG) || (!read_objects(file, bytes, size, begin_outline, &at) &&
                                               (kind != JSON || !read_sheet(file, bytes, size, take_outline, &at))))
        read_outline(file, kind, bytes, size, how, NULL, outlines);
    free(bytes);
}

/* The pictures of a folder; with characters fonts are some. */
static void read_folder(const char *folder, char **paths, size_t count, const reading *how, bool *met,
                        outline_list *outlines) {
    size_t taken = 0;
    for (size_t k = 0; k < count; k++) {
        const file_kind kind = kind_of_suffix(paths[k]);
        if (kind == SVG || kind == PNG || (kind == FONT && how->characters)) {
            read_file(paths[k], how, met, outlines);
            taken++;
        }
        free(paths[k]);
    }
    free(paths);
    if (taken == 0)
        report_at(folder, 0, "a folder without .svg or .png files");
}

void read_outlines(const char *const *files, size_t count, const reading *how, outline_list *out_outlines) {
    bool met[KIND_COUNT] = {false};
    watch_warnings();
    for (size_t i = 0; i < count; i++) {
        size_t inside;
        char **paths = strcmp(files[i], "-") == 0 ? NULL : list_folder(files[i], &inside);
        if (paths)
            read_folder(files[i], paths, inside, how, met, out_outlines);
        else
            read_file(files[i], how, met, out_outlines);
    }
    if (how->characters && !met[FONT])
        fail("--characters is for fonts, and none is given");
    if (how->ids && !met[SVG] && !met[DXF])
        fail("--ids is for SVG and DXF, and neither is given");
    if (how->cells.width && !met[PNG])
        fail("--grid is for PNG, and none is given");
    if (how->threshold > 0 && !met[PNG] && !met[SVG])
        fail("--threshold is for PNG and SVG, and neither is given");
    if (how->silhouette && !met[PNG] && !met[SVG])
        fail("--silhouette is for PNG and SVG, and neither is given");
}
