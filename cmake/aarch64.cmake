# SPDX-License-Identifier: MIT
# Toolchain file: 64-bit ARM, see cross.cmake.
set(processor aarch64)
set(tools aarch64-linux-gnu)
set(debian arm64)
set(emulator qemu-aarch64)
include("${CMAKE_CURRENT_LIST_DIR}/cross.cmake")
