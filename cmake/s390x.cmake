# SPDX-License-Identifier: MIT
# Toolchain file: IBM Z, whose numbers lie in memory from their upper byte on, see cross.cmake.
set(processor s390x)
set(tools s390x-linux-gnu)
set(debian s390x)
set(emulator qemu-s390x)
include("${CMAKE_CURRENT_LIST_DIR}/cross.cmake")
