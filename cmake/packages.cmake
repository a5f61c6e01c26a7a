# Debian packages, one a component: `scripts/package.sh` makes them all into build/packages.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR palpate)
set(CPACK_PACKAGE_CONTACT "The palpate project <palpate@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 0)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # what its programs are linked with
set(CPACK_COMPONENTS_ALL haptic deform render web ros mesh tools dev)
foreach(optional organ spacemouse)
  if(TARGET palpate_${optional})
    list(APPEND CPACK_COMPONENTS_ALL ${optional})
  endif()
endforeach()
if(PALPATE_PYTHON)  # its programs are slower than those of a build without it
  set(CPACK_COMPONENTS_ALL python)
endif()

# palpate_package(COMPONENT "what it is" [DEPENDS package...] [RECOMMENDS package...])
function(palpate_package component meaning)
  cmake_parse_arguments(PARSE_ARGV 2 more "" "" "DEPENDS;RECOMMENDS")
  string(TOUPPER ${component} name)
  list(JOIN more_DEPENDS ", " depends)
  list(JOIN more_RECOMMENDS ", " recommends)
  set(CPACK_COMPONENT_${name}_DESCRIPTION "${meaning}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${name}_PACKAGE_NAME palpate-${component} PARENT_SCOPE)
  set(CPACK_DEBIAN_${name}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${name}_PACKAGE_RECOMMENDS "${recommends}" PARENT_SCOPE)
endfunction()
palpate_package(haptic "Haptic node: collision and force at the device's rate, from precomputed tensors")
palpate_package(deform "Deformation node: the organ's shape by superposition, and moving tissue")
palpate_package(render "Render node: draws organs and instruments, off screen"
  DEPENDS fonts-dejavu-core RECOMMENDS ffmpeg palpate-mesh)
palpate_package(web "Web node: shows a running scene in browsers, and moves its tools for their users"
  RECOMMENDS palpate-mesh)
palpate_package(ros "Bridge to ROS 2: a running scene as standard messages, and commands to its tools"
  RECOMMENDS palpate-mesh)
palpate_package(mesh "Reader of mesh files, which the other programs load where they need one")
palpate_package(tools "Command line, example scenes, pages, deployment and manual"
  DEPENDS "palpate-mesh (= ${PROJECT_VERSION})" RECOMMENDS palpate-haptic palpate-deform palpate-render palpate-web ffmpeg python3-matplotlib)
palpate_package(dev "For drivers of devices: messages, headers, library, CMake package and examples"
  DEPENDS cyclonedds-dev libeigen3-dev libfmt-dev libxxhash-dev zlib1g-dev)
palpate_package(spacemouse "Driver that moves a tool by a SpaceMouse" RECOMMENDS spacenavd)
palpate_package(organ "Meshes of surfaces and of labelled images" DEPENDS "palpate-mesh (= ${PROJECT_VERSION})")
if(PALPATE_PYTHON)  # its modules are for the one Python that they are built with
  find_package(Python3 COMPONENTS Interpreter REQUIRED)
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(this_python "python3 (>= 3.${Python3_VERSION_MINOR})" "python3 (<< 3.${next})")
endif()
palpate_package(python "Python module: lock step with one's own controller, static states, logs as arrays"
  DEPENDS ${this_python} python3-numpy "palpate-mesh (= ${PROJECT_VERSION})" RECOMMENDS python3-matplotlib)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-palpate)
include(CPack)
