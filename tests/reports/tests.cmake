foreach(header markup plot samples scene travel html_report)
  taut_add_test(reports ${header} LABELS unit LIBS taut::reports fmt::fmt)
endforeach()

add_executable(reports_write_samples reports/write_samples.cc)
target_link_libraries(reports_write_samples PRIVATE taut_common taut::reports)
add_test(NAME reports.browser
  COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/reports/browser_test.sh" $<TARGET_FILE:reports_write_samples>)
set_tests_properties(reports.browser PROPERTIES LABELS slow TIMEOUT 300)
