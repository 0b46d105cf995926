// SPDX-License-Identifier: GPL-3.0-or-later
// Robots of CASPR (the Cable-robot Analysis and Simulation Platform for Research), made into cases.
//
// A CASPR robot is two XML files, *_cables.xml and *_bodies.xml. The numbers of these files go into the case digit by
// digit. What they can't say (units, limits of length, how the load may differ, a move) is given by the caller or
// assumed, and the case says so.
#pragma once

#include <string>
#include <vector>

#include "problem/units.h"

namespace taut {

/// The largest XML file that is read [bytes]; a robot of six cables has some 3 kB.
inline constexpr std::size_t kMaxXmlBytes = 1 << 20;

struct XmlFile {
  std::string name;  ///< for messages
  std::string text;
};

/// Units of all numbers of the files: they state none. Angles are radians, as CASPR computes with them.
struct CasprUnits {
  Unit length;
  Unit force;
  Unit mass;
  bool mass_is_assumed = false;  ///< kg, since nobody said
};

/// Reads "length=m,force=N" or "length=m,force=N,mass=kg"; without it, masses are in kg. @throws InputError
[[nodiscard]] CasprUnits read_caspr_units(const std::string& text);

struct CasprRobot {
  XmlFile cables;
  XmlFile bodies;
  CasprUnits units;
  std::string cable_set;  ///< its id, or empty: the file's default
};

struct ImportedCase {
  std::string text;                   ///< a case file
  std::vector<std::string> read;      ///< what was read, one sentence a line
  std::vector<std::string> not_said;  ///< what the files don't say, and what the case has instead
};

/// The robot as a case of that name.
/// @pre name is what read_name() of a case file takes, and plain YAML
/// @throws InputError with file, line and element: not XML, XML that declares entities, elements or attributes that are
/// unknown, missing or doubled, numbers that are no decimals, a robot that is not one free rigid body on six straight
/// cables between points, or one that can't be a case.
[[nodiscard]] ImportedCase case_from_caspr(const CasprRobot& robot, const std::string& name);

}  // namespace taut
