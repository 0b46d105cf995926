add_test(NAME packaging.surface COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/packaging/surface_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(packaging.surface PROPERTIES LABELS "unit" TIMEOUT 60)
