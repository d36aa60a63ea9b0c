/* SPDX-License-Identifier: MIT
 *
 * json_path.h - values of a JSON file with their places in it, and checked access. Whatever is wrong ends the program
 * with a message that names file, place and value: "dem: pile.json: stages[1].duration: is not above 0 '-1'".
 */
#ifndef DEM_JSON_PATH_H
#define DEM_JSON_PATH_H

#include <stdbool.h>
#include <stddef.h>

#include "fail.h"
#include "json.h"

typedef struct json_value {
    const char *file;
    const cJSON *item; /* NULL: not there */
    char place[120];   /* "stages[1].duration"; empty: the file's value */
} json_value;

/* "dem: file: place: problem 'value'". */
_Noreturn void json_fail(const json_value *value, const char *problem);

/* A member that may be missing (its item is NULL then), or must be there; an item of a list. */
json_value json_member(const json_value *object, const char *key);
json_value json_require(const json_value *object, const char *key);
json_value json_at(const json_value *list, size_t index);

/* The value is an object whose keys are among `keys`, NULL behind the last, each there once. */
void json_check_object(const json_value *object, const char *const *keys);

/* How many items a list has. */
size_t json_list(const json_value *list);

/* A number from `low` to `high`; `open` leaves `low` itself out. */
double json_number(const json_value *value, double low, double high, bool open);
double json_positive(const json_value *object, const char *key);
double json_number_or(const json_value *object, const char *key, double low, double high, double otherwise);
size_t json_whole(const json_value *value, size_t low, size_t high);
bool json_bool_or(const json_value *object, const char *key, bool otherwise);

/* A list of `count` finite numbers. */
void json_numbers(const json_value *list, size_t count, double *out_numbers);

/* A string, not empty, shorter than `size`, copied. */
void json_text(const json_value *value, char *out_text, size_t size);

#endif
