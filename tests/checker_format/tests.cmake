# SPDX-License-Identifier: GPL-3.0-or-later
foreach(header exact expression reader)
  taut_add_test(checker_format ${header} LABELS unit LIBS taut_checker OpenSSL::Crypto)
endforeach()
