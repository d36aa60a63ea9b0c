# narc_add_isa(NAME FLAGS ...): one object library with the kernels compiled for one instruction set, from
# kernels/isa_<name>.c. Skipped (with a message) if the compiler does not take the flags. Adds the objects to
# NARC_ISA_OBJECTS and NARC_HAVE_<NAME> to the dispatcher's definitions (NARC_ISA_DEFINITIONS).
include(CheckCSourceCompiles)

function(narc_add_isa name)
  cmake_parse_arguments(ISA "" "" "FLAGS" ${ARGN})
  string(TOUPPER "${name}" upper)
  list(JOIN ISA_FLAGS " " flags)
  set(CMAKE_REQUIRED_FLAGS "${flags}")
  check_c_source_compiles("int main(void) { return 0; }" NARC_COMPILES_${upper})
  if(NOT NARC_COMPILES_${upper})
    message(STATUS "narc: no ${name} kernels, the compiler does not take ${flags}")
    return()
  endif()
  add_library(narc_isa_${name} OBJECT "${PROJECT_SOURCE_DIR}/kernels/isa_${name}.c")
  # No LTO: inlining must not carry these instructions across the processor check.
  set_target_properties(narc_isa_${name} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
  target_compile_options(narc_isa_${name} PRIVATE ${ISA_FLAGS})
  target_link_libraries(narc_isa_${name} PRIVATE narc_flags narc_kernel_dependencies)
  set(NARC_ISA_NAMES ${NARC_ISA_NAMES} ${name} PARENT_SCOPE)
  set(NARC_ISA_OBJECTS ${NARC_ISA_OBJECTS} $<TARGET_OBJECTS:narc_isa_${name}> PARENT_SCOPE)
  set(NARC_ISA_DEFINITIONS ${NARC_ISA_DEFINITIONS} NARC_HAVE_${upper}=1 PARENT_SCOPE)
endfunction()
