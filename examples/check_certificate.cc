// SPDX-License-Identifier: GPL-3.0-or-later
// Proves a certificate again that somebody else made about our case: check_certificate CERTIFICATE.json CASE.yaml
#include <taut/taut.h>

#include <fstream>
#include <iostream>
#include <sstream>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: check_certificate CERTIFICATE.json CASE.yaml\n";
    return 3;
  }
  std::ifstream file(argv[1], std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  try {
    taut::CheckOptions options;
    options.the_case = taut::Case::load(argv[2]);
    const taut::CheckResult result = taut::check(text.str(), options);
    if (!result.theorem) {
      std::cout << "not accepted: " << result.message << "\n";
      return 1;
    }
    std::cout << "accepted: " << result.message << "\n" << result.theorem->claim() << "\n";
    return 0;
  } catch (const taut::InputError& error) {
    std::cerr << error.what() << "\n";
    return 3;
  }
}
