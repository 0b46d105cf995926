# SPDX-License-Identifier: GPL-3.0-or-later
foreach(name end_to_end init signature regress report moves timed_audit wrap messages angles terminal levels monitor)
  taut_add_script_test(cli ${name} LABELS unit TIMEOUT 1800
    ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
endforeach()
foreach(name parts robustness logs bodies compare audit json formal legs sensitivity map no_path show loads)
  taut_add_script_test(cli ${name} LABELS slow TIMEOUT 1800 COST 200
    ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
endforeach()
# parts has several processes under mpirun, some of which are killed, and others wait for a minute to hear of them: it
# runs alone.
set_tests_properties(cli.parts PROPERTIES PROCESSORS 3)
foreach(name audit_tolerances long_logs)
  taut_add_script_test(cli ${name} LABELS slow nightly TIMEOUT 1800
    ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
endforeach()
