# Man pages, completions of shells and docs/reference.md, which rt-write-manual makes from the flags of the programs.
set(RT_PROGRAMS ray-tracing-cpu ray-tracing-gpu ray-tracing-image ray-tracing-bench)
set(RT_MANUAL ${PROJECT_BINARY_DIR}/manual)
set(manual_files ${RT_MANUAL}/reference.md)
set(man_pages "")
foreach(program IN LISTS RT_PROGRAMS)
    list(APPEND man_pages ${RT_MANUAL}/man/${program}.1)
    list(APPEND manual_files ${RT_MANUAL}/man/${program}.1 ${RT_MANUAL}/bash/${program} ${RT_MANUAL}/zsh/_${program}
                             ${RT_MANUAL}/fish/${program}.fish)
endforeach()
add_custom_command(OUTPUT ${manual_files} COMMAND rt-write-manual ${RT_MANUAL} DEPENDS rt-write-manual
                   COMMENT "Man pages, completions and reference from the flags" VERBATIM)
# Systems with gzip keep man pages compressed.
find_program(RT_GZIP gzip)
mark_as_advanced(RT_GZIP)
set(RT_COMPRESSED "")
if(RT_GZIP)
    set(RT_COMPRESSED .gz)
    list(TRANSFORM man_pages APPEND .gz OUTPUT_VARIABLE compressed)
    add_custom_command(OUTPUT ${compressed} COMMAND ${RT_GZIP} -9nkf ${man_pages} DEPENDS ${man_pages} VERBATIM)
    list(APPEND manual_files ${compressed})
endif()
add_custom_target(rt-manual-files ALL DEPENDS ${manual_files})
add_custom_target(reference COMMAND ${CMAKE_COMMAND} -E copy ${RT_MANUAL}/reference.md ${PROJECT_SOURCE_DIR}/docs
                  DEPENDS rt-manual-files VERBATIM)
