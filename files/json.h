/* SPDX-License-Identifier: MIT
 *
 * json.h - JSON by cJSON, with messages. Internal.
 */
#ifndef NARC_JSON_H
#define NARC_JSON_H

#include <cjson/cJSON.h>

#include "lines.h"

/* Parses a text as narc_clean_text() leaves it; free the value with cJSON_Delete(). NARC_ERROR_FORMAT, with the line:
 * the text is not JSON, or has a NUL character in a string, which cJSON would silently cut there. NARC_ERROR_MEMORY. */
narc_status narc_parse_json(const char *text, cJSON **out_value, narc_error *error);

/* The number of the line in which `item`, a value within `root`, begins in the text that it was parsed from. */
size_t narc_find_json_line(const char *text, const cJSON *root, const cJSON *item);

/* A value as JSON, for messages. */
narc_excerpt narc_show_json(const cJSON *value);

#endif
