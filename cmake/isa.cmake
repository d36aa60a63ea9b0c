# SPDX-License-Identifier: MIT
# The instruction sets of kernels/isa.def: for each that this processor's kind can have and the compiler takes the flags
# of, one object library narc_isa_<name> with the kernels compiled for it. Sets
#   NARC_KERNEL_SOURCES   the kernels' files
#   NARC_ISA_LIST         all names, best first
#   NARC_ISA_NAMES        those that are built
#   NARC_ISA_OBJECTS      their objects
#   NARC_ISA_FLAGS_<name> what the compiler needs for it
#   NARC_ISA_DEFINITIONS  NARC_BUILT_<name>=1 or 0, for the dispatcher
# tests/kernels/CMakeLists.txt makes tests of every name, tests/package/CMakeLists.txt tests the symbols of what is built.
include(CheckCSourceCompiles)

set(NARC_KERNEL_SOURCES)
foreach(file sat/overlap sat/search sat/rows sat/pair sat/contact sat/manifold sat/separation sat/follow sat/recycle box/box_walk broad/boxes broad/sweep
    pose parts scene/rays scene/ray_fans scene/ray_pairs scene/regions scene/points scene/nearest
    scene/casts scene/one_cast scene/piece_casts scene/fit table)
  list(APPEND NARC_KERNEL_SOURCES "${PROJECT_SOURCE_DIR}/kernels/${file}.c")
endforeach()

# One pair at a time is hardly faster with -O3, and its text is to stay in the first cache.
set_source_files_properties("${PROJECT_SOURCE_DIR}/kernels/sat/pair.c" "${PROJECT_SOURCE_DIR}/kernels/scene/one_cast.c" PROPERTIES
  COMPILE_OPTIONS "$<$<CONFIG:Release,RelWithDebInfo>:-O2>")

# narc_add_isa_objects(TARGET NAME ISA SOURCE ...): symbols have the name, instructions are those of the set.
function(narc_add_isa_objects target name isa)
  add_library(${target} OBJECT ${ARGN})
  target_compile_definitions(${target} PRIVATE NARC_ISA_NAME=${name} NARC_SIMD="simd/${isa}.h")
  # No LTO, whoever asks for it: inlining must not carry these instructions across the processor check.
  set_target_properties(${target} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
  separate_arguments(flag_list UNIX_COMMAND "${NARC_ISA_FLAGS_${isa}}")
  # Functions begin with a cache line: anywhere else the same code takes up to 4 % longer.
  target_compile_options(${target} PRIVATE ${flag_list} -fno-lto -falign-functions=64)
  # Structures are copied by the registers that they are written by: a wider load waits for all stores that it covers.
  if(CMAKE_C_COMPILER_ID STREQUAL "GNU" AND CMAKE_C_COMPILER_VERSION VERSION_GREATER_EQUAL 12 AND isa STREQUAL "avx512")
    target_compile_options(${target} PRIVATE -mmove-max=128 -mstore-max=128)
  endif()
  # Where each variable of an optimised kernel lives takes half of GCC's time to find out, and Clang 14 crashes over it
  # (in LLVM's salvageDebugInfo): lines, but no variables.
  target_compile_options(${target} PRIVATE $<$<C_COMPILER_ID:GNU>:-fno-var-tracking>
    $<$<AND:$<C_COMPILER_ID:Clang,AppleClang>,$<VERSION_LESS:$<C_COMPILER_VERSION>,16>>:-gline-tables-only>)
  # The address sanitizer's checks written out take GCC half a minute in a file; as calls they are the same.
  if(CMAKE_C_FLAGS MATCHES "-fsanitize=[a-z,-]*address")
    target_compile_options(${target} PRIVATE
      $<$<C_COMPILER_ID:GNU>:SHELL:--param asan-instrumentation-with-call-threshold=0>)
    # And all take minutes to compile into all sets: fuzzing goes through the plain C kernels with them, tests through the
    # vectors' ones.
    if((isa STREQUAL "scalar" AND NOT NARC_BUILD_FUZZERS) OR (NOT isa STREQUAL "scalar" AND NARC_BUILD_FUZZERS))
      target_compile_options(${target} PRIVATE -fno-sanitize=all)
    endif()
  endif()
  target_link_libraries(${target} PRIVATE narc_flags)
endfunction()

set(processor "${CMAKE_SYSTEM_PROCESSOR}")
if(processor MATCHES "^(x86_64|AMD64)$" AND CMAKE_SIZEOF_VOID_P EQUAL 4)
  set(processor i686) # -m32
endif()
set(isa_file "${PROJECT_SOURCE_DIR}/kernels/isa.def")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${isa_file}")
file(STRINGS "${isa_file}" isa_lines REGEX "^NARC_ISA\\(")
foreach(line IN LISTS isa_lines)
  if(NOT line MATCHES "^NARC_ISA\\(([a-z0-9_]+), [A-Z0-9_ |]+, \"([^\"]+)\", \"([^\"]*)\"\\)$")
    message(FATAL_ERROR "narc: ${isa_file}: not understood: ${line}")
  endif()
  set(name "${CMAKE_MATCH_1}")
  set(processors "${CMAKE_MATCH_2}")
  set(CMAKE_REQUIRED_FLAGS "${CMAKE_MATCH_3}")
  list(APPEND NARC_ISA_LIST ${name})
  set(built 0)
  if(processor MATCHES "^(${processors})$")
    check_c_source_compiles("int main(void) { return 0; }" NARC_COMPILES_${name})
    if(NARC_COMPILES_${name})
      set(NARC_ISA_FLAGS_${name} "${CMAKE_REQUIRED_FLAGS}")
      narc_add_isa_objects(narc_isa_${name} ${name} ${name} ${NARC_KERNEL_SOURCES})
      if(NARC_SLEEF)
        target_link_libraries(narc_isa_${name} PRIVATE PkgConfig::SLEEF)
        target_compile_definitions(narc_isa_${name} PRIVATE NARC_WITH_SLEEF=1)
      endif()
      list(APPEND NARC_ISA_NAMES ${name})
      list(APPEND NARC_ISA_OBJECTS $<TARGET_OBJECTS:narc_isa_${name}>)
      set(built 1)
    else()
      message(STATUS "narc: no ${name} kernels, the compiler does not take ${CMAKE_REQUIRED_FLAGS}")
    endif()
  endif()
  list(APPEND NARC_ISA_DEFINITIONS NARC_BUILT_${name}=${built})
endforeach()
set(CMAKE_REQUIRED_FLAGS)
