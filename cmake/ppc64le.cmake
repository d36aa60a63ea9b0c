# SPDX-License-Identifier: MIT
# Toolchain file: 64-bit POWER, see cross.cmake.
set(processor ppc64le)
set(tools powerpc64le-linux-gnu)
set(debian ppc64el)
set(emulator qemu-ppc64le)
include("${CMAKE_CURRENT_LIST_DIR}/cross.cmake")
