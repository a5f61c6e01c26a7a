# Writes to LIST a test for every suite of PROGRAM, with PROPERTIES; those in ON_TIME, ALONE or WAITS, or ALL, as such. CACHE: the user's, for them.
# JUDGES_TIME: what runs those of the three kinds, if anything.
cmake_minimum_required(VERSION 3.22)
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
get_filename_component(name ${PROGRAM} NAME)
string(REPLACE "\n" ";" lines "${listing}")
# Tests run side by side: threads of OpenBLAS and OpenMP that wait for one another would take the time of the others.
set(environment OPENBLAS_NUM_THREADS=1 OMP_WAIT_POLICY=passive)
# What programs keep for the user is kept for all tests together, in the build folder.
list(APPEND environment XDG_CACHE_HOME=${CACHE})
# Debian 12's OpenBLAS takes processors that are newer than it for ones of 2004 (docs/offline.md).
file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
if(flags MATCHES " avx512f " AND flags MATCHES " avx512dq " AND flags MATCHES " avx512bw " AND flags MATCHES " avx512vl ")
  list(APPEND environment OPENBLAS_CORETYPE=SkylakeX)
elseif(flags MATCHES " avx2 " AND flags MATCHES " fma ")
  list(APPEND environment OPENBLAS_CORETYPE=Haswell)
endif()
# ctest's processors are slots here, two for each core and one more (scripts/test.sh): what takes a core takes two.
set(on_time RESOURCE_LOCK on_time PROCESSORS 2 COST 100)
set(computes PROCESSORS 2)
set(waits PROCESSORS 1 COST -1)  # after all that computes: begins where two slots are not free
set(tests "")
foreach(line IN LISTS lines)
  if(line MATCHES "^([^ ]+)\\.( |$)")  # cases are indented
    set(suite ${CMAKE_MATCH_1})
    set(properties ${PROPERTIES})
    set(launcher ${JUDGES_TIME})
    if("${suite}" IN_LIST ALONE OR ALONE STREQUAL "ALL")
      list(APPEND properties RUN_SERIAL TRUE)
    elseif("${suite}" IN_LIST ON_TIME OR ON_TIME STREQUAL "ALL")
      list(APPEND properties ${on_time})
    else()
      if("${suite}" IN_LIST WAITS OR WAITS STREQUAL "ALL")
        list(APPEND properties ${waits})
      else()
        list(APPEND properties ${computes})
        set(launcher "")
      endif()
      set(launcher "nice -n 10 ${launcher}")  # what judges no time yields to what does
    endif()
    string(APPEND tests "add_test([=[${name}.${suite}]=] ${launcher} [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n")
    list(JOIN properties " " properties)
    string(APPEND tests "set_tests_properties([=[${name}.${suite}]=] PROPERTIES ENVIRONMENT [=[${environment}]=] ${properties})\n")
  endif()
endforeach()
file(WRITE ${LIST} "${tests}")
