# SPDX-License-Identifier: AGPL-3.0-or-later
# Toolchain file: the runtime for Windows on x86-64, by mingw-w64 (Debian package g++-mingw-w64-x86-64-posix).
#   cmake -S . -B build/windows --toolchain cmake/mingw-w64.cmake -DPALPATE_HDF5=OFF -DCMAKE_BUILD_TYPE=Release
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# The queue of the runtime is a header that fits every system, in the folder of this one.
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH)
# One file to carry: nothing of the compiler beside it.
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-static")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
