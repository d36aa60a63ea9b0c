# SPDX-License-Identifier: MIT
# Toolchain file: build for 64-bit ARM on another Debian or Ubuntu machine, run the tests under qemu-aarch64.
#
# The arm64 libraries (SLEEF, cmocka) come from the packages unpacked in build/arm64, where `sh cmake/bootstrap.sh test`
# puts them; where that folder is missing, from the system (libsleef-dev:arm64 and libcmocka-dev:arm64).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu)

get_filename_component(packages "${CMAKE_CURRENT_LIST_DIR}/../build/arm64" ABSOLUTE)
set(ENV{PKG_CONFIG_LIBDIR} "/usr/lib/aarch64-linux-gnu/pkgconfig")
if(IS_DIRECTORY "${packages}")
  set(ENV{PKG_CONFIG_SYSROOT_DIR} "${packages}")
  set(ENV{PKG_CONFIG_LIBDIR} "${packages}/usr/lib/aarch64-linux-gnu/pkgconfig")
  # The library that a program's shared library needs is not in a place where linker and loader look by themselves.
  set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${packages}/usr/lib/aarch64-linux-gnu")
  list(APPEND CMAKE_CROSSCOMPILING_EMULATOR -E "LD_LIBRARY_PATH=${packages}/usr/lib/aarch64-linux-gnu")
  set(CMAKE_C_FLAGS_INIT "-isystem ${packages}/usr/include/aarch64-linux-gnu -isystem ${packages}/usr/include")
  set(CMAKE_FIND_ROOT_PATH "${packages}")
  set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
endif()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
