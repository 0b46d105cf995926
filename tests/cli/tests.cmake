# SPDX-License-Identifier: GPL-3.0-or-later
foreach(name end_to_end init signature audit logs regress robustness compare report sensitivity map no_path show
    loads json messages angles terminal levels)
  taut_add_script_test(cli ${name} LABELS unit TIMEOUT 1800
    ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
endforeach()
# With several processes under mpirun, and some that are killed.
taut_add_script_test(cli parts LABELS slow TIMEOUT 1800
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
taut_add_script_test(cli long_logs LABELS slow TIMEOUT 1800
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
taut_add_script_test(cli audit_tolerances LABELS slow nightly TIMEOUT 1800
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
