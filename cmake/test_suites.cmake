# palpate_test_suites(TARGET [ON_TIME ALL | SUITE...] [ALONE ALL | SUITE...] [WAITS ALL | SUITE...]
# [PROPERTIES NAME VALUE ...]): one test of ctest for every GoogleTest suite of a program, so that the cases of a suite
# share a process and what it has set up. Suites are listed after each build of the program. Those ON_TIME judge when
# something comes: of these one runs at a time, and the others, which run beside it, yield to it. Those ALONE measure
# lateness, and nothing runs beside them. Those that WAIT take less than half of a core; the rest computes.
function(palpate_test_suites target)
  cmake_parse_arguments(PARSE_ARGV 1 suites "" "" "ON_TIME;ALONE;WAITS;PROPERTIES")
  if(suites_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "palpate_test_suites(${target}): ${suites_UNPARSED_ARGUMENTS}")
  endif()
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
  set(include_list ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake)
  # What a sanitizer finds counts the first time.
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
    set(judged "")
  else()
    set(judged $<TARGET_FILE:unless_held_up>)
    add_dependencies(${target} unless_held_up)
  endif()
  add_custom_command(TARGET ${target} POST_BUILD VERBATIM
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:${target}> -D LIST=${list} -D "PROPERTIES=${suites_PROPERTIES}"
            -D CACHE=${PROJECT_BINARY_DIR}/cache -D JUDGES_TIME=${judged}
            -D "ON_TIME=${suites_ON_TIME}" -D "ALONE=${suites_ALONE}" -D "WAITS=${suites_WAITS}"
            -P ${PROJECT_SOURCE_DIR}/cmake/list_suites.cmake
    BYPRODUCTS ${list})
  # ctest reads it at its start; without the program the test fails by name.
  file(WRITE ${include_list} "if(EXISTS \"${list}\")\n  include(\"${list}\")\nelse()\n  add_test(${target} ${target}_not_built)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${include_list})
endfunction()
