# Writes FILE, a header with the commit that is built: COMMIT, where it is given, else that of the
# checkout SOURCE. Where it has not changed the file is left as it is, and nothing is built anew.
if(COMMIT STREQUAL "")
    execute_process(
        COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
        OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT "#define VINES_COMMIT \"${COMMIT}\"\n")
