/* SPDX-License-Identifier: MIT
 *
 * narc_export.h - which symbols a shared library shows.
 */
#ifndef NARC_EXPORT_H
#define NARC_EXPORT_H

#if defined(__GNUC__) || defined(__clang__)
#define NARC_API __attribute__((visibility("default")))
#else
#define NARC_API
#endif

#endif
