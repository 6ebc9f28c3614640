# SPDX-License-Identifier: Apache-2.0
# Text files as constants of C++. A program that links the target includes "<path in the tree>/<file>.hpp".
#   tappet_script(<target> <file>.osd)   tappet::scripts::<file>, for compiled_script of kernel/script/compiled.hpp
#   tappet_file(<target> <file>)         tappet::files::<file_extension>: for a DBC, EDS or DCF file these are tables, for
#                                        from_dbc of drivers/can/from_dbc.hpp and dictionary of drivers/canopen/eds.hpp: the
#                                        program of toolchain/tables reads the file once
include_guard(GLOBAL)

# Where that program lies: with the installed programs, or built from here.
if(DEFINED TAPPET_TOOLS)
    set(tappet_tables_program "${TAPPET_TOOLS}/tappet-tables" CACHE INTERNAL "")
else()
    add_subdirectory("${CMAKE_CURRENT_LIST_DIR}/tables" "${CMAKE_CURRENT_BINARY_DIR}/toolchain/tables")
    set(tappet_tables_program tappet-tables CACHE INTERNAL "")
endif()

function(tappet_script target file)
    get_filename_component(name "${file}" NAME_WE)
    if(NOT name MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
        message(FATAL_ERROR "script \"${file}\": its name becomes one of C++; use characters, digits and _ only")
    endif()
    tappet_constant(${target} "${file}" "scripts::${name}")
endfunction()

function(tappet_file target file)
    get_filename_component(name "${file}" NAME)
    string(MAKE_C_IDENTIFIER "${name}" name)
    tappet_constant(${target} "${file}" "files::${name}")
endfunction()

function(tappet_constant target file constant)
    set(generator "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/script_header.cmake")
    cmake_path(ABSOLUTE_PATH file NORMALIZE OUTPUT_VARIABLE from)
    cmake_path(RELATIVE_PATH from BASE_DIRECTORY "${CMAKE_SOURCE_DIR}" OUTPUT_VARIABLE place)
    set(header "${CMAKE_BINARY_DIR}/scripts/${place}.hpp")
    if(file MATCHES "[.](dbc|DBC|eds|EDS|dcf|DCF)$")
        set(generator "${tappet_tables_program}")
        string(REPLACE "files::" "" name "${constant}")
        set(command "${generator}" "${from}" "${header}" "${place}" "${name}")
    else()
        set(command "${CMAKE_COMMAND}" "-DFROM=${from}" "-DTO=${header}" "-DPLACE=${place}" "-DCONSTANT=${constant}" -P "${generator}")
    endif()
    # One rule in the whole tree, whoever asks for the text.
    string(MAKE_C_IDENTIFIER "constant_${place}" rule)
    if(NOT TARGET ${rule})
        cmake_path(GET header PARENT_PATH folder)
        file(MAKE_DIRECTORY "${folder}")
        add_custom_command(
            OUTPUT "${header}"
            COMMAND ${command}
            DEPENDS "${from}" "${generator}"
            COMMENT "${place} as a constant"
            VERBATIM)
        add_custom_target(${rule} DEPENDS "${header}")
    endif()
    add_dependencies(${target} ${rule})
    get_target_property(type ${target} TYPE)
    if(type STREQUAL INTERFACE_LIBRARY) # such as <machine>_table: whoever is linked with it waits for the header
        target_include_directories(${target} INTERFACE "${CMAKE_BINARY_DIR}/scripts")
    else()
        target_include_directories(${target} PUBLIC "${CMAKE_BINARY_DIR}/scripts")
    endif()
endfunction()
