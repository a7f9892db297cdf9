# Writes the ctest entries of a GoogleTest executable, one entry per suite. Each start of an executable loads some 250
# libraries, which takes longer than most tests: 0.14 s of processor time.
#
# usage: cmake -D program=FILE -D list=FILE -D properties=WORDS -P suites.cmake
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE lines RESULT_VARIABLE status TIMEOUT 300)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${program} --gtest_list_tests: ${status}")
endif()
string(REGEX MATCHALL "(^|\n)[^ \n]+\\.[^\n]*" suites "${lines}")
if(NOT suites)
  message(FATAL_ERROR "${program} has no tests")
endif()
set(entries "")
foreach(suite ${suites})
  string(REGEX REPLACE "^\n?([^ ]+)\\..*$" "\\1" suite "${suite}")
  string(APPEND entries "add_test([[${suite}]] [[${program}]] [[--gtest_filter=${suite}.*]])\n"
    "set_tests_properties([[${suite}]] PROPERTIES SKIP_RETURN_CODE 77 ${properties})\n")
endforeach()
file(WRITE ${list} "${entries}")
