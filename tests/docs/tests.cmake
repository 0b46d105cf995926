add_test(NAME docs.documents COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/docs/documents_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(docs.documents PROPERTIES LABELS "documents" TIMEOUT 600)
add_test(NAME docs.layers COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/docs/layers_test.py ${PROJECT_SOURCE_DIR})
set_tests_properties(docs.layers PROPERTIES LABELS "unit" TIMEOUT 60)
