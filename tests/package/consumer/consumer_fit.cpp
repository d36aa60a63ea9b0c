// SPDX-License-Identifier: MIT
//
// consumer_fit.cpp - the same program in C++.
#include "consumer_fit.c"
