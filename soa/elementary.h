/* SPDX-License-Identifier: MIT
 *
 * elementary.h - sines, arc tangents, logarithms and the like, with the same bits on every machine: they use sums,
 * products, quotients and square roots alone, which are rounded correctly everywhere. The C library's functions differ
 * in the last bit from one library to the next. Internal.
 *
 * Errors are in units in the last place, of finite arguments. What is not finite gives NaN, or what the C library says.
 */
#ifndef NARC_ELEMENTARY_H
#define NARC_ELEMENTARY_H

/* Cosine and sine of any angle, below 1 unit. */
void narc_find_cosine(double angle, double *out_cosine, double *out_sine);
double narc_cos(double angle);
double narc_sin(double angle);

/* The angle of the vector (x, y), -pi .. pi, below 1 unit where neither is 2^1000 times the other. Zeros count with
 * their signs, as in the C library. */
double narc_atan2(double y, double x);

/* Of -1 .. 1, below 2 units. */
double narc_asin(double sine);

/* The length of the vector (x, y), below 1.5 units. */
double narc_hypot(double x, double y);

/* Of what is above 0, below 1.5 units. */
double narc_log(double x);

/* x to the power y, for x of 0 or more and y above 0; relative to the result, within 2 + 2 |y log x| units. */
double narc_pow(double x, double y);

#endif
