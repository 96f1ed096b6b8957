// SPDX-License-Identifier: AGPL-3.0-or-later
// What is wrong with a surface, before any repair.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/faulty_faces.hpp"
#include "mesher/geometry/soup.hpp"

namespace palpate::mesher {

struct Diagnosis {
  std::vector<std::string> findings;  ///< number and place of each kind of fault; empty: sound
  FaultyFaces faces;                  ///< m
};

/// Counts holes, borders, edges with more than two faces, points in which sheets meet, faces that
/// occur twice, have no area, cross others or are oriented differently from their neighbours, and
/// separate parts. Crossings and parts are those of the faces after they are connected
/// (repair/sheets.hpp).
/// @param soup tidied, in metres
Diagnosis diagnose(const Soup& soup, const std::string& where);

}  // namespace palpate::mesher
