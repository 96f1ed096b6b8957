# SPDX-License-Identifier: AGPL-3.0-or-later
# Debian packages, one for each component; scripts/package makes them. `python` where the module is built.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME palpate)
set(CPACK_PACKAGE_CONTACT "palpate maintainers <maintainers@users.noreply.h-seed-f341c0fe.example>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_COMPONENTS_ALL runtime development command)
if(TARGET palpate_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# What each needs of Debian is read from its programs; what of the other packages, from the library of the build.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")

# palpate_package(COMPONENT NAME SECTION SUMMARY DESCRIPTION [OWN PACKAGE...]): OWN, packages of this version.
macro(palpate_package component name section summary description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${description}")
  set(own "")
  foreach(package ${ARGN})
    list(APPEND own "${package} (= ${PROJECT_VERSION})")
  endforeach()
  list(JOIN own ", " CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS)
endmacro()

set(runtime libpalpate${PROJECT_VERSION_MAJOR})
palpate_package(runtime ${runtime} libs "renders response libraries of soft bodies in real time"
"Reads a response library, which tells how a soft body feels at each point
of its surface, and returns contact forces at the rate of a haptic device.
Its energy account shows that the body never returns more energy than it
absorbed.
.
This package has the shared library with its C interface.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_PROVIDES "libpalpate (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/packages/triggers)
palpate_package(development libpalpate-dev libdevel "development files of libpalpate"
"Header of the C interface of libpalpate, and the files by which CMake and
pkg-config find it." ${runtime})
palpate_package(command palpate science "computes how a soft body feels, and lets you touch it"
"A nonlinear finite element solver presses a tool into the surface of a
soft body; the force-deflection curves become compact, passive responses
in one file, the response library. The command makes, certifies,
simulates and shows such libraries, and renders them on haptic devices.
`palpate play liver` opens a ready-made one in a browser." ${runtime})
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "xdg-utils")
palpate_package(python python3-palpate python "response libraries of soft bodies in Python"
"Reads the artifacts of palpate as arrays of numpy, and steps response
libraries.")
# The extension is of this minor version of Python. Without the command it computes no campaign.
if(TARGET palpate_python)
  get_directory_property(minor DIRECTORY ${PROJECT_SOURCE_DIR}/python DEFINITION Python_VERSION_MINOR)
  math(EXPR next "${minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${minor}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS palpate)
endif()

set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/packages/finish.cmake)
set(CPACK_PALPATE_SOURCE ${PROJECT_SOURCE_DIR})
if(PALPATE_HAS_PRIVATE_HDF5)
  set(CPACK_PALPATE_HDF5_LICENCE ${PALPATE_HDF5_LICENCE})
endif()
set(CPACK_PALPATE_PACKAGES "runtime=${runtime};development=libpalpate-dev;command=palpate;python=python3-palpate")
include(CPack)
