# SPDX-License-Identifier: Apache-2.0
# The portable compiler: what builds here needs nothing newer than what Debian 12 ships.
set(CMAKE_C_COMPILER gcc)
set(CMAKE_CXX_COMPILER g++)
