# SPDX-License-Identifier: Apache-2.0
# The language all our code is written in: same standard, same arithmetic, same limits with both compilers.
include_guard(GLOBAL)

set(CMAKE_CXX_STANDARD 23)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_library(tappet_options INTERFACE)
target_include_directories(tappet_options INTERFACE "${PROJECT_SOURCE_DIR}")
target_compile_features(tappet_options INTERFACE cxx_std_23)
# A running machine says which binary it is.
target_link_options(tappet_options INTERFACE -Wl,--build-id=sha1)

# One seed gives one run, bit for bit, with both compilers: the baseline instruction set, and no a*b+c folded into
# one rounding where one compiler sees the chance and the other does not.
target_compile_options(tappet_options INTERFACE -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
    # With the atomic instructions of version 8.1, and no others: before it an exchange is a loop that others can keep going.
    target_compile_options(tappet_options INTERFACE -march=armv8.1-a+lse -mno-outline-atomics)
else()
    target_compile_options(tappet_options INTERFACE -march=x86-64)
endif()

# A frame larger than a page touches each of its pages in turn, so that none steps over the page that guards a stack.
target_compile_options(tappet_options INTERFACE -fstack-clash-protection)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64 AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(tappet_options INTERFACE "SHELL:--param stack-clash-protection-guard-size=12")
endif()

# A machine is checked in constant expressions; the compilers' own limits are meant for smaller ones.
target_compile_options(
    tappet_options
    INTERFACE
        "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fconstexpr-ops-limit=2000000000;-fconstexpr-loop-limit=10000000;-fconstexpr-depth=2000>"
        "$<$<COMPILE_LANG_AND_ID:CXX,Clang>:-fconstexpr-steps=2000000000;-fconstexpr-depth=2000>")
