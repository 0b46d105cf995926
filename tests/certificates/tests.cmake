# SPDX-License-Identifier: GPL-3.0-or-later
add_test(NAME certificates.bases
  COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_SOURCE_DIR}/certificates/make_bases.py --check)
set_tests_properties(certificates.bases PROPERTIES LABELS certificates TIMEOUT 300 COST 12)
taut_add_script_test(certificates expand LABELS certificates)
taut_add_script_test(certificates schema LABELS certificates ARGUMENTS ${PROJECT_SOURCE_DIR} ${TAUT_CERTIFICATES})
