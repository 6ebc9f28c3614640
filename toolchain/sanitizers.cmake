# SPDX-License-Identifier: Apache-2.0
# One sanitizer for a whole build tree, foreign code included: half a program under the thread sanitizer reports
# races that are none.
include_guard(GLOBAL)

set(TAPPET_SANITIZE none CACHE STRING "Sanitizer of this build tree: none, thread, realtime or address")
set_property(CACHE TAPPET_SANITIZE PROPERTY STRINGS none thread realtime address)

if(TAPPET_SANITIZE STREQUAL none)
    set(tappet_sanitizer_flags)
elseif(TAPPET_SANITIZE STREQUAL thread)
    set(tappet_sanitizer_flags -fsanitize=thread)
elseif(TAPPET_SANITIZE STREQUAL realtime)
    set(tappet_sanitizer_flags -fsanitize=realtime)
elseif(TAPPET_SANITIZE STREQUAL address)
    set(tappet_sanitizer_flags -fsanitize=address,undefined -fno-sanitize-recover=all)
else()
    message(FATAL_ERROR "TAPPET_SANITIZE is '${TAPPET_SANITIZE}'; choose none, thread, realtime or address")
endif()

if(TAPPET_SANITIZE STREQUAL realtime AND NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    message(FATAL_ERROR "the real-time sanitizer is clang's; configure with toolchain/clang.cmake")
endif()

if(tappet_sanitizer_flags)
    add_compile_options(${tappet_sanitizer_flags} -fno-omit-frame-pointer)
    add_link_options(${tappet_sanitizer_flags})
endif()
