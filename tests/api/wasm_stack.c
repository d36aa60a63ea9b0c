/* SPDX-License-Identifier: MIT
 *
 * wasm_stack.c - the stack that a program on WebAssembly has by linking narc alone: as large as NARC_WASM_STACK says, and
 * below all data.
 */
#include <stdint.h>
#include <stdio.h>

#include "narc.h"

extern unsigned char __global_base; /* of the linker: where data begin */

int main(void) {
    const uintptr_t local = (uintptr_t) & (int){0}, data = (uintptr_t)&__global_base;
    printf("%s: a local at %zu, data at %zu\n", narc_version(), (size_t)local, (size_t)data);
    return data >= STACK && STACK >= 4 * NARC_STACK_SIZE && local < data ? 0 : 1;
}
