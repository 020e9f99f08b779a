# Runs before cpack packs: every file gets the time SOURCE_DATE_EPOCH, so that equal contents make equal packages.
if(DEFINED ENV{SOURCE_DATE_EPOCH})
    find_program(touch touch REQUIRED)
    find_program(find find REQUIRED)
    execute_process(COMMAND ${find} ${CPACK_TEMPORARY_DIRECTORY} -exec ${touch} -hd @$ENV{SOURCE_DATE_EPOCH} {} +
                    COMMAND_ERROR_IS_FATAL ANY)
endif()
