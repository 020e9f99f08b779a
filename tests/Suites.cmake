# Read by ctest when it starts: each suite that `program` lists becomes its test "folder.Suite". A suite whose name begins with
# "Nightly" has the label nightly, the others ci. Those that take long, at `milliseconds` a case, begin first.
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE list RESULT_VARIABLE result)
if(NOT result EQUAL 0)
    add_test(${folder}.ListsItsTests ${program} --gtest_list_tests) # and fails again, where everyone sees it
    set_tests_properties(${folder}.ListsItsTests PROPERTIES LABELS ci)
    return()
endif()

function(add_suite suite cases)
    set(tier ci)
    if(suite MATCHES "^Nightly")
        set(tier nightly)
    endif()
    math(EXPR cost "${cases} * ${milliseconds}")
    # Whose few cases compile many shaders: begun late they end alone.
    if(folder STREQUAL "cross" AND suite MATCHES "(Agreement|Analytic|Estimators|Stability|Superset)")
        math(EXPR cost "${cost} * 16")
    endif()
    add_test(${folder}.${suite} ${program} --gtest_brief=1 --gtest_filter=${suite}.*)
    set_tests_properties(${folder}.${suite} PROPERTIES COST ${cost} TIMEOUT 1800 LABELS "${folder};${tier}")
    # Small renders: Mesa's software driver takes longer to optimise its code than that saves, measured for some of
    # these suites with an empty cache of that driver. A window's frames are many: its tests take longer with code that
    # is not optimised (GpuWindowTest 48 -> 60 s of processor time, PanelsTest with the GPU 66 -> 82).
    if(folder MATCHES "^(cross|program)$")
        set_tests_properties(${folder}.${suite} PROPERTIES ENVIRONMENT GALLIVM_PERF=nopt)
    endif()
endfunction()

# Lines "Suite.  # parameter" and, below, "  Case  # parameter".
string(REGEX REPLACE "[^A-Za-z0-9_/.\n ]" "" list "${list}")
string(REPLACE "\n" ";" lines "${list}")
set(suite "")
foreach(line IN LISTS lines)
    if(line MATCHES "^([A-Za-z0-9_/]+)\\.")
        if(suite)
            add_suite(${suite} ${cases})
        endif()
        set(suite ${CMAKE_MATCH_1})
        set(cases 0)
    elseif(line MATCHES "^  [^ ]")
        math(EXPR cases "${cases} + 1")
    endif()
endforeach()
if(suite)
    add_suite(${suite} ${cases})
endif()
