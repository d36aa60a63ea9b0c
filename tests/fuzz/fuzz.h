/* SPDX-License-Identifier: MIT
 *
 * fuzz.h - what the fuzzing programs share: a fuzzer's bytes as numbers, shapes and bodies. A check that fails ends
 * the program, as libFuzzer wants it.
 */
#ifndef NARC_FUZZ_H
#define NARC_FUZZ_H

#include "everywhere.h"
#include "scene.h"

/* What libFuzzer calls. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

struct bytes {
    const uint8_t *next;
    size_t left;
};

/* Behind the last byte there are zeros. */
unsigned take_byte(struct bytes *from);
uint32_t take_word(struct bytes *from);
unsigned take_below(struct bytes *from, unsigned limit); /* at most 256 */

/* From a lattice of sixteenths about 0, where much ties; anything below `size`; or 1 in 16 times any float at all. */
double take_number(struct bytes *from, double size);
float take_any(struct bytes *from);

/* What a builder makes of such numbers, or a circle where it refuses them. What it makes must be valid. */
struct shape take_shape(struct bytes *from);

/* A few shapes, and bodies of them; one in 8 bodies has broken numbers. */
struct scene take_scene(struct bytes *from, size_t shapes, size_t bodies, size_t pairs);

/* Perhaps some of the bodies have flown away. To be taken last: then what was found before it was asked stays what it is. */
void take_flights(struct bytes *from, struct scene *scene);

#endif
