# SPDX-License-Identifier: MIT
# What the toolchain files share: build for another processor on a Debian or Ubuntu machine, run the tests under qemu.
# Set before: `processor`, CMake's name of it; `tools`, the prefix of the compiler; `debian`, Debian's name of it;
# `emulator`.
#
# Libraries of that processor (cmocka, SLEEF) come from the packages unpacked in build/packages/<debian>, where
# `sh cmake/bootstrap.sh gate` puts them; where that folder is missing, from the system (libcmocka-dev:<debian>).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR ${processor})
set(CMAKE_C_COMPILER ${tools}-gcc)
set(CMAKE_CROSSCOMPILING_EMULATOR ${emulator} -L /usr/${tools})

execute_process(COMMAND ${CMAKE_C_COMPILER} -print-multiarch OUTPUT_VARIABLE triplet OUTPUT_STRIP_TRAILING_WHITESPACE)
get_filename_component(packages "${CMAKE_CURRENT_LIST_DIR}/../build/packages/${debian}" ABSOLUTE)
set(ENV{PKG_CONFIG_LIBDIR} "/usr/lib/${triplet}/pkgconfig")
if(IS_DIRECTORY "${packages}")
  set(ENV{PKG_CONFIG_SYSROOT_DIR} "${packages}")
  set(ENV{PKG_CONFIG_LIBDIR} "${packages}/usr/lib/${triplet}/pkgconfig")
  # The library that a program's shared library needs is not in a place where linker and loader look by themselves.
  set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${packages}/usr/lib/${triplet}")
  list(APPEND CMAKE_CROSSCOMPILING_EMULATOR -E "LD_LIBRARY_PATH=${packages}/usr/lib/${triplet}")
  set(CMAKE_C_FLAGS_INIT "-isystem ${packages}/usr/include/${triplet} -isystem ${packages}/usr/include")
  set(CMAKE_FIND_ROOT_PATH "${packages}")
  set(CMAKE_LIBRARY_ARCHITECTURE ${triplet})
endif()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
