# SPDX-License-Identifier: GPL-3.0-or-later
if(TAUT_PYTHON)
  taut_add_script_test(python taut LABELS unit ARGUMENTS $<TARGET_FILE:taut> ${PROJECT_SOURCE_DIR})
  taut_add_script_test(python tutorial LABELS unit ARGUMENTS ${PROJECT_SOURCE_DIR})
  set_tests_properties(python.taut python.tutorial PROPERTIES
    ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1")
  if(PROJECT_BINARY_DIR STREQUAL "${PROJECT_SOURCE_DIR}/build/release")  # elsewhere it would build that
    taut_add_script_test(python wrapper LABELS unit ARGUMENTS ${PROJECT_SOURCE_DIR})
  endif()
endif()
