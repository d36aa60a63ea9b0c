/* SPDX-License-Identifier: MIT
 *
 * info.c - narc info: what runs here.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "fail.h"
#include "narc.h"
#include "options.h"

static void run(int argc, char **argv) {
    parse_options(argc, argv, NULL, 0, NULL, NULL);
    const char *chosen = narc_get_isa();
    if (!chosen) {
        /* The library's reason, which begins with the function that gives it. */
        narc_error error = {0};
        narc_set_isa(getenv("NARC_ISA"), &error);
        fail("NARC_ISA%s", error.message + strcspn(error.message, ":"));
    }
    printf("narc %s\n\n%-20s", narc_version(), "processor features");
    for (size_t i = 0; narc_cpu_feature(i); i++)
        printf(" %s", narc_cpu_feature(i));
    printf("%s\n", narc_cpu_feature(0) ? "" : " none of those asked for");
    for (size_t i = 0; narc_isa_name(i); i++) {
        const char *name = narc_isa_name(i);
        printf("%-20s %-8s %s\n", i ? "" : "instruction sets", name,
               narc_isa_supported(name) ? "supported" : "not built, or not supported by this processor");
    }
    printf("%-20s %s\n", "in use", chosen);
    for (size_t i = 0; narc_kernel_name(i); i++)
        printf("%-20s %s\n", i ? "" : "kernels", narc_kernel_name(i));
    narc_workers workers;
    narc_openmp_workers(0, &workers);
    printf("%-20s %u\n", "threads", workers.count);
}

const command info_command = {"info", "version, processor features, instruction sets, threads", run};
