# cmake -DFOOTFALL=... -DFILE=docs/reference.md -P reference_test.cmake: is the reference that is checked
# in what the program prints?
execute_process(COMMAND ${FOOTFALL} reference OUTPUT_VARIABLE printed RESULT_VARIABLE result)
file(READ ${FILE} stored)
if(NOT result EQUAL 0 OR NOT printed STREQUAL stored)
  message(FATAL_ERROR "docs/reference.md is stale: run `footfall reference > docs/reference.md`")
endif()
