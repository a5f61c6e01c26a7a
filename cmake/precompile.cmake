# Precompiled headers: parsed once, for all targets with the same flags.

# Every target of this folder and those below it.
function(palpate_targets_below folder result)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(subfolders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS subfolders)
    palpate_targets_below(${subfolder} deeper)
    list(APPEND targets ${deeper})
  endforeach()
  set(${result} ${targets} PARENT_SCOPE)
endfunction()

# Precompiles cmake/precompiled_NAME.hpp with the flags of this folder, into the target precompiled_NAME.
function(palpate_precompiled_header name)
  add_library(precompiled_${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
  target_link_libraries(precompiled_${name} PRIVATE ${ARGN})
  target_precompile_headers(precompiled_${name} PRIVATE <cmake/precompiled_${name}.hpp>)
endfunction()

# Gives it to every target in and below this folder that has C++ sources and no compiler options of its own.
function(palpate_use_precompiled_header name)
  get_directory_property(folder_options COMPILE_OPTIONS)
  palpate_targets_below(${CMAKE_CURRENT_SOURCE_DIR} targets)
  foreach(target IN LISTS targets)
    get_target_property(sources ${target} SOURCES)
    get_target_property(options ${target} COMPILE_OPTIONS)
    if(sources MATCHES "\\.cpp" AND options STREQUAL folder_options AND NOT target MATCHES "^precompiled_")
      target_precompile_headers(${target} REUSE_FROM precompiled_${name})
      # GCC 12 forgets which precompiled lines are a library's, where these are often wrong.
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized -Wno-stringop-overflow -Wno-array-bounds)
    endif()
  endforeach()
endfunction()
