# SPDX-License-Identifier: MIT
# Does every file and folder exist that a document names in backticks, as seen from the project or from kernels/? Run as
#   cmake -D DOCUMENT=... -D SOURCE=<the project's folder> -P document_paths.cmake
file(READ "${DOCUMENT}" text)
string(REGEX MATCHALL "`[A-Za-z_0-9/]+(/|\\.(c|h|inl|def|md))`" names "${text}")
list(LENGTH names count)
if(count LESS 20)
  message(FATAL_ERROR "${DOCUMENT} names only ${count} files")
endif()
foreach(name IN LISTS names)
  string(REPLACE "`" "" path "${name}")
  file(GLOB found "${SOURCE}/*/${path}" "${SOURCE}/kernels/*/${path}") # of a name alone it is enough to be somewhere
  if(NOT found AND NOT EXISTS "${SOURCE}/${path}" AND NOT EXISTS "${SOURCE}/kernels/${path}")
    message(SEND_ERROR "${DOCUMENT} names ${path}, which does not exist")
  endif()
endforeach()
