# SPDX-License-Identifier: GPL-3.0-or-later
foreach(header markup display_units samples scene travel report_data cable_use nearness key_numbers broken_limits
    bodies_statement body_distances load_statement style summary angles machine_picture shown_bodies worst_place
    html_report theorem file_lines scope assurance_case lift_plan time_statement move_sampler)
  taut_add_test(reports ${header} LABELS unit LIBS taut::reports fmt::fmt OpenSSL::Crypto TOGETHER)
endforeach()

add_executable(reports_write_samples reports/write_samples.cc)
target_link_libraries(reports_write_samples PRIVATE taut_common taut::reports)
# In a browser; with a directory as a last argument it leaves screenshots there.
add_test(NAME reports.browser
  COMMAND "${TAUT_NODE}" "${CMAKE_CURRENT_SOURCE_DIR}/reports/browser_test.mjs" $<TARGET_FILE:taut>
    $<TARGET_FILE:reports_write_samples> "${PROJECT_SOURCE_DIR}/cases")
set_tests_properties(reports.browser PROPERTIES LABELS slow TIMEOUT 1800 COST 300)
add_test(NAME reports.words COMMAND "${TAUT_NODE}" --test "${CMAKE_CURRENT_SOURCE_DIR}/reports/words_test.mjs"
  "${CMAKE_CURRENT_SOURCE_DIR}/reports/data_test.mjs" "${CMAKE_CURRENT_SOURCE_DIR}/reports/nearness_test.mjs")
set_tests_properties(reports.words PROPERTIES LABELS unit)
add_test(NAME reports.map_slices
  COMMAND "${TAUT_NODE}" "${CMAKE_CURRENT_SOURCE_DIR}/reports/map_slices_test.mjs" $<TARGET_FILE:taut>
    "${PROJECT_SOURCE_DIR}/cases")
set_tests_properties(reports.map_slices PROPERTIES LABELS slow TIMEOUT 300)
