/* SPDX-License-Identifier: MIT
 *
 * schema.h - what the user gives, checked: objects of a JSON file by tables of their keys.
 * Whatever is wrong ends the program with a message that names file, path and value:
 * "dem: pile.json: stages[1].duration: is not above 0 '-1'".
 */
#ifndef DEM_SCHEMA_H
#define DEM_SCHEMA_H

#include <stdbool.h>
#include <stddef.h>

#include <cjson/cJSON.h>

#include "dem.h"

typedef struct json_value {
    const char *file;
    const cJSON *item; /* NULL: not there */
    char path[120];    /* "stages[1].duration"; empty: the file's value */
    size_t index;      /* of an item of a list */
} json_value;

/* What has names: `count` structures of `size` bytes whose first member is theirs. `problem`: none has this one. */
typedef struct json_names {
    const void *items;
    size_t count, size;
    const char *problem;
} json_names;

/* What a value must be, and what it becomes. */
enum {
    NUMBER = 1, /* a double from `low` to `high`; both 0: finite */
    POSITIVE,   /* a double above 0 */
    WHOLE,      /* a uint64_t from `low` to `high` */
    BOOL,       /* a bool */
    PAIR,       /* two finite numbers: a vec */
    REGION,     /* [low x, low y, high x, high y]: a dem_region */
    TEXT,       /* a string that is not empty, with its NUL at most `high` bytes: an array of char */
    NAME,       /* a text that can stand in the head of a table and on a terminal */
    ONE_OF,     /* one of `names`: its index, a uint32_t */
    SOME_OF,    /* a list of `low` to `high` of `names`: an array of uint32_t */
    LIST,       /* of `low` to `high` items; both 0: of any number: a json_value */
    OBJECT,     /* an object: a table of its keys */
    ANY,        /* a json_value, or NULL */
    MUST = 64   /* added to one of these: the key must be there */
};

/* A key of an object, what its value must be, and where it goes. */
typedef struct json_key {
    const char *name;
    int kind;
    void *out;
    double low, high;
    const json_names *names;
    const char *no; /* unless it is NULL: the key must not be there, which is why */
} json_key;

/* The value of a file of JSON, which must last as long as the tree. */
json_value json_read_file(const char *path);

/* Checks that the value is an object which has no key twice, none that is not among `keys` (the last one has no name)
 * and all that it must have, and reads their values. What is not there stays as it was. */
void json_read(const json_value *object, const json_key *keys);
void json_read_some(const json_value *object, const json_key *keys); /* whatever else there is */
void json_take(const json_value *value, json_key key);               /* of one value */

/* "dem: file: path: problem 'value'"; of a member, if it is there. */
_Noreturn void json_fail(const json_value *value, const char *problem);
void json_refuse(const json_value *object, const char *key, const char *problem);

/* A member, whose item is NULL if it is not there; is it there? */
json_value json_member(const json_value *object, const char *key);
bool json_has(const json_value *object, const char *key);

/* Goes to the next item of a list or member of an object, from {0} to the first; false behind the last. */
bool json_next(const json_value *list, json_value *item);

/* The index of a name; `count` if there is none. */
size_t json_find(const json_names *names, const char *name);

/* An object's name must not be that of one before it. */
void json_check_new(const json_value *object, const char *name, json_names before);

#endif
