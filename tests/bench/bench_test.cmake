# SPDX-License-Identifier: Apache-2.0
# tappet_bench_test(NAME ARGUMENT...): a CTest that is one run of tappet-bench with these arguments.
#
#   EXPECT REGEX...  the output must match each of them, in any order
#   GOLDEN FILE...   the output must contain the lines of each, with addresses, times and the build masked
#   EXIT CODE        the guest's exit code (default 0)
#   TIMEOUT S        wall time from the first command on (default 300: other tests may run beside it)
#   RUN ARGUMENT...  the arguments of tappet-bench; generator expressions are welcome
#
# Bench tests carry the label "bench". Each needs one processor for its time, so they run beside others. In a build tree with a
# sanitizer there is no bench, and the function does nothing.
include_guard(GLOBAL)

# These take half a minute or more each; shorter tests cover the same.
set(bench_tests_left_to_all
    campaign campaign_without_guardian loom_people loom_faults loom_foreign_nodes two_robots bearing_press cut_to_length woodworking_lane browse modbus_line
    flooded_wire flooded_wire_planted)

function(tappet_bench_test name)
    cmake_parse_arguments(PARSE_ARGV 1 test "" "EXIT;TIMEOUT" "EXPECT;GOLDEN;RUN")
    if(NOT TARGET tappet-bench)
        return()
    endif()
    if(NOT test_RUN OR test_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "tappet_bench_test(${name}): give the arguments of tappet-bench after RUN")
    endif()
    if(NOT DEFINED test_EXIT)
        set(test_EXIT 0)
    endif()
    if(NOT DEFINED test_TIMEOUT)
        set(test_TIMEOUT 300)
    endif()
    set(expectations)
    foreach(regex IN LISTS test_EXPECT)
        list(APPEND expectations --expect "${regex}")
    endforeach()
    foreach(file IN LISTS test_GOLDEN)
        list(APPEND expectations --golden "${file}")
    endforeach()
    add_test(NAME "bench.${name}"
             COMMAND bench-expect --exit ${test_EXIT} ${expectations} --
                     $<TARGET_FILE:tappet-bench> --verbose --timeout ${test_TIMEOUT}
                     ${test_RUN})
    math(EXPR hard_limit "${test_TIMEOUT} + 330") # to boot on a busy host, and to end
    set_tests_properties("bench.${name}" PROPERTIES LABELS bench TIMEOUT ${hard_limit})
    set(where ALWAYS)
    if(name IN_LIST bench_tests_left_to_all)
        set(where LEFT)
    endif()
    string(REGEX MATCHALL "TARGET_FILE:[^>]+" programs "${test_RUN}")
    list(TRANSFORM programs REPLACE "TARGET_FILE:" "")
    tappet_tried("bench.${name}" ${where} STARTS bench-expect tappet-bench ${programs})
endfunction()
