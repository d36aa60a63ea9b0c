/* SPDX-License-Identifier: MIT
 *
 * sanitizers.h - is this built for the address or the thread sanitizer, which have frames, a malloc() and locks of their
 * own?
 */
#ifndef NARC_TEST_SANITIZERS_H
#define NARC_TEST_SANITIZERS_H

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define IS_SANITIZED 1
#elif defined(__has_feature) /* clang */
#define IS_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#else
#define IS_SANITIZED 0
#endif

#endif
