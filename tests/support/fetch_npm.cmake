# cmake -DNPM=... -DWORK=... -P fetch_npm.cmake: the packages of a test, by `npm ci`. What cannot
# be fetched is no failure: the tests that need it then say that they are skipped.
if(EXISTS ${WORK}/node_modules/.package-lock.json AND
    ${WORK}/node_modules/.package-lock.json IS_NEWER_THAN ${WORK}/package-lock.json)
  return()
endif()
execute_process(COMMAND ${NPM} ci --no-audit --no-fund --ignore-scripts --loglevel=error
  WORKING_DIRECTORY ${WORK} TIMEOUT 240 RESULT_VARIABLE result ERROR_VARIABLE error OUTPUT_QUIET)
if(NOT result EQUAL 0)
  message("npm cannot fetch the packages: ${error}")
endif()
