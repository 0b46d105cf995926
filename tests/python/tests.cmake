if(TAUT_PYTHON)
  add_test(NAME python.taut COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/python/taut_test.py
    $<TARGET_FILE:taut> ${PROJECT_SOURCE_DIR})
  set_tests_properties(python.taut PROPERTIES LABELS "unit" TIMEOUT 300
    ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1")
  add_test(NAME python.tutorial COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/python/tutorial_test.py
    ${PROJECT_SOURCE_DIR})
  set_tests_properties(python.tutorial PROPERTIES LABELS "unit" TIMEOUT 300
    ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1")
endif()
