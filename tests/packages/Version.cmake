# One version wherever it stands: in CMakeLists.txt, vcpkg.json, the changelog of users and the data for software
# centres; its first two numbers alone in projects that use the modules, which are bound to these. Libraries of vcpkg
# have one, too: the baseline is a commit.
#   cmake -DROOT=... -P Version.cmake
cmake_minimum_required(VERSION 3.25)

# expect_version FILE PATTERN: the first text that matches the pattern has the version of CMakeLists.txt in its
# parentheses.
function(expect_version file pattern)
    file(READ ${ROOT}/${file} text)
    string(REGEX MATCH "${pattern}" found "${text}")
    if(NOT CMAKE_MATCH_1 STREQUAL version)
        message(SEND_ERROR "${file}: '${found}' is not of version ${version}")
    endif()
endfunction()

file(READ ${ROOT}/CMakeLists.txt project)
string(REGEX MATCH "project\\([^)]* VERSION ([0-9.]+)" found "${project}")
set(version ${CMAKE_MATCH_1})
expect_version(vcpkg.json "\"version\": \"([0-9.]+)\"")
expect_version(CHANGELOG.md "\n## ([0-9.]+)")
expect_version(Assets/desktop/org.example.RayTracingTwins.metainfo.xml "<release version=\"([0-9.]+)\"")

string(REGEX MATCH "^[0-9]+\\.[0-9]+" version ${version})
file(GLOB examples RELATIVE ${ROOT} ${ROOT}/examples/*/CMakeLists.txt)
foreach(file IN ITEMS ${examples} docs/modules.md)
    expect_version(${file} "find_package\\(RayTracingTwins ([0-9.]+)")
endforeach()

file(READ ${ROOT}/vcpkg.json manifest)
string(JSON baseline GET "${manifest}" builtin-baseline)
string(LENGTH "${baseline}" digits)
if(NOT baseline MATCHES "^[0-9a-f]+$" OR NOT digits EQUAL 40)
    message(SEND_ERROR "vcpkg.json: the baseline '${baseline}' is no commit")
endif()
