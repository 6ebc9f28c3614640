# SPDX-License-Identifier: Apache-2.0
# The second architecture, by the verifying compiler: what runs in the machine's box, linked statically against Debian's own
# libraries for it, which `ci/setup aarch64` has unpacked and not installed.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
include("${CMAKE_CURRENT_LIST_DIR}/clang.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/cache.cmake")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TAPPET_CACHE)
set(CMAKE_C_COMPILER_TARGET aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER_TARGET aarch64-linux-gnu)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)

set(CMAKE_SYSROOT "${TAPPET_CACHE}/aarch64")
if(NOT EXISTS "${CMAKE_SYSROOT}/key")
    message(FATAL_ERROR "${CMAKE_SYSROOT} does not hold Debian's libraries for aarch64; run `ci/setup aarch64` once as root")
endif()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH) # headers alone are the same for every processor
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)

# The same linker and tools as the other architecture's: a firmware's linker script is written for them.
foreach(tool IN ITEMS AR RANLIB STRIP OBJCOPY OBJDUMP)
    string(TOLOWER "${tool}" name)
    set(CMAKE_${tool} "/usr/bin/aarch64-linux-gnu-${name}")
endforeach()
set(CMAKE_LINKER /usr/bin/aarch64-linux-gnu-ld)

# Programs built here run here in user mode: one instruction set, emulated, on the host's own kernel.
set(CMAKE_CROSSCOMPILING_EMULATOR /usr/bin/qemu-aarch64-static)
