/* SPDX-License-Identifier: MIT
 *
 * box2d.h - what examples/workers/box2d.h uses of Box2D: the types of its hooks.
 */
#ifndef FAKE_BOX2D_H
#define FAKE_BOX2D_H

#include <stdint.h>

typedef void b2TaskCallback(int begin, int end, uint32_t worker, void *context);
typedef void *b2EnqueueTaskCallback(b2TaskCallback *task, int count, int least, void *context, void *user_context);
typedef void b2FinishTaskCallback(void *pending, void *user_context);

typedef struct b2WorldDef {
    int workerCount;
    b2EnqueueTaskCallback *enqueueTask;
    b2FinishTaskCallback *finishTask;
    void *userTaskContext;
} b2WorldDef;

#endif
