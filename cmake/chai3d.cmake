# SPDX-License-Identifier: AGPL-3.0-or-later
# Of CHAI3D only its tool, its force algorithms and what these call: collision trees, mesh, world and material. The whole needs
# the development files of OpenGL, ALSA and libusb and a closed driver library. The language, the macro and the optimization
# are those of its own CMakeLists.txt.
if(TARGET chai3d_force_algorithms)
  return()
endif()
set(sources
  collisions/CCollisionAABB collisions/CCollisionAABBTree collisions/CCollisionBrute collisions/CGenericCollision
  devices/CGenericDevice devices/CGenericHapticDevice
  effects/CGenericEffect
  forces/CAlgorithmFingerProxy forces/CAlgorithmPotentialField forces/CGenericForceAlgorithm
  graphics/CColor graphics/CDisplayList graphics/CFog graphics/CTriangleArray
  materials/CMaterial
  system/CGenericType system/CGlobals system/CString
  timers/CFrequencyCounter timers/CPrecisionClock
  tools/CGenericTool tools/CHapticPoint tools/CToolCursor
  world/CGenericObject world/CMesh world/CShapeSphere world/CWorld)
list(TRANSFORM sources PREPEND ${PALPATE_CHAI3D}/src/)
list(TRANSFORM sources APPEND .cpp)
add_library(chai3d_force_algorithms STATIC ${sources})
set_target_properties(chai3d_force_algorithms PROPERTIES CXX_STANDARD 11 CXX_CLANG_TIDY "")
target_include_directories(chai3d_force_algorithms SYSTEM PUBLIC
  ${PALPATE_CHAI3D}/src ${PALPATE_CHAI3D}/externals/Eigen ${PALPATE_CHAI3D}/externals/glew/include)
target_compile_definitions(chai3d_force_algorithms PUBLIC LINUX)
target_compile_options(chai3d_force_algorithms PRIVATE -w -O3 -march=native -ffunction-sections -fdata-sections)
# What stays unresolved draws: shaders, lights and OpenGL, which the program never calls. A function that is never called may
# be missing from a program at a fixed address.
target_link_options(chai3d_force_algorithms INTERFACE -no-pie -Wl,--gc-sections -Wl,--unresolved-symbols=ignore-in-object-files)
