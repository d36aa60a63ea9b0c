# SPDX-License-Identifier: MIT
# Toolchain file: 64-bit RISC-V, see cross.cmake.
set(processor riscv64)
set(tools riscv64-linux-gnu)
set(debian riscv64)
set(emulator qemu-riscv64)
include("${CMAKE_CURRENT_LIST_DIR}/cross.cmake")
