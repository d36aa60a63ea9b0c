/* SPDX-License-Identifier: MIT
 *
 * report.c - the tables of times and the data of the plot, from the rows that ran.
 */
#include "report.h"

#include <math.h>
#include <string.h>

#include "common.h"
#include "lists.h"
#include "rows.h"

/* Lists of "title = value", divided by ";". A table has a line for each of `lines` and each of `others`, and in it the
 * time of each column's row: "$1" in its name is the value of the first, "$2" of the second. A column that ends with
 * "/ 2" also tells how many times as long the second one is. */
struct table {
    const char *title, *lines, *others, *columns;
    double unit; /* ns */
};

#define SCENES "30,000 = pile; 1,000,000 = pile-1000000"

/* The plot's curves; see plots.gp. */
static const char series[] = "narc overlap = overlap/$2/pile/BEST; narc overlap, AVX2 = overlap/$2/pile/avx2;"
                             "narc contact = contact/$2/pile/BEST; narc contact, AVX2 = contact/$2/pile/avx2;"
                             "Box2D b2CollidePolygons = contact/$2/pile/box2d; Box2D GJK = overlap/$2/pile/box2d;"
                             "libccd GJK = overlap/$2/pile/ccd-gjk; libccd MPR = overlap/$2/pile/ccd-mpr";
static const char sizes[] = "4 = n4; 6 = n6; 8 = n8; 12 = n12; 16 = n16";

static const struct table tables[] = {
    {"ns a pair, 30,000 bodies",
     "4 arcs = n4; 8 arcs = n8; 12 arcs = n12; rounded 8-gons = rounded; boxes = boxes; discs = discs; "
     "capsules = capsules; all kinds = kinds",
     "",
     "overlap = overlap/$1/pile/BEST; contact = contact/$1/pile/BEST / 6; AVX2 = contact/$1/pile/avx2 / 6;"
     "manifolds = manifold/$1/pile/BEST / 6; AVX2 = manifold/$1/pile/avx2 / 6; Box2D = contact/$1/pile/box2d;"
     "a loop = contact/$1/pile/loop",
     1},
    {"ns a pair by itself | row",
     "boxes = boxes; capsules = capsules; 8 arcs, 8-gons = n8; 8-gons = gons8; rounded 5-gons = rounded5;"
     "ball and box = balls-boxes; two balls = discs",
     "contact = contact; manifold = manifold",
     "two bodies = $2/$1/pile/BEST/alone / 5; AVX2 = $2/$1/pile/avx2/alone / 5;"
     "columns = $2/$1/pile/BEST/by1 / 5; AVX2 = $2/$1/pile/avx2/by1 / 5;"
     "Box2D = contact/$1/pile/box2d",
     1},
    {"ns a pair, 8 arcs, 30,000 bodies", "contact = contact", "",
     "two bodies = $1/n8/pile/BEST/alone; calls of 1 = $1/n8/pile/BEST/by1; 4 = $1/n8/pile/BEST/by4;"
     "16 = $1/n8/pile/BEST/by16; 64 = $1/n8/pile/BEST/by64; 256 = $1/n8/pile/BEST/by256;"
     "65,536 = $1/n8/pile/BEST/by65536",
     1},
    {"ns a pair, boxes at rest | shapes", "pyramid = pyramid", "16 = -templates; 4,096 = ",
     "overlap = overlap/squares/$1$2/BEST; contact = contact/squares/$1$2/BEST / 4;"
     "manifolds = manifold/squares/$1$2/BEST / 4; Box2D = contact/squares/$1$2/box2d",
     1},
    {"ns a pair, 8 arcs, 64 shapes",
     "boxes = boxes; pairs = pairs; both and manifolds = plain; a step of contacts that stay = stay-moving", "",
     "2,000 bodies = $1/n8/pile-2000/BEST; 30,000 = $1/n8/pile/BEST; 1,000,000 = $1/n8/pile-1000000/BEST", 1},
    {"ns a pair, a whole step | all bodies",
     "8 arcs = n8/pile; a shape a body = n8/pile-each; 4 arcs = n4/pile; 8-gons = gons8/pile; boxes = boxes/pile;"
     "capsules = capsules/pile; all kinds = kinds/pile; squares, pyramids = squares/pyramid-templates",
     "move = moving; settle = settled",
     "narc = stay-$2/$1/BEST / 3; AVX2 = stay-$2/$1/avx2 / 3; Box2D = stay-$2/$1/box2d;"
     "recycled = stay-$2-recycled/$1/BEST / 6; AVX2 = stay-$2-recycled/$1/avx2 / 6;"
     "Box2D = stay-$2-recycled/$1/box2d",
     1},
    {"ns a pair, a whole step | move",
     "30,000 of 8 arcs = n8/pile; 10,000 boxes = boxes/pile-10000; squares, pyramids = squares/pyramid-templates",
     "10 % = 1of10; 1 % = 1of100",
     "narc = stay-moving/$1/BEST/$2 / 2; Box2D = stay-moving/$1/box2d/$2;"
     "recycled = stay-moving-recycled/$1/BEST/$2 / 4; Box2D = stay-moving-recycled/$1/box2d/$2",
     1},
    {"ns a pair, all pairs new", "8 arcs = n8; boxes = boxes; all kinds = kinds", "",
     "narc = stay-rain/$1/pile/BEST / 3; plain calls = plain/$1/pile/BEST / 3; Box2D = stay-rain/$1/pile/box2d", 1},
    {"ns a pair, 30,000 bodies | shapes", "overlap = overlap; contact = contact", "boxes = boxes; 8 arcs = n8",
     "scalar = $1/$2/pile/scalar; sse41 = $1/$2/pile/sse41 / 1; neon = $1/$2/pile/neon / 1;"
     "avx2 = $1/$2/pile/avx2 / 1; avx512 = $1/$2/pile/avx512 / 1",
     1},
    {"ns a ray | bodies", "a fan of 1,080 = ray-fan; long = ray-long; short = ray-short", SCENES,
     "8 arcs = $1/n8/$2/BEST; 8-gons = $1/gons8/$2/BEST / 6; AVX2 = $1/gons8/$2/avx2 / 6;"
     "one by one = $1/gons8/$2/BEST/by1 / 6; AVX2 = $1/gons8/$2/avx2/by1 / 6; Box2D = $1/gons8/$2/box2d",
     1},
    {"ns a region | bodies", "that finds 48 = region-48; that finds 3 = region-3", SCENES,
     "batch = $1/gons8/$2/BEST / 3; one by one = $1/gons8/$2/BEST/by1 / 3; Box2D = $1/gons8/$2/box2d;"
     "GEOS = $1/gons8/$2/geos",
     1},
    {"ns a point: the nearest body", SCENES, "",
     "8-gons = nearest/gons8/$1/BEST; one by one = nearest/gons8/$1/BEST/by1;"
     "8 arcs = nearest/n8/$1/BEST;"
     "one by one = nearest/n8/$1/BEST/by1; of one that is named = distance/n8/$1/BEST",
     1},
    {"ns a question of one 8-gon",
     "does a ray hit it, and where? = named-ray; how far is a point? = distance; is a point within? = inside;"
     "the same, all points of one = inside-one",
     "",
     "batch = $1/gons8/pile/BEST / 5; AVX2 = $1/gons8/pile/avx2 / 5; one by one = $1/gons8/pile/BEST/by1 / 5;"
     "AVX2 = $1/gons8/pile/avx2/by1 / 5; Box2D = $1/gons8/pile/box2d",
     1},
    {"ns an outline",
     "the hull of 8 points = hull-8/points/clouds; of 200 = hull-200/points/clouds; an 8-arc as a polyline = "
     "polyline/n8/pile; an 8-gon = polyline/gons8/pile",
     "", "narc = $1/BEST / 2; Box2D = $1/box2d", 1},
    {"ns a pair, times of impact | motion", "boxes 1 : 1 = squares; boxes 1 : 8 = slabs; 8-gons = gons8; 8 arcs = n8",
     "straight = straight; turning by up to 1 = turning; turning by up to 6 = turning-6",
     "batch = impact-$2/$1/flights/BEST / 5; AVX2 = impact-$2/$1/flights/avx2 / 5;"
     "one by one = impact-$2/$1/flights/BEST/alone / 5; AVX2 = impact-$2/$1/flights/avx2/alone / 5;"
     "Box2D = impact-$2/$1/flights/box2d",
     1},
    {"ns a box of an index", SCENES, "", "built = index-good/gons8/$1/BEST; built `fast` = index-fast/gons8/$1/BEST",
     1},
    {"ns a box that moves in an index | so many", SCENES,
     "1, anywhere = 1; 100 = 100; 2,000 = 2000; 2,000, a little = near-2000",
     "narc = move-$2/gons8/$1/BEST; Box2D = move-$2/gons8/$1/box2d", 1},
    {"ns a body", "30,000 boxes in worlds of 32: boxes, pairs and manifolds = boxes", "", "narc = worlds/$1/pile/BEST",
     1},
    {"us a step of 30,000 boxes on ground", "of pieces of 1.1 m = hills; of 0.13 m = short-hills", "",
     "without it = ground-none/boxes/$1/BEST / 2; with it = ground-among/boxes/$1/BEST;"
     "AVX2, without it = ground-none/boxes/$1/avx2 / 4; with it = ground-among/boxes/$1/avx2",
     1000},
    {"ns a body on ground | what",
     "balls = balls/few-hills; boxes = boxes/few-hills; balls, a half-plane = balls/plane;"
     "boxes, a half-plane = boxes/plane",
     "pairs that are there = pairs; a step = among",
     "narc = ground-$2/$1/BEST / 3; AVX2 = ground-$2/$1/avx2 / 3; Box2D = ground-$2/$1/box2d", 1},
};

/* ------------------------------------------------------------------------------------------------ times */

/* The time of a row in nanoseconds a question, NaN if it did not run. "BEST" in the name is the best instruction set. */
static double time_of(const char *pattern, const char *best_isa) {
    char name[BENCH_NAME];
    const struct row *row;
    replace_word(pattern, "BEST", best_isa, name, sizeof name);
    for (size_t k = 0; (row = get_row(k)) != NULL; k++)
        if (strcmp(row->bench.name, name) == 0 && row->bench.ns > 0)
            return row->bench.ns;
    return NAN;
}

/* ------------------------------------------------------------------------------------------------ tables */

static double time_in(const char *row, const char *first, const char *second, const char *best_isa) {
    char one[BENCH_NAME], both[BENCH_NAME];
    replace_word(row, "$1", first, one, sizeof one);
    replace_word(one, "$2", second, both, sizeof both);
    return time_of(both, best_isa);
}

/* 12.3, 456, 7,890. */
static void print_number(double value, FILE *out) {
    const int whole = (int)(value + 0.5);
    if (value < 99.95)
        fprintf(out, "%.1f", value);
    else if (whole < 1000)
        fprintf(out, "%d", whole);
    else
        fprintf(out, "%d,%03d", whole / 1000, whole % 1000);
}

static void print_head(const char *title, const struct item *columns, size_t count, const bool *ran, FILE *out) {
    fprintf(out, "| %s |", title);
    for (size_t k = 0; k < count; k++)
        if (ran[k])
            fprintf(out, " %s |", columns[k].title);
    fprintf(out, "\n|");
    for (const char *bar = title; bar; bar = strchr(bar + 1, '|'))
        fprintf(out, " --- |");
    for (size_t k = 0; k < count; k++)
        if (ran[k])
            fprintf(out, " ---: |");
    fputc('\n', out);
}

/* Lines and columns of which a row ran. */
static void print_table(const struct table *table, const char *best_isa, FILE *out) {
    struct item lines[MOST_ITEMS], others[MOST_ITEMS], columns[MOST_ITEMS];
    double times[MOST_ITEMS][MOST_ITEMS][MOST_ITEMS];
    const size_t line_count = read_items(table->lines, lines);
    const size_t other_count = read_items(table->others, others);
    const size_t count = read_items(table->columns, columns);
    bool column_ran[MOST_ITEMS] = {false}, line_ran[MOST_ITEMS][MOST_ITEMS] = {{false}}, any = false;
    for (size_t i = 0; i < line_count; i++)
        for (size_t j = 0; j < other_count; j++)
            for (size_t k = 0; k < count; k++) {
                times[i][j][k] = time_in(columns[k].value, lines[i].value, others[j].value, best_isa);
                const bool ran = !isnan(times[i][j][k]);
                line_ran[i][j] |= ran;
                column_ran[k] |= ran;
                any |= ran;
            }
    if (!any)
        return;
    print_head(table->title, columns, count, column_ran, out);
    for (size_t i = 0; i < line_count; i++)
        for (size_t j = 0; j < other_count; j++) {
            if (!line_ran[i][j])
                continue;
            fprintf(out, "| %s%s%s |", lines[i].title, *others[j].title ? " | " : "", others[j].title);
            for (size_t k = 0; k < count; k++) {
                const double time = times[i][j][k], over = columns[k].over ? times[i][j][columns[k].over - 1] : NAN;
                if (!column_ran[k])
                    continue;
                if (!isnan(time)) {
                    fputc(' ', out);
                    print_number(time / table->unit, out);
                }
                if (!isnan(over / time))
                    fprintf(out, over < 2 * time ? " (%.2f)" : " (%.1f)", over / time);
                fprintf(out, " |");
            }
            fputc('\n', out);
        }
    fputc('\n', out);
}

/* Of peers that ran. */
static void print_differences(FILE *out) {
    const struct row *row;
    bool any = false;
    for (size_t k = 0; (row = get_row(k)) != NULL; k++)
        if (row->bench.ns > 0 && row->bench.wrong > 0) {
            if (!any)
                fprintf(out, "| row | other answers than the exact ones | of |\n| --- | ---: | ---: |\n");
            any = true;
            fprintf(out, "| %s | %.0f | %zu |\n", row->bench.name, row->bench.wrong, row->bench.count);
        }
    if (any)
        fputc('\n', out);
}

static void print_machine(const char *best_isa, FILE *out) {
    fprintf(out, "%s, %s, %s; %s unless said otherwise; beside %s\n\n", processor_name(), compiler_name, compiler_flags,
            best_isa, box2d_name());
}

static void print_tables(const char *best_isa, FILE *out) {
    for (size_t k = 0; k < sizeof tables / sizeof tables[0]; k++)
        print_table(&tables[k], best_isa, out);
}

void print_report(const char *best_isa, FILE *out) {
    fputc('\n', out);
    print_machine(best_isa, out);
    print_tables(best_isa, out);
    print_differences(out);
}

/* ------------------------------------------------------------------------------------------------ the plot */

static void print_value(FILE *out, double value) {
    if (isnan(value))
        fprintf(out, "\t?");
    else
        fprintf(out, "\t%.4g", value);
}

/* The table by numbers of arcs on its side: one column for each series, under its title. */
static void write_arcs(const char *best_isa, const char *folder) {
    struct item curves[MOST_ITEMS], counts[MOST_ITEMS];
    const size_t curve_count = read_items(series, curves), count = read_items(sizes, counts);
    FILE *file = open_result(folder, "arcs.dat");
    fprintf(file, "n");
    for (size_t k = 0; k < curve_count; k++)
        fprintf(file, "\t\"%s\"", curves[k].title);
    for (size_t n = 0; n < count; n++) {
        fprintf(file, "\n%s", counts[n].title);
        for (size_t k = 0; k < curve_count; k++)
            print_value(file, time_in(curves[k].value, "", counts[n].value, best_isa));
    }
    fputc('\n', file);
    close_result(file);
}

void write_report(const char *best_isa, const char *folder) {
    char path[1024];
    snprintf(path, sizeof path, "%s/bench.md", folder);
    FILE *file = fopen(path, "a");
    if (!file)
        fail("%s can't be written", path);
    fseek(file, 0, SEEK_END);
    if (ftell(file) == 0)
        print_machine(best_isa, file);
    print_tables(best_isa, file);
    close_result(file);
    if (!isnan(time_of("overlap/n8/pile/BEST", best_isa)))
        write_arcs(best_isa, folder);
}

/* ------------------------------------------------------------------------------------------------ answers */

bool is_all_right(FILE *out) {
    const struct row *row;
    bool right = true;
    for (size_t k = 0; (row = get_row(k)) != NULL; k++)
        if (row->bench.must_be_right && row->bench.wrong > 0) {
            fprintf(out, "%s: %.0f wrong answers\n", row->bench.name, row->bench.wrong);
            right = false;
        }
    return right;
}
