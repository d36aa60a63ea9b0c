/* SPDX-License-Identifier: MIT
 *
 * svg_document.c - the tree of an SVG file, its style sheet, and its elements by id.
 *
 * The parser is kept from everything outside the data: no network, no files (entities that are in files are as if they
 * were not declared), and its own limits on depth, on the length of values and on entities in entities stay on.
 */
#include "svg_document.h"

#include <limits.h>
#include <string.h>

#include <libxml/parserInternals.h>

#include "error.h"
#include "svg_number.h"

static void declare_entity(void *context, const xmlChar *name, int type, const xmlChar *public_id,
                           const xmlChar *system_id, xmlChar *content) {
    if (type == XML_INTERNAL_GENERAL_ENTITY || type == XML_INTERNAL_PARAMETER_ENTITY) {
        xmlSAX2EntityDecl(context, name, type, public_id, system_id, content);
    }
}

/* Keeps the line on which each element's tag begins: the tree itself keeps 16 bits of that on which it ends. In a tag
 * '<' stands at the beginning only; of a very long tag the parser may have let go of that. */
static void start_element(void *context, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri,
                          int namespace_count, const xmlChar **namespaces, int attribute_count, int defaulted_count,
                          const xmlChar **attributes) {
    xmlParserCtxt *parser = context;
    xmlSAX2StartElementNs(context, name, prefix, uri, namespace_count, namespaces, attribute_count, defaulted_count,
                          attributes);
    if (parser->node && parser->input) {
        const xmlParserInput *input = parser->input;
        uintptr_t line = input->line > 0 ? (uintptr_t)input->line : 0;
        for (const xmlChar *at = input->cur; at > input->base && *at != '<'; at--) {
            line -= *at == '\n' && at < input->cur && line > 1;
        }
        parser->node->_private = (void *)line;
    }
}

/* The first error that ends the parsing; those after it are its consequences. */
struct xml_error {
    int code;
    int line;
    char message[128];
};

#if LIBXML_VERSION >= 21200
typedef const xmlError parser_error;
#else
typedef xmlError parser_error;
#endif

static void keep_error(void *context, parser_error *error) {
    struct xml_error *first = ((xmlParserCtxt *)context)->_private;
    if (error->level == XML_ERR_FATAL && !first->code) {
        first->code = error->code;
        first->line = error->line;
        const char *text = error->message ? error->message : "";
        size_t size = strcspn(text, "\r\n");
        while (size && (text[size - 1] == '.' || text[size - 1] == ' ')) {
            size--;
        }
        const size_t kept = size < sizeof(first->message) ? size : sizeof(first->message) - 1;
        memcpy(first->message, text, kept);
        first->message[kept] = 0;
    }
}

static narc_status fail_xml(const struct xml_error *first, narc_error *error) {
    if (first->code == XML_ERR_NO_MEMORY) {
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the SVG file");
    }
    const size_t line = first->line > 0 ? (size_t)first->line : 0;
    return narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: not XML: %s", line,
                     first->code ? first->message : "no element");
}

static narc_status parse(const void *data, size_t size, xmlDoc **out_tree, narc_error *error) {
    xmlParserCtxt *parser = xmlNewParserCtxt();
    struct xml_error first = {0};
    if (!parser) {
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the SVG file");
    }
    parser->_private = &first;
    parser->sax->entityDecl = declare_entity;
    parser->sax->startElementNs = start_element;
    parser->sax->serror = keep_error;
    const int options = XML_PARSE_NONET | XML_PARSE_NOENT | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_COMPACT;
    *out_tree = xmlCtxtReadMemory(parser, data, (int)size, NULL, NULL, options);
    xmlFreeParserCtxt(parser);
    return *out_tree ? NARC_OK : fail_xml(&first, error);
}

const xmlNode *narc_next_node(const xmlNode *root, const xmlNode *node) {
    if (node->type == XML_ELEMENT_NODE && node->children) {
        return node->children;
    }
    while (node != root && !node->next) {
        node = node->parent;
    }
    return node == root ? NULL : node->next;
}

static narc_status index_ids(narc_svg_document *document) {
    document->ids = xmlHashCreate(0);
    for (xmlNode *node = (xmlNode *)document->root; node && document->ids;
         node = (xmlNode *)narc_next_node(document->root, node)) {
        const char *id = node->type == XML_ELEMENT_NODE ? narc_get_attribute(node, "id") : NULL;
        const xmlChar *key = (const xmlChar *)id;
        if (id && !xmlHashLookup(document->ids, key) && xmlHashAddEntry(document->ids, key, node)) {
            return NARC_ERROR_MEMORY;
        }
    }
    return document->ids ? NARC_OK : NARC_ERROR_MEMORY;
}

static narc_status find_root(narc_svg_document *document, narc_error *error) {
    const xmlNode *root = xmlDocGetRootElement(document->tree);
    if (!root || strcmp(narc_get_svg_name(root), "svg") != 0) {
        const size_t line = root ? narc_get_line(root) : 0;
        return narc_fail(error, NARC_ERROR_FORMAT, line, 0, "line %zu: not SVG: the outermost element is <%.40s>", line,
                         root ? (const char *)root->name : "");
    }
    document->root = root;
    return NARC_OK;
}

narc_status narc_open_svg(const void *data, size_t size, narc_svg_document *document, narc_error *error) {
    static const unsigned char gzip[2] = {0x1f, 0x8b};
    *document = (narc_svg_document){0};
    if (size > INT_MAX) {
        return narc_fail(error, NARC_ERROR_SIZE, 0, (double)size, "an SVG file of 2 GB or more");
    }
    if (size >= 2 && memcmp(data, gzip, 2) == 0) {
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "a compressed SVG file (svgz): it must be unpacked first");
    }
    if (size == 0) {
        return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "the SVG file is empty");
    }
    narc_status status = parse(data, size, &document->tree, error);
    if (!status) {
        status = find_root(document, error);
    }
    if (!status && (index_ids(document) || narc_read_sheet(document->root, &document->sheet))) {
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the SVG file");
    }
    return status;
}

void narc_close_svg(narc_svg_document *document) {
    narc_release_sheet(&document->sheet);
    if (document->ids) {
        xmlHashFree(document->ids, NULL);
    }
    xmlFreeDoc(document->tree);
    *document = (narc_svg_document){0};
}

const xmlNode *narc_find_element(const narc_svg_document *document, const char *id) {
    return xmlHashLookup(document->ids, (const xmlChar *)id);
}

size_t narc_get_line(const xmlNode *node) { return (uintptr_t)node->_private; }
