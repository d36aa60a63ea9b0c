/* SPDX-License-Identifier: MIT
 *
 * points.c - points from CSV and JSON: what is read, each error with its place, damaged texts; and their hull.
 */
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fit_support.h"

/* `expected` as contours, each ended by a point of NAN, and the last by two. */
static void expect_points(reader *read, const char *text, const narc_point *expected) {
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error;
    expect_ok(read_exactly(read, text, strlen(text), path, &error), &error);
    AUTO(narc_release_contours) narc_contours contours = flatten(path);
    size_t contour = 0, point = 0;
    for (size_t i = 0; contour == 0 || !isnan(expected[i].x); contour++, i++) {
        for (; !isnan(expected[i].x); i++, point++) {
            assert_true(point < contours.point_count);
            assert_true(contours.points[point].x == expected[i].x && contours.points[point].y == expected[i].y);
        }
        assert_true(contour < contours.count);
        assert_int_equal(contours.ends[contour], point);
    }
    assert_int_equal(contours.count, contour);
}

static void expect_wrong(reader *read, const struct wrong *wrong, size_t count) {
    for (size_t k = 0; k < count; k++)
        expect_wrong_text(read, wrong[k].text, strlen(wrong[k].text), wrong[k].status, wrong[k].line, wrong[k].words);
}

#define END                                                                                                            \
    { NAN, NAN }
static const narc_point square[] = {{0, 0}, {1.5, 0}, {1.5, 2e1}, {-0.25, 20}, END, END};
static const narc_point two[] = {{0, 0}, {1, 0}, {1, 1}, END, {5, 5}, {6, 5}, END, END};
static const narc_point one_point[] = {{3, 4}, END, END};

/* ---------------------------------------------------------------------------- CSV */

TEST(reads_csv) {
    expect_points(narc_read_csv, "0,0\n1.5,0\n1.5,2e1\n-.25,+20\n", square);
    expect_points(narc_read_csv, "x,y\r\n0,0\r\n1.5,0\r\n1.5,2e1\r\n-0.25,20", square); /* no line end at the end */
    expect_points(narc_read_csv, "\xef\xbb\xbf\n\n X , Y\n 0 ,\t0 \n1.50,0e0\n15e-1,20.\n-25e-2,20\n\n\n", square);
    expect_points(narc_read_csv, "0,0\n1.5,0\n1.5,20\n-0.25,20\n0,0\n", square); /* closed by itself */
    expect_points(narc_read_csv, "0,0\n1,0\n1,1\n\n5,5\n6,5\n", two);
    expect_points(narc_read_csv, "\n0,0\n1,0\n1,1\n \t\r\n\r\n\n5,5\n6,5\n\n\n", two);
    expect_points(narc_read_csv, "3,4", one_point);
}

/* What LibreOffice, Excel and pandas write. */
TEST(reads_tables_of_spreadsheets) {
    expect_points(narc_read_csv, "\"x\",\"y\"\r\n\"0\",\"0\"\r\n\"1.5\",0\r\n1.5,\"2e1\" \r\n-0.25,20\r\n", square);
    expect_points(narc_read_csv, "0;0\n1,5;0\n\"1,5\";2e1\n-,25;20\n", square);
    expect_points(narc_read_csv, "X\tY\n0\t0\n1,5\t 0\n1,5\t20\n-0,25\t20\n", square);
    expect_points(narc_read_csv, "0;0\n1.5;0\n1.5;20\n-0.25;20\n", square);
    expect_points(narc_read_csv, " 0.0e0   0.0e0\n 1.5\t0\r\n1.5 20\n-0.25 \"20\"\n", square);
    expect_points(narc_read_csv, "x,y,z\n0,0,1\n1.5,0,2\n1.5,20,3\n-0.25,20,no number\n", square);
    expect_points(narc_read_csv, "0,0,7\n1.5,0,7.0\n1.5,20,7\n-0.25,20,7\n", square);
    expect_points(narc_read_csv, ",y,\"a, \"\"b\"\"\",x\n0,0,\"p,q\",0\n1,0,,1.5\n2,20,\"\",1.5\n3,20,-,-0.25\n",
                  square);
    expect_points(narc_read_csv, "\tx\ty\n\t0\t0\n\t1.5\t0\n1\t1.5\t20\n\t-0.25\t20\n", square);
    expect_points(narc_read_csv, "x,y\n0,0\n1,0\n1,1\n,\n5,5\n6,5\n,\n,\n", two);
    expect_points(narc_read_csv, "x;y;;\n0;0;;\n1;0;;\n1;1;;\n;;;\n5;5;;\n6;5;;\n", two);
}

TEST(names_lines_of_csv) {
    static const struct wrong wrong[] = {
        {"", NARC_ERROR_FORMAT, 0, "empty"},
        {" \r\n\n\t", NARC_ERROR_FORMAT, 0, "empty"},
        {"\xef\xbb\xbf", NARC_ERROR_FORMAT, 0, "empty"},
        {"x,y\n\n", NARC_ERROR_FORMAT, 0, "header only"},
        {"0\n", NARC_ERROR_FORMAT, 1, "not numbers 'x,y' or 'x,y,z': '0'"},
        {"0,0,0,0\n", NARC_ERROR_FORMAT, 1, "not numbers 'x,y' or 'x,y,z': '0,0,0,0'"},
        {"0,0\n1\n", NARC_ERROR_FORMAT, 2, "1 columns where the first row has 2: '1'"},
        {"0,0\n1,2,3\n", NARC_ERROR_FORMAT, 2, "3 columns where the first row has 2: '1,2,3'"},
        {"x,y\n1,2,3\n", NARC_ERROR_FORMAT, 2, "3 columns where the first row has 2: '1,2,3'"},
        {"0,1,2\n1,1,2\n2,2,3\n", NARC_ERROR_FORMAT, 3, "z changes, but without a header"},
        {"0,1,2\n1,1,\n", NARC_ERROR_FORMAT, 2, "z is not a number: ''"},
        {"id,name\n1,2\n", NARC_ERROR_FORMAT, 1, "the header has no column 'x': 'id,name'"},
        {"x,name\n1,2\n", NARC_ERROR_FORMAT, 1, "the header has no column 'y': 'x,name'"},
        {"x,y,X\n1,2,3\n", NARC_ERROR_FORMAT, 1, "the header has two columns 'x': 'x,y,X'"},
        {"x,id,y\n1,2,3\n1,2,up\n", NARC_ERROR_FORMAT, 3, "y is not a number: 'up'"},
        {"x,y\n\"1,5\",2\n", NARC_ERROR_FORMAT, 2, "x has a decimal comma, but fields are not separated by"},
        {"x;y\n0,5;2\n0.5;2\n", NARC_ERROR_FORMAT, 3, "x has a decimal point, others before it a comma"},
        {"x;y\n1.234,5;2\n", NARC_ERROR_FORMAT, 2, "x is not a number: '1.234,5'"},
        {"x;y\n1,2,3;2\n", NARC_ERROR_FORMAT, 2, "x is not a number: '1,2,3'"},
        {"x,y\n\"1,2\n", NARC_ERROR_FORMAT, 2, "a field in quotes does not end, or more follows it: '\"1,2'"},
        {"x,y\n\"1\"0,2\n", NARC_ERROR_FORMAT, 2, "more follows it: '\"1\"0,2'"},
        {"\xff\xfex", NARC_ERROR_FORMAT, 1, "UTF-16"},
        {"0,0\n\nx,y\n", NARC_ERROR_FORMAT, 3, "x is not a number: 'x'"},
        {"0,0\n1,0\r\n\r\n1,zwei\r\n", NARC_ERROR_FORMAT, 4, "y is not a number: 'zwei'"},
        {"0,0\n,1\n", NARC_ERROR_FORMAT, 2, "x is not a number: ''"},
        {"0,0\n1,\n", NARC_ERROR_FORMAT, 2, "y is not a number: ''"},
        {"1e5e,0\n", NARC_ERROR_FORMAT, 1, "'1e5e'"},
        {"0x10,0\n", NARC_ERROR_FORMAT, 1, "'0x10'"},
        {"1.2.3,0\n", NARC_ERROR_FORMAT, 1, "'1.2.3'"},
        {"1 2,0\n", NARC_ERROR_FORMAT, 1, "'1 2'"},
        {"1,2\x01\n", NARC_ERROR_FORMAT, 1, "'2?'"},
        {"1,2\r3,4\n", NARC_ERROR_FORMAT, 1, "y is not a number: '2?3'"},
        {"0,0\nnan,1\n", NARC_ERROR_FORMAT, 2, "x is not a number: 'nan'"},
        {"0,0\n1,-NaN\n", NARC_ERROR_FORMAT, 2, "y is not a number: '-NaN'"},
        {"0,0\n0,0\n0,inf\n", NARC_ERROR_FORMAT, 3, "y is not a number: 'inf'"},
        {"-Infinity,0\n", NARC_ERROR_FORMAT, 1, "x is not a number: '-Infinity'"},
        {"0,0\n1e400,0\n", NARC_ERROR_NOT_FINITE, 2, "line 2: x is not finite: '1e400'"},
        {"0,0\n0,-1000000001\n", NARC_ERROR_SIZE, 2, "y is -1000000001, coordinates reach up to 1e+09"},
        /* what is shown of long values ends between characters: 39 letters, then one of two bytes */
        {"0,aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\xc3\xa4zzz\n", NARC_ERROR_FORMAT, 1,
         "'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...'"},
    };
    expect_wrong(narc_read_csv, wrong, sizeof wrong / sizeof wrong[0]);
}

/* A NUL byte, and numbers that are too long to be any. */
TEST(refuses_odd_csv) {
    AUTO(narc_destroy_path_at) narc_path *path = make_occupied_path();
    narc_error error;
    expect_error(read_exactly(narc_read_csv, "0,0\n1,\0 2\n", 10, path, &error), NARC_ERROR_FORMAT, &error,
                 "line 2: a NUL byte");
    char text[1002];
    memset(text, '1', sizeof text);
    text[1000] = ',';
    expect_error(read_exactly(narc_read_csv, text, sizeof text, path, &error), NARC_ERROR_FORMAT, &error,
                 "'1111111111111111111111111111111111111111...'");
    expect_unchanged(path);
}

/* ---------------------------------------------------------------------------- JSON */

TEST(reads_json) {
    expect_points(narc_read_json, "[[0, 0], [1.5, 0], [1.5, 2e1], [-0.25, 20]]", square);
    expect_points(narc_read_json, "\xef\xbb\xbf\n[[0,0],[1.5,0],\n[1.5,20],[-0.25,20],[0,0]]\n\n", square);
    expect_points(narc_read_json, "[[[0, 0], [1.5, 0], [1.5, 20], [-0.25, 20]]]", square);
    expect_points(narc_read_json, "[[[0, 0], [1, 0], [1, 1]], [[5, 5], [6, 5]]]", two);
    expect_points(narc_read_json,
                  "{\"name\": \"[{\\\"\", \"contours\": [[[0,0],[1,0],[1,1]],[[5,5],[6,5]]], \"b\": {}}", two);
    expect_points(narc_read_json, "{\"points\": [[0, 0], [1.5, 0], [1.5, 20], [-0.25, 20]]}", square);
    expect_points(narc_read_json, "{\"points\": [[[0,0],[1,0],[1,1]],[[5,5],[6,5]]]}", two);
    expect_points(narc_read_json, "{\"contours\": [[3, 4]]}", one_point);
    expect_points(narc_read_json, "[[3, 4]]", one_point);
}

TEST(names_places_of_json) {
    static const struct wrong wrong[] = {
        {"", NARC_ERROR_FORMAT, 0, "empty"},
        {"\n \n", NARC_ERROR_FORMAT, 0, "empty"},
        {"[[0, 0],\n[1, 0],\n[1,\n", NARC_ERROR_FORMAT, 4, "it ends too early"},
        {"[[0, 0],\n[1, nan]]", NARC_ERROR_FORMAT, 2, "not valid JSON here: 'nan]]'"},
        {"[[0, 0],\n[1, -Infinity],\n[2, 3]]", NARC_ERROR_FORMAT, 2, "'-Infinity],'"},
        {"[[0, 0]]\nx", NARC_ERROR_FORMAT, 2, "here: 'x'"},
        {"\n\n7", NARC_ERROR_FORMAT, 0, "not a list of points or contours: '7'"},
        {"[]", NARC_ERROR_FORMAT, 0, "a list without points: '[]'"},
        {"{\"a\": 1,\n\"points\":\n \"b\"}", NARC_ERROR_FORMAT, 0, "not a list of points or contours: '\"b\"'"},
        {"\n{\"Points\": []}", NARC_ERROR_FORMAT, 0, "an object without a key 'points' or 'contours'"},
        {"{\n\"points\": [[0, 0]],\n\"contours\": [[1, 1]]}", NARC_ERROR_FORMAT, 0, "a second key"},
        {"[[0, 0],\n[1],\n[2, 2]]", NARC_ERROR_FORMAT, 0, "point 1 of contour 0 is not a list of two numbers: '[1]'"},
        {"[[0, 0],\n\n[1, 2, 3]]", NARC_ERROR_FORMAT, 0, "'[1,2,3]'"},
        {"[[0, 0],\n{\"x\": 1, \"y\": 2}]", NARC_ERROR_FORMAT, 0, "'{\"x\":1,\"y\":2}'"},
        {"[[0, 0],\n[\n\"]\",\n\"1\"]]", NARC_ERROR_FORMAT, 0, "x of point 1 of contour 0 is not a number: '\"]\"'"},
        {"[[0, 0], [1,\nnull]]", NARC_ERROR_FORMAT, 0, "y of point 1 of contour 0 is not a number: 'null'"},
        {"[[[0, 0], [1, 0]],\n[[0, 0],\n[0, true]]]", NARC_ERROR_FORMAT, 0,
         "y of point 1 of contour 1 is not a number: 'true'"},
        {"[[[0, 0], [1, 0]],\n[]]", NARC_ERROR_FORMAT, 0, "contour 1 is not a list of points: '[]'"},
        {"[[[0, 0], [1, 0]],\n5]", NARC_ERROR_FORMAT, 0, "contour 1 is not a list of points: '5'"},
        {"[\n[]]", NARC_ERROR_FORMAT, 0, "point 0 of contour 0 is not a list of two numbers: '[]'"},
        {"[[0, 0],\n[1, 2],\n[1e400, 2]]", NARC_ERROR_NOT_FINITE, 0, "x of point 2 of contour 0 is not finite"},
        {"{\"[\": [\"\\\"\\\\\"],\n\"contours\":\n[[[0, 0]],\n[[1, 2],\n[1,\n-2e9]]]}", NARC_ERROR_SIZE, 0,
         "y of point 1 of contour 1 is -2000000000, coordinates reach up to 1e+09"},
    };
    expect_wrong(narc_read_json, wrong, sizeof wrong / sizeof wrong[0]);
}

TEST(refuses_odd_json) {
    AUTO(narc_destroy_path_at) narc_path *path = make_occupied_path();
    narc_error error;
    expect_error(read_exactly(narc_read_json, "[[0,\n\0 0]]", 10, path, &error), NARC_ERROR_FORMAT, &error,
                 "line 2: a NUL byte");
    expect_error(read_exactly(narc_read_json, "{\"a\\u0000\":\n[[1, 1]]}", 21, path, &error), NARC_ERROR_FORMAT, &error,
                 "line 1: a NUL character");
    AUTO(free_at) char *deep = malloc(100001); /* nesting that would use up the stack */
    assert_non_null(deep);
    memset(deep, '[', 100000);
    deep[100000] = 0;
    memcpy(deep, "[\"\\\"[\",\n", 8); /* brackets in strings do not count */
    expect_error(read_exactly(narc_read_json, deep, 100000, path, &error), NARC_ERROR_FORMAT, &error,
                 "line 2: lists and objects nested more than 1000 deep");
    expect_error(read_exactly(narc_read_json, deep, 900, path, &error), NARC_ERROR_FORMAT, &error,
                 "line 2: not valid JSON: it ends too early");
    memset(deep, '[', 1000); /* as deep as may be, and wrong there */
    deep[1000] = 'x';
    expect_error(read_exactly(narc_read_json, deep, 1001, path, &error), NARC_ERROR_FORMAT, &error,
                 "line 1: not valid JSON here: 'x'");
    expect_unchanged(path);
}

/* ---------------------------------------------------------------------------- both */

TEST(refuses_null) {
    reader *const readers[] = {narc_read_csv, narc_read_json};
    AUTO(narc_destroy_path_at) narc_path *path = make_occupied_path();
    for (size_t k = 0; k < 2; k++) {
        narc_error error;
        expect_error(readers[k](NULL, 5, path, &error), NARC_ERROR_ARGUMENT, &error, "data is NULL");
        expect_error(readers[k]("1,1", 3, NULL, &error), NARC_ERROR_ARGUMENT, &error, "path is NULL");
    }
    expect_unchanged(path);
}

/* Where the decimal point is a comma, files mean the same. Skipped without such a locale. */
TEST(reads_in_any_locale) {
    static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    const char *chosen = NULL;
    for (size_t k = 0; k < 4 && !chosen; k++)
        chosen = setlocale(LC_NUMERIC, names[k]);
    if (!chosen) {
        print_message("no locale with a decimal comma is installed\n");
        skip();
    }
    expect_points(narc_read_csv, "0,0\n1.5,0\n1.5,2e1\n-.25,+20\n", square);
    expect_points(narc_read_json, "[[0, 0], [1.5, 0], [1.5, 2e1], [-0.25, 20]]", square);
    setlocale(LC_NUMERIC, "C");
}

/* ---------------------------------------------------------------------------- their hull */

TEST(computes_the_hull) {
    const narc_point corners[] = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
    narc_point points[] = {{4, 3}, {2, 0}, {0, 3}, {1, 1}, {0, 0}, {4, 3}, {4, 0}, {4, 1}};
    size_t count = 0;
    narc_error error;
    expect_ok(narc_compute_hull(points, 8, points, &count, &error), &error);
    assert_int_equal(count, 4);
    assert_memory_equal(points, corners, sizeof corners);
    const narc_point line[] = {{0, 0}, {1, 1}, {3, 3}};
    expect_error(narc_compute_hull(line, 3, points, &count, &error), NARC_ERROR_NOT_CONVEX, &error, "on a line");
    expect_error(narc_compute_hull(line, 0, points, &count, &error), NARC_ERROR_COUNT, &error, "no points");
    expect_error(narc_compute_hull(NULL, 3, points, &count, &error), NARC_ERROR_ARGUMENT, &error, "NULL");
    assert_int_equal(count, 4);
    assert_memory_equal(points, corners, sizeof corners);
}

/* Whatever the bytes, points come out, or an error whose line there is; then the path is as before. */
TEST(survives_damage) {
    static const char *const texts[] = {
        "x,y\n0,0\n1.5,0\n\n1.5,2e1\n-.25,+20\n",
        "x;\"y\";\n0;0;\n\"1,5\";0;\n\n1,5;2e1;\"\"\n",
        "[[0, 0], [1.5, 0],\n[1.5, 2e1], [-0.25, 20]]",
        "{\"name\": \"\\u00e4\",\n\"contours\": [[[0,0],[1,0],\n[1,1]],[[5,5],\n[6,5e-3]]]}",
    };
    struct test_random random = test_random_named("damaged texts");
    size_t read = 0;
    const size_t trials = test_trials(30000);
    for (size_t trial = 0; trial < trials; trial++) {
        char text[200] = {0};
        strcpy(text, texts[trial % 4]);
        const size_t size = random_damage(&random, text, strlen(text));
        narc_path *path = make_occupied_path();
        narc_error error = {0};
        const narc_status status =
            read_exactly(trial % 4 > 1 ? narc_read_json : narc_read_csv, text, size, path, &error);
        size_t lines = 1;
        for (size_t i = 0; i < size; i++)
            lines += text[i] == '\n';
        assert_true(status == NARC_OK || error.index <= lines);
        const unsigned allowed = 1u << NARC_ERROR_FORMAT | 1u << NARC_ERROR_NOT_FINITE | 1u << NARC_ERROR_SIZE;
        read += finish_any_bytes(status, &error, allowed, 100, path);
    }
    assert_true(read > trials / 20 && read < trials - trials / 4); /* both sorts are really met */
}
