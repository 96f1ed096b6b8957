# SPDX-License-Identifier: AGPL-3.0-or-later
# One interface target carries the warning level and the sanitizers to every target of the project.
add_library(palpate_options INTERFACE)
target_include_directories(palpate_options INTERFACE ${PROJECT_SOURCE_DIR})
set(unity $<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>)
set(gnu $<CXX_COMPILER_ID:GNU>)
target_compile_options(palpate_options INTERFACE -Wall -Wextra -Wconversion
  $<$<BOOL:${PALPATE_WARNINGS_AS_ERRORS}>:-Werror>)
# Where several files are compiled as one, a local name of one says nothing about the same name in another,
# and every file is an included one.
target_compile_options(palpate_options INTERFACE
  $<$<NOT:${unity}>:-Wshadow>
  "$<$<AND:${unity},${gnu}>:-Wshadow=local;-Wno-subobject-linkage>")
# GCC 12 sees overlapping copies in "text" + std::string that are not there (GCC bug 105651).
target_compile_options(palpate_options INTERFACE
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-unknown-warning-option>)  # for clang-tidy on the commands of GCC
if(PALPATE_SANITIZE)
  target_compile_options(palpate_options INTERFACE -fsanitize=${PALPATE_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(palpate_options INTERFACE -fsanitize=${PALPATE_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(palpate_options INTERFACE
      -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/undefined_behaviour_ignorelist.txt)
  endif()
endif()

# The optimization of lines that are many and cost more to compile than to run.
set(PALPATE_QUICK_TO_COMPILE $<$<CONFIG:Release>:-O1>)
if(PALPATE_SANITIZE)
  set(PALPATE_QUICK_TO_COMPILE -O0)
endif()

# palpate_fuzzed(TARGET): counted by libFuzzer where that is to be had.
function(palpate_fuzzed target)
  if(PALPATE_SANITIZE MATCHES "address" AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

if(NOT PALPATE_HDF5)
  return()
endif()

# Eigen chooses alignment, and with it how memory is freed, by the instruction set. Sixteen bytes are what
# libraries built for any processor (Ceres) take; every target that sees Eigen links this one. The runtime
# and the format never do.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
add_library(palpate_eigen INTERFACE)
target_link_libraries(palpate_eigen INTERFACE Eigen3::Eigen)
target_compile_definitions(palpate_eigen INTERFACE EIGEN_MAX_ALIGN_BYTES=16)
if(PALPATE_NATIVE AND NOT PALPATE_SANITIZE)
  target_compile_options(palpate_eigen INTERFACE -march=native)
endif()
# GCC 12 warns of an uninitialised value inside its own AVX-512 intrinsics, and of packets larger than a small matrix,
# which Eigen does not use there.
target_compile_options(palpate_eigen INTERFACE
  "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-uninitialized;-Wno-array-bounds>")
