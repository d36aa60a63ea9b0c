/* SPDX-License-Identifier: MIT
 *
 * json_position.h - where a value stands in a JSON text, for messages: cJSON does not keep it. cJSON has accepted the
 * text.
 */
#ifndef NARC_TOOL_JSON_POSITION_H
#define NARC_TOOL_JSON_POSITION_H

#include <stddef.h>

/* The beginning of the text's value. */
const char *find_root(const char *text);

/* The beginning of the value of `key` in the object at `object`; NULL if that is no object, or has no key spelt so. */
const char *find_member(const char *object, const char *key);

/* The beginning of element number `index` of the list at `list`; NULL if that is no list, or a shorter one. */
const char *find_element(const char *list, size_t index);

#endif
