# Run by cpack on the files to be packed, one folder per component. Changes what Debian places
# elsewhere, or in another form, than `cmake --install`.
cmake_policy(VERSION 3.25)
set(debian ${CMAKE_CURRENT_LIST_DIR}/debian)
set(program ${CPACK_TEMPORARY_DIRECTORY}/program)
set(core ${CPACK_TEMPORARY_DIRECTORY}/core)

function(compress file)
    execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

compress(${program}/usr/share/man/man1/vines.1)
file(RENAME ${program}/usr/share/zsh/site-functions ${program}/usr/share/zsh/vendor-completions)
file(MAKE_DIRECTORY ${program}/etc/default)
file(COPY_FILE ${debian}/vines.default ${program}/etc/default/vines)

# Copyright of vines, of the libraries whose headers it is built with, and of the page's npm packages.
file(READ ${debian}/copyright copyright)
foreach(library libcli11-dev libcpp-httplib-dev libeigen3-dev libfmt-dev libspdlog-dev nlohmann-json3-dev
    prometheus-cpp-dev)
    file(READ /usr/share/doc/${library}/copyright text)
    string(APPEND copyright "\n---- ${library}\n\n${text}")
endforeach()
set(modules ${CMAKE_CURRENT_LIST_DIR}/../web/node_modules)
file(GLOB licences RELATIVE ${modules} ${modules}/d3-*/LICENSE ${modules}/delay/license ${modules}/idb-keyval/LICENCE)
foreach(licence IN LISTS licences)
    file(READ ${modules}/${licence} text)
    string(APPEND copyright "\n---- ${licence}\n\n${text}")
endforeach()

# Uses SOURCE_DATE_EPOCH if set.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
foreach(package vines libvines-core-dev)
    set(folder ${program})
    if(package STREQUAL libvines-core-dev)
        set(folder ${core})
    endif()
    set(documents ${folder}/usr/share/doc/${package})
    file(WRITE ${documents}/copyright "${copyright}")
    file(WRITE ${documents}/changelog "vines (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * See CHANGELOG.md of the sources.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
    compress(${documents}/changelog)
endforeach()

# Removes symbols that only a debugger needs.
file(GLOB libraries ${core}/usr/lib/*.a ${core}/usr/lib/*/*.a)
foreach(file IN LISTS libraries ITEMS ${program}/usr/bin/vines)
    set(what --strip-unneeded)
    if(file IN_LIST libraries)
        set(what --strip-debug --enable-deterministic-archives)
    endif()
    execute_process(
        COMMAND strip ${what} --remove-section=.comment ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
