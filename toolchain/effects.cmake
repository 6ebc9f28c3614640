# SPDX-License-Identifier: Apache-2.0
# Real time is checked whichever compiler builds. Clang from 20 on follows the effects of functions itself. With another compiler,
# such a clang also reads each source with components of a machine, at the same time (toolchain/effects). Without one, the build
# says so, and the firmware arms on the host and the bench only.
include_guard(GLOBAL)

function(tappet_finds_effects path is_one) # a validator of find_program: is it a clang that follows effects?
    execute_process(COMMAND "${path}" --version OUTPUT_VARIABLE version ERROR_QUIET)
    if(NOT version MATCHES "clang version ([0-9]+)" OR CMAKE_MATCH_1 LESS 20)
        set(${is_one} FALSE PARENT_SCOPE)
    endif()
endfunction()

find_program(TAPPET_CLANG NAMES clang++-22 clang++-21 clang++-20 clang++ VALIDATOR tappet_finds_effects)
mark_as_advanced(TAPPET_CLANG)
set(TAPPET_EFFECTS ON CACHE BOOL "OFF: nothing checks the real-time functions of machines; their firmware does not arm on a box")
if(NOT TAPPET_EFFECTS)
    set(TAPPET_EFFECTS_BY "" CACHE INTERNAL "")
elseif(CMAKE_CXX_COMPILER_ID STREQUAL Clang AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 20)
    set(TAPPET_EFFECTS_BY compiler CACHE INTERNAL "")
elseif(TAPPET_CLANG)
    set(TAPPET_EFFECTS_BY beside CACHE INTERNAL "")
else()
    set(TAPPET_EFFECTS_BY "" CACHE INTERNAL "")
endif()
if(NOT TAPPET_EFFECTS_BY)
    message(
        WARNING
            "Nothing checks that the real-time functions of this machine do not block: a lock, an allocation or a sleep in them would "
            "compile. The firmware arms on the host and the bench only. Install clang-22 (or 20, 21) and configure again")
endif()

# Where it lies: with the installed programs, or built from here.
if(DEFINED TAPPET_TOOLS)
    set(tappet_effects_program "${TAPPET_TOOLS}/tappet-effects" CACHE INTERNAL "")
else()
    add_subdirectory("${CMAKE_CURRENT_LIST_DIR}/effects" "${CMAKE_CURRENT_BINARY_DIR}/toolchain/effects")
    set(tappet_effects_program "${CMAKE_BINARY_DIR}/tools/tappet-effects" CACHE INTERNAL "")
endif()

# Checks the sources of these targets and of what they stand on, wherever the project defines it: called when all targets are known.
# The framework's own libraries are proven where they are made.
function(tappet_check_effects)
    cmake_path(GET CMAKE_CURRENT_FUNCTION_LIST_DIR PARENT_PATH root)
    foreach(target IN LISTS ARGN)
        if(NOT TARGET ${target})
            continue()
        endif()
        get_target_property(alias ${target} ALIASED_TARGET)
        if(alias)
            set(target ${alias})
        endif()
        get_target_property(is_imported ${target} IMPORTED)
        get_target_property(is_seen ${target} TAPPET_EFFECTS_SEEN)
        get_target_property(folder ${target} SOURCE_DIR)
        if(is_imported OR is_seen OR folder MATCHES "^${root}/(kernel|drivers|board|toolchain)(/|$)")
            continue()
        endif()
        set_target_properties(${target} PROPERTIES TAPPET_EFFECTS_SEEN TRUE)
        get_target_property(type ${target} TYPE)
        if(type STREQUAL INTERFACE_LIBRARY)
            set(libraries INTERFACE_LINK_LIBRARIES)
        else()
            set(libraries LINK_LIBRARIES)
            tappet_check_effects_of(${target})
        endif()
        get_target_property(below ${target} ${libraries})
        tappet_check_effects(${below})
    endforeach()
endfunction()

function(tappet_check_effects_of target)
    target_compile_definitions(${target} PRIVATE TAPPET_EFFECTS_CHECKED) # code.cpp tells the machine
    if(TAPPET_EFFECTS_BY STREQUAL compiler)
        target_compile_options(${target} PRIVATE -Wfunction-effects -Werror=function-effects)
    elseif(TAPPET_EFFECTS_BY STREQUAL beside)
        get_target_property(launcher ${target} CXX_COMPILER_LAUNCHER)
        set(check ${TAPPET_CLANG} -O0 -Wno-everything -Wfunction-effects -Werror=function-effects)
        list(APPEND check -fconstexpr-steps=2000000000 -fconstexpr-depth=2000)
        set(both "${tappet_effects_program}" ${check} --)
        if(launcher) # not an empty word in the list, because a command with one does not start
            set(both "${tappet_effects_program}" ${launcher} ${check} -- ${launcher})
        endif()
        set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER "${both}")
        if(TARGET tappet-effects)
            add_dependencies(${target} tappet-effects)
        endif()
    endif()
endfunction()
