# SPDX-License-Identifier: Apache-2.0
# tappet_precompiled(<name> [HEADERS ...] [OURS ...] LIBRARIES ... [OPTIONS ...]): headers that many sources begin with, read once
# for all of them. A target takes them by target_precompile_headers(<target> REUSE_FROM tappet_header_<name>).
# OURS, from the root of the tree, are clang's alone, whose tests spend half of their time on them. g++ tells a file that #pragma once
# has seen by its age, which another clone's cache does not have; and it finds the source that does not include what it uses.
include_guard(GLOBAL)

# clang's file names the clone that it was made in. ccache knows it by the text beside it instead, which every clone has alike,
# and takes the path of the header relative to the clone where it stands as clang finds the file itself.
if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    set(CMAKE_CXX_COMPILE_OPTIONS_USE_PCH -include <PCH_HEADER>)
endif()

function(tappet_precompiled name)
    cmake_parse_arguments(PARSE_ARGV 1 header "" "" "HEADERS;OURS;LIBRARIES;OPTIONS")
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
        list(TRANSFORM header_OURS REPLACE "(.+)" "<\\1>")
    else()
        set(header_OURS)
    endif()
    set(stand_in "${CMAKE_CURRENT_BINARY_DIR}/header_${name}.cpp") # a target must own a precompiled header
    file(CONFIGURE OUTPUT "${stand_in}" CONTENT "")
    add_library(tappet_header_${name} OBJECT EXCLUDE_FROM_ALL "${stand_in}")
    target_link_libraries(tappet_header_${name} PRIVATE ${header_LIBRARIES} tappet_options tappet_warnings)
    target_compile_options(tappet_header_${name} PRIVATE ${header_OPTIONS})
    target_precompile_headers(tappet_header_${name} PRIVATE ${header_HEADERS} ${header_OURS})
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
        set(header "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/tappet_header_${name}.dir/cmake_pch.hxx")
        add_custom_command(
            OUTPUT "${header}.pch.sum"
            COMMAND "${CMAKE_CXX_COMPILER}" ${CMAKE_CXX23_STANDARD_COMPILE_OPTION} "-I$<JOIN:$<TARGET_PROPERTY:tappet_header_${name},INCLUDE_DIRECTORIES>,;-I>" -E -P -w -MD -MF "${header}.pch.sum.d" -o "${header}.pch.sum" -x c++ "${header}"
            DEPFILE "${header}.pch.sum.d"
            COMMAND_EXPAND_LISTS
            COMMENT "The text of precompiled header ${name}"
            VERBATIM)
        target_sources(tappet_header_${name} PRIVATE "${header}.pch.sum")
    endif()
endfunction()

# Libraries whose sources begin with a machine. In a sanitizer's tree, which has one level of optimisation (TAPPET_FOR_SIZE): clang
# takes no header that was read with another one.
function(tappet_reads_machines)
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang AND NOT TAPPET_SANITIZE STREQUAL none)
        foreach(target IN LISTS ARGN)
            target_precompile_headers(${target} REUSE_FROM tappet_header_machine)
        endforeach()
    endif()
endfunction()
