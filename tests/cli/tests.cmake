# SPDX-License-Identifier: GPL-3.0-or-later
foreach(name end_to_end init signature audit logs regress robustness compare report sensitivity map no_path show
    loads bodies moves timed_audit legs wrap json messages angles terminal levels formal monitor)
  taut_add_script_test(cli ${name} LABELS unit TIMEOUT 1800
    ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
endforeach()
# Kills at more moments, and finer steps of memory.
taut_add_script_test(cli robustness_at_length SCRIPT robustness LABELS slow TIMEOUT 1800
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR}
    Robustness.test_a_kill_at_any_moment_leaves_whole_files Robustness.test_no_amount_of_memory_makes_it_abort)
set_tests_properties(cli.robustness_at_length PROPERTIES ENVIRONMENT TAUT_AT_LENGTH=1)
# With several processes under mpirun, and some that are killed.
taut_add_script_test(cli parts LABELS slow TIMEOUT 1800
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
taut_add_script_test(cli long_logs LABELS slow TIMEOUT 1800
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
taut_add_script_test(cli audit_tolerances LABELS slow nightly TIMEOUT 1800
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
