# SPDX-License-Identifier: MIT
# Is no word a part of an identifier that the last table of docs/architecture.md has others for? Comments and strings may
# have it. Run as
#   cmake -D SOURCE=<the project's folder> -P document_words.cmake
cmake_minimum_required(VERSION 3.22)
set(folders include soa kernels dispatch methods files tools tests/support tests/api)

file(READ "${SOURCE}/docs/architecture.md" text)
string(REGEX REPLACE ".*\n\\| Not \\| But \\|\n" "" text "${text}")
string(REGEX MATCHALL "\n\\| `[a-z]+`" words "\n${text}")
list(TRANSFORM words REPLACE "[^a-z]" "")
list(LENGTH words count)
if(count LESS 5)
  message(FATAL_ERROR "docs/architecture.md has no table of words")
endif()
list(JOIN words "|" words)

foreach(folder IN LISTS folders)
  file(GLOB_RECURSE paths RELATIVE "${SOURCE}" "${SOURCE}/${folder}/*")
  list(FILTER paths INCLUDE REGEX "\\.(c|h|hpp|cpp|inl|def)$")
  foreach(path IN LISTS paths)
    file(READ "${SOURCE}/${path}" text)
    string(REGEX REPLACE "/\\*([^*]|\\*+[^*/])*\\*+/|//[^\n]*|\"(\\\\.|[^\"\n])*\"" "" text "${text}")
    string(REGEX REPLACE "[][;]" " " text "${text}")
    string(TOLOWER "${text}" text)
    string(REGEX MATCHALL "[a-z0-9_]*[^a-z](${words})s?[^a-z]" found "${text}")
    list(TRANSFORM found REPLACE ".*[^a-z](${words})s?[^a-z]$" "\\1")
    list(REMOVE_DUPLICATES found)
    foreach(word IN LISTS found)
      message(SEND_ERROR "${path}: ${word} (docs/architecture.md, Words, has a better one)")
    endforeach()
  endforeach()
endforeach()
