/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * format.h - what LAMMPS' headers name of its formatting library, for packages that leave the library's header out.
 */
#ifndef NARC_LAMMPS_FORMAT_H
#define NARC_LAMMPS_FORMAT_H

namespace fmt {
class string_view;
class format_args;
template <class... Arguments, class Format, class... Rest> format_args make_args_checked(const Format &, Rest &&...);
} // namespace fmt

#endif
