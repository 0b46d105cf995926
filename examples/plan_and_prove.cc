// SPDX-License-Identifier: GPL-3.0-or-later
// Plans a case, writes what comes out, and proves a path of its own: plan_and_prove CASE.yaml FOLDER
#include <taut/taut.h>

#include <fstream>
#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: plan_and_prove CASE.yaml FOLDER\n";
    return 3;
  }
  try {
    const taut::Case robot = taut::Case::load(argv[1]);
    const std::string folder = argv[2];

    // What `taut plan` does.
    taut::PlanOptions options;
    options.progress = [](const taut::Progress& at) { std::cerr << at.stage << ": " << at.done << " charts\r"; };
    const taut::Certificate certificate = taut::plan(robot, options);
    std::cerr << "\n";
    if (certificate.verdict() != taut::Verdict::kProved) {
      std::cout << "not proved: " << certificate.reason() << "\n";
      return 1;
    }
    const taut::Margins margins = certificate.theorem()->margins().value();
    std::cout << "proved: " << certificate.segments() << " segments; every tension stays at least " << margins.tension_N
              << " N inside its limits\n";
    certificate.save(folder + "/certificate.json");
    std::ofstream(folder + "/path.csv") << certificate.path_csv();
    std::ofstream(folder + "/report.html") << taut::report(certificate);

    // A path of one's own: there and back again, along the same waypoints.
    taut::Path path = certificate.path();
    const std::size_t there = path.waypoints.size();
    for (std::size_t k = there - 1; k-- > 0;) path.waypoints.push_back(path.waypoints[k]);
    const taut::Certificate back = taut::prove(robot, path);
    std::cout << "there and back: " << (back.verdict() == taut::Verdict::kProved ? "proved" : "not proved") << "\n";
    return back.verdict() == taut::Verdict::kProved ? 0 : 1;
  } catch (const taut::InputError& error) {
    std::cerr << error.what() << "\n";
    return 3;
  }
}
