/* SPDX-License-Identifier: MIT
 *
 * report.c - the tables of times and the data of the plots, from the rows that ran.
 */
#include "report.h"

#include <math.h>
#include <string.h>

#include "common.h"
#include "lists.h"
#include "rows.h"

/* Lists of "title = value", divided by ";". A table has a line for each of `lines` and each of `others`, and in it the
 * time of each column's row: "$1" in its name is the value of the first, "$2" of the second. A column that ends with
 * "/ 2" is also told in times of the second one. */
struct table {
    const char *title, *lines, *others, *columns;
    double unit; /* ns */
};

#define SCENES                                                                                                         \
    "1,000 pile = pile-1000; 1,000 sparse = sparse-1000; 30,000 pile = pile; 30,000 sparse = sparse; "                 \
    "1,000,000 pile = pile-1000000; 1,000,000 sparse = sparse-1000000"

/* The plot's curves; see plots.gp. */
static const char series[] = "narc overlap = overlap/$2/mixed/BEST; narc overlap, AVX2 = overlap/$2/mixed/avx2;"
                             "narc contact = contact/$2/mixed/BEST; narc contact, AVX2 = contact/$2/mixed/avx2;"
                             "Box2D b2CollidePolygons = contact/$2/mixed/box2d; Box2D GJK = overlap/$2/mixed/box2d;"
                             "Chipmunk cpShapesCollide = contact/$2/mixed/chipmunk;"
                             "libccd GJK = overlap/$2/mixed/ccd-gjk; libccd MPR = overlap/$2/mixed/ccd-mpr";
static const char sizes[] = "4 = n4; 6 = n6; 8 = n8; 12 = n12; 16 = n16";

static const struct table tables[] = {
    {"ns a pair, 30,000 bodies | shapes",
     "4 arcs = n4; 8 arcs = n8; 12 arcs = n12; rounded 8-gons = rounded; boxes = boxes; discs = discs; "
     "capsules = capsules; all kinds = kinds",
     "64 = pile; 4,096 = pile-unlike",
     "overlap = overlap/$1/$2/BEST; contact = contact/$1/$2/BEST;"
     "manifolds = manifold/$1/$2/BEST; Box2D (times contact) = contact/$1/$2/box2d / 2;"
     "Chipmunk = contact/$1/$2/chipmunk / 2; a loop = contact/$1/$2/loop / 2",
     1},
    {"ns a pair, boxes at rest | shapes", "pyramid = pyramid; lattice = lattice", "16 = -templates; 4,096 = ",
     "overlap = overlap/squares/$1$2/BEST; contact = contact/squares/$1$2/BEST;"
     "manifolds = manifold/squares/$1$2/BEST; Box2D (times manifolds) = contact/squares/$1$2/box2d / 3",
     1},
    {"ns a pair, 8 arcs, 64 shapes",
     "boxes = boxes; pairs = pairs; both and manifolds = plain; a step of contacts that stay = stay-moving", "",
     "2,000 bodies = $1/n8/pile-2000/BEST; 30,000 = $1/n8/pile/BEST; 1,000,000 = $1/n8/pile-1000000/BEST;"
     "2 threads = $1/n8/pile-1000000/BEST/2threads / 3",
     1},
    {"ns a pair, a whole step | all bodies",
     "8 arcs = n8/pile; a shape a body = n8/pile-each; 4 arcs = n4/pile; 8-gons = gons8/pile; boxes = boxes/pile;"
     "capsules = capsules/pile; all kinds = kinds/pile; squares, pyramids = squares/pyramid-templates",
     "move = moving; settle = settled",
     "narc = stay-$2/$1/BEST; AVX2 = stay-$2/$1/avx2 / 1; Box2D = stay-$2/$1/box2d / 1; recycled = "
     "stay-$2-recycled/$1/BEST;"
     "AVX2 = stay-$2-recycled/$1/avx2 / 4; Box2D = stay-$2-recycled/$1/box2d / 4",
     1},
    {"ns a pair, a whole step | move",
     "30,000 of 8 arcs = n8/pile; 10,000 boxes = boxes/pile-10000; squares, pyramids = squares/pyramid-templates",
     "10 % = 1of10; 1 % = 1of100; none = 1of0",
     "narc = stay-moving/$1/BEST/$2; Box2D = stay-moving/$1/box2d/$2 / 1; recycled = stay-moving-recycled/$1/BEST/$2;"
     "Box2D = stay-moving-recycled/$1/box2d/$2 / 3",
     1},
    {"ns a pair, all pairs new", "8 arcs = n8; boxes = boxes; all kinds = kinds", "",
     "narc = stay-rain/$1/pile/BEST; plain calls = plain/$1/pile/BEST / 1; Box2D = stay-rain/$1/pile/box2d / 1", 1},
    {"ns a pair, mixed scene, 4,096 shapes, n =", series, NULL, sizes, 1},
    {"ns a ray | bodies", "a fan of 1,080 = ray-fan; long = ray-long; short = ray-short", SCENES,
     "8 arcs = $1/n8/$2/BEST; 8-gons = $1/gons8/$2/BEST; one by one = $1/gons8/$2/BEST/by1;"
     "Box2D (times 8-gons) = $1/gons8/$2/box2d / 2; Chipmunk = $1/gons8/$2/chipmunk / 2",
     1},
    {"ns a region | bodies", "that finds 48 = region-48; that finds 3 = region-3", SCENES,
     "batch = $1/gons8/$2/BEST; one by one = $1/gons8/$2/BEST/by1; 2 threads = $1/gons8/$2/BEST/2threads / 1;"
     "Box2D (times batch) = $1/gons8/$2/box2d / 1; Chipmunk = $1/gons8/$2/chipmunk / 1; GEOS = $1/gons8/$2/geos / 1",
     1},
    {"ns a point: the nearest body", SCENES, "",
     "8-gons = nearest/gons8/$1/BEST; one by one = nearest/gons8/$1/BEST/by1;"
     "Chipmunk (times 8-gons) = nearest/gons8/$1/chipmunk / 1; GEOS = nearest/gons8/$1/geos / 1;"
     "8 arcs = nearest/n8/$1/BEST; one by one = nearest/n8/$1/BEST/by1;"
     "2 threads = nearest/n8/$1/BEST/2threads / 5; inside = nearest-inside/n8/$1/BEST / 5;"
     "distance by pair = distance/n8/$1/BEST; of one body = distance-of-one/n8/$1/BEST",
     1},
    {"ns a pair, times of impact | motion", "boxes 1 : 1 = squares; boxes 1 : 8 = slabs; 8-gons = gons8; 8 arcs = n8",
     "straight = straight; straight, anywhere = straight-anywhere; turning by up to 1 = turning;"
     "turning by up to 1, anywhere = turning-anywhere; turning by up to 6 = turning-6",
     "contact = impact-contact/$1/flights/BEST; cast (times contact) = impact-$2/$1/flights/BEST / 1;"
     "one by one = impact-$2/$1/flights/BEST/by1; Box2D (times cast) = impact-$2/$1/flights/box2d / 2",
     1},
    {"ns a box of an index", SCENES, "",
     "built = index-good/gons8/$1/BEST; 2 threads = index-good/gons8/$1/BEST/2threads / 1;"
     "built `fast` = index-fast/gons8/$1/BEST; 2 threads = index-fast/gons8/$1/BEST/2threads / 3;"
     "refitted = index-refit/gons8/$1/BEST; 2 threads = index-refit/gons8/$1/BEST/2threads / 5",
     1},
    {"us a step of 30,000 boxes on ground", "of pieces of 1.1 m = hills; of 0.13 m = short-hills", "",
     "without it = ground-none/boxes/$1/BEST; with it = ground-among/boxes/$1/BEST", 1000},
};

/* ------------------------------------------------------------------------------------------------ times */

double time_of(const char *names, const char *best_isa) {
    char name[BENCH_NAME], first[BENCH_NAME];
    const char *more = strstr(names, " + ");
    const struct row *row;
    if (more) {
        snprintf(first, sizeof first, "%.*s", (int)(more - names), names);
        return time_of(first, best_isa) + time_of(more + 3, best_isa);
    }
    replace_word(names, "BEST", best_isa, name, sizeof name);
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

static void print_head(const char *title, const struct item *columns, size_t count, FILE *out) {
    fprintf(out, "| %s |", title);
    for (size_t k = 0; k < count; k++)
        fprintf(out, " %s |", columns[k].title);
    fprintf(out, "\n|");
    for (const char *bar = title; bar; bar = strchr(bar + 1, '|'))
        fprintf(out, " --- |");
    for (size_t k = 0; k < count; k++)
        fprintf(out, " ---: |");
    fputc('\n', out);
}

/* Lines of which a row ran. Where the lines have the rows' names, columns stand for "$2" in them. */
static void print_table(const struct table *table, const char *best_isa, FILE *out) {
    struct item lines[MOST_ITEMS], others[MOST_ITEMS], columns[MOST_ITEMS];
    const size_t line_count = read_items(table->lines, lines);
    const size_t other_count = read_items(table->others ? table->others : "", others);
    const size_t count = read_items(table->columns, columns);
    bool headed = false;
    for (size_t line = 0; line < line_count; line++)
        for (size_t other = 0; other < other_count; other++) {
            double times[MOST_ITEMS];
            bool any = false;
            for (size_t k = 0; k < count; k++) {
                times[k] = table->others ? time_in(columns[k].value, lines[line].value, others[other].value, best_isa)
                                         : time_in(lines[line].value, "", columns[k].value, best_isa);
                any |= !isnan(times[k]);
            }
            if (!any)
                continue;
            if (!headed)
                print_head(table->title, columns, count, out);
            headed = true;
            fprintf(out, "| %s%s%s |", lines[line].title, *others[other].title ? " | " : "", others[other].title);
            for (size_t k = 0; k < count; k++) {
                const double over = columns[k].over ? times[columns[k].over - 1] : NAN;
                if (!isnan(times[k])) {
                    fputc(' ', out);
                    print_number(times[k] / table->unit, out);
                }
                if (!isnan(times[k] / over))
                    fprintf(out, times[k] < over ? " (%.2f)" : " (%.1f)", times[k] / over);
                fprintf(out, " |");
            }
            fputc('\n', out);
        }
    if (headed)
        fputc('\n', out);
}

/* If any but the best ran. */
static void print_instruction_sets(const char *best_isa, FILE *out) {
    char columns[512] = "";
    for (size_t k = 0; narc_isa_name(k); k++)
        if (narc_isa_supported(narc_isa_name(k)))
            snprintf(columns + strlen(columns), sizeof columns - strlen(columns), "%s%s = $1/$2/pile/%s",
                     *columns ? "; " : "", narc_isa_name(k), narc_isa_name(k));
    const struct table table = {
        "ns a pair, piles of 30,000 bodies | shapes",
        "overlap = overlap; contact = contact; manifolds = manifold; boxes = boxes; pairs = pairs",
        "discs = discs; boxes = boxes; 8 arcs = n8; rounded 8-gons = rounded", columns, 1};
    if (!isnan(time_of("overlap/discs/pile/scalar", best_isa)))
        print_table(&table, best_isa, out);
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

void print_report(const char *best_isa, FILE *out) {
    fprintf(out, "\n%s, %s, %s; %s unless said otherwise; one thread; beside %s\n\n", processor_name(), compiler_name,
            compiler_flags, best_isa, box2d_name());
    print_targets(best_isa, out);
    for (size_t k = 0; k < sizeof tables / sizeof tables[0]; k++)
        print_table(&tables[k], best_isa, out);
    print_instruction_sets(best_isa, out);
    print_differences(out);
}

/* ------------------------------------------------------------------------------------------------ plots */

static void print_value(FILE *out, double value) {
    if (isnan(value))
        fprintf(out, "\t?");
    else
        fprintf(out, "\t%.4g", value);
}

/* The table of the mixed scene on its side: one column for each series, under its title. */
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

/* Pairs per second against the size of a batch, with 1 and with 2 threads. */
static void write_batches(const char *best_isa, const char *folder) {
    FILE *file = open_result(folder, "batches.dat");
    fprintf(file, "pairs\t\"1 thread\"\t\"2 threads\"\n");
    for (size_t pairs = 64; pairs <= 262144; pairs *= 4) {
        char size[32];
        snprintf(size, sizeof size, "%zupairs", pairs);
        fprintf(file, "%zu", pairs);
        print_value(file, 1e9 / time_in("overlap/n8/pile-1000000/BEST/$1", size, "", best_isa));
        print_value(file, 1e9 / time_in("overlap/n8/pile-1000000/BEST/2threads/$1", size, "", best_isa));
        fputc('\n', file);
    }
    close_result(file);
}

void write_report(const char *best_isa, const char *folder) {
    char path[1024];
    snprintf(path, sizeof path, "%s/bench.md", folder);
    FILE *file = fopen(path, "a");
    if (!file)
        fail("%s can't be written", path);
    print_report(best_isa, file);
    close_result(file);
    if (!isnan(time_of("overlap/n8/mixed/BEST", best_isa)))
        write_arcs(best_isa, folder);
    if (!isnan(time_of("overlap/n8/pile-1000000/BEST/2threads/64pairs", best_isa)))
        write_batches(best_isa, folder);
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
