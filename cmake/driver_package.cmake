# What drivers of devices are built with, by find_package(palpate): the bus, its messages, a 1 kHz loop. Component dev.
include(CMakePackageConfigHelpers)
set(driver_libraries palpate_bus palpate_describe palpate_idl palpate_messages palpate_realtime)
foreach(library IN LISTS driver_libraries)
  string(REPLACE palpate_ "" name ${library})
  # A driver may be a module of another program, such as Python; without a precompiled header, whose code is not.
  set_target_properties(${library} PROPERTIES
    EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON DISABLE_PRECOMPILE_HEADERS ON)
  target_compile_features(${library} PUBLIC cxx_std_20)
endforeach()
install(TARGETS ${driver_libraries} EXPORT palpate ARCHIVE DESTINATION lib/palpate COMPONENT dev
        INCLUDES DESTINATION include/palpate)
install(EXPORT palpate FILE palpate-targets.cmake NAMESPACE palpate:: DESTINATION lib/cmake/palpate COMPONENT dev)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/palpate-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/palpate-config.cmake ${PROJECT_BINARY_DIR}/palpate-config-version.cmake
        DESTINATION lib/cmake/palpate COMPONENT dev)

install(FILES common/bus/bus.hpp common/bus/dds_bus.hpp common/bus/force_follower.hpp DESTINATION include/palpate/common/bus COMPONENT dev)
install(FILES common/realtime/clock.hpp common/realtime/histogram.hpp common/realtime/periodic.hpp common/realtime/shutdown.hpp
        DESTINATION include/palpate/common/realtime COMPONENT dev)
foreach(header fields messages topics)
  install(FILES ${PROJECT_BINARY_DIR}/idl/${header}.hpp DESTINATION include/palpate/idl COMPONENT dev)
endforeach()
install(FILES idl/topic.hpp DESTINATION include/palpate/idl COMPONENT dev)
install(FILES idl/palpate.idl DESTINATION share/palpate/idl COMPONENT dev)
install(DIRECTORY drivers/c drivers/cpp drivers/python DESTINATION share/palpate/drivers COMPONENT dev)
