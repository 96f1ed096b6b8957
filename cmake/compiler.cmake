# SPDX-License-Identifier: AGPL-3.0-or-later
# One interface target carries the warning level and the sanitizers to every target of the project.
add_library(palpate_options INTERFACE)
target_include_directories(palpate_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(palpate_options INTERFACE -Wall -Wextra -Wconversion -Wshadow
  $<$<BOOL:${PALPATE_WARNINGS_AS_ERRORS}>:-Werror>)
# GCC 12 sees overlapping copies in "text" + std::string that are not there (GCC bug 105651).
target_compile_options(palpate_options INTERFACE
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
if(PALPATE_SANITIZE)
  target_compile_options(palpate_options INTERFACE -fsanitize=${PALPATE_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(palpate_options INTERFACE -fsanitize=${PALPATE_SANITIZE})
endif()
