# Configures and builds the project in SOURCE_DIR against the package installed in PREFIX, in the folder WORK, which is
# kept: what has not changed is not built again. Then runs RUN, if given, and the installed command.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN} failed:\n${output}")
  endif()
endfunction()
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK} -G Ninja -DCMAKE_BUILD_TYPE=${CONFIGURATION}
  -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_PREFIX_PATH=${PREFIX})
run(${CMAKE_COMMAND} --build ${WORK})
if(RUN)
  run(${WORK}/${RUN})
endif()
run(${PREFIX}/bin/lampyr --version)
