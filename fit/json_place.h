/* SPDX-License-Identifier: MIT
 *
 * json_place.h - where a value stands in a JSON text, for messages: cJSON does not keep it. Internal.
 */
#ifndef NARC_JSON_PLACE_H
#define NARC_JSON_PLACE_H

#include <stddef.h>

/* The beginning of a value: steps[0] says which element or member of the text's value, counted from 0, steps[1] which
 * of that one's, and so on. With a step that does not exist, the value that was to have it. cJSON has accepted the
 * text. */
const char *narc_find_json_value(const char *text, const size_t *steps, size_t count);

/* Steps over blanks; from the opening quote of a string to behind the closing one. */
const char *narc_skip_json_blanks(const char *at);
const char *narc_skip_json_string(const char *at);

/* The number of bytes of the value that begins here. */
size_t narc_measure_json_value(const char *value);

#endif
