# SPDX-License-Identifier: MIT
# Toolchain file: 32-bit x86, see cross.cmake.
set(processor i686)
set(tools i686-linux-gnu)
set(debian i386)
set(emulator qemu-i386)
include("${CMAKE_CURRENT_LIST_DIR}/cross.cmake")
