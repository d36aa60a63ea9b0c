/* SPDX-License-Identifier: MIT
 *
 * enkits_workers.h - narc's tasks in enkiTS.
 */
#include <TaskScheduler.h>
#include <narc.h>

static void run_in_enkits(void *context, unsigned task_count, void (*task)(void *, unsigned), void *argument) {
    enki::TaskScheduler *scheduler = static_cast<enki::TaskScheduler *>(context);
    enki::TaskSet set(task_count, [=](enki::TaskSetPartition range, uint32_t) {
        for (uint32_t index = range.start; index < range.end; index++)
            task(argument, index);
    });
    scheduler->AddTaskSetToPipe(&set);
    scheduler->WaitforTask(&set);
}

inline narc_workers enkits_workers(enki::TaskScheduler &scheduler) {
    return {&scheduler, scheduler.GetNumTaskThreads(), run_in_enkits};
}
