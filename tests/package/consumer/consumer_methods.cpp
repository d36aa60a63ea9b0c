// SPDX-License-Identifier: MIT
//
// consumer_methods.cpp - the same program in C++.
#include "consumer_methods.c"
