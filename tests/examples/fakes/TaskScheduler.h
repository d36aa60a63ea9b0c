/* SPDX-License-Identifier: MIT
 *
 * TaskScheduler.h - what examples/workers/enkits.h uses of enkiTS, in one thread.
 */
#ifndef FAKE_TASK_SCHEDULER_H
#define FAKE_TASK_SCHEDULER_H

#include <cstdint>
#include <functional>

namespace enki {

struct TaskSetPartition {
    uint32_t start, end;
};

struct TaskSet {
    TaskSet(uint32_t count_, std::function<void(TaskSetPartition, uint32_t)> run_) : count(count_), run(run_) {}
    uint32_t count;
    std::function<void(TaskSetPartition, uint32_t)> run;
    bool added = false;
};

/* Runs ranges of two tasks, the last first, when they are waited for. */
struct TaskScheduler {
    uint32_t GetNumTaskThreads() const { return 5; }
    void AddTaskSetToPipe(TaskSet *set) { set->added = true; }
    void WaitforTask(const TaskSet *set) {
        for (uint32_t start = (set->count - 1) / 2 * 2 + 2; set->added && start >= 2; start -= 2)
            set->run({start - 2, start < set->count ? start : set->count}, 0);
    }
};

} // namespace enki

#endif
