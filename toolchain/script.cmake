# SPDX-License-Identifier: Apache-2.0
# tappet_script(<target> <file>.osd): the script as a constant of C++, for compiled_script of kernel/script/compiled.hpp.
# Who is linked with the target includes "<path in the tree>/<file>.osd.hpp" and has tappet::scripts::<file>, a ScriptSource.
function(tappet_script target file)
    set(generator "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/script_header.cmake")
    cmake_path(ABSOLUTE_PATH file NORMALIZE OUTPUT_VARIABLE from)
    cmake_path(RELATIVE_PATH from BASE_DIRECTORY "${CMAKE_SOURCE_DIR}" OUTPUT_VARIABLE place)
    set(header "${CMAKE_BINARY_DIR}/scripts/${place}.hpp")
    add_custom_command(
        OUTPUT "${header}"
        COMMAND "${CMAKE_COMMAND}" "-DFROM=${from}" "-DTO=${header}" "-DPLACE=${place}" -P "${generator}"
        DEPENDS "${from}" "${generator}"
        COMMENT "${place} as a constant"
        VERBATIM)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL INTERFACE_LIBRARY) # such as <machine>_table: whoever is linked with it waits for the header
        target_sources(${target} INTERFACE "${header}")
        target_include_directories(${target} INTERFACE "${CMAKE_BINARY_DIR}/scripts")
    else()
        target_sources(${target} PRIVATE "${header}")
        target_include_directories(${target} PUBLIC "${CMAKE_BINARY_DIR}/scripts")
    endif()
endfunction()
