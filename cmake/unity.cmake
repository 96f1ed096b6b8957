# SPDX-License-Identifier: AGPL-3.0-or-later
# Every target compiles its sources eight at a time, as one: they share headers and template instances that cost
# more than their own lines. Runtime and mesher name their groups themselves. Whoever works on a file prefers
# -DPALPATE_UNITY=OFF. Under -march=native, what is inlined where decides the last bits of a force: they may
# differ between the two.
set(CMAKE_UNITY_BUILD ${PALPATE_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)

# palpate_alone(file...): compiles these files apart, which have a local name that another file of the target has, too.
function(palpate_alone)
  if(ARGN)
    set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()
