// main.cpp: main() of the tests: exit status 77, skipped for ctest, if each of them was skipped.
#include <gtest/gtest.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  setenv("SOURCE_DATE_EPOCH", "1700000000", 0);  // maps saved twice have the same bytes
  testing::InitGoogleTest(&argc, argv);
  if (RUN_ALL_TESTS() != 0) return 1;
  const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
  const int run = tests.test_to_run_count();
  return run > 0 && tests.skipped_test_count() == run ? 77 : 0;
}
