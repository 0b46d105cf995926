add_test(NAME docs.documents COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/docs/documents_test.py
  $<TARGET_FILE:taut> $<TARGET_FILE:taut-check> ${PROJECT_SOURCE_DIR})
set_tests_properties(docs.documents PROPERTIES LABELS "documents" TIMEOUT 600)
