# Writes FILE, a header with the commit that is built: COMMIT if given, else that of the checkout
# SOURCE. An unchanged file keeps its time stamp, so that nothing is rebuilt.
if(COMMIT STREQUAL "")
    execute_process(
        COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
        OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT "#define VINES_COMMIT \"${COMMIT}\"\n")
