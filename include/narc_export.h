/* SPDX-License-Identifier: MIT
 *
 * narc_export.h - which symbols a shared library shows.
 */
#ifndef NARC_EXPORT_H
#define NARC_EXPORT_H

#if defined(_WIN32) && defined(NARC_BUILDING) /* a program needs no word of its own to call functions of a DLL */
#define NARC_API __declspec(dllexport)
#elif defined(_WIN32)
#define NARC_API
#elif defined(__GNUC__) || defined(__clang__)
#define NARC_API __attribute__((visibility("default")))
#else
#define NARC_API
#endif

#endif
