/* SPDX-License-Identifier: MIT
 *
 * stacks.c - threads on stacks between forbidden pages and watched ones.
 */
#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include "stacks.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "guard.h"
#include "sanitizers.h"

#ifdef __OPTIMIZE__
const bool large_frames = IS_SANITIZED;
#else
const bool large_frames = true;
#endif

enum { FORBIDDEN = 1 << 20 };

static unsigned char *call_stack, *task_stack;
static size_t stack_size, most; /* promised, and the most that was used */

/* What a thread is given: on some platforms none may have as little as calls are promised to need. */
static size_t thread_size(void) {
    const long least = sysconf(_SC_THREAD_STACK_MIN);
    return least > 0 && (size_t)least > stack_size ? (size_t)least : stack_size;
}

static unsigned char *map_stack(void) {
    unsigned char *map =
        mmap(NULL, FORBIDDEN + thread_size(), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(map != MAP_FAILED);
    assert_int_equal(mprotect(map, FORBIDDEN, PROT_NONE), 0);
    return map + FORBIDDEN;
}

/* Runs a thread and returns how much of its stack it used. */
static size_t run_thread(unsigned char *stack, void *(*work)(void *), void *argument) {
    const size_t size = thread_size();
    pthread_attr_t attributes;
    pthread_t thread;
    size_t left = 0;
    memset(stack, GUARD_JUNK, size);
    assert_int_equal(pthread_attr_init(&attributes), 0);
    assert_int_equal(pthread_attr_setstack(&attributes, stack, size), 0);
    assert_int_equal(pthread_create(&thread, &attributes, work, argument), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(pthread_attr_destroy(&attributes), 0);
    while (left < size && stack[left] == GUARD_JUNK)
        left++;
    if (size - left > stack_size)
        fail_msg("%zu of %zu bytes", size - left, stack_size);
    most = size - left > most ? size - left : most;
    return size - left;
}

struct job {
    const struct stack_call *call;
    narc_error error;
    narc_status status;
};

static void *run_job(void *argument) {
    struct job *job = argument;
    job->status = job->call->run(&job->error);
    return NULL;
}

struct task {
    void (*run)(void *argument, unsigned index);
    void *argument;
    unsigned index;
};

static void *run_task(void *argument) {
    const struct task *task = argument;
    task->run(task->argument, task->index);
    return NULL;
}

/* Workers whose tasks have threads of their own, one after the other. */
static void run_tasks(void *context, unsigned task_count, void (*run)(void *argument, unsigned index), void *argument) {
    (void)context;
    for (unsigned index = 0; index < task_count; index++) {
        struct task task = {run, argument, index};
        run_thread(task_stack, run_task, &task);
    }
}

void run_on_stacks(const struct stack_call *calls, size_t call_count, size_t promised,
                   void (*set_workers)(const narc_workers *workers)) {
    const narc_workers tasks = {.count = 3, .run = run_tasks};
    const narc_workers openmp = openmp_workers(3);
    const narc_workers *const workers[] = {NULL, &openmp, &tasks};
    stack_size = promised;
    call_stack = map_stack();
    task_stack = map_stack();
    for (size_t way = 0; way < 3; way++) {
        set_workers(workers[way]);
        most = 0;
        for (size_t k = 0; k < call_count; k++) {
            struct job job = {.call = &calls[k], .status = NARC_ERROR_CANCELLED};
            printf("%s", calls[k].name);
            fflush(stdout);
            printf(" %zu\n", run_thread(call_stack, run_job, &job));
            if (job.status != NARC_OK && job.status != NARC_ERROR_CAPACITY)
                fail_msg("%s: %s", calls[k].name, job.error.message);
        }
        printf("at most %zu of %zu bytes\n", most, stack_size);
        assert_true(most > stack_size / 4); /* the measure works */
    }
}
