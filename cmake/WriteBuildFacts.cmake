# Writes the header RT_HEADER with RT_VERSION, RT_FEATURES, RT_COMPILERS and the commit of the sources in RT_ROOT: "1a2b3c4d5e6f",
# with "+changes" where files differ from it; empty where they are no checkout. Nothing is written when nothing has
# changed.
cmake_minimum_required(VERSION 3.25)
set(commit "")
if(RT_GIT AND EXISTS ${RT_ROOT}/.git)
    execute_process(COMMAND ${RT_GIT} -C ${RT_ROOT} rev-parse --short=12 HEAD OUTPUT_VARIABLE commit ERROR_QUIET
                    OUTPUT_STRIP_TRAILING_WHITESPACE)
    execute_process(COMMAND ${RT_GIT} -C ${RT_ROOT} diff-index --quiet HEAD -- RESULT_VARIABLE differs ERROR_QUIET)
    if(commit AND differs EQUAL 1)
        string(APPEND commit "+changes")
    endif()
endif()
file(CONFIGURE OUTPUT ${RT_HEADER} @ONLY CONTENT "#pragma once
#define RT_VERSION \"@RT_VERSION@\"
#define RT_COMMIT \"@commit@\"
#define RT_FEATURES \"@RT_FEATURES@\"
#define RT_COMPILERS \"@RT_COMPILERS@\"
")
