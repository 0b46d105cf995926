foreach(header exact expression reader)
  taut_add_test(checker_format ${header} LABELS unit LIBS taut_checker OpenSSL::Crypto)
endforeach()
