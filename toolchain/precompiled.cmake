# SPDX-License-Identifier: Apache-2.0
# tappet_precompiled(<name> HEADERS ... LIBRARIES ... [OPTIONS ...]): foreign headers that many sources begin with, read once for
# all of them. A target takes them by target_precompile_headers(<target> REUSE_FROM tappet_header_<name>).
# Not our own headers: g++ tells a file that #pragma once has seen by its age, which another clone's cache does not have.
include_guard(GLOBAL)

function(tappet_precompiled name)
    cmake_parse_arguments(PARSE_ARGV 1 header "" "" "HEADERS;LIBRARIES;OPTIONS")
    set(stand_in "${CMAKE_CURRENT_BINARY_DIR}/header_${name}.cpp") # a target must own a precompiled header
    file(CONFIGURE OUTPUT "${stand_in}" CONTENT "")
    add_library(tappet_header_${name} OBJECT EXCLUDE_FROM_ALL "${stand_in}")
    target_link_libraries(tappet_header_${name} PRIVATE ${header_LIBRARIES} tappet_options tappet_warnings)
    target_compile_options(tappet_header_${name} PRIVATE ${header_OPTIONS})
    target_precompile_headers(tappet_header_${name} PRIVATE ${header_HEADERS})
endfunction()
