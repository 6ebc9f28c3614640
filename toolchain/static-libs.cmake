# SPDX-License-Identifier: Apache-2.0
# A firmware is one static binary, so what it stands on must be there as archives:
#   tappet::libgpiod   Debian's own libgpiod.a, version 2; the package of Tappet has it along, since a plain Debian 12 has not
#   tappet::libedit    Debian's own libedit.a with what it stands on; not for a firmware, but for tappet-browse beside it
#   tappet::double_conversion  Debian's own libdouble-conversion.a
#   tappet::mathematics  sine and its kin out of Debian's libc.a of musl: one routine for every processor
#   tappet::libmodbus, tappet::pugixml  built here from Debian's source packages (with their security patches): no
#                      package has the archive of the one, and that of the other has parts that nobody here needs
include_guard(GLOBAL)
include("${CMAKE_CURRENT_LIST_DIR}/cache.cmake")

# --- libgpiod -----------------------------------------------------------------------------------------------------
find_path(TAPPET_GPIOD_INCLUDE gpiod.h HINTS "${TAPPET_CACHE}/libgpiod")
find_library(TAPPET_GPIOD_ARCHIVE libgpiod.a HINTS "${TAPPET_CACHE}/libgpiod")
if(NOT TAPPET_GPIOD_INCLUDE OR NOT TAPPET_GPIOD_ARCHIVE)
    message(FATAL_ERROR "gpiod.h and libgpiod.a are not installed; run ci/setup once as root")
endif()
file(STRINGS "${TAPPET_GPIOD_INCLUDE}/gpiod.h" tappet_gpiod_v2 REGEX "gpiod_line_settings_new" LIMIT_COUNT 1)
if(NOT tappet_gpiod_v2)
    message(FATAL_ERROR "${TAPPET_GPIOD_INCLUDE}/gpiod.h is version 1, version 2 is needed; run ci/setup once as root")
endif()

add_library(tappet_libgpiod STATIC IMPORTED GLOBAL)
set_target_properties(
    tappet_libgpiod PROPERTIES IMPORTED_LOCATION "${TAPPET_GPIOD_ARCHIVE}"
    INTERFACE_INCLUDE_DIRECTORIES "${TAPPET_GPIOD_INCLUDE}")
add_library(tappet::libgpiod ALIAS tappet_libgpiod)

# --- libedit ------------------------------------------------------------------------------------------------------
find_path(TAPPET_EDIT_INCLUDE histedit.h)
find_library(TAPPET_EDIT_ARCHIVE libedit.a)
find_library(TAPPET_TINFO_ARCHIVE libtinfo.a)
find_library(TAPPET_BSD_ARCHIVE libbsd.a)
find_library(TAPPET_MD_ARCHIVE libmd.a)
foreach(part IN ITEMS EDIT_INCLUDE EDIT_ARCHIVE TINFO_ARCHIVE BSD_ARCHIVE MD_ARCHIVE)
    if(NOT TAPPET_${part})
        message(FATAL_ERROR "libedit-dev is not installed completely (${part}); run ci/setup once as root")
    endif()
endforeach()
add_library(tappet_libedit STATIC IMPORTED GLOBAL)
set_target_properties(
    tappet_libedit PROPERTIES IMPORTED_LOCATION "${TAPPET_EDIT_ARCHIVE}"
    INTERFACE_LINK_LIBRARIES "${TAPPET_TINFO_ARCHIVE};${TAPPET_BSD_ARCHIVE};${TAPPET_MD_ARCHIVE}")
add_library(tappet::libedit ALIAS tappet_libedit)

# --- double-conversion --------------------------------------------------------------------------------------------
find_path(TAPPET_DOUBLE_CONVERSION_INCLUDE double-conversion/double-conversion.h)
find_library(TAPPET_DOUBLE_CONVERSION_ARCHIVE libdouble-conversion.a)
if(NOT TAPPET_DOUBLE_CONVERSION_INCLUDE OR NOT TAPPET_DOUBLE_CONVERSION_ARCHIVE)
    message(FATAL_ERROR "libdouble-conversion.a is not installed; run ci/setup once as root")
endif()
add_library(tappet_double_conversion STATIC IMPORTED GLOBAL)
set_target_properties(tappet_double_conversion PROPERTIES IMPORTED_LOCATION "${TAPPET_DOUBLE_CONVERSION_ARCHIVE}")
add_library(tappet::double_conversion ALIAS tappet_double_conversion)

# --- mathematics --------------------------------------------------------------------------------------------------
# glibc takes another routine on a processor with fused multiply-add, so that one seed gave one run on one kind of box
# only; and a static binary holds four of each. All that one routine of musl needs becomes one object that shows
# the routines alone: its tables bear names that glibc uses too.
# g++ makes one sincos of a sine and a cosine, and both compilers an exp2 of a power of two.
set(tappet_routines sin cos sincos tan asin acos atan atan2 exp exp2 log log2 log10 pow sqrt hypot fabs floor ceil round trunc nearbyint rint fmod)
set(tappet_routine_parts ${tappet_routines} scalbn __sin __cos __tan __rem_pio2 __rem_pio2_large __math_divzero __math_invalid
    __math_oflow __math_uflow __math_xflow exp_data log_data log2_data pow_data)
find_file(TAPPET_MUSL_ARCHIVE libc.a PATHS /usr/lib/${CMAKE_SYSTEM_PROCESSOR}-linux-musl NO_DEFAULT_PATH)
if(NOT TAPPET_MUSL_ARCHIVE)
    message(FATAL_ERROR "musl's libc.a is not installed; run ci/setup once as root")
endif()
# Where a fused multiply-add is to be had always, musl's logarithms and powers take it and round once less: they are compiled here as
# they are elsewhere.
set(tappet_unfused)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
    set(tappet_unfused_parts log log2 pow log_data log2_data pow_data)
    list(REMOVE_ITEM tappet_routine_parts ${tappet_unfused_parts})
    list(REMOVE_DUPLICATES tappet_routine_parts)
    set(tappet_musl "${TAPPET_CACHE}/musl")
    list(TRANSFORM tappet_unfused_parts REPLACE "(.+)" "${tappet_musl}/src/math/\\1.c")
    add_library(tappet_unfused OBJECT EXCLUDE_FROM_ALL ${tappet_unfused_parts})
    set(tappet_unfused $<TARGET_OBJECTS:tappet_unfused>)
    cmake_path(GET TAPPET_MUSL_ARCHIVE PARENT_PATH place)
    cmake_path(GET place FILENAME place)
    target_compile_options(
        tappet_unfused
        PRIVATE -w -std=c99 -nostdinc -ffp-contract=off -frounding-math -U__FP_FAST_FMA
                "SHELL:-I ${tappet_musl}/arch/aarch64 -I ${tappet_musl}/arch/generic -I ${tappet_musl}/src/include -I ${tappet_musl}/src/internal"
                "SHELL:-I ${CMAKE_SYSROOT}/usr/include/${place} -I ${tappet_musl}/include")
endif()
set(tappet_mathematics "${PROJECT_BINARY_DIR}/mathematics")
file(MAKE_DIRECTORY "${tappet_mathematics}")
list(TRANSFORM tappet_routines PREPEND "--keep-global-symbol=" OUTPUT_VARIABLE tappet_shown)
list(TRANSFORM tappet_routine_parts APPEND ".lo" OUTPUT_VARIABLE tappet_members)
add_custom_command(
    OUTPUT "${tappet_mathematics}/routines.o"
    COMMAND "${CMAKE_AR}" x "${TAPPET_MUSL_ARCHIVE}" ${tappet_members}
    COMMAND "${CMAKE_LINKER}" -r -o all.o ${tappet_members} ${tappet_unfused}
    COMMAND "${CMAKE_OBJCOPY}" ${tappet_shown} all.o routines.o
    WORKING_DIRECTORY "${tappet_mathematics}"
    DEPENDS "${TAPPET_MUSL_ARCHIVE}" ${tappet_unfused}
    COMMENT "sine and its kin, the same on every processor"
    VERBATIM COMMAND_EXPAND_LISTS)
set_source_files_properties("${tappet_mathematics}/routines.o" PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
add_library(tappet_mathematics STATIC "${tappet_mathematics}/routines.o")
set_target_properties(tappet_mathematics PROPERTIES LINKER_LANGUAGE C)
add_library(tappet::mathematics ALIAS tappet_mathematics)

# --- pugixml ------------------------------------------------------------------------------------------------------
set(tappet_pugixml_source "${TAPPET_CACHE}/pugixml/src")
if(NOT EXISTS "${tappet_pugixml_source}/pugixml.cpp")
    message(FATAL_ERROR "${tappet_pugixml_source} does not hold the source of pugixml; run ci/setup once as root")
endif()
add_library(tappet_pugixml STATIC "${tappet_pugixml_source}/pugixml.cpp")
target_include_directories(tappet_pugixml SYSTEM PUBLIC "${tappet_pugixml_source}")
# Property files are read once, before the machine arms: small counts, not fast.
target_compile_definitions(tappet_pugixml PUBLIC PUGIXML_NO_XPATH PUGIXML_NO_STL PUGIXML_NO_EXCEPTIONS)
target_compile_options(tappet_pugixml PRIVATE -w -Os -ffunction-sections -fdata-sections)
add_library(tappet::pugixml ALIAS tappet_pugixml)

# --- libmodbus ----------------------------------------------------------------------------------------------------
set(tappet_modbus_source "${TAPPET_CACHE}/libmodbus")
if(NOT EXISTS "${tappet_modbus_source}/src/modbus.c")
    message(FATAL_ERROR "${tappet_modbus_source} does not hold the source of libmodbus; run ci/setup once as root")
endif()

# Its configure script would do no more than this on the one system we build for.
foreach(part IN ITEMS major minor micro)
    file(STRINGS "${tappet_modbus_source}/configure.ac" line REGEX "m4_define\\(\\[libmodbus_version_${part}\\]")
    string(REGEX REPLACE ".*\\[([0-9]+)\\].*" "\\1" number "${line}")
    string(TOUPPER "LIBMODBUS_VERSION_${part}" name)
    set(${name} "${number}")
endforeach()
set(LIBMODBUS_VERSION "${LIBMODBUS_VERSION_MAJOR}.${LIBMODBUS_VERSION_MINOR}.${LIBMODBUS_VERSION_MICRO}")
set(tappet_modbus_generated "${PROJECT_BINARY_DIR}/libmodbus")
configure_file("${tappet_modbus_source}/src/modbus-version.h.in" "${tappet_modbus_generated}/modbus/modbus-version.h" @ONLY)
configure_file("${tappet_modbus_source}/src/modbus.h" "${tappet_modbus_generated}/modbus/modbus.h" COPYONLY)
configure_file("${tappet_modbus_source}/src/modbus-tcp.h" "${tappet_modbus_generated}/modbus/modbus-tcp.h" COPYONLY)
configure_file("${tappet_modbus_source}/src/modbus-rtu.h" "${tappet_modbus_generated}/modbus/modbus-rtu.h" COPYONLY)

add_library(
    tappet_libmodbus STATIC
    "${tappet_modbus_source}/src/modbus.c"
    "${tappet_modbus_source}/src/modbus-data.c"
    "${tappet_modbus_source}/src/modbus-rtu.c"
    "${tappet_modbus_source}/src/modbus-tcp.c")
target_include_directories(
    tappet_libmodbus SYSTEM
    PUBLIC "${tappet_modbus_generated}" "${tappet_modbus_generated}/modbus"
    PRIVATE "${tappet_modbus_source}/src")
target_compile_options(
    tappet_libmodbus
    PRIVATE -w -O2 -fstack-clash-protection -D_GNU_SOURCE -DHAVE_CONFIG_H -include "${CMAKE_CURRENT_LIST_DIR}/libmodbus/config.h"
            "-I${CMAKE_CURRENT_LIST_DIR}/libmodbus")
add_library(tappet::libmodbus ALIAS tappet_libmodbus)
