/* SPDX-License-Identifier: MIT
 *
 * expect.h - what a function's status and error should be.
 */
#ifndef NARC_TEST_EXPECT_H
#define NARC_TEST_EXPECT_H

#include "narc_shapes.h"

/* Fails unless status and error are the expected one and the message, one line without a full stop, holds `words`. */
void expect_error(narc_status status, narc_status expected, const narc_error *error, const char *words);

/* Fails, with the message, unless `status` is NARC_OK. */
void expect_ok(narc_status status, const narc_error *error);

#endif
