// SPDX-License-Identifier: MIT
//
// adapters.cpp - the adapters of examples/workers: each runs all tasks, and answers are those of the calling thread.
//
// Of Box2D and enkiTS only what the adapters use is here, under empty headers with their names.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>

extern "C" {
typedef void b2TaskCallback(int begin, int end, uint32_t worker, void *context);
typedef void *b2EnqueueTaskCallback(b2TaskCallback *task, int count, int least, void *context, void *user_context);
typedef void b2FinishTaskCallback(void *pending, void *user_context);
}

struct b2WorldDef {
    int workerCount;
    b2EnqueueTaskCallback *enqueueTask;
    b2FinishTaskCallback *finishTask;
    void *userTaskContext;
};

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

// Runs ranges of two tasks, the last first, when they are waited for.
struct TaskScheduler {
    uint32_t GetNumTaskThreads() const { return 5; }
    void AddTaskSetToPipe(TaskSet *set) { set->added = true; }
    void WaitforTask(const TaskSet *set) {
        for (uint32_t start = (set->count - 1) / 2 * 2 + 2; set->added && start >= 2; start -= 2)
            set->run({start - 2, start < set->count ? start : set->count}, 0);
    }
};

} // namespace enki

#include "workers/box2d_workers.h"
#include "workers/enkits_workers.h"
#include "workers/thread_workers.h"

namespace {

constexpr unsigned body_count = 700;

// Every other task of Box2D's hooks runs at once, the others when they are waited for.
struct Hooks {
    b2TaskCallback *task;
    void *context;
    int count;
    unsigned calls;
};

void *enqueue(b2TaskCallback *task, int count, int, void *context, void *user) {
    Hooks *hooks = static_cast<Hooks *>(user);
    *hooks = {task, context, count, hooks->calls + 1};
    if (hooks->calls % 2 == 0)
        return hooks;
    task(0, count, 0, context);
    return nullptr;
}

void finish(void *pending, void *) {
    const Hooks *hooks = static_cast<Hooks *>(pending);
    for (int index = hooks->count; index-- > 0;)
        hooks->task(index, index + 1, 0, hooks->context);
}

std::vector<narc_contact> find_contacts(const narc_shapes *shapes, const narc_workers *workers) {
    std::vector<narc_body> body(body_count);
    std::vector<uint32_t> a, b;
    for (unsigned k = 0; k < body_count; k++)
        body[k] = {0.013 * k, 0.017 * (k * 37 % body_count), 1, 0, 1, 0};
    for (unsigned k = 0; k < 20 * body_count; k++) {
        a.push_back(k % body_count);
        b.push_back((k % body_count + 1 + k / body_count) % body_count);
    }
    narc_bodies bodies;
    narc_view_bodies(body.data(), body.size(), &bodies);
    narc_pairs pairs = {};
    pairs.count = a.size();
    pairs.a = NARC_ARRAY(a);
    pairs.b = NARC_ARRAY(b);
    narc_query query = {};
    query.workers = workers;
    std::vector<narc_contact> rows(a.size());
    size_t found = 0;
    if (narc_find_contacts(shapes, &bodies, &pairs, &query, rows.data(), rows.size(), &found, nullptr))
        found = 0;
    rows.resize(found);
    return rows;
}

} // namespace

int main() {
    narc_shapes *shapes = nullptr;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count = 0;
    if (narc_create_shapes(nullptr, &shapes) || narc_build_box(2, 2, 0.25, arcs, &count, nullptr) ||
        narc_add_shape(shapes, arcs, count, nullptr, nullptr))
        return 1;
    const std::vector<narc_contact> expected = find_contacts(shapes, nullptr);
    Hooks hooks = {};
    b2WorldDef world = {3, enqueue, finish, &hooks};
    enki::TaskScheduler scheduler;
    narc_workers all[] = {box2d_workers(&world), box2d_workers(&world), enkits_workers(scheduler), thread_workers()};
    all[3].count = 4; /* the machine may have one */
    int wrong = expected.empty();
    for (const narc_workers &workers : all) {
        const std::vector<narc_contact> rows = find_contacts(shapes, &workers);
        wrong += rows.size() != expected.size() ||
                 std::memcmp(rows.data(), expected.data(), rows.size() * sizeof rows[0]) != 0;
    }
    wrong += hooks.calls < 2;
    std::printf("%zu contacts, %u calls of hooks, %d wrong\n", expected.size(), hooks.calls, wrong);
    narc_destroy_shapes(shapes);
    return wrong != 0;
}
