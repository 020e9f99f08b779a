# Each of examples/ is a project of its own that finds the installed package, compiles without a warning, and prints and
# writes what it is to. What they print is compared with closed forms, most of them computed by the examples themselves
# from formulas that their estimates do not use.
#   cmake -DBUILD=... -DCONFIG=... -DROOT=... -DSCRATCH=... -DGENERATOR=... -DCOMPILER=... -P Examples.cmake
include(${CMAKE_CURRENT_LIST_DIR}/Prefix.cmake)

# run(<example>): its output becomes `said`.
function(run name)
    if(NOT EXISTS ${prefix}/share/doc/ray-tracing-twins-dev/examples/${name}/main.cpp)
        message(FATAL_ERROR "${name} is not installed")
    endif()
    # The installed copy: nothing of the source tree can be beside it.
    configure(${prefix}/share/doc/ray-tracing-twins-dev/examples/${name} -DCMAKE_CXX_FLAGS=-Wall\ -Wextra\ -Werror)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${name} cannot be configured: ${said}")
    endif()
    execute_process(COMMAND ${CMAKE_COMMAND} --build ${SCRATCH}/${name}
                    RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE said)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${name} does not compile: ${said}")
    endif()
    execute_process(COMMAND ${SCRATCH}/${name}/${name} WORKING_DIRECTORY ${SCRATCH}/${name}
                    RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE error)
    message("---- ${name}\n${said}${error}")
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${name} failed")
    endif()
    set(said "${said}" PARENT_SCOPE)
endfunction()

# A number that the pattern has in parentheses, in ten-thousandths: CMake computes with integers alone.
function(number result pattern)
    if(NOT said MATCHES "${pattern}")
        message(FATAL_ERROR "'${pattern}' is not in what it printed")
    endif()
    set(found ${CMAKE_MATCH_1})
    if(NOT found MATCHES "\\.")
        string(APPEND found ".")
    endif()
    string(APPEND found "0000")
    string(REGEX REPLACE "^([0-9]*)\\.([0-9][0-9][0-9][0-9]).*" "\\1\\2" found ${found})
    string(REGEX REPLACE "^0+([0-9])" "\\1" found ${found})
    set(${result} ${found} PARENT_SCOPE)
endfunction()

# expect_close(<a> <b> <most> <what>): of numbers in ten-thousandths.
function(expect_close a b most what)
    math(EXPR difference "${a} - ${b}")
    string(REPLACE "-" "" difference ${difference})
    if(difference GREATER most)
        message(SEND_ERROR "${what}: ${a} and ${b} differ by more than ${most} ten-thousandths")
    endif()
endfunction()

function(expect_file file)
    if(NOT EXISTS ${SCRATCH}/${file})
        message(SEND_ERROR "${file} was not written")
    endif()
endfunction()

run(bvh)
number(by_tree "pass through: ([0-9]+) by the tree")
number(by_loop "([0-9]+) by a loop")
expect_close(${by_tree} ${by_loop} 0 "boxes that rays pass through")
number(tests "tests a ray: ([0-9]+) by the tree")
if(by_tree EQUAL 0 OR tests GREATER 20000000) # a tenth of what the loop needs
    message(SEND_ERROR "the tree is of no use")
endif()

run(spherical-triangle)
number(by_formula "solid angle: ([0-9.]+) sr")
number(by_chance "by the formula, ([0-9.]+) of uniform")
expect_close(${by_formula} ${by_chance} 50 "the solid angle")
number(by_formula "irradiance: ([0-9.]+) by Lambert")
number(by_samples "Lambert's formula, ([0-9.]+) of the samples")
expect_close(${by_formula} ${by_samples} 5 "the irradiance")
number(inside "inside: ([0-9.]+) %")
expect_close(${inside} 1000000 100 "the share inside") # of those on the edge the test's own rounding decides
expect_file(spherical-triangle/spherical-triangle.png)

run(weekend)
# The sky's gradient by the height of the direction: white to (.5, .7, 1).
number(red "upper row: ([0-9.]+) ")
number(blue "upper row: [0-9.]+ [0-9.]+ ([0-9.]+)")
expect_close(${blue} 10000 1 "the blue of the sky")
if(red LESS 5000 OR red GREATER 9000)
    message(SEND_ERROR "the red of the sky is ${red} ten-thousandths")
endif()
expect_file(weekend/weekend.png)

run(estimator)
number(worst "largest difference: ([0-9.]+)")
expect_close(${worst} 0 300 "the visibility of the sky")

run(error-against-time)
# The mean squared error falls as 1 / samples, and aiming at lamps is worth more than twice the samples.
string(REGEX MATCHALL "relMSE ([0-9.]+)" errors "${said}")
list(LENGTH errors count)
if(NOT count EQUAL 10)
    message(FATAL_ERROR "there are ${count} errors in place of 10")
endif()
foreach(row RANGE 9)
    list(GET errors ${row} said)
    number(error${row} "relMSE ([0-9.]+)")
endforeach()
math(EXPR mis_gain "${error0} / (${error4} + 1)")
math(EXPR gain "${error9} * 10 / (${error4} + 1)")
if(mis_gain LESS 6 OR gain LESS 20)
    message(SEND_ERROR "16 times the samples: ${mis_gain} times less error; lights sampled: ${gain} tenths")
endif()
expect_file(error-against-time/error-against-time.csv)
file(REMOVE_RECURSE ${SCRATCH})
