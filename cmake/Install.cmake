# What cmake --install puts where. Programs find Assets beside themselves, below the prefix, or by RT_ASSETS
# (Common/Core/Paths.cpp), so that the prefix can be moved.
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(RT_PRIVATE_LIBRARIES lib/ray-tracing-twins) # of these programs alone

# Libraries that come along in an archive of one folder: those of the system that every desktop has, and the loaders of
# graphics drivers, stay the system's.
set(left_out "^(ld-linux|lib(c|m|dl|rt|pthread|gcc_s|stdc\\+\\+|vulkan|GL|EGL|drm|gbm|xkbcommon)[.-])" "^lib(X|xcb|wayland)"
             "^(api-ms-|ext-ms-)")
set(installed "")
foreach(program IN LISTS RT_PROGRAMS)
    if(TARGET ${program})
        list(APPEND installed ${program})
    endif()
endforeach()
if(UNIX AND NOT APPLE)
    file(RELATIVE_PATH from_bin /${CMAKE_INSTALL_BINDIR} /${RT_PRIVATE_LIBRARIES})
    set_target_properties(${installed} PROPERTIES INSTALL_RPATH $ORIGIN/${from_bin})
    foreach(program IN LISTS installed) # libraries that come along find each other there, too
        target_link_options(${program} PRIVATE LINKER:--disable-new-dtags)
    endforeach()
endif()
set(dependencies "")
if(CMAKE_SYSTEM_NAME MATCHES "^(Linux|Windows)$" AND NOT CMAKE_CROSSCOMPILING) # where CMake finds what programs load
    set(dependencies RUNTIME_DEPENDENCY_SET rt-libraries)
endif()
install(TARGETS ${installed} ${dependencies} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
if(TARGET ray-tracing-mpi)
    install(TARGETS ray-tracing-mpi LIBRARY DESTINATION ${RT_PRIVATE_LIBRARIES} COMPONENT programs)
endif()
if(dependencies)
    install(RUNTIME_DEPENDENCY_SET rt-libraries PRE_EXCLUDE_REGEXES ${left_out}
            POST_EXCLUDE_REGEXES ".*system32/.*\\.dll"
            LIBRARY DESTINATION ${RT_PRIVATE_LIBRARIES} COMPONENT libraries EXCLUDE_FROM_ALL
            RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT libraries EXCLUDE_FROM_ALL)
    install(SCRIPT cmake/packages/Licenses.cmake COMPONENT libraries EXCLUDE_FROM_ALL)
endif()
install(DIRECTORY Assets/ DESTINATION ${CMAKE_INSTALL_DATADIR}/ray-tracing-twins COMPONENT programs
        PATTERN desktop EXCLUDE)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/ray-tracing-twins COMPONENT libraries EXCLUDE_FROM_ALL)

if(UNIX AND NOT APPLE)
    set(desktop ${PROJECT_SOURCE_DIR}/Assets/desktop)
    install(FILES ${desktop}/ray-tracing-cpu.desktop ${desktop}/ray-tracing-gpu.desktop
                  ${desktop}/ray-tracing-open.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT programs)
    install(FILES ${desktop}/org.example.RayTracingTwins.metainfo.xml
            DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT programs)
    install(FILES ${desktop}/ray-tracing-twins.mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages
            RENAME ray-tracing-twins.xml COMPONENT programs)
    set(zsh_functions site-functions)
    if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
        set(zsh_functions vendor-completions) # of packages
    endif()
    set(icons ${CMAKE_INSTALL_DATADIR}/icons/hicolor)
    install(FILES ${desktop}/ray-tracing-twins.svg DESTINATION ${icons}/scalable/apps COMPONENT programs)
    foreach(size IN ITEMS 16 24 32 48 64 128 256)
        install(FILES ${desktop}/icons/${size}.png DESTINATION ${icons}/${size}x${size}/apps
                RENAME ray-tracing-twins.png COMPONENT programs)
    endforeach()
    foreach(program IN LISTS installed)
        install(FILES ${RT_MANUAL}/man/${program}.1${RT_COMPRESSED}
                DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs)
        install(FILES ${RT_MANUAL}/bash/${program}
                DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT programs)
        install(FILES ${RT_MANUAL}/zsh/_${program}
                DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${zsh_functions} COMPONENT programs)
        install(FILES ${RT_MANUAL}/fish/${program}.fish
                DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT programs)
    endforeach()
endif()
