# SPDX-License-Identifier: MIT
# Columns and rows of the wrong type do not compile: columns whatever a compiler makes of pointers of another type, rows
# in C where its warnings are errors.
set(good "bodies.cosine = NARC_COLUMN(body, c)" "bodies.shape = NARC_COLUMN(body, shape)"
  "bodies.x = NARC_POSITION_COLUMN(body, x)" "bodies.y = NARC_POSITION_COLUMN(body, c)"
  "query.selection = NARC_ARRAY(words)" "query.selection = NARC_COLUMN(body, constant)" "query.selection = NARC_ARRAY(constants)")
set(bad "bodies.cosine = NARC_COLUMN(body, x)" "bodies.cosine = NARC_COLUMN(body, shape)"
  "bodies.shape = NARC_COLUMN(body, c)" "bodies.shape = NARC_COLUMN(body, signed_shape)"
  "bodies.x = NARC_POSITION_COLUMN(body, shape)" "bodies.x = NARC_COLUMN(body, c)" "bodies.scale = NARC_ARRAY(doubles)"
  "query.selection = NARC_ARRAY(doubles)")
# Objects of static storage duration.
foreach(type "narc_float_column COLUMN body,c" "narc_index_column ARRAY words" "narc_position_column POSITION_COLUMN body,x"
    "narc_position_column POSITION_ARRAY doubles")
  string(REGEX REPLACE "(.*) (.*) (.*)" "static const \\1 column = NARC_\\2_INIT(\\3)" statement "${type}")
  list(APPEND good "${statement}")
endforeach()
# Rows.
foreach(call contacts manifolds)
  foreach(rows contacts manifolds doubles)
    set(statement "narc_find_${call}(shapes, &bodies, &pairs, &query, ${rows}, 4, &found, NULL)")
    if(rows STREQUAL call)
      list(APPEND good "${statement}")
    else()
      list(APPEND bad_rows "${statement}")
    endif()
  endforeach()
endforeach()
list(APPEND bad_rows "narc_find_overlaps(shapes, &bodies, &pairs, &query, words, NULL)")
# The same by narc.hpp.
set(good_cpp "bodies.cosine = narc::column(body, &Body::c)" "bodies.x = narc::positions(body, &Body::x)"
  "query.selection = narc::column(words)" "(void)narc::find_contacts(shapes, bodies, pairs, query, contacts)"
  "(void)narc::find_manifolds(shapes, bodies, pairs, query, manifolds)"
  "bodies = narc::bodies_of(body, &Body::x, &Body::x, &Body::c, &Body::c, &Body::shape)"
  "query = narc::query().workers(workers)")
set(bad_cpp "bodies.cosine = narc::column(body, &Body::x)" "bodies.x = narc::column(body, &Body::c)"
  "bodies.x = narc::positions(body, &Body::shape)" "query.selection = narc::column(body, &Body::signed_shape)"
  "(void)narc::find_contacts(shapes, bodies, pairs, query, manifolds)"
  "(void)narc::find_manifolds(shapes, bodies, pairs, query, doubles)"
  "(void)narc::find_manifolds(shapes, bodies, pairs, query, contacts)"
  "(void)narc::find_overlaps(shapes, bodies, pairs, query, words)"
  "bodies = narc::bodies_of(body, &Body::x, &Body::x, &Body::x, &Body::c, &Body::shape)"
  "query = narc::query().workers(narc_workers{})" "narc::shapes copy = *static_cast<const narc::shapes *>(nullptr)")

function(compiles out_result language statement)
  set(command ${C_COMPILER} -std=c17)
  if(language STREQUAL cpp)
    set(command ${CXX_COMPILER} -std=c++17)
  endif()
  set(header narc.h)
  if(statement MATCHES "narc::")
    set(header narc.hpp)
  endif()
  file(WRITE "${FOLDER}/column.${language}" "#include <${header}>
struct Body { double x; float c; uint32_t shape; int32_t signed_shape; const uint32_t constant; };
extern struct Body body[4];
extern double doubles[4];
extern uint32_t words[4];
extern const uint32_t constants[4];
extern narc_contact contacts[4];
extern narc_manifold manifolds[4];
void take(const narc_shapes *shapes, narc_bodies bodies, narc_pairs pairs, narc_query query, narc_workers workers);
void take(const narc_shapes *shapes, narc_bodies bodies, narc_pairs pairs, narc_query query, narc_workers workers) {
    size_t found;
    ${statement};
    (void)shapes, (void)bodies, (void)pairs, (void)query, (void)workers, (void)found;
}
")
  execute_process(COMMAND ${command} ${ARGN} -fsyntax-only ${INCLUDES} "${FOLDER}/column.${language}"
    RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE messages)
  if(result EQUAL 0)
    set(${out_result} TRUE PARENT_SCOPE)
  else()
    set(${out_result} FALSE PARENT_SCOPE)
    set(messages "${messages}" PARENT_SCOPE)
  endif()
endfunction()

# All in one program.
function(expect_compiles language)
  list(JOIN ARGN ";}\n    {" statements)
  compiles(fine ${language} "{${statements};}" -Wall -Wextra -Wno-unused-variable -Wno-unused-but-set-variable -Werror)
  if(NOT fine)
    message(FATAL_ERROR "${language}: does not compile:\n${messages}")
  endif()
endfunction()

# expect_refused(LANGUAGE "FLAGS" STATEMENT ...)
function(expect_refused language flags)
  foreach(statement IN LISTS ARGN)
    compiles(fine ${language} "${statement}" ${flags})
    if(fine)
      message(FATAL_ERROR "${language}: compiles: ${statement}")
    endif()
  endforeach()
endfunction()

file(MAKE_DIRECTORY "${FOLDER}")
expect_compiles(c ${good})
expect_refused(c "" ${bad})
expect_refused(c "-Werror" ${bad_rows})
if(CXX_COMPILER)
  expect_compiles(cpp ${good} ${good_cpp})
  expect_refused(cpp "" ${bad} ${bad_rows} ${bad_cpp})
endif()
