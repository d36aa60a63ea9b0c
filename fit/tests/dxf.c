/* SPDX-License-Identifier: MIT
 *
 * dxf.c - DXF drawings: arcs stay exact, strokes are joined, blocks placed; what is wrong is told by line and value.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fit_support.h"

#define BEGIN "  0\nSECTION\n  2\nENTITIES\n"
#define END   "  0\nENDSEC\n  0\nEOF\n"
#define ROUND_BOX                                                                                                      \
    "0\nLWPOLYLINE\n100\nAcDbPolyline\n8\nplate\n90\n8\n70\n1\n10\n10\n20\n0\n10\n90\n20\n0\n42\n0."                   \
    "41421356237309503\n"                                                                                              \
    "10\n100\n20\n10\n10\n100\n20\n50\n42\n0.41421356237309503\n10\n90\n20\n60\n10\n10\n20\n60\n42\n0."                \
    "41421356237309503\n"                                                                                              \
    "10\n0\n20\n50\n10\n0\n20\n10\n42\n0.41421356237309503\n"
#define SLOT                                                                                                           \
    "0\nLINE\n8\nslot\n10\n40\n20\n28\n11\n60\n21\n28\n0\nARC\n8\nslot\n10\n60\n20\n30\n40\n2\n50\n270\n51\n90\n"      \
    "0\nLINE\n8\nslot\n10\n40\n20\n32\n11\n60\n21\n32\n0\nARC\n8\nslot\n10\n40\n20\n30\n40\n2\n50\n90\n51\n270\n"
#define BLOCKS                                                                                                         \
    "0\nSECTION\n2\nHEADER\n9\n$"                                                                                      \
    "INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nhole\n70\n0\n10\n1\n20\n1\n"                \
    "0\nCIRCLE\n8\n0\n10\n1\n20\n1\n40\n2\n0\nENDBLK\n8\n0\n0\nENDSEC\n"

static void read(const char *text, const char *layer, narc_path **out) {
    narc_error error;
    *out = make_path();
    expect_ok(narc_read_dxf(text, strlen(text), &(narc_dxf_request){.layer = layer}, *out, &error), &error);
}

static void expect_area(const char *text, const char *layer, size_t contours, double area) {
    AUTO(narc_destroy_path_at) narc_path *path;
    AUTO(narc_release_contours) narc_contours flat;
    double sum = 0;
    read(text, layer, &path);
    assert_int_equal(narc_flatten_path(path, 2e-8, &flat, NULL), NARC_OK);
    assert_int_equal(flat.count, contours);
    for (size_t k = 0; k < flat.count; k++)
        sum += fabs(measure_area(&flat, k));
    if (!(fabs(sum - area) <= 1e-5))
        fail_msg("area %.9g, expected %.9g", sum, area);
}

static const double PI_ = 3.14159265358979323846;

TEST(arcs_stay_arcs) {
    AUTO(narc_destroy_path_at) narc_path *path;
    narc_arc_chains chains;
    narc_error error;
    size_t arcs = 0, lines = 0;
    read(BEGIN ROUND_BOX SLOT END, NULL, &path);
    expect_ok(narc_fit_fewest_chains(path, 0.01, false, &chains, &error), &error);
    assert_int_equal(chains.count, 2);
    for (size_t k = 0; k < chains.arc_count; k++) {
        const narc_curve_arc *a = &chains.arcs[k];
        lines += a->turn == 0;
        arcs += a->turn != 0;
        const double radius = fabs(a->radius - 10) < 1 ? 10 : 2;
        assert_true(a->turn == 0 || fabs(a->radius - radius) <= 1e-11);
    }
    assert_int_equal(arcs, 6);
    assert_int_equal(lines, 6);
    narc_release_chains(&chains);
    expect_area(BEGIN ROUND_BOX SLOT END, "plate", 1, 6000 - (4 - PI_) * 100);
    expect_area(BEGIN ROUND_BOX SLOT END, "slot", 1, 80 + 4 * PI_);
}

TEST(a_polyline_of_old_files) {
    expect_area(BEGIN "0\nPOLYLINE\n8\na\n66\n1\n70\n1\n0\nVERTEX\n8\na\n10\n0\n20\n0\n42\n1\n0\nVERTEX\n8\na\n10\n4\n2"
                      "0\n0\n0\nVERTEX\n"
                      "8\na\n10\n4\n20\n3\n0\nVERTEX\n8\na\n10\n0\n20\n3\n0\nSEQEND\n8\na\n" END,
                NULL, 1, 12 + 2 * PI_);
}

TEST(blocks_and_units) {
    static const char text[] =
        BLOCKS BEGIN "0\nINSERT\n8\nholes\n2\nhole\n10\n20\n20\n20\n41\n2\n42\n2\n70\n2\n71\n3\n44\n60\n45\n20\n"
                     "0\nINSERT\n8\nflat\n2\nhole\n10\n20\n20\n20\n41\n2\n42\n1\n50\n30\n" END;
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    double unit = 7;
    size_t open = 7;
    AUTO(free_at) char *names;
    narc_error error;
    expect_area(text, "holes", 6, 6 * 16 * PI_);
    expect_area(text, "flat", 1, 8 * PI_);
    expect_ok(
        narc_read_dxf(text, strlen(text), &(narc_dxf_request){.out_unit = &unit, .out_open = &open}, path, &error),
        &error);
    assert_true(unit == 0.001 && open == 0);
    expect_ok(narc_list_dxf_layers(text, strlen(text), &names, &error), &error);
    assert_string_equal(names, "holes\nflat\n");
}

TEST(curves) {
    expect_area(
        BEGIN "0\nELLIPSE\n8\na\n10\n1\n20\n2\n30\n0\n11\n4\n21\n0\n31\n0\n40\n0.5\n41\n0\n42\n6.283185307179586\n" END,
        NULL, 1, 8 * PI_);
    /* A Bezier curve 0,0 3,0 3,3 0,3, closed by a line. */
    expect_area(BEGIN "0\nSPLINE\n8\na\n70\n8\n71\n3\n72\n8\n73\n4\n74\n0\n40\n0\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40"
                      "\n1\n40\n1\n10\n0\n20\n0\n"
                      "10\n3\n20\n0\n10\n3\n20\n3\n10\n0\n20\n3\n" END,
                NULL, 1, 5.4);
    /* Seen from behind, x is turned round. */
    expect_area(BEGIN "0\nARC\n8\na\n10\n0\n20\n0\n40\n2\n50\n0\n51\n180\n210\n0\n220\n0\n230\n-1\n0\nLINE\n8\na\n10\n-"
                      "2\n20\n0\n11\n2\n21\n0\n" END,
                NULL, 1, 2 * PI_);
}

static narc_status read_usual(const void *data, size_t size, narc_path *path, narc_error *error) {
    return narc_read_dxf(data, size, NULL, path, error);
}

TEST(what_is_wrong) {
    static const struct wrong cases[] = {
        {"AutoCAD Binary DXF\r\n\x1a", NARC_ERROR_FORMAT, 0, "ASCII"},
        {BEGIN "0\nCIRCLE\n8\na\n10\n1\n20\n1\n40\n-2\n" END, NARC_ERROR_RADIUS, 6, "CIRCLE"},
        {BEGIN "0\nCIRCLE\n8\na\n10\none\n20\n1\n40\n2\n" END, NARC_ERROR_FORMAT, 10, "'one'"},
        {BEGIN "0\nCIRCLE\n8\na\n10\n1e99\n20\n1\n40\n2\n" END, NARC_ERROR_SIZE, 10, "1e99"},
        {BEGIN "0\nCIRCLE\nx\na\n" END, NARC_ERROR_FORMAT, 7, "'x'"},
        {BEGIN "0\nLWPOLYLINE\n90\n2000000000\n" END, NARC_ERROR_FORMAT, 8, "2000000000"},
        {BEGIN "0\nLWPOLYLINE\n90\n90000000\n" END, NARC_ERROR_FORMAT, 8, "90000000"},
        {BEGIN "0\nCIRCLE\n8\na\n10\n1\n20\n1\n40\n2\n", NARC_ERROR_FORMAT, 14, "not whole"},
        {BEGIN "0\nCIRCLE\n8\na\n10\n1\n20\n1\n40\n", NARC_ERROR_FORMAT, 13, "'40'"},
        {BEGIN "0\nINSERT\n8\na\n2\nbolt\n10\n1\n20\n1\n" END, NARC_ERROR_FORMAT, 6, "'bolt'"},
        {BEGIN END, NARC_ERROR_FORMAT, 0, "nothing is drawn"},
        {"0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\na\n10\n0\n20\n0\n0\nINSERT\n2\na\n10\n0\n20\n0\n0\nENDBLK\n0\nENDSEC"
         "\n" BEGIN "0\nINSERT\n2\na\n10\n0\n20\n0\n" END,
         NARC_ERROR_FORMAT, 14, "too deep"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        expect_wrong_text(read_usual, cases[k].text, strlen(cases[k].text), cases[k].status, cases[k].line,
                          cases[k].words);
}

TEST(any_bytes) {
    static const char whole[] = BLOCKS BEGIN ROUND_BOX SLOT "0\nINSERT\n8\nholes\n2\nhole\n10\n20\n20\n20\n" END;
    struct test_random random = test_random_named("DXF");
    for (size_t trial = 0, trials = test_trials(300); trial < trials; trial++) {
        char text[sizeof whole + 3];
        memcpy(text, whole, sizeof whole);
        const size_t size = random_damage(&random, text, sizeof whole - 1);
        AUTO(narc_destroy_path_at) narc_path *path = make_path();
        narc_error error;
        const narc_status status = narc_read_dxf(text, size, NULL, path, &error);
        assert_true(status == NARC_OK || (status != NARC_ERROR_MEMORY && error.message[0]));
    }
}

TEST_MAIN("DXF")
