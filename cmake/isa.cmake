# SPDX-License-Identifier: MIT
# narc_add_isa(NAME [FLAGS ...]): one object library with the kernels compiled for one instruction set, from
# kernels/isa_<name>.c. Skipped (with a message) if the compiler does not take the flags. Appends to
#   NARC_ISA_NAMES        the name
#   NARC_ISA_OBJECTS      the objects
#   NARC_ISA_DEFINITIONS  NARC_HAVE_<NAME>=1, for the dispatcher
# tests/package.cmake tests the symbols of every name.
include(CheckCSourceCompiles)

function(narc_add_isa name)
  cmake_parse_arguments(ISA "" "" "FLAGS" ${ARGN})
  string(TOUPPER "${name}" upper)
  list(JOIN ISA_FLAGS " " CMAKE_REQUIRED_FLAGS)
  check_c_source_compiles("int main(void) { return 0; }" NARC_COMPILES_${upper})
  if(NOT NARC_COMPILES_${upper})
    message(STATUS "narc: no ${name} kernels, the compiler does not take ${CMAKE_REQUIRED_FLAGS}")
    return()
  endif()
  add_library(narc_isa_${name} OBJECT "${PROJECT_SOURCE_DIR}/kernels/isa_${name}.c")
  # No LTO, whoever asks for it: inlining must not carry these instructions across the processor check.
  set_target_properties(narc_isa_${name} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
  target_compile_options(narc_isa_${name} PRIVATE ${ISA_FLAGS} -fno-lto)
  # Clang 14 crashes over variables in the debug information of optimised AVX-512 kernels (in LLVM's salvageDebugInfo):
  # lines, but no variables.
  target_compile_options(narc_isa_${name} PRIVATE
    $<$<AND:$<C_COMPILER_ID:Clang>,$<VERSION_LESS:$<C_COMPILER_VERSION>,16>>:-gline-tables-only>)
  target_link_libraries(narc_isa_${name} PRIVATE narc_flags)
  if(NARC_SLEEF)
    target_link_libraries(narc_isa_${name} PRIVATE PkgConfig::SLEEF)
    target_compile_definitions(narc_isa_${name} PRIVATE NARC_WITH_SLEEF=1)
  endif()
  set(NARC_ISA_NAMES ${NARC_ISA_NAMES} ${name} PARENT_SCOPE)
  set(NARC_ISA_OBJECTS ${NARC_ISA_OBJECTS} $<TARGET_OBJECTS:narc_isa_${name}> PARENT_SCOPE)
  set(NARC_ISA_DEFINITIONS ${NARC_ISA_DEFINITIONS} NARC_HAVE_${upper}=1 PARENT_SCOPE)
endfunction()
