taut_add_test(certify segment_proof LABELS unit LIBS taut::certify)
taut_add_test(certify certificate LABELS unit LIBS taut::certify)
taut_add_test(certify certificate_stream LABELS unit LIBS taut::certify)
taut_add_test(certify grazing LABELS unit LIBS taut::certify)
foreach(header rounding interval mp_interval dyadic centered motion box_proof oracle)
  taut_add_test(certify ${header} LABELS unit laws LIBS taut::certify)
endforeach()
taut_add_test(certify interval_laws LABELS unit laws LIBS taut::certify taut_checker)
foreach(arithmetic Interval Mp BoostDouble Checker)
  add_test(NAME certify.interval_laws_at_length.${arithmetic}
    COMMAND certify_interval_laws_test --gtest_filter=IntervalLaws/${arithmetic}*.OperationsEncloseTheirRange)
  set_tests_properties(certify.interval_laws_at_length.${arithmetic} PROPERTIES LABELS slow TIMEOUT 3600
    ENVIRONMENT TAUT_INTERVAL_CASES=40000)
endforeach()
