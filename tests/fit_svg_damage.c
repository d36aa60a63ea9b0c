/* SPDX-License-Identifier: MIT
 *
 * fit_svg_damage.c - SVG files that are wrong, and right ones with changed bytes: an error or an outline.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fit_svg.h"

static const struct wrong documents[] = {
    {"", NARC_ERROR_FORMAT, 0, "empty"},
    {"M0 0h1v1z", NARC_ERROR_FORMAT, 1, "not XML"},
    {"<svg><path d='M0 0h4v4'/>\n<g>", NARC_ERROR_FORMAT, 2, "not XML"},
    {"<svg>\n<path d='M0 0h4v4'", NARC_ERROR_FORMAT, 2, "not XML"},
    {"<svg>\n\n<g></svg>", NARC_ERROR_FORMAT, 3, "g"},
    {"<?xml version='1.0' encoding='no-such'?><svg/>", NARC_ERROR_FORMAT, 1, "no-such"},
    {"<svg>\xff\xfe</svg>", NARC_ERROR_FORMAT, 1, "not XML"},
    {"\x1f\x8b\x08", NARC_ERROR_FORMAT, 0, "compressed"},
    {"<html><svg/></html>", NARC_ERROR_FORMAT, 1, "<html>"},
    {"<x:svg xmlns:x='urn:other'/>", NARC_ERROR_FORMAT, 1, "not SVG"},
    {"<svg/>", NARC_ERROR_FORMAT, 0, "no outline"},
    {"<svg><defs><path d='M0 0h4v4'/></defs></svg>", NARC_ERROR_FORMAT, 0, "no outline"},
    {"<svg>\n<path d='M0 0h4v4'/><path d='&no;'/></svg>", NARC_ERROR_FORMAT, 2, "no"},
    {"<svg>\n<use href='other.svg#a'/></svg>", NARC_ERROR_FORMAT, 2, "other files are not read at \"other.svg#a\""},
    {"<svg>\n<g id='a'>\n<use href='#a'/></g></svg>", NARC_ERROR_FORMAT, 3,
     "<use>, href: an element that shows itself"},
    {"<svg><use id='a' href='#a'/></svg>", NARC_ERROR_FORMAT, 1, "shows itself"},
    {"<svg><g id='a'>\n<use href='#b'/></g><symbol id='b'>\n<use href='#a'/></symbol></svg>", NARC_ERROR_FORMAT, 2,
     "an element that shows itself at \"#b\""},
    {"<svg\n\n><path\n\nd='x'\n\n/></svg>", NARC_ERROR_FORMAT, 3, "<path>, d: no path command"},
};

/* Bodies in a root that begins on the line before. */
static const struct wrong bodies[] = {
    {"<path d='L1 1'/>", NARC_ERROR_FORMAT, 2, "<path>, d: a path begins with M at \"L1 1\""},
    {"<path d='1 1'/>", NARC_ERROR_FORMAT, 2, "no path command at \"1 1\""},
    {"<g>\n\n<path d='M0 0L5 5 6'/></g>", NARC_ERROR_FORMAT, 4, "a number is missing at \"6\""},
    {"<path d='M0 0L5 5 6 Z'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \"Z\""},
    {"<path d='M0 0 L'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \"L\""},
    {"<path d='M0 0L5,,5'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \",5\""},
    {"<path d='M,0 0L5,5'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \",0 0"},
    {"<path d='M0 0L5 5,H3'/>", NARC_ERROR_FORMAT, 2, "after the comma at \",H3\""},
    {"<path d='M0 0h4v4z5'/>", NARC_ERROR_FORMAT, 2, "no path command at \"5\""},
    {"<path d='M0 0h4X'/>", NARC_ERROR_FORMAT, 2, "no path command at \"X\""},
    {"<path d='M0 0h4v.e5'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \".e5\""},
    {"<path d='M0 0h--4'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \"--4\""},
    {"<path d='M0 0h0x10'/>", NARC_ERROR_FORMAT, 2, "no path command at \"x10\""},
    {"<path d='M0 0hnan'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \"nan\""},
    {"<path d='M0 0hinf'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \"inf\""},
    {"<path d='M0 0A5 5 0 2 0 9 9'/>", NARC_ERROR_FORMAT, 2, "a flag 0 or 1 is missing at \"2 0 9 9\""},
    {"<path d='M0 0A5 5 0 0 9 9'/>", NARC_ERROR_FORMAT, 2, "a flag 0 or 1 is missing at \"9 9\""},
    {"<path d='M0 0A5 5 0'/>", NARC_ERROR_FORMAT, 2, "a flag 0 or 1 is missing at \"A5 5 0\""},
    {"<path d='M0 0A5 5 0 1 +1 9 9'/>", NARC_ERROR_FORMAT, 2, "a flag 0 or 1 is missing"},
    {"<path d='M0 0L1e999 0 0 1'/>", NARC_ERROR_NOT_FINITE, 2, "not finite at \"1e999"},
    {"<path d='M0 0l3 3 1e308 0 1e308 0'/>", NARC_ERROR_SIZE, 2, "beyond 1e9"},
    {"<path d='M0 0C1 1 2 2 3 3S1e308 1e308 9 9'/>", NARC_ERROR_SIZE, 2, "beyond 1e9"},
    {"<path d='M0 0h2000000000v1'/>", NARC_ERROR_SIZE, 2, "beyond 1e9"},
    {"<path d='M0 0A1e300 1e300 0 1 1 9 9'/>", NARC_ERROR_SIZE, 2, "beyond 1e9"},
    {"<polygon points='1 2 3 4 5'/>", NARC_ERROR_FORMAT, 2, "<polygon>, points: a point of a single number at \"5\""},
    {"<polyline points='1 2 3 4 x'/>", NARC_ERROR_FORMAT, 2, "a number is missing at \"x\""},
    {"<polygon points='1 2 3 4 1e10 0'/>", NARC_ERROR_SIZE, 2, "beyond 1e9 at \"1e10 0\""},
    {"<rect width='-5' height='5'/>", NARC_ERROR_SIZE, 2, "<rect>, width: a negative length at \"-5\""},
    {"<rect width='5' height='5' rx='-1'/>", NARC_ERROR_SIZE, 2, "rx: a negative length"},
    {"<rect width='5' height='5' x=''/>", NARC_ERROR_FORMAT, 2, "x: a length is missing"},
    {"<rect width='5em' height='5'/>", NARC_ERROR_FORMAT, 2, "a unit that is not known at \"5em\""},
    {"<rect width='5 5' height='5'/>", NARC_ERROR_FORMAT, 2, "a unit that is not known at \"5 5\""},
    {"<rect width='50%' height='5'/>", NARC_ERROR_FORMAT, 2, "a percentage of a size that is not told"},
    {"<rect width='1e999' height='5'/>", NARC_ERROR_NOT_FINITE, 2, "not finite at \"1e999\""},
    {"<rect width='1e300' height='5'/>", NARC_ERROR_SIZE, 2, "beyond 1e9"},
    {"<circle r='-1'/>", NARC_ERROR_SIZE, 2, "<circle>, r: a negative length"},
    {"<circle r='1' cx='y'/>", NARC_ERROR_FORMAT, 2, "cx: a length is missing at \"y\""},
    {"<ellipse rx='1' ry='-1'/>", NARC_ERROR_SIZE, 2, "ry: a negative length"},
    {"<line x1='a' stroke='red'/>", NARC_ERROR_FORMAT, 2, "x1: a length is missing"},
    {"<g transform='scale(2'/>", NARC_ERROR_FORMAT, 2, "<g>, transform: a transform without ')' at \"scale(2\""},
    {"<g transform='scale 2'/>", NARC_ERROR_FORMAT, 2, "without '(' at"},
    {"<g transform='scale()'/>", NARC_ERROR_FORMAT, 2, "a wrong count of numbers"},
    {"<g transform='matrix(1 2 3 4 5)'/>", NARC_ERROR_FORMAT, 2, "a wrong count of numbers"},
    {"<g transform='matrix(1 2 3 4 5 6 7)'/>", NARC_ERROR_FORMAT, 2, "too many numbers"},
    {"<g transform='rotate(1 2)'/>", NARC_ERROR_FORMAT, 2, "a wrong count of numbers"},
    {"<g transform='turn(1)'/>", NARC_ERROR_FORMAT, 2, "not known at \"turn(1)\""},
    {"<g transform='scale(1e999)'/>", NARC_ERROR_NOT_FINITE, 2, "not finite at \"scale(1e999)\""},
    {"<g transform='scale(1e200)scale(1e200)'/>", NARC_ERROR_NOT_FINITE, 2, "not finite"},
    {"<g transform='scale(1e200)'><circle r='5'/></g>", NARC_ERROR_SIZE, 2, "<circle>, cx, cy, r: a coordinate beyond"},
    {"<svg viewBox='0 0 1' width='5' height='5'/>", NARC_ERROR_FORMAT, 2, "<svg>, viewBox: not four numbers"},
    {"<svg viewBox='0 0 1 1'/>", NARC_ERROR_FORMAT, 2, "size is not told"},
    {"<svg width='-1'/>", NARC_ERROR_SIZE, 2, "width: a negative length"},
    {"<svg width='1' height='1' viewBox='0 0 1 1' preserveAspectRatio='xmid'/>", NARC_ERROR_FORMAT, 2,
     "preserveAspectRatio: not such as xMidYMid meet at \"xmid\""},
    {"<path d='M0 0h4 \xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4\xc3\xa4"
     "\xc3\xa4\xc3\xa4\xc3\xa4x\xc3\xa4'/>",
     NARC_ERROR_FORMAT, 2, "\xc3\xa4x\""},
};

static void tells_line_and_value(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof(documents) / sizeof(documents[0]); k++) {
        const struct wrong *w = &documents[k];
        expect_wrong_text(narc_read_svg, w->text, strlen(w->text), w->status, w->line, w->words);
    }
    for (size_t k = 0; k < sizeof(bodies) / sizeof(bodies[0]); k++) {
        const struct wrong *w = &bodies[k];
        char text[1000];
        /* What was read before the error is taken back. */
        const int size = snprintf(text, sizeof(text), "<svg><rect width='9' height='9'/>\n%s</svg>", w->text);
        expect_wrong_text(narc_read_svg, text, (size_t)size, w->status, w->line, w->words);
    }
    narc_path *path = make_path();
    narc_error error;
    expect_error(narc_read_svg(NULL, 1, path, &error), NARC_ERROR_ARGUMENT, &error, "data is NULL");
    expect_error(narc_read_svg("<svg/>", 6, NULL, &error), NARC_ERROR_ARGUMENT, &error, "path is NULL");
    narc_destroy_path(path);
}

/* Lines are told beyond 65535, too. */
static void counts_many_lines(void **state) {
    (void)state;
    enum { LINES = 100000 };
    char *text = malloc(LINES + 100);
    assert_non_null(text);
    memcpy(text, "<svg>", 5);
    memset(text + 5, '\n', LINES);
    strcpy(text + 5 + LINES, "<path d='x'/>\n</svg>");
    expect_wrong_text(narc_read_svg, text, strlen(text), NARC_ERROR_FORMAT, LINES + 1, "line 100001, <path>");
    free(text);
}

/* ---------------------------------------------------------------------------- what multiplies */

/* 10^20 rectangles, or so many empty groups, in a file of a few kilobytes. */
static void ends_repeated_use(void **state) {
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        static const char *const leaves[] = {"<rect id='a0' width='9' height='9'/>", "<g id='a0'/>",
                                             "<path id='a0' display='none' d='M0 0h1v1'/>"};
        char text[8000];
        size_t size = (size_t)snprintf(text, sizeof(text), "<svg><defs>%s", leaves[kind]);
        for (int level = 1; level <= 20; level++) {
            size += (size_t)snprintf(text + size, sizeof(text) - size, "<g id='a%d'>", level);
            for (int k = 0; k < 10; k++) {
                size += (size_t)snprintf(text + size, sizeof(text) - size, "<use href='#a%d'/>", level - 1);
            }
            size += (size_t)snprintf(text + size, sizeof(text) - size, "</g>");
        }
        size += (size_t)snprintf(text + size, sizeof(text) - size, "</defs>\n<use href='#a20'/></svg>");
        assert_true(size < sizeof(text) - 1);
        expect_wrong_text(narc_read_svg, text, size, NARC_ERROR_SIZE, 1, "used again too often");
    }
}

/* Each group is inside the one before by a use: no element is deep inside another in the file, but all are when
 * shown. */
static void ends_deep_use(void **state) {
    (void)state;
    enum { LEVELS = 2000 };
    char *text = malloc(LEVELS * 50);
    assert_non_null(text);
    size_t size = (size_t)sprintf(text, "<svg>");
    for (int k = 0; k < LEVELS; k++) {
        size += (size_t)sprintf(text + size, "<g id='a%d'><use href='#a%d'/></g>\n", k, k + 1);
    }
    size += (size_t)sprintf(text + size, "</svg>");
    /* The root, then two levels for each line. */
    expect_wrong_text(narc_read_svg, text, size, NARC_ERROR_SIZE, 256, "too deep");
    size = (size_t)sprintf(text, "<svg>");
    for (int k = 0; k < LEVELS; k++) {
        size += (size_t)sprintf(text + size, "<g>");
    }
    expect_wrong_text(narc_read_svg, text, size, NARC_ERROR_FORMAT, 1, "not XML");
    free(text);
}

/* Entities of entities, 10^10 times the data of a path; and one that holds itself. */
static void ends_entity_bombs(void **state) {
    (void)state;
    char text[4000];
    size_t size = (size_t)sprintf(text, "<!DOCTYPE svg [<!ENTITY a0 'h1v1h1v1h1v1h1v1'>");
    for (int level = 1; level <= 10; level++) {
        size += (size_t)sprintf(text + size, "<!ENTITY a%d '", level);
        for (int k = 0; k < 10; k++) {
            size += (size_t)sprintf(text + size, "&a%d;", level - 1);
        }
        size += (size_t)sprintf(text + size, "'>");
    }
    size += (size_t)sprintf(text + size, "]>\n<svg><path d='M0 0&a10;'/></svg>");
    expect_wrong_text(narc_read_svg, text, size, NARC_ERROR_FORMAT, 2, "not XML");
    static const char loop[] = "<!DOCTYPE svg [<!ENTITY a '&b;'><!ENTITY b '&a;'>]>\n<svg><path d='&a;'/></svg>";
    expect_wrong_text(narc_read_svg, loop, strlen(loop), NARC_ERROR_FORMAT, 2, "not XML");
}

/* Entities in the file are replaced, in attributes, in the tree and in names of namespaces; those in other files are
 * not, even if the file is there. */
static void replaces_own_entities_only(void **state) {
    (void)state;
    static const char own[] = "<!DOCTYPE svg [<!ENTITY s 'http://www.w3.org/2000/svg'><!ENTITY d 'h4'>"
                              "<!ENTITY p '<path d=\"M0 0h4v2\"/>'>]><svg xmlns='&s;'><path d='M0 0&d;v2'/>&p;</svg>";
    narc_path *path = make_path();
    narc_error error;
    expect_ok(narc_read_svg(own, strlen(own), path, &error), &error);
    narc_contours contours = flatten(path);
    assert_int_equal(contours.count, 2);
    assert_int_equal(contours.point_count, 6);
    narc_release_contours(&contours);
    narc_destroy_path(path);

    static const char name[] = "test_fit_svg_entity.tmp";
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fputs("<path d='M0 0h4v2'/>", file);
    fclose(file);
    char text[500];
    for (int kind = 0; kind < 2; kind++) {
        const int size = snprintf(text, sizeof(text),
                                  kind ? "<!DOCTYPE svg [<!ENTITY %% e SYSTEM '%s'>%%e;]><svg>&e;</svg>"
                                       : "<!DOCTYPE svg [<!ENTITY e SYSTEM '%s'>]><svg>&e;</svg>",
                                  name);
        narc_path *other = make_occupied_path();
        expect_error(narc_read_svg(text, (size_t)size, other, &error), NARC_ERROR_FORMAT, &error, "");
        expect_unchanged(other);
        narc_destroy_path(other);
    }
    remove(name);
}

/* ---------------------------------------------------------------------------- bytes that change */

static const char *const good[] = {
    "<?xml version='1.0' encoding='UTF-8'?>\n<!DOCTYPE svg [<!ENTITY e 'v2'>]>\n"
    "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='0 0 10 10'>\n"
    "<style>.a{fill:none}/* */#b,path{stroke:red}</style>\n"
    "<path id='b' class='a' d='M1.5.5-3e2 4&e;H5V6h1Cc1 2 3 4 5 6s1 2 3 4Q1 2 3 4T5 6A1 2 3 0110 10z'/>\n</svg>",
    "<svg xmlns='http://www.w3.org/2000/svg'><g transform='translate(1,2)rotate(30 1 1) scale(2) skewX(3) matrix(1 2 3 "
    "4 "
    "5 6)'>\n<rect x='1mm' y='2%' width='3' height='4' rx='1'/><circle r='5'/><ellipse rx='1' ry='2'/>"
    "<polygon points='1,2 3,4 5,7'/><line x2='5' stroke='#000'/></g></svg>",
    "<svg xmlns:xlink='http://www.w3.org/1999/xlink'><defs><symbol id='s' viewBox='0 0 4 4' preserveAspectRatio='none'>"
    "<path id='p' d='M0 0h4v4z' style='fill:red;opacity:.5'/></symbol></defs><use xlink:href='#s' x='5' width='8' "
    "height='8'/><use href='#p' transform='scale(2)'/><switch><a><svg width='5' height='5'><use href='#p'/></svg></a>"
    "</switch></svg>",
};

static const char *const tokens[] = {"<",    ">",         "'", "&", "e", "-",  ".",  "1e308", "1e-308",
                                     "0",    "999999999", " ", ",", "A", "#s", "#p", "/>",    "<g>",
                                     "</g>", "\x80",      "{", "}", ";", "(",  ")",  "%",     "</"};

static size_t mutate(struct test_random *random, char *text, size_t size, size_t capacity) {
    for (size_t count = 1 + random_below(random, 4); count > 0; count--) {
        const size_t at = random_below(random, size + 1), rest = size - at;
        const char *token = tokens[random_below(random, sizeof(tokens) / sizeof(tokens[0]))];
        const size_t length = strlen(token), cut = random_below(random, 10) + 1;
        switch (random_below(random, 5)) {
        case 0: /* one bit */
            if (rest) {
                text[at] = (char)(text[at] ^ 1 << random_below(random, 8));
            }
            break;
        case 1: /* cut */
            memmove(text + at, text + at + (cut < rest ? cut : rest), cut < rest ? rest - cut : 0);
            size -= cut < rest ? cut : rest;
            break;
        case 2: /* truncate, now and then */
            size = random_below(random, 5) ? size : at;
            break;
        case 3: /* insert */
            if (size + length <= capacity) {
                memmove(text + at + length, text + at, rest);
                memcpy(text + at, token, length);
                size += length;
            }
            break;
        default: /* overwrite */
            memcpy(text + at, token, length < rest ? length : rest);
        }
    }
    return size;
}

static void survives_changed_bytes(void **state) {
    (void)state;
    struct test_random random = test_random_named("svg bytes");
    size_t read = 0, trials = test_trials(20000);
    for (size_t trial = 0; trial < trials; trial++) {
        char buffer[2000];
        const char *text = good[trial % 3];
        memcpy(buffer, text, strlen(text));
        const size_t size = mutate(&random, buffer, strlen(text), sizeof(buffer));
        narc_path *path = make_occupied_path();
        narc_error error = {.message = ""};
        const narc_status status = read_exactly(narc_read_svg, buffer, size, path, &error);
        const unsigned allowed = 1u << NARC_ERROR_FORMAT | 1u << NARC_ERROR_SIZE | 1u << NARC_ERROR_NOT_FINITE;
        read += finish_any_bytes(status, &error, allowed, SIZE_MAX, path);
    }
    /* Both ends happen. */
    assert_true(read > 0 && read < trials);
}

int test_svg_damage(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tells_line_and_value),   cmocka_unit_test(counts_many_lines),
        cmocka_unit_test(ends_repeated_use),      cmocka_unit_test(ends_deep_use),
        cmocka_unit_test(ends_entity_bombs),      cmocka_unit_test(replaces_own_entities_only),
        cmocka_unit_test(survives_changed_bytes),
    };
    return cmocka_run_group_tests_name("SVG damage", tests, NULL, NULL);
}
