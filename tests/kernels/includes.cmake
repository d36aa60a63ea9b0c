# SPDX-License-Identifier: MIT
# Does every kernel file include what it uses? Compiles each one alone, for its syntax only. Run as
#   cmake -D COMPILER=... -D FLAGS=... -D SOURCE=<the project's folder> -P includes.cmake
separate_arguments(flags UNIX_COMMAND "${FLAGS}")
file(GLOB_RECURSE files "${SOURCE}/kernels/*.inl" "${SOURCE}/kernels/*.c" "${SOURCE}/methods/*.inl")
list(LENGTH files count)
if(count LESS 20)
  message(FATAL_ERROR "only ${count} files in ${SOURCE}")
endif()
set(failed)
foreach(file IN LISTS files)
  execute_process(COMMAND "${COMPILER}" ${flags} -std=c17 -fsyntax-only -Werror=implicit-function-declaration
      "-I${SOURCE}" "-I${SOURCE}/include" "-I${SOURCE}/kernels" "-I${SOURCE}/soa" "-I${SOURCE}/dispatch"
      -DNARC_ISA_NAME=scalar "-DNARC_SIMD=\"simd/scalar.h\"" -x c "${file}"
    ERROR_VARIABLE errors RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message("${errors}")
    list(APPEND failed "${file}")
  endif()
endforeach()
if(failed)
  message(FATAL_ERROR "do not compile alone: ${failed}")
endif()
