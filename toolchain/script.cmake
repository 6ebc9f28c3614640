# SPDX-License-Identifier: Apache-2.0
# Text files as constants of C++. A program that links the target includes "<path in the tree>/<file>.hpp".
#   tappet_script(<target> <file>.osd)   tappet::scripts::<file>, for compiled_script of kernel/script/compiled.hpp
#   tappet_file(<target> <file>)         tappet::files::<file_extension>, for from_dbc of drivers/can/from_dbc.hpp
#                                        and dictionary of drivers/canopen/eds.hpp
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
    # One rule in the whole tree, whoever asks for the text.
    string(MAKE_C_IDENTIFIER "constant_${place}" rule)
    if(NOT TARGET ${rule})
        add_custom_command(
            OUTPUT "${header}"
            COMMAND "${CMAKE_COMMAND}" "-DFROM=${from}" "-DTO=${header}" "-DPLACE=${place}" "-DCONSTANT=${constant}" -P "${generator}"
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
