// SPDX-License-Identifier: MIT
//
// guard.cpp - calls that may throw. CLP is C++: when memory runs out its C interface throws std::bad_alloc.

#include "solve/guard.h"

bool narc_call_guarded(void (*call)(void *), void *context) {
    try {
        call(context);
    } catch (...) {
        return false;
    }
    return true;
}
