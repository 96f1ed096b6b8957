# SPDX-License-Identifier: AGPL-3.0-or-later
# Provenance needs the git revision of the build. It is refreshed by each build, not by each
# configure, so that an artifact never names the wrong commit.
add_custom_target(palpate_version
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR}
          -DOUTPUT=${PROJECT_BINARY_DIR}/generated/palpate_version.hpp -DVERSION=${PROJECT_VERSION}
          -P ${PROJECT_SOURCE_DIR}/cmake/write_version.cmake
  BYPRODUCTS ${PROJECT_BINARY_DIR}/generated/palpate_version.hpp
  VERBATIM)
