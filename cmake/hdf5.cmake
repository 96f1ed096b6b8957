# SPDX-License-Identifier: AGPL-3.0-or-later
# Target palpate_hdf5: HDF5 for the target that is linked. The shared library of the system, or, for a target
# with the property PALPATE_PRIVATE_HDF5, a static copy that stays inside it.

# Serial HDF5 only: with a parallel build in first place the C API would need mpi.h.
set(HDF5_PREFER_PARALLEL FALSE)
find_package(HDF5 REQUIRED COMPONENTS C)
if(HDF5_IS_PARALLEL)
  message(FATAL_ERROR "The serial HDF5 is required: install libhdf5-dev")
endif()

# Debian's shared HDF5 needs libcurl and an HTTP stack, for a driver that reads files over a network: 30 libraries
# in every program that embeds libpalpate.so, and a clash where the program has an HDF5 of its own. The static HDF5
# needs none of them, as nothing refers to that driver. Debian compiles it for executables (-fPIE). Such code can be
# linked into a shared library when all symbols that it refers to are bound inside that library, which the version
# script of libpalpate.so ensures. The variables stdout and stderr of the C library are not: in a copy of the archive
# they have other names, which format/hdf5_streams.c defines.
find_library(PALPATE_STATIC_HDF5 NAMES libhdf5.a libhdf5_serial.a PATH_SUFFIXES hdf5/serial)
find_file(PALPATE_HDF5_LICENCE NAMES copyright COPYING PATHS /usr/share/doc/libhdf5-dev NO_DEFAULT_PATH)
find_library(PALPATE_SZIP NAMES sz)
find_library(PALPATE_ZLIB NAMES z)

# palpate_link_private_hdf5(RESULT): whether a shared library can be linked with the copy, which is made here.
function(palpate_link_private_hdf5 result)
  set(${result} FALSE PARENT_SCOPE)
  if(PALPATE_SANITIZE OR NOT (PALPATE_STATIC_HDF5 AND PALPATE_HDF5_LICENCE AND PALPATE_SZIP AND PALPATE_ZLIB AND CMAKE_OBJCOPY))
    return()
  endif()
  set(folder ${PROJECT_BINARY_DIR}/private_hdf5)
  file(MAKE_DIRECTORY ${folder})
  file(WRITE ${folder}/probe.c "int H5open(void);\nint palpate_probe(void) { return H5open(); }\n")
  execute_process(RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET
    COMMAND ${CMAKE_OBJCOPY} --redefine-sym stdout=palpate_hdf5_stdout --redefine-sym stderr=palpate_hdf5_stderr
            ${PALPATE_STATIC_HDF5} ${folder}/libhdf5_private.a)
  if(NOT failed)
    execute_process(RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET
      COMMAND ${CMAKE_C_COMPILER} -shared -fPIC ${folder}/probe.c ${PROJECT_SOURCE_DIR}/format/hdf5_streams.c
              ${folder}/libhdf5_private.a ${PALPATE_SZIP} ${PALPATE_ZLIB} -lm -Wl,--no-undefined
              -Wl,--version-script=${PROJECT_SOURCE_DIR}/runtime/palpate.map -o ${folder}/probe.so)
  endif()
  if(NOT failed)
    set(${result} TRUE PARENT_SCOPE)
  endif()
endfunction()

palpate_link_private_hdf5(PALPATE_HAS_PRIVATE_HDF5)
add_library(palpate_hdf5 INTERFACE)
add_library(palpate_shared_hdf5 INTERFACE)
target_link_libraries(palpate_shared_hdf5 INTERFACE ${HDF5_C_LIBRARIES})
if(PALPATE_HAS_PRIVATE_HDF5)
  add_library(palpate_hdf5_streams STATIC ${PROJECT_SOURCE_DIR}/format/hdf5_streams.c)
  add_library(palpate_private_hdf5 INTERFACE)
  target_link_libraries(palpate_private_hdf5 INTERFACE
    ${PROJECT_BINARY_DIR}/private_hdf5/libhdf5_private.a palpate_hdf5_streams ${PALPATE_SZIP} ${PALPATE_ZLIB} m)
  target_link_libraries(palpate_hdf5 INTERFACE
    $<IF:$<BOOL:$<TARGET_PROPERTY:PALPATE_PRIVATE_HDF5>>,palpate_private_hdf5,palpate_shared_hdf5>)
else()
  message(STATUS "libpalpate.so needs the shared HDF5 and all that it needs: its static library cannot be linked into it")
  target_link_libraries(palpate_hdf5 INTERFACE palpate_shared_hdf5)
endif()
