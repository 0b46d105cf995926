foreach(header markup samples scene travel report_data cable_use summary html_report)
  taut_add_test(reports ${header} LABELS unit LIBS taut::reports fmt::fmt OpenSSL::Crypto)
endforeach()

add_executable(reports_write_samples reports/write_samples.cc)
target_link_libraries(reports_write_samples PRIVATE taut_common taut::reports)
