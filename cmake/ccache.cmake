# SPDX-License-Identifier: AGPL-3.0-or-later
# Compile through ccache where it is installed, unless the caller names a launcher.
option(PALPATE_CCACHE "Compile through ccache where it is installed" ON)
find_program(PALPATE_CCACHE_PROGRAM ccache)
mark_as_advanced(PALPATE_CCACHE_PROGRAM)
if(NOT PALPATE_CCACHE OR NOT PALPATE_CCACHE_PROGRAM OR CMAKE_CXX_COMPILER_LAUNCHER)
  return()
endif()

# With a base folder, two checkouts use the same results. The sloppiness and the compiler options are those that the
# manual of ccache asks for with precompiled headers.
set(launcher ${CMAKE_COMMAND} -E env
  CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
  CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
  ${PALPATE_CCACHE_PROGRAM})
set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
else()
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
endif()
