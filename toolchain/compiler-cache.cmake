# SPDX-License-Identifier: Apache-2.0
# ccache: a source is compiled once, in this clone or another, with paths taken relative to the clone. It keeps
# its objects beside the rest that ci/setup made; -DCMAKE_CXX_COMPILER_LAUNCHER= switches it off.
include_guard(GLOBAL)
include("${CMAKE_CURRENT_LIST_DIR}/cache.cmake")

find_program(TAPPET_CCACHE ccache)
mark_as_advanced(TAPPET_CCACHE)
if(TAPPET_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER AND NOT DEFINED ENV{CMAKE_CXX_COMPILER_LAUNCHER})
    foreach(language IN ITEMS C CXX)
        set(CMAKE_${language}_COMPILER_LAUNCHER
            "${CMAKE_COMMAND}" -E env "CCACHE_DIR=${TAPPET_CACHE}/compiled" CCACHE_MAXSIZE=4G CCACHE_NOHASHDIR=1 CCACHE_PCH_EXTSUM=1
            "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}"
            # Headers that are compiled ahead are compared by what they hold, not by their age.
            "CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime" "${TAPPET_CCACHE}")
    endforeach()
endif()
# A precompiled header of clang names the age of what it was made from, unless it is told not to: another clone has other ages.
add_compile_options("$<$<COMPILE_LANG_AND_ID:CXX,Clang>:SHELL:-Xclang -fno-pch-timestamp>")
