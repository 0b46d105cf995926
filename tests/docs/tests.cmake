# SPDX-License-Identifier: GPL-3.0-or-later
taut_add_script_test(docs documents LABELS documents slow TIMEOUT 600
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
taut_add_script_test(docs layers LABELS unit TIMEOUT 60 ARGUMENTS ${PROJECT_SOURCE_DIR})
