# SPDX-License-Identifier: Apache-2.0
# Warnings are errors, in our own code only: foreign headers come in as system headers.
include_guard(GLOBAL)

add_library(tappet_warnings INTERFACE)
target_compile_options(
    tappet_warnings
    INTERFACE
        -Wall
        -Wextra
        -Wpedantic
        -Wshadow
        -Wconversion
        -Wsign-conversion
        -Wcast-align
        -Werror
        "$<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor;-Wold-style-cast;-Woverloaded-virtual>"
        # A function that a real-time function calls must be declared real-time safe itself. The extension is wanted: a check of
        # the machine table computes its sentence and hands it to static_assert, which clang accepts in any mode.
        "$<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wfunction-effects;-Werror=function-effects;-Wno-c++26-extensions>")
