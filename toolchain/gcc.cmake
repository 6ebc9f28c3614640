# SPDX-License-Identifier: Apache-2.0
# The portable compiler: what builds here needs nothing newer than what Debian 12 ships.
set(CMAKE_C_COMPILER gcc)
set(CMAKE_CXX_COMPILER g++)
# Its memory is collected seldom: a tenth of its time for a table goes into that, and 2 GB are enough for two of them.
set(CMAKE_CXX_FLAGS_INIT "--param ggc-min-expand=200 --param ggc-min-heapsize=1000000")
