/* SPDX-License-Identifier: MIT
 *
 * json_path.h - what the user gives, checked: numbers of options, and values of a JSON file with their places in it.
 * Whatever is wrong ends the program with a message that names file, place and value:
 * "dem: pile.json: stages[1].duration: is not above 0 '-1'".
 */
#ifndef DEM_JSON_PATH_H
#define DEM_JSON_PATH_H

#include <stdbool.h>
#include <stddef.h>

#include <cjson/cJSON.h>

#include "dem.h"

/* Ends the program with status 2: "dem: message", one line on standard error. */
__attribute__((format(printf, 1, 2))) _Noreturn void fail(const char *format, ...);

/* A whole number, of an option with this name. */
unsigned long long read_whole(const char *option, const char *text, unsigned long long low, unsigned long long high);

typedef struct json_value {
    const char *file;
    const cJSON *item; /* NULL: not there */
    char place[120];   /* "stages[1].duration"; empty: the file's value */
} json_value;

/* The value of a file of JSON, which must last as long as the tree. */
json_value json_read(const char *path);

/* "dem: file: place: problem 'value'". */
_Noreturn void json_fail(const json_value *value, const char *problem);

/* A member that may be missing (its item is NULL then), or must be there; an item of a list. */
json_value json_member(const json_value *object, const char *key);
json_value json_require(const json_value *object, const char *key);
json_value json_at(const json_value *list, size_t index);

/* The value is an object whose keys are among `keys`, words with blanks between them, each there once. */
void json_check_object(const json_value *object, const char *keys);

/* The object has none of these keys. */
void json_refuse(const json_value *object, const char *keys, const char *problem);

/* How many items a list has. */
size_t json_list(const json_value *list);

/* A number from `low` to `high`; `open` leaves `low` itself out. */
double json_number(const json_value *value, double low, double high, bool open);
double json_positive(const json_value *object, const char *key);
double json_number_or(const json_value *object, const char *key, double low, double high, double otherwise);
size_t json_whole(const json_value *value, size_t low, size_t high);
bool json_bool_or(const json_value *object, const char *key, bool otherwise);

/* A list of `count` finite numbers; of two of them; of two that may be missing. */
void json_numbers(const json_value *list, size_t count, double *out_numbers);
dem_vec json_vec(const json_value *list);
dem_vec json_vec_or(const json_value *object, const char *key, dem_vec otherwise);

/* A string, not empty, shorter than `size`, copied; and one that can stand in the head of a table and on a terminal. */
void json_text(const json_value *value, char *out_text, size_t size);
void json_name(const json_value *value, char *out_text, size_t size);

/* The index of the item that has a name; items are structures of `size` bytes whose first member is theirs. `problem`:
 * there is none. */
size_t json_find(const json_value *name, const void *items, size_t count, size_t size, const char *problem);

#endif
