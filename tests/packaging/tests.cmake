# SPDX-License-Identifier: GPL-3.0-or-later
taut_add_script_test(packaging surface LABELS unit TIMEOUT 60
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
if(NOT TAUT_SANITIZE)  # what is installed then can't be used without
  taut_add_script_test(packaging library LABELS slow TIMEOUT 600
    ARGUMENTS ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR} $<TARGET_FILE:taut-check>)
endif()
if(TAUT_HARDENING AND NOT TAUT_SANITIZE AND NOT CMAKE_BUILD_TYPE STREQUAL Debug)
  add_test(NAME packaging.hardening COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/packaging/hardening_test.py
    ${PROJECT_BINARY_DIR} $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> $<TARGET_FILE:taut_shared>)
  set_tests_properties(packaging.hardening PROPERTIES LABELS "unit" TIMEOUT 60)
endif()
