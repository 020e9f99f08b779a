# What cmake/Libraries.cmake would find: targets that have headers alone, from the folder RT_HEADERS, and for codecs the
# library RT_STANDINS.
foreach(name IN ITEMS glm spdlog json cli11 stb tinygltf png jpeg openexr tbb)
    add_library(rt::${name} INTERFACE IMPORTED GLOBAL)
    target_include_directories(rt::${name} INTERFACE ${RT_HEADERS} ${RT_HEADERS}/stb ${RT_HEADERS}/OpenEXR
                               ${RT_HEADERS}/Imath)
endforeach()
foreach(name IN ITEMS png jpeg openexr)
    target_link_libraries(rt::${name} INTERFACE ${RT_STANDINS})
endforeach()
target_compile_definitions(rt::spdlog INTERFACE SPDLOG_FMT_EXTERNAL FMT_HEADER_ONLY)
