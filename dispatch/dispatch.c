/* SPDX-License-Identifier: MIT
 *
 * dispatch.c - which table of kernels runs: one atomic pointer, set at the first call or by narc_set_isa().
 */
#include "dispatch.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"

/* Best first. */
static const struct isa {
    const char *name;
    const narc_kernel_table *table;
    unsigned needs;
} isas[] = {
#define NARC_ISA(name, needs, processors, flags) {#name, NARC_ISA_TABLE(NARC_BUILT_##name, narc_kernels_##name), needs},
#include "isa.def"
};
enum { ISA_COUNT = sizeof isas / sizeof isas[0] };

/* All names, each behind a comma. */
static const char isa_names[] =
#define NARC_ISA(name, needs, processors, flags) ", " #name
#include "isa.def"
    ;

_Atomic(const narc_kernel_table *) narc_active_kernels;

/* The processor is asked once: each question leaves a virtual machine, and all took 140 us of a call of narc_set_isa(). */
static bool is_supported(const struct isa *isa) {
    static _Atomic(unsigned) found;
    if (!found)
        found = narc_detect_cpu();
    return isa->table && (found & isa->needs) == isa->needs;
}

static const struct isa *find_isa(const char *name) {
    for (int k = 0; name && k < ISA_COUNT; k++)
        if (strcmp(isas[k].name, name) == 0)
            return &isas[k];
    return NULL;
}

static const narc_kernel_table *best_table(void) {
    int k = 0;
    while (!is_supported(&isas[k])) /* the last one always is */
        k++;
    return isas[k].table;
}

/* The table called `name`, or NULL and why not; `origin` says where the name came from. */
static const narc_kernel_table *table_by_name(const char *name, const char *origin, narc_status *out_status,
                                              narc_error *error) {
    const struct isa *isa = find_isa(name);
    if (!isa) {
        char shown[41]; /* as all names are: letters, digits, signs */
        size_t length = 0;
        for (; name[length] && length + 1 < sizeof shown; length++)
            shown[length] = name[length] >= ' ' && name[length] <= '~' ? name[length] : '?';
        shown[length] = 0;
        *out_status = narc_fail(error, NARC_ERROR_ISA_UNKNOWN, 0, 0, "%s: no instruction set is called '%s' (%s)",
                                origin, shown, isa_names + 2);
        return NULL;
    }
    if (!is_supported(isa)) {
        *out_status = narc_fail(error, NARC_ERROR_ISA_UNSUPPORTED, 0, 0, "%s: %s does not have '%s'", origin,
                                isa->table ? "this processor" : "this build", name);
        return NULL;
    }
    return isa->table;
}

const narc_kernel_table *narc_choose_kernels(narc_status *out_status, narc_error *error) {
    const char *wanted = getenv("NARC_ISA");
    const narc_kernel_table *const table =
        wanted && *wanted ? table_by_name(wanted, "NARC_ISA", out_status, error) : best_table();
    if (!table)
        return NULL;
    /* Another thread may have been first, perhaps through narc_set_isa(): then its choice stands. */
    const narc_kernel_table *first = NULL;
    if (!atomic_compare_exchange_strong_explicit(&narc_active_kernels, &first, table, memory_order_acq_rel,
                                                 memory_order_acquire))
        return first;
    return table;
}

narc_status narc_set_isa(const char *name, narc_error *error) {
    narc_status status = NARC_OK;
    const narc_kernel_table *table = name ? table_by_name(name, "narc_set_isa", &status, error) : best_table();
    if (table)
        atomic_store_explicit(&narc_active_kernels, table, memory_order_release);
    return status;
}

const char *narc_get_isa(void) {
    narc_status status = NARC_OK;
    const narc_kernel_table *table = narc_kernels(&status, NULL);
    return table ? table->isa : NULL;
}

const char *narc_isa_name(size_t index) { return index < ISA_COUNT ? isas[index].name : NULL; }

bool narc_isa_supported(const char *name) {
    const struct isa *isa = find_isa(name);
    return isa && is_supported(isa);
}

static const char *const kernel_names[] = {
#define NARC_KERNEL(type, name, parameters) #name,
#include "kernels.def"
};
enum { KERNEL_COUNT = sizeof kernel_names / sizeof kernel_names[0] };

const char *narc_kernel_name(size_t index) { return index < KERNEL_COUNT ? kernel_names[index] : NULL; }
