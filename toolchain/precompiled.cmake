# SPDX-License-Identifier: Apache-2.0
# tappet_precompiled(<name> HEADERS ... LIBRARIES ... [OPTIONS ...]): foreign headers that many sources begin with, read once for
# all of them. A target takes them by target_precompile_headers(<target> REUSE_FROM tappet_header_<name>).
# Not our own headers: g++ tells a file that #pragma once has seen by its age, which another clone's cache does not have.
include_guard(GLOBAL)

# clang's file names the clone that it was made in. ccache knows it by the text beside it instead, which every clone has alike,
# and takes the path of the header relative to the clone where it stands as clang finds the file itself.
if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    set(CMAKE_CXX_COMPILE_OPTIONS_USE_PCH -include <PCH_HEADER>)
endif()

function(tappet_precompiled name)
    cmake_parse_arguments(PARSE_ARGV 1 header "" "" "HEADERS;LIBRARIES;OPTIONS")
    set(stand_in "${CMAKE_CURRENT_BINARY_DIR}/header_${name}.cpp") # a target must own a precompiled header
    file(CONFIGURE OUTPUT "${stand_in}" CONTENT "")
    add_library(tappet_header_${name} OBJECT EXCLUDE_FROM_ALL "${stand_in}")
    target_link_libraries(tappet_header_${name} PRIVATE ${header_LIBRARIES} tappet_options tappet_warnings)
    target_compile_options(tappet_header_${name} PRIVATE ${header_OPTIONS})
    target_precompile_headers(tappet_header_${name} PRIVATE ${header_HEADERS})
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
        set(header "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/tappet_header_${name}.dir/cmake_pch.hxx")
        add_custom_command(
            OUTPUT "${header}.pch.sum"
            COMMAND "${CMAKE_CXX_COMPILER}" ${CMAKE_CXX23_STANDARD_COMPILE_OPTION} -E -P -w -MD -MF "${header}.pch.sum.d" -o "${header}.pch.sum" -x c++ "${header}"
            DEPFILE "${header}.pch.sum.d"
            COMMENT "The text of precompiled header ${name}"
            VERBATIM)
        target_sources(tappet_header_${name} PRIVATE "${header}.pch.sum")
    endif()
endfunction()
