/* SPDX-License-Identifier: MIT
 *
 * thread_workers.h - narc's tasks in threads of the C++ library.
 */
#include <narc.h>

#include <thread>
#include <vector>

static void run_in_threads(void *, unsigned task_count, void (*task)(void *, unsigned), void *argument) {
    std::vector<std::thread> threads;
    for (unsigned index = 1; index < task_count; index++)
        threads.emplace_back(task, argument, index);
    task(argument, 0);
    for (std::thread &thread : threads)
        thread.join();
}

inline narc_workers thread_workers() { return {nullptr, std::thread::hardware_concurrency(), run_in_threads}; }
