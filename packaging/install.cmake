# What is installed with the program (component program) beside it, and Debian's packages of program
# and core: cpack --preset package, or cpack -G DEB in a build's folder.
include(GNUInstallDirs)

# The program knows its flags: manual page and completions are made with it, each time.
set(made ${CMAKE_CURRENT_BINARY_DIR}/made)
file(MAKE_DIRECTORY ${made})
add_custom_command(TARGET vines POST_BUILD
    COMMAND vines manual > ${made}/vines.1
    COMMAND vines completion bash > ${made}/vines
    COMMAND vines completion zsh > ${made}/_vines
    COMMAND vines completion fish > ${made}/vines.fish
    VERBATIM)
install(FILES ${made}/vines.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${made}/vines DESTINATION share/bash-completion/completions COMPONENT program)
install(FILES ${made}/_vines DESTINATION share/zsh/site-functions COMPONENT program)
install(FILES ${made}/vines.fish DESTINATION share/fish/vendor_completions.d COMPONENT program)

# systemd looks here for /usr and /usr/local; the unit names the program by its path.
install(FILES deploy/vines.service DESTINATION lib/systemd/system COMPONENT program)
install(CODE [[
    set(unit "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib/systemd/system/vines.service")
    file(READ "${unit}" text)
    string(REPLACE "/usr/bin/vines" "${CMAKE_INSTALL_PREFIX}/bin/vines" text "${text}")
    file(WRITE "${unit}" "${text}")
]] COMPONENT program)

# pkg-config --cflags --libs vines-core, wherever its prefix is moved to.
string(REGEX REPLACE "[^/]+" ".." up ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
configure_file(src/core/vines-core.pc.in vines-core.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vines-core.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT core)

set(VINES_MAINTAINER "vines maintainers <maintainers@vines.invalid>" CACHE STRING
    "name and address in Debian's packages")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vines)
set(CPACK_PACKAGE_CONTACT ${VINES_MAINTAINER})
set(CPACK_OUTPUT_FILE_PREFIX ${CMAKE_CURRENT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL program core)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_SOURCE_DIR}/packaging/debian.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(debian ${CMAKE_CURRENT_SOURCE_DIR}/packaging/debian)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME vines)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "curl, jq")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA
    ${debian}/postinst ${debian}/prerm ${debian}/postrm ${debian}/conffiles)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
"exact simulation of an oscillator with a vibro-impact absorber
A linear oscillator coupled with a vibro-impact nonlinear energy sink:
its motion, every impact, its transfer matrices and its transient
Lyapunov exponents, as a command line and as an HTTP service with a page
that plots its answers.
.
The service is installed, but not enabled: systemctl enable --now vines.")

set(CPACK_DEBIAN_CORE_PACKAGE_NAME libvines-core-dev)
set(CPACK_DEBIAN_CORE_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_CORE_PACKAGE_DEPENDS libeigen3-dev)
set(CPACK_DEBIAN_CORE_DESCRIPTION
"exact simulation of an oscillator with a vibro-impact absorber (library)
Headers and the static library of the core of vines, for programs in
C++20: find_package(vines) of CMake with the target vines::core, or
pkg-config's vines-core.")
include(CPack)
