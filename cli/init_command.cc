// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/init_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "cli/caspr.h"
#include "cli/console.h"
#include "cli/new_case_text.h"

namespace taut {

std::string new_case(const std::string& name) {
  constexpr std::string_view kPlaceholder = "NAME";
  std::string text = kNewCaseText;
  for (std::size_t at = text.find(kPlaceholder); at != std::string::npos; at = text.find(kPlaceholder, at)) {
    text.replace(at, kPlaceholder.size(), name);
    at += name.size();
  }
  return text;
}

namespace {

constexpr std::string_view kCaspr = "caspr:";

/// The name of the case in that file: the file's, if it can be one as it is.
std::string case_name(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  const bool is_plain = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.';
  });
  return name.empty() || !is_plain || name.size() > 100 ? "new-case" : name;
}

/// X_bodies.xml beside X_cables.xml, bodies.xml beside cables.xml.
std::string bodies_beside(const std::string& cables) {
  constexpr std::string_view kCables = "cables.xml";
  if (!cables.ends_with(kCables)) {
    throw InputError(ErrorCode::kUse,
                     fmt::format("--from: got '{}', expected a file whose name ends in {}, or --bodies FILE as well",
                                 excerpt(cables), kCables));
  }
  return cables.substr(0, cables.size() - kCables.size()) + "bodies.xml";
}

ImportedCase import(const InitArguments& arguments) {
  if (!arguments.from.starts_with(kCaspr) || arguments.from.size() == kCaspr.size()) {
    throw InputError(ErrorCode::kUse, fmt::format("--from: got '{}', expected caspr:PATH, the cables.xml of a robot",
                                                  excerpt(arguments.from)));
  }
  if (arguments.units.empty()) {
    throw InputError(ErrorCode::kUse,
                     "--units: got none, expected those of the robot's files, which don't say: CASPR's own are "
                     "--units length=m,force=N,mass=kg");
  }
  const std::string cables = arguments.from.substr(kCaspr.size());
  const std::string bodies = arguments.bodies.empty() ? bodies_beside(cables) : arguments.bodies;
  const CasprUnits units = read_caspr_units(arguments.units);
  const CasprRobot robot{{cables, read_whole(cables, kMaxXmlBytes)},
                         {bodies, read_whole(bodies, kMaxXmlBytes)},
                         units,
                         arguments.cable_set};
  return case_from_caspr(robot, case_name(arguments.path));
}

}  // namespace

void add_init_options(CLI::App& command, InitArguments& arguments) {
  command.add_option("FILE", arguments.path, "case file to write")->required();
  CLI::Option* from = command.add_option("--from", arguments.from,
                                         "make it of a CASPR robot: caspr:PATH/cables.xml, with bodies.xml beside it");
  command
      .add_option("--units", arguments.units,
                  "units of the robot's files: length=m,force=N (and mass=kg, which is the default)")
      ->needs(from);
  command.add_option("--bodies", arguments.bodies, "the robot's bodies.xml, if it is elsewhere")->needs(from);
  command.add_option("--cable-set", arguments.cable_set, "id of the cable_set to take (default: the file's)")
      ->needs(from);
}

int run_init(const InitArguments& arguments) {
  const std::string& path = arguments.path;
  std::error_code unknown;  // then writing it says why
  if (std::filesystem::exists(path, unknown))
    throw InputError(ErrorCode::kUse, path + ": got a file that exists, expected a new one", {path});
  if (arguments.from.empty()) {
    write_whole({{path, new_case(case_name(path))}});
    fmt::print("Written: {0}. Change it to your machine, then: taut plan {0}\n", sanitize(path));
    return kProvedExit;
  }
  const ImportedCase imported = import(arguments);
  write_whole({{path, imported.text}});
  for (const std::string& line : imported.read) fmt::print("{}\n", sanitize(line));
  fmt::print("These files don't say, and the case assumes (MISSING in it):\n");
  for (const std::string& line : imported.not_said) fmt::print("  {}\n", sanitize(line));
  fmt::print("Written: {0}. Put in what is missing; taut show {0} prints how it is understood.\n", sanitize(path));
  return kProvedExit;
}

}  // namespace taut
