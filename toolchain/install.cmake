# SPDX-License-Identifier: Apache-2.0
# Installs what a machine of your own needs: the framework's sources, which are compiled with each machine, the foreign sources
# that no package has, and the programs beside a machine. Found by find_package(Tappet), or by add_subdirectory(<clone>).
set(CMAKE_INSTALL_LIBDIR lib) # not an architecture's own: the programs find each other and the sources from here
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include("${CMAKE_CURRENT_LIST_DIR}/cache.cmake")

set(tappet_share "${CMAKE_INSTALL_DATADIR}/tappet")
install(FILES CMakeLists.txt LICENSE DESTINATION "${tappet_share}")
install(DIRECTORY kernel drivers board DESTINATION "${tappet_share}" PATTERN "*.md" EXCLUDE)
install(DIRECTORY toolchain DESTINATION "${tappet_share}" PATTERN "*.md" EXCLUDE PATTERN tools EXCLUDE PATTERN tables EXCLUDE PATTERN guide EXCLUDE)
install(DIRECTORY toolchain/tools/chart DESTINATION "${tappet_share}/toolchain/tools" PATTERN "*.md" EXCLUDE)
install(DIRECTORY toolchain/tools/front/template DESTINATION "${tappet_share}")
install(FILES toolchain/tools/front/tappet.bash DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME tappet)
foreach(library IN ITEMS libmodbus/src libmodbus/configure.ac libmodbus/VERSION pugixml/src pugixml/VERSION)
    cmake_path(GET library PARENT_PATH folder)
    if(IS_DIRECTORY "${TAPPET_CACHE}/${library}")
        install(DIRECTORY "${TAPPET_CACHE}/${library}" DESTINATION "${tappet_share}/foreign/${folder}")
    else()
        install(FILES "${TAPPET_CACHE}/${library}" DESTINATION "${tappet_share}/foreign/${folder}")
    endif()
endforeach()
# Debian 12 has version 2 in its backports only, which a plain one does not look into.
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/libgpiod")
execute_process(COMMAND dpkg-query -W -f "\${Version}\\n" libgpiod-dev OUTPUT_FILE "${PROJECT_BINARY_DIR}/libgpiod/VERSION" ERROR_QUIET)
install(FILES "${TAPPET_GPIOD_INCLUDE}/gpiod.h" "${TAPPET_GPIOD_ARCHIVE}" "${PROJECT_BINARY_DIR}/libgpiod/VERSION" DESTINATION "${tappet_share}/foreign/libgpiod")
# Pages to read first: the framework's page, the guide and the smallest whole machine.
install(FILES README.md DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/tappet")
install(DIRECTORY toolchain/guide "${PROJECT_BINARY_DIR}/guide" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/tappet")
install(DIRECTORY apps/cut_to_length DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/tappet/examples")
# The bench's kernels, unpacked, and the box's: without them a machine runs on the host only.
install(DIRECTORY "${TAPPET_CACHE}/kernel" DESTINATION "${tappet_share}/foreign" PATTERN "*-aarch64" EXCLUDE)

# They find each other beside themselves.
install(TARGETS tappet tappet-bench tappet-browse tappet-effects tappet-gateway tappet-image tappet-tables bench-init box-init DESTINATION "${CMAKE_INSTALL_LIBDIR}/tappet")
install(FILES "${CMAKE_BINARY_DIR}/tools/box-init.inputs" DESTINATION "${CMAKE_INSTALL_LIBDIR}/tappet") # for bills of materials
install(CODE "
    set(bin \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
    file(MAKE_DIRECTORY \"\${bin}\")
    foreach(program IN ITEMS tappet tappet-browse tappet-bench tappet-gateway)
        file(CREATE_LINK \"../${CMAKE_INSTALL_LIBDIR}/tappet/\${program}\" \"\${bin}/\${program}\" SYMBOLIC)
    endforeach()")

configure_package_config_file(
    toolchain/TappetConfig.cmake.in "${PROJECT_BINARY_DIR}/TappetConfig.cmake"
    INSTALL_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/Tappet"
    PATH_VARS tappet_share CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/TappetConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/TappetConfig.cmake" "${PROJECT_BINARY_DIR}/TappetConfigVersion.cmake"
        DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/Tappet")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tappet)
set(CPACK_PACKAGE_CONTACT "the developers of Tappet <tappet@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "machine controllers on real-time Linux: one table, one static binary")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
# Scripts that compile a machine and boot it on the bench.
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "g++, cmake, ninja-build, libeigen3-dev, libdouble-conversion-dev, libedit-dev, libbsd-dev, musl-dev, libgtest-dev, libgmock-dev")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "clang-22, qemu-system-x86, graphviz, plantuml, efibootguard, gdisk, dosfstools, mtools, e2fsprogs, zstd")
include(CPack)
