# SPDX-License-Identifier: Apache-2.0
# Which tests ci/test tries in this tree, and what is built for them: the target "tried". Most of what is tried needs one compiler:
# clang, whose sanitizer of real time sees more and which is the faster one. With g++ too is tried what the compiler can change, and what
# goes onto the bench; for races what all threads pass. The rest, and the figures, carry the label "all": ci/test --all tries them.
include_guard(GLOBAL)

if(TAPPET_TESTS STREQUAL all)
    set(tried_folders ".*")
elseif(TAPPET_SANITIZE STREQUAL thread)
    set(tried_folders "^kernel/(os|exchange|component|activity)(/|$)")
    set(tried_tests real_world_test map_test loop_test) # of the other folders those that have threads
elseif(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    set(tried_folders ".*")
else()
    set(tried_folders "^(kernel/(exchange|script|statechart)|differential|diagnostics|fuzz|waitfree|stack|bench|toolchain/tools/(bench|front|image))(/|$)")
endif()

add_custom_target(tried ALL)

# tappet_tried(TEST.. [LEFT | ALWAYS] [STARTS TARGET..]): tests of this folder are tried where the folder is; with LEFT by --all alone,
# with ALWAYS in each tree that has them. They need the programs of their own names, and those that they start.
function(tappet_tried)
    cmake_parse_arguments(PARSE_ARGV 0 tests "LEFT;ALWAYS" "" "STARTS")
    cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY "${PROJECT_SOURCE_DIR}/tests" OUTPUT_VARIABLE folder)
    if(TAPPET_TESTS STREQUAL all OR tests_ALWAYS OR "${tests_UNPARSED_ARGUMENTS}" IN_LIST tried_tests OR (NOT tests_LEFT AND folder MATCHES "${tried_folders}"))
        foreach(target IN LISTS tests_UNPARSED_ARGUMENTS tests_STARTS)
            if(TARGET ${target})
                add_dependencies(tried ${target})
            endif()
        endforeach()
        return()
    endif()
    foreach(test IN LISTS tests_UNPARSED_ARGUMENTS)
        # After the folder has said what else it says of its tests.
        cmake_language(EVAL CODE "cmake_language(DEFER CALL set_property TEST ${test} APPEND PROPERTY LABELS all)")
    endforeach()
endfunction()
