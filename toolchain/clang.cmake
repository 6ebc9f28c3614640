# SPDX-License-Identifier: Apache-2.0
# The verifying compiler: it follows function effects and has the real-time and thread sanitizers. The version is
# part of the name because an older clang checks neither.
set(CMAKE_C_COMPILER clang-22)
set(CMAKE_CXX_COMPILER clang++-22)
