# SPDX-License-Identifier: MIT
# Toolchain file: Windows on x86-64 by mingw-w64, the tests under wine.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
# GCC takes 32-byte variables on the stack to be aligned, which Windows' stack is not. mingw-w64's isfinite() converts
# doubles in branches that are never taken.
set(CMAKE_C_FLAGS_INIT "-Wa,-muse-unaligned-vector-move -Wno-float-conversion")
# No DLL of the compiler's own.
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -static)
get_filename_component(wine_folder "${CMAKE_CURRENT_LIST_DIR}/../build/wine" ABSOLUTE)
# wine takes arguments and names of files to be in the locale's encoding.
set(CMAKE_CROSSCOMPILING_EMULATOR env WINEDEBUG=-all LC_ALL=C.UTF-8
  "WINEPREFIX=${wine_folder}" /usr/lib/wine/wine64)
# Libraries that mingw64.sh has built, all static.
get_filename_component(packages "${CMAKE_CURRENT_LIST_DIR}/../build/packages/mingw64" ABSOLUTE)
set(NARC_LICENCES "${packages}/licences")
set(ENV{PKG_CONFIG_LIBDIR} "${packages}/lib/pkgconfig")
set(PKG_CONFIG_ARGN --static)
set(CMAKE_FIND_ROOT_PATH "${packages}" /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
