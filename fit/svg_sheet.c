/* SPDX-License-Identifier: MIT
 *
 * svg_sheet.c - the style sheets inside an SVG file, as far as drawing programs write them: one rule for each class.
 */
#include <stdlib.h>
#include <string.h>

#include "path.h"
#include "svg_document.h"
#include "svg_number.h"

/* What all rules with one selector say; of each property, which of the sheet's rules said it last. */
struct entry {
    narc_svg_values said;
    size_t rules[NARC_SVG_PROPERTIES];
};

static bool is_style(const xmlNode *node) { return strcmp(narc_get_svg_name(node), "style") == 0; }

/* The text of all style elements in one, in a buffer of its own; NULL if there is no memory. */
static char *collect_text(const xmlNode *root) {
    size_t size = 0, capacity = 0;
    char *text = narc_grow(NULL, &capacity, 1, 1);
    for (const xmlNode *node = root; node && text; node = narc_next_node(root, node)) {
        const bool css = (node->type == XML_TEXT_NODE || node->type == XML_CDATA_SECTION_NODE) && node->parent &&
                         is_style(node->parent) && node->content;
        if (css) {
            const size_t more = strlen((const char *)node->content);
            char *larger = narc_grow(text, &capacity, size + more + 1, 1);
            if (!larger) {
                free(text);
                return NULL;
            }
            text = larger;
            memcpy(text + size, node->content, more);
            size += more;
        }
    }
    if (text) {
        text[size] = 0;
    }
    return text;
}

/* Comments, and the marks with which old files hide sheets from old readers, become blanks. */
static void blank_comments(char *text) {
    for (char *at = text; *at; at++) {
        size_t size = 0;
        if (strncmp(at, "/*", 2) == 0) {
            const char *end = strstr(at + 2, "*/");
            size = end ? (size_t)(end + 2 - at) : strlen(at);
        } else if (strncmp(at, "<!--", 4) == 0) {
            size = 4;
        } else if (strncmp(at, "-->", 3) == 0) {
            size = 3;
        }
        if (size) {
            memset(at, ' ', size);
            at += size - 1;
        }
    }
}

/* Behind the block that begins here, and the blocks inside it; or at the end of the text. */
static char *skip_block(char *open) {
    size_t depth = 0;
    for (; *open; open++) {
        depth += *open == '{';
        if (*open == '}' && --depth == 0) {
            return open + 1;
        }
    }
    return open;
}

/* One name, class or id, or '*', without anything else. */
static bool is_simple(narc_span selector) {
    for (size_t k = 0; k < selector.size; k++) {
        const char c = selector.text[k];
        if (strchr(" \t\r\n\f\v>+~:[]()@\"'", c) || (k && strchr(".#*", c))) {
            return false;
        }
    }
    return selector.size > 0;
}

static narc_status add_rule(narc_svg_sheet *sheet, narc_span selector, const narc_svg_values *values, size_t rule) {
    /* What stands behind the selector, a comma or the like, is not looked at again. */
    sheet->text[selector.text + selector.size - sheet->text] = 0;
    const xmlChar *key = (const xmlChar *)selector.text;
    struct entry *entry = xmlHashLookup(sheet->rules, key);
    if (!entry) {
        entry = calloc(1, sizeof(*entry));
        if (!entry || xmlHashAddEntry(sheet->rules, key, entry)) {
            free(entry);
            return NARC_ERROR_MEMORY;
        }
    }
    for (size_t k = 0; k < NARC_SVG_PROPERTIES; k++) {
        if (values->values[k].size) {
            entry->said.values[k] = values->values[k];
            entry->rules[k] = rule;
        }
    }
    return NARC_OK;
}

/* All selectors before the block at `open`. */
static narc_status add_rules(narc_svg_sheet *sheet, char *start, char *open, const char *end, size_t rule) {
    narc_svg_values values = {0};
    const char *last = end > open + 1 && end[-1] == '}' ? end - 1 : end;
    narc_add_declarations((narc_span){open + 1, (size_t)(last - (open + 1))}, &values);
    narc_status status = NARC_OK;
    while (start < open && !status) {
        char *comma = memchr(start, ',', (size_t)(open - start));
        char *stop = comma ? comma : open;
        const narc_span selector = narc_trim((narc_span){start, (size_t)(stop - start)});
        if (is_simple(selector)) {
            status = add_rule(sheet, selector, &values, rule);
        }
        start = stop + 1;
    }
    return status;
}

static narc_status add_all_rules(narc_svg_sheet *sheet) {
    narc_status status = NARC_OK;
    size_t rule = 0;
    char *at = sheet->text;
    while (!status) {
        at += strspn(at, " \t\r\n\f\v;}");
        char *open = at + strcspn(at, *at == '@' ? "{;" : "{");
        if (!*open) {
            return NARC_OK;
        }
        char *end = *open == ';' ? open + 1 : skip_block(open);
        if (*at != '@') {
            status = add_rules(sheet, at, open, end, ++rule);
        }
        at = end;
    }
    return status;
}

narc_status narc_read_sheet(const xmlNode *root, narc_svg_sheet *sheet) {
    *sheet = (narc_svg_sheet){.text = collect_text(root), .rules = xmlHashCreate(0)};
    if (!sheet->text || !sheet->rules) {
        return NARC_ERROR_MEMORY;
    }
    blank_comments(sheet->text);
    return add_all_rules(sheet);
}

static void free_entry(void *entry, const xmlChar *key) {
    (void)key;
    free(entry);
}

void narc_release_sheet(narc_svg_sheet *sheet) {
    free(sheet->text);
    if (sheet->rules) {
        xmlHashFree(sheet->rules, free_entry);
    }
    *sheet = (narc_svg_sheet){0};
}

static void add_entry(const narc_svg_sheet *sheet, const char *selector, struct entry *sum) {
    const struct entry *entry = xmlHashLookup(sheet->rules, (const xmlChar *)selector);
    for (size_t k = 0; entry && k < NARC_SVG_PROPERTIES; k++) {
        if (entry->said.values[k].size && entry->rules[k] >= sum->rules[k]) {
            sum->said.values[k] = entry->said.values[k];
            sum->rules[k] = entry->rules[k];
        }
    }
}

/* A key longer than this is no class that a program writes. */
enum { KEY_SIZE = 256 };

static void add_prefixed(const narc_svg_sheet *sheet, char prefix, narc_span word, struct entry *sum) {
    char key[KEY_SIZE] = {prefix};
    if (word.size && word.size < KEY_SIZE - 1) {
        memcpy(key + 1, word.text, word.size);
        add_entry(sheet, key, sum);
    }
}

/* Of rules for equally special selectors the later wins; ids win over classes, these over names, these over '*'. */
void narc_add_sheet(const narc_svg_sheet *sheet, const xmlNode *node, narc_svg_values *values) {
    struct entry sum = {.said = *values};
    if (xmlHashSize(sheet->rules) <= 0) {
        return;
    }
    add_entry(sheet, "*", &sum);
    memset(sum.rules, 0, sizeof(sum.rules));
    add_entry(sheet, (const char *)node->name, &sum);
    memset(sum.rules, 0, sizeof(sum.rules));
    const char *class = narc_get_attribute(node, "class");
    while (class && *class) {
        class = narc_skip_space(class);
        const size_t size = strcspn(class, " \t\r\n\f\v");
        add_prefixed(sheet, '.', (narc_span){class, size}, &sum);
        class += size;
    }
    memset(sum.rules, 0, sizeof(sum.rules));
    const char *id = narc_get_attribute(node, "id");
    if (id) {
        add_prefixed(sheet, '#', (narc_span){id, strlen(id)}, &sum);
    }
    *values = sum.said;
}
