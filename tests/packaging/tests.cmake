taut_add_script_test(packaging surface LABELS unit TIMEOUT 60
  ARGUMENTS $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
if(NOT TAUT_SANITIZE)  # what is installed then can't be used without
  taut_add_script_test(packaging library LABELS slow TIMEOUT 600
    ARGUMENTS ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR} $<TARGET_FILE:taut-check>)
endif()
