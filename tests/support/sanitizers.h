/* SPDX-License-Identifier: MIT
 *
 * sanitizers.h - is this built for the address or the thread sanitizer, which have frames, a malloc() and locks of their
 * own?
 */
#ifndef NARC_TEST_SANITIZERS_H
#define NARC_TEST_SANITIZERS_H

#ifdef __SANITIZE_ADDRESS__
#define HAS_ADDRESS_SANITIZER 1
#elif defined(__has_feature) /* clang */
#define HAS_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#else
#define HAS_ADDRESS_SANITIZER 0
#endif

#ifdef __SANITIZE_THREAD__
#define IS_SANITIZED 1
#elif defined(__has_feature)
#define IS_SANITIZED (HAS_ADDRESS_SANITIZER || __has_feature(thread_sanitizer))
#else
#define IS_SANITIZED HAS_ADDRESS_SANITIZER
#endif

#endif
