// SPDX-License-Identifier: GPL-3.0-or-later
// Audits a table that this program makes, an arc that somebody thinks is safe: audit_table CASE.yaml
//
// The case has the parameters phi and theta, as cases/robot1-slice-qs-qg.yaml.
#include <taut/taut.h>

#include <iostream>

namespace {

std::string text(const taut::Place& place) { return "segment " + std::to_string(place.position()); }

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: audit_table CASE.yaml\n";
    return 3;
  }
  try {
    const taut::Case robot = taut::Case::load(argv[1]);
    taut::Table arc = {{"t[s]", "phi[deg]", "theta[deg]"}, {}};
    constexpr int kRows = 30;
    for (int k = 0; k < kRows; ++k) {
      const double seconds = 0.5 * k;
      arc.values.insert(arc.values.end(), {seconds, -130.0 + 8.0 * k, 92.0});
    }
    const taut::Certificate certificate = taut::audit(robot, arc, {}, "arc");
    if (certificate.verdict() == taut::Verdict::kProved) {
      std::cout << "proved, with " << certificate.theorem()->margins()->tension_N << " N to spare\n";
      return 0;
    }
    for (const taut::Stretch& stretch : certificate.stretches()) {
      std::cout << "not proved from " << text(stretch.begin) << " to " << text(stretch.end);
      if (stretch.violations) {
        const taut::Witness& first = stretch.violations->first;
        std::cout << ": " << first.kind;
        if (first.kind != "singular") {
          std::cout << " of cable " << first.cable << ", " << first.value_lower << " beside a limit of " << first.limit;
        }
        std::cout << "\n";
      } else {
        std::cout << ": open, " << stretch.reason << "\n";
      }
    }
    return 1;
  } catch (const taut::InputError& error) {
    std::cerr << error.what() << "\n";
    return 3;
  }
}
