# SPDX-License-Identifier: Apache-2.0
# One sanitizer for a whole build tree, foreign code included: half a program under the thread sanitizer reports
# races that are none.
include_guard(GLOBAL)

set(TAPPET_SANITIZE none CACHE STRING "Sanitizer of this build tree: none, thread, realtime, address or fuzz")
set_property(CACHE TAPPET_SANITIZE PROPERTY STRINGS none thread realtime address fuzz)

if(TAPPET_SANITIZE STREQUAL none)
    set(tappet_sanitizer_flags)
elseif(TAPPET_SANITIZE STREQUAL thread)
    set(tappet_sanitizer_flags -fsanitize=thread)
elseif(TAPPET_SANITIZE STREQUAL realtime)
    set(tappet_sanitizer_flags -fsanitize=realtime)
elseif(TAPPET_SANITIZE STREQUAL address)
    set(tappet_sanitizer_flags -fsanitize=address,undefined -fno-sanitize-recover=all)
elseif(TAPPET_SANITIZE STREQUAL fuzz)
    set(tappet_sanitizer_flags -fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=all)
else()
    message(FATAL_ERROR "TAPPET_SANITIZE is '${TAPPET_SANITIZE}'; choose none, thread, realtime, address or fuzz")
endif()

if(TAPPET_SANITIZE MATCHES "realtime|fuzz" AND NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    message(FATAL_ERROR "the real-time sanitizer and libFuzzer are clang's; configure with toolchain/clang.cmake")
endif()

if(tappet_sanitizer_flags)
    add_compile_options(${tappet_sanitizer_flags} -fno-omit-frame-pointer -DTAPPET_ASSERTS_THREADS)
    if(NOT TAPPET_SANITIZE STREQUAL realtime) # whose tree is the second compiler's, too
        add_compile_options(-O1)
    endif()
    add_link_options(${tappet_sanitizer_flags})
endif()

# For what works while a machine starts, or tells about itself: there size counts more than speed, on a box. A sanitizer's tree
# has one level, so that all its sources can begin with the same header, read once.
set(TAPPET_FOR_SIZE -Os)
if(tappet_sanitizer_flags)
    set(TAPPET_FOR_SIZE)
endif()
