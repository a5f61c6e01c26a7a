# find_package(palpate): the target palpate::bus, and palpate_IDL, the file of the messages.
include(CMakeFindDependencyMacro)
find_dependency(CycloneDDS)
find_dependency(Eigen3)
find_dependency(fmt)
find_dependency(Threads)
find_dependency(ZLIB)
include(${CMAKE_CURRENT_LIST_DIR}/palpate-targets.cmake)
get_filename_component(palpate_IDL ${CMAKE_CURRENT_LIST_DIR}/../../../share/palpate/idl/palpate.idl ABSOLUTE)
