/* SPDX-License-Identifier: MIT
 *
 * box2d_workers.h - narc's tasks through the hooks that an engine has for Box2D's (versions 3.0 and 3.1).
 */
#include <box2d/box2d.h>
#include <narc.h>

struct job {
    void (*task)(void *argument, unsigned index);
    void *argument;
};

static void run_items(int begin, int end, uint32_t worker, void *context) {
    const struct job *job = (const struct job *)context;
    (void)worker;
    for (int index = begin; index < end; index++)
        job->task(job->argument, (unsigned)index);
}

static void run_by_hooks(void *context, unsigned task_count, void (*task)(void *, unsigned), void *argument) {
    const b2WorldDef *hooks = (const b2WorldDef *)context;
    struct job job = {task, argument};
    void *pending = hooks->enqueueTask(run_items, (int)task_count, 1, &job, hooks->userTaskContext);
    if (pending) /* else it has run */
        hooks->finishTask(pending, hooks->userTaskContext);
}

static inline narc_workers box2d_workers(b2WorldDef *hooks) { /* it must last as long as they */
    narc_workers workers = {hooks, (unsigned)hooks->workerCount, run_by_hooks};
    return workers;
}
