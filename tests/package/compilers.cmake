# SPDX-License-Identifier: MIT
# What compilers other than the one in use would say. Run as cmake -D SOURCE=<the project's folder> -P compilers.cmake:
# words that are not C17 stand in soa/compiler.h and the public include/narc_export.h alone. With
#   CLANG, HEADERS, LAYOUTS  the libraries go through clang's front end as for Microsoft's compiler, without a warning, with
#                            mingw-w64's headers (which take the compiler for GCC; compiler.h alone asks for it); LAYOUTS is
#                            where declared.h lies
cmake_minimum_required(VERSION 3.22)
set(words "__(attribute|builtin|typeof|asm|declspec|restrict|inline|has_feature|int128)|_Pragma|_MSC_|__GNU|__clang")
foreach(layer include soa kernels dispatch methods files fit tools examples)
  file(GLOB_RECURSE files RELATIVE "${SOURCE}" "${SOURCE}/${layer}/*.[ch]" "${SOURCE}/${layer}/*.inl")
  list(REMOVE_ITEM files soa/compiler.h include/narc_export.h)
  foreach(file IN LISTS files)
    file(STRINGS "${SOURCE}/${file}" lines REGEX "(^|[^A-Za-z_0-9])(${words})|[^A-Za-z_](asm|typeof) *\\(")
    foreach(line IN LISTS lines)
      message(SEND_ERROR "${file}: to stand in soa/compiler.h: ${line}")
    endforeach()
    math(EXPR read "0${read} + 1")
  endforeach()
endforeach()
if(read LESS 150)
  message(FATAL_ERROR "only ${read} files were found")
endif()
if(NOT CLANG OR NOT HEADERS)
  message(STATUS "words only: no clang, or no headers of Windows")
  return()
endif()

file(STRINGS "${SOURCE}/kernels/isa.def" all_lines REGEX "^NARC_ISA\\(")
set(lines ${all_lines})
list(FILTER lines INCLUDE REGEX "AMD64|\\(scalar")
foreach(line IN LISTS all_lines)
  string(REGEX MATCH "\\(([a-z0-9]+)" matched "${line}")
  set(built 0)
  if(line IN_LIST lines)
    set(built 1)
  endif()
  list(APPEND definitions -DNARC_BUILT_${CMAKE_MATCH_1}=${built})
endforeach()

function(compile file)
  execute_process(COMMAND "${CLANG}" --target=x86_64-pc-windows-msvc -fgnuc-version=4.2.1 -fsyntax-only -std=c17
    -nostdlibinc -isystem "${HEADERS}" -D_CRT_SECURE_NO_WARNINGS -I include -I soa -I kernels -I dispatch -I methods -I . -I "${LAYOUTS}"
    -DNARC_BUILDING=1 ${definitions} -Wall -Wextra -Wundef -Werror ${ARGN} ${file}
    WORKING_DIRECTORY "${SOURCE}" RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(SEND_ERROR "${file}: not for Microsoft's headers")
  endif()
endfunction()

file(GLOB files RELATIVE "${SOURCE}" "${SOURCE}/soa/*.c" "${SOURCE}/dispatch/*.c" "${SOURCE}/dispatch/*/*.c"
  "${SOURCE}/methods/*.c")
list(REMOVE_ITEM files methods/kernels.c)
foreach(file IN LISTS files)
  compile(${file})
endforeach()
file(GLOB kernels RELATIVE "${SOURCE}" "${SOURCE}/kernels/*.c" "${SOURCE}/kernels/*/*.c"
  "${SOURCE}/methods/kernels.c")
# All for AVX2. What another instruction set has of its own is the header that rows.c has, too.
foreach(line IN LISTS lines)
  string(REGEX MATCH "^NARC_ISA\\(([a-z0-9]+), .*\"([^\"]*)\"\\)$" matched "${line}")
  separate_arguments(flags UNIX_COMMAND "${CMAKE_MATCH_2}")
  if(NOT CMAKE_MATCH_1 STREQUAL "avx2")
    set(files kernels/sat/rows.c)
  else()
    set(files ${kernels})
  endif()
  foreach(file IN LISTS files)
    compile(${file} ${flags} -DNARC_ISA_NAME=${CMAKE_MATCH_1} "-DNARC_SIMD=\"simd/${CMAKE_MATCH_1}.h\"")
  endforeach()
endforeach()
