/* SPDX-License-Identifier: MIT
 *
 * happens_before.c - for LD_PRELOAD, under valgrind's helgrind, which does not see that libgomp's threads wait for each
 * other, by futex: what comes before an OpenMP region happens before its tasks, and these before what comes after it.
 */
#define _GNU_SOURCE /* RTLD_NEXT */
#include <dlfcn.h>
#include <string.h>
#include <valgrind/helgrind.h>

typedef void region(void *data);
typedef void run_region(region *task, void *data, unsigned threads, unsigned flags);

struct call {
    region *task;
    void *data;
    char begin, end; /* their addresses are what helgrind orders by */
};

static void run_task(void *argument) {
    struct call *const call = argument;
    ANNOTATE_HAPPENS_AFTER(&call->begin);
    call->task(call->data);
    ANNOTATE_HAPPENS_BEFORE(&call->end);
}

/* What GCC makes of `omp parallel`. */
__attribute__((visibility("default"))) run_region GOMP_parallel;
void GOMP_parallel(region *task, void *data, unsigned threads, unsigned flags) {
    struct call call = {.task = task, .data = data};
    run_region *run;
    void *const found = dlsym(RTLD_NEXT, "GOMP_parallel");
    memcpy(&run, &found, sizeof run);
    ANNOTATE_HAPPENS_BEFORE(&call.begin);
    run(run_task, &call, threads, flags);
    ANNOTATE_HAPPENS_AFTER(&call.end);
    ANNOTATE_HAPPENS_BEFORE_FORGET_ALL(&call.begin);
    ANNOTATE_HAPPENS_BEFORE_FORGET_ALL(&call.end);
}
