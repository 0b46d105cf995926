// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/lift_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/summary/bodies_statement.h"
#include "reports/summary/summary.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

constexpr const char* kLoad = "The load";
constexpr const char* kEquipment = "Load handling equipment";
constexpr const char* kRigging = "Rigging";
constexpr const char* kMovement = "Movement of equipment and load";
constexpr const char* kPeople = "Personnel and communication";
constexpr const char* kSite = "Site, ground and weather";
constexpr const char* kTrouble = "Contingencies and emergencies";

/// Text of the case, in quotes, since nothing checks it.
std::string stated(const std::string& text, const char* what) {
  return text.empty() ? "" : fmt::format("{}: “{}”, as the case says.", what, text);
}

std::string joined(const std::string& a, const std::string& b) { return a + (a.empty() || b.empty() ? "" : " ") + b; }

/// The greatest of the proved tensions, or nothing where the whole move is not proved.
std::string greatest_tension(const ReportContext& scene, const Summary& s) {
  if (s.use.source != CableUse::Source::kProved || scene.verdict != "proved") return "";
  const DisplayUnit& force = s.units.force;
  const auto upper = [](const Use& use) { return use.range.upper; };
  const Use& greatest = *std::ranges::max_element(s.use.tension, {}, upper);
  return fmt::format(
      "In the model, under the stated loads, no cable's tension exceeds {} {}; this program proved it, taut-check did "
      "not confirm this number.",
      up_text(greatest.range.upper, greatest.upper_limit, force), force.name());
}

std::string numbers_of(const Summary& s, const char* key) {
  const auto found = std::ranges::find(s.key_numbers, std::string_view(key), &KeyNumber::key);
  if (found == s.key_numbers.end() || !found->is_proved) return "";
  return fmt::format("{}: {} ({}).", found->title, found->value, found->detail);
}

std::vector<LiftPlanItem> load_items(const Summary& s) {
  const bool has_mass = s.load.mass_kg.has_value();
  return {{"load_description", kLoad, "Description, drawing, dimensions", stated(s.load_name, "Load"),
           "Drawing and dimensions of the load; parts of it that could shift. Lift planner."},
          {"load_weight", kLoad, "Weight, and where the figure comes from", s.load.total,
           "How the figures are known: weighed, drawn or estimated. Lift planner."},
          {"load_centre", kLoad, "Centre of gravity",
           has_mass ? "With the weight above; its uncertainty is that of the loads under Machine and load." : "",
           has_mass ? "How it is known. Lift planner." : "Where it is, and how that is known. Lift planner."},
          {"load_attachment", kLoad, "Attachment points, securing", "",
           "Points at which the load is held, and their strength. Rigging engineer."}};
}

std::vector<LiftPlanItem> equipment_items(const ReportContext& scene, const Summary& s) {
  const auto limits = std::ranges::find(s.statements, std::string_view("limits"), &Statement::key);
  const std::string no_bounds = scene.verdict == "proved" ? "" : "Bounds of the tensions: this report proves none. ";
  return {{"equipment", kEquipment, "Equipment and its configuration",
           joined(stated(s.machine, "Machine"), "Six cables; anchors under Machine and load."),
           "Make, serial number, inspections and tests. Equipment owner."},
          {"capacity", kEquipment, "Capacity, and how much of it is used",
           joined(limits == s.statements.end() ? "" : limits->text, numbers_of(s, "top")),
           no_bounds + "That the limits are the rated capacities, with every factor of safety. Equipment owner."},
          {"load_indicator", kEquipment, "Load indicator", greatest_tension(scene, s),
           "Which tensions are measured, and at which the move is stopped. Lift director."},
          {"foundation", kEquipment, "Foundation and support", greatest_tension(scene, s),
           no_bounds + "Strength of anchors, structure and ground under these forces. Structural engineer."},
          {"rigging", kRigging, "Slings, shackles, attachments", "",
           "Selection, capacity, inspection, and protection of load and rigging. Rigging engineer."}};
}

/// What is proved of clearances, and who has to see to the rest.
LiftPlanItem clearances_item(const ReportContext& scene, const Summary& s) {
  LiftPlanItem item{"clearances", kMovement, "Clearances, obstructions, power lines", "",
                    "Collisions are not examined here: all clearances along the path. Lift planner."};
  const std::optional<BodiesText>& bodies = scene.certificate.problem.bodies;
  if (!bodies) return item;
  const std::string rest = in_full({not_covered(scene.certificate).front()});
  if (scene.verdict != "proved") {
    item.open = "This report proves no clearances. All along the path. Lift planner.";
    return item;
  }
  const BodiesStatement statement = bodies_statement(*bodies);
  item.filled =
      joined(fmt::format("All checked pairs of bodies stay farther apart than their clearances, all along the "
                         "path{}. {}{}{}",
                         but_in_contacts(*bodies), statement.checked, statement.contacts.empty() ? "" : " ",
                         statement.contacts),
             numbers_of(s, "clearance"));
  item.open = fmt::format("That the bodies are those of the site. {} Power lines. Lift planner.", rest);
  return item;
}

/// Forces of inertia and the limits in time, where they are proved; else that only the stated loads have some.
LiftPlanItem dynamics_item(const ReportContext& scene) {
  LiftPlanItem item{"dynamics", kMovement, "Speed and dynamic loads",
                    "Forces of inertia as far as the stated loads contain them.",
                    "Speeds and accelerations at which they suffice. Lift planner."};
  if (!is_move(scene.certificate)) return item;
  if (scene.verdict != "proved") {
    item.filled.clear();
    item.open = "This report proves nothing about speeds and forces of inertia. Lift planner.";
    return item;
  }
  const Problem& problem = scene.certificate.problem;
  item.filled =
      fmt::format("The move takes T = {}. Forces of inertia of the weights are covered at every time of it. {}",
                  seconds_text(scene.certificate.path.timing->duration_s()),
                  time_limits_text(problem.time.value(), scene.illustration.units));
  item.open = fmt::format(
      "That the drives keep to the times, speeds and accelerations{}; vibration, jerk and stops on the way. Lift "
      "planner.",
      problem.time->rows ? ", and that what jumps of speed at rows add is within the loads" : "");
  return item;
}

std::vector<LiftPlanItem> movement_items(const ReportContext& scene, const Summary& s) {
  const bool is_found = !found_no_path(scene.certificate) && !scene.certificate.path.waypoints.empty();
  return {
      {"travel_path", kMovement, "Travel path of the load", is_found ? s.move : "",
       is_found ? "Step-by-step procedure with hold points. Lift director." : "The path. Lift planner."},
      clearances_item(scene, s),
      dynamics_item(scene),
      {"personnel", kPeople, "Persons, roles and qualifications", stated(s.prepared_by, "Prepared by"),
       "Lift director, operators, riggers, signal persons. Lift director."},
      {"communication", kPeople, "Communication, signals", "", "Method, and what happens if it fails. Lift director."},
      {"meeting", kPeople, "Pre-lift meeting, approvals", "The declaration on the first page is to be signed.",
       "Date and attendance. Lift director."}};
}

std::vector<LiftPlanItem> site_items(const Summary& s) {
  const auto tolerances = std::ranges::find(s.statements, std::string_view("tolerances"), &Statement::key);
  return {{"site", kSite, "Work area, services, utilities", stated(s.site, "Site"),
           "Work area, lighting, power and other services. Site manager."},
          {"site_control", kSite, "Access, traffic, exclusion zones", "", "Barriers and supervision. Site manager."},
          {"ground", kSite, "Ground", "", "Bearing capacity under the machine's supports. Structural engineer."},
          {"weather", kSite, "Weather limits", "Wind as far as the stated loads contain it.",
           "Wind speed, temperature and visibility at which the move is stopped. Lift director."},
          {"deviations", kTrouble, "Deviation from the plan",
           joined(tolerances == s.statements.end() ? "" : "Tolerances: " + tolerances->text, numbers_of(s, "growth")),
           "What is done when load, machine or path differ by more. Lift director."},
          {"malfunction", kTrouble, "Malfunction of equipment", "",
           "Loss of a cable, drive, sensor or power is not examined here. Lift planner."},
          {"emergency", kTrouble, "Emergency action plan", "",
           "The site's plan, and how it covers this move. Site manager."}};
}

}  // namespace

std::vector<LiftPlanItem> lift_plan(const ReportContext& scene, const Summary& summary) {
  std::vector<LiftPlanItem> result;
  for (const std::vector<LiftPlanItem>& part :
       {load_items(summary), equipment_items(scene, summary), movement_items(scene, summary), site_items(summary)}) {
    result.insert(result.end(), part.begin(), part.end());
  }
  return result;
}

nlohmann::json to_json(const std::vector<LiftPlanItem>& items) {
  const auto text_or_null = [](const std::string& text) {
    return text.empty() ? nlohmann::json() : nlohmann::json(text);
  };
  nlohmann::json result = nlohmann::json::array();
  for (const LiftPlanItem& item : items) {
    result.push_back({{"key", item.key},
                      {"group", item.group},
                      {"topic", item.topic},
                      {"filled", text_or_null(item.filled)},
                      {"open", text_or_null(item.open)}});
  }
  return result;
}

}  // namespace taut
