# SPDX-License-Identifier: MIT
# Does DOCUMENT print the lines between the marks "MARK: begin" and "MARK: end" of SOURCE, as they are? They must
# be a whole block of C in it.
function(read_between text begin end out)
  string(FIND "${text}" "${begin}" from)
  string(FIND "${text}" "${end}" to)
  if(from LESS 0 OR to LESS from)
    message(FATAL_ERROR "${SOURCE}: no lines between '${begin}' and '${end}'")
  endif()
  string(LENGTH "${begin}" length)
  math(EXPR from "${from} + ${length}")
  math(EXPR length "${to} - ${from}")
  string(SUBSTRING "${text}" ${from} ${length} lines)
  set(${out} "${lines}" PARENT_SCOPE)
endfunction()

file(READ "${SOURCE}" source)
file(READ "${DOCUMENT}" document)
read_between("${source}" "/* ${MARK}: begin */\n" "/* ${MARK}: end */" code)
string(FIND "${document}" "```c\n${code}```\n" place)
if(place LESS 0)
  message(FATAL_ERROR "${DOCUMENT} does not print the marked lines of ${SOURCE} as they are")
endif()
