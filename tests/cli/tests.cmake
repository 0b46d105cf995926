find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME cli.end_to_end COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/cli/end_to_end_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.end_to_end PROPERTIES LABELS "unit" TIMEOUT 1800)
add_test(NAME cli.signature COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/cli/signature_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.signature PROPERTIES LABELS "unit" TIMEOUT 1800)
add_test(NAME cli.audit COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/cli/audit_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.audit PROPERTIES LABELS "unit" TIMEOUT 1800)
add_test(NAME cli.audit_tolerances COMMAND Python3::Interpreter
  ${CMAKE_CURRENT_SOURCE_DIR}/cli/audit_tolerances_test.py $<TARGET_FILE:taut> $<TARGET_FILE:taut-check>
  ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.audit_tolerances PROPERTIES LABELS "slow" TIMEOUT 1800)
add_test(NAME cli.regress COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/cli/regress_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.regress PROPERTIES LABELS "unit" TIMEOUT 1800)
add_test(NAME cli.robustness COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/cli/robustness_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.robustness PROPERTIES LABELS "unit" TIMEOUT 1800)
add_test(NAME cli.compare COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/cli/compare_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.compare PROPERTIES LABELS "unit" TIMEOUT 1800)
add_test(NAME cli.report COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/cli/report_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.report PROPERTIES LABELS "unit" TIMEOUT 1800)
add_test(NAME cli.show COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/cli/show_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(cli.show PROPERTIES LABELS "unit" TIMEOUT 1800)
