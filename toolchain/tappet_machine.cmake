# SPDX-License-Identifier: Apache-2.0
# tappet_machine(<name>
#     TABLE machine.hpp            holds <namespace>::table
#     BOARDS bench ipc-x86_64 ..   boards of Tappet by name, or headers of one's own: boards/my_box.hpp holds tappet::board::my_box.
#                                  One whose name ends in an architecture is built for that one only
#     [BINDINGS bindings.hpp]      holds <namespace>::bindings::<board> for each board that is not simulated
#     [PLANT plant.hpp]            holds <namespace>::Plant, made from a seed: the other end of the wires
#     [TESTS test.cpp ..]          cases of GoogleTest about it with its PLANT: they include "toolchain/machine/test.hpp"
#     [PLANT_SOURCES ..]           its own, and
#     [PLANT_LIBRARIES ..]         what it stands on
#     [HOOKS hooks.hpp]            holds <namespace>::firmware_hooks for its boards
#     [HOST_HOOKS hooks.hpp]       holds <namespace>::host_hooks for its program with the PLANT
#     [SWARM swarm.hpp]            holds <namespace>::Swarm: what must never be so of it, whatever goes wrong around it
#     [MODEL model.hpp]            holds <namespace>::model: what spin is to know and to prove beside the table
#     [NAMESPACE a::b]             where all of that stands; <name> unless said
#     [LIBRARIES ..])              what its components need beyond Tappet
#
# makes <name>, the machine with its plant in one process on the host; <name>_host, the same as a library for tests, with
# <namespace>::on_host(), the accepted machine; <name>_test, for CTest; <name>-swarm, what its SWARM judges; <name>-chart, when it
# is asked for, which draws it; for each board, the static
# firmware <name>-<board>, and <name>-<board>.stripped, which is what goes onto the box; and, for the bench, <name>-plant, the
# plant at the other end of its wires. After it tappet_script(<name>_table <file>.osd) gives its table a script: see script.cmake.
include_guard(GLOBAL)

# The linker's own: llvm-strip refuses the relocations of a static program.
find_program(TAPPET_STRIP NAMES ${CMAKE_SYSTEM_PROCESSOR}-linux-gnu-strip strip REQUIRED)
find_program(TAPPET_SIZE NAMES ${CMAKE_SYSTEM_PROCESSOR}-linux-gnu-size size REQUIRED)

# A header as a program includes it: what lies in Tappet's own tree from its root, so that another clone compiles the same.
function(tappet_header path result)
    cmake_path(GET CMAKE_CURRENT_FUNCTION_LIST_DIR PARENT_PATH root)
    cmake_path(IS_PREFIX root "${path}" NORMALIZE inside)
    if(inside)
        cmake_path(RELATIVE_PATH path BASE_DIRECTORY "${root}" OUTPUT_VARIABLE path)
    endif()
    set(${result} "${path}" PARENT_SCOPE)
endfunction()

# The header and the name in C++ of a board.
function(tappet_board board header symbol)
    if(board MATCHES "\\.hpp$")
        cmake_path(ABSOLUTE_PATH board NORMALIZE OUTPUT_VARIABLE path)
        cmake_path(GET board STEM name)
    else()
        cmake_path(GET CMAKE_CURRENT_FUNCTION_LIST_DIR PARENT_PATH root)
        set(path "${root}/board/${board}/board.hpp")
        set(name "${board}")
    endif()
    if(NOT EXISTS "${path}")
        message(FATAL_ERROR "tappet_machine: there is no board \"${board}\": no file ${path}; name one of Tappet's, or a header of your own")
    endif()
    string(REPLACE "-" "_" name "${name}")
    tappet_header("${path}" path)
    set(${header} "${path}" PARENT_SCOPE)
    set(${symbol} "${name}" PARENT_SCOPE)
endfunction()

# The language of a machine's programs, whatever the project around them says.
function(tappet_language)
    set_target_properties(${ARGN} PROPERTIES CXX_STANDARD 23 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
endfunction()

# A program on the host that tells which real-time code of its machine may block, by the name of the function.
function(tappet_is_watched program)
    if(TARGET tappet_host_watch)
        target_link_libraries(${program} PRIVATE tappet_host_watch)
        set_target_properties(${program} PROPERTIES ENABLE_EXPORTS ON)
    endif()
endfunction()

function(tappet_machine name)
    cmake_parse_arguments(PARSE_ARGV 1 machine "" "TABLE;BINDINGS;PLANT;HOOKS;HOST_HOOKS;SWARM;MODEL;NAMESPACE" "BOARDS;LIBRARIES;TESTS;PLANT_SOURCES;PLANT_LIBRARIES")
    if(machine_UNPARSED_ARGUMENTS OR NOT machine_TABLE OR NOT machine_BOARDS)
        message(FATAL_ERROR "tappet_machine(${name} ..): say TABLE <header> and BOARDS <board>..; \"${machine_UNPARSED_ARGUMENTS}\" is unknown")
    endif()
    set(mains "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/machine")
    if(NOT machine_NAMESPACE)
        set(machine_NAMESPACE "${name}")
    endif()

    # The code below its table, for tests and for programs of its own.
    add_library(${name}_table INTERFACE)
    target_link_libraries(${name}_table INTERFACE tappet_framework ${machine_LIBRARIES})
    set(definitions TAPPET_NAMESPACE=${machine_NAMESPACE}) # of each program: one that looks at two machines links two tables
    foreach(part IN ITEMS TABLE BINDINGS PLANT HOOKS HOST_HOOKS SWARM MODEL)
        if(machine_${part})
            cmake_path(ABSOLUTE_PATH machine_${part} NORMALIZE OUTPUT_VARIABLE path)
            if(NOT EXISTS "${path}")
                message(FATAL_ERROR "tappet_machine(${name} ..): ${part} names ${path}, which does not exist")
            endif()
            tappet_header("${path}" path)
            list(APPEND definitions "TAPPET_${part}_HEADER=\"${path}\"")
        endif()
    endforeach()

    # The code that all of its programs link: none of it depends on the board.
    add_library(${name}_code STATIC "${mains}/code.cpp")
    target_compile_definitions(${name}_code PRIVATE ${definitions})
    target_compile_options(${name}_code PRIVATE -ffunction-sections -fdata-sections)
    if(TAPPET_EFFECTS_BY)
        cmake_language(EVAL CODE "cmake_language(DEFER DIRECTORY \"${CMAKE_SOURCE_DIR}\" CALL tappet_check_effects ${name}_code)")
    else()
        add_custom_command(
            TARGET ${name}_code POST_BUILD
            COMMAND "${CMAKE_COMMAND}" -E echo "${name}: UNCHECKED: whether its real-time functions block. It arms on the host and the bench only; install clang-22 and configure again"
            VERBATIM)
    endif()
    target_link_libraries(${name}_code PUBLIC ${name}_table PRIVATE tappet_warnings)
    tappet_language(${name}_code)

    if(machine_PLANT)
        add_library(${name}_host STATIC "${mains}/on_host.cpp" "${mains}/plant.cpp" ${machine_PLANT_SOURCES})
        target_compile_definitions(${name}_host PRIVATE ${definitions})
        target_link_libraries(
            ${name}_host
            PUBLIC ${name}_code tappet_host ${machine_PLANT_LIBRARIES}
            PRIVATE tappet_warnings)
        add_executable(${name} "${mains}/host_main.cpp")
        target_compile_definitions(${name} PRIVATE ${definitions})
        target_link_libraries(${name} PRIVATE ${name}_host tappet_warnings)
        tappet_is_watched(${name})
        tappet_language(${name}_host ${name})
        add_executable(${name}-swarm "${mains}/swarm_main.cpp")
        target_compile_definitions(${name}-swarm PRIVATE ${definitions})
        target_link_libraries(${name}-swarm PRIVATE ${name}_host tappet_warnings)
        tappet_language(${name}-swarm)
    endif()
    foreach(each IN ITEMS ${name}_code ${name}_host ${name} ${name}-swarm)
        if(COMMAND tappet_reads_machines AND TARGET ${each})
            tappet_reads_machines(${each})
        endif()
    endforeach()
    if(machine_TESTS)
        if(NOT machine_PLANT)
            message(FATAL_ERROR "tappet_machine(${name} ..): TESTS need wires that lead somewhere; say PLANT <header>")
        endif()
        find_package(GTest REQUIRED)
        add_executable(${name}_test ${machine_TESTS})
        target_compile_definitions(${name}_test PRIVATE ${definitions})
        tappet_is_watched(${name}_test)
        target_link_libraries(${name}_test PRIVATE ${name}_host GTest::gmock GTest::gtest_main tappet_warnings)
        target_compile_options(${name}_test PRIVATE -Wno-error) # the user's own code: a warning there must not hide the outcome
        tappet_language(${name}_test)
        add_test(NAME ${name}_test COMMAND ${name}_test)
    endif()

    # Its charts: nobody waits for them who does not ask. It reads scripts back from their instructions and finds the
    # names of C++ programs among its symbols.
    add_executable(${name}-chart EXCLUDE_FROM_ALL "${mains}/chart_main.cpp" "${mains}/on_host.cpp" "${mains}/code.cpp")
    target_compile_definitions(${name}-chart PRIVATE ${definitions} TAPPET_KEEPS_INSTRUCTIONS)
    target_link_libraries(${name}-chart PRIVATE ${name}_table tappet_chart tappet_warnings)
    set_target_properties(${name}-chart PROPERTIES ENABLE_EXPORTS ON)
    if(COMMAND tappet_reads_machines)
        tappet_reads_machines(${name}-chart)
    endif()
    tappet_language(${name}-chart)

    foreach(board IN LISTS machine_BOARDS)
        if(board STREQUAL host) # its program is the one above: the host's devices are simulated
            if(NOT machine_PLANT)
                message(FATAL_ERROR "tappet_machine(${name} ..): the host has no wires; say PLANT <header>, what stands at their other end")
            endif()
            continue()
        endif()
        cmake_path(GET board STEM board_name)
        if(board_name MATCHES "[-_](x86_64|aarch64)$" AND NOT CMAKE_MATCH_1 STREQUAL CMAKE_SYSTEM_PROCESSOR)
            continue()
        endif()
        tappet_board("${board}" header symbol)
        set(firmware "${name}-${board_name}")
        if(TARGET tappet_sealed_heap)
            add_executable(${firmware} "${mains}/firmware_main.cpp")
            target_compile_options(${firmware} PRIVATE -ffunction-sections -fdata-sections)
            target_link_libraries(${firmware} PRIVATE tappet_sealed_heap)
            # The files that the linker took are the image's bill of materials.
            target_link_options(${firmware} PRIVATE -static -Wl,--gc-sections "LINKER:--dependency-file=${CMAKE_CURRENT_BINARY_DIR}/${firmware}.inputs")
            set(stripped "$<TARGET_FILE:${firmware}>.stripped")
            add_custom_command(
                TARGET ${firmware} POST_BUILD
                COMMAND "${TAPPET_STRIP}" -o "${stripped}" "$<TARGET_FILE:${firmware}>"
                COMMAND "${TAPPET_SIZE}" "${stripped}"
                COMMENT "${firmware}: static memory, without symbols"
                VERBATIM)
        else() # no static binary has a sanitizer, but the effects of its functions are looked at
            string(APPEND firmware "-effects")
            add_library(${firmware} OBJECT EXCLUDE_FROM_ALL "${mains}/firmware_main.cpp")
            target_compile_options(${firmware} PRIVATE -O0)
            if(TAPPET_SANITIZE STREQUAL realtime AND board STREQUAL bench) # a board changes no function
                set_target_properties(${firmware} PROPERTIES EXCLUDE_FROM_ALL FALSE)
            endif()
        endif()
        set(on_board ${definitions} TAPPET_BOARD=${symbol} "TAPPET_BOARD_HEADER=\"${header}\"")
        if(machine_PLANT AND board_name STREQUAL bench AND TARGET tappet_sealed_heap)
            add_executable(${name}-plant "${mains}/plant_main.cpp")
            target_compile_definitions(${name}-plant PRIVATE ${on_board})
            target_link_libraries(${name}-plant PRIVATE ${name}_host tappet_bench_plant tappet_warnings)
            target_link_options(${name}-plant PRIVATE -static)
            tappet_language(${name}-plant)
        endif()
        target_compile_definitions(${firmware} PRIVATE ${on_board})
        target_link_libraries(${firmware} PRIVATE ${name}_code tappet_firmware tappet_warnings)
        tappet_language(${firmware})
    endforeach()
endfunction()
