// SPDX-License-Identifier: MIT
//
// consumer_files.cpp - the same program in C++.
#include "consumer_files.c"
