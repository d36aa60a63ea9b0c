# SPDX-License-Identifier: MIT
# Toolchain file: 32-bit ARM with a floating point unit, see cross.cmake.
set(processor arm)
set(tools arm-linux-gnueabihf)
set(debian armhf)
set(emulator qemu-arm)
include("${CMAKE_CURRENT_LIST_DIR}/cross.cmake")
