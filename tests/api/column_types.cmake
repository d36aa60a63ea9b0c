# SPDX-License-Identifier: MIT
# Columns of the wrong type do not compile, whatever a compiler makes of pointers of another type.
set(good ".cosine = NARC_COLUMN(body, c), .shape = NARC_COLUMN(body, shape), .x = NARC_POSITION_COLUMN(body, x),
  .y = NARC_POSITION_COLUMN(body, c)")
set(bad ".cosine = NARC_COLUMN(body, x)" ".cosine = NARC_COLUMN(body, shape)" ".shape = NARC_COLUMN(body, c)"
  ".shape = NARC_COLUMN(body, signed_shape)" ".x = NARC_POSITION_COLUMN(body, shape)" ".x = NARC_COLUMN(body, c)"
  ".scale = NARC_ARRAY(doubles)")

function(compiles out_result language fields)
  if(language STREQUAL c)
    set(command ${C_COMPILER} -std=c17)
    set(code "void take(void) { const narc_bodies bodies = {.count = 1, ${fields}}; (void)bodies; }")
  else()
    set(command ${CXX_COMPILER} -std=c++17)
    string(REGEX REPLACE " *[.]([a-z]+) = ([^)]*[)]),? *" "bodies.\\1 = \\2; " fields "${fields}")
    set(code "void take() { narc_bodies bodies = {}; ${fields} (void)bodies; }")
  endif()
  file(WRITE "${FOLDER}/column.${language}" "#include <narc.h>
struct { double x; float c; uint32_t shape; int32_t signed_shape; } body[4];
double doubles[4];
${code}
")
  execute_process(COMMAND ${command} -fsyntax-only ${INCLUDES} "${FOLDER}/column.${language}"
    RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE messages)
  if(result EQUAL 0)
    set(${out_result} TRUE PARENT_SCOPE)
  else()
    set(${out_result} FALSE PARENT_SCOPE)
    set(messages "${messages}" PARENT_SCOPE)
  endif()
endfunction()

file(MAKE_DIRECTORY "${FOLDER}")
foreach(language c cpp)
  if(language STREQUAL cpp AND NOT CXX_COMPILER)
    continue()
  endif()
  compiles(fine ${language} "${good}")
  if(NOT fine)
    message(FATAL_ERROR "${language}: columns of the right type do not compile:\n${messages}")
  endif()
  foreach(fields IN LISTS bad)
    compiles(fine ${language} "${fields}")
    if(fine)
      message(FATAL_ERROR "${language}: compiles: ${fields}")
    endif()
  endforeach()
endforeach()
