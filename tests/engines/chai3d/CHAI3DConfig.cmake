# SPDX-License-Identifier: AGPL-3.0-or-later
# In place of the package of a whole CHAI3D: the part that cmake/chai3d.cmake compiles, in the archive CHAI3D_PART.
# CHAI3D: the checkout.
find_package(OpenGL REQUIRED)
set(CHAI3D_INCLUDE_DIRS ${CHAI3D}/src ${CHAI3D}/externals/Eigen ${CHAI3D}/externals/glew/include)
set(CHAI3D_LIBRARIES ${CHAI3D_PART} OpenGL::GLU OpenGL::GL pthread -no-pie -Wl,--gc-sections
  -Wl,--unresolved-symbols=ignore-in-object-files)
