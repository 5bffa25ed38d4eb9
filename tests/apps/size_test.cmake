# The size of a program without its symbols, in bytes.
execute_process(COMMAND ${STRIP} -o ${PROGRAM}.stripped ${PROGRAM} COMMAND_ERROR_IS_FATAL ANY)
file(SIZE ${PROGRAM}.stripped size)
file(REMOVE ${PROGRAM}.stripped)
if(size GREATER MOST)
  message(FATAL_ERROR "${PROGRAM}: ${size} bytes, more than ${MOST}")
endif()
message(STATUS "${PROGRAM}: ${size} bytes of ${MOST}")
