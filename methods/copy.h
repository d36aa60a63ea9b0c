/* SPDX-License-Identifier: MIT
 *
 * copy.h - the object that methods work on: a copy of a store's shapes, each with its box. Internal.
 */
#ifndef NARC_METHODS_COPY_H
#define NARC_METHODS_COPY_H

#include <stdbool.h>

#include "method_kernels.h"

struct narc_methods {
    narc_shapes shapes; /* headers and records only */
    void *memory;       /* of both, as the allocator returned it */
    bool all_polygons;
    const narc_shapes *store;
    uint64_t change_count; /* the store's when it was copied */
    narc_allocator allocator;
};

#endif
