# SPDX-License-Identifier: AGPL-3.0-or-later
# palpate_unity(TARGET [ALONE file...]): compiles the sources of the target, eight at a time, as one. They
# share headers and template instances that cost more than their own lines. ALONE: files with a local name
# that another file of the target has, too. Solver and fit stay as they are: under -march=native, what is
# inlined where decides the last bits of a force. The presets with sanitizers, whose bits nothing depends on,
# compile every target in this way.
function(palpate_unity target)
  cmake_parse_arguments(arg "" "" "ALONE" ${ARGN})
  if(NOT PALPATE_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  set_source_files_properties(${arg_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# palpate_alone(file...): the same for files of targets that only these presets compile as one.
function(palpate_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
