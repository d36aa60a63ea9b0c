# SPDX-License-Identifier: MIT
# Toolchain file: WebAssembly by clang and wasi-libc, the tests in node.
set(CMAKE_SYSTEM_NAME Generic) # a system without shared libraries; older versions of CMake do not know WASI
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_EXECUTABLE_SUFFIX_C .wasm)
# Without this option Node 20 crashed at the end of long programs.
set(CMAKE_CROSSCOMPILING_EMULATOR node --no-warnings --no-turbo-fast-api-calls "${CMAKE_CURRENT_LIST_DIR}/wasi.mjs")
set(CMAKE_FIND_ROOT_PATH /usr/include/wasm32-wasi)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
