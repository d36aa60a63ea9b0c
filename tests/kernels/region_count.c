/* SPDX-License-Identifier: MIT
 *
 * region_count.c - narc_query_index() where there are 2^32 pairs: it counts them, and takes no memory for them.
 */
#include <stdlib.h>

#include "expect.h"
#include "index.h"
#include "ledger.h"
#include "narc.h"
#include "support.h"

TEST(counts_pairs_that_are_too_many) {
    enum { COUNT = 66000 };
    AUTO(free_at) narc_box *const boxes = malloc(COUNT * sizeof *boxes);
    narc_pairs pairs = {.count = 7};
    narc_error error;
    AUTO(narc_destroy_index_at) narc_index *index;
    struct ledger ledger = {0};
    const narc_allocator allocator = ledger_allocator(&ledger);
    const narc_workers workers = openmp_workers(2);
    assert_int_equal(narc_create_index(&allocator, &index), NARC_OK);
    for (size_t k = 0; k < COUNT; k++)
        boxes[k] = (narc_box){1, 1, 2, 2};
    assert_int_equal(narc_build_index(index, boxes, COUNT, NULL, NULL), NARC_OK);
    const narc_index_query query = {.workers = &workers};
    expect_error(narc_query_index(index, boxes, COUNT, &query, &pairs, &error), NARC_ERROR_COUNT, &error,
                 "2^32 pairs or more");
    assert_int_equal(pairs.count, 7);
    assert_true(ledger.most < (size_t)20 << 20); /* none of it for pairs */
    assert_int_equal(narc_query_index(index, boxes, 1, NULL, &pairs, NULL), NARC_OK);
    assert_int_equal(pairs.count, COUNT);
}

TEST_MAIN("region_count")
