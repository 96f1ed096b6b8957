# SPDX-License-Identifier: AGPL-3.0-or-later
# Of CHAI3D only its finger-proxy algorithm and what that calls: collision trees, mesh, world and material. The whole needs
# the development files of OpenGL, ALSA and libusb and a closed driver library. The language, the macro and the optimization
# are those of its own CMakeLists.txt.
set(sources
  collisions/CCollisionAABB collisions/CCollisionAABBTree collisions/CCollisionBrute collisions/CGenericCollision
  effects/CGenericEffect
  forces/CAlgorithmFingerProxy forces/CGenericForceAlgorithm
  graphics/CColor graphics/CDisplayList graphics/CFog graphics/CTriangleArray
  materials/CMaterial
  system/CGenericType system/CString
  world/CGenericObject world/CMesh world/CWorld)
list(TRANSFORM sources PREPEND ${PALPATE_CHAI3D}/src/)
list(TRANSFORM sources APPEND .cpp)
add_library(chai3d_finger_proxy STATIC ${sources})
set_target_properties(chai3d_finger_proxy PROPERTIES CXX_STANDARD 11 CXX_CLANG_TIDY "")
target_include_directories(chai3d_finger_proxy SYSTEM PUBLIC
  ${PALPATE_CHAI3D}/src ${PALPATE_CHAI3D}/externals/Eigen ${PALPATE_CHAI3D}/externals/glew/include)
target_compile_definitions(chai3d_finger_proxy PUBLIC LINUX)
target_compile_options(chai3d_finger_proxy PRIVATE -w -O3 -march=native -ffunction-sections -fdata-sections)
# What stays unresolved draws: shaders, lights and OpenGL, which the program never calls. A function that is never called may
# be missing from a program at a fixed address.
target_link_options(chai3d_finger_proxy INTERFACE -no-pie -Wl,--gc-sections -Wl,--unresolved-symbols=ignore-in-object-files)
