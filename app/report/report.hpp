// SPDX-License-Identifier: AGPL-3.0-or-later
// The report: one HTML file that shows a body, its responses, certificate, session and provenance.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/report/session_digest.hpp"
#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/library.hpp"

namespace palpate {

/// The artifacts to show. Body, curves and library must belong together: the vertices of the
/// library are those of the response surface, and the sites of the curves index them.
struct ReportInput {
  const Body* body = nullptr;
  const Curves* curves = nullptr;
  const Library* library = nullptr;
  const report::SessionDigest* session = nullptr;  ///< may be null
  std::string title;                               ///< empty: the name of the library
  std::uintmax_t library_bytes = 0;                ///< size of library.h5; 0: unknown
  /// Text of comparison.json (`palpate compare`); empty: none. Its vertices are those of the
  /// library.
  std::string comparison{};
  /// Text of fidelity.json (`palpate compare --fem`); empty: none. Shown when it contains
  /// the library of this digest.
  std::string fidelity{};
  std::string library_sha256{};
  /// Text of calibration.json (`palpate calibrate body`); empty: none.
  std::string calibration{};
  /// Text of repair.json (`palpate mesh`, where it repaired the surface); empty: none.
  std::string repair{};
  /// Bytes of deformation.pdef (a case with [deformation]); empty: none.
  std::string deformation{};
};

/// Writes one self-contained HTML file, which needs JavaScript but neither network nor WebGL. Text
/// from the artifacts is data for the page, never markup. The file is complete or absent.
/// @throws Error(Configuration) when the artifacts do not belong together, Error(Internal) when the
///   file cannot be written. Not real-time safe.
void write_report(const ReportInput& input, const std::filesystem::path& path);

namespace report {
/// The page of calibration.json alone. @throws Error(Configuration) when it cannot be read; as
/// write_report.
void write_calibration(const std::string& text, const std::filesystem::path& path);

/// The page with these data, which have a "title".
std::string page_text(const nlohmann::json& data);
/// The same as a file; as write_report.
void write_page(const nlohmann::json& data, const std::filesystem::path& path);
}  // namespace report

}  // namespace palpate
